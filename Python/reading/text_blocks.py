# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The lines of a text file, in blocks that memory holds: bytes, encodings and ends of lines."""

import io
import os
import re

from .column_names import known_names
from .tables import known
from ..clouds import WHOLE, Part
from ..messages import FileError

END_MARKS = b"\0\x1a\r\n "  # what DOS and full disks write behind the last line
LINE_END = re.compile(rb"\r?\n|\r(?=[^\n])")
BLOCK = 8 << 20  # bytes; larger blocks cost time, as their memory is fetched afresh each time


class Blocks:
    """The whole lines of a text file as bytes, some 8 MB at once: iterate to get (block, fraction).

    UTF-16 with its mark becomes UTF-8; the mark of UTF-8 is taken away. A part of a file has some of
    the blocks of the whole file: a line is in the block in which it begins.

    begin  where the first line begins
    """

    def __init__(self, path, stream, part=WHOLE):
        self.path, self.file, self.stream = path, stream, stream
        self.size = os.fstat(stream.fileno()).st_size
        head = self.read(0, 4096)
        if head[:2] in (b"\xff\xfe", b"\xfe\xff"):
            text = self.read(0, self.size).decode("utf-16", "replace")
            self.stream = io.BytesIO(text.encode())
            self.size = len(self.stream.getbuffer())
        elif b"\0" in (head.rstrip(END_MARKS) or head):
            raise FileError(f"{path}: is not a text file")
        self.count = max(1, -(-self.size // BLOCK))
        self.blocks = part.rows(self.count)
        self.begin = self.line_begin(self.blocks.start * BLOCK)

    def __iter__(self):
        first, last, begin = self.blocks.start, self.blocks.stop, self.begin
        for number in range(first + 1, last + 1):
            end = begin if begin >= number * BLOCK else self.line_begin(number * BLOCK)
            data = plain(self.read(begin, end - begin).removeprefix(b"\xef\xbb\xbf" if begin == 0 else b""))
            if data:
                yield data, (number - first) / (last - first)
            begin = end

    def read(self, at, count):
        try:
            self.stream.seek(at)
            return self.stream.read(count)
        except OSError as error:
            raise FileError(f"{self.path}: cannot be read: {error.strerror}") from None

    def line_begin(self, at):
        """Where the first line begins that does so at a place or behind it."""
        place = at - 1
        while at and (data := self.read(place, 4096)):
            found = LINE_END.search(data)
            if found:
                return place + found.end()
            place += max(len(data) - 1, 1)
        return self.size if at else 0

    def lines_before(self):
        """How many lines there are before this part."""
        before = Blocks(self.path, self.file, Part(0, self.blocks.start, self.count))
        return sum(block.count(b"\n") for block, _ in before)


def plain(data):
    """Bytes with \\n at the end of lines, the usual sign for minus, and no marks of the end."""
    end = data.rstrip(END_MARKS)
    if b"\x1a" in data[len(end) :] or b"\0" in data[len(end) :]:
        data = end and end + b"\n"
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return data.replace(b"\xe2\x88\x92", b"-")


def encoding_of(block):
    """The encoding in which most words of a header mean something, of text that is not UTF-8."""
    head = b" ".join(line for line in block.split(b"\n", 20)[:20] if not re.search(rb"\d[.,]\d", line))
    encodings = known().signs["encodings"]
    if head.isascii():
        return encodings[0]  # it reads the same in all of them
    texts = {encoding: head.decode(encoding, "replace") for encoding in encodings}
    return max(texts, key=lambda encoding: known_names(re.split(r"[\s,;|]+", texts[encoding])))


def block_lines(block, encoding):
    """The lines of a block: UTF-8, or another encoding where it is not."""
    try:
        text = block.decode("utf-8")
    except UnicodeDecodeError:
        text = block.decode(encoding, "replace")
    lines = text.split("\n")
    if not lines[-1]:
        lines.pop()
    return lines
