# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The properties of the chain of filters: their names, what they take, and how that is checked."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from .messages import did_you_mean


def number_at_least_zero(value):
    value = float(value)
    if not (value >= 0 and math.isfinite(value)):
        raise ValueError
    return value


def number_above_zero(value):
    value = float(value)
    if not 0.0 < value < math.inf:
        raise ValueError
    return value


def view_angles(view):
    """(bearing, height) of "top", of "BEARING,HEIGHT", or of two numbers. Raises ValueError."""
    if view == "top":
        return (180.0, 90.0)
    bearing, height = (float(a) for a in (view.split(",") if isinstance(view, str) else view))
    if not 0 < height <= 90 or not math.isfinite(bearing):
        raise ValueError("view takes (bearing, height) with a height above 0 and at most 90")
    return (bearing % 360.0, height)


def number_up_to_a_quarter(value):
    value = float(value)
    if not 0 <= value <= 0.25:
        raise ValueError
    return value


def count_at_least_zero(value):
    count = int(value)
    if count < 0 or count != float(value):
        raise ValueError
    return count


def yes_or_no(value):
    if value not in (True, False):
        raise ValueError
    return bool(value)


def one_of(*names):
    """A function that makes the place of a name in the list of an enumeration's names."""

    def index(value):
        return names.index(str(value).lower().replace("_", "-").replace(" ", "-"))

    return index


SEARCH_STRATEGIES = ("voxel-traversal", "compactness")
INTERPOLATIONS = ("neighbor-mean", "membrane", "thin-plate", "adaptive", "cubic-spline")
OUTWARD_TESTS = ("exact", "inward-normal")
BOUNDARY_EDGES = ("follow-surface", "straight", "own-elevations")
LATTICE_MODES = ("automatic", "off")
COLOURS = ("elevation", "error")
FAULTS_Z = ("automatic", "given", "drape")
DUPLICATES = ("keep-first", "keep-last", "keep-lowest", "keep-highest")


@dataclasses.dataclass(frozen=True)
class Property:
    """A property of the chain: which filter has it, and what it takes."""

    step: str  # delaunay, trim, fill; "" for all three; faults for what is done to them before
    setter: str
    convert: object  # raises ValueError for what the property does not take
    takes: str  # what it takes, in words


NUMBER = "a number of 0 or more"
COUNT = "a whole number of 0 or more"
YES_OR_NO = "True or False"


def _choice(step, setter, names):
    return Property(step, setter, one_of(*names), "one of " + ", ".join(names))


# Names are those of the command line. What is not given stays as the filters have it.
PROPERTIES = {
    "maximum_edge_length": Property(
        "delaunay", "SetMaximumEdgeLength", number_at_least_zero, NUMBER
    ),
    "maximum_elevation_error": Property(
        "delaunay", "SetMaximumElevationError", number_at_least_zero, NUMBER
    ),
    "data_dependent_edges": Property("delaunay", "SetDataDependentEdges", yes_or_no, YES_OR_NO),
    "duplicates": _choice("delaunay", "SetDuplicatePolicy", DUPLICATES),
    "lattice_mode": _choice("delaunay", "SetLatticeMode", LATTICE_MODES),
    "lattice_tolerance": Property(
        "delaunay", "SetLatticeTolerance", number_up_to_a_quarter, "a number from 0 to 0.25"
    ),
    "search_strategy": _choice("delaunay", "SetSearchStrategy", SEARCH_STRATEGIES),
    "outward_test": _choice("trim", "SetOutwardTest", OUTWARD_TESTS),
    "gap_tolerance": Property("trim", "SetGapTolerance", number_at_least_zero, NUMBER),
    "recover_boundary": Property("trim", "SetRecoverBoundary", yes_or_no, YES_OR_NO),
    "boundary_edges": _choice("trim", "SetBoundaryEdges", BOUNDARY_EDGES),
    "open_edge_length": Property("fill", "SetMaximumEdgeLength", number_at_least_zero, NUMBER),
    "maximum_hole_size": Property("fill", "SetMaximumHoleSize", number_at_least_zero, NUMBER),
    "maximum_hole_edges": Property("fill", "SetMaximumHoleEdges", count_at_least_zero, COUNT),
    "fill_cut_outs": Property("fill", "SetFillCutOuts", yes_or_no, YES_OR_NO),
    "maximum_expected_points": Property(
        "fill", "SetMaximumNumberOfExpectedPoints", count_at_least_zero, COUNT
    ),
    "spacing": Property("fill", "SetSpacing", number_at_least_zero, NUMBER),
    "interpolation": _choice("fill", "SetInterpolation", INTERPOLATIONS),
    "interpolate_point_data": Property("fill", "SetInterpolatePointData", yes_or_no, YES_OR_NO),
    "faults_z": _choice("faults", "", FAULTS_Z),
    "threads": Property("", "SetNumberOfThreads", count_at_least_zero, COUNT),
}


def option_of(name):
    """maximum_edge_length -> --maximum-edge-length"""
    return "--" + name.replace("_", "-")


def checked(properties: dict[str, Any]) -> dict[str, Any]:
    """{name: value as the filters take it}. Raises TypeError and ValueError with one clear line."""
    result = {}
    for name, value in properties.items():
        if name not in PROPERTIES:
            raise TypeError(
                f"reconstruct() has no property {name}{did_you_mean(name, list(PROPERTIES))}"
            )
        if value is None:
            continue
        try:
            result[name] = PROPERTIES[name].convert(value)
        except (TypeError, ValueError, OverflowError):
            raise ValueError(f"{name} takes {PROPERTIES[name].takes}, not {value!r}") from None
    check_together(result)
    return result


def check_together(given, name_of=str):
    """Raises ValueError for properties that do not go with each other. name_of: as they are called."""
    names = ("maximum_edge_length", "maximum_elevation_error")
    if all(given.get(name) for name in names):
        words = " and ".join(name_of(name) for name in names)
        raise ValueError(f"{words} cannot be used together: fewer points make longer edges")
    if given.get("data_dependent_edges") and not given.get("maximum_elevation_error"):
        needs, needed = name_of("data_dependent_edges"), name_of("maximum_elevation_error")
        raise ValueError(f"{needs} needs {needed}: with all points, edges are Delaunay")
