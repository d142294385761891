# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What PyVista 0.48 and newer finds by the package's entry points, which pyproject.toml lists.

    mesh.elevation_surface.reconstruct(maximum_edge_length=35)
    pyvista.read("horizon.zmap")
    surface.save("surface.ts")
"""

import pyvista
from pyvista.core.utilities.reader_registry import LocalFileRequiredError
from vtkmodules.vtkFiltersCore import vtkTriangleFilter
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter

from . import reading, reconstruction, writing


@pyvista.register_dataset_accessor("elevation_surface", pyvista.DataSet)
class ElevationSurface:
    """The methods mesh.elevation_surface of a PyVista mesh."""

    def __init__(self, mesh):
        self._mesh = mesh

    def reconstruct(self, **options):
        """The surface of the mesh's points, with holes filled. Options are those of reconstruct()."""
        return pyvista.wrap(reconstruction.reconstruct(self._mesh, **options).surface)


def read_points(path, **options):
    """The points of a file, as read() reads them, with their arrays."""
    path = str(path)
    if "://" in path:
        raise LocalFileRequiredError
    return pyvista.wrap(reading.read(path, **options).points)


def write_triangles(surface, path):
    """Writes the triangles and polygons of a mesh in the format of the suffix."""
    faces = vtkGeometryFilter()
    faces.SetInputData(surface)
    triangles = vtkTriangleFilter()
    triangles.PassVertsOff()
    triangles.PassLinesOff()
    triangles.SetInputConnection(faces.GetOutputPort())
    triangles.Update()
    if not triangles.GetOutput().GetNumberOfPolys():
        raise ValueError(f"{path}: the mesh has no triangles to write")
    writing.write_surface(triangles.GetOutput(), path)
