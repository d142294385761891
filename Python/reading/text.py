# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of numbers in text files: separator, header, comments and columns are found out here.

A file is read in blocks of whole lines. numpy parses a block at once, exactly, some two million
lines a second. What numpy does not take is parsed line by line, so that an error can name the line.
"""

import collections
import contextlib
import math
import re

import numpy

from ..clouds import WHOLE, Cloud, add_array, make_points
from .columns import advice_on_columns, choose_columns
from .known import COMMENT_MARKS, SUMMARY
from .layouts import (
    are_touching,
    check_marks,
    check_names,
    doubtful_marks,
    doubtful_units,
    find_layout,
    find_names,
    is_comment,
    is_data,
    known_axes,
    touching_in,
)
from .text_blocks import Blocks, lines_of
from ..messages import FileError, Reason, counted
from ..progress import no_progress, items_with_progress
from ..projecting import note_on_degrees
from ..selecting import MOST_VALUES, WordReader
from ..names import option

TAIL = 50  # lines at the end of a block among which summaries are looked for
CHUNK = 1000  # lines that are tried at once where a block is not all numbers
SAMPLE = 3000  # lines at the start, and as many from the rest of the first block
NAMED, MOST_SUMMARIES = 3, 5  # that many lines of other kinds, and of summaries, are named
# Over parts of a file.
SUMMED = ("count", "comments", "repeated", "ragged", "summaries", "skipped", "skipped_lines", "uneven")
MOST_UNEVEN = 0.2  # lines of numbers that are left out, as a share of rows


class BadLine(FileError):
    """A line that is not a row of the table."""


# ---- what kind of table -----------------------------------------------------------------------


class Table:
    """What the first block shows of a table.

    layout, words    how lines become words, and how many a line has
    width            how many of these are columns: a separator may stand behind the last
    names            of the columns, or None
    first            index of the first line of data
    advice           what a user can do where columns are wrong; None: choose others
    has_summaries    whether lines that begin with "Total" or such are not data
    sees_summaries   whether there are such at the start or at the end of the first block
    head_lines       lines before the data that are not comments, without blanks around
    headers, comments  how many lines before the data are such
    indices, extras, texts, of_numbers, notes, z_name, is_horizon, angles  see Choice
    skips            whether lines of other kinds are left out; bad_lines are [number, text] of those
                     before the data
    """

    def __init__(self, path, lines, columns, needed, advice, skips):
        self.path, self.needed, self.advice = path, needed, advice or advice_on_columns()
        self.skips, self.can_skip, self.bad_lines = skips, advice is None, []
        self.layout = find_layout(path, lines[:5000], needed)
        head, preamble, self.comments = self.read_head(lines)
        self.head_lines = {lines[number - 1].strip() for number, _ in preamble}
        near = self.first + SAMPLE
        behind = lines[self.first : near] + lines[max(near, len(lines) - TAIL) :]
        behind = [line for line in behind if is_data(line)]
        summaries = sum(bool(SUMMARY.match(line)) for line in behind)
        # Points may have such names; then they are many.
        self.has_summaries = summaries < len(behind) and summaries <= 5 + len(behind) // 100
        self.sees_summaries = self.has_summaries and summaries > 0
        rows, consecutive = self.sample(lines)
        self.name_columns(head, rows)
        if not columns:
            before = [lines[number - 1] for number, _ in preamble]
            check_names(path, self.layout, before, rows[:400], self.names, self.width, self.advice)
        chosen = choose_columns(
            path, rows, consecutive, self.layout, self.names, self.width, columns, needed,
            advice,
        )
        vars(self).update(vars(chosen))
        check_marks(path, rows, self.of_numbers)
        if needed == 3:
            self.notes += doubtful_marks(rows, *self.indices)
            self.notes += doubtful_units(self.layout, head, self.names, self.indices)
        begins = self.first_of_data(lines, preamble)
        if begins:
            self.first = begins - 1
            self.head_lines = {lines[n - 1].strip() for n, _ in preamble if n < begins}
        self.headers = sum(number <= self.first for number, _ in preamble) - len(self.bad_lines)

    def read_head(self, lines):
        """(lines before the data, those of them that are not comments, number of comments).

        The second as (number, words). Sets first.
        """
        head, preamble, comments = [], [], 0
        for self.first, line in enumerate(lines):
            if is_comment(line):
                head.append(line.strip().lstrip("#%/!*> "))
                comments += 1
            elif self.is_like(line) and not known_axes(self.layout.words(line)) >= set("xyz"):  # as x,y,z,0,1
                break
            elif line.strip():
                head.append(line.strip())
                preamble.append((self.first + 1, self.layout.words(line)))
        return head, preamble, comments

    def sample(self, lines):
        """(rows as words, how many of them follow each other)."""
        start = self.first + SAMPLE
        data = [line for line in lines[self.first : start] if self.is_row(line)]
        step = max(1, (len(lines) - start) // SAMPLE)
        later = [line for line in lines[start::step] if self.is_row(line)]
        if self.skips:
            data, later = ([line for line in some if self.is_like(line)] for some in (data, later))
        return [self.layout.words(line) for line in data + later], len(data)

    def is_like(self, line):
        """Whether a line holds enough numbers for a row."""
        return self.layout.numbers(line) >= self.needed

    def bad_line(self, number, line, why, advice=""):
        """The error for a line that is not a row."""
        touching = touching_in(line)
        if touching:
            why, advice = are_touching(touching), ""
        elif self.can_skip and not (advice and self.is_like(line)):
            advice = f"{option('skip_bad_lines')} leaves out such lines"
        return BadLine(f"{self.path}, line {number}: {why}" + (advice and "; " + advice))

    def no_number(self, number, line, words, axis):
        """The error for a line in which x, y or z is a word."""
        index = self.indices[axis]
        why = f"'{words[index][:40]}' in column {index + 1} ({'xyz'[axis]}) is not a number"
        return self.bad_line(number, line, why, self.advice)

    def is_row(self, line):
        """Whether a line behind the header is data: not blank, no comment, header or summary."""
        return is_data(line) and line.strip() not in self.head_lines and not self.summary(line)

    def summary(self, line):
        """The word of a line that holds the total, mean or such of others; None for data."""
        match = SUMMARY.match(line) if self.has_summaries else None
        return match and match.group(1)

    def name_columns(self, head, rows):
        """Sets words, width and names."""
        widths = collections.Counter(len(row) for row in rows)
        self.words = self.width = widths.most_common(1)[0][0]
        if not self.skips:
            self.words = self.width = max(len(rows[0]), self.width)
        # Where lines end with a separator, nothing stands behind it.
        ends = self.width > self.needed and not any("".join(row[self.width - 1 :]) for row in rows)
        self.names = find_names(self.layout, head, self.width, not ends)
        if ends and not (self.names and self.names[-1]):
            self.width -= 1
            self.names = find_names(self.layout, head, self.width)

    def first_of_data(self, lines, preamble):
        """The number of the first line of what looked like a header but is data, as it lacks a value.

        None where there is none. A line that looks like data but for one word is an error, no header.
        """
        for number, words in preamble:
            try:
                if self.lacks_a_value(number, words, lines[number - 1]):
                    return number
            except BadLine:
                if not self.skips:
                    raise
                self.bad_lines.append([number, lines[number - 1].strip()])
        return None

    def lacks_a_value(self, number, words, line):
        """Whether a line before the data is a row without one of its values."""
        values = [self.layout.number(word) for word in words]
        no_words = re.fullmatch(r"[-+\d.,;\seE]+", " ".join(words)) is not None
        if 2 <= len(words) < self.width and (None not in values or no_words):
            why = f"{len(words)} columns found where other lines have {self.width}"
            raise self.bad_line(number, line, f"{why} (mark it with # if it is not a row of data)")
        if len(words) < self.width:
            return False
        values = [values[i] for i in self.indices]
        good = sum(v is not None and not math.isnan(v) for v in values)
        if None in values and good >= len(values) - 1:
            raise self.no_number(number, line, words, values.index(None))
        return None not in values and good > 0


# ---- rows -------------------------------------------------------------------------------------


class Parser:
    """Turns blocks of lines into rows of numbers: those of the axes first, then the extras.

    blocks   the Blocks of the file, or of a part of it
    alive    is called now and then where a block takes long
    named    whether all columns of text are wanted; else those with more than MOST_VALUES words are
             given up
    """

    def __init__(self, table, blocks, alive, named=False):
        self.table, self.blocks, self.alive, self.named = table, blocks, alive, named
        self.words = {index: WordReader() for index in table.texts}
        self.used = list(table.indices) + list(table.extras)
        self.parts, self.numbers, self.starts = [], [], []
        self.count = self.line = self.comments = self.repeated = self.uneven = 0
        self.after_blank = True
        self.before = None  # lines before this part of the file, once a message needs their number
        self.ragged = []  # the first line with more words than others, and their number
        self.no_numbers = {}  # {index of an extra: [count, first line, word] of what is not a number}
        self.summaries = []  # (line number, word)
        # Lines of other kinds, and the first of them: [number, text].
        first = table.bad_lines if blocks.begin == 0 else []
        self.skipped, self.skipped_lines = len(first), first[:NAMED]

    def add(self, block, lines, skip):
        """Takes the lines of a block, but for the first so many, which are not data."""
        before = self.skipped
        if self.table.skips:
            lines = self.without_short(block, lines, skip)
        plain = not skip and before == self.skipped and not any(mark.encode() in block for mark in COMMENT_MARKS)
        if self.table.sees_summaries or any(map(self.table.summary, lines[-TAIL:])):
            plain = False
        rows = self.load(lines, b'"' in block) if plain else None
        if rows is not None and len(rows) == len(lines):
            self.keep(rows, numpy.arange(self.line + 1, self.line + 1 + len(lines)), lines)
            if self.after_blank:
                self.starts.append(self.count - len(rows))
                self.after_blank = False
        else:
            self.add_carefully(lines, skip, b'"' in block)
        self.check_widths(block, lines, skip)
        self.line += len(lines)

    def without_short(self, block, lines, skip):
        """The lines with blanks for those that are too short for a row."""
        lines = list(lines)
        for i in self.of_other_width(block, lines):
            words = self.table.layout.words(lines[i])
            if i >= skip and self.table.is_row(lines[i]) and self.is_short(words):
                self.skip(i, lines[i])
                lines[i] = ""
        return lines

    def skip(self, i, line):
        """Leaves out a line of another kind."""
        self.skipped += 1
        self.uneven += self.table.is_like(line)
        if len(self.skipped_lines) < NAMED:
            self.skipped_lines.append([self.number(i), line.strip()])

    def number(self, i):
        """The number in the file of line i of the block."""
        if self.before is None:
            self.before = self.blocks.lines_before()
        return self.before + self.line + 1 + i

    def keep(self, rows, numbers, lines):
        if self.words:
            self.keep_words(lines)
        self.parts.append(rows)
        self.numbers.append(numbers)
        self.count += len(rows)

    def keep_words(self, lines):
        """The words of the columns of text."""
        for index, reader in list(self.words.items()):
            reader.add(self.words_in(lines, index))
            if len(reader.codes) > MOST_VALUES and not self.named:
                del self.words[index]

    def words_in(self, lines, index):
        """The words of a column; "" in lines that end before it."""
        layout = self.table.layout
        if not any('"' in line for line in lines):
            try:
                return [line.split(layout.separator, index + 1)[index].strip() for line in lines]
            except IndexError:
                pass
        rows = map(layout.words, lines)
        return [row[index] if index < len(row) else "" for row in rows]

    def take_words(self):
        """{name: Words} since the last call."""
        return {self.table.texts[index]: reader.take() for index, reader in self.words.items()}

    def load(self, lines, quoted):
        """numpy's rows of some lines, or None where a word is not a number."""
        if self.table.layout.decimal_comma:
            if quoted:
                return None
            lines = [line.replace(",", ".") for line in lines]
        try:
            return numpy.loadtxt(
                lines,
                delimiter=self.table.layout.separator,
                usecols=self.used,
                comments=None,
                ndmin=2,
                **({"quotechar": '"'} if quoted else {}),
            )
        except ValueError:
            return None

    def add_carefully(self, lines, skip, quoted):
        """Lines among which are comments, blank lines, missing values, quotes or errors."""
        kept = []
        for i, line in enumerate(items_with_progress(lines, self.alive, len(lines), 20 * CHUNK)):
            if i < skip or not line.strip():
                self.after_blank |= i >= skip or not self.count
            elif is_comment(line):
                self.comments += 1
                self.after_blank |= line.lstrip().startswith(">")
            elif line.strip() in self.table.head_lines:
                self.repeated += 1
            elif self.table.summary(line):
                self.summaries.append((self.number(i), self.table.summary(line)))
            else:
                if self.after_blank:
                    self.starts.append(self.count + len(kept))
                    self.after_blank = False
                kept.append(i)
        for start in range(0, len(kept), CHUNK):
            some = kept[start : start + CHUNK]
            rows = self.load([lines[i] for i in some], quoted)
            if rows is None or len(rows) < len(some):
                rows, some = self.rows(lines, some)
            if some:
                self.keep(rows, self.line + 1 + numpy.array(some), [lines[i] for i in some])
            self.alive(0.0)

    def rows(self, lines, places):
        """(the rows of the lines at some places, the places without those that are skipped)."""
        rows, kept = [], []
        for i in places:
            try:
                rows.append(self.row(lines[i], i))
                kept.append(i)
            except BadLine:
                if not self.table.skips:
                    raise
                self.skip(i, lines[i])
        return numpy.array(rows), kept

    def row(self, line, i):
        """The numbers of a line, its place in the block being i."""
        try:
            if not ('"' in line or "_" in line):
                words = line.split(self.table.layout.separator)
                return [float(words[k]) for k in self.used]
        except (ValueError, IndexError):
            pass
        return self.careful_row(line, i)

    def careful_row(self, line, i):
        """A row that is not plain numbers: missing values, words in other columns, or an error."""
        table = self.table
        words, row = table.layout.words(line), []
        for axis, index in enumerate(table.indices):
            if index >= len(words):
                why = f"{counted(len(words), 'column')} found, but {'xyz'[axis]} is column {index + 1}"
                raise table.bad_line(self.number(i), line, why)
            value = table.layout.number(words[index])
            if value is None:
                raise table.no_number(self.number(i), line, words, axis)
            row.append(value)
        for index in table.extras:
            value = table.layout.number(words[index]) if index < len(words) else math.nan
            if value is None:
                if index not in self.no_numbers:
                    self.no_numbers[index] = [0, self.number(i), words[index]]
                self.no_numbers[index][0] += 1
            row.append(math.nan if value is None else value)
        return row

    def check_widths(self, block, lines, skip):
        """Remembers the first line that has more words than the others.

        Where blanks part the words, a line that lacks one is an error: nothing shows which.
        """
        table = self.table
        is_first = self.line == 0 and self.blocks.begin == 0
        if not self.parts or b'"' in block and not is_first and table.layout.separator:
            return
        for i in self.of_other_width(block, lines):
            if i < skip or not table.is_row(lines[i]):
                continue
            words = table.layout.words(lines[i])
            if len(words) > table.words:
                self.ragged = self.ragged or [self.number(i), len(words)]
                if table.layout.separator:
                    return
            elif self.is_short(words):
                why = (
                    f"{counted(len(words), 'column')} found where {table.words} are expected, and "
                    "blanks do not show which one lacks; part the columns by commas or write nan for "
                    "what is missing"
                )
                raise table.bad_line(self.number(i), lines[i], why)

    def of_other_width(self, block, lines):
        """The places of lines that may have more or fewer words than the others."""
        table, every = self.table, range(len(lines))
        if table.layout.separator:
            separators = block.count(table.layout.separator.encode())
            even = self.ragged or separators == (table.words - 1) * len(lines)
            return () if even else every
        if b'"' in block:
            return every
        letters = numpy.frombuffer(block, dtype="u1")
        blank = letters <= 32
        begins = numpy.flatnonzero(blank[:-1] > blank[1:])
        begins = numpy.append(numpy.flatnonzero(~blank[:1]) - 1, begins)
        ends = numpy.append(numpy.flatnonzero(letters == 10), len(letters))[: len(lines)]
        if len(begins) == table.words * len(lines):
            in_lines = begins.reshape(len(lines), table.words)
            if (in_lines[:, -1] < ends).all() and (in_lines[1:, 0] >= ends[:-1]).all():
                return ()
        counts = numpy.diff(numpy.searchsorted(begins, ends), prepend=0)
        return numpy.flatnonzero(counts != table.words).tolist()

    def is_short(self, words):
        """Whether blanks part fewer words than others have, unless only text lacks behind numbers."""
        table = self.table
        if len(words) >= table.words or table.layout.separator:
            return False
        return any(
            column >= len(words) or table.layout.number(words[column]) is None
            for column in table.of_numbers
        )

    def take(self):
        """(rows, line numbers) since the last call. There must be some."""
        taken = [
            parts[0] if len(parts) == 1 else numpy.concatenate(parts)
            for parts in (self.parts, self.numbers)
        ]
        self.parts, self.numbers = [], []
        return taken

    def facts(self):
        """What final_notes() reports about lines, as plain values that can be added to those of other parts."""
        return {
            **{name: getattr(self, name) for name in SUMMED},
            "no_numbers": {str(i): [found] for i, found in self.no_numbers.items()},
        }

    def take_facts(self, facts):
        """Takes the facts of the whole file as its own."""
        vars(self).update({name: facts[name] for name in SUMMED})
        self.no_numbers = {
            int(i): [sum(count for count, *_ in found), *found[0][1:]]
            for i, found in facts["no_numbers"].items()
        }

    def final_notes(self):
        """Notes, once all lines are read. Raises FileError where many rows have other numbers of columns."""
        table = self.table
        if self.uneven > MOST_UNEVEN * self.count:
            raise FileError(
                f"{table.path}: {self.uneven:,} lines of numbers have other columns than {self.count:,} rows: blanks do not "
                "part the columns of this table; export it as .csv"
            )
        notes, comments = table.notes, self.comments + table.comments
        seen = [f"separated by {table.layout}"]
        for count, what in ((table.headers, "header"), (comments, "comment")):
            if count:
                seen.append(counted(count, f"{what} line"))
        if not any(" as x" in note or ", y = " in note for note in notes):
            columns = ", ".join(str(index + 1) for index in table.indices)
            notes.insert(0, f"{', '.join('xyz'[:table.needed])} are in columns {columns}")
        notes.insert(0, "text: " + ", ".join(seen))
        if self.repeated:
            notes.append(f"header lines that come again are left out: {self.repeated:,}")
        if self.ragged:
            notes.append(
                f"line {self.ragged[0]:,} has {self.ragged[1]} columns where others have "
                f"{table.words}: they are counted from the left"
            )
        for what, lines, count, most in (
            ("summary lines", self.summaries, len(self.summaries), MOST_SUMMARIES),
            ("lines of other kinds", self.skipped_lines, self.skipped, NAMED),
        ):
            words = ", ".join(f"line {line:,} ({text[:20]})" for line, text in lines[:most])
            more = f" and {count - most:,} more" if count > most else ""
            notes += [f"{what} are left out: {words}{more}"] * bool(count)
        for index, (count, line, word) in self.no_numbers.items():
            words = counted(count, "word is not a number", "words are not numbers")
            where = f"line {line:,}" if count == 1 else f"first in line {line:,}"
            notes.append(f"column {table.extras[index]}: {words} ({where}: {word[:40]})")
        return notes


