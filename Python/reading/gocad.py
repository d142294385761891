# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Vertices, lines and triangles of GOCAD files: TSurf, VSet and PLine."""

import re

import numpy
from vtkmodules.vtkCommonDataModel import vtkCellArray

from ..clouds import Cloud, add_array, make_points
from ..messages import FileError
from ..progress import lines_with_progress
from ..selecting import words_of
from .facing import check_faces, make_faces

KINDS = ("TSurf", "VSet", "PLine")
NAME = re.compile(r'(?:HEADER *\{)? *name: *"?([^"}]*)')


class Gocad:
    """All objects of a file.

    points      [(x, y, z)]
    properties  {name: [value of each point]}, NaN where there is none
    segments    [(from, to)], triangles [(a, b, c)]: places in points
    turned      whether z of an object is turned over, as it says that it counts downwards
    turn        False to leave z as it is
    no_data     the z that marks missing data, which is left as it is, or None
    objects     [[name, number of its points]]
    """

    def __init__(self, path, progress, turn=True, no_data=None):
        self.path, self.turn, self.turned, self.sign = path, turn, False, 1.0
        self.no_data = no_data
        self.points, self.properties, self.segments, self.triangles = [], {}, [], []
        self.ids, self.names, self.sizes, self.missing = {}, [], [], []
        self.objects = []
        key = ""
        with open(path, encoding="latin-1") as stream:
            for number, line in enumerate(lines_with_progress(stream, progress), 1):
                words = line.split()
                if not words or words[0].startswith("#"):
                    continue
                key = words[0]
                try:
                    self.take(key, words)
                except (KeyError, ValueError, IndexError):
                    shown = line.strip()[:40]
                    raise FileError(f"{path}, line {number}: '{shown}' is damaged") from None
        if key != "END":
            raise FileError(f"{path}: is cut off: its last line, END, is missing")
        if not self.points:
            raise FileError(f"{path}: holds no points")

    def take(self, key, words):
        if key == "GOCAD":
            if words[1] not in KINDS:
                raise FileError(f"{self.path}: holds a {words[1]}; {', '.join(KINDS)} are read")
            self.ids, self.names, self.sizes, self.missing = {}, [], [], []
            self.sign = 1.0
            self.objects.append(["", 0])
        elif key == "ZPOSITIVE":
            self.sign = -1.0 if self.turn and words[1].lower() == "depth" else 1.0
        elif key == "PROPERTIES":
            self.names = [word.strip('"') for word in words[1:]]
        elif key == "ESIZES":
            self.sizes = [int(word) for word in words[1:]]
        elif key == "NO_DATA_VALUES":
            self.missing = [float(word) for word in words[1:]]
        elif key in ("VRTX", "PVRTX"):
            x, y, z = (float(word) for word in words[2:5])
            self.turned |= self.sign < 0.0
            z = z if z == self.no_data else self.sign * z
            self.add(words[1], (x, y, z), words[5:])
        elif key in ("ATOM", "PATOM"):
            self.add(words[1], self.points[self.ids[words[2]]], words[3:])
        elif key == "SEG":
            self.segments.append((self.ids[words[1]], self.ids[words[2]]))
        elif key == "TRGL":
            self.triangles.append(tuple(self.ids[word] for word in words[1:4]))
        elif found := NAME.match(" ".join(words)):
            self.objects[-1][0] = self.objects[-1][0] or found.group(1).strip()

    def add(self, name, point, values):
        self.ids[name] = len(self.points)
        at = 0
        for i, (title, size) in enumerate(zip(self.names, self.sizes or [1] * len(self.names))):
            if size == 1 and at < len(values) and values[at] != "CNXYZ":
                value = float(values[at])
                if i < len(self.missing) and value == self.missing[i]:
                    value = numpy.nan
                column = self.properties.setdefault(title, [])
                column += [numpy.nan] * (len(self.points) - len(column)) + [value]
            at += size
        self.points.append(point)
        self.objects[-1][1] += 1


def read_points(path, options):
    """The vertices; properties become point arrays."""
    gocad = Gocad(path, options.progress, turn=not options.depth, no_data=options.no_data)
    cloud = Cloud(make_points(numpy.array(gocad.points)))
    cloud.z_name = "elevation"  # by ZPOSITIVE, which turns over what is none
    for name, values in gocad.properties.items():
        values = values + [numpy.nan] * (len(gocad.points) - len(values))
        add_array(cloud.points, name, numpy.array(values))
    names, counts = zip(*gocad.objects)
    if any(names):
        cloud.words["name"] = words_of(names).some(numpy.repeat(numpy.arange(len(names)), counts))
    if gocad.triangles:
        cloud.notes += check_objects(gocad, options)
    if gocad.segments or gocad.triangles:
        cloud.notes.append("only the points are used, not the file's cells")
    if gocad.turned:
        cloud.notes.append("z is turned over: the file says that it is depth (ZPOSITIVE Depth)")
    return cloud


def check_objects(gocad, options):
    """Notes on the faces of each object, of those that are chosen by name. Raises FileError."""
    wanted = [value for column, value in options.where or () if column.lower() == "name" and value]
    wanted += [options.layer] if options.layer else []
    points, triangles = numpy.array(gocad.points), numpy.array(gocad.triangles)
    ends = numpy.cumsum([count for _, count in gocad.objects])
    owner = numpy.searchsorted(ends, triangles[:, 0], side="right")
    notes = []
    for i in numpy.unique(owner).tolist():
        name = gocad.objects[i][0]
        if not wanted or name in wanted:
            called = f"{gocad.path}, {name}" if name and len(gocad.objects) > 1 else gocad.path
            notes += check_faces(called, make_faces(points, triangles[owner == i]), options)
    return notes


def read_lines(path, singular, progress):
    """The lines, or triangles where there are none, as vtkPolyData."""
    gocad = Gocad(path, progress)
    chains = []
    for start, end in gocad.segments:
        if chains and chains[-1][-1] == start:
            chains[-1].append(end)
        else:
            chains.append([start, end])
    cells = vtkCellArray()
    for ids in chains or gocad.triangles:
        cells.InsertNextCell(len(ids), ids)
    if not cells.GetNumberOfCells():
        raise FileError(f"{path}: holds no line and no polygon that could be {singular}")
    data = make_points(numpy.array(gocad.points))
    (data.SetLines if chains else data.SetPolys)(cells)
    return data
