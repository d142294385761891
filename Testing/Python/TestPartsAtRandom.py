# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Random clouds, dealt at random, give one surface: in memory, on ranks, in pieces, and on ranks with pieces.

And an abort, a full disk or a lost folder at a random moment is one message and nothing else. A mode is
compared where the table of features.py says that what is drawn is the same there.

Run by mpirun, as TestManyRanks.py, or alone on one rank. What a round works on is drawn by the seed, the
number of the round and the number of ranks; a round that fails names the options that make it again.
"""

import faulthandler
import os
import re
import resource
import shutil
import signal
import tempfile
import traceback
import types

import numpy
from on_ranks import COUNT, LAST, RANK, check, end, fewer, gather, options_of, owners_in_places

import features
import modes
import outcomes
from TestManyRanks import draw_points
from TestManyRanksConstraints import draw_lines
from TestManyRanksTrim import rings_for, torn

GUARD = 300  # seconds, after which a rank that still waits ends all of them
ABORTED = ("Stopped", "Aborted")  # what a warning begins with: of filters, and of a source of pieces
UNLIMITED = resource.getrlimit(resource.RLIMIT_FSIZE)
# The words of the table, which say what is compared in a mode.
WORDS = {(row.filter, row.feature): row.cells for row in features.rows()}
WITH_PIECES = "2 ranks, 2 pieces each" if COUNT > 1 else "4 pieces"
# A message of pieces that says less than that of memory: no better limit of edges.
WITHOUT_MORE = "are left without a triangle"
# In memory it can be trimmed.
REFUSED_IN_PIECES = "What is near the borders of pieces does not"
LATTICES = ((612000.0, 6073000.0, 25.0, 0.0, 0.0, 12.5), (612000.0, 6073000.0, 20.0, 15.0, -9.0, 12.0))
# What properties may be set to, which are the same in all modes; lengths are shares of an even distance.
NUMBERS = {
    "Delaunay.SearchStrategy": (0, 1), "Delaunay.LatticeMode": (0, 1), "Delaunay.DuplicatePolicy": (0, 1, 2, 3),
    "Trim.RecoverBoundary": (False, True), "Trim.BoundaryEdges": (0, 1, 2),
    "Fill.Interpolation": (0, 1, 2, 3, 4, 5), "Fill.FillCutOuts": (False, True), "Fill.MatchDensity": (False, True), "Fill.AreaMode": (0, 1), "Fill.MaximumHoleEdges": (5, 40),
    "Fill.ConfidenceLevel": (0.5, 0.95), "Fill.InterpolatePointData": (False, True), "Fill.MaximumNumberOfExpectedPoints": (50, 2000),
    "Delaunay.Lattice": LATTICES,
}
LENGTHS = {
    "Delaunay.MaximumEdgeLength": (0.5, 2.0, 8.0), "Delaunay.LatticeTolerance": (0.02,),
    "Fill.OpenEdgeLength": (1.5, 3.0, 8.0), "Fill.MaximumHoleSize": (4.0, 30.0), "Fill.Spacing": (0.6, 1.0, 5.0),
}


def draw_properties(random, steps, distance, are_nodes):
    """Some properties of these filters; a lattice for other points than nodes is mostly an error."""
    drawn = {"Fill.MaximumNumberOfExpectedPoints": 20000} if "Fill" in steps else {}
    for name, values in [*NUMBERS.items(), *LENGTHS.items()]:
        value = values[random.integers(len(values))]
        often = 0.25 if name != "Delaunay.Lattice" or are_nodes else 0.01
        if random.random() < often and name.split(".")[0] in steps:
            drawn[name] = distance * value if name in LENGTHS else value
    return drawn


def deal(random, case):
    """Which rank and which slice has which point. In memory, points without ids are in the order of ranks."""
    owners = owners_in_places(random, case.xyz)
    ids = [case.arrays[name] for name, role in case.roles.items() if role == "GlobalIds"]
    order = numpy.argsort(ids[0] if ids else owners, kind="stable")
    case.xyz, owners = case.xyz[order], owners[order]
    case.arrays.update({name: values[order] for name, values in case.arrays.items() if name != "Number"})
    case.dealt = {1: numpy.zeros(len(order), int), COUNT: owners}


def draw(random):
    """A row as of features.py and what it works on: a chain of filters with their properties, and points."""
    xyz, ids, arrays = draw_points(random)
    name = list(modes.FILTERS)[random.integers(3)]
    if name != "Delaunay" and ids is None and not arrays and len(xyz) > 30 and random.random() < 0.5:
        xyz = torn(random, xyz)
    case = modes.case_of(xyz)
    case.arrays.update(arrays)
    if ids is not None and random.random() < 0.5:  # not known in pieces
        # Those of new points follow the order of triangles, and the second name is not compared.
        ids_name = "Id" if name == "Delaunay" else "GlobalPointIds"
        case.arrays[ids_name], case.roles[ids_name] = ids.astype("i8"), "GlobalIds"
    finite = xyz[numpy.isfinite(xyz).all(axis=1)].astype(float)
    size = numpy.ptp(finite[:, :2], axis=0).max() if len(finite) else 0.0
    if name != "Delaunay" and random.random() < 0.7 and len(finite) > 2 and size > 0.0:
        case.rings = rings_for(random, finite)
        if name == "Fill" and random.random() < 0.3:
            case.areas = rings_for(random, finite)
    if random.random() < 0.15 and len(finite) > 2 and size > 0.0:
        places, cells = draw_lines(random, finite)
        case.lines = (places, *([ids for ids, closed in cells if closed == kind] for kind in (False, True)))
    case.on_one = bool(random.random() < 0.3)
    deal(random, case)
    distance = float(size / max(1.0, len(finite)) ** 0.5) or 1.0
    steps = [step for step in modes.FILTERS if step == "Delaunay" or step == name or (step == "Trim" and case.rings)]
    are_nodes = len(finite) > 0 and finite[:, 0].min() > LATTICES[0][0] - 1e4
    properties = draw_properties(random, steps, distance, are_nodes)
    if case.areas and random.random() < 0.4:
        properties["Fill.LevelArrayName"] = "Water"
    return types.SimpleNamespace(filter=name, feature="cut out", properties=properties), case


def is_same(row, case, mode):
    """Whether the table says so of all that is drawn."""
    drawn = ["points"] + ["constraints"] * bool(case.lines) + ["lattice given"] * ("Delaunay.Lattice" in row.properties)
    drawn += ["point data: global ids"] * ("GlobalIds" in case.roles.values())
    return all(WORDS["Delaunay", feature][mode] == "same" for feature in drawn)


def pass_known_messages(found, expected, case, mode):
    """Makes messages equal where these differ in what is known to: numbers of points, which on ranks and in pieces
    are global ids; in pieces the extent of the mesh, which in memory has points without a triangle too, and what
    comes after a sentence.
    """
    varying = [r"(?<=\b[Pp]oint) \d+"] if "GlobalIds" in case.roles.values() else []
    varying += [r"(?<=the mesh at) .*(?=: are both)"] * ("piece" in mode)
    for made in (found, expected):
        for pattern in varying:
            made["messages"] = [(event, re.sub(pattern, "", text)) for event, text in made["messages"]]
    for i, ((event, text), (_, right)) in enumerate(zip(found["messages"], expected["messages"])):
        if "piece" in mode and WITHOUT_MORE in text and right.startswith(text):
            found["messages"][i] = event, right


def why_another(parts, whole, row, case, mode):
    """What differs between parts and one run in memory. After an error there is no point.

    Triangles that lines have changed begin with another corner on ranks, and with it sums.
    """
    digits = 9 if case.lines and case.rings else None
    found, expected = (outcomes.joined(made, digits=digits) for made in (parts, [whole]))
    pass_known_messages(found, expected, case, mode)
    if "piece" in mode and any(text.startswith(REFUSED_IN_PIECES) for _, text in found["messages"]):
        return ""
    if modes.has_error(expected["messages"]):
        if any(len(block["points"]) for port in found["ports"] for block in port):
            return "there are points after an error"
        found["ports"] = expected["ports"] = []
        found["alike"], found["counts"] = True, {}
    return outcomes.difference(found, expected)


def compare(number, seed):
    """A round: all ways to make one surface."""
    random = numpy.random.default_rng((seed, number, COUNT))
    row, case = draw(random)
    slices, pieces = (int(random.integers(1, 6)) for _ in range(2))
    case.dealt.setdefault(slices, numpy.sort(random.integers(slices, size=len(case.xyz))))
    made = {("2 ranks", "%d ranks" % COUNT): gather(modes.on_rank(row, case, RANK, COUNT))}
    own = {}
    if modes.has_pieces(case) and is_same(row, case, WITH_PIECES):
        of_each = int(random.integers(1, 4))
        asked = range(RANK * of_each, (RANK + 1) * of_each)
        made[WITH_PIECES, "%d ranks, %d pieces each" % (COUNT, of_each)] = sum(
            gather(modes.in_pieces(row, case, [(RANK, COUNT)], asked, COUNT * of_each)), [])
    if RANK == LAST and modes.has_pieces(case) and is_same(row, case, "4 pieces"):
        of_slices = [(i, slices) for i in range(slices)]
        own["4 pieces", "%d slices, %d pieces" % (slices, pieces)] = modes.in_pieces(
            row, case, of_slices, range(pieces), pieces, True)
    if RANK == 0:
        own["memory"] = [modes.in_memory(row, case)]
    for one in gather(own):
        made.update(one)
    if RANK == 0:
        whole = made.pop("memory")[0]
        for (mode, shown), parts in made.items():
            why = why_another(parts, whole, row, case, mode)
            check(not why, "%s, round on %d ranks (--seed %d --first %d --clouds 1): %s\n    %s, %d points" % (
                shown, COUNT, seed, number, why, describe(row, case), len(case.xyz)))


def describe(row, case):
    shown = ", ".join("%s=%s" % item for item in row.properties.items())
    return "%s (%s), %s rings, %s" % (row.filter, shown, len(case.rings or ()), "lines" if case.lines else "no lines")


# ---- what fails at a moment -----------------------------------------------------------------------


class InMemory:
    """The filters of a row on all ranks, again and again."""

    KINDS = ("abort",)

    def __init__(self, row, case):
        self.steps = list(modes.chain(row, case, modes.part_of(case, RANK, COUNT), 1, True).values())

    def make(self):
        """What this rank has made, in parts."""
        messages = modes.noted(*self.steps)
        self.steps[0].Modified()
        self.steps[-1].UpdatePiece(RANK, COUNT, 0)
        return [outcomes.made_by(self.steps, messages)]

    def end(self):
        pass


class InPieces:
    """A source of so many pieces for each rank, in a folder of this rank."""

    KINDS = ("abort", "full disk", "no folder")

    def __init__(self, row, case, pieces):
        self.row, self.case, self.pieces = row, case, pieces
        self.folder = tempfile.mkdtemp()
        self.begin()

    def begin(self):
        self.steps = [modes.piece_source(self.row, self.case, self.folder)]

    def make(self):
        pieces = range(RANK * self.pieces, (RANK + 1) * self.pieces)
        return modes.pieces_made(self.steps[0], self.row, self.case, [(RANK, COUNT)], pieces, COUNT * self.pieces,
                                 lambda messages: any(gather(is_failure(messages))))

    def forget(self, with_object):
        """Leaves no file; a folder that is gone is made again."""
        if with_object:
            self.steps = []
            self.begin()
        else:
            self.steps[0].Reset()
        os.makedirs(self.folder, exist_ok=True)
        return not os.listdir(self.folder)

    def end(self):
        self.steps = []
        shutil.rmtree(self.folder)


def is_failure(messages):
    return any(event == "ErrorEvent" or text.startswith(ABORTED) for event, text in messages)


def fill_disk(random, folder):
    """From now on files can grow to a part of the largest one."""
    sizes = [os.path.getsize(os.path.join(folder, name)) for name in os.listdir(folder)]
    largest = int(random.random() * max(sizes, default=0))
    resource.setrlimit(resource.RLIMIT_FSIZE, (largest, UNLIMITED[1]))


def make_with_failure(random, maker, kind, at):
    """What is made where something happens on this rank at a report of progress; at = 0: nothing.

    @return (parts, how many reports there were)
    """
    reports, aborted = [], []

    def report(caller, _event):
        reports.append(caller.GetProgress())
        if len(reports) == at:
            if kind == "abort":
                caller.SetAbortExecute(1)
                aborted.append(caller)
            elif kind == "full disk":
                fill_disk(random, maker.folder)
            else:
                shutil.rmtree(maker.folder)

    tags = [step.AddObserver("ProgressEvent", report) for step in maker.steps]
    try:
        parts = maker.make()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, UNLIMITED)
    for step, tag in zip(maker.steps, tags):
        step.RemoveObserver(tag)
    for step in aborted:
        step.SetAbortExecute(0)  # newer VTKs keep it; nobody else has to take anything back
    return parts, len(reports)


def draw_to_fail(random):
    """A surface that takes some reports of progress."""
    name = list(modes.FILTERS)[random.integers(3)]
    kinds = (modes.coast_and_lakes, modes.lattice_and_lakes) + (modes.duplicates,) * (name == "Delaunay")
    case = kinds[random.integers(len(kinds))](random, int(random.choice([100, 1000, 3000])))
    properties = {"Delaunay.MaximumEdgeLength": 4.0} if random.random() < 0.3 else {}
    deal(random, case)
    return types.SimpleNamespace(filter=name, feature="", properties=properties), case


def point_counts(part):
    return [len(block["points"]) for block in sum(part["ports"], [])]


def check_failure(number, seed):
    """A surface is made; again, where something fails at a moment; and once more. @return whether it failed"""
    random = numpy.random.default_rng((seed, number, COUNT, 0))
    row, case = draw_to_fail(random)
    ways = ["memory"] * (COUNT > 1) + [1, 3] * is_same(row, case, WITH_PIECES)
    way = ways[random.integers(len(ways))]
    maker = InMemory(row, case) if way == "memory" else InPieces(row, case, way)
    kind, culprit = maker.KINDS[random.integers(len(maker.KINDS))], random.integers(COUNT)
    claim = "%s on rank %d of %d, %s, failure %d (--seed %d --first %d --clouds 0 --aborts 1): " % (
        kind, culprit, COUNT, way if way == "memory" else "%d pieces each" % way, number, seed, number)
    usual, reports = make_with_failure(random, maker, kind, 0)
    right = outcomes.joined(sum(gather(usual), []))
    at = 1 + int(random.integers(max(1, gather(reports)[culprit])))
    if isinstance(maker, InPieces):
        check(maker.forget(False), claim + "the folder is empty after Reset()")
    parts, _ = make_with_failure(random, maker, kind, at if RANK == culprit else 0)
    new = [message for message in parts[0]["messages"] if message not in right["messages"]]
    reported = sum(gather(new), [])
    if reported:
        event = "WarningEvent" if kind == "abort" else "ErrorEvent"
        is_right = len(reported) == 1 and reported[0][0] == event and is_failure(reported)
        check(is_right, "%s%s is all that is reported" % (claim, reported))
        # A piece that is passed on may be there where another rank fails to pass on its own.
        points, others = point_counts(parts[-1]), point_counts(usual[len(parts) - 1])
        is_passed = way != "memory" and RANK != culprit and points == others
        check(is_passed or not any(points), "%sthere are points: %s" % (claim, points))
    else:
        why = outcomes.difference(outcomes.joined(sum(gather(parts), [])), right)
        check(not why, "%snothing is reported, and %s" % (claim, why))
    if isinstance(maker, InPieces):
        check(maker.forget(random.random() < 0.5), claim + "no file is left")
    again = outcomes.joined(sum(gather(maker.make()), []))
    why = outcomes.difference(again, right)
    check(not why, "%sthe next surface is another: %s" % (claim, why))
    maker.end()
    return bool(reported)


def main(options):
    clouds = fewer(20) if options.clouds is None else options.clouds
    failures = fewer(20) if options.aborts is None else options.aborts
    failed = 0
    for number in range(options.first, options.first + max(clouds, failures)):
        faulthandler.dump_traceback_later(GUARD, exit=True)
        if number < options.first + clouds:
            compare(number, options.seed)
        if number < options.first + failures:
            failed += check_failure(number, options.seed)
    faulthandler.cancel_dump_traceback_later()
    check(failures < 10 or 2 * failed >= failures, "%d of %d failures have come to pass" % (failed, failures))
    return "%d clouds in all ways, %d of %d failures have come to pass" % (clouds, failed, failures)


if __name__ == "__main__":
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        end(main(options_of()))
    except Exception:
        traceback.print_exc()
        os._exit(1)  # and all other ranks
