# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes surfaces."""

import os

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .clouds import make_points
from .messages import FileError, Messages
from .paths import suffix_of
from .vtk_files import rounding_note

WRITE_SUFFIXES = (".vtp", ".ply", ".stl", ".obj")


def write_surface(data, path):
    """Writes vtkPolyData in the format of the suffix. Returns notes for the user."""
    from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter
    from vtkmodules.vtkIOPLY import vtkPLYWriter
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    suffix = suffix_of(path)
    notes = []
    coordinates = vtk_to_numpy(data.GetPoints().GetData())
    coarse = rounding_note(coordinates) is not None
    if suffix == ".vtp":
        writer = vtkXMLPolyDataWriter()
        # Not appended: ParaView 5.11 cannot read appended data with a newer libexpat. In memory first:
        # the writer crashes on a full disk.
        writer.SetDataModeToBinary()
        writer.WriteToOutputStringOn()
    elif suffix == ".ply":
        writer = vtkPLYWriter()
        if coarse:
            # The format's usual floats have 24 bits. A whole-number shift keeps the shape.
            origin = numpy.floor(numpy.nanmin(coordinates, axis=0))
            origin[2] = 0.0
            shifted = vtkPolyData()
            shifted.ShallowCopy(data)
            points = make_points(coordinates - origin).GetPoints()
            shifted.SetPoints(points)
            data = shifted
            text = f"{origin[0]:.0f} {origin[1]:.0f}"
            writer.AddComment(f"add to x y: {text}")
            notes.append(
                f".ply holds single precision: x,y are written less {text}, see its header"
            )
    elif suffix == ".stl":
        writer = vtkSTLWriter()
        # ASCII keeps every digit; binary STL has 24 bits.
        if coarse:
            writer.SetFileTypeToASCII()
            notes.append(".stl is written as text to keep large coordinates exact")
        else:
            writer.SetFileTypeToBinary()
    else:
        writer = vtkOBJWriter()
    with Messages() as messages:
        writer.SetFileName(path)
        writer.SetInputData(data)
        done = writer.Write()
    if suffix == ".vtp" and done and not messages.errors:
        with open(path, "w", encoding="ascii", newline="") as stream:
            stream.write(writer.GetOutputString())
    if messages.errors or not done:
        raise FileError(messages.errors[0] if messages.errors else "VTK's writer gave no reason")
    if not is_whole(path, suffix, data):
        raise FileError("the file is cut off; is the disk full?")
    return notes


def is_whole(path, suffix, data):
    """Whether all of the surface is in the file. VTK's writers do not notice a full disk."""
    try:
        size = os.path.getsize(path)
        with open(path, "rb") as stream:
            if suffix == ".obj":
                lines = stream.read().split(b"\n")
                kinds = [line[:2] for line in lines]
                return (
                    lines[-1] == b""
                    and kinds.count(b"v ") == data.GetNumberOfPoints()
                    and kinds.count(b"f ") == data.GetNumberOfPolys()
                )
            head = stream.read(2000)
            stream.seek(max(0, size - 100))
            tail = stream.read().rstrip()
    except OSError:
        return False
    if suffix == ".vtp":
        return tail.endswith(b"</VTKFile>")
    if suffix == ".ply":
        start = head.find(b"end_header\n")
        body = 12 * data.GetNumberOfPoints() + 13 * data.GetNumberOfPolys()
        return start > 0 and size == start + len(b"end_header\n") + body
    if head.startswith(b"solid") and tail.endswith(b"endsolid"):
        return True
    return size == 84 + 50 * data.GetNumberOfPolys()
