# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What became of each block of an input: accounts, which are plain values that ranks can exchange,
and the report that they make together."""

from vtkmodules.vtkCommonCore import vtkStringArray

from .algorithm_base import words_of
from .messages import counted
from .ranks import together, total
from .report import main_counts, report_lines

RECOGNISED = "Recognised"  # the field array in which ElevationPoints reports what a file is
CONTENTS = "RecognisedAs"  # that with its contents, points say, and how many points there are
MOST_ERRORS = 5  # of blocks, in one message


def recognised(points, ranks=None):
    """What a reader has found out, for the report of these points: all of the file, or some.

    ranks  the controller of those that have some of the points each, or None
    """
    count = total(ranks, points.GetNumberOfPoints())
    words = together(ranks, lambda: [[words_of(points, name) for name in (RECOGNISED, CONTENTS)]])
    lines, contents = next((pair for pair in words if pair[0]), ([], []))
    if lines and contents[1:] != [str(count)]:
        lines[0] += f"; this surface is of {counted(count, 'point')}"
    return lines


def account_of(surface, result, told):
    """The account of a Surface that became a Reconstruction; told: recognised() of its points."""
    # A panel always says which of several heights is taken, so that nobody has decided it.
    notes = result.decided + result.notes
    return {
        "place": surface.place,
        "name": surface.name,
        "warnings": notes + result.gathered,
        "shown": notes + told,
        "rows": report_lines(result.report),
        "counts": main_counts(result),
        "sums": sums_of(result),
    }


def account_of_error(surface, error):
    """The account of a Surface that became nothing."""
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


def once(accounts):
    """Accounts of all ranks in the order of the blocks, each block once."""
    places = {tuple(account["place"]): account for account in reversed(accounts)}
    return [places[place] for place in sorted(places)]


def in_block(account, words):
    return f"{account['name']}: {words}" if account["name"] else words


def joined_errors(errors, others):
    """The errors of blocks as one message; once where it is the same in all."""
    if not others and len({account["error"] for account in errors}) == 1:
        return errors[0]["error"]
    lines = [in_block(account, account["error"]) for account in errors[:MOST_ERRORS]]
    if len(errors) > MOST_ERRORS:
        lines.append(f"And {len(errors) - MOST_ERRORS} more like these.")
    return "\n".join(lines)


def made_of(accounts):
    """The accounts of blocks that became a surface."""
    return [account for account in accounts if "error" not in account]


def all_blocks(accounts):
    """[(item, text)] of what all blocks have together."""
    columns = zip(*(account["sums"] for account in made_of(accounts)))
    sums = [(*column[0][::2], sum(number for _, number, _ in column)) for column in columns]
    return [(item, f"{count:,} {words}".strip()) for item, words, count in sums]


def counts_of(accounts):
    """What one wants to know first, as a list of words."""
    made = made_of(accounts)
    if len(made) == 1:
        return made[0]["counts"]
    rows = [row for row in all_blocks(made)[:3] if row[0] != "unused"]
    return [counted(len(made), "block"), *(f"{text.split()[0]} {item}" for item, text in rows)]


def report_rows(accounts):
    """[(block, item, value)] of the report; none where no block became a surface."""
    made = made_of(accounts)
    rows = [("all blocks", *row) for row in all_blocks(made)] if len(made) > 1 else []
    for account in accounts if made else ():
        for item, value in account.get("rows") or [("error", account["error"])]:
            rows.append((account["name"], item, value))
    return rows


def report_text(accounts):
    """The report, one line each."""
    lines, last = [], ""
    for block, item, value in report_rows(accounts):
        if block != last:
            lines.append(f"{block}:")
            last = block
        lines.append(f"{item:<10} {value}")
    return "\n".join(lines)


def lines_to_show(accounts):
    """The lines of the report without those that were shown: warnings, and what a reader told."""
    shown = {line for account in accounts for line in account.get("shown", ())}
    return [
        f"{block}: {item:<10} {value}" if block else f"{item:<10} {value}"
        for block, item, value in report_rows(accounts)
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
