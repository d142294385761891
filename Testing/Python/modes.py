# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The rows of features.py, run in each mode: what they work on, and how they are run.

A row is a chain of filters up to that of the row: triangulate, trim where there is a boundary, fill. The
same chain runs in memory, on ranks, in pieces, and on ranks with pieces each.
"""

import copy
import tempfile
import types

import numpy
from vtkelevationsurface import (
    vtkFillElevationHoles,
    vtkGridDelaunay2D,
    vtkTrimOutwardTriangles,
)
from vtkelevationsurface.clouds import add_array
from vtkelevationsurface.vtkElevationSurfacePieces import vtkReconstructPieces
from vtkmodules.vtkCommonDataModel import (
    vtkMultiBlockDataSet,
    vtkPartitionedDataSet,
    vtkPartitionedDataSetCollection,
    vtkPolyData,
    vtkUnstructuredGrid,
)

import meshes
from outcomes import made_by, noted

FILTERS = {
    "Delaunay": vtkGridDelaunay2D, "Trim": vtkTrimOutwardTriangles, "Fill": vtkFillElevationHoles,
}

# ---- what rows work on ----------------------------------------------------------------------------


def case_of(xyz, **more):
    """Points; each has its number as a value, so that points at one place can be distinguished."""
    case = types.SimpleNamespace(
        xyz=xyz, arrays={"Number": numpy.arange(float(len(xyz)))}, roles={}, dealt={}, lines=None, rings=None,
        areas=None, triangles=None, cells={}, on_one=False, copies=False, composite=None, kind=vtkPolyData)
    vars(case).update(more)
    return case


def with_heights(random, xy):
    """Hills, and a little noise."""
    x, y = (xy - xy.min(axis=0)).T / numpy.ptp(xy)
    z = 3.0 * numpy.sin(6.0 * x) * numpy.cos(5.0 * y) + x
    return numpy.column_stack((xy, z + 0.05 * random.random(len(xy))))


def scattered(random, count):
    """One point for each unit of area."""
    return with_heights(random, numpy.sqrt(count) * random.random((count, 2)) + (1000.0, 5000.0))


def nodes(random, count, part=0.8):
    """Nodes of a lattice along the axes with steps of 1, in no order; some are missing."""
    side = int(numpy.sqrt(count / part))
    xy = numpy.stack(numpy.meshgrid(numpy.arange(side), numpy.arange(side)), -1).reshape(-1, 2)
    kept = random.permutation(len(xy))[: int(part * len(xy))]
    return xy[kept].astype(float)


def middle_of(xyz):
    low, high = (getattr(xyz[:, :2], name)(axis=0) for name in ("min", "max"))
    return 0.5 * (low + high), float((high - low).min())


def star(middle, radius, corners):
    """A ring with waves, (n, 2)."""
    turn = numpy.linspace(0.0, 2.0 * numpy.pi, corners, endpoint=False)
    reach = radius * (1.0 + 0.2 * numpy.sin(5.0 * turn))
    return numpy.column_stack((reach * numpy.cos(turn), reach * numpy.sin(turn))) + middle


def away(xyz, *circles):
    """Points outside circles (x, y, radius), in shares of the extent from the middle."""
    middle, extent = middle_of(xyz)
    for x, y, radius in circles:
        xyz = xyz[numpy.hypot(*(xyz[:, :2] - middle - (x * extent, y * extent)).T) > radius * extent]
    return xyz


def points(random, count):
    return case_of(scattered(random, count))


def no_points(_random, _count):
    return case_of(numpy.zeros((0, 3)))


def two_points(random, _count):
    return case_of(scattered(random, 2))


def lattice(random, count):
    steps = numpy.array([[2.0, 1.5], [-0.9, 1.2]])
    return case_of(with_heights(random, nodes(random, count) @ steps + (6e5, 6e6)))


def sparse_lattice(random, count):
    """So few nodes that the lattice cannot be found."""
    xy = random.integers(int(30 * numpy.sqrt(count)), size=(count, 2))
    steps = numpy.array([[2.0, 1.5], [-0.9, 1.2]])
    return case_of(with_heights(random, numpy.unique(xy, axis=0) @ steps + (6e5, 6e6)))


def loose_lattice(random, count):
    xy = nodes(random, count)
    return case_of(with_heights(random, xy + random.uniform(-0.05, 0.05, xy.shape)))


def duplicates(random, count):
    xyz = scattered(random, count)
    again = xyz[random.integers(len(xyz), size=count // 4)]
    xyz = numpy.vstack((xyz, again, again[: count // 9]))
    xyz[:, 2] = random.integers(3, size=len(xyz))
    return case_of(xyz[random.permutation(len(xyz))])


def not_finite(random, count):
    xyz = scattered(random, count)
    for value in (numpy.nan, numpy.inf, -numpy.inf):
        xyz[random.integers(len(xyz), size=5), random.integers(3, size=5)] = value
    return case_of(xyz)


def breaklines(random, count):
    """Lines that cross, a polygon, and a line through points of the cloud."""
    case = points(random, count)
    middle, extent = middle_of(case.xyz)
    reach = 0.4 * extent * numpy.array([[-1, -0.9], [0.9, 1], [-1, 0.8], [1, -0.7], [0, -1.1], [0.7, 0.9], [1, 0]])
    places = numpy.column_stack((middle + reach, numpy.arange(7.0)))
    places = numpy.vstack((places, case.xyz[[3, 50, 90]]))
    case.lines = (places, [[0, 1], [2, 3], [7, 8, 9]], [[4, 5, 6]])
    return case


def soft_lines(random, count):
    """Lines that cross, inside of the cloud, with some points without z."""
    case = points(random, count)
    middle, extent = middle_of(case.xyz)
    reach = 0.3 * extent * numpy.array([[-1, -0.9], [0.9, 1], [-1, 0.8], [1, -0.7], [0, -1.0], [0.7, 0.9]])
    places = numpy.column_stack((middle + reach, [numpy.nan, 1.0, numpy.nan, numpy.nan, 2.0, numpy.nan]))
    case.lines = (places, [[0, 1], [2, 3], [4, 5]], [])
    return case


def straight_line(random, count):
    """A line of many points through a cloud, of even slope."""
    case = points(random, count)
    middle, extent = middle_of(case.xyz)
    along = numpy.linspace(-0.4, 0.4, 40)
    xy = middle + extent * numpy.column_stack((along, numpy.zeros(40)))
    case.lines = (numpy.column_stack((xy, along)), [range(40)], [])
    return case


def coast(random, count):
    case = points(random, count)
    middle, extent = middle_of(case.xyz)
    case.rings = [star(middle, 0.36 * extent, 60)]
    return case


def with_lakes(case):
    """A coast, lakes, and an island."""
    middle, extent = middle_of(case.xyz)
    case.rings = [star(middle, 0.36 * extent, 60), star(middle, 0.03 * extent, 7)]
    for x, y, radius in ((0.0, 0.0, 0.1), (0.2, 0.05, 0.05), (-0.2, 0.1, 0.07), (0.02, -0.2, 0.04)):
        case.rings.append(star(middle + (x * extent, y * extent), radius * extent, int(8 + 100 * radius)))
    return case


def coast_and_lakes(random, count):
    return with_lakes(points(random, count))


def areas_of(rings):
    """Around every second lake, so that others are not chosen."""
    return [1.2 * (ring - ring.mean(axis=0)) + ring.mean(axis=0) for ring in rings[1::2]]


def area_data(case):
    """Areas, all but the second with a level."""
    data, levels = meshes.rings(case.areas), 100.0 + numpy.arange(len(case.areas))
    levels[1:2] = numpy.nan
    add_array(data, "Water", levels, "Cell")
    return data


def coast_along_edges(random, count):
    """A boundary whose edges are those of a lattice."""
    case = case_of(with_heights(random, nodes(random, count, 1.0)))
    last = int(case.xyz[:, 0].max()) - 3
    ways = ((i, 3) for i in range(3, last)), ((last, i) for i in range(3, last))
    ways += ((i, last) for i in range(last, 3, -1)), ((3, i) for i in range(last, 3, -1))
    case.rings = [numpy.array([place for way in ways for place in way], float)]
    return case


def lattice_and_lakes(random, count):
    return with_lakes(case_of(with_heights(random, nodes(random, count, 1.0))))


def gaps(random, count):
    """A cloud with a lake and a bay, and a few points outside."""
    xyz = away(scattered(random, count), (0.1, 0.0, 0.15), (-0.5, -0.1, 0.2))
    outside = scattered(random, 5) + (3.0 * numpy.sqrt(count), 0.0, 0.0)
    return case_of(numpy.vstack((xyz, outside)))


def tracks(random, count):
    """Dense along lines that are far apart, and enough of them to be found to be such."""
    count = 2 * count
    line = random.integers(10, size=count)
    xy = numpy.column_stack((count / 20 * random.random(count), 5.0 * line + 0.01 * random.random(count)))
    return case_of(with_heights(random, xy))


def surface(random, count):
    """Triangles that come from elsewhere, with holes, from left to right."""
    case = points(random, count)
    delaunay = vtkGridDelaunay2D()
    delaunay.SetInputData(meshes.cloud(case.xyz))
    delaunay.Update()
    triangles = meshes.triangles_of(delaunay.GetOutput())
    middle, extent = middle_of(case.xyz)
    centres = case.xyz[triangles, :2].mean(axis=1)
    for x, y, radius in ((0.0, 0.0, 0.12), (0.25, 0.1, 0.06), (-0.2, 0.2, 0.05)):
        kept = numpy.hypot(*(centres - middle - (x * extent, y * extent)).T) > radius * extent
        triangles, centres = triangles[kept], centres[kept]
    used, triangles = numpy.unique(triangles[numpy.argsort(centres[:, 0])], return_inverse=True)
    case = case_of(case.xyz[used], triangles=triangles.reshape(-1, 3))
    case.cells["Cell"] = numpy.arange(float(len(triangles.reshape(-1, 3))))
    return case


def surface_and_coast(random, count):
    case = surface(random, count)
    middle, extent = middle_of(case.xyz)
    case.rings = [star(middle, 0.36 * extent, 60)]
    return case


# What is changed of these.


def of_floats(case):
    case.xyz = (case.xyz - case.xyz.min(axis=0)).astype("f4")
    if case.rings:
        middle, extent = middle_of(case.xyz)
        case.rings = [star(middle, 0.36 * extent, 60), star(middle, 0.12 * extent, 20)]


def adding(role="", **make):
    """Adds arrays: name = function(numbers of points, random)."""

    def add(case):
        numbers, random = numpy.arange(len(case.xyz)), numpy.random.default_rng(2)
        for name, function in make.items():
            case.arrays[name] = function(numbers, random)
            if role:
                case.roles[name] = role

    return add


def unit(vectors):
    return vectors / numpy.linalg.norm(vectors, axis=1)[:, None]


INTEGERS = ("i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8")
def with_some_z(ring):
    """(n, 3): every third point has no z."""
    return numpy.column_stack((ring, numpy.where(numpy.arange(len(ring)) % 3, 5.0, numpy.nan)))


CHANGES = {
    "float": of_floats,
    "float array": adding(Single=lambda n, r: numpy.sin(n).astype("f4")),
    "double array": adding(Double=lambda n, r: numpy.sin(n)),
    "integers": adding(**{
        "Int" + kind: lambda n, r, kind=kind: (n % 97 + 2**40 * (kind[1] == "8")).astype(kind)
        for kind in INTEGERS}),
    "strings": adding(Text=lambda n, r: numpy.array(["t" * (i % 4) + str(i) for i in n], "U")),
    "global ids": adding("GlobalIds", Id=lambda n, r: 3 * n.astype("i8") + 2**33),
    "pedigree ids": adding("PedigreeIds", Pedigree=lambda n, r: 7 * n.astype("i8")),
    "vectors": adding("Vectors", Flow=lambda n, r: r.random((len(n), 3))),
    "normals": adding("Normals", Normal=lambda n, r: unit(r.random((len(n), 3)) - (0.5, 0.5, -2.0))),
    "copies": lambda case: vars(case).update(copies=True),
    "on one": lambda case: vars(case).update(on_one=True),
    "no z": lambda case: vars(case).update(rings=[with_some_z(ring) for ring in case.rings]),
    "areas": lambda case: vars(case).update(areas=areas_of(case.rings)),
    "multiblock": lambda case: vars(case).update(composite=vtkMultiBlockDataSet),
    "partitions": lambda case: vars(case).update(composite=vtkPartitionedDataSet),
    "collection": lambda case: vars(case).update(composite=vtkPartitionedDataSetCollection),
    "unstructured": lambda case: vars(case).update(kind=vtkUnstructuredGrid),
    "clockwise": lambda case: vars(case).update(triangles=case.triangles[:, ::-1]),
    "vertices": lambda case: vars(case).update(kind="vertices"),
}


def make_case(row, count):
    """What a row works on, with about so many points."""
    base, *changes = row.input.split(" + ")
    case = globals()[base.replace(" ", "_")](numpy.random.default_rng(35), count)
    for change in changes:
        CHANGES[change](case)
    return case


def owners(case, count, parts):
    """The part of each point (triangle): as dealt; else one after another, with global ids in no order."""
    if parts in case.dealt:
        return case.dealt[parts]
    if "Id" in case.arrays and case.triangles is None:
        return numpy.random.default_rng(parts).integers(parts, size=count)
    return numpy.arange(count) * parts // max(1, count)


def of_points(case, chosen, marks=None):
    plain = [(name, values[chosen]) for name, values in case.arrays.items()]
    if marks is not None:
        plain.append((meshes.GHOSTS, marks.astype("u1")))
    kind = vtkPolyData if case.kind == "vertices" else case.kind
    data = meshes.cloud(case.xyz[chosen], None, plain, kind)
    for name, role in case.roles.items():
        data.GetPointData().SetActiveAttribute(name, getattr(data.GetPointData(), role.upper(), ROLES[role]))
    return data


ROLES = {"Vectors": 1, "Normals": 2, "GlobalIds": 5, "PedigreeIds": 6}  # of vtkDataSetAttributes


def plain_part(case, part, parts):
    """The part of points or triangles. With copies it also has some of the next part's, marked."""
    if case.triangles is None:
        of = owners(case, len(case.xyz), parts)
        mine = numpy.flatnonzero(of == part)
        if not case.copies:
            return of_points(case, mine)
        more = numpy.flatnonzero(of == (part + 1) % parts)[:9] if parts > 1 else mine[:0]
        chosen = numpy.append(mine, more)
        return of_points(case, chosen, numpy.arange(len(chosen)) >= len(mine))
    of = owners(case, len(case.triangles), parts)
    mine = numpy.flatnonzero(of == part)
    more = numpy.flatnonzero(of == (part + 1) % parts)[:9] if case.copies and parts > 1 else mine[:0]
    chosen = numpy.append(mine, more)
    used = numpy.unique(case.triangles[chosen])
    first = numpy.searchsorted(used, case.triangles[mine])
    data = of_points(case, used, ~numpy.isin(used, case.triangles[mine]) if case.copies else None)
    cells = [(name, values[chosen]) for name, values in case.cells.items()]
    if case.copies:
        cells.append((meshes.GHOSTS, (numpy.arange(len(chosen)) >= len(mine)).astype("u1")))
    corners = numpy.vstack((first, numpy.searchsorted(used, case.triangles[more])))
    whole = meshes.mesh(case.xyz[used], corners, None, (), cells)
    data.SetPolys(whole.GetPolys())
    data.GetCellData().ShallowCopy(whole.GetCellData())
    if case.kind == "vertices" and len(mine):
        data.SetVerts(meshes.cells_of([[0]]))
        for name, values in cells:
            values = numpy.append(values[:1], values)
            data.GetCellData().AddArray(meshes.array_of(values, name))
    return data


