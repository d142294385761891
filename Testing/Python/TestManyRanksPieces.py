# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pieces that several ranks make are those of one process: points and their numbers, triangles, reports.

Run by mpirun, as TestManyRanks.py: each surface is also made by rank 0 alone, in as many pieces, and compared
with what all ranks have made. What goes wrong on one rank is the error of all, and the first reports it.
"""

import tempfile

import numpy
from on_ranks import COUNT, LAST, RANK, check, check_equal, end, fewer, gather, options_of, owners_in_places
from vtkmodules.util.numpy_support import vtk_to_numpy

import modes
import outcomes
from meshes import cloud, lines, rings
from vtkelevationsurface.vtkElevationSurfacePieces import vtkReconstructPieces

FIRST, NEXT = RANK == 0, (RANK + 1) % COUNT


def cloud_of(random):
    """A cloud with lakes and duplicates, scattered or on a lattice."""
    count = int(random.choice([200, 1500]))
    if random.random() < 0.5:
        xyz = modes.scattered(random, count)
    else:
        xyz = modes.with_heights(random, modes.nodes(random, count))
    xyz = modes.away(xyz, (0.1, 0.0, 0.12), (-0.2, 0.2, 0.08))
    return numpy.vstack((xyz, xyz[:9] + (0.0, 0.0, 1.0)))


class Source:
    """A source of pieces with these properties, Filter.Property or its own, and its messages."""

    def __init__(self, alone=False, **properties):
        self.folder = tempfile.TemporaryDirectory()
        self.pieces = vtkReconstructPieces()
        self.pieces.SetFolder(self.folder.name)
        if alone:
            self.pieces.SetController(None)
        self.pieces.GetDelaunay().SetNumberOfThreads(1)
        self.set(**properties)
        self.messages = outcomes.noted(self.pieces)

    def set(self, **properties):
        for name, value in properties.items():
            step, _, last = name.rpartition("_")
            getattr(getattr(self.pieces, "Get" + step)() if step else self.pieces, "Set" + last)(value)

    def add(self, xyz, *arrays):
        return self.pieces.AddPoints(cloud(xyz, None, arrays))

    def ask(self, piece, count):
        """What there is of a piece."""
        self.pieces.UpdatePiece(piece, count, 0)
        ids = self.pieces.GetOutput().GetPointData().GetArray("GlobalPointIds")
        return outcomes.made_by([self.pieces], [], vtk_to_numpy(ids) if ids else ())

    def ask_for_own(self, each):
        """Those of this rank, of so many of each; the first has the messages."""
        made = [self.ask(RANK * each + i, COUNT * each) for i in range(each)]
        made[0]["messages"] = self.messages
        return made

    def take_messages(self):
        """The messages since the last time, without the event."""
        texts = [text for _, text in self.messages]
        self.messages.clear()
        return texts

    def end(self):
        self.pieces.Reset()
        self.folder.cleanup()


def compare(random, claim):
    """Makes one surface on all ranks and on rank 0 alone. All ranks draw the same."""
    xyz = cloud_of(random)
    owners = owners_in_places(random, xyz)
    number = random.integers(99, size=len(xyz)).astype("i2")
    middle, extent = modes.middle_of(xyz)
    ring = rings([modes.star(middle, 0.35 * extent, 40)])
    corners = numpy.column_stack((middle + extent * random.uniform(-0.4, 0.4, (4, 2)), random.random(4)))
    line = lines(corners, [[0, 1], [2, 3]])
    properties, each = {"FillHoles": bool(random.random() < 0.6)}, int(random.integers(1, 4))
    if random.random() < 0.5:
        properties["TrimOutward"] = True
    else:
        properties["Delaunay_MaximumEdgeLength"] = 4.0
    has_ring, has_line = random.random(2) < 0.4

    def second(is_here):
        """Lines that one rank has."""
        given = {"Trim_BoundaryData": ring} if has_ring and is_here(LAST) else {}
        return {**given, **({"Delaunay_SourceData": line} if has_line and is_here(0) else {})}

    source = Source(**properties, **second(lambda rank: rank == RANK))
    mine = numpy.flatnonzero(owners == RANK)
    for part in numpy.array_split(mine, 3):
        source.add(xyz[part], ("number", number[part]))
    check_equal(source.pieces.GetNumberOfPoints(), len(mine), claim + ": own points are counted before the first piece")
    parts = sum(gather(source.ask_for_own(each)), [])
    source.end()
    if FIRST:
        check(not any(part["messages"] for part in parts[each:]), claim + ": other ranks are silent")
        whole = Source(True, **properties, **second(lambda rank: True))
        order = numpy.argsort(owners, kind="stable")
        whole.add(xyz[order], ("number", number[order]))
        expected = [whole.ask(piece, COUNT * each) for piece in range(COUNT * each)]
        expected[0]["messages"] = whole.messages
        whole.end()
        digits = 9 if has_line and has_ring else None
        why = outcomes.difference(*(outcomes.joined(made, digits=digits) for made in (parts, expected)))
        check(not why, "%s (%s, %d pieces each, ring %s, line %s): %s" % (
            claim, properties, each, has_ring, has_line, why))


def counts_of(made):
    return sum(part["ports"][0][0]["count"] for part in made)


def check_refused(source, words, claim, each=2):
    """One error of all, by the first rank; nobody gets anything, nor waits when it asks again."""
    for again in ("", ", again"):
        made = source.ask_for_own(each)
        errors = source.take_messages()
        is_right = len(errors) == each and all(words in text for text in errors) if FIRST else not errors
        check(is_right, "%s%s: %s" % (claim, again, errors))
        check_equal(counts_of(made), 0, claim + ": no triangle")


def check_errors(random):
    xyz = modes.scattered(random, 400)
    own = xyz[RANK::COUNT]
    alone = Source(True)
    alone.add(xyz)
    right = counts_of([alone.ask(0, 1)])
    check(right > 600, "a process can work alone: %d triangles" % right)
    alone.end()
    source = Source()

    # What this rank alone asks for is its own error, and nothing is lost.
    source.add(own)
    source.ask(0, 2 * COUNT + 1)
    errors = source.take_messages()
    check(len(errors) == 1 and "is %d, but %d processes" % (2 * COUNT + 1, COUNT) in errors[0], "a wrong number: %s" % errors)
    source.ask(2 * NEXT, 2 * COUNT)
    errors = source.take_messages()
    check(len(errors) == 1 and "this one makes pieces %d to %d." % (2 * RANK, 2 * RANK + 1) in errors[0],
          "another's piece: %s" % errors)
    source.pieces.SetController(None)
    check("Controller cannot be changed" in source.take_messages()[0], "the controller is taken with the points")

    # What one rank has wrong is the error of all, and can be put right.
    source.set(Delaunay_MaximumEdgeLength=-1.0 if RANK == LAST else 0.0)
    check_refused(source, "MaximumEdgeLength is -1", "a wrong property")
    source.set(Delaunay_MaximumEdgeLength=0.0)
    source.pieces.Modified()
    each = 3 if RANK == LAST else 2
    source.ask(each * RANK, each * COUNT)
    errors = source.take_messages()
    check(len(errors) == FIRST and (not FIRST or "different numbers" in errors[0]), "different numbers: %s" % errors)
    source.pieces.Modified()
    check_equal(sum(gather(counts_of(source.ask_for_own(2)))), right, "what is put right gives all triangles")
    check_equal(source.pieces.GetNumberOfTriangles(), right, "all ranks count all triangles")
    check_equal(source.pieces.GetNumberOfPoints(), len(xyz), "all ranks count all points")
    check_equal(source.take_messages(), [], "nothing is reported")

    # After the first piece each rank goes on alone.
    if FIRST:
        source.set(Delaunay_LatticeTolerance=0.1)
    check_equal(counts_of([source.ask(2 * RANK, 2 * COUNT)]) > 0, not FIRST, "the piece, unless properties are others")
    errors = source.take_messages()
    check(len(errors) == FIRST and (not FIRST or "Properties were changed" in errors[0]), "a changed property: %s" % errors)
    source.end()


def check_lost(random):
    """Points that one rank has lost are an error of all, until all begin again; so are other arrays."""
    own = modes.scattered(random, 400)[RANK::COUNT]
    source = Source()
    source.add(own)
    check_equal(source.add(own, ("more", own[:, 2])) if RANK == LAST else False, False, "other arrays are refused")
    check(len(source.take_messages()) == (RANK == LAST), "by the rank that adds them")
    check_refused(source, "On rank %d: The points are not complete" % LAST, "lost points")
    source.pieces.Reset()
    source.add(own, *([("more", own[:, 2])] if RANK == LAST else []))
    source.ask(RANK, COUNT)
    errors = source.take_messages()
    check(len(errors) == FIRST and (not FIRST or "the same point arrays" in errors[0]), "arrays of one rank: %s" % errors)
    source.pieces.Reset()
    if RANK == LAST:
        source.set(Folder="")
    else:
        source.add(own)
    check_refused(source, "On rank %d: Folder is not set." % LAST, "no folder")
    if RANK == LAST:
        source.set(Folder=source.folder.name)
    source.pieces.Modified()
    check(sum(gather(counts_of(source.ask_for_own(1)))) > 0, "a rank without points takes part")
    check_equal(source.take_messages(), [], "nothing is reported")
    source.end()


def main(options):
    random = numpy.random.default_rng(options.seed)
    check_errors(random)
    check_lost(random)
    surfaces = options.clouds or fewer(12)
    for i in range(surfaces):
        compare(random, "surface %d of seed %d" % (i, options.seed))
    return "%d surfaces in pieces" % surfaces


if __name__ == "__main__":
    end(main(options_of()))
