# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes .vtp and .vtu: VTK's XML with binary data inline.

VTK's own writer makes appended data, which ParaView 5.11 does not read where libexpat defers parsing
(since 2.6, and in Debian 12), or inline data, and then it crashes on a full disk, or holds three
copies of the file in memory. This one holds a few megabytes, and a full disk is an OSError.
"""

import binascii
import zlib
from concurrent.futures import ThreadPoolExecutor

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import (
    VTK_ID_TYPE,
    vtkBitArray,
    vtkDataArray,
    vtkStringArray,
    vtkUnsignedCharArray,
)

BLOCK = 1 << 18  # bytes compressed at a time
AT_ONCE = 64  # blocks that become text at a time
# Larger arrays whose first block does not shrink to half are stored: that is some 20 times faster.
ALWAYS_COMPRESSED = 1 << 25
TRIANGLE = 5  # VTK_TRIANGLE

MARKS = {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": "&#10;", "\r": "&#13;", "\t": "&#9;"}

HEAD = """<?xml version="1.0"?>
<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64" \
compressor="vtkZLibDataCompressor">
<{kind}>
"""


def write_vtp(data, path, progress=None):
    """Writes the lines and polygons of vtkPolyData with all arrays. Raises OSError."""
    with Writer(path, data, progress) as write:
        write(HEAD.format(kind="PolyData"))
        write.fields(data)
        write(
            f'<Piece NumberOfPoints="{data.GetNumberOfPoints()}" NumberOfVerts="0" NumberOfStrips="0" '
            f'NumberOfLines="{data.GetNumberOfLines()}" NumberOfPolys="{data.GetNumberOfPolys()}">\n'
        )
        write.points_and_arrays(data)
        write.group("Lines", cell_arrays(data.GetLines()))
        write.group("Polys", cell_arrays(data.GetPolys()))
        write("</Piece>\n</PolyData>\n</VTKFile>\n")


def write_vtu(data, path, progress=None):
    """Writes triangles of vtkPolyData as an unstructured grid with all arrays. Raises OSError."""
    cells = data.GetPolys()
    with Writer(path, data, progress) as write:
        write(HEAD.format(kind="UnstructuredGrid"))
        write.fields(data)
        write(
            f'<Piece NumberOfPoints="{data.GetNumberOfPoints()}" '
            f'NumberOfCells="{data.GetNumberOfPolys()}">\n'
        )
        write.points_and_arrays(data)
        types = numpy.full(data.GetNumberOfPolys(), TRIANGLE, dtype="u1")
        write.group("Cells", [*cell_arrays(cells), ("types", types, "")])
        write("</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")


def cell_arrays(cells):
    return [
        ("connectivity", vtk_to_numpy(cells.GetConnectivityArray()), ""),
        ("offsets", vtk_to_numpy(cells.GetOffsetsArray())[1:], ""),
    ]


def named_arrays(attributes):
    """(name, numpy array, more attributes of XML) of each array of numbers of point or cell data."""
    result = []
    for i in range(attributes.GetNumberOfArrays()):
        array = attributes.GetAbstractArray(i)
        if isinstance(array, vtkBitArray):
            plain = vtkUnsignedCharArray()
            plain.DeepCopy(array)
            plain.SetName(array.GetName())
            array = plain
        if isinstance(array, vtkDataArray):
            more = ' IdType="1"' if array.GetDataType() == VTK_ID_TYPE else ""
            for j in range(array.GetNumberOfComponents()):
                if array.GetComponentName(j):
                    more += f" ComponentName{j}={quoteattr(array.GetComponentName(j))}"
            result.append((array.GetName() or f"Array{i}", vtk_to_numpy(array), more))
    return result


def quoteattr(text):
    """A text as the value of an attribute; xml.sax has such a function, and takes time to import."""
    return '"' + text.translate(str.maketrans(MARKS)) + '"'


def xml_type(array):
    """float64 -> Float64"""
    return array.dtype.name.capitalize().replace("Ui", "UI")


class Writer:
    """An open file; call it to write text."""

    def __init__(self, path, data, progress):
        self.path, self.progress = path, progress
        self.total = 1024.0 * max(1, data.GetActualMemorySize())
        self.done = 0

    def __enter__(self):
        self.stream = open(self.path, "wb")  # pylint: disable=consider-using-with
        return self

    def __exit__(self, *_):
        self.stream.close()

    def __call__(self, text):
        self.stream.write(text.encode())

    def fields(self, data):
        """The field data: numbers, and words as codes of their characters."""
        fields = data.GetFieldData()
        self("<FieldData>\n")
        for name, array, more in named_arrays(fields):
            self.array(name, array, f' NumberOfTuples="{len(array)}"' + more)
        for i in range(fields.GetNumberOfArrays()):
            array = fields.GetAbstractArray(i)
            if isinstance(array, vtkStringArray):
                self.words(array)
        self("</FieldData>\n")

    def words(self, array):
        values = [array.GetValue(i).encode() for i in range(array.GetNumberOfValues())]
        codes = " ".join(str(code) for value in values for code in value + b"\0")
        self(
            f'<Array type="String" Name={quoteattr(array.GetName())} '
            f'NumberOfTuples="{len(values)}" format="ascii">\n{codes}\n</Array>\n'
        )

    def points_and_arrays(self, data):
        for tag, attributes in (("PointData", data.GetPointData()), ("CellData", data.GetCellData())):
            ids = attributes.GetGlobalIds()
            active = f" GlobalIds={quoteattr(ids.GetName())}" if ids and ids.GetName() else ""
            self.group(tag, named_arrays(attributes), active)
        self.group("Points", [("Points", vtk_to_numpy(data.GetPoints().GetData()), "")])

    def group(self, tag, arrays, active=""):
        self(f"<{tag}{active}>\n")
        for name, array, more in arrays:
            self.array(name, array, more)
        self(f"</{tag}>\n")

    def array(self, name, array, more=""):
        """One array: compressed blocks, with their number and sizes before them."""
        width = 1 if array.ndim == 1 else array.shape[1]
        self(
            f'<DataArray type="{xml_type(array)}" Name={quoteattr(name)} '
            f'NumberOfComponents="{width}"{more} format="binary">\n'
        )
        plain = numpy.ascontiguousarray(array, array.dtype.newbyteorder("<"))
        raw = memoryview(plain.reshape(-1).view("u1"))
        pieces = range(0, len(raw), BLOCK)
        # The sizes are known last, and their text is as long as that of as many zeros.
        sizes = numpy.zeros(3 + len(pieces), dtype="<u8")
        place = self.stream.tell()
        self.stream.write(binascii.b2a_base64(sizes, newline=False))
        level, waiting = 1, bytearray()
        if len(raw) > ALWAYS_COMPRESSED and 2 * len(zlib.compress(raw[:BLOCK], level)) > BLOCK:
            level = 0
        letters, last = numpy.frombuffer(raw, "u1"), b""

        def compressed(start):
            """A block, or None where it is the same as the one before."""
            here, before = letters[start : start + BLOCK], letters[max(start - BLOCK, 0) : start]
            return None if numpy.array_equal(here, before) else zlib.compress(here, level)

        with ThreadPoolExecutor() as threads:
            parts = [pieces[first : first + AT_ONCE] for first in range(0, len(pieces), AT_ONCE)]
            # One part is compressed while the one before becomes text.
            later = [threads.map(compressed, part) for part in parts[:1]]
            for number, part in enumerate(parts):
                later += [threads.map(compressed, more) for more in parts[number + 1 : number + 2]]
                for entry, block in enumerate(later.pop(0), 3 + number * AT_ONCE):
                    last = block or last
                    sizes[entry] = len(last)
                    waiting += last
                # Three bytes are four letters.
                whole = len(waiting) - len(waiting) % 3
                self.stream.write(binascii.b2a_base64(memoryview(waiting)[:whole], newline=False))
                waiting = waiting[whole:]
                if self.progress:
                    self.progress(min(1.0, (self.done + part.stop) / self.total))
        self.stream.write(binascii.b2a_base64(waiting, newline=False))
        self.done += len(raw)
        sizes[:3] = len(pieces), BLOCK, len(raw) % BLOCK
        end = self.stream.tell()
        self.stream.seek(place)
        self.stream.write(binascii.b2a_base64(sizes, newline=False))
        self.stream.seek(end)
        self("\n</DataArray>\n")
