# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The outline of a surface that is made of few of its points: that of all points, simplified.

[Douglas & Peucker 1973] Algorithms for the reduction of the number of points required to represent
a digitized line or its caricature, The Canadian Cartographer 10(2).
"""

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkCellArray

from .clouds import cells_of, coordinates_of, id_lists, joined, make_points, moved, some_points, triangles_of
from .messages import Messages
from .passes import corner_flags
from .spreading import WITHIN_ERROR
from .vtkElevationSurface import vtkGridDelaunay2D, vtkTrimOutwardTriangles

ON_OUTLINE = 0.01  # spacings: points as near to an outline that was found are not outside of it
ON_BORDER = 1e-9  # of the size of a border along a given boundary, likewise


def border_of(surface):
    """The edges of one triangle only, as lines, and their points with z and point data."""
    triangles = triangles_of(surface)
    edges = numpy.vstack((triangles[:, :2], triangles[:, 1:], triangles[:, ::2]))
    edges = numpy.sort(edges, axis=1)
    edges, counts = numpy.unique(edges, axis=0, return_counts=True)
    edges = edges[counts == 1]
    keep, places = numpy.unique(edges, return_inverse=True)
    border = some_points(surface, keep)
    border.SetLines(cells_of(places.reshape(-1, 2)))
    return border


def rings_of(outline):
    """[(n,) ids] of the points of closed lines, each once."""
    return [ids[:-1] for ids in id_lists(outline.GetLines())]


def with_rings(outline, rings):
    """Rings of ids of an outline's points as closed lines, with these points and their data."""
    keep = numpy.unique(numpy.concatenate(rings))
    result, cells = some_points(outline, keep), vtkCellArray()
    for ring in rings:
        ids = numpy.searchsorted(keep, numpy.append(ring, ring[0])).tolist()
        cells.InsertNextCell(len(ids), ids)
    result.SetLines(cells)
    return result


def places_of(points):
    """(n,) complex numbers: x,y of points, to look for equal ones."""
    return numpy.ascontiguousarray(points[:, :2], "f8").view("c16")[:, 0]


def in_use(outline, surface):
    """An outline along edges of a surface, without the points that the surface has left out of it."""
    fields = surface.GetFieldData()
    ids, why = (vtk_to_numpy(fields.GetArray("UnusedPoint" + name)) for name in ("Ids", "Reasons"))
    xy, surface_xy = (places_of(coordinates_of(p)) for p in (outline, surface))
    is_used = ~numpy.isin(xy, surface_xy[ids[why == WITHIN_ERROR]])
    return with_rings(outline, [ring[is_used[ring]] for ring in rings_of(outline)])


def along_edges(outline, surface):
    """An outline through the vertices of a surface that lie on it: where faults cross it."""
    xyz = coordinates_of(outline).astype("f8")
    vertices = corners_in_order(surface)
    vertices = vertices[~numpy.isin(places_of(vertices), places_of(xyz))]
    reach = max(ON_BORDER * outline.GetLength(), 16 * numpy.spacing(abs(xyz[:, :2]).max()))
    added, lines = [xyz], vtkCellArray()
    count = len(xyz)
    for ends in (ids.tolist() for ids in id_lists(outline.GetLines())):
        through = ends[:1]
        for p, q in zip(ends[:-1], ends[1:]):
            on_it = between(xyz[p], xyz[q], vertices, reach)
            added.append(on_it)
            through += [*range(count, count + len(on_it)), q]
            count += len(on_it)
        lines.InsertNextCell(len(through), through)
    result = make_points(numpy.concatenate(added))
    result.SetLines(lines)
    return result


def within(lines, outline, reach):
    """Lines without what is outside of an outline: their edges, cut at the points of the outline on them, but
    for those that are outside as a whole. One that crosses the outline between its points stays."""
    own, corners = (coordinates_of(data).astype("f8") for data in (lines, outline))
    order = numpy.argsort(corners[:, 1], kind="stable")
    numbered = numpy.column_stack((corners[order, :2], len(own) + order))
    whole, edges = edge_ids(lines), []
    for p, q in whole.tolist():
        through = [p, *between(own[p], own[q], numbered, reach)[:, 2].astype("i8").tolist(), q]
        edges += zip(through[:-1], through[1:])
    edges = numpy.array(edges, dtype="i8").reshape(-1, 2)
    ends = numpy.concatenate((own, corners))[edges][:, :, :2]
    is_outside = outside_of(outline, ends.mean(axis=1), reach)
    is_outside[is_outside] = ~are_crossing(ends[is_outside], *edges_of(outline))
    if len(edges) == len(whole) and not is_outside.any():
        return lines
    result = joined([some_points(data, numpy.arange(data.GetNumberOfPoints())) for data in (lines, outline)])
    result.SetLines(cells_of(edges[~is_outside]))
    return result


