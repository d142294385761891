# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes surfaces."""

import os

from vtkmodules.vtkCommonDataModel import vtkPolyData

from ..clouds import cells_of, coordinates_of, make_points, rounding_note, set_crs
from .mesh_formats import Triangles, write_glb, write_ply, write_ts
from ..messages import FileError, Messages
from ..paths import suffix_of
from .xml_writer import write_vtp, write_vtu


def write_surface(data, path, crs=None, progress=None):
    """Writes triangles in the format of the suffix. Returns notes for the user.

    data      vtkPolyData with triangles
    crs       the coordinate reference system as WKT or AUTHORITY:CODE; written where the format has a
              place for it
    progress  None, or a function that is called with the fraction done
    Raises OSError, and FileError where VTK gives the reason.
    """
    return FORMATS[suffix_of(path)](data, path, crs, progress or (lambda fraction: None))


def in_vtk_xml(write):
    def run(data, path, crs, progress):
        if crs:
            plain, data = data, vtkPolyData()
            data.ShallowCopy(plain)
            set_crs(data, crs)
        write(data, path, progress)
        return []

    return run


def write_obj(data, path, _crs, progress):
    """OBJ by VTK, which writes all digits."""
    from vtkmodules.vtkIOGeometry import vtkOBJWriter

    surface = Triangles(data)
    bare = make_points(surface.points)
    bare.SetPolys(cells_of(surface.triangles))
    run_writer(vtkOBJWriter(), bare, path, progress)
    last = surface.triangles[-1] + 1
    check_end(path, "f " + " ".join(str(i) for i in last))
    return []


def write_stl(data, path, _crs, progress):
    """STL by VTK; as text, which holds every digit, where the 24 bits of binary STL are too few."""
    from vtkmodules.vtkIOGeometry import vtkSTLWriter

    coarse = rounding_note(coordinates_of(data))
    writer = vtkSTLWriter()
    (writer.SetFileTypeToASCII if coarse else writer.SetFileTypeToBinary)()
    run_writer(writer, data, path, progress)
    if not coarse:
        if os.path.getsize(path) != 84 + 50 * data.GetNumberOfPolys():
            raise_cut_off()
        return []
    check_end(path, "endsolid")
    return [".stl is written as text to keep large coordinates exact"]


def run_writer(writer, data, path, progress):
    writer.AddObserver("ProgressEvent", lambda caller, _: progress(caller.GetProgress()))
    with Messages() as messages:
        writer.SetFileName(path)
        writer.SetInputData(data)
        done = writer.Write()
    if messages.errors or not done:
        raise FileError(messages.errors[0] if messages.errors else "VTK's writer gave no reason")


def check_end(path, words):
    """Whether all of a text is in the file. VTK's writers do not notice a full disk."""
    with open(path, "rb") as stream:
        stream.seek(max(0, os.path.getsize(path) - 100))
        if not stream.read().rstrip(b"\r\n").decode("latin-1").endswith(words):
            raise_cut_off()


def raise_cut_off():
    raise FileError("the file is cut off; is the disk full?")


FORMATS = {
    ".vtp": in_vtk_xml(write_vtp),
    ".vtu": in_vtk_xml(write_vtu),
    ".ply": write_ply,
    ".stl": write_stl,
    ".obj": write_obj,
    ".glb": write_glb,
    ".ts": write_ts,
}
WRITE_SUFFIXES = tuple(FORMATS)
