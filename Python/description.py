# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The description of all properties, properties.ini, as Python has it.

It needs Python alone, neither VTK nor numpy: the build reads it too.
"""

from __future__ import annotations

import configparser
import dataclasses
import math
import os
import re


def view_angles(view):
    """(bearing, height) of "top", of "BEARING,HEIGHT", or of two numbers. Raises ValueError."""
    if view == "top":
        return (180.0, 90.0)
    bearing, height = (float(a) for a in (view.split(",") if isinstance(view, str) else view))
    if not 0 < height <= 90 or not math.isfinite(bearing):
        raise ValueError("view takes (bearing, height) with a height above 0 and at most 90")
    return (bearing % 360.0, height)


def pixels(text):
    """A number above 0, FILE of "like FILE", or "". Raises ValueError."""
    word, _, path = text.partition(" ")
    return path.strip() if word == "like" and path.strip() else text and KINDS["step"].convert(text)


def file_or_number(text):
    """A number if it is one, else the name of a file. Raises ValueError where it is neither."""
    try:
        number = float(text)
    except ValueError:
        return named(text)
    if not math.isfinite(number):
        raise ValueError
    return number


def named(text):
    """Text that names something. Raises ValueError where it is none."""
    if not isinstance(text, str) or not text.strip():
        raise ValueError
    return text


@dataclasses.dataclass(frozen=True)
class Kind:
    """What a property takes.

    metavar  of the option; "" where it takes no value
    value_type  of the values of a panel: double, int, bool, string
    words    what it takes, where that is not its range
    make     makes the value of what is given, where that is not its range; raises ValueError
    least, most  its range; is_above: the least itself is none
    unit     in words
    choices  of an enumeration, whose values are places in this list
    """

    metavar: str
    value_type: str = "string"
    words: str = ""
    make: object = None
    least: float = 0
    most: float = math.inf
    is_above: bool = False
    unit: str = ""
    choices: tuple = ()

    @property
    def takes(self):
        """In words, for errors."""
        words = "a whole number" if self.value_type == "int" else "a number"
        if self.is_above:
            words += f" above {self.least}"
        elif self.most < math.inf:
            words += f" from {self.least} to {self.most}"
        else:
            words += f" from {self.least}" if self.least else " of 0 or more"
        return self.words or words

    def convert(self, value):
        """The value that the filters take of what is given. Raises ValueError, TypeError."""
        if self.make or self.value_type == "string":
            return self.make(value) if self.make else value
        if self.choices:
            return self.choices.index(str(value).lower().replace("_", "-").replace(" ", "-"))
        if self.value_type == "bool":
            return bool([False, True].index(value))
        number = int(value) if self.value_type == "int" else float(value)
        most = min(self.most, 2**63 - 1) if self.value_type == "int" else self.most
        is_within = self.least <= number <= most and number < math.inf
        if number != float(value) or not is_within or (self.is_above and number == self.least):
            raise ValueError
        return number

    def numbers(self, words):
        """The numbers of a default: "0 0 0 0", "keep-first", "on"."""
        if self.choices:
            return [self.choices.index(words)]
        if self.value_type == "bool":
            return [int(words == "on")]
        return [float(word) if self.value_type == "double" else int(word) for word in words.split()]


VIEW = "top, or BEARING,HEIGHT in degrees with a height above 0 and at most 90, as 225,35"
KINDS = {
    "flag": Kind("", "bool", "True or False"),  # off unless it is given
    "switch": Kind("", "bool", "True or False"),
    "length": Kind("LENGTH", "double", unit="units of x and y"),
    "height": Kind("HEIGHT", "double", unit="units of z"),
    "spacings": Kind("SPACINGS", "double", unit="point spacings"),
    "factor": Kind("FACTOR", "double"),
    "probability": Kind("PROBABILITY", "double", least=0.5, most=0.999),
    "steps": Kind("STEPS", "double", most=0.25, unit="steps of the grid"),
    "numbers": Kind("NUMBERS", "double", "numbers"),
    "count": Kind("COUNT", "int"),
    "threads": Kind("NUMBER", "int", most=1024),
    "ordinal": Kind("NUMBER", "int", least=1),
    "step": Kind("STEP", "double", is_above=True, unit="units of x and y, or of z"),
    "pixels": Kind(
        "[STEP|like FILE]", words="a number above 0, or like FILE, or nothing where the points are from a grid",
        make=pixels,
    ),
    "surface or level": Kind("FILE|LEVEL", words="the file of a surface, or a finite level", make=file_or_number),
    "elevation": Kind("VALUE", "string", "an elevation", float, unit="units of z"),
    "text": Kind("TEXT", words="text"),
    "name": Kind("NAME", words="a name", make=named),
    "column": Kind("COLUMN", words="a column"),
    "columns": Kind("X,Y,Z", words="three columns by name or number from 1, as x,y,z or 1,2,3"),
    "classes": Kind("N,N", words="numbers from 0 to 255, as 2,8"),
    "where": Kind("COLUMN=VALUE", words="COLUMN=VALUE, as horizon=Top"),
    "lines": Kind("FILE", words="a file"),
    "file": Kind("FILE", words="a file"),
    "file or nothing": Kind("[FILE]", words="a file, or nothing"),
    "size": Kind("SIZE", words="a size, such as 2G"),
    "reference system": Kind("CRS", words="a coordinate reference system, as EPSG:25832"),
    "view": Kind("top|BEARING,HEIGHT", "string", VIEW, view_angles),
}


def titled(choice):
    """own-elevations -> Own Elevations, as panels have it"""
    return choice.replace("-", " ").title()


class Property:
    """A property as properties.ini describes it; its head explains what stands there."""

    def __init__(self, name, words):
        self.name, self.words = name, words
        self.line = words["line"]
        self.step = words["step"] if words["step"] != "all" else ""
        self.places = words.get("in", "program filter chain").split()
        choices = tuple(words["takes"].split(", "))
        self.kind = KINDS.get(words["takes"]) or Kind(
            f"{{{','.join(choices)}}}", "int", "one of " + ", ".join(choices), choices=choices
        )
        self.takes, self.choices = self.kind.takes, self.kind.choices
        self.convert = self.kind.convert
        self.in_pieces = "pieces" not in words
        self.contents = words.get("contents", "points").split()
        self.readers = words.get("readers", "").split()
        self.setter = f"Set{self.name_in('filter')}" if "filter" in self.places else ""

    def name_in(self, place):
        """MaximumEdgeLength; for the program --maximum-edge-length."""
        if place == "program":
            return self.options[-1]
        return self.words.get(place, self.name.title().replace("_", ""))

    @property
    def options(self):
        """Those of the program."""
        return self.words.get("program", "--" + self.name.replace("_", "-")).split()

    def label_in(self, place):
        name = self.name_in(place)
        return self.words.get("label") or re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)

    def default_in(self, place):
        """In words, as properties.ini has it; "" where there is none."""
        default = self.words.get("default", "off" if self.kind.value_type == "bool" else "")
        return self.words.get("default." + place, default)

    def help_in(self, place):
        """The help where the program, a class or an entry in Python shows it."""
        more = {"program": ("chain", "program"), "chain": ("panel", "chain")}.get(place, (place,))
        parts = [self.words["help"], *(self.words.get(f"help.{part}", "") for part in more)]

        def named(found):
            other = DESCRIBED[found.group(1)]
            return other.options[0] if place == "program" else other.label_in(place)

        words = re.sub(r"{(\w+)}", named, " ".join(" ".join(parts).split()))
        if place == "program":  # there choices are called as they are given
            for choice in self.choices:
                words = re.sub(rf"\b{titled(choice)}\b", choice, words)
        return words

    def rules(self):
        """[(whether it needs one of the others, their names, the words of a refusal)]"""
        found = []
        for rule in ("needs", "excludes"):
            if rule in self.words:
                others, words = self.words[rule].split(": ", 1)
                groups = [others.split()] if rule == "needs" else [[other] for other in others.split()]
                found += [(rule == "needs", group, words) for group in groups]
        return found


def described():
    """{name: Property}, in the order of properties.ini."""
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "properties.ini")
    parser = configparser.ConfigParser(interpolation=None)
    with open(path, encoding="utf-8") as stream:
        parser.read_file(stream)
    return {name: Property(name, dict(parser[name])) for name in parser.sections()}


DESCRIBED = described()


def listing(names):
    """A decorator that puts a line for each property in place of {properties} in a docstring."""

    def add(function):
        lines = [f"{name}: {DESCRIBED[name].line}" for name in names if name in DESCRIBED]
        function.__doc__ = function.__doc__ and re.sub(
            r"( *){properties}",
            lambda found: ";\n".join(found.group(1) + line for line in lines),
            function.__doc__,
        )
        return function

    return add