def elevated(lines, surface):
    """Lines whose points without z (NaN) get that of the vertex of a surface there, if there is one."""
    xyz = coordinates_of(lines).astype("f8")
    soft = numpy.flatnonzero(numpy.isnan(xyz[:, 2]))
    if not len(soft):
        return lines
    vertices = coordinates_of(surface)[numpy.unique(triangles_of(surface))]
    there = dict(zip(places_of(vertices).tolist(), vertices[:, 2].tolist()))
    xyz[soft, 2] = [there.get(place, numpy.nan) for place in places_of(xyz[soft]).tolist()]
    return moved(lines, xyz)


def are_crossing(edges, p, q):
    """(n,) of bool: which edges, (n, 2, 2), cross one of those from p to q, (m, 2) each."""

    def side(a, b, c):
        (ux, uy), (vx, vy) = (b - a).T, (c - a).T
        return numpy.sign(ux * vy - uy * vx)

    crossing = [
        (side(a, b, p) * side(a, b, q) < 0) & (side(p, q, a) * side(p, q, b) < 0) for a, b in edges
    ]
    return numpy.array([one.any() for one in crossing], dtype=bool)


def corners_in_order(surface):
    """(n, 3) the points that triangles of a surface use, by increasing y."""
    xyz = coordinates_of(surface)
    xyz = xyz[corner_flags(triangles_of(surface), len(xyz))].astype("f8")
    return xyz[numpy.argsort(xyz[:, 1], kind="stable")]


def between(p, q, points, reach):
    """The points, of some by increasing y, that lie on an edge, from its begin to its end."""
    low, high = sorted((p[1], q[1]))
    rows = slice(*numpy.searchsorted(points[:, 1], (low - reach, high + reach)))
    (dx, dy), length = (q - p)[:2], numpy.hypot(*(q - p)[:2])
    rx, ry = (points[rows] - p)[:, :2].T
    along = (dx * rx + dy * ry) / length
    is_on = (abs(dx * ry - dy * rx) <= reach * length) & (along > 0) & (along < length)
    is_on &= (points[rows, :2] != q[:2]).any(axis=1)  # which may be short of length by rounding
    return points[rows][is_on][numpy.argsort(along[is_on])]


def spacing_of(outline, lattice):
    """The distance of neighbouring points along an outline."""
    if lattice:
        return min(lattice["lengths"])
    p, q = edges_of(outline)
    return float(numpy.median(numpy.hypot(*(q - p).T)))


def simplified(outline, spacing, error):
    """An outline of fewer points: the others are within half a spacing in x,y, and an error in z.

    Points where rings touch stay. So does the whole outline where rings would cross.
    """
    xyz = coordinates_of(outline).astype("f8")
    rings = rings_of(outline)
    ids, counts = numpy.unique(numpy.concatenate(rings), return_counts=True)
    touching = ids[counts > 1]
    fewer = [
        ring[kept_points(xyz[ring], numpy.isin(ring, touching), 0.5 * spacing, error)] for ring in rings
    ]
    result = with_rings(outline, fewer)
    return result if is_sound(result) else with_rings(outline, rings)


def kept_points(ring, fixed, reach, error):
    """(n,) of bool: the points of a ring that stay [Douglas & Peucker 1973].

    fixed  (n,) of bool: those that have to
    """
    ring = ring - ring[0]
    first = int(numpy.argmax(numpy.hypot(ring[:, 0], ring[:, 1])))
    ring, kept = numpy.roll(ring, -first, axis=0), numpy.roll(fixed, -first)
    kept[0] = kept[numpy.argmax(numpy.hypot(*(ring - ring[0])[:, :2].T))] = True
    closed, kept = numpy.vstack((ring, ring[:1])), numpy.append(kept, True)
    ends = numpy.flatnonzero(kept).tolist()
    parts = list(zip(ends[:-1], ends[1:]))
    while parts:
        i, j = parts.pop()
        if j - i < 2:
            continue
        aside, above = away_from(closed[i], closed[j], closed[i + 1 : j])
        away = numpy.maximum(aside / reach, above / error)
        worst = int(numpy.argmax(away))
        if away[worst] > 1.0:
            kept[i + 1 + worst] = True
            parts += [(i, i + 1 + worst), (i + 1 + worst, j)]
    kept = kept[:-1]
    if numpy.count_nonzero(kept) < 3:
        i, j = numpy.flatnonzero(kept)
        kept[numpy.argmax(away_from(ring[i], ring[j], ring)[0])] = True
    return numpy.roll(kept, first)


