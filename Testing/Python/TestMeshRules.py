# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""That mesh_rules.py finds each rule broken which it knows, and nothing in a mesh that keeps them."""
import os
import sys
import unittest

import numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from meshes import array_of, cells_of, cloud  # noqa: E402
from mesh_rules import findings, in_circle, border_edge_count, orientation  # noqa: E402

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
ALL = {"delaunay": True, "convex_hull": True, "all_points": True}


def mesh(places, polygons, unused=()):
    data = cloud(numpy.column_stack((numpy.array(places, float), numpy.zeros(len(places)))))
    data.SetPolys(cells_of(polygons))
    if unused:
        data.GetFieldData().AddArray(array_of(numpy.array(unused, "i8"), "UnusedPointIds"))
    return data


class TestMeshRules(unittest.TestCase):
    def expect(self, words, places, polygons, unused=(), **rules):
        found = findings(mesh(places, polygons, unused), **rules)
        self.assertEqual([line for line in found if words not in line], [])
        self.assertNotEqual(found, [])

    def test_a_square_keeps_all_rules(self):
        self.assertEqual(findings(mesh(SQUARE, [(0, 1, 2), (0, 2, 3)]), **ALL), [])
        self.assertEqual(border_edge_count(mesh(SQUARE, [(0, 1, 2), (0, 2, 3)])), 4)
        self.assertEqual(findings(vtkPolyData()), [])
        parts = [mesh(SQUARE, [corners]) for corners in ((0, 1, 2), (0, 2, 3))]
        self.assertEqual(findings(*parts, **ALL), [])

    def test_triangles(self):
        self.expect("not a triangle", SQUARE, [(0, 1, 2, 3)])
        self.expect("has the corners", SQUARE, [(0, 1, 4)])
        self.expect("has the corners", SQUARE, [(0, -1, 2)])
        self.expect("has the corners", SQUARE, [(0, 1, 1)])
        self.expect("is clockwise", SQUARE, [(0, 1, 2), (0, 3, 2)])
        self.expect("is flat", SQUARE + [(2, 0)], [(0, 1, 4)])

    def test_edges_of_three_triangles(self):
        self.expect("run along edge 0-1", SQUARE + [(0.5, 2)], [(0, 1, 2), (0, 1, 4)])

    def test_empty_circles_and_ties(self):
        kite = [(0, 0), (1, -1), (2, 0), (1, 2)]
        self.expect("inside the circle", kite, [(0, 1, 3), (1, 2, 3)], delaunay=True)
        self.assertEqual(findings(mesh(kite, [(0, 1, 3), (1, 2, 3)])), [])
        self.assertEqual(findings(mesh(kite, [(0, 1, 2), (0, 2, 3)]), delaunay=True), [])
        self.expect("lowest vertex", SQUARE, [(0, 1, 3), (1, 2, 3)], delaunay=True)

    def test_the_hull(self):
        bent = SQUARE + [(0.75, 0.5)]
        triangles = [(0, 1, 4), (0, 4, 3), (4, 2, 3)]
        self.expect("turns inwards at point 4", bent, triangles, convex_hull=True)
        self.assertEqual(findings(mesh(bent, triangles)), [])
        apart = SQUARE + [(3, 0), (4, 0), (3, 1)]
        self.expect("not one loop", apart, [(0, 1, 2), (0, 2, 3), (4, 5, 6)], convex_hull=True)
        pinched = [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)]
        self.expect("not one loop", pinched, [(0, 1, 2), (0, 3, 4)], convex_hull=True)

    def test_points(self):
        triangles = [(0, 1, 2), (0, 2, 3)]
        self.expect("point 4 is not a vertex", SQUARE + [(9, 9)], triangles, all_points=True)
        self.expect("point 3 is listed", SQUARE, triangles, unused=[3], all_points=True)
        self.assertEqual(findings(mesh(SQUARE + [(9, 9)], triangles, unused=[4]), **ALL), [])

    def test_places_covered_twice(self):
        # One in the other, two that cross, the same at other points, and a strip around a point.
        inner, crossing = [(0.6, 0.1), (0.9, 0.1), (0.9, 0.4)], [(0.5, -0.5), (0.8, -0.5), (0.8, 0.5)]
        for other in (inner, crossing, SQUARE[:3]):
            self.expect("lies over", SQUARE[:3] + other, [(0, 1, 2), (3, 4, 5)])
        angle = numpy.linspace(0.0, 2.2 * numpy.pi, 23)
        circle = numpy.column_stack([numpy.cos(angle), numpy.sin(angle)])
        strip = [t for i in range(22) for t in ((i, i + 1, i + 24), (i, i + 24, i + 23))]
        self.expect("lies over", numpy.vstack([2 * circle, circle]), strip)
        # Those that touch from outside do not.
        self.assertEqual(findings(mesh(SQUARE + [(1, 0.2), (2, 0.2), (2, 0.8), (1, 0.8)],
                                       [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])), [])

    def test_signs_are_exact(self):
        # One number up or down from a place on the line, and on the circle.
        for y, side in ((0.5, 0), (numpy.nextafter(0.5, 1), 1), (numpy.nextafter(0.5, 0), -1)):
            a, b, c = (numpy.array([p]) for p in ((12.0, 12.0), (24.0, 24.0), (0.5, y)))
            self.assertEqual(orientation(a, b, c), side)
            a, b, c, d = (numpy.array([p]) for p in ((0.5, 0.5), (3.5, 3.5), (0.5, 3.5), (3.5, y)))
            self.assertEqual(in_circle(a, b, c, d), side)


if __name__ == "__main__":
    unittest.main(argv=["TestMeshRules"])
