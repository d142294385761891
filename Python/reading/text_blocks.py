# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The lines of a text file, in blocks that memory holds: bytes, encodings and ends of lines."""

import codecs
import io
import os
import re

from .column_names import known_names
from .tables import known
from ..clouds import WHOLE, Part
from ..messages import FileError

END_MARKS = b"\0\x1a\r\n "  # what DOS and full disks write behind the last line
MARKS = {  # of encodings with two or four bytes a letter, the longer ones first
    codecs.BOM_UTF32_LE: "utf-32", codecs.BOM_UTF32_BE: "utf-32",
    codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16",
}
BLOCK = 8 << 20  # bytes; larger blocks cost time, as their memory is fetched afresh each time


class Blocks:
    """The whole lines of a text file as bytes, some 8 MB at once: iterate to get (block, fraction).

    UTF-16 and UTF-32 become UTF-8; the mark of UTF-8 is taken away. A part of a file has the lines that
    begin in some of the blocks of the whole file.

    begin  where the first line begins
    """

    def __init__(self, path, stream, part=WHOLE):
        self.path, self.file, self.stream = path, stream, stream
        self.size = os.fstat(stream.fileno()).st_size
        head = self.read(0, 4096)
        if encoding := wide_encoding(head):
            self.take(self.read(0, self.size).decode(encoding, "replace").encode())
        elif b"\0" in (head.rstrip(END_MARKS) or head):
            raise FileError(f"{path}: is not a text file; save a table as .csv, in UTF-8")
        elif b"\r" in head and b"\n" not in head:  # of old Macintoshes
            self.take(plain(self.read(0, self.size)))
        self.count = max(1, -(-self.size // BLOCK))
        self.blocks = part.rows(self.count)
        self.begin, self.end = (self.line_begin(at * BLOCK) for at in (self.blocks.start, self.blocks.stop))

    def take(self, data):
        self.stream, self.size = io.BytesIO(data), len(data)

    def __iter__(self):
        at = self.begin
        while at < self.end:
            data = self.read(at, min(BLOCK, self.end - at))
            block = plain(data.removeprefix(b"\xef\xbb\xbf" if at == 0 else b""))
            at += len(data)
            if block:
                yield block, (at - self.begin) / (self.end - self.begin)

    def read(self, at, count):
        """So many bytes, and the rest of the line in which they end."""
        try:
            self.stream.seek(at)
            data = self.stream.read(count)
            return data if data.endswith(b"\n") else data + self.stream.readline()
        except OSError as error:
            raise FileError(f"{self.path}: cannot be read: {error.strerror}") from None

    def line_begin(self, at):
        """Where the first line begins that does so at a place or behind it."""
        at = min(at, self.size)
        return at and at - 1 + len(self.read(at - 1, 1))

    def lines_before(self):
        """How many lines there are before this part."""
        before = Blocks(self.path, self.file, Part(0, self.blocks.start, self.count))
        return sum(block.count(b"\n") for block, _ in before)


def wide_encoding(head):
    """The encoding of text with two or four bytes a letter: by its mark, or where all of its letters are such and
    most are of ASCII, so that every second byte is zero. Else ""."""
    for mark, encoding in MARKS.items():
        if head.startswith(mark):
            return encoding
    for encoding in ("utf-32-le", "utf-32-be", "utf-16-le", "utf-16-be") if b"\0" in head else ():
        try:
            text = head[: len(head) & ~3].decode(encoding).rstrip("\0\x1a")
        except UnicodeDecodeError:
            continue
        are_letters = all(letter.isprintable() or letter.isspace() for letter in text)
        if are_letters and 2 * sum(map(str.isascii, text)) > len(text):
            return encoding
    return ""


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

    def meant(encoding):
        return known_names(re.split(r"[\s,;|]+", head.decode(encoding, "replace")))

    return max(known().signs["encodings"], key=meant)


def block_lines(block, encoding):
    """The lines of a block: UTF-8, or another encoding where it is not."""
    try:
        text = block.decode("utf-8")
    except UnicodeDecodeError:
        text = block.decode(encoding, "replace")
    return text.removesuffix("\n").split("\n")
