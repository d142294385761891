# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""How the holes of a surface were treated, for the report."""

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from .clouds import coordinates_of, triangles_of, words_in
from .messages import counted
from .names import option
from .passes import are_edges
from .properties import INTERPOLATIONS
from .ranks import all_values, before, summed, together, total

MOST_LEVELS = 5  # of holes that are level, that have a line each


def holes_of(result):
    """The part of the report on holes."""
    report = hole_report(
        result.holes, result.bridged, result.fill, result.why_opened, result.ranks
    )
    return {**report, "open_edge_length": result.open_edge_length}


def hole_report(outlines, bridged, fill, why_opened=None, ranks=None):
    """The part of the report on holes.

    outlines    vtkPolyData, with the report of the filter as cell data
    bridged     of each outline, see BridgedVoids
    fill        the filter
    why_opened  where the length from that of the filter is from
    ranks       the controller of those that have some outlines each, or None

    found, filled  counts of holes, and of voids that triangles bridged and that were filled; a hole
                   that the boundary has cut out is found only if it is filled
    cut_out        count of those that stay open
    bridged_left   count of voids whose triangles are left as they are
    list           of each hole also "level", where that is how it was filled, and how far the highest point
                   of its rim lies above and the lowest below
    drawn_back     of filled points that would be too far beyond the surface around: their count, and by
                   how much z was drawn back at most
    """
    names = ("HoleId", "NumberOfEdges", "Perimeter", "Area", "Size", "NumberOfInsertedPoints",
             "Interpolation", "NumberOfPointsDrawnBack", "LargestDrawBack", "Level",
             "RimAboveLevel", "RimBelowLevel")
    columns = [column_of(outlines, name).tolist() for name in names]
    statuses = words_in(outlines.GetCellData(), "StatusName")
    rows = zip(*columns, statuses, bridged.tolist(), *hole_places(outlines))
    rows = together(ranks, lambda: list(rows))
    holes = [
        {
            "hole": hole,
            "status": status,
            "bridged": bridged,
            "edges": edges,
            "perimeter": perimeter,
            "area": area,
            "size": size,
            "centre": centre,
            "box": box,
            "inserted_points": inserted,
            "interpolation": INTERPOLATIONS[way] if inserted else None,
            "points_drawn_back": drawn,
            "largest_draw_back": most,
            "level": level if level == level else None,
            "rim_above_level": above if above == above else None,
            "rim_below_level": below if below == below else None,
        }
        for (hole, edges, perimeter, area, size, inserted, way, drawn, most, level, above, below,
             status, bridged, centre, box) in rows
    ]
    by_status = {}
    for hole in holes:
        by_status[hole["status"]] = by_status.get(hole["status"], 0) + 1
    cut_out = by_status.get("cut out", 0)
    found = sum(not hole["bridged"] or hole["status"] == "replaced" for hole in holes) - cut_out
    return {
        "open_edge_length": fill.GetOpenEdgeLength(),
        "open_edge_length_is": why_opened,
        "found": found,
        "filled": by_status.get("filled", 0) + by_status.get("replaced", 0),
        "cut_out": cut_out,
        "bridged_left": len(holes) - found - cut_out,
        "by_status": by_status,
        "inserted_points": sum(hole["inserted_points"] for hole in holes),
        "drawn_back": {
            "points": sum(hole["points_drawn_back"] for hole in holes),
            "most": max((hole["largest_draw_back"] for hole in holes), default=0.0),
        },
        "list": holes,
    }


def column_of(outlines, name):
    """The values of the filter's report on holes; none on a rank that has no outline."""
    column = outlines.GetCellData().GetArray(name)
    return vtk_to_numpy(column) if column else numpy.zeros(0, dtype="i8")


def hole_counts(ranks, result):
    """(found, filled) of holes. A void that stays bridged by triangles is not a hole; nor is one that
    the boundary has cut out and that stays open."""
    status = column_of(result.holes, "Status")
    left = total(ranks, numpy.count_nonzero((result.bridged & (status != 4)) | (status == 5)))
    return result.fill.GetNumberOfHoles() - left, result.fill.GetNumberOfFilledHoles()


