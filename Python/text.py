# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of numbers in text files: separator, header, comments and columns are found out here, so
that an error can name the line."""

import array
import csv
import math
import re

import numpy

from .clouds import Cloud, make_points
from .messages import FileError

COMMENT_MARKS = ("#", "%", "//", "!", "*")
MISSING = {"", "na", "n/a", "null", "none", "nodata", "-"}
NAMES = {
    "x": {"x", "easting", "east", "e", "lon", "long", "longitude", "xcoord", "utmx", "xutm", "px"},
    "y": {"y", "northing", "north", "n", "lat", "latitude", "ycoord", "utmy", "yutm", "py"},
    "z": {"z", "elevation", "elev", "height", "altitude", "alt", "depth", "twt", "h", "pz"},
}


def plain_name(name):
    """Column names are compared without case, units in brackets and signs: "X (m)" -> "x"."""
    name = re.sub(r"[(\[{].*", "", name.lower())
    return re.sub(r"[^a-z0-9]", "", name)


class Layout:
    """How a line of text becomes words: the separator (None: blanks) and the decimal sign."""

    NAMES = {";": "semicolons", "\t": "tabs", ",": "commas", None: "blanks"}

    def __init__(self, separator, decimal_comma=False):
        self.separator = separator
        self.decimal_comma = decimal_comma

    def __str__(self):
        text = self.NAMES[self.separator]
        return text + ", decimal comma" if self.decimal_comma else text

    def words(self, line):
        if self.separator is None:
            return line.split()
        if '"' in line:
            return [word.strip() for word in next(csv.reader([line], delimiter=self.separator))]
        return [word.strip() for word in line.split(self.separator)]

    def number(self, word):
        """The word's value; NaN where a value is missing; None for text."""
        try:
            return float(word.replace(",", ".") if self.decimal_comma else word)
        except ValueError:
            return math.nan if word.lower() in MISSING else None

    def numbers(self, line):
        """How many words of the line are written as numbers."""
        return sum(
            1 for w in self.words(line) if w.lower() not in MISSING and self.number(w) is not None
        )


LAYOUTS = (
    Layout(";"),
    Layout("\t"),
    Layout(","),
    Layout(None),
    Layout(";", True),
    Layout("\t", True),
    Layout(None, True),
)


def read_lines(path):
    """The lines of a text file; UTF-8, UTF-16 with its mark, or Latin-1."""
    with open(path, "rb") as stream:
        data = stream.read()
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        text = data.decode("utf-16", "replace")
    elif b"\0" in data[:4096]:
        raise FileError(f"{path}: is not a text file")
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("latin-1")
    return text.splitlines()


def is_comment(line):
    return line.lstrip().startswith(COMMENT_MARKS)


def find_layout(path, lines, needed):
    """The layout under which most of the first lines hold the needed number of numbers."""
    sample = [line for line in lines if line.strip() and not is_comment(line)][:400]
    best, best_score, most = None, 0, 0
    for layout in LAYOUTS:
        counts = [layout.numbers(line) for line in sample]
        score = sum(1 for count in counts if count >= needed)
        most = max(most, max(counts, default=0))
        if score > best_score:
            best, best_score = layout, score
    if best:
        return best
    if not sample:
        raise FileError(f"{path}: holds no data, only blank or comment lines")
    if most == 0:
        raise FileError(f"{path}: holds text, but no numbers")
    raise FileError(
        f"{path}: no line holds {needed} numbers; the most is {most}. "
        f"{'x, y and z' if needed == 3 else 'x and y'} are needed in columns of their own"
    )


def find_columns(path, columns, header, width, needed):
    """Indices of the x, y, z columns, and a note when they were guessed."""
    axes = "xyz"[:needed]
    names = [plain_name(word) for word in header] if header else []
    if columns:
        indices = []
        for axis, column in zip(axes, columns):
            if re.fullmatch(r"\d+", column):
                index = int(column) - 1
                if not 0 <= index < width:
                    raise FileError(
                        f"{path}: there is no column {column} for {axis}; lines have {width}"
                    )
            elif column in (header or []):
                index = header.index(column)
            elif plain_name(column) in names:
                index = names.index(plain_name(column))
            else:
                known = ", ".join(header) if header else "none: the file has no header line"
                raise FileError(f"{path}: there is no column named {column}; names: {known}")
            indices.append(index)
        return indices, None
    found = []
    for axis in axes:
        matches = [i for i, name in enumerate(names) if name in NAMES[axis]]
        found.append(matches[0] if matches else None)
    if None not in found:
        if found == list(range(width)):
            return found, None
        text = ", ".join(f"{axis} = {header[i]}" for axis, i in zip(axes, found))
        return found, f"columns by their names: {text}"
    if width > needed:
        note = f"the first {needed} of {width} columns are taken as {', '.join(axes)}"
        return list(range(needed)), note + " (see --columns)"
    return list(range(needed)), None


