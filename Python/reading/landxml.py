# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of LandXML: their points, breaklines and boundaries. No library of Debian reads them."""

import xml.etree.ElementTree as ElementTree

import numpy

from ..clouds import Cloud, make_lines, make_points
from ..gdal_common import choose_layer
from ..messages import FileError
from .facing import check_faces, make_faces

POINT_LISTS = ("PntList3D", "PntList2D")


class LandXml:
    """What a file holds.

    surfaces  {name: [{id: (x, y, z)}, [corners' ids]]}
    others    [(x, y, z)] of the points of a survey
    lines     {"Breakline": [(n, 3) array], "Boundary": ...}, z NaN where there is none
    crs, unit  as AUTHORITY:CODE, and of lengths in words, or None
    """

    def __init__(self, path, progress):
        self.path = path
        self.surfaces, self.others, self.crs, self.unit = {}, [], None, None
        self.lines = {"Breakline": [], "Boundary": []}
        progress(0.0)
        inside = []
        try:
            for event, element in ElementTree.iterparse(path, ("start", "end")):
                name = element.tag.rpartition("}")[2]
                if event == "start":
                    inside.append(name)
                    if name == "Surface":
                        title = element.get("name") or f"surface {len(self.surfaces) + 1}"
                        self.surfaces[title] = [{}, []]
                    continue
                self.take(name, element, inside)
                inside.pop()
        except ElementTree.ParseError as error:
            raise FileError(f"{path}: is cut off or damaged: {error}") from None
        except (ValueError, IndexError):
            raise FileError(f"{path}: is damaged: {name} holds '{(element.text or '').strip()[:40]}'") from None

    def take(self, name, element, inside):
        """Takes what an element holds; the first number of a place is its northing."""
        words = (element.text or "").split()
        if name == "P" and "Surface" in inside:
            y, x, z = map(float, words[:3])
            list(self.surfaces.values())[-1][0][element.get("id")] = (x, y, z)
        elif name == "F" and element.get("i") != "1":  # 1: invisible
            first, second, third = words[:3]
            list(self.surfaces.values())[-1][1].append((first, second, third))
        elif name == "CgPoint" and len(words) == 3:
            y, x, z = map(float, words)
            self.others.append((x, y, z))
        elif name in POINT_LISTS and set(self.lines) & set(inside):
            places = numpy.array(words, "f8").reshape(-1, 3 if name == "PntList3D" else 2)
            z = places[:, 2] if places.shape[1] == 3 else numpy.full(len(places), numpy.nan)
            kind = "Breakline" if "Breakline" in inside else "Boundary"
            self.lines[kind].append(numpy.column_stack((places[:, 1], places[:, 0], z)))
        elif name == "CoordinateSystem" and element.get("epsgCode"):
            self.crs = f"EPSG:{element.get('epsgCode')}"
        elif name in ("Metric", "Imperial"):
            self.unit = element.get("linearUnit")
        if name in ("P", "F"):
            element.clear()


def read_points(path, options):
    """The points of a surface, or of a survey where there is no surface."""
    found = LandXml(path, options.progress)
    names = [name for name, (points, _) in found.surfaces.items() if points]
    if not names and found.others and not options.layer:
        cloud = Cloud(make_points(numpy.array(found.others)), ["LandXML: the points of the survey (CgPoints)"])
    else:
        name = choose_layer(path, options.layer, names, "surfaces")
        points, faces = found.surfaces[name]
        cloud = Cloud(make_points(numpy.array(list(points.values()))), [f"LandXML: surface {name}"])
        places = {key: place for place, key in enumerate(points)}
        try:
            corners = numpy.array([[places[key] for key in face] for face in faces])
        except KeyError as error:
            raise FileError(f"{path}: is damaged: a face has the corner {error}, which is not a point") from None
        if len(faces) and not options.points_only:
            cloud.notes.append("only the points are used, not the file's cells")
            cloud.notes += check_faces(path, make_faces(numpy.array(list(points.values())), corners), options)
        cloud.z_name = name
    cloud.crs = found.crs
    if found.unit:
        cloud.notes.append(f"lengths in {found.unit}, as the file says")
    return cloud


def read_lines(path, singular, progress):
    """The breaklines of all surfaces, or their boundaries."""
    kind = "Boundary" if singular == "a boundary" else "Breakline"
    lines = LandXml(path, progress).lines[kind]
    if not lines:
        raise FileError(f"{path}: holds no {kind}")
    return make_lines(lines, [f"{kind} {i} of the file" for i in range(1, len(lines) + 1)])
