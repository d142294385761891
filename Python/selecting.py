# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Points chosen by their values in a column: --where, --each-value, and --layer of a text file.

A column is an array of numbers, one for each point, or Words.
"""

import dataclasses
import shlex

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkBitArray, vtkDataArray, vtkStringArray

from .messages import FileError, Reason, counted, did_you_mean
from .names import argument, option

MOST_VALUES = 1000  # a column with more of them names no surfaces
SHOWN = 10  # values or columns in a message
BY_WHERE = Reason("point", "of other values")


def none_chosen():
    """The note where no point is left."""
    return f"{option('where')} leaves no point"


@dataclasses.dataclass
class Words:
    """A column of text: each point's place in a list of words; "" where it has none."""

    codes: numpy.ndarray
    values: list

    def some(self, keep):
        return Words(self.codes[keep], self.values)


class WordReader:
    """Collects the words of a column as they are read."""

    def __init__(self):
        self.codes, self.parts = {}, []

    def add(self, words):
        for word in dict.fromkeys(words):
            self.codes.setdefault(word, len(self.codes))
        codes = map(self.codes.__getitem__, words)
        self.parts.append(numpy.fromiter(codes, "i4", len(words)))

    def take(self):
        """Words since the last call."""
        parts, self.parts = self.parts, []
        return Words(numpy.concatenate([numpy.empty(0, "i4"), *parts]), list(self.codes))


def words_of(values):
    """Words of a list of words, or of None where there is none."""
    reader = WordReader()
    reader.add(["" if value is None else str(value) for value in values])
    return reader.take()


def joined_words(parts):
    """The Words of several columns, one behind the other."""
    known = {}
    for part in parts:
        for value in part.values:
            known.setdefault(value, len(known))
    codes = [
        numpy.array([known[value] for value in part.values], dtype="i4")[part.codes]
        for part in parts if len(part.codes)
    ]
    return Words(numpy.concatenate([numpy.empty(0, "i4"), *codes]), list(known))


def columns_in(cloud):
    """{name: column} of all columns of a Cloud but x, y and z."""
    found = dict(cloud.words)
    data = cloud.points.GetPointData()
    for i in range(data.GetNumberOfArrays()):
        array = data.GetAbstractArray(i)
        if array.GetNumberOfComponents() != 1 or not array.GetName():
            continue
        if isinstance(array, vtkStringArray):
            count = array.GetNumberOfValues()
            found[array.GetName()] = words_of([array.GetValue(k) for k in range(count)])
        elif isinstance(array, vtkDataArray) and not isinstance(array, vtkBitArray):
            found[array.GetName()] = vtk_to_numpy(array)
    return found


def conditions_of(where):
    """[(column, value)] of "COLUMN=VALUE", of a list of such, or of {column: value or values}.

    Values become text. Raises ValueError.
    """
    if isinstance(where, dict):
        where = [
            (column, value)
            for column, values in where.items()
            for value in (values if isinstance(values, (list, tuple, set)) else [values])
        ]
    found = []
    for one in [where] if isinstance(where, str) else where:
        column, sign, value = one.partition("=") if isinstance(one, str) else (one[0], "=", one[1])
        if not sign or not str(column).strip():
            raise ValueError(f"{argument('where')} takes COLUMN=VALUE, as horizon=Top, not {one}")
        found.append((str(column).strip(), str(value).strip()))
    return found


def condition(text):
    """(column, value) of COLUMN=VALUE. Raises ValueError."""
    return conditions_of(text)[0]


def as_option(column, value):
    """--where 'Horizon name=Top A'"""
    return f"{option('where')} {shlex.quote(f'{column}={value}')}"


def written(number):
    """A number of a column as text that makes the same number: 3, not 3.0."""
    number = float(number)
    return str(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)


def coded(column):
    """(the number of each point's value, or -1 where it has none; the values as text, in order)."""
    if isinstance(column, Words):
        there, codes = numpy.unique(column.codes, return_inverse=True)
        values = [column.values[code] for code in there.tolist()]
    else:
        there, codes = numpy.unique(column, return_inverse=True)
        values = [written(value) if numpy.isfinite(value) else "" for value in there]
    order = [i for i in range(len(values)) if values[i] != ""]
    if isinstance(column, Words):
        order.sort(key=lambda i: values[i])
    place = numpy.full(len(values), -1)
    place[order] = numpy.arange(len(order))
    return place[codes.ravel()], [values[i] for i in order]


def value_counts(column):
    """{value: number of points that have it}"""
    codes, values = coded(column)
    counts = numpy.bincount(codes[codes >= 0], minlength=len(values)).tolist()
    return dict(zip(values, counts))


def shown_values(column):
    """The values of a column with the number of points of each, in words."""
    return shown_counts(value_counts(column))


def in_order(counts):
    """The same {value: count}, by the size of the values or, where not all are numbers, by their words."""
    try:
        return {value: counts[value] for value in sorted(counts, key=float)}
    except ValueError:
        return {value: counts[value] for value in sorted(counts)}


def shown_counts(counts):
    words = [f"{value} ({count:,})" for value, count in counts.items()]
    more = f", and {len(words) - SHOWN:,} more" if len(words) > SHOWN else ""
    return (", ".join(words[:SHOWN]) or "none") + more


