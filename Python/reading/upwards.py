# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whether z counts upwards: what its name, its unit, its sign and the kind of file say together.

All readers ask here. z is never turned over because of it, but a doubt is reported, once, with both
readings.
"""

import os

from ..clouds import heights_of
from ..names import option
from .column_names import z_direction, names_horizon, says_up

PLURALS = {"depth": "depths", "time": "times"}


def notes_on_up(cloud, depth, path="", ranks=None):
    """Notes for the user on the z of a Cloud as it was read; ranks: see take_out().

    depth  it will be turned over
    """
    heights = heights_of(cloud.points, ranks)
    return notes_on_range(cloud, depth, *heights, path) if heights else []


def notes_on_range(cloud, depth, low, high, path=""):
    """The same for z from low to high."""
    is_horizon = cloud.is_horizon or names_horizon(os.path.basename(path))
    direction, values = z_direction(cloud.z_name), f"from {low:,.6g} to {high:,.6g}"
    if depth:
        if high > 0.0 or low == 0.0:
            return []
        return [
            f"z was {values} before {option('depth')} turned it over: where it was an elevation below 0, as "
            f"of a lake's bed, hollows are hills now; leave {option('depth')} out then"
        ]
    if direction and low >= 0.0 and high > 0.0:
        return [
            f"z are {PLURALS[direction]} by their name and positive, so the surface is upside down; "
            f"{option('depth')} turns it over"
        ]
    if direction and high > 0.0:
        return [
            f"z are {PLURALS[direction]} by their name, but {values}: taken as they are, upwards; if "
            f"they count downwards, {option('depth')} turns it over"
        ]
    if is_horizon and not direction and not says_up(cloud.z_name) and low > 0.0:
        return [
            f"z is {values}, and it is not certain that it counts upwards: taken as elevations; if "
            f"these are depths or times, as of horizons, the surface is upside down, and {option('depth')} "
            "turns it over"
        ]
    return []
