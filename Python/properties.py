# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The properties of the chain of filters: their names, what they take, and how that is checked."""

from __future__ import annotations

from typing import Any

from .description import DESCRIBED
from .messages import did_you_mean

# Those of the filters, as the command line calls them. What is not given stays as the filters have it.
PROPERTIES = {
    name: one
    for name, one in DESCRIBED.items()
    if {"program", "chain"} <= set(one.places)
    and (one.setter or one.step == "faults")
    and one.words["takes"] != "lines"
}
BOUNDARY_EDGES, COLOURS, DUPLICATES, FAULTS_Z, INTERPOLATIONS, LATTICE_MODES, METHODS = (
    DESCRIBED[name].choices
    for name in ("boundary_edges", "colours", "duplicates", "faults_z", "interpolation", "lattice_mode", "method")
)
# Switches of the filters that the chain sets the other way, unless they are given.
TURNED = {
    name: one.default_in("chain") == "on"
    for name, one in PROPERTIES.items()
    if one.words["takes"] == "switch" and one.default_in("chain") != one.default_in("filter")
}
FEWER = ("maximum_number_of_points", "maximum_elevation_error")  # what makes a surface of few points


def checked(properties: dict[str, Any], name_of=str) -> dict[str, Any]:
    """{name: value as the filters take it}. Raises TypeError and ValueError with one clear line.

    name_of  makes of a name what it is called where it was given
    """
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
            takes = PROPERTIES[name].takes
            raise ValueError(f"{name_of(name)} takes {takes}, not {value!r}") from None
    check_together(result, name_of)
    return result


def check_together(given, name_of=str, among=PROPERTIES):
    """Raises ValueError for properties that do not go with each other.

    given    {name: value}; None and False are as if it were not given, and 0 excludes nothing
    name_of  makes of a name what it is called where it was given
    among    the names that can be given there
    """
    for name, value in given.items():
        if value is None or value is False:
            continue
        for needs, others, words in DESCRIBED[name].rules():
            names = " or ".join(name_of(other) for other in others)
            is_given = [given.get(other) not in (None, False, 0) for other in others if other in among]
            if needs and is_given and not any(is_given):
                raise ValueError(f"{name_of(name)} {words.format(names)}")
            if not needs and value and any(is_given):
                raise ValueError(f"{name_of(name)} and {names} {words}")


def is_simplified(given):
    """Whether a surface of few points is wanted, with an elevation error or a number of points."""
    return any(given.get(name) for name in FEWER)


def set_properties(algorithm, step, given):
    """Gives a filter of the chain the properties that are its own, as checked() has them. Returns it.

    Unused points are removed at the end of the chain: reports need all of them.
    """
    for name, value in {**TURNED, **given}.items():
        is_own = PROPERTIES[name].step in (step, "") and name != "remove_unused_points"
        if is_own and PROPERTIES[name].setter:
            getattr(algorithm, PROPERTIES[name].setter)(value)
    return algorithm
