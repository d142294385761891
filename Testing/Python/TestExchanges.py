# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""An error on one rank is that of all ranks, whatever exchange the others are in or come to: nobody waits
for ever, and the first rank reports it. Run by mpirun; a rank that waits in vain ends by the time-out.
"""

import numpy
from on_ranks import COUNT, LAST, RANK, RANKS, check, check_equal, end, gather
from vtkelevationsurface import ranks, spreading
from vtkelevationsurface.messages import Aborted, ElevationSurfaceError, FileError, PictureError
from vtkmodules.vtkCommonDataModel import vtkPolyData


class Updated:
    """A filter that waits for all ranks in its update."""

    def UpdatePiece(self, *_):
        RANKS.Barrier()


EXCHANGES = {
    "collected": lambda: [len(row) for row in ranks.collected(RANKS, [RANK] * RANK)],
    "collected doubles": lambda: [len(row) for row in ranks.collected(RANKS, [0.5] * RANK, "f8")],
    "together": lambda: ranks.together(RANKS, lambda: ["rank", RANK]),
    "agreed": lambda: ranks.agreed(RANKS, lambda: 1),
    "total": lambda: ranks.total(RANKS, RANK),
    "shared": lambda: len(ranks.shared(RANKS, vtkPolyData)),
    "update": lambda: spreading.update(Updated(), RANKS),
}
if hasattr(RANKS, "Iprobe"):  # else VTK's Python knows no MPI, and only the program needs it
    EXCHANGES["by_first"] = lambda: ranks.by_first(RANKS, lambda: 2, 3)


def fail(error):
    raise error


def outcome(work):
    """What work() gives as one of all ranks, or what it raises."""
    try:
        return ranks.agreed(RANKS, work)
    except Exception as error:  # pylint: disable=broad-except
        check(ranks.is_on_all_ranks(error) and error.is_reported_here == (RANK == 0),
              "%r is of all ranks, and the first reports it" % error)
        return error


def check_fails(claim, errors, exchange, kind, words):
    """errors: {rank: what it raises instead of the exchange}; kind, words: what all ranks raise."""
    found = outcome(lambda: fail(errors[RANK]) if RANK in errors else exchange())
    check_equal((type(found), str(found)), (kind, words), claim)


def main():
    for name, exchange in EXCHANGES.items():
        first = gather(outcome(exchange))
        for culprit in sorted({0, LAST}):
            check_fails("%s without rank %d" % (name, culprit), {culprit: ElevationSurfaceError("no points")},
                        exchange, ElevationSurfaceError, "no points")
        check_fails("%s, all but one fail" % name,
                    {rank: ValueError("rank %d" % rank) for rank in range(1, COUNT)}, exchange,
                    ValueError, "rank 1")
        check_fails("%s, an abort besides an error" % name, {0: Aborted(), LAST: ValueError("wrong")} if LAST else {},
                    exchange, ValueError, "wrong")
        check_fails("%s, a stop" % name, {LAST: Aborted()}, exchange, Aborted, "")
        check_equal(gather(outcome(exchange)), first, "%s works as before the errors" % name)
    # In the work of an exchange, and in one exchange within another.
    for name in ("together", "agreed", "by_first"):
        if name not in EXCHANGES:
            continue
        found = outcome(lambda: getattr(ranks, name)(RANKS, lambda: fail(MemoryError()) if RANK == 0 else []))
        check_equal(type(found), MemoryError, "the work of %s fails" % name)
    check_fails("an exchange within two others",
                {LAST: FileError("a.txt: not there")},
                lambda: ranks.agreed(RANKS, lambda: ranks.agreed(RANKS, lambda: ranks.total(RANKS, 1))),
                FileError, "a.txt: not there")
    # What an error says of itself comes along; what cannot travel, does so in its words.
    found = outcome(lambda: fail(ElevationSurfaceError("wrong", "faults", "trimming")) if RANK == LAST else 0)
    check_equal((str(found), found.message, found.about, found.step), ("trimming: wrong", "wrong", "faults", "trimming"),
                "an error")
    check_fails("an error of two words", {LAST: PictureError("a.png", "no screen")}, lambda: 0,
                ElevationSurfaceError, "a.png: cannot be drawn: no screen")
    # At random: each rank does the same exchanges, and one or none of them fails at a random one.
    random = numpy.random.default_rng(5)
    for run in range(100):
        names = random.choice(list(EXCHANGES), 6)
        culprit, moment = random.integers(COUNT), random.integers(9)

        def work():
            for i, name in enumerate(names):
                if RANK == culprit and i == moment:
                    raise ValueError("exchange %d" % i)
                EXCHANGES[name]()
            return "done"

        found = str(outcome(work))
        check_equal(found, "exchange %d" % moment if moment < len(names) else "done", "run %d: %s" % (run, names))
    return "exchanges"


if __name__ == "__main__":
    end(main())
