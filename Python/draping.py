# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Faults without z: they get that of the surface that the points make without faults, everywhere.

Each gets a vertex where it crosses an edge of that surface, as the surface bends there.
"""

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkStaticCellLocator

from .clouds import bare_lines, make_lines, make_points, parts_of_lines
from .messages import ElevationSurfaceError, Messages, counted
from .properties import FAULTS_Z
from .vtkElevationSurface import vtkGridDelaunay2D

ROUNDING = 1e-9  # of an edge: places no farther apart along it are one


def draped(cloud, faults, name, given, strict=False):
    """(faults, notes), those without z being draped on the surface of the points of a Cloud.

    name    how messages call the faults
    given   properties, see checked(): faults_z and duplicates count
    strict  True: faults without z are an error
    """
    wanted = FAULTS_Z[given.get("faults_z", 0)]
    names, parts = parts_of_lines(faults)
    bare = bare_lines(faults)
    words = f"{name}: {numpy.count_nonzero(bare):,} of {counted(len(parts), 'line')} without z"
    if wanted == "drape":
        bare[:] = True
        words = f"{name}: z of its lines is left aside, as --faults-z says"
    elif wanted == "automatic" and not bare.all() and is_zero_beside(parts, bare, cloud.points):
        bare[:] = True
        words = (
            f"{name}: z of its lines is 0 everywhere and that of the points never, so that they "
            "count as lines without z; --faults-z given takes the 0"
        )
    if not bare.any():
        return faults, []
    words += f" (first: {names[int(numpy.argmax(bare))]})"
    if wanted == "given" or strict and wanted != "drape":
        advice = "; --faults-z drape takes z of the surface of the points"
        raise ElevationSurfaceError(words + advice, "faults")
    surface = Surface(cloud.points, given.get("duplicates", 0), name)
    result, outside, vertices = [], [], 0
    for title, part, is_bare in zip(names, parts, bare):
        found, lost, place = surface.drape(part) if is_bare else ([part], [], None)
        result += [(title, one) for one in found]
        vertices += sum(len(one) for one in found) if is_bare else 0
        if lost:
            outside.append((title, sum(lost), place))
    if not result:
        return faults, []  # the filter says where they are, and where the points
    z = numpy.concatenate([one[:, 2] for _, one in result])
    notes = [
        f"{words}: they follow the surface of the points, with {vertices:,} vertices and z from "
        f"{z.min():.6g} to {z.max():.6g}"
    ]
    if outside:
        title, lost, (x, y, _) = outside[0]
        notes.append(
            f"{name}: what lies outside of the points is left out of "
            f"{counted(len(outside), 'line')} without z, a length of {lost:.4g} of {title}, at "
            f"({x:.10g}, {y:.10g})"
        )
    return make_lines([one for _, one in result], [title for title, _ in result]), notes


def is_zero_beside(parts, bare, points):
    """Whether z of all lines that have one is 0, and z of the points never comes to 0."""
    if any(part[:, 2].any() for part, is_bare in zip(parts, bare) if not is_bare):
        return False
    z = vtk_to_numpy(points.GetPoints().GetData())[:, 2]
    z = z[numpy.isfinite(z)]
    return len(z) > 0 and (z.min() > 0.0 or z.max() < 0.0)


class Surface:
    """The triangulation of points without faults, to drape lines on."""

    def __init__(self, points, duplicates, name):
        mesh = vtkGridDelaunay2D()
        mesh.SetLatticeMode(mesh.OFF)  # as with faults
        mesh.SetDuplicatePolicy(duplicates)
        mesh.SetInputData(points)
        with Messages(mesh, mesh.GetExecutive()) as messages:
            mesh.Update()
        cells = mesh.GetOutput().GetPolys()
        if not cells.GetNumberOfCells():
            why = messages.errors or messages.warnings or ["the points make no surface"]
            raise ElevationSurfaceError(f"{name}: cannot be draped: {why[0]}", "faults")
        self.xyz = vtk_to_numpy(mesh.GetOutput().GetPoints().GetData()).astype("f8")
        self.triangles = vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, 3)
        flat = vtkPolyData()
        flat.SetPoints(make_points(numpy.nan_to_num(self.xyz) * (1.0, 1.0, 0.0)).GetPoints())
        flat.SetPolys(cells)
        self.cells, self.ids = vtkStaticCellLocator(), vtkIdList()
        self.cells.SetDataSet(flat)
        self.cells.BuildLocator()

    def near(self, p, q):
        """(n, 3, 3): the corners of triangles, among them all that a segment may touch."""
        reach = 1e-6 * (abs(q - p).max() + self.cells.GetDataSet().GetLength())
        self.ids.Reset()
        self.cells.FindCellsAlongLine((*p[:2], 0.0), (*q[:2], 0.0), reach, self.ids)
        found = [self.ids.GetId(i) for i in range(self.ids.GetNumberOfIds())]
        return self.xyz[self.triangles[numpy.unique(found).astype("i8")]]

    def drape(self, line):
        """([(n, 3) parts of a line that lie within the points], [lengths of what does not], the
        first place of that)."""
        parts, lost, first, goes_on = [], [], None, False
        for p, q in zip(line[:-1], line[1:]):
            if (p[:2] == q[:2]).all():
                continue
            points, along = self.points_along(p, q)
            outside = 1.0 - numpy.ptp(along) if len(along) else 1.0
            if outside > ROUNDING:
                lost.append(outside * float(numpy.hypot(*(q - p)[:2])))
                first = first if first is not None else q if 0.0 in along else p
            if goes_on and 0.0 in along:
                parts[-1] += list(points[1:])
            elif len(points):
                parts.append(list(points))
            goes_on = 1.0 in along
        return [numpy.array(part) for part in parts if len(part) > 1], lost, first

    def points_along(self, p, q):
        """(points, their places from 0 to 1 along pq) where a segment crosses edges of the surface,
        with its ends where they lie within the points."""
        corners, step = self.near(p, q), (q - p)[:2]
        if not len(corners):
            return numpy.empty((0, 3)), numpy.empty(0)
        edges = numpy.concatenate([corners[:, [i, (i + 1) % 3]] for i in range(3)])
        a, b = edges[:, 0], edges[:, 1]
        # Sides of the segment's line on which the ends of edges lie, as distances times its length.
        sides = [step[0] * (c - p)[:, 1] - step[1] * (c - p)[:, 0] for c in (a, b)]
        near = ROUNDING * numpy.hypot(*step) * numpy.hypot(*(b - a)[:, :2].T)
        on = [abs(side) <= near for side in sides]
        crosses = (sides[0] * sides[1] < 0) & ~on[0] & ~on[1]
        share = numpy.where(crosses, sides[0] / numpy.where(crosses, sides[0] - sides[1], 1.0), 0.0)
        found = numpy.concatenate((a[on[0]], b[on[1]], (a + share[:, None] * (b - a))[crosses]))
        along = (found - p)[:, :2] @ step / (step @ step)
        within = (along > -ROUNDING) & (along < 1.0 + ROUNDING)
        found, along = found[within], along[within]
        for place, end in ((0.0, p), (1.0, q)):
            at_end = abs(along - place) <= ROUNDING
            along[at_end], found[at_end, :2] = place, end[:2]
            z = self.height(end, corners)
            if z is not None:
                found = numpy.vstack(((*end[:2], z), found))
                along = numpy.append(place, along)
        order = numpy.argsort(along, kind="stable")
        order = order[numpy.diff(along[order], prepend=-1.0) > ROUNDING]
        return found[order], along[order]

    @staticmethod
    def height(p, corners):
        """z at a place, in the triangle of some that holds it; None where none does."""
        to = corners - p
        following = numpy.roll(to, -1, axis=1)
        edges = numpy.hypot(*(following - to)[..., :2].T).T
        areas = to[..., 0] * following[..., 1] - to[..., 1] * following[..., 0]
        deep = (areas / edges).min(axis=1)  # the least distance from an edge
        best = int(numpy.argmax(deep))
        reach = ROUNDING * edges[best].max() + 8 * numpy.spacing(abs(p[:2]).max())
        if deep[best] < -reach:
            return None
        shares = numpy.maximum(numpy.roll(areas[best], -1), 0.0)  # each of the corner opposite
        return float(shares @ corners[best, :, 2] / shares.sum())