class BridgedVoids:
    """Which outlines are of voids that triangles bridge, or did until they were filled.

    A hole is on the left of its outline. Where a triangle is there, on any rank, it bridges a void.

    outlines  those that this rank has, of the holes of all
    """

    def __init__(self, outlines, ranks=None):
        self.ranks, self.status = ranks, column_of(outlines, "Status")
        self.left = numpy.flatnonzero((self.status != 0) & (self.status != 4))
        lines = outlines.GetLines()
        starts = vtk_to_numpy(lines.GetOffsetsArray())[self.left]
        ids, places = vtk_to_numpy(lines.GetConnectivityArray()), coordinates_of(outlines)[:, :2]
        ends = places[numpy.stack((ids[starts], ids[starts + 1]), 1)] if len(self.left) else ()
        self.edges = all_values(ranks, numpy.ravel(ends), "f8").reshape(-1, 4)
        self.are_there = numpy.zeros(len(self.edges))

    def see(self, surface):
        """Takes the triangles of this rank, or some of them."""
        self.are_there += are_edges(coordinates_of(surface), triangles_of(surface), self.edges)

    def find(self):
        """(n,) bool of the outlines of this rank, once all have seen all triangles."""
        bridged, own = self.status == 4, before(self.ranks, len(self.left))
        found = summed(self.ranks, self.are_there)[own : own + len(self.left)]
        bridged[self.left] = found > 0
        return bridged


def hole_places(lines):
    """Of each line's box in x,y: [its centres (x, y); its corners ((x, y) lowest, (x, y) highest)]."""
    if lines.GetNumberOfLines() == 0:
        return [[], []]
    cells = lines.GetLines()
    xy = coordinates_of(lines)[:, :2]
    xy = xy[vtk_to_numpy(cells.GetConnectivityArray())]
    starts = vtk_to_numpy(cells.GetOffsetsArray())[:-1]
    low = numpy.minimum.reduceat(xy, starts, axis=0)
    high = numpy.maximum.reduceat(xy, starts, axis=0)
    boxes = numpy.stack((low, high), axis=1)
    return [boxes.mean(axis=1).tolist(), boxes.tolist()]


def hole_lines(holes, line):
    """The lines on how the holes were treated."""
    line(
        "holes",
        f"{holes['found']:,} found, {holes['filled']:,} filled with "
        f"{counted(holes['inserted_points'], 'point')}",
    )
    count = holes["by_status"].get("replaced", 0)
    if count:
        line("", f"{count:,} of them were bridged by triangles")
        line(
            "",
            f"gaps wider than {holes['open_edge_length']:.4g} are filled "
            f"({holes['open_edge_length_is']}); see {option('open_edge_length')}",
        )
    drawn = holes["drawn_back"]
    if drawn["points"]:
        words = counted(drawn["points"], "filled point")
        line("", f"{words} drawn back, by up to {drawn['most']:.4g}: beyond the heights around")
    water = [hole for hole in holes["list"] if hole["level"] is not None]
    for hole in water[:MOST_LEVELS]:
        above, below = hole["rim_above_level"], hole["rim_below_level"]
        where = f"up to {above:.4g} above and {below:.4g} below"
        if above < 0 or below < 0:  # the level is that of an area
            where = f"{-above:.4g} to {below:.4g} below" if above < 0 else f"{-below:.4g} to {above:.4g} above"
        line("", f"hole {hole['hole']} level at {hole['level']:.6g}: its rim lies {where}")
    if len(water) > MOST_LEVELS:
        line("", f"{len(water) - MOST_LEVELS:,} more level; see the report as JSON")
    if holes["cut_out"]:
        line("", f"{holes['cut_out']:,} cut out by the boundary stay open; see {option('fill_cut_outs')}")
    for status in holes["by_status"]:
        for bridged, words in (
            (False, f"not filled, {status}: hole"),
            (True, f"bridged by long triangles and left as they are, {status}: void"),
        ):
            listed = [h for h in holes["list"] if (h["status"], h["bridged"]) == (status, bridged)]
            if listed and status not in ("filled", "replaced", "cut out"):
                line("", f"{len(listed):,} {words} {', '.join(map(size_of, listed[:5]))}"
                     f"{', ...' if len(listed) > 5 else ''}")


def size_of(hole):
    """Number and size of a hole that is over a limit."""
    if hole["status"] == "too many edges":
        return f"{hole['hole']} ({counted(hole['edges'], 'edge')})"
    return f"{hole['hole']} (size {hole['size']:.4g})"
