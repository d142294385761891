# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which columns of a table are x, y and z: by their names, else by their values.

Names, or the places of columns, give the readings that are possible; each has a score. If the best is clearly
better than the next, a note says what it rests on. If not, an error shows both, with the first rows.
"""

import itertools
import math
import os
import re

import numpy

from .column_names import Meaning, alike_but_for_axis, in_brackets, meaning, plain
from .blunders import FAR
from .nulls import usual_nulls
from .tables import known
from ..messages import FileError
from ..names import option

SHOWN_ROWS, SHOWN_COLUMNS = 3, 12  # below a question
MOST_JUDGED = 30  # columns, from the left: each is compared with each
MOST_COLUMNS = 12  # of rows of points without names; with more, they are a grid
ROWS_OF_GRID = 20  # times its columns, and no more
FEW_ROWS = 10  # show too little for some reasons why a column is no coordinate
NOT_DECIMALS = re.compile(r"^[^.,]*[.,]?|[eEdD].*$")
# Why a column is no coordinate, where that counts for others.
COUNTS_UP, EACH_ONCE = "an id: it counts up by one", "an id: whole numbers, each once"
PART_OF_TIME, THE_SAME = "a part of a date or time", "the same in all rows"
NO_NEIGHBOUR = "no coordinate next to the next"


def advice_on_columns():
    """What a user can do who may choose columns."""
    return f"{option('columns')} chooses other columns"


@numpy.errstate(all="ignore")
def are_heights(values):
    """Whether rows of numbers look like a grid of heights: few rows, whose neighbours are near each other, or which
    have many columns, all alike, as those of x, y and z are not."""
    values = numpy.asarray(values, "f8")
    values = values[numpy.isfinite(values).all(axis=1)]
    if values.shape[1] < 4 or not 3 < len(values) <= ROWS_OF_GRID * values.shape[1]:
        return False
    spread = float(numpy.ptp(numpy.percentile(values, (10, 90))))
    is_near = numpy.median(abs(numpy.diff(values, axis=1)), axis=0).max() < 0.25 * spread
    apart, wide = abs(numpy.median(values, axis=0) - numpy.median(values)), values.std(axis=0) / (spread or 1.0)
    are_alike = apart.max() < 0.6 * spread and 0.15 < wide.min() and wide.max() < 0.8
    return bool(is_near or are_alike and values.shape[1] > 6)


def as_grid(path, source):
    """The command that makes a grid of heights of a file; source: what numpy reads it by."""
    target = os.path.splitext(os.path.basename(path))[0] + ".npz"
    return f"""python3 -c "import numpy; numpy.savez('{target}', z={source})" and then {target}"""


class Choice:
    """Which columns are x, y and z, or x and y, and what was found out about the others.

    indices     of x, y and z
    extras      {index: name} of the other columns of numbers
    texts       {index: name} of the columns of text
    of_numbers  indices of all columns that hold more numbers than text
    z_name      what z is called, with its unit
    is_horizon  whether lines and traces of a seismic survey stand next to them
    angles      as of a Cloud
    reasons     {index: why a column is no coordinate}, by its values

    By column, without nulls: values, finite, low, high, largest, spans, decimals, whole (all values
    are); numeric are columns with fewer words than numbers.
    """

    @numpy.errstate(all="ignore")
    def __init__(self, path, rows, consecutive, layout, head, names, width, columns, needed, advice):
        """Raises FileError.

        rows         some rows as words; the first so many (consecutive) follow each other in the file
        layout       the Layout of lines
        head         the lines before the data
        names, width  of the columns; names may be None
        columns      None, or what the user said: names or numbers
        needed       3 or 2
        advice       what a user can do where no choice is sure; None: choose columns
        """
        self.path, self.layout, self.names, self.width, self.needed = path, layout, names, width, needed
        self.head = "\n".join(head).lower()
        self.rows = [row[:width] + [""] * (width - len(row)) for row in rows]
        self.consecutive, self.axes = consecutive, "xyz"[:needed]
        self.can_be_chosen, self.advice = advice is None, advice or advice_on_columns()
        self.indices, self.extras, self.texts, self.reasons, self.notes = [], {}, {}, {}, []
        self.z_name, self.is_horizon, self.angles, self.has_swapped = "", False, "no", False
        self.judge_values()
        self.judge_names()
        if columns:
            self.use_given(columns)
        elif not self.by_names():
            self.by_values()
        self.look_at_values()
        self.name_others()
        if names:
            self.z_name = names[self.indices[-1]] if needed == 3 else ""
            self.is_horizon = any("".join(plain(name)) in known().words["seismic"] for name in names)

    def judge_values(self):
        table = [list(map(self.layout.number, row)) for row in self.rows]
        self.values = numpy.array(table, "f8")
        self.share_of_text = numpy.equal(numpy.array(table, object), None).mean(axis=0)
        shares = numpy.isfinite(self.values).mean(axis=0)
        self.of_numbers = numpy.flatnonzero(shares > self.share_of_text).tolist()
        self.numeric = [i for i, share in enumerate(self.share_of_text) if share < 0.5]
        for column in self.values.T:
            for _, found in usual_nulls(column):
                column[found] = numpy.nan
        self.finite = [column[numpy.isfinite(column)] for column in self.values.T]
        self.low = [values.min(initial=math.inf) for values in self.finite]
        self.high = [values.max(initial=-math.inf) for values in self.finite]
        self.spans = [float(max(high - low, 0.0)) for low, high in zip(self.low, self.high)]
        self.largest = [max(abs(low), abs(high)) for low, high in zip(self.low, self.high)]
        some = self.rows[:: 1 + len(self.rows) // 500]
        decimals = [[len(NOT_DECIMALS.sub("", word)) for word in row] for row in some]
        self.decimals = numpy.max(decimals, axis=0).tolist()
        self.whole = [
            count == 0 and len(values) > 0 and bool((values == numpy.rint(values)).all())
            for count, values in zip(self.decimals, self.finite)
        ]

    def judge_names(self):
        """Sets meanings; some names have another one next to some others."""
        letters = ["".join(plain(name)) for name in self.names or [""] * self.width]
        meanings = [meaning(name) for name in self.names or [""] * self.width]
        others = alike_but_for_axis([name for name, m in zip(letters, meanings) if m == Meaning()])
        if not {"r", "g", "b"} <= set(letters):  # single letters are colours only together
            others.update({letter: Meaning() for letter in "rgb"})
        finnish, lines = known().finnish, known().lines
        if set(finnish) <= set(letters) and not set(letters) & set("nexy"):
            others.update({letter: Meaning(axis, 2) for letter, axis in finnish.items()})
        has_places = any(others.get(name, m).axis in ("x", "y") for name, m in zip(letters, meanings))
        self.is_in_lines = not has_places and all(words & set(letters) for words in lines.values())
        if self.is_in_lines:
            others.update({word: Meaning(axis, 8) for axis, words in lines.items() for word in words})
        self.meanings = [others.get(name, m) for name, m in zip(letters, meanings)]

    # -- what the user said

    def use_given(self, columns):
        names, numbers = self.names or [], list(range(1, self.width + 1))
        joined = ["".join(plain(in_brackets(name)[0])) for name in names]
        for axis, column in zip(self.axes, columns):
            ways = [(names, column), (joined, "".join(plain(column)))]
            ways = [(numbers, int(column))] if column.isdecimal() else ways
            ways = [[i for i, one in enumerate(titles) if title and one == title] for titles, title in ways]
            found, why = next(filter(None, ways), []), ""
            if not found:
                there = f"named {', '.join(names)}" if names else "without names: the file has no header line"
                why = f"there is no column {column} for {axis}; lines have {self.width}, {there}"
            elif len(found) > 1:
                why = f"{self.listed(found)} are all called {column}; {option('columns')} takes the number of one"
            elif found[0] in self.indices:
                both = f"{self.axes[self.indices.index(found[0])]} and {axis} from column {self.called(found[0])}"
                why = f"{option('columns')} takes both {both}; each needs a column of its own"
            if why:
                raise FileError(f"{self.path}: {why}")
            self.indices.append(found[0])
        self.refuse_geocentric(self.indices)
        self.refuse_shortened(self.indices)

    # -- readings

    def decide(self, readings, why="the columns can be read in two ways"):
        """Sets the indices to the reading of the best score; asks where the next is about as good, or z no height.

        readings  {indices: score}, in the order in which they are shown
        """
        best, *others = sorted(readings, key=readings.get, reverse=True)
        figures = known().figures
        clear = figures["clear" if readings[best] >= figures["good"] else "clear of poor"]
        self.refuse_geocentric(best)
        self.refuse_shortened(best)
        shown = [one for one in readings if one in (best, *others[:1])]
        if others and readings[best] - readings[others[0]] < clear:
            self.ask(shown, why)
        others = [i for i in self.numeric if self.spans[i] > 0 and i not in (*best, *self.reasons)]
        same = [i for i in best if self.spans[i] == 0 and not self.meanings[i].axis and others]
        if set(same) - set(best[2:]) or same and any(map(self.counts_along, others)):
            self.ask(shown, f"column {self.called(same[0])} is the same in all rows, where others are not")
        if self.needed == 3 and not self.meanings[best[2]].axis and self.is_too_high(best[2]):
            self.ask(shown, f"column {self.called(best[2])} is higher than any place, so z may lack or stand elsewhere")
        self.indices = list(best)
        self.turn_where_x_is_north()

    def turn_where_x_is_north(self):
        """Swaps x and y where the lines before the data are in a language in which X is often north and the sizes
        prove it; asks where these prove nothing."""
        x, y = self.indices[:2]
        language = next((name for name, letters in known().x_is_north.items() if re.search(letters, self.head)), "")
        is_plain = self.meanings[x].rank == self.meanings[y].rank == 0
        is_east, is_north = self.is_utm(x, y), self.is_utm(y, x)
        if language == "Hungarian":
            is_east, is_north = is_east or self.is_eov(x, y), is_north or self.is_eov(y, x)
        if not language or not is_plain or is_east and not is_north or self.are_degrees(x, y):
            return
        if is_east or not is_north:
            why = f"X is often north in tables in {language}, and nothing shows here whether it is"
            self.ask([self.swapped(), self.indices], why)
        self.has_swapped, self.indices = True, self.swapped()
        self.note(f"X is north, as often in tables in {language}, and by the sizes: {self.taken()}")

    def swapped(self):
        """The indices with x and y in each other's place."""
        x, y, *z = self.indices
        return [y, x, *z]

    def are_degrees(self, x, y):
        """Whether columns may be longitude and latitude by their sizes and decimals."""
        return self.largest[x] <= 360 and self.largest[y] <= 90 and min(self.decimals[x], self.decimals[y]) >= 4

    def is_too_high(self, i):
        return len(self.finite[i]) > 0 and abs(self.finite[i]).min() > known().figures["highest"]

    def ask(self, readings, why, other=""):
        """Raises the error that shows readings as options, or another command, and the first rows under the columns'
        numbers."""
        if not self.can_be_chosen:
            raise FileError(f"{self.path}: {why}; {self.advice}")
        ways = [*map(self.way, readings)] + [other] * bool(other)
        width = min(self.width, max([SHOWN_COLUMNS, *(max(one) + 1 for one in readings)]))
        numbers, names = [str(i + 1) for i in range(width)], [self.names] if self.names else []
        shown = [[word[:16] for word in row[:width]] for row in [numbers, *names, *self.rows[:SHOWN_ROWS]]]
        widths = [max(map(len, column)) for column in zip(*shown)]
        lines = ["  ".join(word.rjust(w) for word, w in zip(row, widths)) for row in shown]
        choose = f"choose {' or '.join(ways)}" if ways else self.advice
        raise FileError("\n  ".join([f"{self.path}: {why}; {choose}", *lines]))

    # -- names

    def by_names(self):
        """Whether the names give the columns; sets the indices then."""
        named = self.best_named()
        if not any(named.values()):
            return False
        missing = [axis for axis in self.axes if not named[axis]]
        free, are_likely = self.free_columns(sum(named.values(), []), missing) if missing else ([], True)
        given = ", ".join(f"{a} = {self.called(c[0])}" for a, c in named.items() if c)
        why = f"the names give {given}, but not {' and '.join(missing)}"
        if len(free) < len(missing):
            self.ask([], f"{why}; no column is left for it")
        good = known().figures["good"]
        readings = {  # the values only choose which two are shown
            indices: good + known().weights["one pair"] * self.is_pair(*indices[:2]) + 1e-3 * self.score(indices)
            for indices in itertools.product(*(named[axis] or free for axis in self.axes))
            if len(set(indices)) == self.needed
        }
        doubtful = [axis for axis in self.axes if len(named[axis]) > 1]
        if missing:
            why += f"; it may be {self.listed(free)}"
            if not are_likely:
                self.ask(sorted(readings, key=readings.get)[-1:-3:-1], why)
        elif doubtful:
            several = [i for axis in doubtful for i in named[axis]]
            why = f"{self.listed(several)} may all be {' and '.join(doubtful)}"
        self.decide(readings, why)
        self.look_at_names(missing)
        return True

    def best_named(self):
        """{axis: columns whose names are the best for it}: of numbers before others, x and y alike before those that
        are not, as longitude next to latitude is before "E1", and "z" before "z10"."""
        named, ranks = {}, {}
        for axis in self.axes:
            found = [i for i, m in enumerate(self.meanings) if m.axis == axis]
            # Words of a time, which a traveltime may be called, are no height next to x and y or to one, and no
            # seconds of a week.
            times = [i for i in found if self.meanings[i].rank == 4]
            found = [i for i in found if i not in times] or found
            times = [i for i in times if (all(named.values()) and i not in self.numeric) or self.is_too_high(i)]
            found = [i for i in found if i in self.numeric] or found
            named[axis] = [i for i in found if i not in times]
            ranks[axis] = {self.meanings[i].rank for i in named[axis]}
        alike = ranks["x"] & ranks["y"]
        for axis, found in named.items():
            best = min(alike if alike and axis != "z" else ranks[axis], default=0)
            found = [i for i in found if self.meanings[i].rank == best]
            bare = [i for i in found if best == 0 and not re.search(r"\d", self.names[i])]
            named[axis] = bare or found
        return named

    def is_pair(self, x, y):
        """Whether names of x and y have the same further words, as X_utm and Y_utm do."""
        x, y = self.meanings[x], self.meanings[y]
        return bool(x.axis and y.axis) and x.beside == y.beside and abs(x.rank - y.rank) < 2

    def free_columns(self, taken, missing):
        """Columns for axes that have no name of their own, and whether they are likely."""
        most = known().figures["highest"] if missing == ["z"] else math.inf
        free = [i for i in self.numeric if i not in taken and not self.meanings[i].axis]
        bare = [i for i in free if not self.meanings[i].role]
        others = bare or [i for i in free if self.meanings[i].role in ("a measure", "a code")]
        times = self.times(others)
        likely = [i for i in others if i not in times and not self.is_id(i) and self.high[i] < most]
        return (likely, bool(bare)) if len(likely) >= len(missing) else (others, False)

    def look_at_names(self, missing):
        x, y = self.indices[:2]
        if self.is_in_lines:
            self.note(f"no column is named as x or y: {self.taken()}; lengths count lines and traces, not metres")
        elif not self.has_swapped and (missing or self.indices != list(range(self.width))):
            left = f"; {missing[0]} is the only column left" if missing else ""
            self.note(f"columns by their names: {self.taken()}{left}")
        others = [
            i for i in self.numeric
            if self.meanings[i].axis == "z" and self.meanings[i].rank not in (4, 9) and i not in self.indices
        ]
        if self.needed == 3 and others and self.meanings[self.indices[2]].axis:
            self.note(f"z is {self.called(self.indices[2])}; {self.listed(others)} could be too")
        if not self.has_swapped and self.indices[-1] > x > y and self.meanings[x].rank == self.meanings[y].rank == 0:
            why = "Y stands before X, as where X is north; x and y are taken as named"
            self.notes.append(f"{why}; if not: {self.way(self.swapped())}")

    # -- values

    def by_values(self):
        """Sets the indices from the values of the columns."""
        count = self.needed
        numbers = [i for i in self.numeric if len(self.finite[i])]
        usable = [i for i in numbers if not self.meanings[i].role and not self.meanings[i].axis]
        if len(numbers) < count != self.width:
            are = "is" if len(numbers) == 1 else "are"
            self.ask([], f"{count} columns of numbers are needed, and there {are} {len(numbers)}")
        if len(usable) < count <= len(numbers) and self.names and all(self.names):
            others = self.listed([i for i in numbers if i not in usable])
            self.ask([numbers[:count]], f"{self.none_is_named()}, and {others} may be something else by the names")
        usable = usable if len(usable) >= count else numbers
        if not self.names and self.width > count == 3:
            self.ask_for_grid(len(usable) == self.width)
        left = self.without_others(usable[:MOST_JUDGED]) if self.width > count else list(range(count))
        readings = self.scored(left)
        for other in ((1, 2, 0), (2, 1, 0)) if self.width == count == 3 else ():  # as z, x, y
            are_places = self.is_utm(*other[:2]) or self.are_degrees(*other[:2]) and self.decimals[0] < 4
            readings[other] = readings[0, 1, 2] if are_places else -math.inf
        self.decide(readings)
        for i in left[: left.index(min(self.indices[:2]))]:
            each = self.whole[i] and len(numpy.unique(self.finite[i])) == len(self.finite[i])
            self.reasons[i] = EACH_ONCE if each else NO_NEIGHBOUR
        if len(self.rows) < FEW_ROWS and {NO_NEIGHBOUR, THE_SAME} & set(self.reasons.values()):
            self.ask([usable[:count], self.indices], "so few rows do not show which columns are x, y and z")
        if count == 3:
            self.east_and_north()
        if self.width == count:
            if self.names:
                self.note(f"{self.none_is_named()}: {self.taken()}")
            return
        if self.indices == list(range(count)):
            self.note(f"the first {count} of {self.width} columns are taken as {', '.join(self.axes)}")
            return
        reasons = [(i, reason) for i, reason in sorted(self.reasons.items()) if i < max(self.indices)]
        why = "".join(f"column {self.called(i)} is {reason}; " for i, reason in reasons)
        self.note(f"columns by their values: {why}{self.taken()}")

    def ask_for_grid(self, are_numbers):
        """Asks where rows may be those of a grid, maybe with x above and y before them.

        are_numbers  whether all columns are
        """
        is_wide, layout = self.width > MOST_COLUMNS and (are_numbers or len(self.rows) < 5), self.layout
        down, across = numpy.diff(self.finite[0]), numpy.diff(self.values[0, 1:])
        has_y = abs(numpy.sign(down).sum()) == len(down) > 2
        is_even = has_y and across[0] > 0 and all(numpy.allclose(steps, steps[0]) for steps in (down, across))
        is_even &= not numpy.isfinite(self.values[0, 0])  # as y\x
        is_bare = are_numbers and are_heights(self.values)
        has_axes = has_y and not is_bare and (is_even or self.width > 4 and are_heights(self.values[:, 1:]))
        if is_wide or has_axes or is_bare:
            lines = "(line.replace(',', '.') for line in open('{}'))" if layout.decimal_comma else "'{}'"
            between = f", delimiter={layout.separator!r}" if layout.separator else ""
            source = f"numpy.{'genfrom' if has_axes else 'load'}txt({lines.format(self.path)}{between})"
            source = f"(a := {source})[1:, 1:], x=a[0, 1:], y=a[1:, 0]" if has_axes else source
            why = f"{self.width} columns of numbers without names may be a grid of elevations"
            self.ask([] if is_wide else [(0, 1, 2)], why, as_grid(self.path, source))

    def without_others(self, columns):
        """The columns that may be coordinates, by their values; sets the reasons of the others."""
        left = list(columns)

        def leave(columns, reason):
            for i in columns:
                left.remove(i)
                self.reasons[i] = reason

        leave(self.times(left)[: len(left) - self.needed], PART_OF_TIME)
        while len(left) > self.needed:
            first, second = left[:2]
            reason = (
                COUNTS_UP if self.is_id(first)
                else THE_SAME if self.spans[first] == 0
                else "a class or line: few whole numbers" if self.is_class(first, second)
                else ""
            )
            if not reason:
                break
            leave([first], reason)
        between = left[2:-1] if len(left) > self.needed else []
        along = [i for i in between if self.is_distance(i, *left[:2])]
        leave(along[:1], "the distance along a line: it grows as x and y go on")
        if self.needed == 3 and len(left) >= 5:
            place = self.place_in_grid(left)
            leave(place, "a line, trace or place in a grid: others follow from it")
            self.is_horizon = len(place) > 0
        return left

    def is_distance(self, i, x, y):
        """Whether a column grows by the way between rows, in metres or kilometres, but where a line begins. With even
        steps that may be by chance."""
        grown, way = self.steps(i), numpy.hypot(self.steps(x), self.steps(y))
        fits = numpy.isclose(grown, way, 0.02, 0.0) | numpy.isclose(1000 * grown, way, 0.02, 0.0)
        return (fits & (way > 0)).sum() > 5 and fits.mean() > 0.9 and way[fits].std() > 0.05 * way[fits].mean()

    def scored(self, columns):
        """{indices: score} of the readings of columns, in a row or with numbers of lines before z."""
        count, readings, weights = self.needed, {}, known().weights
        for k in range(len(columns) - count + 1):
            x, y, *z = columns[k : k + count]
            place = weights["a column is left out"] * (k - 1) if k else weights["stands first"]
            readings[x, y, *z] = self.score((x, y, *z)) + place
            others = [i for i in columns[k + count :] if self.spans[i] > 0]
            behind = columns[k + count : k + count + 1]
            is_flat = z and self.spans[z[0]] == 0 and (not others or self.counts_along(behind[0]))
            if is_flat or z and others and self.counts_along(z[0]) and not self.may_count(x, y):
                readings[x, y, *z] += weights["z is flat or rises along lines"]
                for other in others:
                    behind = weights["z behind lines"] + place
                    behind += weights["a column is left out"] * self.counts_along(other)
                    readings[x, y, other] = self.score((x, y, other)) + behind
        return readings

    def score(self, reading):
        """How much columns look like x, y and z."""
        x, y, *z = reading
        metres = 1e5 if self.are_degrees(x, y) or self.are_degrees(y, x) else 1.0  # in a degree
        spans = [metres * self.spans[x], metres * self.spans[y], *(self.spans[i] for i in z)]
        alike = abs(self.decimals[x] - self.decimals[y]) <= 1
        alike &= (self.decimals[x] == 0) == (self.decimals[y] == 0)
        found = {
            "as many decimals": alike,
            "as wide as high": 0 < max(spans[:2]) <= 30 * min(spans[:2]),
            "x is a line": self.is_line(x, y),
            "x rises": self.rises(x, 10),
            "x and y count": self.may_count(x, y),
            "x and y are of UTM": self.is_utm(x, y) or self.is_utm(y, x),
        }
        if z:
            found["z spans less"] = spans[2] <= 10 * max(spans[:2])
            found["z is higher than any place"] = self.is_too_high(z[0])
        return sum(known().weights[what] for what, is_so in found.items() if is_so)

    def steps(self, i):
        return numpy.diff(self.values[: self.consecutive, i])

    def is_id(self, i):
        """Whole numbers that count up by one, here and there with a gap, and never go back."""
        is_full = len(self.finite[i]) == len(self.rows)
        counts = numpy.count_nonzero(self.steps(i) == 1) > 0.6 * (self.consecutive - 1)
        return is_full and self.whole[i] and self.rises(i, 3) and counts

    def times(self, columns):
        """Columns that are years, months, days, hours, minutes and seconds, in which time goes on."""
        for parts, k in itertools.product(known().times, range(len(columns))):
            found = columns[k : k + len(parts)]
            if len(found) < len(parts) or found[-1] - found[0] >= len(parts):
                continue
            moment, even = 0.0, True
            for part, i in zip(parts, found):
                low, high, factor = known().parts_of_time[part]
                values = self.values[: self.consecutive, i]
                even &= bool((values >= low).all() and (values <= high).all())
                even &= part == "second" or self.whole[i]
                moment = moment + factor * values
            goes_on = even and self.consecutive > 1 and (numpy.diff(moment) >= 0).mean() >= 0.99
            small = "year" not in parts and self.high[found[-1]] < 30
            if goes_on and len(moment) > 2 and numpy.ptp(moment) > 0 and not small:
                return found
        return []

    def place_in_grid(self, columns):
        """The two columns from which two others follow: of lines and traces, or in degrees."""
        pairs = list(zip(columns, columns[1:]))
        for place, pair in itertools.product(pairs, pairs):
            may_be = all(self.whole[k] or self.decimals[k] >= 4 and self.largest[k] <= 360 for k in place)
            others = [k for k in columns if k > pair[1] and k not in place]
            if set(place) & set(pair) or not others or not may_be:
                continue
            is_larger = math.prod(self.spans[k] for k in pair) > math.prod(self.spans[k] for k in place) > 0
            follow = self.follow_from(place, pair) or self.follow_from(pair, place, are_rounded=True)
            if is_larger and follow and not self.follow_from(place, [pair[0], others[0]]):  # as in a plane
                return place
        return ()

    def follow_from(self, given, wanted, are_rounded=False):
        """Whether columns are a turned and stretched copy of others, to a hundredth; or are rounded: the
        whole numbers nearest to one, as lines near points."""
        rows = self.values[(abs(self.values[:, [*given, *wanted]]) < FAR).all(axis=1)]
        if len(rows) < 6:
            return False
        base, goal = (rows[:, list(some)] - rows[:, list(some)].mean(axis=0) for some in (given, wanted))
        factors, _, rank, _ = numpy.linalg.lstsq(base, goal, rcond=1e-9)
        is_turned = abs(numpy.linalg.det(factors)) > 1e-6 * (numpy.abs(factors) ** 2).sum()
        rest, spread = goal - base @ factors, goal.std(axis=0)
        fits = (spread > 0).all() and (rest.std(axis=0) < 0.01 * spread).all()
        if are_rounded:
            are_wide = all(self.whole[i] and self.spans[i] >= 10 for i in wanted)
            fits = are_wide and len(rows) >= 10 and abs(rest).max() < 0.6
        return bool(rank == 2 and is_turned and fits)

    def may_count(self, x, y):
        """Whether columns may be line and trace: small, whole, in small steps."""
        if not all(self.whole[i] and self.largest[i] < 1e5 for i in (x, y)):
            return False
        steps = [abs(self.steps(i)) for i in (x, y)]
        usual = [numpy.median(s[s > 0]) if (s > 0).any() else 0.0 for s in steps]
        return 1.0 <= min(usual) and max(usual) <= known().figures["most step of lines"]

    def counts_along(self, i):
        """Whether numbers go one way, in even steps within their rounding, but where a line begins."""
        steps = self.steps(i)
        steps = steps[steps != 0]
        if len(self.finite[i]) < 10 or not len(steps):
            return False
        one_way = max((steps > 0).mean(), (steps < 0).mean()) >= 0.8
        rounding = 1.01 * 10.0 ** -self.decimals[i] if self.decimals[i] else 0.0
        are_even = abs(abs(steps) - numpy.median(abs(steps))) <= rounding
        return bool(one_way and are_even.mean() >= 0.6)

    def is_class(self, i, beside):
        """A few small whole numbers next to a column of quite other ones."""
        count = len(self.finite[i])
        few = count >= 20 and self.whole[i] and len(numpy.unique(self.finite[i])) <= min(32, count // 10)
        other = self.spans[beside] > 30 * self.spans[i] or not self.whole[beside]
        return few and other and 0 <= self.low[i] and self.high[i] <= 255

    def rises(self, i, least):
        """Whether numbers rise in all rows, of which there are at least so many."""
        return len(self.finite[i]) >= least and bool((numpy.diff(self.finite[i]) > 0).all())

    def is_line(self, i, beside):
        """The same whole number along runs of rows, through which others go in no even steps."""
        steps = numpy.column_stack((self.steps(i), self.steps(beside)))
        within = steps[steps[:, 0] == 0, 1]
        if not self.whole[i] or not 0.7 * len(steps) < len(within) < len(steps):
            return False
        even = abs(within - numpy.median(within)) <= 0.01 * abs(numpy.median(within))
        return bool(even.mean() < 0.5)

    def east_and_north(self):
        """x and y of points with numbers: surveyors write the northing first.

        Metres of UTM decide it, where they cannot be feet of the USA. Otherwise a code behind z speaks for point,
        northing, easting, elevation, code, and x,y,z as they stand is as likely. So is it behind dates, where latitude
        and longitude stand.
        """
        x, y, z = self.indices
        texts = [i for i in range(self.width) if self.share_of_text[i] > 0.5]
        has_ids = any(i < min(x, y, z) for i in texts)
        has_ids |= any(reason in (COUNTS_UP, EACH_ONCE) for reason in self.reasons.values())
        coded = any(i > max(x, y, z) for i in texts)
        northing_first, northing_second = self.is_utm(y, x), self.is_utm(x, y)
        figures, (less, more) = known().figures, sorted((self.low[x], self.low[y]))
        are_feet = more < figures["most feet"] or figures["least feet east"] < less < figures["most feet north"]
        is_sure = northing_first != northing_second and not are_feet
        if has_ids and northing_first and is_sure:
            self.has_swapped, self.indices = True, self.swapped()
            self.notes.append(
                f"column {self.called(x)} is taken as northing and {self.called(y)} as "
                "easting, by their sizes"
            )
            return
        may_be_north = northing_first or coded and not (northing_second and is_sure)
        if has_ids and may_be_north or self.may_be_latitude(x, y, z):
            self.ask([self.swapped(), self.indices], "the columns can be read in two ways")

    def may_be_latitude(self, x, y, z):
        """Whether columns may be latitude and longitude in this order, and not the other way."""
        if self.largest[x] > 90 or self.largest[y] > 180 or min(self.decimals[x], self.decimals[y]) < 4:
            return False
        places = self.values[:, [x, y]]
        places = places[numpy.isfinite(places).all(axis=1) & places.any(axis=1)]  # 0 0: no place yet
        wide = numpy.ptp(places, axis=0).max() if len(places) else 0.0
        words = " ".join(word for row in self.rows[:SHOWN_ROWS] for word in row)
        dated = re.search(r"\d{4}-\d\d-\d\d|\d:\d\d", words) is not None
        return PART_OF_TIME in self.reasons.values() or dated or wide < 0.1 * self.spans[z]

    def is_utm(self, x, y):
        """Whether columns are easting and northing of UTM by their sizes, in metres; the easting may begin with the
        number of its zone, which has one digit in the Gauss-Krueger systems of middle Europe."""
        low, high = self.low, self.high
        has_zone = 1e7 < low[x] < 61e6 or 2e6 < low[x] < 9e6 and 4.75e6 < low[y] <= high[y] < 6.2e6
        zone = low[x] // 1e6 * 1e6 if has_zone else 0.0
        return bool(160e3 < low[x] - zone <= high[x] - zone < 840e3 and 1.1e6 < low[y] <= high[y] < 10e6)

    def is_eov(self, x, y):
        """Whether columns are easting and northing of the Hungarian EOV, of which one is always the larger."""
        middle = known().figures["middle of eov"]
        return bool(0 < self.low[y] <= self.high[y] < middle < self.low[x] <= self.high[x] < 1e6)

    def refuse_geocentric(self, chosen):
        """Raises the error for columns of which some are x, y and z from the centre of the earth."""
        equator, pole, most, least = known().earth
        for three in zip(*(range(i, self.width) for i in range(3))):
            x, y, z = self.values[:, three].T
            away = (x * x + y * y) / equator**2 + z * z / pole**2 - 1
            if not set(three).isdisjoint(chosen) and (abs(away) < most).all() and (abs(z) > least).all():
                raise FileError(
                    f"{self.path}: {self.listed(three)} are x, y and z from the centre of the "
                    "earth (ECEF); export longitude, latitude and height, or a map projection"
                )

    def refuse_shortened(self, chosen):
        """Raises the error for columns of which x and y lack digits."""
        is_short = known().patterns["shortened"].fullmatch
        if 2 * sum(all(is_short(row[i]) for i in chosen[:2]) for row in self.rows) > len(self.rows):
            raise FileError(f"{self.path}: {known().refusals['shortened']}")

    # -- what the values say about the choice

    def look_at_values(self):
        x, y = self.indices[:2]
        for i in (x + 1, y + 1):  # behind a latitude or longitude without its sign
            letters = {row[i].strip().upper() for row in self.rows if i < self.width} - {""}
            if letters <= set("NSEW") and letters & set("SW"):
                raise FileError(
                    f"{self.path}: column {i + 1} has {' and '.join(sorted(letters))} for the signs of the "
                    "numbers before it; export signed decimals"
                )
        by_name = [i for i in (x, y) if self.meanings[i].rank == 3]
        for i, limit, what in ((x, 360, "longitude"), (y, 90, "latitude")):
            if i in by_name and limit < self.largest[i] < math.inf:
                worst = max(self.low[i], self.high[i], key=abs)
                self.note(
                    f"column {self.called(i)} is a {what} by its name, but holds {worst:.9g}, which no "
                    f"{what} can be"
                )
        if self.needed == 3 and self.largest[x] <= 360 and self.largest[y] <= 90:
            fine = min(self.decimals[x], self.decimals[y]) >= 4
            if by_name or fine and 0 < max(self.spans[x], self.spans[y]) < 0.1 * self.spans[self.indices[2]]:
                self.angles = "look like degrees"
        are_words = self.meanings[x].rank == self.meanings[y].rank == 1  # as "easting"
        if self.is_utm(y, x) and not self.is_utm(x, y) and not self.has_swapped and not are_words:
            why = "x is as large as a northing and y as an easting of UTM or Gauss-Krueger"
            self.notes.append(f"{why}; if so: {self.way(self.swapped())}")

    # -- words

    def none_is_named(self):
        return f"no column is named as {'x, y or z' if self.needed == 3 else 'x or y'}"

    def note(self, words):
        self.notes.append(f"{words} (see {option('columns')})" if self.can_be_chosen else words)

    def way(self, indices):
        """What a user can do so that columns are taken."""
        numbers = ",".join(str(i + 1) for i in indices)
        return f"{option('columns')} {numbers}" if self.can_be_chosen else self.advice

    def taken(self):
        return ", ".join(f"{axis} = {self.called(i)}" for axis, i in zip(self.axes, self.indices))

    def called(self, i):
        name = self.names[i] if self.names else ""
        return f"{i + 1} ({name})" if name else str(i + 1)

    def listed(self, columns):
        words = [self.called(i) for i in columns[:6]]
        return "columns " + " and ".join(words) if len(words) > 1 else f"column {words[0]}"

    # -- the other columns

    def name_others(self):
        """Sets extras and texts."""
        left_out = []
        for i in [i for i in range(self.width) if i not in self.indices and self.needed == 3]:
            name = (self.names[i].strip() if self.names else "") or f"column {i + 1}"
            if not len(self.finite[i]) or self.share_of_text[i] > 0.1:
                left_out.append(name)
                others = self.texts if self.share_of_text[i] > 0 else {}
            else:
                others = self.extras
                colours = [colour for colour, words in known().colours.items() if "".join(plain(name)) in words]
                name = next((colour for colour in colours if colour not in others.values()), name)
            is_known = name in (*self.extras.values(), *self.texts.values())
            others[i] = f"{name} (column {i + 1})" if is_known else name
        if left_out:
            chosen = f"; {option('where')} chooses points by them" if self.texts and self.can_be_chosen else ""
            self.notes.append(f"columns without numbers are left out: {', '.join(left_out)}{chosen}")
