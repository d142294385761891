# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a filter reports of its progress while all ranks work on a mesh that is spread over them. Run by mpirun."""

import meshes
import numpy
from on_ranks import COUNT, RANK, check, end
from vtkelevationsurface import vtkTrimOutwardTriangles
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet

SIDE = 20
OF_SPREAD = 0.9  # of a filter's progress, its work on what is spread
TRIMMED = 0.88  # of this for a block, until its parts are written


def part_of_grid():
    """The columns of a square grid that this rank has, with an array of cells."""
    i, j = numpy.meshgrid(numpy.arange(SIDE), numpy.arange(SIDE))
    places = numpy.column_stack((i.ravel(), j.ravel(), numpy.zeros(SIDE * SIDE))).astype(float)
    first = (numpy.arange(SIDE - 1)[:, None] * SIDE + numpy.arange(SIDE - 1)).ravel()
    triangles = numpy.vstack([first + numpy.array(corners)[:, None] for corners in (
        (0, 1, SIDE + 1), (0, SIDE + 1, SIDE))]).reshape(2, 3, -1).transpose(0, 2, 1).reshape(-1, 3)
    own = triangles[(triangles[:, 0] % SIDE) * COUNT // SIDE == RANK]
    used, corners = numpy.unique(own, return_inverse=True)
    return meshes.mesh(places[used], corners.reshape(-1, 3), cell_arrays=[("cell", numpy.arange(len(own)))])


def reports(data):
    """What trimming along a ring reports, until all that is spread is done."""
    trim, found = vtkTrimOutwardTriangles(), []
    trim.AddObserver("ProgressEvent", lambda *_: found.append(trim.GetProgress()))
    trim.SetInputDataObject(0, data)
    trim.SetBoundaryData(meshes.rings([[(2.5, 2.5), (15.5, 3.5), (9.5, 16.5)]]))
    trim.SetNumberOfThreads(1)
    trim.UpdatePiece(RANK, COUNT, 0)
    return numpy.unique([one for one in found if one < OF_SPREAD - 1e-9])


def main():
    part = part_of_grid()
    alone = reports(part)
    # Points and, of each side, corners and arrays are written, and the first has most of the time.
    writing = (alone / OF_SPREAD - TRIMMED) / (1.0 - TRIMMED)
    check(any((writing > 0.65) & (writing < 0.95)), "progress goes on while parts are written")
    both = vtkMultiBlockDataSet()
    both.SetBlock(0, part)
    both.SetBlock(1, part_of_grid())
    found = reports(both)
    first, second = found[found < 0.5 * OF_SPREAD - 1e-9], found[found > 0.5 * OF_SPREAD + 1e-9]
    check(len(first) > 5, "there are reports of the first block: %s" % first)
    for share, reported in ((0.0, first), (0.5 * OF_SPREAD, second)):
        lacks = [one for one in share + 0.5 * alone if abs(reported - one).min(initial=1.0) > 0.002 and one > share]
        check(not lacks, "a block of two has half of the progress: no report at %s" % lacks)
    return "progress"


if __name__ == "__main__":
    end(main())
