# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the name of a column means: an axis, or something else, in nine languages and words of others."""

import dataclasses
import functools
import re
import unicodedata

from .tables import known


def plain(text):
    """Without accents, apart at capitals, signs and scripts: "Höhe_NN (m)" -> ["hohe", "nn", "m"],
    "X座標" -> ["x", "座標"]."""
    text = re.sub("Ø(?=[A-Z])", "OE", text)
    text = unicodedata.normalize("NFKD", text.translate(known().letters))
    text = "".join(letter for letter in text if not unicodedata.combining(letter))
    text = unicodedata.normalize("NFC", text)
    text = re.sub(r"([a-z])([A-Z])|([A-Z])([A-Z][a-z])", r"\1\3 \2\4", text)
    beside = r"(utm|p|pos|coord\w*|koord\w*)?"
    text = re.sub(rf"\b{beside}([xyz]){beside}\b", r"\1 \2 \3", text.lower())
    return re.findall(r"[a-z]+|[^\W\d_a-z]+", text)


def in_brackets(name):
    """("X (Nord)") -> ("X ", " Nord")."""
    name = unicodedata.normalize("NFKC", name)
    return re.sub(r"[(\[{<].*", "", name), " ".join(re.findall(r"[(\[{<]([^)\]}>]*)", name))


@dataclasses.dataclass(frozen=True)
class Meaning:
    """What a name means: an axis with rank and direction, or the role of something else."""

    axis: str = ""
    rank: int = 0
    direction: str = ""
    role: str = ""
    beside: tuple = ()  # the words next to the name of the axis


@functools.lru_cache(maxsize=10_000)
def meaning(name):
    """The Meaning of a column's name; empty where it is not known."""
    outside, inside = in_brackets(name)
    words = plain(outside) or plain(inside)
    joined = "".join(words)
    for role, names in known().roles.items():
        whole = joined in names and (len(words) == 1 or len(joined) > 3)  # "X L" is no "xl"
        if whole or role == "a measure" and names.intersection(words):
            return Meaning(role=role)
    roles = [role for role, names in known().roles.items() if names.intersection(words) and min(map(len, words)) > 1]
    return _axis_meaning(words, joined, plain(inside)) or Meaning(role=(roles or [""])[0])


def _axis_meaning(words, joined, inside):
    """The Meaning of a name of an axis, or None."""
    axes, letters = known().axes, known().words["letters of axes"]
    named = [word for word in words if word in axes]
    # "Longitude_E": the word says more than the letter.
    found = [joined] if joined in axes else [w for w in named if w not in letters] or named
    found = [axes[word] for word in found]
    found += [axes[word] for word in inside if word in axes and axes[word][1] == 1]
    if len({axis for axis, *_ in found}) > 1:
        # "X (Nord)": the word says more than the letter.
        found = [one for one in found if one[1] == 1 and one[0] != "z"]
    if len({axis for axis, *_ in found}) != 1:
        return None
    axis, rank, _ = min(found)
    beside = [w for w in words if w not in axes and joined not in axes]
    heights = [w for w in named if axes[w][0] == axis == "z"]
    is_old = words[-1] == "alt" and len(set(heights)) > 1  # "Höhe_alt"
    if is_old or not known().words["beside axes"].issuperset(beside):
        if max(map(len, named), default=0) < 2 or rank == 4:
            return None  # a single letter among words that mean something else
        rank += 5
    return Meaning(axis, rank, max(direction for *_, direction in found), "", tuple(sorted(beside)))


def alike_but_for_axis(names):
    """{name: Meaning} of names that differ by x and y, and z, alone, as "xcollar" and "ycollar" do."""
    found = {}
    for name in names:
        for at in (match.start() for match in re.finditer("x", name)):
            alike = [name[:at] + axis + name[at + 1 :] for axis in "xyz"]
            if alike[1] in names:
                found.update({one: Meaning(axis, 8) for axis, one in zip("xyz", alike)})
    return found


def length_unit(name):
    """The unit of length in a column's name, as "feet" for "Z (ft)" and "elev_ft", or ""."""
    outside, inside = in_brackets(name)
    words = plain(inside) or plain(outside)[1:]
    return next((unit for unit, names in known().lengths.items() if words and words[-1] in names), "")


def z_direction(name):
    """"depth" or "time" where a name, or its unit in brackets, says that z counts downwards, or ""."""
    is_time = "".join(plain(in_brackets(name)[1])) in known().words["time"]
    return meaning(name).direction or ("time" if is_time else "")


def says_up(name):
    """Whether a name says that z counts upwards, as "Elevation" does and "Z" does not."""
    found = meaning(name)
    return found.axis == "z" and found.rank == 1 and not z_direction(name)


def names_horizon(name):
    """Whether the name of a file says that it holds a horizon, or depths."""
    words = plain(name)
    is_depth = any(len(word) > 4 and meaning(word).direction == "depth" for word in words)
    return is_depth or not known().words["horizons"].isdisjoint(words)


def known_names(names):
    """How many of some names mean something, those of axes most."""
    found = [meaning(name) for name in names]
    return sum(3 if m.axis and m.rank < 5 else 1 for m in found if m.axis or m.role)
