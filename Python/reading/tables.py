# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What is known of tables of text: tables.ini as Python has it. The head of that file explains it."""

import configparser
import functools
import os
import types


@functools.lru_cache(maxsize=None)
def known():
    """The tables, read when the first of them is asked for.

    axes         {name: (axis, rank, direction)}
    not_tables   [(pattern, words of an error)]; grids are such, too
    not_numbers  [(pattern, share of lines, words of an error)]
    """
    parser = configparser.ConfigParser(interpolation=None, delimiters="=")
    parser.optionxform = str  # names as they are written
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "tables.ini")
    with open(path, encoding="utf-8") as stream:
        parser.read_file(stream)

    def each(section, convert):
        return {name: convert(value) for name, value in parser[section].items()}

    def words(text):
        return frozenset(text.split())

    def numbers(text):
        return tuple(map(float, text.split()))

    def pattern(text):
        return text.replace("\n", "")

    def not_table(text):
        begin, *said = text.strip().split("\n")
        said = " ".join(said)
        return begin, refusals.get(said, said)

    def not_number(name, text):
        share, *lines = text.split("\n")
        return "".join(lines), float(share), refusals[name.rsplit(" ", 1)[0]]

    refusals = each("refusals", lambda text: " ".join(text.split()))
    keys = [(key.split(), names.split()) for key, names in parser["axes"].items()]
    return types.SimpleNamespace(
        axes={name: (axis, int(rank), "".join(what)) for (axis, rank, *what), names in keys for name in names},
        beside_axes=words(parser["beside axes"]["words"]),
        roles=each("roles", words),
        colours=each("colours", words),
        lengths=each("units of length", words),
        words=each("other words", words),
        letters=str.maketrans(each("letters", str)),
        lines=each("lines", words),
        finnish=each("finnish", str),
        x_is_north=each("x is north", str),
        signs=each("signs", lambda text: tuple(text.split())),
        separators={sign.replace("\\t", "\t") or None: name for name, sign in parser["separators"].items()},
        refusals=refusals,
        grids=list(each("grids", not_table).values()),
        not_tables=list(each("not tables", not_table).values()),
        not_numbers=[not_number(*one) for one in parser["not numbers"].items()],
        patterns=each("patterns", pattern),
        nulls=each("nulls", numbers),
        weights=each("weights", float),
        figures=each("figures", float),
        parts_of_time=each("parts of time", numbers),
        times=[line.split(", ") for line in parser["times"]["orders"].strip().split("\n")],
    )