def parsed(path, columns, needed, advice, progress, named=False, part=WHOLE, skips=False):
    """Yields the Parser of a text file, or of a part of it, before and after each block of lines."""
    done = 0.0

    with open(path, "rb") as stream:
        blocks = Blocks(path, stream, part)
        head = next(iter(blocks if part.is_whole() else Blocks(path, stream)), None)
        if head is None:
            raise FileError(f"{path}: is empty")
        head = lines_of(head[0])
        table = Table(path, head, columns, needed, advice, skips)
        parser, skip = Parser(table, blocks, lambda _: progress(done), named), 0
        yield parser
        for block, read in blocks:
            if parser.line == 0 and blocks.begin == 0:
                lines, skip = head, table.first
            else:
                lines, skip = lines_of(block), 0
            parser.add(block, lines, skip)
            done = read
            progress(done)
            yield parser


def parse(path, columns, needed, advice, progress, named=False, skips=False):
    """(parser, rows, line numbers, notes) of a text file."""
    for parser in parsed(path, columns, needed, advice, progress, named, skips=skips):
        pass
    if not parser.parts:
        raise FileError(f"{path}: no line is a row of x, y and z")
    return (parser, *parser.take(), parser.final_notes())


def read_table(path, needed=3, progress=no_progress):
    """Rows of numbers of a text file.

    Returns (rows, line numbers, starts, notes): rows is an array of n * needed doubles, a start is
    the index of a row that follows a blank line or one that begins with ">".
    """
    advice = f"a header line with {', '.join('xyz'[:needed])} names the columns"
    parser, rows, numbers, notes = parse(path, None, needed, advice, progress)
    return rows[:, :needed].copy(), numbers, parser.starts, notes


