# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which columns of a table are x, y and z: by their names, else by their values.

A choice that is not sure becomes a note that tells why; of two that are about as likely, an error
shows both.
"""

import dataclasses
import math
import re

import numpy

from .column_names import COLOURS, Meaning, in_brackets, is_seismic, meaning, plain
from ..messages import FileError
from ..names import option


@dataclasses.dataclass
class Choice:
    """What was found out about the columns.

    indices     of x, y and z
    extras      {index: name} of the other columns of numbers
    texts       {index: name} of the columns of text
    of_numbers  indices of all columns that hold more numbers than text
    """

    indices: list
    extras: dict
    of_numbers: list
    notes: list
    z_name: str = ""  # what z is called, with its unit
    is_horizon: bool = False  # whether lines and traces of a seismic survey stand beside
    texts: dict = dataclasses.field(default_factory=dict)


def advice_on_columns():
    """What a user can do who may choose columns."""
    return f"{option('columns')} chooses other columns"


@numpy.errstate(all="ignore")
def choose_columns(path, rows, consecutive, number, names, width, columns, needed, advice):
    """Finds the columns of x, y and z, or of x and y. Returns a Choice. Raises FileError.

    rows         some rows as words; the first so many (consecutive) follow each other in the file
    number       makes a number of a word: NaN where it is missing, None for text
    names, width  of the columns; names may be None
    columns      None, or what the user said: names or numbers
    needed       3 or 2
    advice       what a user can do where no choice is sure; None: choose columns
    """
    search = Search(path, rows, consecutive, number, names, width, needed, advice)
    if columns:
        search.use_given(columns)
    elif not search.by_names():
        search.by_values()
    search.look_at_values()
    extras = search.extras()
    shares = numpy.isfinite(search.values).mean(axis=0)
    of_numbers = [i for i in range(width) if shares[i] > search.share_of_text[i]]
    z_name = names[search.indices[-1]] if names and needed == 3 else ""
    is_horizon = any(map(is_seismic, names)) if names else search.has_line_and_trace
    return Choice(
        search.indices, extras, of_numbers, search.notes, z_name, is_horizon, search.texts
    )


class Search:
    """The state of choose_columns()."""

    def __init__(self, path, rows, consecutive, number, names, width, needed, advice):
        self.path, self.names, self.width, self.needed = path, names, width, needed
        self.axes, self.has_line_and_trace, self.has_swapped = "xyz"[:needed], False, False
        self.ids = set()  # columns that are so by their values
        self.can_be_chosen, self.advice = advice is None, advice or advice_on_columns()
        self.row = next((row for row in rows if len(row) >= width), rows[0])
        table = [[number(w) for w in row[:width]] + [math.nan] * (width - len(row)) for row in rows]
        text = numpy.array([[value is None for value in row] for row in table], dtype=bool)
        self.values = numpy.array(
            [[math.nan if value is None else value for value in row] for row in table], dtype="f8"
        )
        self.consecutive = consecutive
        self.share_of_text = text.mean(axis=0)
        self.decimals = [
            max(len(re.sub(r"^[^.,]*[.,]?|[eEdD].*$", "", row[i])) if i < len(row) else 0
                for row in rows[:500])
            for i in range(width)
        ]
        self.meanings = [meaning(name) for name in names] if names else [Meaning()] * width
        letters = {"".join(plain(name)) for name in names or []}
        if not {"r", "g", "b"} <= letters:  # single letters are colours only together
            lone = [i for i, name in enumerate(names or []) if "".join(plain(name)) in "rgb"]
            self.meanings = [Meaning() if i in lone else m for i, m in enumerate(self.meanings)]
        if {"p", "i"} <= letters and not letters & set("nexy"):  # Finnish: pohjoinen, itä
            finnish = {"p": Meaning("y", 2), "i": Meaning("x", 2)}
            self.meanings = [
                finnish.get("".join(plain(name)), m) for name, m in zip(names, self.meanings)
            ]
        self.indices, self.notes, self.texts = None, [], {}

    # -- what the user said

    def use_given(self, columns):
        plain_names = ["".join(plain(in_brackets(name)[0])) for name in self.names or []]
        self.indices = []
        for axis, column in zip(self.axes, columns):
            if re.fullmatch(r"\d+", column):
                index = int(column) - 1
                if not 0 <= index < self.width:
                    raise FileError(
                        f"{self.path}: there is no column {column} for {axis}; "
                        f"lines have {self.width}"
                    )
            elif column in (self.names or []):
                index = self.names.index(column)
            elif "".join(plain(column)) in plain_names:
                index = plain_names.index("".join(plain(column)))
            else:
                known = ", ".join(self.names or []) or "none: the file has no header line"
                raise FileError(f"{self.path}: there is no column named {column}; names: {known}")
            if index in self.indices:
                other = self.axes[self.indices.index(index)]
                raise FileError(
                    f"{self.path}: {option('columns')} takes both {other} and {axis} from column "
                    f"{self.called(index)}; each needs a column of its own"
                )
            self.indices.append(index)

    # -- names

    def by_names(self):
        """Whether names tell the columns; sets the indices then."""
        chosen = {axis: self.best_named(axis) for axis in self.axes}
        if not any(chosen.values()):
            return False
        self.match_x_and_y(chosen)
        for axis, columns in chosen.items():
            if len(columns) > 1:
                self.refuse_two(
                    [[c if a == axis else chosen[a][0] for a in self.axes] for c in columns[:2]]
                    if all(chosen.values()) else None,
                    f"{self.listed(columns)} may all be {axis}",
                )
        missing = [axis for axis in self.axes if not chosen[axis]]
        taken = [columns[0] for columns in chosen.values() if columns]
        if missing:
            self.fill_in(chosen, missing, taken)
        self.indices = [chosen[axis][0] for axis in self.axes]
        if missing or self.indices != list(range(self.width)):
            text = ", ".join(f"{a} = {self.called(i)}" for a, i in zip(self.axes, self.indices))
            left = f"; {missing[0]} is the only column left" if missing else ""
            self.notes.append(f"columns by their names: {text}{left} (see {option('columns')})")
        self.look_at_names()
        return True

    def best_named(self, axis):
        """The columns whose names are the best for an axis; those of numbers before others."""
        found = [i for i, m in enumerate(self.meanings) if m.axis == axis]
        found = [i for i in found if self.share_of_text[i] < 0.5] or found
        best = min((self.meanings[i].rank for i in found), default=0)
        return [i for i in found if self.meanings[i].rank == best]

    def match_x_and_y(self, chosen):
        """Of several x and y, those are left whose names have the same words beside."""
        x, y = chosen["x"], chosen["y"]
        if len(x) > 1 or len(y) > 1:
            pairs = [
                (i, j) for i in x for j in y
                if self.meanings[i].beside == self.meanings[j].beside
                and abs(self.meanings[i].rank - self.meanings[j].rank) < 2
            ]
            if len(pairs) == 1:
                chosen["x"], chosen["y"] = [pairs[0][0]], [pairs[0][1]]
            elif len(pairs) > 1:
                z = (chosen.get("z") or [None])[:1]
                self.refuse_two(
                    [[*pair, *z][: self.needed] for pair in pairs[:2]] if None not in z else None,
                    f"{self.listed([i for pair in pairs for i in pair])} may all be x and y",
                )

    def fill_in(self, chosen, missing, taken):
        """Finds the columns of axes that have no name of their own among the others."""
        free = [
            i for i in range(self.width)
            if i not in taken and self.share_of_text[i] < 0.5 and not self.meanings[i].axis
        ]
        others = [i for i in free if not self.meanings[i].role]
        if not others:
            others = [i for i in free if self.meanings[i].role in ("a measure", "a code")]
        if len(others) == len(missing) == 1:
            chosen[missing[0]] = others
            return
        known = ", ".join(f"{a} = {self.called(c[0])}" for a, c in chosen.items() if c)
        lacks = " and ".join(missing)
        could = f"it may be {self.listed(others or free)}" if free else "no column is left for it"
        raise FileError(
            f"{self.path}: the names tell {known}, but not {lacks}; {could}; {self.advice}"
        )

    def look_at_names(self):
        z = self.meanings[self.indices[-1]]
        x, y = self.indices[:2]
        if self.needed == 3:
            others = [
                i for i, m in enumerate(self.meanings)
                if m.axis == "z" and m.rank not in (4, 9) and i not in self.indices
                and self.share_of_text[i] < 0.5
            ]
            if others and z.axis:
                self.notes.append(
                    f"z is {self.called(self.indices[2])}; {self.listed(others)} could be too "
                    f"(see {option('columns')})"
                )
        if self.indices[-1] > x > y and self.meanings[x].rank == self.meanings[y].rank == 0:
            self.notes.append(
                "Y stands before X, as where X is north; x and y are taken as named "
                f"({option('columns')} {self.numbered([y, x] + self.indices[2:])} swaps them)"
            )

    # -- values

    def by_values(self):
        """Sets the indices from the values of the columns."""
        if self.width == self.needed:
            self.indices = list(range(self.width))
            if self.names:
                axes = "x, y or z" if self.needed == 3 else "x or y"
                taken = ", ".join(f"{a} = {self.called(i)}" for i, a in enumerate(self.axes))
                self.notes.append(f"no column is named as {axes}: {taken} (see {option('columns')})")
            self.look_at_order()
            return
        numbers = [
            i for i in range(self.width) if self.share_of_text[i] < 0.5 and len(self.finite(i))
        ]
        known = {i for i in numbers if self.meanings[i].role or self.meanings[i].axis}
        usable = [i for i in numbers if i not in known]
        if len(usable) < self.needed:
            usable = numbers
        if len(usable) < self.needed:
            raise FileError(
                f"{self.path}: {self.needed} columns of numbers are needed, "
                f"and there {'is' if len(usable) == 1 else 'are'} {len(usable)}"
            )
        left, reasons = self.without_others(usable)
        chosen = self.most_like_points(left, reasons)
        if self.needed == 3:
            chosen = self.east_and_north(chosen, reasons)
        self.indices = chosen
        why = [
            f"column {self.called(i)} is {reason}"
            for i, reason in sorted(reasons.items()) if i < max(chosen)
        ]
        taken = ", ".join(f"{a} = {self.called(i)}" for a, i in zip(self.axes, chosen))
        if chosen == list(range(self.needed)):
            self.notes.append(
                f"the first {self.needed} of {self.width} columns are taken as "
                f"{', '.join(self.axes)} (see {option('columns')})"
            )
        else:
            why = "; ".join(why) + "; " if why else ""
            self.notes.append(f"columns by their values: {why}{taken} (see {option('columns')})")

    def without_others(self, columns):
        """(columns that may be coordinates, {column: what it is else}), by the values."""
        left, reasons = list(columns), {}

        def take(i, reason):
            left.remove(i)
            reasons[i] = reason

        while len(left) > self.needed:
            first, second = left[:2]
            if self.is_id(first):
                self.ids.add(first)
                take(first, "an id: it counts up by one")
            elif numpy.ptp(self.finite(first)) == 0:
                take(first, "the same in all rows")
            elif self.is_class(first, second):
                take(first, "a class or line: few whole numbers")
            else:
                break
        if self.needed == 3 and len(left) >= 5:
            for i in self.place_in_grid(left):
                take(i, "a line, trace or place in a grid: others follow from it")
                self.has_line_and_trace = True
        return left, reasons

    def finite(self, i):
        values = self.values[:, i]
        return values[numpy.isfinite(values)]

    def is_whole(self, i):
        values = self.finite(i)
        return self.decimals[i] == 0 and len(values) > 0 and (values == numpy.rint(values)).all()

    def is_id(self, i):
        """Whole numbers that count up by one, here and there with a gap, and never go back."""
        values = self.values[:, i]
        if len(values) < 3 or not numpy.isfinite(values).all() or not self.is_whole(i):
            return False
        steps = numpy.diff(values)
        near = steps[: max(self.consecutive - 1, 1)]
        return bool((steps > 0).all() and (near == 1).mean() > 0.6)

    def is_class(self, i, beside):
        """A few small whole numbers beside a column of quite other ones."""
        values = self.finite(i)
        if len(values) < 20 or not self.is_whole(i) or values.min() < 0 or values.max() > 255:
            return False
        few = len(numpy.unique(values)) <= min(32, len(values) // 10)
        other = numpy.ptp(self.finite(beside)) > 30 * numpy.ptp(values)
        return few and (other or not self.is_whole(beside))

    def place_in_grid(self, columns):
        """The two columns of whole numbers from which two others follow, as line and trace do."""
        for i, j in zip(columns, columns[1:]):
            if not all(self.is_whole(k) and numpy.ptp(self.finite(k)) > 0 for k in (i, j)):
                continue
            rest = [k for k in columns if k not in (i, j)]
            for pair in zip(rest, rest[1:]):
                larger = self.size(pair) > self.size([i, j])
                others = [k for k in rest if k > pair[1]][:1]
                if larger and others and self.follow_from([i, j], list(pair)):
                    if not self.follow_from([i, j], [pair[0], *others]):  # as in a plane
                        return [i, j]
        return []

    def size(self, columns):
        return float(numpy.prod([numpy.ptp(self.finite(i)) for i in columns]))

    def follow_from(self, given, wanted):
        """Whether columns are a turned and stretched copy of others, to a hundredth."""
        rows = self.values[numpy.isfinite(self.values[:, given + wanted]).all(axis=1)]
        if len(rows) < 6:
            return False
        base = rows[:, given] - rows[:, given].mean(axis=0)
        goal = rows[:, wanted] - rows[:, wanted].mean(axis=0)
        factors, _, rank, _ = numpy.linalg.lstsq(base, goal, rcond=1e-9)
        spread = goal.std(axis=0)
        rest = (goal - base @ factors).std(axis=0)
        turned = abs(numpy.linalg.det(factors)) > 1e-6 * (numpy.abs(factors) ** 2).sum()
        return bool(rank == 2 and turned and (spread > 0).all() and (rest < 0.01 * spread).all())

    def most_like_points(self, columns, reasons):
        """Of three columns in a row, the first that look like x, y and z.

        The first three stay where they are about as good. What always rises before them may be a
        time, or the x of sorted points: then both readings are shown.
        """
        count = self.needed
        groups = [columns[k : k + count] for k in range(len(columns) - count + 1)]
        marks = [self.likeness(group) for group in groups]
        later = max(marks[1:], default=0)
        best = marks.index(later, 1) if later > marks[0] else 0
        doubtful = best and (marks[0] < 4 or self.is_line(*columns[:2]))
        if later == 5 and self.always_rises(columns[0]):
            best, doubtful = marks.index(later, 1), True
        if best and later < marks[0] + 2:
            if doubtful:
                self.refuse_two([groups[0], groups[best]])
            best = 0
        if best == 0 and len(groups) > 2 and marks[2] == 5 and self.may_count(columns):
            self.refuse_two([groups[0], groups[2]])
        if best == 0 and marks[1:2] == [5] and not self.is_grid(*columns[:2]):
            if self.is_grid(*groups[1][:2]):
                self.refuse_two(groups[:2])
        for i in columns[: columns.index(groups[best][0])]:
            values = self.finite(i)
            each = self.is_whole(i) and len(numpy.unique(values)) == len(values)
            self.ids |= {i} if each else set()
            reasons[i] = (
                "an id: whole numbers, each once" if each else "no coordinate beside the next"
            )
        return groups[best]

    def is_grid(self, x, y):
        """Whether each value of x stands once with each of y, here and there with a gap."""
        rows = self.values[: self.consecutive, [x, y]]
        sizes = [len(numpy.unique(column)) for column in rows.T]
        if min(sizes) < 2 or sizes[0] * sizes[1] > 1.5 * len(rows):
            return False
        return len(numpy.unique(rows, axis=0)) == len(rows)

    def may_count(self, columns):
        """Whether the first two may be line and trace: small, whole, in steps of one."""
        if not all(self.is_whole(i) and abs(self.finite(i)).max() < 1e5 for i in columns[:2]):
            return False
        steps = abs(numpy.diff(self.values[: self.consecutive, columns[:2]], axis=0))
        usual = [numpy.median(s[s > 0]) if (s > 0).any() else 0.0 for s in steps.T]
        return usual == [1.0, 1.0] and all(self.decimals[i] for i in columns[2:4])

    def always_rises(self, i):
        values = self.finite(i)
        return len(values) > 9 and bool((numpy.diff(values) > 0).all())

    def likeness(self, group):
        """How much columns look like x, y and z: at most 5 marks."""
        x, y = group[:2]
        spans = [float(numpy.ptp(self.finite(i))) if len(self.finite(i)) else 0.0 for i in group]
        alike = abs(self.decimals[x] - self.decimals[y]) <= 1
        alike &= (self.decimals[x] == 0) == (self.decimals[y] == 0)
        marks = 2 * alike
        marks += 0 < max(spans[:2]) <= 30 * min(spans[:2])
        if len(group) == 3:
            marks += 2 * (spans[2] <= 10 * max(spans[:2]))
            z = self.finite(group[2])
            marks -= 2 * (len(z) > 0 and abs(z).min() > 1e5)  # as high as no elevation
        marks -= self.is_line(x, y)
        return marks

    def is_line(self, i, beside):
        """The same whole number along runs of rows, through which others go in no even steps."""
        values = self.values[: self.consecutive, [i, beside]]
        steps = numpy.diff(values, axis=0)
        within = steps[steps[:, 0] == 0, 1]
        if not self.is_whole(i) or not 0.7 * len(steps) < len(within) < len(steps):
            return False
        even = abs(within - numpy.median(within)) <= 0.01 * abs(numpy.median(within))
        return bool(even.mean() < 0.5)

    def east_and_north(self, chosen, reasons):
        """x and y of points with numbers: surveyors write the northing first.

        Metres of UTM tell which it is. Otherwise a code behind z speaks for point, northing,
        easting, elevation, code, and x,y,z as they stand is as likely.
        """
        named = [i for i in range(min(chosen)) if self.share_of_text[i] > 0.5]
        if not named and self.ids.isdisjoint(reasons):
            return chosen
        first, second, z = chosen
        swapped = [second, first, z]
        if self.is_utm(second, first):
            self.has_swapped = True
            self.notes.append(
                f"column {self.called(first)} is taken as northing and {self.called(second)} as "
                "easting, by their sizes"
            )
            return swapped
        coded = any(self.share_of_text[i] > 0.5 for i in range(max(chosen) + 1, self.width))
        if coded and not self.is_utm(first, second):
            self.refuse_two([swapped, chosen])
        return chosen

    def is_utm(self, x, y):
        """Whether columns are easting and northing of UTM by their sizes, in metres."""
        x, y = self.finite(x), self.finite(y)
        if not len(x) or not len(y):
            return False
        return bool(160e3 < x.min() and x.max() < 840e3 and 1.1e6 < y.min() and y.max() < 10e6)

    def look_at_order(self):
        """Notes where three columns without names look like z, x, y."""
        if self.needed == 2 or any(m.axis or m.role for m in self.meanings):
            return
        later = self.is_utm(1, 2) or self.is_utm(2, 1)
        if later and not self.is_utm(0, 1) and not self.is_utm(1, 0):
            order = [1, 2, 0] if self.is_utm(1, 2) else [2, 1, 0]
            self.notes.append(
                "the columns are taken as x, y, z in this order, but 2 and 3 are as large as "
                f"coordinates of UTM; if 1 is z: {option('columns')} {self.numbered(order)}"
            )

    # -- what the values tell of the choice

    def look_at_values(self):
        x, y = self.indices[:2]
        xs, ys = self.finite(x), self.finite(y)
        if not len(xs) or not len(ys):
            return
        for i, values, limit, what in ((x, xs, 360, "longitude"), (y, ys, 90, "latitude")):
            if self.meanings[i].rank == 3 and abs(values).max() > limit:
                self.notes.append(
                    f"column {self.called(i)} is a {what} by its name, but holds "
                    f"{values[abs(values).argmax()]:.9g}, which no {what} can be (see {option('columns')})"
                )
        by_name = 3 in (self.meanings[x].rank, self.meanings[y].rank)
        degrees = abs(xs).max() <= 360 and abs(ys).max() <= 90
        if self.needed == 3 and degrees:
            z = self.finite(self.indices[2])
            wide = max(numpy.ptp(xs), numpy.ptp(ys))
            fine = min(self.decimals[x], self.decimals[y]) >= 4
            if by_name or fine and len(z) and 0 < wide < 0.1 * numpy.ptp(z):
                self.notes.append(
                    "x,y look like degrees: project them first to give triangles their true shape"
                    + ("" if by_name else f"; x is longitude, if it is not: {option('columns')} swaps them")
                )
        if self.is_utm(y, x) and not self.has_swapped:
            self.notes.append(
                "x is as large as a northing and y as an easting of UTM; if so, "
                f"{option('columns')} {self.numbered([y, x] + self.indices[2:])} gives the map its true side"
            )

    # -- words

    def called(self, i):
        name = self.names[i] if self.names else ""
        return f"{i + 1} ({name})" if name else str(i + 1)

    def listed(self, columns):
        words = [self.called(i) for i in columns[:6]]
        return "columns " + " and ".join(words) if len(words) > 1 else f"column {words[0]}"

    @staticmethod
    def numbered(columns):
        return ",".join(str(i + 1) for i in columns)

    def refuse_two(self, readings, why="the columns can be read in two ways"):
        """Raises the error that shows two readings and the options that decide."""
        if not readings or not self.can_be_chosen:
            raise FileError(f"{self.path}: {why}; {self.advice}")
        words = []
        for reading in readings:
            pairs = [(a, i) for a, i in zip(self.axes, reading) if i < len(self.row)]
            values = [f"{a} = {self.row[i]}" for a, i in pairs]
            words.append(f"{option('columns')} {self.numbered(reading)} (first row: {', '.join(values)})")
        raise FileError(f"{self.path}: {why}; choose {' or '.join(words)}")

    # -- the other columns

    def extras(self):
        """{index: name} of the columns of numbers that are no coordinates."""
        result, text = {}, []
        for i in range(self.width):
            if i in self.indices or self.needed == 2:
                continue
            name = (self.names[i].strip() if self.names else "") or f"column {i + 1}"
            if not len(self.finite(i)) or self.share_of_text[i] > 0.1:
                text.append(name)
                if self.share_of_text[i] > 0:
                    known = name in (*result.values(), *self.texts.values())
                    self.texts[i] = f"{name} (column {i + 1})" if known else name
                continue
            for colour, words in COLOURS.items():
                if "".join(plain(name)) in words:
                    name = colour if colour not in result.values() else name
            known = name in (*result.values(), *self.texts.values())
            result[i] = f"{name} (column {i + 1})" if known else name
        if text:
            chosen = f"; {option('where')} chooses points by them" if self.texts else ""
            self.notes.append(f"columns without numbers are left out: {', '.join(text)}{chosen}")
        return result