def column_of(path, name, columns):
    """The name of the column that is meant, which may have other capitals. Raises FileError."""
    if name in columns:
        return name
    alike = [known for known in columns if known.strip().lower() == name.strip().lower()]
    if len(alike) == 1:
        return alike[0]
    numbered = f"column {name}"  # of a text file without names
    if numbered in columns:
        return numbered
    known = ", ".join(list(columns)[:SHOWN]) or "none"
    more = f", and {len(columns) - SHOWN} more" if len(columns) > SHOWN else ""
    raise FileError(
        f"{path}: there is no column {name} besides x, y and z{did_you_mean(name, list(columns))}; "
        f"columns: {known}{more}"
    )


def are_equal(path, name, column, value):
    """(n,) of bool: which points have a value, which is text. Raises FileError for no number."""
    if isinstance(column, Words):
        return column.codes == (column.values.index(value) if value in column.values else -1)
    if value == "":
        return ~numpy.isfinite(column)
    try:
        return column == float(value)
    except ValueError:
        raise FileError(
            f"{path}: column {name} holds numbers, and '{value}' is none; values: "
            f"{shown_values(column)}"
        ) from None


class NothingChosen(FileError):
    """A file without points that --where keeps; others may have some."""


class Selection:
    """The points that --where keeps: of each column that it names, one of the values.

    count  how many were left out
    found  {column: {value that is wanted: how many points have it}}
    seen   {column: {value: how many points have it}} for errors
    """

    def __init__(self, path, conditions):
        self.path, self.wanted, self.count = path, {}, 0
        for name, value in conditions:
            self.wanted.setdefault(name, []).append(value)
        self.found, self.seen = {}, {}

    def keep(self, columns):
        """(n,) of bool for the points of a cloud, or of a part of it, with these columns."""
        keep = True
        for name, values in self.wanted.items():
            name = column_of(self.path, name, columns)
            here, found = False, self.found.setdefault(name, {})
            for value in values:
                equal = are_equal(self.path, name, columns[name], value)
                found[value] = found.get(value, 0) + int(numpy.count_nonzero(equal))
                here = here | equal
            if self.missing(name):
                self.note_values(name, columns[name])
            keep = keep & here
        self.count += int(numpy.count_nonzero(~keep))
        return keep

    def facts(self):
        """What was found, as plain values that can be added to those of other points."""
        return {"count": self.count, "found": self.found, "seen": self.seen}

    def take(self, facts):
        """Takes the facts of all points as its own."""
        self.count, self.found, self.seen = facts["count"], facts["found"], facts["seen"]

    def missing(self, name):
        """The wanted values of a column that no point has had so far."""
        return [value for value, count in self.found[name].items() if not count]

    def note_values(self, name, column):
        """Remembers what values there are, for an error."""
        known = self.seen.setdefault(name, {})
        for value, count in value_counts(column).items():
            if value in known or len(known) < MOST_VALUES:
                known[value] = known.get(value, 0) + count

    def check(self, any_left):
        """Notes on values that no point has. Raises NothingChosen where that leaves no point."""
        notes = []
        for name in self.found:
            known = in_order(self.seen.get(name, {}))
            for value in self.missing(name):
                notes.append(
                    f"no point has {name} = {value or 'nothing'}"
                    f"{did_you_mean(value, known) if value else ''}; values: {shown_counts(known)}"
                )
        if not any_left and self.found:
            words = " and ".join(
                as_option(name, value)
                for name in sorted(self.found)
                for value in sorted(self.found[name]) if self.found[name][value]
            )
            words = notes[0] if notes else f"no point is left by {words} together"
            raise NothingChosen(f"{self.path}: {words}")
        return notes

    def add_to(self, left_out, reason=BY_WHERE):
        if self.count:
            left_out[reason] = self.count


def select(path, cloud, conditions, reason=BY_WHERE):
    """Leaves the points of a Cloud that meet [(column, value)]. Raises FileError."""
    from .clouds import keep_points

    selection = Selection(path, conditions)
    keep = selection.keep(columns_in(cloud))
    cloud.notes += selection.check(keep.any())
    selection.add_to(cloud.left_out, reason)
    if selection.count:
        keep_points(cloud, numpy.flatnonzero(keep))


def layer_condition(path, name, columns):
    """(column, value) for the column of text that holds the name of a layer. Raises FileError."""
    texts = {title: column for title, column in columns.items() if isinstance(column, Words)}
    holding = [title for title, column in texts.items() if name in column.values and name]
    if len(holding) == 1:
        return holding[0], name
    if holding:
        ways = " or ".join(as_option(title, name) for title in holding)
        raise FileError(f"{path}: several columns hold {name}; choose {ways}")
    few = {title: column for title, column in texts.items() if len(column.values) <= MOST_VALUES}
    known = [value for column in few.values() for value in column.values]
    words = "; ".join(f"{title}: {shown_values(column)}" for title, column in few.items())
    raise FileError(
        f"{path}: no column of text holds {name}{did_you_mean(name, known)}; "
        f"{words or 'there is no column of text'}"
    )


def values_to_make(path, name, columns):
    """(name of the column, how many points have no value in it, the values as text), for a surface
    each. Raises FileError."""
    name = column_of(path, name, columns)
    codes, values = coded(columns[name])
    if not values:
        raise FileError(f"{path}: column {name} is empty")
    if len(values) > MOST_VALUES:
        raise FileError(
            f"{path}: column {name} has {counted(len(values), 'value')}, and {option('each_value')} makes a "
            f"surface of each, at most {MOST_VALUES:,}: choose a column that names surfaces, or "
            f"some values by {option('where')}"
        )
    return name, int(numpy.count_nonzero(codes < 0)), values