def read_table(path, columns=None, needed=3):
    """Rows of numbers of a text file.

    Returns (rows, line numbers, blank-line starts, notes): rows is an array of n * needed doubles,
    a start is the index of a row that follows a blank line.
    """
    lines = read_lines(path)
    layout = find_layout(path, lines, needed)
    preamble, comments, indices, names = [], [], None, None
    values, numbers, starts = array.array("d"), array.array("l"), []
    notes, after_blank, width = [], False, 0
    skipped = 0
    for number, line in enumerate(lines, 1):
        if not line.strip():
            after_blank = True
            continue
        if is_comment(line):
            skipped += 1
            if indices is None:
                comments.append(layout.words(line.lstrip().lstrip("#%/!* ")))
            continue
        if indices is not None and '"' not in line:
            words = line.split(layout.separator)
        else:
            words = layout.words(line)
        if indices is None:
            if layout.numbers(line) < needed:
                preamble.append((number, words))
                continue
            width = len(words)
            headers = [w for _, w in preamble] + comments
            names = next((w for w in reversed(headers) if len(w) == width), None)
            if names is None and layout.separator is None:
                # "x (m)  y (m)": blanks within names; good enough when single letters are left
                for words_of_line in reversed(headers):
                    short = [w for w in words_of_line if plain_name(w)]
                    if len(short) == width:
                        names = short
                        break
            indices, note = find_columns(path, columns, names, width, needed)
            if note:
                notes.append(note)
            check_preamble(path, layout, preamble, indices, width)
        try:
            row = [float(words[i]) for i in indices]
        except (ValueError, IndexError):
            row = careful_row(f"{path}, line {number}", layout, words, indices)
        if after_blank or not numbers:
            starts.append(len(numbers))
            after_blank = False
        values.extend(row)
        numbers.append(number)
    heads = len(preamble)
    seen = [f"separated by {layout}"]
    if heads:
        seen.append(f"{heads} header line{'s' * (heads > 1)}")
    if skipped:
        seen.append(f"{skipped} comment line{'s' * (skipped > 1)}")
    notes.insert(0, "text: " + ", ".join(seen))
    rows = numpy.frombuffer(values, dtype="f8").reshape(-1, needed)
    return rows, numbers, starts, notes


def careful_row(where, layout, words, indices):
    """A row that is not plain numbers: decimal commas, missing values, or an error."""
    row = []
    for axis, index in zip("xyz", indices):
        if index >= len(words):
            raise FileError(
                f"{where}: {len(words)} column{'s' * (len(words) != 1)} found, "
                f"but {axis} is column {index + 1}"
            )
        word = words[index].strip()
        value = layout.number(word)
        if value is None:
            raise FileError(
                f"{where}: '{word[:40]}' in column {index + 1} ({axis}) is not a number; "
                "--columns chooses other columns"
            )
        row.append(value)
    return row


def check_preamble(path, layout, preamble, indices, width):
    """A line before the data that looks like data but for one word is an error, not a header."""
    for number, words in preamble:
        values = [layout.number(word) for word in words]
        if len(words) >= 2 and len(words) < width and None not in values:
            raise FileError(
                f"{path}, line {number}: {len(words)} columns found where other lines have {width} "
                "(mark it with # if it is no row of data)"
            )
        if len(words) != width:
            continue
        values = [values[i] for i in indices]
        good = sum(v is not None and not math.isnan(v) for v in values)
        if None in values and good >= len(values) - 1:
            axis = values.index(None)
            column = indices[axis]
            raise FileError(
                f"{path}, line {number}: '{words[column][:40]}' in column {column + 1} "
                f"({'xyz'[axis]}) is not a number; --columns chooses other columns"
            )


def read_text(path, options):
    rows, lines, _, notes = read_table(path, options.columns)
    cloud = Cloud(None, notes, lines=lines)
    if options.no_data is not None:
        keep = rows[:, 2] != options.no_data
        if not keep.all():
            cloud.left_out["rows without data"] = int(len(keep) - numpy.count_nonzero(keep))
            cloud.lines = array.array("l", numpy.asarray(lines)[keep].tolist())
            rows = rows[keep]
        if not len(rows):
            raise FileError(f"{path}: all rows are without data")
    cloud.points = make_points(rows)
    return cloud