def away_from(p, q, points):
    """((n,), (n,)): how far points are from a segment in x,y, and in z from its nearest place."""
    step = q - p
    square = step[:2] @ step[:2]
    along = numpy.clip((points[:, :2] - p[:2]) @ step[:2] / square, 0, 1) if square else 0.0
    off = points - p - numpy.multiply.outer(along * numpy.ones(len(points)), step)
    return numpy.hypot(off[:, 0], off[:, 1]), numpy.abs(off[:, 2])


def is_sound(rings):
    """Whether rings cross neither themselves nor each other: a mesh can be trimmed along them."""
    errors, crossings, triangles = trial(rings, are_edges=True)
    return not errors and not crossings and triangles > 0


def trial(rings, are_edges=False):
    """Triangulates the points of rings in x,y, with these as edges or without, and trims along them.

    Returns (errors of the filters, how often rings cross, the number of triangles).
    """
    xyz = coordinates_of(rings).astype("f8")
    xyz[:, 2] = 0.0  # z may be missing (NaN)
    flat = moved(rings, xyz)
    mesh = vtkGridDelaunay2D()
    mesh.SetInputData(flat)
    if are_edges:
        mesh.SetSourceData(flat)
    trim = vtkTrimOutwardTriangles()
    trim.SetInputConnection(mesh.GetOutputPort())
    trim.SetBoundaryData(flat)
    steps = (mesh, mesh.GetExecutive(), trim, trim.GetExecutive())
    with Messages(*steps) as messages:
        trim.Update()
    triangles = (trim if are_edges else mesh).GetOutput().GetNumberOfPolys()
    return messages.errors, mesh.GetNumberOfConstraintCrossings(), triangles


def edges_of(lines):
    """((n, 2), (n, 2)): x,y of both ends of the edges of lines."""
    xy = coordinates_of(lines)[:, :2].astype("f8")
    begins, ends = edge_ids(lines).T
    return xy[begins], xy[ends]


def edge_ids(lines):
    """(n, 2) ids of both ends of the edges of lines and polygons."""
    edges = []
    for cells, are_closed in ((lines.GetLines(), False), (lines.GetPolys(), True)):
        ids, offsets = (vtk_to_numpy(a) for a in (cells.GetConnectivityArray(), cells.GetOffsetsArray()))
        has_points = numpy.diff(offsets) > 0
        first, last = offsets[:-1][has_points], offsets[1:][has_points] - 1
        following, is_edge = numpy.roll(ids, -1), numpy.ones(len(ids), dtype=bool)
        following[last], is_edge[last] = ids[first], are_closed
        edges.append(numpy.column_stack((ids, following))[is_edge].astype("i8"))
    return numpy.concatenate(edges)


def outside_of(lines, points, reach):
    """(n,) of bool: the points that are outside of rings or border edges, by more than a length."""
    x, y = points[:, 0].astype("f8"), points[:, 1].astype("f8")
    order = numpy.argsort(y, kind="stable")
    x, y = x[order], y[order]
    inside, near = (numpy.zeros(len(y), dtype=bool) for _ in range(2))
    p, q = edges_of(lines)
    first = numpy.searchsorted(y, numpy.minimum(p[:, 1], q[:, 1]) - reach, "left")
    last = numpy.searchsorted(y, numpy.maximum(p[:, 1], q[:, 1]) + reach, "right")
    steps, lengths = q - p, numpy.hypot(*(q - p).T)
    for edge in numpy.flatnonzero(last > first).tolist():
        rows = slice(first[edge], last[edge])
        (px, py), (dx, dy), length = p[edge], steps[edge], lengths[edge]
        rx, ry = x[rows] - px, y[rows] - py
        side, along = dx * ry - dy * rx, dx * rx + dy * ry
        passes = (y[rows] >= py) != (y[rows] >= q[edge, 1])
        inside[rows] ^= passes & (side > 0 if dy > 0 else side < 0)
        near[rows] |= (
            (numpy.abs(side) <= reach * length)
            & (along >= -reach * length)
            & (along <= (length + reach) * length)
        )
    result = numpy.empty(len(y), dtype=bool)
    result[order] = ~(inside | near)
    return result