def read_line_table(path, progress):
    """As read_table() of x, y and z, or of x and y where there are no more columns of numbers."""
    try:
        return read_table(path, 3, progress)
    except FileError:
        with contextlib.suppress(FileError):
            table = parse(path, None, 2, "", progress)[0].table
            if len(table.of_numbers) == 2:
                return read_table(path, 2, progress)
        raise


def read_text(path, options):
    """The points of a text file; numbers in other columns become point arrays, text becomes Words.

    Returns a Cloud. Ten million lines of x, y and z take some five seconds of one core and 0.8 GB.
    """
    named = bool(options.where or options.layer)
    parser, rows, numbers, notes = parse(
        path, options.columns, 3, None, options.progress, named, options.skip_bad_lines
    )
    table = parser.table
    cloud = Cloud(None, notes, lines=numbers)
    cloud.z_name, cloud.is_horizon, cloud.angles = table.z_name, table.is_horizon, table.angles
    cloud.words = parser.take_words()
    if options.no_data is not None:
        keep = rows[:, 2] != options.no_data
        cloud.lines = numbers[keep]
        cloud.words = {name: words.some(keep) for name, words in cloud.words.items()}
        if not keep.all():
            cloud.left_out[Reason("row", "without data")] = int(numpy.count_nonzero(~keep))
            rows = rows[keep]
        if not len(rows):
            raise FileError(f"{path}: {TextSlices.without_data}")
    cloud.points = make_points(rows[:, :3])
    add_arrays(cloud.points, table.extras, rows[:, 3:])
    return cloud


