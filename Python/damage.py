# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Finds out whether a .ply, .stl, .vtk or XML file of VTK's holds what its header announces.

VTK's readers of these formats trust the header: a file that was cut off, or one that announces too
much, ends the program or gives points of zero. So the announced counts are compared with what is
there before a reader sees the file. Reading twice costs less than a second for a million points,
some seconds for as many lines of text.
"""

import math
import os
import re
import struct

import numpy

CUT = "is cut off or damaged"


class Damage(Exception):
    """What is wrong, in words that follow the file's name."""


def why_damaged(path, kind):
    """What is wrong with the file, as words to follow its name, or None.

    Files of other kinds than those above are not looked at. Raises OSError.
    """
    check = {
        ".ply": check_ply,
        ".stl": check_stl,
        ".vtk": check_legacy_vtk,
        ".vtp": check_xml,
        ".vtu": check_xml,
        ".vti": check_xml_grid,
        ".vtr": check_xml_grid,
        ".vts": check_xml_grid,
    }.get(kind)
    if check is None:
        return None
    with open(path, "rb") as stream:
        data = stream.read()
    try:
        check(data)
    except Damage as damage:
        return str(damage)
    return None


def count_of(word, what):
    if not word.isdigit():
        raise Damage(f"{CUT}: '{word.decode('latin-1')[:40]}' is no count of {what}")
    return int(word)


# ---- .vtp, .vtu, .vti, .vtr, .vts -------------------------------------------------------------

# Equal numbers can be packed to some thousandth of their size.
PACKED = 10000


def check_xml(data):
    """VTK's XML readers notice nearly all by themselves, but not a count beyond all memory."""
    counts = re.compile(rb'\bNumberOf(Points|Verts|Lines|Polys|Cells)="(\d+)"')
    for what, count in counts.findall(data[:65536]):
        if int(count) > PACKED * len(data):
            raise Damage(f"is damaged: it cannot hold {int(count):,} {what.decode().lower()}")


def extent_of(text):
    """The six numbers of an extent, first and last along x, y and z."""
    words = text.split()
    try:
        numbers = [int(word) for word in words]
    except ValueError:
        numbers = []
    if len(numbers) != 6 or any(a > b for a, b in zip(numbers[::2], numbers[1::2])):
        raise Damage(f"is damaged: '{text.decode('latin-1')[:60]}' is no extent of a grid")
    return numbers


def check_xml_grid(data):
    """VTK's readers of grids leave nodes as they are in memory that no piece of the file covers."""
    header = data[: data.find(b"<AppendedData") if b"<AppendedData" in data else len(data)]
    whole = re.search(rb"""\bWholeExtent\s*=\s*["']([^"']*)["']""", header)
    if whole is None:
        return
    whole = extent_of(whole.group(1))
    nodes = math.prod(b - a + 1 for a, b in zip(whole[::2], whole[1::2]))
    if nodes > PACKED * len(data):
        raise Damage(f"is damaged: it cannot hold {nodes:,} nodes")

    def cells(extent):
        return math.prod(max(b - a, 1) for a, b in zip(extent[::2], extent[1::2]))

    covered = 0
    for text in re.findall(rb"""<Piece\b[^>]*\bExtent\s*=\s*["']([^"']*)["']""", header):
        piece = extent_of(text)
        for i in range(0, 6, 2):
            if piece[i] < whole[i] or piece[i + 1] > whole[i + 1]:
                raise Damage(
                    f"is damaged: a piece of extent {' '.join(map(str, piece))} "
                    f"is not within the whole extent {' '.join(map(str, whole))}"
                )
        covered += cells(piece)
    if covered < cells(whole):
        raise Damage(
            f"{CUT}: its whole extent {' '.join(map(str, whole))} has {cells(whole):,} cells, "
            f"its pieces only {covered:,}"
        )


# ---- .ply -------------------------------------------------------------------------------------

PLY_TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "float32": "f4",
    "float64": "f8",
}
PLY_FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
# The longest line that vtkPLYReader takes as one.
PLY_LINE = 4095


class PlyElement:
    """One "element" of a header.

    properties  [(name, type of the value, None or for a list the type of its count)]
    """

    def __init__(self, name, count):
        self.name = name
        self.count = count
        self.properties = []

    def has_list(self):
        return any(count for _, _, count in self.properties)