def every_second(case, first):
    """Half of the points (triangles), in their order."""
    some = copy.copy(case)
    if case.triangles is not None:
        some.triangles = case.triangles[first::2]
        some.cells = {name: values[first::2] for name, values in case.cells.items()}
    else:
        some.xyz = case.xyz[first::2]
        some.arrays = {name: values[first::2] for name, values in case.arrays.items()}
    return some


def part_of(case, part, parts):
    """The input of a rank, or what is added at a time."""
    if not case.composite:
        return plain_part(case, part, parts)
    halves = [plain_part(every_second(case, i), part, parts) for i in (0, 1)]
    composite = case.composite()
    for i, half in enumerate(halves):
        if case.composite is vtkMultiBlockDataSet:
            composite.SetBlock(i, half)
        elif case.composite is vtkPartitionedDataSet:
            composite.SetPartition(i, half)
        else:
            composite.SetPartition(i, 0, half)
    return composite


# ---- modes ----------------------------------------------------------------------------------------


def set_properties(row, of):
    """of(name) -> the filter. A property is of the row's filter, or Filter.Property.

    What is filled are holes that a boundary has cut out, but where a row is about that.
    """
    if row.filter == "Fill" and "cut-outs" not in row.feature:
        of("Fill").SetFillCutOuts(True)
    for name, value in row.properties.items():
        name = name if "." in name else row.filter + "." + name
        step, name = name.split(".")
        getattr(of(step), "Set" + name)(value)


