# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of numbers in text files: separator, header, comments and columns are found out here.

A file is read in blocks of whole lines. vtkTextRows parses a block of nothing but rows of numbers,
several million lines a second. Of others numpy reads many lines at once, exactly as well. What it
does not take is parsed line by line, so that an error can name the line.
"""

import collections
import math
import re

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray

from ..clouds import WHOLE, Cloud, ReadOptions, add_array, make_points
from .columns import Choice, advice_on_columns
from ..passes import in_vtk
from ..vtkElevationSurfacePieces import vtkTextRows
from .layouts import (
    check_names,
    find_layout,
    find_names,
    is_comment,
    known_axes,
    notes_on_marks,
    notes_on_units,
    title_kind,
    touching_in,
)
from .nulls import leave_out
from .tables import known
from .text_blocks import Blocks, block_lines, encoding_of
from ..messages import FileError, counted
from ..progress import no_progress
from ..projecting import note_on_degrees
from ..selecting import MOST_VALUES, WordReader
from ..names import option

TAIL = 50  # lines at the end of a block among which summaries are looked for
ROWS_BELOW = 100  # lines with which one that may be a title is compared
AT_ONCE = 20_000  # lines that numpy reads, all or none
SAMPLE = 3000  # lines at the start, and as many from the rest of the first block
NAMED, MOST_SUMMARIES = 3, 5  # that many lines of other kinds, and of summaries, are named
MOST_UNEVEN = 0.5, 0.08  # lines of numbers that are longer than others or left out, as a share of rows
WITHOUT_DATA = "all rows are without data"
NO_ROWS = {2: "no line is a row of x and y", 3: "no line is a row of x, y and z"}


class BadLine(FileError):
    """A line that is not a row of the table."""


# ---- what kind of table -----------------------------------------------------------------------


class Table:
    """What the first block shows of a table.

    layout, words    how lines become words, and how many a line has
    width            how many of these are columns: a separator may stand behind the last
    names            of the columns, or None
    first            index of the first line of data
    has_summaries    whether lines that begin with "Total" or such are not data
    sees_summaries   whether there are such at the start or at the end of the first block
    head_lines       lines before the data that are not comments, without blanks around
    headers, comments  how many lines before the data are such
    choice           the Choice of columns
    notes            its notes, and others
    skips            whether lines of other kinds are left out; bad_lines are [number, text] of those
                     before the data
    """

    def __init__(self, path, block, options, needed, advice):
        self.path, self.needed, self.advice = path, needed, advice or advice_on_columns()
        self.encoding = encoding_of(block)
        lines = block_lines(block, self.encoding)
        self.skips, self.can_skip, self.bad_lines = options.skip_bad_lines, advice is None, []
        self.layout = find_layout(path, lines[:5000], needed)
        self.head_lines, self.has_summaries, self.titles = set(), False, {}
        head, preamble = self.read_head(lines)
        near = self.first + SAMPLE
        behind = lines[self.first : near] + lines[max(near, len(lines) - TAIL) :]
        behind = [line for line in behind if self.is_row(line)]
        summaries = sum(map(bool, map(known().patterns["summary"].match, behind)))
        # Points may have such names; then they are many.
        self.has_summaries = summaries < len(behind) and summaries <= 5 + len(behind) // 100
        self.sees_summaries = self.has_summaries and summaries > 0
        before = [line for _, line in preamble]
        self.head_lines = set(map(str.strip, before))
        rows, consecutive = self.sample(lines)
        if not rows:
            raise FileError(f"{path}: {NO_ROWS[needed]}")
        self.name_columns(head, rows)
        if not options.columns:
            check_names(path, self.layout, before, rows[:400], self.names, self.width, self.advice)
        self.choice = Choice(
            path, rows, consecutive, self.layout, head, self.names, self.width, options.columns, needed, advice
        )
        self.indices, self.notes = self.choice.indices, self.choice.notes
        self.notes += notes_on_marks(path, rows, self.choice.of_numbers, self.indices)
        if needed == 3:
            self.notes += notes_on_units(self.layout, head, self.names, self.indices)
        begin = next((number for number, line in preamble if self.is_data(number, line)), self.first + 1)
        for number, line in reversed([(number, line) for number, line in preamble if number < begin]):
            if not self.lacks_all(line):
                break
            begin = number
        self.first, self.comments = begin - 1, sum(map(is_comment, lines[: begin - 1]))
        before = [line for number, line in preamble if number < begin]
        self.head_lines, self.headers = set(map(str.strip, before)), len(before) - len(self.bad_lines)

    def read_head(self, lines):
        """(lines before the data, [(number, line)] of those of them that are not comments). Sets first."""
        head, preamble = [], []
        for self.first, line in enumerate(lines):
            if is_comment(line):
                head.append(line.strip().lstrip("#%/!*> "))
            elif self.is_like(line) and not known_axes(self.layout.words(line)) >= set("xyz"):  # as x,y,z,0,1
                kind = self.title_kind(line, lines[:self.first], lines[self.first + 1 :])
                if not kind:
                    break
                self.titles[line.strip()] = kind
                preamble.append((self.first + 1, line))
            elif line.strip():
                head.append(line.strip())
                preamble.append((self.first + 1, line))
        return head, preamble

    def title_kind(self, line, above, below):
        """Whether a line of numbers is a title: "sure", "doubtful" or "". It is none below names of columns, unless it
        counts these; where ids go on from it; and where it closes a ring."""
        plain, words = line.strip(), self.layout.words(line)
        near = [other for other in below[:ROWS_BELOW] if self.is_like(other) and other.strip() != plain]
        above = next((other for other in reversed(above) if other.strip()), "")
        is_named = known_axes(self.layout.words(above)) >= {"x", "y"} and not is_comment(above)
        counts = words in [list(map(str, range(k, k + len(words)))) for k in (0, 1)]
        ids = [self.layout.number(self.layout.words(other)[0]) for other in (line, *near[:2])]
        goes_on = None not in ids and ids[0] % 1 == 0 and ids[1:] == [ids[0] + 1, ids[0] + 2]
        pairs = zip(below, [*below[1:], ""]) if self.needed == 2 else ()
        closes = any(one.strip() == plain and not other.strip("> ") for one, other in pairs)
        if closes or not counts and (is_named or goes_on):
            return ""
        kind = title_kind(self.layout, line, near, sum(map(bool, map(str.strip, below))))
        if not kind and near and title_kind(self.layout, near[0], near[3:], 0) == "sure":  # others may follow
            kind = title_kind(self.layout, line, near[3:], 0).replace("doubtful", "")
        return "sure" if kind and is_named else kind

    def sample(self, lines):
        """(rows as words, how many of them follow each other)."""
        start = self.first + SAMPLE
        step = max(1, (len(lines) - start) // SAMPLE)
        data, later = (
            [line for line in some if self.is_row(line) and (self.is_like(line) or not self.skips)]
            for some in (lines[self.first : start], lines[start::step])
        )
        return [self.layout.words(line) for line in data + later], len(data)

    def is_like(self, line):
        """Whether a line holds enough numbers for a row."""
        return self.layout.numbers(line) >= self.needed

    def bad_line(self, number, line, why, advice=""):
        """The error for a line that is not a row."""
        if touching := touching_in(line):
            why, advice = touching, ""
        elif self.can_skip and not (advice and self.is_like(line)):
            advice = f"{option('skip_bad_lines')} leaves out such lines"
        elif not self.can_skip and not advice:
            advice = "mark it with # if it is no row"
        return BadLine(f"{self.path}, line {number}: {why}" + (advice and "; " + advice))

    def few_words(self, number, line, count):
        """The error for a line with fewer words than others have."""
        why = f"{counted(count, 'column')} found where other lines have {self.words}"
        if not self.layout.separator:
            why += ", and blanks do not show which one lacks: part columns by commas, or write nan for what is missing"
        return self.bad_line(number, line, why)

    def no_number(self, number, line, words, axis):
        """The error for a line in which x, y or z is a word."""
        index = self.indices[axis]
        why = f"'{words[index][:40]}' in column {index + 1} ({'xyz'[axis]}) is not a number"
        return self.bad_line(number, line, why, self.advice)

    def kind(self, line):
        """What a line behind the header is: "row", or why it is none."""
        plain = line.strip()
        if not plain:
            return "blank"
        if plain in self.head_lines:
            return "repeated"
        if plain[0] in "0123456789.-":  # most lines: the rest takes longer
            return "row"
        if is_comment(plain):
            return "comment"
        return "summary" if self.summary(line) else "row"

    def is_row(self, line):
        return self.kind(line) == "row"

    def summary(self, line):
        """The word of a line that holds the total, mean or such of others; None for data."""
        match = known().patterns["summary"].match(line) if self.has_summaries else None
        return match and match.group(1)

    def name_columns(self, head, rows):
        """Sets words, width and names."""
        widths = collections.Counter(len(row) for row in rows)
        self.words = self.width = widths.most_common(1)[0][0]
        if not self.skips:
            self.words = self.width = max(len(rows[0]), self.width)
        # Where lines end with separators, nothing stands behind these.
        filled = max([self.needed, *(i + 1 for row in rows for i, word in enumerate(row[: self.width]) if word)])
        self.names = find_names(self.layout, head, self.width, filled == self.width)
        if not any((self.names or [])[filled:]):
            self.width = min(filled, self.width)
            self.names = find_names(self.layout, head, self.width)

    def lacks_all(self, line):
        """Whether a line is a row that has neither x, y and z nor words, as an empty row of a spreadsheet; dashes alone
        underline names."""
        words = self.layout.words(line)
        values = list(map(self.layout.number, words))
        if len(words) < self.width or None in values or set("".join(words)) == {"-"}:
            return False
        return all(math.isnan(values[i]) for i in self.indices)

    def is_data(self, number, line):
        """Whether a line before the data is a row that lacks one of its values. One that looks like a row
        but for a word, or but for its end, is no header, but a bad line."""
        words, error = self.layout.words(line), None
        values = [self.layout.number(word) for word in words]
        chosen = [values[i] for i in self.indices if i < len(words)]
        plain = line.strip()
        if self.titles.get(plain) == "sure":
            self.notes.append(f"line {number} is left out: {' '.join(words)[:40]} is a title, not a point")
            return False
        good = sum(v is not None and not math.isnan(v) for v in chosen)
        if plain in self.titles:
            why = f"{' '.join(words)[:40]} is unlike all rows below it, as a title is"
            why += "; if it is a point, write a line of names of the columns above it"
            error = self.bad_line(number, "", why)
        elif len(words) < self.width:
            no_words = None not in values or re.fullmatch(r"[-+\d.,;\seE]+", " ".join(words))
            error = self.few_words(number, line, len(words)) if len(words) > 1 and no_words else None
        elif None in chosen and good >= len(chosen) - 1:
            error = self.no_number(number, line, words, chosen.index(None))
        if error and not self.skips:
            raise error
        if error:
            self.bad_lines.append([number, plain])
        return not error and len(words) >= self.width and None not in chosen and good > 0


# ---- rows -------------------------------------------------------------------------------------


class Parser:
    """Turns blocks of lines into rows of numbers: those of the axes first, then the others.

    blocks   the Blocks of the file, or of a part of it
    alive    is called now and then where a block takes long
    named    whether all columns of text are wanted; else those with more than MOST_VALUES words are
             given up
    facts    what final_notes() reports about lines, as plain values that can be added to those of other parts
    """

    def __init__(self, table, blocks, alive, named=False):
        self.table, self.blocks, self.alive, self.named = table, blocks, alive, named
        self.texts = {index: WordReader() for index in table.choice.texts}
        self.used = [*table.indices, *table.choice.extras]
        self.comments = "".join(known().signs["comments"])
        heads = [re.escape(line.encode()) for line in table.head_lines if table.is_like(line)]
        self.head = re.compile(rb"(?:\A|\n)[ \t]*(?:" + b"|".join(heads) + rb")[ \t]*(?:\n|\Z)") if heads else None
        self.parts, self.line = [], 0
        self.breaks = [0]  # numbers of lines behind which another line or ring begins
        self.before = None  # lines before this part of the file, once a message needs their number
        first = table.bad_lines if blocks.begin == 0 else []
        self.facts = {
            "count": 0, "comment": 0, "repeated": 0, "uneven": 0,
            "ragged": [],  # [line number, number of words] of a line with more words than others
            "summary": [],  # [line number, word]
            "skipped": len(first), "skipped_lines": first[:NAMED],  # [line number, text]
            "no_numbers": {},  # {index of a column as text: [[count, first line number, word]]}
        }

    def add(self, block):
        """Takes the lines of a block."""
        if self.line == 0 and self.blocks.begin == 0:  # those before the data are known
            self.line = self.table.first
            block = block.split(b"\n", self.line)[-1]
        rows = self.plain_rows(block)
        if rows is not None:
            self.add_rows(rows, range(self.line + 1, self.line + 1 + len(rows)), len(rows))
            return
        lines = block_lines(block, self.table.encoding)
        for some in (lines[i : i + AT_ONCE] for i in range(0, len(lines), AT_ONCE)):
            self.alive(0.0)
            places = self.rows_among(some)
            rows = self.loaded([some[i] for i in places])
            if rows is None:
                rows, places = self.rows_one_by_one(some, places)
            if self.texts:
                self.keep_words([some[i] for i in places])
            self.add_rows(rows, self.line + 1 + numpy.array(places, "i8"), len(some))

    def add_rows(self, rows, numbers, count):
        """Adds the rows among so many lines, and the numbers of their lines."""
        if len(rows):
            self.parts.append((rows, numbers))
        self.facts["count"] += len(rows)
        self.line += count

    def plain_rows(self, block):
        """The rows of a block of nothing but rows of numbers, the usual case, many times as fast as others; None of
        another."""
        table, layout, rows = self.table, self.table.layout, vtkDoubleArray()
        if self.texts or table.sees_summaries or b'"' in block or not block.isascii():
            return None
        tail = block.rsplit(b"\n", TAIL + 1)[-TAIL - 1 :] if table.has_summaries else []
        if any(map(table.summary, map(bytes.decode, tail))) or self.head and self.head.search(block):
            return None
        is_plain = vtkTextRows.Parse(
            block.replace(b",", b".") if layout.decimal_comma else block, 0, layout.separator or "", table.words,
            in_vtk(numpy.array(self.used, dtype="i4")), self.comments, rows,
        )
        return vtk_to_numpy(rows) if is_plain and rows.GetNumberOfTuples() else None

    def rows_among(self, lines):
        """The places of the rows. Counts other lines, and keeps the breaks between rows."""
        rows = []
        for i, line in enumerate(lines):
            kind = self.table.kind(line)
            if kind == "row":
                rows.append(i)
            elif kind == "summary":
                self.facts["summary"].append([self.number(i), self.table.summary(line)])
            elif kind in ("comment", "repeated"):
                self.facts[kind] += 1
            if kind == "blank" or kind == "comment" and line.lstrip().startswith(">"):
                self.breaks.append(self.line + 1 + i)
        return rows

    def loaded(self, lines):
        """numpy's rows of lines; None where some have more or fewer words than others, or one that is no number."""
        layout, are_quoted = self.table.layout, any('"' in line for line in lines)
        bare = [re.sub('"[^"]*"', "q", line) for line in lines] if are_quoted else lines
        counts = {len(line.split(layout.separator)) for line in bare}
        if counts != {self.table.words} or layout.decimal_comma and are_quoted:
            return None
        if layout.decimal_comma:
            lines = [line.replace(",", ".") for line in lines]
        quotes = {"quotechar": '"'} if are_quoted else {}
        try:
            rows = numpy.loadtxt(lines, delimiter=layout.separator, usecols=self.used, comments=None, ndmin=2, **quotes)
        except ValueError:
            return None
        return rows if len(rows) == len(lines) else None  # a quote that is not closed takes the next line in

    def rows_one_by_one(self, lines, places):
        """(the rows at some places, the places without those that are skipped)."""
        rows, kept = [], []
        for i in places:
            try:
                rows.append(self.row(lines[i], i))
                kept.append(i)
            except BadLine:
                if not self.table.skips:
                    raise
                self.facts["skipped"] += 1
                self.facts["uneven"] += self.table.is_like(lines[i])
                if len(self.facts["skipped_lines"]) < NAMED:
                    self.facts["skipped_lines"].append([self.number(i), lines[i].strip()])
        return numpy.array(rows), kept

    def row(self, line, i):
        """The numbers of a line, its place among some being i. Raises BadLine."""
        table, layout, facts = self.table, self.table.layout, self.facts
        words = layout.words(line)
        row = [layout.number(words[index]) if index < len(words) else math.nan for index in self.used]
        if len(words) > table.words:
            facts["ragged"] = facts["ragged"] or [[self.number(i), len(words)]]
            facts["uneven"] += layout.numbers(line) == len(words)
        axes = row[: table.needed]
        if None in axes:
            raise table.no_number(self.number(i), line, words, axes.index(None))
        if len(words) < table.words and not self.has_all(words):
            raise table.few_words(self.number(i), line, len(words))
        for index, value in zip(self.used, row):
            if value is None:
                found = facts["no_numbers"].setdefault(str(index), [[0, self.number(i), words[index]]])
                found[0][0] += 1
        return [math.nan if value is None else value for value in row]

    def has_all(self, words):
        """Whether x, y and z are there, and between blanks all numbers, so that only text behind them may lack."""
        table = self.table
        needed = table.indices if table.layout.separator else {*table.indices, *table.choice.of_numbers}
        return all(i < len(words) and table.layout.number(words[i]) is not None for i in needed)

    def number(self, i):
        """The number in the file of line i of those that are parsed."""
        if self.before is None:
            self.before = self.blocks.lines_before()
        return self.before + self.line + 1 + i

    def keep_words(self, lines):
        """Keeps the words of the columns of text; "" in lines that end before them."""
        rows = list(map(self.table.layout.words, lines))
        for index, reader in list(self.texts.items()):
            reader.add([row[index] if index < len(row) else "" for row in rows])
            if len(reader.codes) > MOST_VALUES and not self.named:
                del self.texts[index]

    def take_words(self):
        """{name: Words} since the last call."""
        return {self.table.choice.texts[index]: reader.take() for index, reader in self.texts.items()}

    def take(self):
        """(rows, line numbers) since the last call. There must be some. The numbers are an array or a range."""
        rows, numbers = zip(*self.parts)
        rows, self.parts = numpy.concatenate(rows), []
        are_ranges = all(isinstance(some, range) for some in numbers)
        if are_ranges and all(one.stop == other.start for one, other in zip(numbers, numbers[1:])):
            return rows, range(numbers[0].start, numbers[-1].stop)
        return rows, numpy.concatenate(numbers)

    def final_notes(self):
        """Notes, once all lines are read. Raises FileError where many rows have other numbers of columns."""
        table, facts = self.table, self.facts
        if facts["uneven"] > MOST_UNEVEN[table.skips] * facts["count"]:
            raise FileError(
                f"{table.path}: {facts['uneven']:,} lines of numbers have other columns than {facts['count']:,} rows: "
                "blanks do not part the columns of this table; export it as .csv"
            )
        notes, seen = table.notes, [f"separated by {table.layout}"]
        counts = {"header line": table.headers, "comment line": facts["comment"] + table.comments}
        seen += [counted(count, what) for what, count in counts.items() if count]
        if not any(" as x" in note or ", y = " in note for note in notes):
            columns = ", ".join(str(index + 1) for index in table.indices)
            notes.insert(0, f"{', '.join('xyz'[:table.needed])} are in columns {columns}")
        notes.insert(0, "text: " + ", ".join(seen))
        if facts["repeated"]:
            notes.append(f"header lines that come again are left out: {facts['repeated']:,}")
        for line, words in facts["ragged"][:1]:
            notes.append(
                f"line {line:,} has {words} columns where others have {table.words}: they are counted from "
                "the left"
            )
        for what, lines, count, most in (
            ("summary lines", facts["summary"], len(facts["summary"]), MOST_SUMMARIES),
            ("lines of other kinds", facts["skipped_lines"], facts["skipped"], NAMED),
        ):
            words = ", ".join(f"line {line:,} ({text[:20]})" for line, text in lines[:most])
            more = f" and {count - most:,} more" if count > most else ""
            notes += [f"{what} are left out: {words}{more}"] * bool(count)
        for index, found in facts["no_numbers"].items():
            count, (_, line, word) = sum(count for count, *_ in found), found[0]
            words = counted(count, "word is not a number", "words are not numbers")
            where = f"line {line:,}" if count == 1 else f"first in line {line:,}"
            notes.append(f"column {table.choice.extras[int(index)]}: {words} ({where}: {word[:40]})")
        return notes


