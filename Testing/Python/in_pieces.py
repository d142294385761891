# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What tests of surfaces in pieces share: clouds, rings, and the filter that makes pieces."""

import tempfile

import numpy
from in_folder import InFolder
from meshes import ghosts_of, sorted_triangles, triangles_of
from vtkelevationsurface.clouds import make_points
from vtkelevationsurface.messages import Messages
from vtkelevationsurface.vtkElevationSurfacePieces import vtkReconstructPieces
from vtkmodules.util.numpy_support import vtk_to_numpy


def ids_of(data):
    return vtk_to_numpy(data.GetPointData().GetGlobalIds())


def all_triangles(parts):
    """The triangles of pieces, by global ids."""
    return sorted_triangles(numpy.concatenate([ids_of(part)[triangles_of(part)] for part in parts]))


def clouds():
    """{name: (n, 3)} of every kind, in no order, with duplicates and what is not finite."""
    rng = numpy.random.default_rng(7)
    node = numpy.stack(numpy.meshgrid(numpy.arange(60.0), numpy.arange(50.0)), -1).reshape(-1, 2)
    node = node[rng.permutation(len(node))[:2400]]
    along = rng.random(2000) * 900.0
    tracks = numpy.column_stack((numpy.repeat(numpy.arange(20) * 50.0, 100), along))
    found = {
        "random": rng.random((3000, 2)) * 1000.0 + 4e5,
        "lattice": node @ numpy.array([[3.0, 0.5], [-0.25, 2.0]]) + (4e5, 5e6),
        "clustered": rng.normal(size=(3000, 2)) ** 5,
        "tracks": tracks,
        "few": rng.random((5, 2)),
        "almost a lattice": numpy.vstack((node, node + (0.3, 0.2))) * 25.0,
    }
    for name, xy in found.items():
        if len(xy) > 5:
            xy[-40:] = xy[:40]
        found[name] = numpy.column_stack((xy, rng.integers(0, 100, len(xy)) * 0.5))
        if len(xy) > 5:
            found[name][rng.integers(0, len(xy), 30), rng.integers(0, 3, 30)] = numpy.nan
    return found


def star(centre, radius, points=240):
    """A closed ring with waves, as (n, 3) array."""
    turn = numpy.linspace(0.0, 2 * numpy.pi, points + 1)
    reach = radius * (1.0 + 0.2 * numpy.sin(7 * turn))
    ring = numpy.column_stack((reach * numpy.cos(turn), reach * numpy.sin(turn), 0 * turn))
    ring[-1] = ring[0]
    return ring + (*centre, 0.0)


def coast_and_lakes(points):
    """A coast, and lakes of many sizes that cross the cells of pieces."""
    points = points[numpy.isfinite(points).all(axis=1)]
    middle, extent = points.mean(axis=0)[:2], numpy.ptp(points[:, :2], axis=0).min()
    lakes = ((0.0, 0.0, 0.1), (0.2, 0.05, 0.04), (-0.2, 0.1, 0.06), (0.05, -0.2, 0.02), (0.0, 0.2, 0.05))
    return [star(middle, 0.38 * extent)] + [
        star(middle + (x * extent, y * extent), radius * extent, int(20 + 200 * radius))
        for x, y, radius in lakes]


class WithFilter(InFolder):
    """What tests of the filter share."""

    def empty_folder(self):
        return tempfile.mkdtemp(dir=self.folder)

    def source(self, points, at_once=900, **properties):
        source = vtkReconstructPieces()
        source.SetFolder(self.empty_folder())
        for name, value in properties.items():
            getattr(source.GetDelaunay(), "Set" + name)(value)
        for first in range(0, len(points), at_once):
            self.assertTrue(source.AddPoints(make_points(points[first : first + at_once])))
        return source

    def parts(self, source, count):
        result = []
        for i in range(count):
            source.UpdatePiece(i, count, 0)
            part = source.GetOutput().NewInstance()
            part.ShallowCopy(source.GetOutput())
            if part.GetNumberOfPoints():
                result.append(part)
        return result

    def assert_one_owner(self, parts, given, new):
        """Each point is one piece's own; new ones have ids after those given, and one place each."""
        own = numpy.concatenate([ids_of(part)[~ghosts_of(part)] for part in parts])
        numpy.testing.assert_array_equal(numpy.sort(own), numpy.arange(given + new))
        places = {}
        for part in parts:
            here = vtk_to_numpy(part.GetPoints().GetData())
            for number, place in zip(ids_of(part).tolist(), here.tolist()):
                if number >= given:
                    self.assertEqual(places.setdefault(number, place), place)

    def errors_of(self, source, work):
        with Messages(source, source.GetExecutive()) as messages:
            work()
        return messages.errors