def chain(row, case, data, threads, has_second=True):
    """{name: filter}: those up to the row's."""
    steps = {name: make() for name, make in FILTERS.items()}
    if case.areas:
        steps["Fill"].SetAreasData(area_data(case) if has_second else vtkPolyData())
    lines = meshes.lines(*case.lines) if case.lines and has_second else vtkPolyData()
    rings = meshes.rings(case.rings) if case.rings and has_second else vtkPolyData()
    if case.lines:
        steps["Delaunay"].SetSourceData(lines)
    if case.rings:
        steps["Trim"].SetBoundaryData(rings)
    if case.triangles is not None:
        del steps["Delaunay"]
    if row.filter == "Delaunay":
        del steps["Trim"]
    if row.filter != "Fill":
        del steps["Fill"]
    elif not case.rings:
        del steps["Trim"]
    before = None
    for algorithm in steps.values():
        algorithm.SetNumberOfThreads(threads)
        if before:
            algorithm.SetInputConnection(before.GetOutputPort())
        else:
            algorithm.SetInputData(data)
        before = algorithm
    set_properties(row, steps.get)
    return steps


def in_memory(row, case, threads=1, part=(0, 1)):
    """What one run makes of a part of the input, (number, of how many)."""
    steps = list(chain(row, case, part_of(case, *part), threads).values())
    messages = noted(*steps)
    steps[-1].UpdatePiece(0, 1, 0)
    return made_by(steps, messages)