class TextSlices:
    """The rows of a part of a text file: iterate to get (x y z, the other columns), block by block."""

    noun, without_data = "row", "all rows are without data"

    def __init__(self, path, options, part):
        self.parsed = parsed(
            path, options.columns, 3, None, options.progress, bool(options.where), part,
            options.skip_bad_lines,
        )
        self.parser = next(self.parsed)

    def __iter__(self):
        parser = self.parser
        for _ in self.parsed:
            if parser.parts:
                rows, words = parser.take()[0], parser.take_words()
                numbers = zip(parser.table.extras.values(), rows[:, 3:].T)
                yield rows[:, :3], {**words, **dict(numbers)}

    def facts(self):
        return self.parser.facts()

    def finish(self, facts, cloud):
        """Takes the facts about the whole file, and adds to a Cloud what is reported then."""
        table = self.parser.table
        self.parser.take_facts(facts)
        cloud.notes += self.parser.final_notes()
        cloud.z_name, cloud.is_horizon = table.z_name, table.is_horizon
        if table.angles != "no":
            cloud.notes.append(note_on_degrees(table.angles))
        if table.extras:
            cloud.notes.append(f"left out: {', '.join(table.extras.values())}")


def add_arrays(points, extras, values):
    """Adds columns as point arrays. Red, green and blue become one array RGB of bytes."""
    names = list(extras.values())
    colours = [names.index(name) for name in ("red", "green", "blue") if name in names]
    if len(colours) == 3:
        rgb = values[:, colours]
        if ((rgb >= 0) & (rgb <= 255) & (rgb == numpy.floor(rgb))).all():
            add_array(points, "RGB", rgb.astype("u1"))
            names = [None if i in colours else name for i, name in enumerate(names)]
    for i, name in enumerate(names):
        if name:
            column = numpy.ascontiguousarray(values[:, i])
            if (numpy.abs(column) < 2**31).all() and (column == numpy.floor(column)).all():
                column = column.astype("i4")
            add_array(points, name, column)