def ply_header(data):
    """(byte order or "" for text, elements, start of the body)."""
    if data[:3] != b"ply" or data[3:4] not in (b"\n", b"\r"):
        raise Damage("is not a PLY file")
    order, elements, position = None, [], 0
    while True:
        end = data.find(b"\n", position, position + 4096)
        if end < 0:
            raise Damage(f"{CUT}: its header has no end")
        line = data[position:end]
        position = end + 1
        words = line.split()
        kind = words[0] if words else b""
        if kind in (b"ply", b"comment", b"obj_info"):
            continue
        text = [word.decode("latin-1") for word in words]
        if kind == b"format" and len(words) == 3 and text[1] in PLY_FORMATS:
            order = PLY_FORMATS[text[1]]
        elif kind == b"element" and len(words) == 3:
            elements.append(PlyElement(text[1], count_of(words[2], text[1])))
        elif kind == b"property" and elements and len(words) == 3 and text[1] in PLY_TYPES:
            elements[-1].properties.append((text[2], PLY_TYPES[text[1]], None))
        elif (
            kind == b"property"
            and elements
            and len(words) == 5
            and text[1] == "list"
            and text[2] in PLY_TYPES
            and text[3] in PLY_TYPES
        ):
            elements[-1].properties.append((text[4], PLY_TYPES[text[3]], PLY_TYPES[text[2]]))
        elif kind == b"end_header":
            break
        else:
            shown = line.decode("latin-1").strip()[:40]
            raise Damage(f"is damaged: its header holds the line '{shown}'")
    if order is None:
        raise Damage("is damaged: its header names no format")
    scalars = {p[0] for e in elements if e.name == "vertex" for p in e.properties if not p[2]}
    if not {"x", "y", "z"} <= scalars:
        raise Damage("holds no vertices with x, y and z")
    for element in elements:
        lists = {name for name, _, count in element.properties if count}
        if element.name == "face" and not lists & {"vertex_indices", "vertex_index"}:
            raise Damage("is damaged: its faces have no list named vertex_indices")
        if not element.properties:
            raise Damage(f"is damaged: its {element.name} has no property")
    return order, elements, position


def check_ply(data):
    order, elements, position = ply_header(data)
    if order == "":
        check_ply_text(data, elements, position)
        return
    for element in elements:
        position = ply_binary_end(data, element, order, position)
        if position > len(data):
            missing = position - len(data)
            raise Damage(
                f"{CUT}: {element.count:,} of {element.name} are announced, "
                f"but at least {missing:,} bytes are missing"
            )


def check_ply_text(data, elements, position):
    lines = data[position:].split(b"\n")
    if lines[-1].strip() == b"":
        lines.pop()
    number = data.count(b"\n", 0, position)
    first = 0
    for element in elements:
        if first + element.count > len(lines):
            raise Damage(
                f"{CUT}: {element.count:,} of {element.name} are announced, "
                f"{max(len(lines) - first, 0):,} found"
            )
        simple = not element.has_list()
        for i in range(first, first + element.count):
            words = lines[i].split()
            needed = len(element.properties) if simple else ply_words(element, words)
            try:
                if len(words) < needed:
                    raise ValueError
                if simple:
                    for word in words:
                        float(word)
            except ValueError:
                raise Damage(
                    f"{CUT}: line {number + i + 1} is no {element.name} of {needed} numbers"
                ) from None
            if len(lines[i]) > PLY_LINE:
                raise Damage(f"has more than {PLY_LINE:,} characters in line {number + i + 1}")
        first += element.count
    if first == len(lines) and not data.endswith(b"\n"):
        # Also what follows the last number could be missing; and vtkPLYReader would crash.
        raise Damage("is cut off: its last line has no end")


def ply_words(element, words):
    """How many words a line needs; one more than there are when it ends too early."""
    place = 0
    for _, _, count in element.properties:
        if count:
            if place >= len(words) or not words[place].isdigit():
                return len(words) + 1
            place += int(words[place])
        place += 1
    return place