def parsed(path, options, needed=3, advice=None, part=WHOLE):
    """Yields the Parser of a text file, or of a part of it, before and after each block of lines."""
    done = 0.0
    with open(path, "rb") as stream:
        head = next(iter(Blocks(path, stream)), None)
        if head is None:
            raise FileError(f"{path}: is empty")
        table = Table(path, head[0], options, needed, advice)
        is_named = bool(options.where or options.layer)
        parser = Parser(table, Blocks(path, stream, part), lambda _: options.progress(done), is_named)
        yield parser
        for block, read in parser.blocks:
            parser.add(block)
            done = read
            options.progress(done)
            yield parser


def parse(*arguments):
    """(parser, rows, line numbers, notes) of a text file; arguments as of parsed()."""
    for parser in parsed(*arguments):
        pass
    if not parser.parts:
        raise FileError(f"{parser.table.path}: {NO_ROWS[parser.table.needed]}")
    return (parser, *parser.take(), parser.final_notes())


def read_table(path, needed=3, progress=no_progress):
    """Rows of numbers of a text file.

    Returns (rows, line numbers, starts, notes): rows is an array of n * needed doubles, a start is
    the index of a row that follows a blank line or one that begins with ">".
    """
    advice = f"a header line with {', '.join(('easting', 'northing', 'elevation')[:needed])} names the columns"
    parser, rows, numbers, notes = parse(path, ReadOptions(progress=progress), needed, advice)
    starts = numpy.unique(numpy.searchsorted(numbers, parser.breaks))
    return rows[:, :needed].copy(), numbers, starts[starts < len(rows)].tolist(), notes


