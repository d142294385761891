# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""How the lines of a text table become words and numbers, and which names its columns have."""

import csv
import dataclasses
import importlib.util
import math
import re

import numpy

from .column_names import known_names, meaning, plain, length_unit
from .tables import known
from ..messages import FileError


FORTRAN = re.compile(r"([-+]?(?:\d+(?:\.\d*)?|\.\d+))[dD]([-+]?\d+)")  # 1.5D+03


@dataclasses.dataclass(frozen=True)
class Layout:
    """How a line of text becomes words: the separator (None: blanks) and the decimal sign."""

    separator: object
    decimal_comma: bool = False

    def __str__(self):
        return known().separators[self.separator] + ", decimal comma" * self.decimal_comma

    def words(self, line):
        if '"' not in line:
            words = line.split(self.separator)
        elif self.separator is None:
            words = [quoted or plain for quoted, plain in re.findall(r'"([^"]*)"|(\S+)', line)]
        else:
            csv.field_size_limit(max(csv.field_size_limit(), len(line)))  # of Python: 131,072 letters
            words = next(csv.reader([line], delimiter=self.separator))
        return [word.strip() for word in words] if self.separator else words

    def number(self, word):
        """The word's value; NaN where a value is missing; None for text."""
        plain = word.replace(",", ".") if self.decimal_comma else word
        try:
            return float(plain if "_" not in plain else "")  # Python takes 1_000 for a number
        except ValueError:
            if fortran := FORTRAN.fullmatch(plain):
                return float("e".join(fortran.groups()))
        return math.nan if is_missing(word) else None

    def numbers(self, line):
        """How many words of the line are written as numbers."""
        return sum(not is_missing(word) and self.number(word) is not None for word in self.words(line))


def is_missing(word):
    return not word or word.lower() in known().signs["missing"]


def is_number(word):
    return Layout(None).number(word) is not None


def is_comment(line):
    return line.lstrip().startswith(known().signs["comments"])


def with_points():
    """The layouts with decimal points."""
    return [Layout(separator) for separator in known().separators]


def find_layout(path, lines, needed):
    """The layout under which most of the first lines hold the needed number of numbers."""
    lines = [line for line in lines if line.strip()]
    sample = [line for line in lines if not is_comment(line)][:400]
    head = "\n".join(line.strip().lower() for line in lines[:20])
    for pattern, words in known().not_tables:
        if pattern.match(head):
            advice = "" if importlib.util.find_spec("osgeo") else "; install python3-gdal to read it"
            raise FileError(f"{path}: {words.replace('{path}', path).replace('{gdal}', advice)}")
    if not sample:
        raise FileError(f"{path}: holds no data, only blank or comment lines")
    layouts = with_points() + [Layout(one, True) for one in known().separators if one != ","]
    counts = {layout: [layout.numbers(line) for line in sample] for layout in layouts}

    def merits(layout):
        """Rows, numbers, and fewer words that are none: "1,5;2,5" is two numbers with decimal commas."""
        rows = [line for line, count in zip(sample, counts[layout]) if count >= needed]
        return len(rows), sum(counts[layout]), -sum(len(layout.words(line)) for line in rows)

    best = max(layouts, key=merits)
    has_rows = merits(best)[0] > 0
    are_needed = f"Rows with {'x, y and z' if needed == 3 else 'x and y'} in columns of their own are needed"
    for pattern, most, words in known().not_numbers:
        if sum(bool(pattern.search(line)) for line in sample) > (most if has_rows else 0.0) * len(sample):
            raise FileError(f"{path}: {words}")
    if has_rows:
        return best
    touching = list(filter(None, map(touching_in, sample)))
    if 2 * len(touching) > len(sample):
        raise FileError(f"{path}: {touching[0]}")
    if not any(re.search(r"\d", line) for line in sample):
        raise FileError(f"{path}: holds text, but no numbers. {are_needed}")
    raise FileError(
        f"{path}: no line holds {needed} numbers; the most is {max(map(max, counts.values()))}. {are_needed}"
    )


def touching_in(line):
    """What is wrong with a line in which numbers touch, or ""."""
    touching, date = (known().patterns[name] for name in ("touching", "date"))
    word = next((w for w in line.split() if touching.fullmatch(w) and not date.fullmatch(w)), "")
    return word and (
        f"numbers of fixed width touch, as {word[:40]}: cut them by their widths, as awk '{{print substr($0,1,10), "
        "substr($0,11,10), substr($0,21,10)}' for 10 each"
    )


