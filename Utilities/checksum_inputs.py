# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The points, lines, rings and meshes that Utilities/checksums gives to the filters.

The random numbers are the same everywhere. More point clouds (NAME.f64, N x 3 doubles) are taken from the
folder ELEVATION_SURFACE_EXTRA_DATA.
"""
import functools
import glob
import os
import zlib

import numpy
from vtkelevationsurface import vtkGridDelaunay2D
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

DATA = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "Data")
EXTRA = os.environ.get("ELEVATION_SURFACE_EXTRA_DATA", "")
LARGE_FILE = 900_000  # bytes; of larger clouds only some cases are run


# ---- points -----------------------------------------------------------------------------------


def random_of(name):
    return numpy.random.RandomState(zlib.crc32(name.encode()))


def with_z(xy, noise=0.2):
    """Adds a wavy surface with a little noise, its relief independent of the extent in x,y."""
    xy = numpy.asarray(xy, float)
    if len(xy) == 0:
        return numpy.empty((0, 3))
    low, size = xy.min(axis=0), numpy.maximum(numpy.ptp(xy, axis=0), 1e-300)
    u, v = ((xy - low) / size).T
    z = 30 * numpy.sin(6 * u) + 20 * numpy.cos(9 * v + 2 * u) + 10 * u
    return numpy.column_stack([xy, z + noise * random_of("z").normal(size=len(xy))])


def lattice(name, columns, rows, keep=1.0, u=(1.0, 0.0), v=(0.0, 1.0), origin=(0.0, 0.0), decimals=None):
    i, j = (a.ravel() for a in numpy.meshgrid(numpy.arange(columns), numpy.arange(rows)))
    xy = numpy.outer(i, u) + numpy.outer(j, v) + origin
    xy = xy[random_of(name).uniform(size=len(xy)) < keep]
    return with_z(xy if decimals is None else numpy.round(xy, decimals))


def uniform(name, count, size=1000.0):
    return with_z(random_of(name).uniform(0.0, size, (count, 2)))


def clustered(name, count):
    random = random_of(name)
    radius, angle = 10.0 / random.uniform(0.001, 1.0, count), random.uniform(0.0, 2 * numpy.pi, count)
    return with_z(numpy.column_stack([radius * numpy.cos(angle), radius * numpy.sin(angle)]))


def tracks(name, crossing):
    random = random_of(name)
    t, lines = numpy.meshgrid(numpy.arange(0.0, 3000.0, 5.0), numpy.arange(0.0, 3000.0, 150.0))
    xy = numpy.column_stack([t.ravel(), lines.ravel()]) + random.normal(0.0, 1.0, (t.size, 2))
    if crossing:
        xy = numpy.vstack([xy, xy[:, ::-1] + random.normal(0.0, 0.5, xy.shape)])
    return with_z(xy)


def integer_circle(radius=32045):
    x = numpy.arange(-radius, radius + 1)
    y = numpy.round(numpy.sqrt(radius**2 - x.astype(float) ** 2)).astype(int)
    x, y = x[x**2 + y**2 == radius**2], y[x**2 + y**2 == radius**2]
    return with_z(numpy.unique(numpy.vstack([numpy.c_[x, y], numpy.c_[x, -y]]), axis=0))


def not_finite(name):
    xyz, random = uniform(name, 5000), random_of(name + "!")
    for value in (numpy.nan, numpy.inf, -numpy.inf):
        xyz[random.randint(0, 5000, 40), random.randint(0, 3, 40)] = value
    return xyz


def duplicates(name):
    xyz, random = uniform(name, 3000), random_of(name + "!")
    xyz = xyz[random.randint(0, 3000, 8000)]
    xyz[:, 2] = random.randint(-20, 20, 8000)
    return xyz


def extremes(name):
    random = random_of(name)
    signs, powers = random.choice([-1.0, 1.0], (400, 2)), random.uniform(-215.0, 100.0, (400, 2))
    return numpy.column_stack([signs * 10.0**powers, random.normal(size=400)])


def circle(count, radius=1.0, middle=(0.0, 0.0), start=0.0):
    angle = start + 2 * numpy.pi * numpy.arange(count) / count
    return numpy.column_stack([radius * numpy.cos(angle), radius * numpy.sin(angle)]) + middle


TURN = numpy.radians(33.7)
MAP = dict(u=(25 * numpy.cos(TURN), 25 * numpy.sin(TURN)), origin=(460838.0, 6215400.6),
           v=(-18.75 * numpy.sin(TURN), 18.75 * numpy.cos(TURN)), decimals=1)

GENERATED = {
    "lattice_sparse": lambda n: lattice(n, 180, 160, 0.6),
    "lattice_full": lambda n: lattice(n, 121, 101),
    "lattice_map": lambda n: lattice(n, 150, 130, 0.85, **MAP),
    "lattice_sheared": lambda n: lattice(n, 120, 110, 0.9, (3.0, 0.5), (1.25, 2.0)),
    "lattice_decimal": lambda n: lattice(n, 60, 60, 1.0, (0.1, 0.0), (0.0, 0.1), (0.3, 0.7)),
    "lattice_rough": lambda n: lattice(n, 90, 90, 0.9, MAP["u"], MAP["v"], decimals=0),
    "uniform": lambda n: uniform(n, 20000),
    "uniform_small": lambda n: uniform(n, 4000),
    "uniform_float32": lambda n: uniform(n, 20000).astype(numpy.float32),
    "lattice_float32": lambda n: lattice(n, 100, 80, 0.7, (0.25, 0), (0, 0.5)).astype(numpy.float32),
    "clustered": lambda n: clustered(n, 20000),
    "tracks": lambda n: tracks(n, False),
    "tracks_crossing": lambda n: tracks(n, True),
    "integers": lambda n: with_z(random_of(n).randint(0, 300, (20000, 2))),
    "circle": lambda n: with_z(circle(1000, 100.0, (7.0, 3.0))),
    "circle_integers": lambda n: integer_circle(),
    "circles": lambda n: with_z(numpy.vstack([circle(200, r, (0, 0), r) for r in range(1, 40)])),
    "collinear": lambda n: with_z(numpy.outer(numpy.arange(1000.0), (1.0, 3.0))),
    "collinear_and_one": lambda n: with_z(numpy.vstack([numpy.outer(range(999), (1, 3)), [(5, 5)]])),
    "duplicates": duplicates,
    "not_finite": not_finite,
    "extremes": extremes,
    "graded": lambda n: with_z(random_of(n).uniform(0.0, 1.0, (9000, 2)) ** (2.5, 1.0) * 1000.0),
    "two_clusters": lambda n: with_z(numpy.vstack([uniform(n, 3000, 1.0)[:, :2],
                                                   uniform(n + "2", 3000, 1.0)[:, :2] + 1e6])),
    "large_uniform_300k": lambda n: uniform(n, 300000),
    "large_lattice_300k": lambda n: lattice(n, 800, 625, 0.6),
}
for _count in range(11):
    GENERATED[f"tiny_{_count}"] = lambda n, c=_count: uniform(n, c)
    GENERATED[f"tiny_integers_{_count}"] = lambda n, c=_count: with_z(random_of(n).randint(0, 4, (c, 2)))


def files():
    """The clouds of Data/ and of the folder with more, by name; not boundaries and faults."""
    found = {}
    for pattern in [os.path.join(DATA, "*." + s) for s in ("csv", "xyz", "vtp")] + (
            [os.path.join(EXTRA, "*.f64")] if EXTRA else []):
        for path in sorted(glob.glob(pattern)):
            name = os.path.splitext(os.path.basename(path))[0]
            if not name.endswith(("_boundary", "_faults")):
                found[name] = path
    return found


FILES = files()


def is_large(name):
    return name.startswith("large_") or (name in FILES and os.path.getsize(FILES[name]) > LARGE_FILE)


def read_vtp(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


@functools.lru_cache(maxsize=4)
def cloud(name):
    """The point set of that name as vtkPolyData."""
    path = FILES.get(name)
    if path is None:
        return poly_data(GENERATED[name](name))
    if path.endswith(".vtp"):
        return read_vtp(path)
    if path.endswith(".f64"):
        return poly_data(numpy.fromfile(path, "<f8").reshape(-1, 3))
    return poly_data(numpy.loadtxt(path, delimiter="," if path.endswith(".csv") else None, skiprows=1))


def coordinates(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def spacing(data):
    """About the distance of neighbours: as if the finite points filled their bounding box."""
    xy = coordinates(data)[:, :2].astype(float)
    xy = xy[numpy.isfinite(xy).all(axis=1)]
    if len(xy) < 2:
        return 1.0
    width, height = numpy.ptp(xy, axis=0)
    return float(numpy.sqrt(width / len(xy)) * numpy.sqrt(height)) or 1.0


def height_range(data):
    z = coordinates(data)[:, 2].astype(float)
    z = z[numpy.isfinite(z)]
    return float(numpy.ptp(z)) if len(z) else 0.0


# ---- meshes and lines -------------------------------------------------------------------------


def cells_of(lists):
    """A vtkCellArray. Ids may be invalid."""
    cells = vtkCellArray()
    offsets = numpy.cumsum([0] + [len(ids) for ids in lists])
    ids = numpy.array([i for ids in lists for i in ids], numpy.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets.astype(numpy.int64), deep=True),
                  numpy_to_vtkIdTypeArray(ids, deep=True))
    return cells


def poly_data(xyz, polys=None, lines=None, verts=None, strips=None):
    data, points = vtkPolyData(), vtkPoints()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(xyz).reshape(-1, 3), deep=True))
    data.SetPoints(points)
    for kind, lists in (("Polys", polys), ("Lines", lines), ("Verts", verts), ("Strips", strips)):
        if lists is not None:
            getattr(data, "Set" + kind)(cells_of(lists))
    return data


def triangles_of(data):
    return vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def add_array(data, name, values):
    if isinstance(values, list):
        array = vtkStringArray()
        array.SetNumberOfValues(len(values))
        for i, value in enumerate(values):
            array.SetValue(i, value)
    else:
        array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName(name)
    data.AddArray(array)
    return array


def decorate(data, cells_too=True, ids=True):
    """Arrays of many types and roles on points, cells and field."""
    xyz = coordinates(data).astype(float)
    count = len(xyz)
    t = numpy.arange(count)
    points = data.GetPointData()
    temperature = numpy.where(t % 97, 20 + numpy.cos(t * 0.01) + 0.1 * xyz[:, 2], numpy.nan)
    add_array(points, "Temperature", temperature.astype(numpy.float32))
    add_array(points, "Drift", numpy.column_stack([xyz[:, 2] * 2, t * 0.5, -xyz[:, 2]]))
    add_array(points, "Number", (t * 7 % 1000).astype(numpy.int32))
    add_array(points, "Class", (t % 5).astype(numpy.uint8))
    add_array(points, "Label", [f"p{i}" for i in t])
    slopes = numpy.column_stack([numpy.sin(t * 0.1), numpy.cos(t * 0.1), 2.0 + 0.0 * t])
    slopes /= numpy.linalg.norm(slopes, axis=1)[:, None]
    points.SetNormals(add_array(points, "Normals", slopes.astype(numpy.float32)))
    points.SetActiveScalars("Temperature")
    if ids:
        points.SetPedigreeIds(add_array(points, "Pedigree", (t * 3).astype(numpy.int64)))
        points.SetGlobalIds(add_array(points, "GlobalIds", (t + 100).astype(numpy.int64)))
    if cells_too:
        c, cells = numpy.arange(data.GetNumberOfCells()), data.GetCellData()
        add_array(cells, "Quality", (c * 0.25).astype(numpy.float32))
        add_array(cells, "Part", (c // 10).astype(numpy.int16))
        add_array(cells, "Name", [f"c{i}" for i in c])
        cells.SetGlobalIds(add_array(cells, "GlobalCellIds", (c + 5).astype(numpy.int64)))
        cells.SetActiveScalars("Part")
    add_array(data.GetFieldData(), "Survey", ["north", "2"])
    add_array(data.GetFieldData(), "Datum", numpy.array([1.5, 2.5]))
    return data


def with_properties(algorithm, properties):
    for name, value in properties.items():
        getattr(algorithm, "Set" + name)(value)
    return algorithm


def delaunay(points, lines=None, **properties):
    """MaximumEdgeLength is in spacings of the points, MaximumElevationError in parts of the relief."""
    algorithm = vtkGridDelaunay2D()
    points = cloud(points) if isinstance(points, str) else points
    algorithm.SetInputData(points)
    if lines is not None:
        algorithm.SetSourceData(lines)
    if properties.get("MaximumEdgeLength"):
        properties["MaximumEdgeLength"] *= spacing(points)
    if "MaximumElevationError" in properties:
        properties["MaximumElevationError"] *= height_range(points)
    return with_properties(algorithm, properties)


@functools.lru_cache(maxsize=4)
def mesh(name, edges=0.0):
    """The triangulation of that point set, without edges of more than so many spacings."""
    algorithm, data = delaunay(name, MaximumEdgeLength=edges), vtkPolyData()
    algorithm.Update()
    data.ShallowCopy(algorithm.GetOutput())
    data.GetFieldData().Initialize()
    return data


@functools.lru_cache(maxsize=4)
def rich_mesh(name, edges=0.0, narrow=False):
    """As mesh, with arrays of all types, and vertices and lines before the triangles."""
    plain = mesh(name, edges)
    data = poly_data(coordinates(plain), None, [[0, 1, 2], [5, 4]], [[3], [1, 2]])
    data.SetPolys(cells_of(triangles_of(plain).tolist()))
    if narrow:
        data.GetPolys().ConvertTo32BitStorage()
    return decorate(data)


def frame(data):
    """Middle and half of the extent of the points, for shapes drawn relative to them."""
    xy = coordinates(data)[:, :2].astype(float)
    return 0.5 * (xy.min(axis=0) + xy.max(axis=0)), 0.5 * numpy.ptp(xy, axis=0).min()


def drawing(base, shapes, closed=False, polygons=False):
    """Lines or polygons, in halves of the extent of base around its middle."""
    middle, half = frame(base)
    lists, total = [], 0
    for shape in shapes:
        ids = list(range(total, total + len(shape)))
        lists.append(ids + ids[:1] if closed and not polygons else ids)
        total += len(shape)
    xy = numpy.vstack(shapes) * half + middle
    xyz = numpy.column_stack([xy, numpy.arange(len(xy)) % 17])
    return poly_data(xyz, lists if polygons else None, None if polygons else lists)


def at_points(base, shapes):
    """Shapes moved to the nearest points of base, in the same relative units."""
    middle, half = frame(base)
    xy = coordinates(base)[:, :2].astype(float)
    moved = []
    for shape in shapes:
        ids = [int(numpy.argmin(((xy - p) ** 2).sum(axis=1))) for p in numpy.asarray(shape) * half + middle]
        ids = [i for k, i in enumerate(ids) if i != ids[k - 1]]
        moved.append(xy[ids])
    return moved


def lines_at_points(base, shapes, closed=False):
    data = drawing(base, at_points(base, shapes), closed)
    xy = numpy.vstack(at_points(base, shapes))
    data.SetPoints(poly_data(numpy.column_stack([xy, numpy.zeros(len(xy))])).GetPoints())
    return data


def constraints(kind, base):
    random = random_of(kind)
    if kind == "crossing":
        return drawing(base, list(random.uniform(-0.9, 0.9, (40, 2, 2))))
    if kind == "polylines":
        return drawing(base, [numpy.cumsum(random.uniform(-0.2, 0.25, (12, 2)), axis=0) for _ in range(8)])
    if kind == "star":
        return drawing(base, [numpy.array([-p, p]) for p in circle(24, 0.8)])
    if kind == "overlapping":
        return drawing(base, [numpy.array([(a, 0.25), (b, 0.25)]) for a, b in
                              ((-0.75, 0.5), (-0.5, 0.75), (0.5, -0.25), (0.0, 0.0), (-0.75, 0.5))])
    if kind == "polygons":
        return drawing(base, [circle(5, 0.5, (0.2, 0.1)), circle(40, 0.3, (-0.3, 0)), circle(4, 0.9)],
                       polygons=True)
    if kind == "outside":
        return drawing(base, [circle(7, 1.8), numpy.array([(-3.0, 0.1), (3.0, 0.2)])], closed=True)
    if kind == "nodes":
        return lines_at_points(base, [numpy.array([(-0.8, -0.8), (0.8, 0.8)]), circle(12, 0.6),
                                      numpy.array([(-0.8, 0.0), (0.8, 0.0), (0.0, 0.8), (0.0, -0.8)])])
    if kind == "rich":
        return decorate(constraints("crossing", base), ids=False)
    if kind == "faults":
        return read_vtp(os.path.join(DATA, "horizon_synthetic_faults.vtp"))
    faults = read_vtp(os.path.join(DATA, "horizon_synthetic_faults.vtp"))
    assert kind == "faults_crossing"
    xyz, middle = coordinates(faults).astype(float), coordinates(faults).mean(axis=0)
    turned = (xyz - middle)[:, [1, 0, 2]] * (1, -1, 1) + middle
    lists = [list(range(len(xyz))), list(range(len(xyz), 2 * len(xyz)))]
    return poly_data(numpy.vstack([xyz, turned]), None, lists)


STAR = circle(10, 0.8) * numpy.where(numpy.arange(10) % 2, 0.4, 1.0)[:, None]
SQUARE = numpy.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
SECTORS = [numpy.array([(0.011, 0.007), a, b]) for a, b in
           zip(circle(100, 0.8), numpy.roll(circle(100, 0.8), -1, axis=0))]
RINGS = {
    "circle": lambda m: drawing(m, [circle(60, 0.7)], True),
    "clockwise": lambda m: drawing(m, [circle(60, 0.7)[::-1]], True),
    "star": lambda m: drawing(m, [STAR], True),
    "nested": lambda m: drawing(m, [circle(40, 0.9), circle(30, 0.6), circle(9, 0.2)], True),
    "polygons": lambda m: drawing(m, [circle(40, 0.9), circle(30, 0.6), circle(9, 0.2)], True, True),
    "rich": lambda m: decorate(drawing(m, [circle(40, 0.9), STAR * 0.5], True), ids=False),
    "at_points": lambda m: lines_at_points(m, [circle(24, 0.8), circle(7, 0.3)], True),
    "square_at_points": lambda m: lines_at_points(m, [SQUARE], True),
    "partly_outside": lambda m: drawing(m, [circle(50, 0.7, (0.8, 0.5))], True),
    "around_all": lambda m: drawing(m, [circle(20, 5.0)], True),
    "sectors": lambda m: drawing(m, SECTORS, True),
    "every_other_sector": lambda m: drawing(m, SECTORS[::2], True),
    "ten_times": lambda m: drawing(m, [circle(30, 0.7)] * 10, True),
    "eleven_times": lambda m: drawing(m, [circle(30, 0.7)] * 11, True),
    "many": lambda m: drawing(m, [circle(6, 0.04, (x, y)) for x in numpy.linspace(-0.9, 0.9, 15)
                                  for y in numpy.linspace(-0.9, 0.9, 15)], True),
    "touching": lambda m: drawing(m, [SQUARE * 0.5, SQUARE * 0.5 + 0.5], True),
    "parcels": lambda m: drawing(m, [SQUARE * 0.5, SQUARE * 0.5 + (0.5, 0.0)], True),
    "segments": lambda m: drawing(m, [numpy.array([a, b]) for a, b in
                                      zip(STAR, numpy.roll(STAR, -1, axis=0))]),
    "in_one_triangle": lambda m: drawing(m, [circle(5, 1e-4, (0.1003, 0.2001))], True),
    "crossing_itself": lambda m: drawing(m, [SQUARE[[0, 2, 1, 3]]], True),
    "crossing_each_other": lambda m: drawing(m, [SQUARE, SQUARE + 0.31], True),
    "open": lambda m: drawing(m, [SQUARE]),
    "two_points": lambda m: drawing(m, [SQUARE[:2]], True),
    "encloses_nothing": lambda m: drawing(m, [circle(9, 0.3, (9.0, 9.0))], True),
    "not_finite": lambda m: drawing(m, [numpy.vstack([SQUARE, [(numpy.nan, 0.0)]])], True),
    "no_lines": lambda m: poly_data(coordinates(m)[:3]),
    "invalid_id": lambda m: poly_data(coordinates(m)[:3], None, [[0, 1, 7, 0]]),
}


# What is cut out of a mesh: by the middles of triangles, in halves of the extent around the middle.
def band(u, v, low, high):
    return (numpy.hypot(u, v) > low) & (numpy.hypot(u, v) < high)


CUTS = {
    "nothing": lambda u, v: u > 9,
    "disc": lambda u, v: band(u, v, -1, 0.35),
    "discs": lambda u, v: (band(u, v, -1, 0.2) | band(u - 0.6, v, -1, 0.1) | band(u, v - 0.6, -1, 0.25)
                           | band(u + 0.6, v + 0.6, -1, 0.04)),
    "island": lambda u, v: band(u, v, 0.2, 0.5),
    "nested": lambda u, v: band(u, v, 0.1, 0.25) | band(u, v, 0.4, 0.7) | band(u - 0.55, v, -1, 0.05),
    "pinched": lambda u, v: ((u * v > 0) & (abs(u) < 0.4) & (abs(v) < 0.4)),
    "slot": lambda u, v: (abs(u) < 0.7) & (abs(v - 0.2 * u) < 0.03),
    "border": lambda u, v: band(u - 1, v, -1, 0.4) | band(u + 0.4, v, -1, 0.2),
    "large_disc": lambda u, v: band(u, v, -1, 0.8),
    "two_thousand": lambda u, v: ((u * 151 % 6.5) < 2.5) & ((v * 151 % 6.5) < 2.5)
                    & (abs(u) < 0.97) & (abs(v) < 0.97),
}


@functools.lru_cache(maxsize=4)
def cut_mesh(name, cut, rich=False, edges=0.0):
    """A mesh with holes. Arrays are put on after cutting."""
    whole = mesh(name, edges)
    middle, half = frame(whole)
    triangles = triangles_of(whole)
    u, v = (coordinates(whole)[triangles][:, :, :2].mean(axis=1).T - middle[:, None]) / half
    triangles = triangles[~CUTS[cut](u, v)]
    data = poly_data(coordinates(whole), None, [[0, 1]] if rich else None, [[0]] if rich else None)
    data.SetPolys(cells_of(triangles.tolist()))
    return decorate(data) if rich else data


GRID = numpy.array([(x, y, x * 0.5 + y * y) for y in range(5) for x in range(5)], float)
GRID_TRIANGLES = [t for y in range(4) for x in range(4) for a in [5 * y + x]
                  for t in ([a, a + 1, a + 6], [a, a + 6, a + 5])]


def bad_mesh(kind):
    """A mesh of 5 x 5 points with a hole in the middle and something wrong."""
    xyz = GRID.copy()
    good = [t for t in GRID_TRIANGLES if 12 not in t]
    polys, others = list(good), {}
    if kind == "one_clockwise":
        polys[3] = polys[3][::-1]
    elif kind == "all_clockwise":
        polys = [t[::-1] for t in polys]
    elif kind == "overlapping":
        polys.append([0, 4, 24])
    elif kind == "twice":
        polys.append(polys[2])
    elif kind == "three_at_an_edge":
        xyz = numpy.vstack([xyz, [(0.5, -1.0, 0.0), (0.6, -2.0, 0.0)]])
        polys += [[0, 25, 1], [0, 26, 1]]
    elif kind == "quad":
        polys[4:5] = [[6, 7, 12, 11]]
    elif kind == "two_ids":
        polys[4:5] = [[6, 7]]
    elif kind == "flat":
        polys.append([0, 1, 2])
    elif kind == "corner_twice":
        polys.append([0, 0, 1])
    elif kind in ("nan", "infinite", "nan_z"):
        xyz[0, 2 if kind == "nan_z" else 0] = numpy.inf if kind == "infinite" else numpy.nan
    elif kind == "nan_unused":
        xyz[12, 0] = numpy.nan
    elif kind == "nan_z_at_rim":
        xyz[6, 2] = numpy.nan
    elif kind == "id_too_large":
        polys[2] = [0, 1, 25]
    elif kind == "id_negative":
        polys[2] = [0, -1, 6]
    elif kind == "strip":
        others = {"strips": [[0, 1, 5, 6]]}
    elif kind == "only_verts":
        polys, others = None, {"verts": [[0, 1, 2]]}
    elif kind == "t_junction":
        xyz = numpy.vstack([xyz, [(2.5, 0.0, 0.0), (2.5, -1.0, 0.0)]])
        polys += [[25, 2, 26]]
    elif kind == "same_place":
        xyz = numpy.vstack([xyz, xyz[6]])
        polys = [[25 if i == 6 and k % 2 else i for i in t] for k, t in enumerate(polys)]
    elif kind == "huge":
        xyz[:, :2] *= 1e160
    elif kind == "minute":
        xyz[:, :2] *= 1e-160
    elif kind == "narrow_double":
        xyz[:, :2] = 1e16 + 2 * xyz[:, :2]
    data = poly_data(xyz, polys, **others)
    if kind == "empty":
        data = vtkPolyData()
    elif kind == "short_point_array":
        add_array(data.GetPointData(), "Short", numpy.zeros(3))
    elif kind == "short_cell_array":
        add_array(data.GetCellData(), "Short", numpy.zeros(3))
    elif kind == "bad_offsets":
        ids = vtkCellArray()
        ids.SetData(numpy_to_vtkIdTypeArray(numpy.array([0, 3, 9, 6], numpy.int64), deep=True),
                    numpy_to_vtkIdTypeArray(numpy.arange(6, dtype=numpy.int64), deep=True))
        data.SetPolys(ids)
    return data


BAD_MESHES = ("fine one_clockwise all_clockwise overlapping twice three_at_an_edge quad two_ids flat "
              "corner_twice nan infinite nan_z nan_unused nan_z_at_rim id_too_large id_negative strip "
              "only_verts t_junction same_place huge minute narrow_double empty short_point_array "
              "short_cell_array bad_offsets").split()
SQUARE_RING = [[6, 8, 18, 16, 6]]


def bad_constraints(kind):
    data = poly_data(GRID, None, [[0, 7, 24]])
    if kind == "strip":
        data = poly_data(GRID, strips=[[0, 1, 5, 6]])
    elif kind in ("id_too_large", "id_negative"):
        data = poly_data(GRID, None, [[0, 25 if kind == "id_too_large" else -1]])
    elif kind == "not_finite":
        data = poly_data(numpy.vstack([GRID, [(0.5, numpy.nan, 0)]]), None, [[0, 25]])
    elif kind == "short_point_array":
        add_array(data.GetPointData(), "Short", numpy.zeros(3))
    elif kind == "one_point":
        data = poly_data([(0.5, 0.25, 1.0)], None, [[0]])
    elif kind == "no_length":
        data = poly_data(GRID, None, [[3, 3], [4, 4, 4]])
    elif kind == "verts":
        data = poly_data(GRID + 0.25, verts=[[3, 4]])
    return data
