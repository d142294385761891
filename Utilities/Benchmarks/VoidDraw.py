# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The voids of void-bench: elevation models as rasters, and voids drawn over them by a seed.

The protocol is that of Reuter, Nelson & Jarvis 2007: kinds of terrain by sizes of voids. The same
seed over the same files gives the same voids on every system.
"""

import glob
import hashlib
import heapq
import os
from typing import NamedTuple

import numpy

DATA = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Data"))
SIZES = (4, 9, 20, 45, 100, 220, 480, 1000)  # lost nodes, about
LEAST_WITH_ISLAND = 100  # about a quarter of the voids from this size on have one
LAND = ("plain", "hills", "mountains")
SLOPES = (0.05, 0.2)  # root mean square slope: where hills begin, and mountains
ROUGH = 0.35  # see roughness()
KINDS = tuple(f"{texture} {land}" for land in LAND for texture in ("smooth", "rough"))
RING = 4  # rows of known nodes around a void, at least
ATTEMPTS = 60  # places tried for each void that is wanted
SHAPES = 48  # of each size; turned and mirrored when they are used


class Raster(NamedTuple):
    name: str
    heights: numpy.ndarray  # rows along y; NaN where there is none
    steps: tuple  # of x and y
    origin: str  # "lattice", or "resampled" where the points are on none


class Void(NamedTuple):
    surface: str
    kind: str
    size: int  # asked for
    heights: numpy.ndarray  # of the window, with those that are lost; NaN where the surface has none
    lost: numpy.ndarray  # of the window, which nodes are
    steps: tuple
    corner: tuple  # row and column of the window in the raster
    has_island: bool

    def damaged(self):
        """What methods get: NaN where heights are lost."""
        return numpy.where(self.lost, numpy.nan, self.heights)

    def relief(self):
        """The standard deviation of the heights around the void: errors are given in parts of it."""
        return float(numpy.nanstd(self.damaged()))


# ---- elevation models ---------------------------------------------------------------------------


def files_of(folders):
    """Surfaces of points in folders; boundaries and faults of another file are not surfaces."""
    kinds = ("*.vtp", "*.csv", "*.xyz", "*.f64", "*.tif", "*.asc")
    found = [path for folder in folders for kind in kinds
             for path in sorted(glob.glob(os.path.join(folder, kind)))]
    names = {os.path.splitext(os.path.basename(path))[0] for path in found}
    lines = {f"{name}_{what}" for name in names for what in ("boundary", "faults")}
    return [path for path in found if os.path.splitext(os.path.basename(path))[0] not in lines]


def points_of(path):
    if path.endswith(".f64"):
        points = numpy.fromfile(path, "<f8").reshape(-1, 3)
    else:
        from vtkelevationsurface import read
        from vtkmodules.util.numpy_support import vtk_to_numpy

        points = vtk_to_numpy(read(path).points.GetPoints().GetData()).astype("f8")
    return points[numpy.isfinite(points).all(axis=1)]


def triangulated(points):
    """The triangles of points, and the lattice on which they lie, or None."""
    from vtkelevationsurface import vtkGridDelaunay2D
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    cloud = vtkPolyData()
    cloud.SetPoints(vtkPoints())
    cloud.GetPoints().SetData(numpy_to_vtk(points, deep=True))
    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputData(cloud)
    delaunay.Update()
    mesh = delaunay.GetOutput()
    lattice = mesh.GetFieldData().GetArray("Lattice")
    ids = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3).copy()
    return ids, None if lattice is None else numpy.array(lattice.GetTuple(0))


def on_lattice(points, lattice):
    """Heights at the nodes of a lattice of right angles, and its steps."""
    first, second = lattice[2:4], lattice[4:6]
    lengths = numpy.hypot(*first), numpy.hypot(*second)
    if abs(first @ second) > 0.02 * lengths[0] * lengths[1]:
        return None
    nodes = numpy.rint(numpy.linalg.solve(
        numpy.column_stack((first, second)), (points[:, :2] - lattice[:2]).T)).astype(int)
    nodes -= nodes.min(axis=1)[:, None]
    heights = numpy.full(nodes.max(axis=1)[::-1] + 1, numpy.nan)
    heights[nodes[1], nodes[0]] = points[:, 2]
    return heights, lengths


def draw_triangles(points, triangles, heights):
    """Writes the heights of triangles at the nodes under them; x and y are in nodes."""
    for a, b, c in points[triangles]:
        left, low = numpy.ceil(numpy.minimum(numpy.minimum(a, b), c)[:2] - 1e-6).astype(int)
        right, high = numpy.floor(numpy.maximum(numpy.maximum(a, b), c)[:2] + 1e-6).astype(int)
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if right < left or high < low or area == 0:
            continue
        x, y = numpy.arange(left, right + 1)[None, :], numpy.arange(low, high + 1)[:, None]
        u = ((b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)) / area
        v = ((c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)) / area
        w = 1.0 - u - v
        inside = (u > -1e-9) & (v > -1e-9) & (w > -1e-9)
        part = heights[low : high + 1, left : right + 1]
        part[inside] = (u * a[2] + v * b[2] + w * c[2])[inside]


def resampled(points, triangles):
    """On squares as large as the place that a point has, without what long triangles bridge."""
    ends = points[triangles][:, :, :2]
    lengths = numpy.hypot(*(numpy.roll(ends, 1, axis=1) - ends).transpose(2, 0, 1))
    kept = triangles[(lengths <= 3.0 * numpy.median(lengths)).all(axis=1)]
    a, b, c = points[kept][:, :, :2].transpose(1, 0, 2)
    areas = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    step = numpy.sqrt(areas.mean())  # two triangles a point
    low = points[:, :2].min(axis=0)
    nodes = numpy.column_stack(((points[:, :2] - low) / step, points[:, 2]))
    heights = numpy.full(numpy.floor(nodes[:, 1::-1].max(axis=0)).astype(int) + 1, numpy.nan)
    draw_triangles(nodes, kept, heights)
    return heights, (step, step)


def raster_of(path):
    name = os.path.splitext(os.path.basename(path))[0]
    points = points_of(path)
    triangles, lattice = triangulated(points)
    found = None if lattice is None else on_lattice(points, lattice)
    heights, steps = found or resampled(points, triangles)
    return Raster(name, heights, tuple(float(step) for step in steps), "lattice" if found else "resampled")


# ---- kinds of terrain ---------------------------------------------------------------------------


def increments(heights, steps):
    """Along x and y; NaN next to what is lost."""
    return numpy.diff(heights, axis=1) / steps[0], numpy.diff(heights, axis=0) / steps[1]


def slope(heights, steps):
    """Root mean square."""
    return float(numpy.sqrt(sum(numpy.nanmean(part**2) for part in increments(heights, steps))))


def roughness(heights, steps):
    """How far heights are from the mean of their four neighbours, in parts of how far they are from one.

    Root mean squares, without the slope of the whole: white noise has 0.79, a smooth surface 0.
    """
    mean = 0.25 * (heights[1:-1, :-2] + heights[1:-1, 2:] + heights[:-2, 1:-1] + heights[2:, 1:-1])
    bends = numpy.nanmean((heights[1:-1, 1:-1] - mean) ** 2)
    along = [part * step for part, step in zip(increments(heights, steps), steps)]
    varies = 0.5 * sum(numpy.nanvar(part) for part in along)
    return float(numpy.sqrt(bends / varies)) if varies > 0 else 0.0


def kind_of(heights, steps):
    """By the heights that are known."""
    land = LAND[int(numpy.searchsorted(SLOPES, slope(heights, steps), side="right"))]
    return f"{'rough' if roughness(heights, steps) >= ROUGH else 'smooth'} {land}"


# ---- shapes of voids ----------------------------------------------------------------------------


def fans(known):
    """How many fans of triangles are around each node that is known and not at the border of the array.

    A cell of four known nodes is two triangles, one of three is one, and others are none.
    """
    core = known[1:-1, 1:-1]
    around = [known[1:-1, 2:], known[2:, 2:], known[2:, 1:-1], known[2:, :-2],
              known[1:-1, :-2], known[:-2, :-2], known[:-2, 1:-1], known[:-2, 2:]]
    cells = numpy.zeros(core.shape, int)
    joins = numpy.zeros(core.shape, int)
    for k in range(0, 8, 2):
        here = [around[k].astype(int) + around[k + 1] + around[(k + 2) % 8] >= 2,
                around[k - 2].astype(int) + around[k - 1] + around[k] >= 2]
        cells += here[0]
        joins += here[0] & here[1] & around[k]  # both have the edge to the neighbour between them
    return numpy.where(core, numpy.where((cells == 4) & (joins == 4), 1, cells - joins), 1)


def without_pinches(lost):
    """With more nodes lost, so that each known one has one fan of triangles, as meshes need."""
    while True:
        bad = fans(~lost) != 1
        if not bad.any():
            return lost
        lost[1:-1, 1:-1] |= bad


def enclosed(lost):
    """Which known nodes are cut off from the border of the array."""
    outside = numpy.zeros(lost.shape, bool)
    outside[[0, -1], :] = outside[:, [0, -1]] = True
    while True:
        grown = outside.copy()
        grown[1:] |= outside[:-1]
        grown[:-1] |= outside[1:]
        grown[:, 1:] |= outside[:, :-1]
        grown[:, :-1] |= outside[:, 1:]
        grown &= ~lost
        if (grown == outside).all():
            return ~lost & ~outside
        outside = grown


def shape_of(size, random, island):
    """Which nodes of a square array are lost: grown from the middle, with ragged sides, longish."""
    wanted = int(round(size / 0.85)) if island else size
    radius = numpy.sqrt(wanted / numpy.pi)
    half = int(3.2 * radius) + 4
    y, x = numpy.mgrid[-half : half + 1, -half : half + 1] / radius
    angle, stretch = numpy.pi * random.random_sample(), 1.0 + 1.2 * random.random_sample()
    u = (numpy.cos(angle) * x + numpy.sin(angle) * y) / stretch
    v = (numpy.cos(angle) * y - numpy.sin(angle) * x) * stretch
    cost = numpy.hypot(u, v)
    for wave in (1.6, 0.9, 0.5):
        for _ in range(3):
            turn, phase = 2.0 * numpy.pi * random.random_sample(2)
            cost += 0.13 * wave * numpy.cos(
                2.0 * numpy.pi / wave * (numpy.cos(turn) * x + numpy.sin(turn) * y) + phase)
    cost = numpy.round(cost, 9)  # the same order everywhere
    lost = numpy.zeros(cost.shape, bool)
    side, border = len(cost), []
    seen = numpy.zeros(cost.shape, bool)
    seen[half, half] = True
    heapq.heappush(border, (0.0, half, half))
    for _ in range(wanted):
        _, i, j = heapq.heappop(border)
        lost[i, j] = True
        for a, b in ((i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)):
            if 2 < a < side - 3 and 2 < b < side - 3 and not seen[a, b]:
                seen[a, b] = True
                heapq.heappush(border, (cost[a, b], a, b))
    lost |= enclosed(lost)
    if island:
        rows, columns = numpy.nonzero(lost)
        place = random.randint(len(rows))
        deep = 0.45 * radius / stretch
        middle = 0.6 * rows.mean() + 0.4 * rows[place], 0.6 * columns.mean() + 0.4 * columns[place]
        i, j = numpy.indices(lost.shape)
        lost &= numpy.hypot(i - middle[0], j - middle[1]) >= max(1.5, deep)
    lost = without_pinches(lost)
    rows, columns = numpy.nonzero(lost)
    return lost[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]


# ---- drawing ------------------------------------------------------------------------------------


class Places:
    """Where voids have room in a raster."""

    def __init__(self, raster):
        self.raster = raster
        known = ~numpy.isnan(raster.heights)
        for _ in range(RING):
            known = shrunk(known)
        self.free = known
        self.nodes = numpy.argwhere(known)


def shrunk(known):
    """Without those at the border of the array, and next to what is not known."""
    inner = numpy.zeros(known.shape, bool)
    rows, columns = known.shape
    inner[1:-1, 1:-1] = True
    for i in range(3):
        for j in range(3):
            inner[1:-1, 1:-1] &= known[i : i + rows - 2, j : j + columns - 2]
    return inner


def attempt(places, shapes, size, random):
    """A void at a place of a surface that is drawn, or None where it has no room."""
    place = places[random.randint(len(places))]
    shape, has_island = shapes[random.randint(len(shapes))]
    turn, where = random.randint(8), random.random_sample()
    if not len(place.nodes):
        return None
    shape = numpy.rot90(shape.T if turn >= 4 else shape, turn % 4)
    raster, middle = place.raster, place.nodes[int(where * len(place.nodes))]
    low = middle - numpy.array(shape.shape) // 2
    high = low + shape.shape
    if (low < 0).any() or (high > raster.heights.shape).any():
        return None
    if not place.free[low[0] : high[0], low[1] : high[1]][shape].all():
        return None
    away = max(2 * RING, int(1.1 * max(shape.shape)))
    first, last = numpy.maximum(low - away, 0), numpy.minimum(high + away, raster.heights.shape)
    heights = raster.heights[first[0] : last[0], first[1] : last[1]]
    lost = numpy.zeros(heights.shape, bool)
    lost[tuple(slice(a, b) for a, b in zip(low - first, high - first))] = shape
    damaged = numpy.where(lost, numpy.nan, heights)
    if not numpy.nanstd(damaged) > 0.0:
        return None  # a lake: it shows nothing
    return Void(raster.name, kind_of(damaged, raster.steps), size, heights, lost, raster.steps,
                tuple(first.tolist()), has_island)


def shapes_of(size, random):
    """[(nodes, whether there is an island)]; about a quarter of the large ones have one."""
    shapes = []
    for number in range(SHAPES):
        island = size >= LEAST_WITH_ISLAND and number % 4 == 0
        nodes = shape_of(size, random, island)
        shapes.append((nodes, bool(enclosed(numpy.pad(nodes, 1)).any())))
    return shapes


def draw(rasters, each, seed, sizes=SIZES):
    """Voids, as many of each kind and size; where a kind has no room, others of the size follow."""
    places = [Places(raster) for raster in rasters]
    voids = []
    for number, size in enumerate(sizes):
        random = numpy.random.RandomState([seed, number])
        shapes = shapes_of(size, random)
        counts = dict.fromkeys(KINDS, 0)
        wanted = each * len(KINDS)
        spare = []
        for _ in range(ATTEMPTS * wanted):
            void = attempt(places, shapes, size, random)
            if void is None:
                continue
            if counts[void.kind] < each:
                counts[void.kind] += 1
                voids.append(void)
            elif len(spare) < wanted:
                spare.append(void)
            if sum(counts.values()) == wanted:
                break
        voids += spare[: wanted - sum(counts.values())]
    return voids


def fingerprint(voids):
    """Of a draw: results of the same one belong together."""
    digest = hashlib.sha256()
    for void in voids:
        digest.update(f"{void.surface} {void.size} {void.corner} {void.steps}".encode())
        digest.update(numpy.ascontiguousarray(void.heights, "<f8").tobytes())
        digest.update(numpy.packbits(void.lost).tobytes())
    return digest.hexdigest()[:16]
