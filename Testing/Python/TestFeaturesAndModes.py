# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table of features.py: what each property and input of the filters does in each mode.

Each cell is computed and compared with the one that stands there; both are printed. Alone, the script
does the modes of one process; with --ranks, started by mpirun, those of so many ranks. --only TEXT does
the rows that have it. Documentation/Features.md explains the words.
"""

import argparse
import sys

import features
import modes
import outcomes
from vtkelevationsurface.vtkElevationSurfacePieces import vtkReconstructPieces

POINTS = 500  # of a row, or about so many
POINTS_FOR_THREADS = 12000  # so that several threads have something to do
FEW = 60  # triangles, of which each rank might not have some
# How what differs begins, by the remarks of the page.
REMARKS = {1: "messages", 2: "output 0: points differ", 3: "output 0: points ("}
# Properties that change no result, which are there to compare, or to be quicker.
# Where all three filters remove unused points, none of them does it alone.
WITHOUT_EFFECT = {("Delaunay", "SearchStrategy"), *(
    ("Fill", of + "RemoveUnusedPoints") for of in ("Delaunay.", "Trim.", ""))}
EFFECTIVE = set()  # (filter, property) of which a row has shown that it changes something
FAILURES = []


def check(is_true, claim):
    if not is_true:
        FAILURES.append(claim)


def is_error(message):
    return message[0] == "ErrorEvent"


def words_of(row, case):
    """What an error has to name, if it refuses the row."""
    words = [name.rsplit(".", 1)[-1] for name in row.properties]
    return words + ["Constraints"] * bool(case.lines) + ["global ids"] * ("Id" in case.arrays)


def word_for(row, case, parts, expected):
    """The word for what parts have made, compared with one run in memory, and what differs."""
    found = outcomes.joined(parts)
    errors = {text for event, text in found["messages"] if event == "ErrorEvent"}
    if errors and not any(map(is_error, expected["messages"])):
        is_named = len(errors) == 1 and any(word in text for text in errors for word in words_of(row, case))
        is_empty = not any(len(block["points"]) for port in found["ports"] for block in port)
        return "refused" if is_named and is_empty else "differs", str(errors)
    gathering = outcomes.take_gathering(found["messages"])
    why = outcomes.difference(found, expected)
    if why:
        remark = [str(number) for number, begin in REMARKS.items() if why.startswith(begin)]
        return " ".join(["differs", *(remark[-1:])]), why
    shares = found["shares"]
    if len(shares) > 1 and sum(shares) > FEW and max(shares) == sum(shares):
        return ("gathers", "") if len(gathering) == 1 else ("differs", "%d warnings of gathering" % len(gathering))
    return "same", ""


def in_one_process(row):
    """{mode: (word, what differs)}"""
    case = modes.make_case(row, POINTS_FOR_THREADS)
    expected, *others = (
        outcomes.joined([modes.in_memory(row, case, threads)], True) for threads in (1, 1, 2))
    found = {}
    for mode, other in zip(features.MODES, others):
        why = outcomes.difference(other, expected)
        found[mode] = "differs" if why else "same", why
    case = modes.make_case(row, POINTS)
    expected = outcomes.joined([modes.in_memory(row, case)])
    for mode, count in (("1 piece", 1), ("4 pieces", 4)):
        found[mode] = "none", ""
        if modes.has_pieces(case):
            parts = modes.in_pieces(row, case, [(i, 3) for i in range(3)], range(count), count)
            found[mode] = word_for(row, case, parts, expected)
            if found[mode][0] == "gathers":
                found[mode] = "differs", "all triangles are in one piece"
    note_effects(row, case, expected)
    return found


def note_effects(row, case, expected):
    """Notes the properties that change what comes out, as a row sets them."""
    for name, value in row.properties.items():
        of, _, last = name.rpartition(".")
        if value != getattr(modes.FILTERS[of or row.filter](), "Get" + last)():
            plain = argparse.Namespace(**vars(row))
            plain.properties = {key: one for key, one in row.properties.items() if key != name}
            if outcomes.difference(outcomes.joined([modes.in_memory(plain, case)]), expected):
                EFFECTIVE.add((row.filter, name))


def on_ranks(row):
    """The same of modes on ranks; on the first rank, others return nothing."""
    from on_ranks import COUNT, RANK, gather

    case = modes.make_case(row, POINTS)
    parts = gather(modes.on_rank(row, case, RANK, COUNT))
    made = {"%d ranks" % COUNT: parts}
    mode = "%d ranks, 2 pieces each" % COUNT
    found = {}
    if mode in features.MODES and modes.has_pieces(case):
        own = range(2 * RANK, 2 * RANK + 2)
        made[mode] = sum(gather(modes.in_pieces(row, case, [(RANK, COUNT)], own, 2 * COUNT)), [])
    elif mode in features.MODES:
        found[mode] = "none", ""
    if RANK == 0:
        expected = outcomes.joined([modes.in_memory(row, case)])
        found.update((name, word_for(row, case, parts, expected)) for name, parts in made.items())
    return found


def check_controller(row):
    """More pieces than ranks are refused, on all of them; without a controller a rank works alone."""
    from on_ranks import COUNT, RANK, gather

    case = modes.make_case(row, POINTS)
    last = list(modes.chain(row, case, modes.part_of(case, RANK, COUNT), 1).values())[-1]
    messages = modes.noted(last)
    last.UpdatePiece(RANK, 2 * COUNT, 0)
    check(len(messages) == 1 and "asked for in 4 pieces, but 2 processes" in messages[0][1],
          "more pieces than ranks: %s" % messages)
    check(last.GetOutput().GetNumberOfPoints() == 0, "the output is empty after the error")
    last.SetController(None)
    last.UpdatePiece(0, 1, 0)
    own = last.GetOutput().GetNumberOfPolys()
    check(own == modes.in_memory(row, case, 1, (RANK, COUNT))["ports"][0][0]["count"], "a rank alone")
    last.UpdatePiece(RANK, COUNT, 0)
    check(len(messages) == 2 and "asked for in 2 pieces, but one process" in messages[1][1],
          "pieces without a controller: %s" % messages)
    check(len(gather(own)) == COUNT, "all ranks have come here")


def check_properties(rows):
    """Each property and input of the filters has a row, and each value of an enumeration."""
    for name, make in modes.FILTERS.items():
        mine = [row for row in rows if row.filter == name]
        cases = [modes.make_case(row, POINTS) for row in mine]
        named = {key for row in mine for key in row.properties if "." not in key} | {"NumberOfThreads", "Controller"}
        named |= {"SourceData", "SourceConnection"} if any(case.lines for case in cases) else set()
        named |= {"BoundaryData", "BoundaryConnection"} if any(case.rings for case in cases) else set()
        named |= {"AreasData", "AreasConnection"} if any(case.areas for case in cases) else set()
        has = outcomes.own_names(make(), "Set")
        if name == "Fill":
            has.discard("MaximumEdgeLength")  # the old name of OpenEdgeLength
        values = {word.split("To", 1)[0] for word in has if "To" in word}
        plain = {word for word in has if "To" not in word or word.split("To", 1)[0] not in has}
        check(plain <= named, "%s: no row names %s" % (name, ", ".join(sorted(plain - named))))
        for one in values & plain:
            wanted = sum(word.startswith(one + "To") for word in has)
            shown = {row.properties[one] for row in mine if one in row.properties}
            check(len(shown) == wanted, "%s: of %d values of %s, rows have %s" % (name, wanted, one, shown))
    has = outcomes.own_names(vtkReconstructPieces(), "Set")
    known = {"Controller", "Folder", "KeepFiles", "TrimOutward", "FillHoles", "HoleMemory"}
    check(has == known, "modes.in_pieces() sets all of vtkReconstructPieces: %s" % has)


def check_page():
    import documented

    check(features.markdown() in documented.text_of("Features.md"),
          "Documentation/Features.md has another table than features.py prints")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ranks", action="store_true")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    rows, rank = features.rows(), 0
    if options.ranks:
        from on_ranks import COUNT, RANK as rank

        if COUNT == 2:
            check_controller(rows[0])
    elif not options.only:
        check_properties(rows)
        check_page()
    right = 0
    for row in rows:
        if options.only not in row.filter + " " + row.feature:
            continue
        found = on_ranks(row) if options.ranks else in_one_process(row)
        shown = []
        for mode, (word, why) in found.items():
            expected = row.cells[mode]
            shown.append(word if word == expected else "%s (expected: %s)" % (word, expected))
            check(word == expected, "%s, %s, %s: %s" % (row.filter, row.feature, mode, why))
            right += word == expected
        if rank == 0:
            print("%-9s %-36s" % (row.filter, row.feature), *("%-18s" % text for text in shown), flush=True)
    if not options.ranks and not options.only:
        vain = {(row.filter, name) for row in rows for name in row.properties} - EFFECTIVE - WITHOUT_EFFECT
        check(not vain, "in no row it changes anything: %s" % sorted(vain))
    for claim in FAILURES:
        print("rank %d: FAILED: %s" % (rank, claim[:1000]), flush=True)
    if rank == 0:
        print("%d cells are as expected" % right)
    sys.exit(1 if FAILURES else 0)


if __name__ == "__main__":
    main()