def ply_binary_end(data, element, order, position):
    """Where the element's rows end; beyond the data when they are not all there."""
    sizes = [int(kind[1]) for _, kind, _ in element.properties]
    if not element.has_list():
        return position + element.count * sum(sizes)
    counts = [count and numpy.dtype(order + count) for _, _, count in element.properties]

    def row_end(start):
        """The end of one row, and the (offset, type, value) of its counts."""
        seen = []
        at = start
        for size, count in zip(sizes, counts):
            if count is None:
                at += size
                continue
            if at + count.itemsize > len(data):
                return len(data) + 1, seen
            value = int(numpy.frombuffer(data, count, 1, at)[0])
            if value < 0:
                raise Damage(f"is damaged: a {element.name} has a list of {value} values")
            seen.append((at - start, count, value))
            at += count.itemsize + size * value
        return at, seen

    done = 0
    while done < element.count and position <= len(data):
        end, seen = row_end(position)
        # Most meshes have rows of one length: these are compared all at once.
        length, same = end - position, 1
        rows = min(element.count - done, (len(data) - position) // length)
        if rows > 1:
            equal = numpy.ones(rows, dtype=bool)
            for offset, count, value in seen:
                equal &= (
                    numpy.ndarray((rows,), count, data, position + offset, (length,)) == value
                )
            same = rows if equal.all() else int(numpy.argmin(equal))
            # Rows of many lengths: looking at all that follow, for each of them, would be slow.
            if same < 64:
                for _ in range(min(10000, element.count - done)):
                    position, _ = row_end(position)
                    done += 1
                    if position > len(data):
                        break
                continue
        position += max(same, 1) * length
        done += max(same, 1)
    return position


# ---- .stl -------------------------------------------------------------------------------------


def check_stl(data):
    if len(data) >= 84:
        facets = struct.unpack("<I", data[80:84])[0]
        if len(data) == 84 + 50 * facets:
            if facets == 0:
                raise Damage("holds no facets")
            return
    if data.lstrip()[:5].lower() != b"solid" or b"\0" in data:
        if len(data) < 84:
            raise Damage("is cut off, or not an STL file")
        raise Damage(
            f"is cut off, or not an STL file: {facets:,} facets are announced, "
            f"which take {84 + 50 * facets:,} bytes, not {len(data):,}"
        )
    words = data.lower().split()
    counts = {name: words.count(name) for name in (b"facet", b"vertex", b"endloop", b"endfacet")}
    if counts[b"facet"] == 0:
        raise Damage("holds no facets")
    if words.count(b"endsolid") == 0:
        raise Damage(f"{CUT}: its last line, endsolid, is missing")
    facets = counts[b"facet"]
    if counts[b"vertex"] != 3 * facets or counts[b"endfacet"] != facets:
        raise Damage(f"is damaged: {facets:,} facets have {counts[b'vertex']:,} corners")
    for i, word in enumerate(words):
        if word == b"vertex":
            try:
                if not numpy.isfinite([float(value) for value in words[i + 1 : i + 4]]).all():
                    raise ValueError
            except ValueError:
                shown = b" ".join(words[i : i + 4]).decode("latin-1")[:60]
                raise Damage(f"is damaged: '{shown}' is no corner of a facet") from None


# ---- legacy .vtk ------------------------------------------------------------------------------

VTK_TYPES = {
    b"char": 1,
    b"signed_char": 1,
    b"unsigned_char": 1,
    b"short": 2,
    b"unsigned_short": 2,
    b"int": 4,
    b"unsigned_int": 4,
    b"long": 8,
    b"unsigned_long": 8,
    b"vtkidtype": 4,
    b"vtktypeint64": 8,
    b"vtktypeuint64": 8,
    b"float": 4,
    b"double": 8,
}
CELLS = (b"vertices", b"lines", b"polygons", b"triangle_strips", b"cells")
ONE_LINE = (b"dataset", b"dimensions", b"origin", b"spacing", b"aspect_ratio", b"extent")
ATTRIBUTES = {b"vectors": 3, b"normals": 3, b"tensors": 9, b"tensors6": 6}
IDS = (b"global_ids", b"pedigree_ids", b"edge_flags")


def may_lack_digits(path):
    """Whether a text .vtk file ends with its last number, which a cut may have shortened."""
    with open(path, "rb") as stream:
        is_text = b"ascii" in b"".join(stream.readline(300).lower() for _ in range(3)).split()
        stream.seek(-1, os.SEEK_END)
        return is_text and not stream.read().isspace()


class LegacyFile:
    """Walks through a legacy file, header line by header line."""

    def __init__(self, data):
        head = data.split(b"\n", 3)
        if len(head) < 4 or not head[0].lower().startswith(b"# vtk datafile version"):
            raise Damage("is cut off, or not a VTK file")
        self.is_text = head[2].strip().lower() == b"ascii"
        if not self.is_text and head[2].strip().lower() != b"binary":
            raise Damage("is damaged: its third line is neither ASCII nor BINARY")
        version = head[0].split()[-1]
        self.offsets = version[:1].isdigit() and int(version.split(b".")[0]) >= 5
        self.data = head[3]
        self.at = 0
        self.line_words = []

    def line(self):
        """The words of the next line that is not blank, the first in small letters, or None."""
        while self.at < len(self.data):
            end = self.data.find(b"\n", self.at)
            end = len(self.data) if end < 0 else end
            words = self.data[self.at : end].split()
            self.at = end + 1
            if words:
                return [words[0].lower()] + words[1:]
        return None

    def skip_metadata(self):
        """Lines up to a blank one."""
        while self.at < len(self.data):
            end = self.data.find(b"\n", self.at)
            end = len(self.data) if end < 0 else end
            blank = not self.data[self.at : end].strip()
            self.at = end + 1
            if blank:
                return

    def values(self, what, count, size):
        """Steps over numbers."""
        if not self.is_text:
            if count * size > len(self.data) - self.at:
                found = max(len(self.data) - self.at, 0) // size
                raise Damage(f"{CUT}: {count:,} numbers of {what} are announced, {found:,} found")
            self.at += count * size
            return
        # A number takes two places at least: what is announced beyond that is not even looked for.
        found, at = 0, self.at
        if 2 * count <= len(self.data) - at + 1:
            while found < count and at < len(self.data):
                # By pieces, so that the rest of the file is not split again for each array.
                end = at + 4 * (count - found) + 64
                while end < len(self.data) and not self.data[end : end + 1].isspace():
                    end += 1
                words = self.data[at:end].split(None, count - found)
                rest = words.pop() if len(words) > count - found else b""
                try:
                    numpy.array(words, dtype="S").astype("f8")
                except ValueError:
                    raise Damage(
                        f"{CUT}: less than the {count:,} numbers of {what} that are announced"
                    ) from None
                found += len(words)
                at = min(end, len(self.data)) - len(rest)
            self.at = at
            if found == count:
                return
        raise Damage(f"{CUT}: less than the {count:,} numbers of {what} that are announced")

    def array(self, what, count, kind):
        """Steps over an array; False when its size cannot be told."""
        size = VTK_TYPES.get(kind.lower())
        if size is None and not (self.is_text and kind.lower() == b"bit"):
            return False
        self.values(what, count, size)
        return True


def check_legacy_vtk(data):
    """Stops without a word at what it does not know: then VTK's own messages must do."""
    file = LegacyFile(data)
    tuples = 0
    try:
        while (words := file.line()) is not None:
            key, what = words[0], words[0].decode("latin-1").upper()
            if key == b"points":
                known = file.array(what, 3 * count_of(words[1], what), words[2])
            elif key in CELLS:
                known = walk_cells(file, words, what)
            elif key == b"cell_types":
                file.values(what, count_of(words[1], what), 4)
                known = True
            elif key in (b"x_coordinates", b"y_coordinates", b"z_coordinates"):
                known = file.array(what, count_of(words[1], what), words[2])
            elif key in (b"point_data", b"cell_data"):
                tuples = count_of(words[1], what)
                known = True
            elif key == b"scalars":
                known = walk_scalars(file, words, tuples)
            elif key in ATTRIBUTES:
                known = file.array(what, ATTRIBUTES[key] * tuples, words[2])
            elif key in IDS:
                known = file.array(what, tuples, words[2])
            elif key == b"texture_coordinates":
                known = file.array(what, count_of(words[2], what) * tuples, words[3])
            elif key == b"color_scalars":
                file.values(what, count_of(words[2], what) * tuples, 1)
                known = True
            elif key == b"lookup_table":
                file.values(what, 4 * count_of(words[2], what), 1)
                known = True
            elif key == b"field":
                known = walk_field(file, count_of(words[2], what))
            elif key == b"metadata":
                file.skip_metadata()
                known = True
            else:
                known = key in ONE_LINE
            if not known:
                return
    except IndexError:
        raise Damage(f"{CUT}: the line that begins with {what} is too short") from None


def walk_cells(file, words, what):
    first, second = count_of(words[1], what), count_of(words[2], what)
    if not file.offsets:
        if first > second:
            raise Damage(f"is damaged: {first:,} {what} cannot take {second:,} numbers")
        file.values(what, second, 4)
        return True
    for name, count in ((b"offsets", first), (b"connectivity", second)):
        words = file.line()
        if words is None or words[0] != name:
            raise Damage(f"{CUT}: {what} lack their {name.decode().upper()}")
        if not file.array(what, count, words[1]):
            return False
    return True


def walk_scalars(file, words, tuples):
    components = count_of(words[3], "components") if len(words) > 3 else 1
    kind = words[2]
    table = file.line()
    if table is None or table[0] != b"lookup_table":
        raise Damage(f"{CUT}: SCALARS lack their LOOKUP_TABLE")
    return file.array("SCALARS", components * tuples, kind)


def walk_field(file, arrays):
    while arrays:
        words = file.line()
        if words is None:
            raise Damage(f"{CUT}: {arrays} more arrays are announced in FIELD")
        if words[0] == b"metadata":
            file.skip_metadata()
            continue
        if words[0] == b"null_array":
            arrays -= 1
            continue
        name = words[0].decode("latin-1")
        count = count_of(words[1], name) * count_of(words[2], name)
        if not file.array(name, count, words[3]):
            return False
        arrays -= 1
    return True