@numpy.errstate(all="ignore")
def title_kind(layout, line, others, count):
    """Whether a line of numbers is a title, as "1024 2048 3", where others are rows: "sure", "doubtful" or "".
    So many (count) lines follow in all.

    Such numbers are whole, and far from all of the others that have decimals. It is doubtful where few rows, or
    numbers of another kind, leave it open whether that is a point; where it alone lacks decimals; and where it begins
    with the number of lines. The numbers of columns, from 0, are one if they are elsewhere than the others.
    """
    words = layout.words(line)
    words, first = (words, 0) if words[0] else (words[1:], 1)  # pandas has no name for an index
    rows = [row[first : first + len(words)] for row in map(layout.words, others) if len(row) >= len(words) - 1]
    width = min(map(len, rows), default=0)
    own = numpy.array([layout.number(word) for word in words[:width]], "f8")
    values = numpy.array([[layout.number(word) for word in row[:width]] for row in rows], "f8")
    if width < 2 or not numpy.isfinite(own).all() or not own.any():
        return ""
    sign = "," if layout.decimal_comma else "."
    decimals = [
        {len(row[i].partition(sign)[2]) for row, number in zip(rows, values[:, i]) if numpy.isfinite(number)}
        for i in range(width)
    ]
    have_decimals = numpy.array([0 not in found for found in decimals])
    low, high = (numpy.where(numpy.isnan(values), no, values) for no in (numpy.inf, -numpy.inf))
    low, high = low.min(axis=0), high.max(axis=0)
    away = numpy.maximum(low - own, own - high)
    is_far = away > numpy.maximum(high - low, 0.5 * numpy.maximum(abs(low), abs(high)))
    least = numpy.minimum(abs(low), abs(high))
    is_near = (least > high - low) & (away < 0.1 * least)  # as map coordinates are
    is_whole = all(map(str.isdecimal, words))
    if not is_whole and all(found == {len(word.partition(sign)[2])} for word, found in zip(words, decimals)):
        return ""  # as the others are written
    x_and_y = set(own[is_far][:2])  # alike, they may be nulls, which are left out later
    is_null = len(x_and_y) == 1 and not x_and_y.isdisjoint(known().nulls["values"] + known().nulls["rows"])
    if have_decimals.sum() > 1 and layout.separator and words == list(map(str, range(len(words)))):
        return "sure" * bool((away[have_decimals][:2] > 0).any())
    is_apart = is_far & (away > 10 * (high - low))
    count_far = (is_far if is_whole else is_apart).sum()
    if count_far > 1 and count_far + 1 >= width and not is_null and len(rows) > (2 if is_whole else 9):
        is_sure = is_whole and (is_apart & have_decimals).sum() > 1 and len(rows) > 9
        return "sure" if is_sure else "doubtful"
    lacks_decimals = have_decimals.sum() > 1 and all(len(found) == 1 for found in decimals)
    is_doubtful = is_whole and len(rows) > 9 and is_near.sum() < 2 and (lacks_decimals or own[0] == count)
    return "doubtful" * bool(is_doubtful)


def notes_on_marks(path, rows, columns, axes):
    """Refuses marks between thousands that look like decimal signs, where the file proves it: another sign stands
    before decimals, or numbers below 1000 have no sign and all others have it before three digits, with zeros at the
    end where these are not cut off. A note says where z alone has a sign, always before three digits.

    columns, axes  those of numbers; of them x, y and z
    """
    is_grouped, signs, proved = known().patterns["grouped"].fullmatch, {".": [], ",": []}, False
    for i in columns:
        words = [row[i] for row in rows if i < len(row) and is_number(row[i].replace(",", "."))]
        for sign, found in signs.items():
            found += [word for word in words if sign in word]
        marked = list(filter(is_grouped, words))
        without = sum(bool(re.fullmatch(r"[-+]?\d{1,3}", word)) for word in words)
        proved |= any(word[-1] == "0" for word in marked) and without > 0 and len(marked) + without == len(words)
    if all(signs.values()):
        proved |= any(all(map(is_grouped, found)) for found in signs.values())
    if proved:
        raise FileError(f"{path}: {known().refusals['thousands']}")
    places = [[row[i] for i in axes] for row in rows if len(row) > max(axes)]
    if len(axes) < 3 or not places or not all(is_grouped(z) and not re.search("[.,]", x + y) for x, y, z in places):
        return []
    return [
        f"z = {places[0][2]} is read as {places[0][2].replace(',', '.')}, though x,y are whole "
        "numbers; if the sign stands between thousands, export plain decimals"
    ]


