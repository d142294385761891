# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the name of a column means: an axis, or something else, in nine languages and some more."""

import dataclasses
import re
import unicodedata

from .known import (
    ABBREVIATED, AXES, NEXT_TO_AXES, HORIZONS, LETTERS, LETTERS_OF_AXES, ROLES, SEISMIC, UNITS, UNITS_OF_TIME
)


def plain(text):
    """Without accents, apart at capitals and signs: "Höhe_NN (m)" -> ["hohe", "nn", "m"]."""
    text = re.sub("Ø(?=[A-Z])", "OE", text)
    text = unicodedata.normalize("NFKD", text.translate(LETTERS))
    text = "".join(letter for letter in text if not unicodedata.combining(letter))
    text = re.sub(r"([a-z])([A-Z])|([A-Z])([A-Z][a-z])", r"\1\3 \2\4", text)
    beside = r"(utm|p|pos|coord\w*|koord\w*)?"
    text = re.sub(rf"\b{beside}([xyz]){beside}\b", r"\1 \2 \3", text.lower())
    return [word for word in re.split(r"[^a-z]+", text) if word]


def in_brackets(name):
    """("X (Nord)") -> ("X ", " Nord")."""
    return re.sub(r"[(\[{<].*", "", name), " ".join(re.findall(r"[(\[{<]([^)\]}>]*)", name))


@dataclasses.dataclass(frozen=True)
class Meaning:
    """What a name means: an axis with rank and direction, or the role of something else."""

    axis: str = ""
    rank: int = 0
    direction: str = ""
    role: str = ""
    beside: tuple = ()  # the words next to the name of the axis


def meaning(name):
    """The Meaning of a column's name; empty where it is not known."""
    outside, inside = in_brackets(name)
    words = plain(outside) or plain(inside)
    joined = "".join(words)
    for role, names in ROLES:
        whole = joined in names and (len(words) == 1 or len(joined) > 3)  # "X L" is no "xl"
        whole |= joined in names & ABBREVIATED
        if whole or role == "a measure" and any(word in names for word in words):
            return Meaning(role=role)
    extra = [w for w in plain(inside) if any(w in names and r == 1 for _, r, _, names in AXES)]
    axis = _axis_of(words, joined, extra)
    if axis:
        return axis
    for role, names in ROLES:
        if words and any(word in names for word in words) and not any(len(w) == 1 for w in words):
            return Meaning(role=role)
    return Meaning()


def _axis_of(words, joined, extra):
    whole = [(a, r, d) for a, r, d, names in AXES if joined in names]
    found = [(a, r, d, w) for a, r, d, names in AXES for w in words if w in names]
    # "Longitude_E": the word says more than the letter.
    found = [one for one in found if one[3] not in LETTERS_OF_AXES] or found
    found = whole or [one[:3] for one in found]
    found += [(a, r, d) for a, r, d, names in AXES for w in extra if w in names]
    if not found:
        return None
    if len({axis for axis, _, _ in found}) > 1:
        # "X (Nord)": the word says more than the letter.
        found = [(a, r, d) for a, r, d in found if r == 1 and a != "z"]
        if len({axis for axis, _, _ in found}) != 1:
            return None
    axis, rank, direction = min(found)
    direction = max(d for _, _, d in found)
    known = frozenset().union(*(names for _, _, _, names in AXES))
    beside = tuple(w for w in words if w not in known) if not whole else ()
    strange = [word for word in beside if word not in NEXT_TO_AXES]
    if axis == "z" and "alt" in words and len(words) > 1 and any(
        w != "alt" and w in names for a, _, _, names in AXES if a == "z" for w in words
    ):
        strange.append("alt")  # "Höhe_alt": the old one
    if strange:
        if max(len(word) for word in words if word in known) < 2 or rank == 4:
            return None  # a single letter among words that mean something else
        rank += 5
    return Meaning(axis, rank, direction, "", tuple(sorted(beside)))


def unit_of(name):
    """The unit of length in a column's name, as "feet" for "Z (ft)" and "elev_ft", or ""."""
    outside, inside = in_brackets(name)
    words = plain(inside) or plain(outside)[1:]
    return next((unit for unit, names in UNITS.items() if words and words[-1] in names), "")


def direction_of(name):
    """"depth" or "time" where a name, or its unit in brackets, says that z counts downwards, or ""."""
    is_time = "".join(plain(in_brackets(name)[1])) in UNITS_OF_TIME
    return meaning(name).direction or ("time" if is_time else "")


def says_up(name):
    """Whether a name says that z counts upwards, as "Elevation" does and "Z" does not."""
    found = meaning(name)
    return found.axis == "z" and found.rank == 1 and not direction_of(name)


def is_of_horizon(name):
    """Whether the name of a file says that it holds a horizon, or depths."""
    return any(
        word in HORIZONS or len(word) > 4 and meaning(word).direction == "depth"
        for word in plain(name)
    )


def is_seismic(name):
    """Whether a name is that of a line or trace of a seismic survey."""
    return "".join(plain(name)) in SEISMIC


def stands_beside_axis(name):
    """Whether a word may stand next to the name of an axis, as "coordinate" does."""
    return all(word in NEXT_TO_AXES for word in plain(name))


def known_names(names):
    """How many of some names mean something, those of axes most."""
    found = [meaning(name) for name in names]
    return sum(3 if m.axis and m.rank < 5 else 1 for m in found if m.axis or m.role)
