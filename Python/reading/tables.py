# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What is known of tables of text: tables.ini as Python has it. The head of that file explains it."""

import codecs
import configparser
import functools
import os
import re
import types

from ..messages import FileError

TABLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "tables.ini")
ASKED_FOR = {  # by name, so that they must be there
    "other words": "beside axes, time, horizons, seismic, letters of axes",
    "colours": "red, green, blue",
    "lines": "x, y",
    "finnish": "p, i",
    "signs": "comments, missing, encodings",
    "refusals": "thousands, sexagesimals, letters, shortened, commas twice",
    "patterns": "touching, date, shortened, grouped, pairs, sexagesimal, with decimals, numbered name, summary",
    "nulls": "values, rows",
    "weights": "one pair, as many decimals, as wide as high, z spans less, z is higher than any place, stands first, "
    "x rises, x is a line, a column is left out, x and y are of UTM, x and y count, z is flat or rises along lines, "
    "z behind lines",
    "figures": "good, clear, clear of poor, most step of lines, highest, most feet, least "
    "feet east, most feet north, middle of eov",
    "earth": "figures",
    "parts of time": "year, month, day, day of year, hour, minute, second",
    "times": "orders",
}


@functools.lru_cache(maxsize=None)
def known():
    """The tables, read when the first of them is asked for. Raises FileError.

    axes         {name: (axis, rank, direction)}
    not_tables   [(pattern, words of an error)]; grids are such, too
    not_numbers  [(pattern, share of lines, words of an error)]
    """
    parser = configparser.ConfigParser(interpolation=None, delimiters="=")
    parser.optionxform = str  # names as they are written
    try:
        with open(TABLES, encoding="utf-8") as stream:
            parser.read_file(stream)
        for section, names in ASKED_FOR.items():
            for name in set(names.split(", ")) - set(parser[section]):
                raise ValueError(f"[{section}] has no {name}")
            for name in names.split(", "):
                if not parser[section][name].strip():
                    raise ValueError(f"[{section}] {name} is empty")
        tables = converted(parser)
        check_counts(tables)
        return tables
    except KeyError as error:
        why = f"it has no {error}"
    except (OSError, configparser.Error, ValueError, re.error, LookupError) as error:
        why = " ".join(str(getattr(error, "strerror", error)).split())
    raise FileError(f"{TABLES}: what is known of tables cannot be read: {why}; install the package again")


def check_counts(tables):
    """Raises an error for an entry with fewer parts than are used, or with the name of something else that lacks."""
    figures = {"[earth] figures": (tables.earth, 4)}
    figures.update((f"[parts of time] {name}", (values, 3)) for name, values in tables.parts_of_time.items())
    for name, (values, count) in figures.items():
        if len(values) != count:
            raise ValueError(f"{name} needs {count} numbers")
    for name, count in (("numbered name", 2), ("summary", 1)):
        if tables.patterns[name].groups < count:
            raise ValueError(f"[patterns] {name} needs {count} groups")
    for part in sum(tables.times, []):
        tables.parts_of_time[part]
    for encoding in tables.signs["encodings"]:
        codecs.lookup(encoding)


def converted(parser):
    """The tables as they are used."""

    def each(section, convert=str):
        return {name: convert(text) for name, text in parser[section].items()}

    def words(text):
        return frozenset(text.split())

    def numbers(text):
        return tuple(map(float, text.split()))

    def lines(text):
        return text.strip().split("\n")

    refusals = each("refusals", lambda text: " ".join(lines(text)))
    axes = [(key.split(), names.split()) for key, names in parser["axes"].items()]
    shares = [(name.rsplit(" ", 1)[0], *lines(text)) for name, text in parser["not numbers"].items()]
    return types.SimpleNamespace(
        axes={name: (axis, int(rank), "".join(what)) for (axis, rank, *what), names in axes for name in names},
        words=each("other words", words),
        roles=each("roles", words),
        colours=each("colours", words),
        lengths=each("units of length", words),
        letters=str.maketrans(each("letters")),
        lines=each("lines", words),
        finnish=each("finnish"),
        x_is_north=each("x is north", re.compile),
        signs=each("signs", lambda text: tuple(text.split())),
        separators={sign.replace("\\t", "\t") or None: name for name, sign in parser["separators"].items()},
        refusals=refusals,
        not_tables=[(re.compile(begin), " ".join(said)) for begin, *said in each("not tables", lines).values()],
        not_numbers=[(re.compile("".join(parts)), float(share), refusals[name]) for name, share, *parts in shares],
        patterns=each("patterns", lambda text: re.compile("".join(lines(text)))),
        nulls=each("nulls", numbers),
        weights=each("weights", float),
        figures=each("figures", float),
        earth=numbers(parser["earth"]["figures"]),
        parts_of_time=each("parts of time", numbers),
        times=[line.split(", ") for line in lines(parser["times"]["orders"])],
    )