def check_names(path, layout, before, rows, names, width, advice):
    """Refuses a header that names x, y and z but has more or fewer names than there are columns.

    before  the lines before the data that are not comments
    rows    some lines of data as words
    names   of the columns as far as they were found, or None
    """
    rows = [" ".join(row) for row in rows if len(row) == width]
    if layout.separator == "," and are_parted_by_commas(rows):
        raise FileError(f"{path}: {known().refusals['commas twice']}")
    patterns = known().patterns
    if not names and len(rows) > 1 and all(map(patterns["sexagesimal"].fullmatch, rows)):
        if any(map(patterns["with decimals"].match, rows)):
            raise FileError(
                f"{path}: the columns look like degrees, minutes and seconds; export degrees as plain "
                f"decimals; {advice}"
            )
    if not before or known_axes(names or []):
        return
    for other, found in splittings(layout, before[-1]):
        if known_axes(found) < set("xyz") or len(found) == width:
            continue
        own = other.separator and other.separator == layout.separator
        meanings = [meaning(name) for name in found]
        others = [name for m, name in zip(meanings, found) if not m.axis and not m.role]
        if own or known().words["beside axes"].issuperset(plain(" ".join(others))):
            degrees = any(m.rank == 3 for m in meanings) and width in (5, 7)
            why = "export degrees as plain decimals, if minutes have columns of their own, or " if degrees else ""
            if layout.separator == "," and len(found) < width:
                why = "commas within numbers part them too, else "
            raise FileError(
                f"{path}: the header has {len(found)} names, but lines have {width} columns; "
                f"{why}give each column a name; {advice}"
            )


def known_axes(names):
    return {meaning(name).axis for name in names} - {""}


def are_parted_by_commas(rows):
    """Whether words 1, 3, 5 of rows look like what stands before a decimal comma, and 2, 4, 6 behind it.

    These are whole, all of the same length, and one of them begins with 0, as no number does.
    """
    if len(rows) < 2 or not all(map(known().patterns["pairs"].fullmatch, rows)):
        return False
    behind = [row.split()[1::2] for row in rows]
    are_even = all(len(set(map(len, column))) == 1 for column in zip(*behind))
    return are_even and any(re.match(r"0\d", word) for row in behind for word in row)


def splittings(layout, line):
    """Yields (Layout, names) of a line of names, with the separator of the data and with others."""
    for other in [layout, *with_points()]:
        yield other, [unquoted(word) for word in other.words(line)]


def find_names(layout, head, width, one_may_lack=True):
    """The names of the columns from the lines before the data, or None.

    head          the lines before the data, without the marks of comments
    one_may_lack  whether the first column may have none

    They stand in one line, with the separator of the data or another; or a line each, numbered as
    "3: X", or below their count as GSLIB has them.
    """
    numbered = filter(None, map(known().patterns["numbered name"].match, head))
    found = {int(match.group(1)): match.group(2).strip('" ') for match in numbered}
    candidates = [[found[i] for i in range(1, width + 1) if i in found]]
    if len(head) == width + 2 and head[1].split()[:1] == [str(width)]:
        return head[2:]  # whatever the title's words mean
    for line in reversed(head):
        for other, words in splittings(layout, line):
            others = [words]
            if other.separator is None:
                # "x (m)  y (m)": blanks within names; good enough when single letters are left
                others += [re.split(r"\s{2,}|\t", line.strip()), [w for w in words if re.sub(r"[(\[{].*|\W|_", "", w)]]
            if one_may_lack and len(words) == width - 1 and known_names(words):
                others.append(["", *words])  # as R writes it: row names have no name
            if not any(words[width:]):  # as behind separators at the end
                others.append(words[:width])
            # With another separator than the data has, words that mean nothing are a sentence.
            candidates += [names for names in others if other is layout or known_names(names) > 1]
    candidates = [names for names in candidates if len(names) == width and not all(map(is_number, names))]
    return max(candidates, key=known_names, default=None)


def unquoted(word):
    """A name without the quotes around it; those that belong to it stay, as in Top "A"."""
    word = word.strip()
    for sign in "\"'":
        if word[:1] == word[-1:] == sign or word.count(sign) % 2:
            word = word.strip(sign).strip()
    return word


def notes_on_units(layout, head, names, indices):
    """Notes where the header has one unit of length for x and y, and another for z.

    The units stand in the names, as in "Z (ft)", in a line of their own, as in "m,m,ft", or where
    Petrel writes them.
    """
    rows = [names or [], *([f"({word.strip('()[]')})" for word in layout.words(line)] for line in head)]
    rows = [[row[i] if i < len(row) else "" for i in indices] for row in rows]
    petrel = dict(re.findall(r"unit in (x and y direction|depth):\s*(\w+)", "\n".join(head).lower()))
    across, up = (f"({petrel.get(where)})" for where in ("x and y direction", "depth"))
    for row in [*rows, [across, across, up]]:
        units = list(map(length_unit, row))
        if all(units) and units[0] == units[1] != units[2]:
            return [
                f"x and y are in {units[0]} and z is in {units[2]}, by the header: nothing is "
                "converted, so slopes and distances mix both"
            ]
    return []