def read_line_table(path, progress):
    """As read_table() of x, y and z, or of x and y where there are no more columns of numbers."""
    try:
        return read_table(path, 3, progress)
    except FileError as error:
        try:
            table = parse(path, ReadOptions(progress=progress), 2, "")[0].table
            if len(table.choice.of_numbers) == 2:
                return read_table(path, 2, progress)
        except FileError as other:
            if isinstance(other, BadLine) and not isinstance(error, BadLine):
                raise
        raise error


def read_text(path, options):
    """The points of a text file; numbers in other columns become point arrays, text becomes Words.

    Returns a Cloud. Ten million lines of x, y and z take some two seconds of two cores and 0.7 GB.
    """
    parser, rows, numbers, notes = parse(path, options)
    choice = parser.table.choice
    cloud = Cloud(make_points(rows[:, :3], copy=False), notes, lines=numbers)
    add_arrays(cloud.points, choice.extras, rows[:, 3:])
    cloud.z_name, cloud.is_horizon, cloud.angles = choice.z_name, choice.is_horizon, choice.angles
    cloud.words = parser.take_words()
    if options.no_data is not None:
        leave_out(path, cloud, options.no_data, noun="row", none_left=WITHOUT_DATA)
    return cloud


class TextSlices:
    """The rows of a part of a text file: iterate to get (x y z, the other columns), block by block."""

    noun, without_data = "row", WITHOUT_DATA

    def __init__(self, path, options, part):
        self.parsed = parsed(path, options, part=part)
        self.parser = next(self.parsed)

    def __iter__(self):
        parser = self.parser
        for _ in self.parsed:
            if parser.parts:
                rows, words = parser.take()[0], parser.take_words()
                yield rows[:, :3], {**words, **dict(zip(parser.table.choice.extras.values(), rows[:, 3:].T))}

    def facts(self):
        return self.parser.facts

    def finish(self, facts, cloud):
        """Takes the facts about the whole file, and adds to a Cloud what is reported then."""
        self.parser.facts, choice = facts, self.parser.table.choice
        cloud.notes += self.parser.final_notes()
        cloud.z_name, cloud.is_horizon = choice.z_name, choice.is_horizon
        if choice.angles != "no":
            cloud.notes.append(note_on_degrees(choice.angles))
        if choice.extras:
            cloud.notes.append(f"left out: {', '.join(choice.extras.values())}")


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
