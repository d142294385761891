# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""PyVista finds a method of its meshes, readers and a writer by the package's entry points.

Where PyVista 0.48 or newer is not installed, a stand-in takes its place, which has what the entry points use.
"""

import os
import sys
import tempfile
import types
import unittest
from importlib.metadata import entry_points, version

import numpy
import vtkelevationsurface
from vtkelevationsurface.clouds import make_points
from vtkelevationsurface.reading.formats import all_suffixes
from vtkelevationsurface.writing import WRITE_SUFFIXES
from vtkmodules.vtkCommonDataModel import vtkPolyData


def stand_in():
    """A module like PyVista: meshes are VTK's own, and accessors are kept by name."""
    module = types.ModuleType("pyvista")
    module.DataSet, module.accessors, module.wrap = vtkPolyData, {}, lambda data: data

    def register(name, target):
        def keep(accessor):
            module.accessors[name] = (accessor, target)
            return accessor

        return keep

    module.register_dataset_accessor = register
    registry = types.ModuleType("pyvista.core.utilities.reader_registry")
    registry.LocalFileRequiredError = type("LocalFileRequiredError", (Exception,), {})
    for name in ("pyvista", "pyvista.core", "pyvista.core.utilities"):
        sys.modules[name] = module
    sys.modules[registry.__name__] = registry
    return module


try:
    import pyvista
    from pyvista import register_dataset_accessor  # noqa: F401

    IS_INSTALLED = True
except ImportError:
    pyvista = stand_in()
    IS_INSTALLED = False


def points_of(group):
    """{name: entry point} of this package."""
    found = entry_points()
    of_group = found.select(group=group) if hasattr(found, "select") else found.get(group, ())
    return {one.name: one for one in of_group if one.value.startswith("vtkelevationsurface.")}


class PyVista(unittest.TestCase):
    def setUp(self):
        x, y = numpy.meshgrid(numpy.arange(5.0), numpy.arange(5.0))
        self.points = make_points(numpy.column_stack((x.ravel(), y.ravel(), x.ravel() * 0.1)))

    def test_a_mesh_has_the_surface_of_its_points(self):
        (entry,) = points_of("pyvista.accessors").values()
        self.assertEqual(entry.name, "elevation_surface")
        module = entry.load()
        surface = module.ElevationSurface(pyvista.wrap(self.points)).reconstruct(gap_tolerance=3)
        self.assertEqual(surface.GetNumberOfCells(), 32)
        if hasattr(pyvista, "accessors"):
            self.assertEqual(pyvista.accessors, {entry.name: (module.ElevationSurface, pyvista.DataSet)})
        else:
            self.assertEqual(pyvista.wrap(self.points).elevation_surface.reconstruct().n_cells, 32)

    def test_readers_read_the_points_of_files(self):
        readers = points_of("pyvista.readers")
        self.assertIn(".zmap", readers)
        self.assertLessEqual(set(readers), set(all_suffixes().split()))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "points.xyz")
            with open(path, "w", encoding="utf-8") as stream:
                stream.write("0 0 1\n1 0 2\n0 1 3\n")
            for entry in readers.values():
                self.assertEqual(entry.load()(path).GetNumberOfPoints(), 3, entry.name)
        with self.assertRaisesRegex(Exception, "^$") as raised:
            readers[".zmap"].load()("https://example.org/horizon.zmap")
        self.assertEqual(type(raised.exception).__name__, "LocalFileRequiredError")

    def test_the_writer_writes_triangles(self):
        writers = points_of("pyvista.writers")
        self.assertEqual(set(writers), {".ts"})
        self.assertLessEqual(set(writers), set(WRITE_SUFFIXES))
        surface = vtkelevationsurface.reconstruct(self.points).surface
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "surface.ts")
            writers[".ts"].load()(pyvista.wrap(surface), path)
            self.assertEqual(vtkelevationsurface.read(path).points.GetNumberOfPoints(), 25)

    @unittest.skipUnless(IS_INSTALLED, "PyVista 0.48 or newer is not installed")
    def test_pyvista_finds_them_by_itself(self):
        mesh = pyvista.wrap(self.points)
        surface = mesh.elevation_surface.reconstruct(gap_tolerance=3)
        self.assertIsInstance(surface, pyvista.PolyData)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "surface.ts")
            surface.save(path)
            self.assertEqual(pyvista.read(path).n_points, 25)
            path = os.path.join(folder, "horizon.zmap")
            with open(path, "w", encoding="utf-8") as stream:
                stream.write("@h, GRID, 3\n15, 1e30, , 7, 1\n2, 3, 0, 2, 0, 1\n0.0, 0.0, 0.0\n@\n1 2\n3 4\n5 6\n")
            self.assertEqual(sorted(pyvista.read(path).points[:, 2]), [1, 2, 3, 4, 5, 6])

    def test_the_package_says_its_version_and_what_it_offers(self):
        self.assertEqual(version("vtkelevationsurface"), vtkelevationsurface.__version__)
        for name in vtkelevationsurface.__all__:
            self.assertTrue(hasattr(vtkelevationsurface, name), name)
        folder = os.path.dirname(vtkelevationsurface.__file__)
        self.assertTrue(os.path.exists(os.path.join(folder, "py.typed")))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
