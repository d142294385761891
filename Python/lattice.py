# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The lattice on which most points of a surface lie."""

import math

import numpy

from .ranks import together


def lattice_of(ranks, surface):
    """The lattice that was found, or None: a node, two steps, their lengths and their directions.

    Directions are in degrees from x to y; with plane=best from the first axis of the plane, which is
    level, to the second, upwards, and the node and the steps have x, y and z.
    """

    def local_lattice():
        array = surface.GetFieldData().GetArray("Lattice")
        return [] if array is None else [array.GetTuple(0)]

    found = together(ranks, local_lattice)
    if not found:
        return None
    origin, *steps = numpy.reshape(found[0], (3, 2)).tolist()
    return {
        "origin": origin,
        "steps": steps,
        "lengths": [math.hypot(*step) for step in steps],
        "directions": [math.degrees(math.atan2(step[1], step[0])) for step in steps],
    }
