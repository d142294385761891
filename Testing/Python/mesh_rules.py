# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The rules of Filters/Kernel/Mesh/Validate.h, asked of a vtkPolyData: what Testing/Cxx/MeshRules.h is in C++.

For the tests in Python and in ParaView. Signs are exact; a place covered twice is found by comparing
triangles, not borders as Validate does.
"""
from fractions import Fraction

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy


def _sign(value, bound, exact):
    """Signs of values with an error of up to bound; exact(i) is the value where that is not an answer."""
    sign = numpy.sign(value).astype(int)
    # Without a bound the value is zero, as all its terms are.
    for i in numpy.flatnonzero((abs(value) <= bound) & (bound > 0.0)):
        number = exact(i)
        sign[i] = (number > 0) - (number < 0)
    return sign


def orientation(a, b, c):
    """On which side of the line from a to b each point c is: 1 left, 0 on it, -1 right."""
    a, b, c = numpy.broadcast_arrays(a, b, c)
    (ax, ay), (bx, by) = (a - c).T, (b - c).T
    left, right = ax * by, ay * bx

    def exact(i):
        (px, py), (qx, qy), (rx, ry) = ((Fraction(v) for v in p[i].tolist()) for p in (a, b, c))
        return (px - rx) * (qy - ry) - (py - ry) * (qx - rx)

    return _sign(left - right, 1e-15 * (abs(left) + abs(right)), exact)


def in_circle(a, b, c, d):
    """Where each point d is to the circle through a, b, c, counter-clockwise: 1 inside, 0 on it, -1 outside."""
    (ax, ay), (bx, by), (cx, cy) = (a - d).T, (b - d).T, (c - d).T
    a2, b2, c2 = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    value = a2 * (bx * cy - by * cx) + b2 * (cx * ay - cy * ax) + c2 * (ax * by - ay * bx)
    size = (a2 * (abs(bx * cy) + abs(by * cx)) + b2 * (abs(cx * ay) + abs(cy * ax)) +
            c2 * (abs(ax * by) + abs(ay * bx)))

    def exact(i):
        dx, dy = (Fraction(v) for v in d[i].tolist())
        (px, py), (qx, qy), (rx, ry) = (
            (Fraction(x) - dx, Fraction(y) - dy) for x, y in (p[i].tolist() for p in (a, b, c)))
        return ((px * px + py * py) * (qx * ry - qy * rx) + (qx * qx + qy * qy) * (rx * py - ry * px) +
                (rx * rx + ry * ry) * (px * qy - py * qx))

    return _sign(value, 4e-15 * size, exact)


def is_lower(p, q):
    """By y, then x."""
    return (p[:, 1] < q[:, 1]) | ((p[:, 1] == q[:, 1]) & (p[:, 0] < q[:, 0]))


class _Mesh:
    """Places, triangles, and half-edge 3 t + i from corner i of triangle t to the next one."""

    def __init__(self, *parts):
        points = parts[0].GetPoints()
        self.places = numpy.empty((0, 2))
        if points is not None and points.GetNumberOfPoints():
            self.places = vtk_to_numpy(points.GetData())[:, :2].astype(float)
        cells = [part.GetPolys() for part in parts if part.GetNumberOfPolys()]
        sizes = [numpy.diff(vtk_to_numpy(each.GetOffsetsArray())) for each in cells]
        self.are_triangles = all((each == 3).all() for each in sizes)
        ids = [vtk_to_numpy(each.GetConnectivityArray()).astype(int) for each in cells]
        self.triangles = (numpy.concatenate(ids).reshape(-1, 3) if ids and self.are_triangles
                          else numpy.empty((0, 3), dtype=int))

    def connect(self):
        """The half-edges and their twins, -1 at the border. Returns those that another one runs along."""
        self.origin = self.triangles.ravel()
        self.destination = numpy.roll(self.triangles, -1, axis=1).ravel()
        self.apex = numpy.roll(self.triangles, -2, axis=1).ravel()
        count = len(self.places)
        keys, twins = self.origin * count + self.destination, self.destination * count + self.origin
        order = numpy.argsort(keys, kind="stable")
        sorted_keys = keys[order]
        at = numpy.searchsorted(sorted_keys, twins)
        at[at == len(keys)] = 0
        self.twin = numpy.where(sorted_keys[at] == twins, order[at], -1) if len(keys) else keys
        return order[1:][sorted_keys[1:] == sorted_keys[:-1]]

    def edge(self, h):
        return f"edge {self.origin[h]}-{self.destination[h]}"


def _triangle_faults(mesh):
    if not mesh.are_triangles:
        yield "there is a polygon that is not a triangle"
        return
    t = mesh.triangles
    strange = ((t < 0) | (t >= len(mesh.places)) | (t == numpy.roll(t, 1, axis=1))).any(axis=1)
    for i in numpy.flatnonzero(strange):
        yield f"triangle {i} has the corners {t[i]} of {len(mesh.places)} points"
    if not strange.any():
        side = orientation(*(mesh.places[t[:, i]] for i in range(3)))
        for i in numpy.flatnonzero(side != 1):
            yield f"triangle {i} is " + ("clockwise" if side[i] else "flat")
        if (side == 1).all():
            for h in mesh.connect():
                yield f"two triangles run along {mesh.edge(h)} in the same way"


def _circle_faults(mesh):
    h = numpy.flatnonzero(mesh.twin > numpy.arange(len(mesh.twin)))
    a, b, c, d = (mesh.places[ids] for ids in (
        mesh.origin[h], mesh.destination[h], mesh.apex[h], mesh.apex[mesh.twin[h]]))
    side = in_circle(a, b, c, d)
    for i in numpy.flatnonzero(side == 1):
        yield f"beyond {mesh.edge(h[i])} a point lies inside the circle of the triangle"
    low_end = numpy.where(is_lower(a, b)[:, None], a, b)
    low_apex = numpy.where(is_lower(c, d)[:, None], c, d)
    for i in numpy.flatnonzero((side == 0) & ~is_lower(low_end, low_apex)):
        yield f"{mesh.edge(h[i])} cuts a co-circular polygon, but not from its lowest vertex"


def _hull_faults(mesh):
    border = numpy.flatnonzero(mesh.twin == -1)
    if not len(border):
        return
    following = dict(zip(mesh.origin[border], mesh.destination[border]))
    ring = [mesh.origin[border[0]]]
    while following[ring[-1]] != ring[0] and len(ring) < len(border):
        ring.append(following[ring[-1]])
    if len(set(ring)) < len(border):
        yield "the border is not one loop, the hull"
        return
    here = mesh.places[ring]
    before, after = numpy.roll(here, 1, axis=0), numpy.roll(here, -1, axis=0)
    for i in numpy.flatnonzero(orientation(before, here, after) == -1):
        yield f"the border turns inwards at point {ring[i]}"
    if (is_lower(here, before) & is_lower(here, after)).sum() != 1:
        yield "the border winds around more than once"


def _vertex_faults(mesh, surface):
    listed = surface.GetFieldData().GetArray("UnusedPointIds")
    unused = vtk_to_numpy(listed) if listed is not None and listed.GetNumberOfTuples() else []
    is_vertex = numpy.zeros(len(mesh.places), dtype=bool)
    is_vertex[mesh.triangles] = True
    is_listed = numpy.zeros(len(mesh.places), dtype=bool)
    is_listed[unused] = True
    for i in numpy.flatnonzero(is_vertex == is_listed):
        yield f"point {i} " + ("is listed as unused but is a vertex" if is_listed[i] else "is not a vertex")


def _overlap_faults(mesh):
    """Where a place is covered twice, a triangle at the border covers such a place."""
    corners = mesh.places[mesh.triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    for t in numpy.unique(numpy.flatnonzero(mesh.twin == -1) // 3):
        near = numpy.flatnonzero(((low < high[t]) & (high > low[t])).all(axis=1))
        near = near[near != t]
        # Triangles are apart when an edge of one of them has the other on its right, or on its line.
        apart = numpy.zeros(len(near), dtype=bool)
        for i in range(3):
            ours, theirs = corners[t], corners[near]
            apart |= (numpy.stack([orientation(ours[i - 1], ours[i], theirs[:, k])
                                   for k in range(3)]) <= 0).all(axis=0)
            apart |= (numpy.stack([orientation(theirs[:, i - 1], theirs[:, i], ours[k])
                                   for k in range(3)]) <= 0).all(axis=0)
        for other in near[~apart]:
            yield f"triangle {t} lies over triangle {other}"


def findings(*parts, delaunay=False, convex_hull=False, all_points=False):
    """The rules that the polygons of a surface break, one line each; none when all is well.

    The surface may be given in parts, which share their points.

    Always: triangles of points, counter-clockwise, at most two at an edge, no place covered twice.
    delaunay: empty circles, and ties cut as a fan from the lowest vertex. convex_hull: the border is the
    hull. all_points: all points are vertices, but those in UnusedPointIds of the field data.
    """
    mesh = _Mesh(*parts)
    found = list(_triangle_faults(mesh))
    if found:
        return found  # what follows presumes a mesh
    found += _circle_faults(mesh) if delaunay else []
    found += _hull_faults(mesh) if convex_hull else []
    found += _vertex_faults(mesh, parts[0]) if all_points else []
    return found + list(_overlap_faults(mesh))


def border_edge_count(surface):
    """How many edges have one triangle, in a surface without findings."""
    mesh = _Mesh(surface)
    mesh.connect()
    return int((mesh.twin == -1).sum())