def on_rank(row, case, rank, count):
    """What one rank has made."""
    has_second = not case.on_one or rank == count - 1
    steps = list(chain(row, case, part_of(case, rank, count), 1, has_second).values())
    messages = noted(*steps)
    steps[-1].UpdatePiece(rank, count, 0)
    return made_by(steps, messages)


def has_pieces(case):
    """Whether vtkReconstructPieces can be asked for it: it takes points, in one block."""
    return case.triangles is None and not case.composite


def piece_source(row, case, folder, is_alone=False):
    """A source without points, whose files go to a folder; of all ranks together, or of this one alone."""
    source = vtkReconstructPieces()
    if is_alone:
        source.SetController(None)
    source.SetFolder(folder)
    of = {name: getattr(source, "Get" + name)() for name in FILTERS}
    for algorithm in of.values():
        algorithm.SetNumberOfThreads(1)
    if case.lines:
        of["Delaunay"].SetSourceData(meshes.lines(*case.lines))
    if case.rings:
        of["Trim"].SetBoundaryData(meshes.rings(case.rings))
    if case.areas:
        of["Fill"].SetAreasData(area_data(case))
    source.SetTrimOutward(row.filter == "Trim")
    source.SetFillHoles(row.filter == "Fill")
    source.SetHoleMemory(1e9)
    set_properties(row, of.get)
    return source


def pieces_made(source, row, case, parts, pieces, count, is_over):
    """What those pieces of a source have, where parts [(number, of how many)] of the points are added.

    is_over  is_over(messages) -> whether to ask for no more
    """
    messages, made = noted(source), []
    all(source.AddPoints(part_of(case, *part)) for part in parts)  # up to an error
    for piece in pieces:
        if is_over(messages):
            break
        source.UpdatePiece(piece, count, 0)
        made.append(made_by([source], []))
        if row.filter != "Fill":
            del made[-1]["ports"][1:]
    made = made or [{"ports": [[]], "counts": {}, "messages": []}]
    made[0]["messages"] = messages
    return made


def has_error(messages):
    return any(event == "ErrorEvent" for event, _ in messages)


def in_pieces(row, case, parts, pieces, count, is_alone=False):
    """The same, of a source in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        source = piece_source(row, case, folder, is_alone)
        made = pieces_made(source, row, case, parts, pieces, count, has_error)
        source.Reset()
    return made
