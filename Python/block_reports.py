# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The report on each block of an input, as plain values that ranks can exchange, and the report that
these make together."""

import math

import numpy
from vtkmodules.vtkCommonCore import vtkStringArray

from .clouds import RECOGNISED, words_in
from .messages import counted
from .query import holes_of
from .ranks import together, total
from .report import main_counts, report_lines

CONTENTS = "RecognisedAs"  # that with its contents, points say, and how many points there are
MOST_ERRORS = 5  # of blocks, in one message


def recognised(points, ranks=None):
    """What a reader has found out, for the report of these points: all of the file, or some.

    ranks  the controller of those that have some of the points each, or None
    """
    count = total(ranks, points.GetNumberOfPoints())
    fields = points.GetFieldData()
    words = together(ranks, lambda: [[words_in(fields, name) for name in (RECOGNISED, CONTENTS)]])
    lines, contents = next((pair for pair in words if pair[0]), ([], []))
    if lines and contents[1:] != [str(count)]:
        lines[0] += f"; this surface is of {counted(count, 'point')}"
    return lines


def block_report(surface, result, recognised_lines):
    """The report on a Surface that became a Reconstruction; recognised_lines: recognised() of its points."""
    # A panel always says which of several heights is taken, so that nobody has decided it.
    notes = result.decided + result.notes
    return {
        "place": surface.place,
        "name": surface.name,
        "warnings": notes + result.gathered,
        "shown": notes + recognised_lines,
        "rows": report_lines(result.report),
        "counts": main_counts(result),
        "sums": sums_of(result),
        "chosen": chosen_values(result),
    }


def chosen_values(result):
    """The values used for properties that may be left to be chosen: {property of the panel: value}."""
    report = result.report
    return {
        "GapTolerance": report.get("trim", {}).get("effective_gap_tolerance", 0.0),
        "OpenEdgeLength": report.get("holes", {}).get("open_edge_length", 0.0),
        "Spacing": spacing_of(result),
    }


def holes_with_points(result):
    """Of the report, those holes that got new points."""
    holes = result.report["holes"]["list"] if result.fill else ()
    return [hole for hole in holes if hole["inserted_points"]]


def patch_triangles(result, ranks):
    """How many triangles the patches with new points have. In a region of long triangles they join
    points of the input, too, so counts of new points and edges do not give their number."""
    numbers = [hole["hole"] for hole in holes_with_points(result)]
    return total(ranks, numpy.isin(holes_of(result.surface), numbers).sum())


def spacing_of(result):
    """The distance of new points: as given, that of a lattice's nodes, or that at which even triangles,
    as many as the patches have, cover the holes. 0: there are none.

    result  a Reconstruction with the attribute patch_triangles
    """
    holes = holes_with_points(result)
    if not holes:
        return 0.0
    if result.fill.GetSpacing():
        return result.fill.GetSpacing()
    if result.lattice:
        return math.sqrt(math.prod(result.lattice["lengths"]))
    area = math.fsum(hole["area"] for hole in holes)
    return math.sqrt(4 / math.sqrt(3) * area / result.patch_triangles)


def failed_block_report(surface, error):
    """The report on a Surface that could not be made."""
    return {"place": surface.place, "name": surface.name, "error": error}


def sums_of(result):
    """[(item, number, words)] of what is added up over blocks."""
    report = result.report
    sums = [
        ("points", report["points"], "read"),
        ("unused", report["points_unused"], ""),
        ("triangles", list(report["triangles"].values())[-1], ""),
    ]
    if result.trim:
        sums.append(("trimmed", report["trim"]["outward_triangles"], "outward triangles"))
    if result.fill:
        sums += [("holes", report["holes"][name], name) for name in ("found", "filled")]
    return sums


def once(reports):
    """Reports of all ranks in the order of the blocks, each block once."""
    places = {tuple(report["place"]): report for report in reversed(reports)}
    return [places[place] for place in sorted(places)]


def in_block(report, words):
    return f"{report['name']}: {words}" if report["name"] else words


def joined_errors(errors, others):
    """The errors of blocks as one message; once where it is the same in all."""
    if not others and len({report["error"] for report in errors}) == 1:
        return errors[0]["error"]
    lines = [in_block(report, report["error"]) for report in errors[:MOST_ERRORS]]
    if len(errors) > MOST_ERRORS:
        lines.append(f"And {len(errors) - MOST_ERRORS} more like these.")
    return "\n".join(lines)


def successes(reports):
    """The reports of blocks that became a surface."""
    return [report for report in reports if "error" not in report]


def all_blocks(reports):
    """[(item, text)] for all blocks together."""
    columns = zip(*(report["sums"] for report in successes(reports)))
    sums = [(*column[0][::2], sum(number for _, number, _ in column)) for column in columns]
    return [(item, f"{count:,} {words}".strip()) for item, words, count in sums]


def counts_of(reports):
    """The main figures, as a list of words."""
    made = successes(reports)
    if len(made) == 1:
        return made[0]["counts"]
    rows = [row for row in all_blocks(made)[:3] if row[0] != "unused"]
    return [counted(len(made), "block"), *(f"{text.split()[0]} {item}" for item, text in rows)]


def report_rows(reports):
    """[(block, item, value)] of the report; none where no block became a surface."""
    made = successes(reports)
    rows = [("all blocks", *row) for row in all_blocks(made)] if len(made) > 1 else []
    for report in reports if made else ():
        for item, value in report.get("rows") or [("error", report["error"])]:
            rows.append((report["name"], item, value))
    return rows


def report_text(reports):
    """The report, one line each."""
    lines, last = [], ""
    for block, item, value in report_rows(reports):
        if block != last:
            lines.append(f"{block}:")
            last = block
        lines.append(f"{item:<10} {value}")
    return "\n".join(lines)


def lines_to_show(reports):
    """The lines of the report without those already shown: warnings, and what a reader found out."""
    shown = {line for report in reports for line in report.get("shown", ())}
    return [
        f"{block}: {item:<10} {value}" if block else f"{item:<10} {value}"
        for block, item, value in report_rows(reports)
        if item != "error" and (item != "note" or value not in shown)
    ]


def fill_table(table, rows):
    """Writes rows of (block, item, value); the block is a column where there are several."""
    names = ["Block", "Item", "Value"]
    first = 0 if any(block for block, _, _ in rows) else 1
    columns = [vtkStringArray() for _ in names]
    item = ""
    for block, name, value in rows:
        item = name or item
        for column, word in zip(columns, (block, item, value)):
            column.InsertNextValue(word)
    for name, column in list(zip(names, columns))[first:]:
        column.SetName(name)
        table.AddColumn(column)
