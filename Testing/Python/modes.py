# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The rows of features.py, run in each mode: what they work on, how they are run, and what came out.

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
    vtkReconstructPieces,
    vtkTrimOutwardTriangles,
)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import (
    vtkMultiBlockDataSet,
    vtkPartitionedDataSet,
    vtkPartitionedDataSetCollection,
    vtkPointSet,
    vtkPolyData,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkCommonExecutionModel import vtkPolyDataAlgorithm

import meshes

FILTERS = {
    "Delaunay": vtkGridDelaunay2D, "Trim": vtkTrimOutwardTriangles, "Fill": vtkFillElevationHoles,
}
DIFFERENT = 1e-9  # of z and values of points that are inserted, which follow the order of sums

# ---- what rows work on ----------------------------------------------------------------------------


def case_of(xyz, **more):
    """Points; each has its number as a value, so that points at one place can be told apart."""
    case = types.SimpleNamespace(
        xyz=xyz, arrays={"Number": numpy.arange(float(len(xyz)))}, roles={}, lines=None, rings=None,
        triangles=None, cells={}, on_one=False, copies=False, composite=None, kind=vtkPolyData)
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
    """A cloud with a lake and a bay, and a few points beside."""
    xyz = away(scattered(random, count), (0.1, 0.0, 0.15), (-0.5, -0.1, 0.2))
    beside = scattered(random, 5) + (3.0 * numpy.sqrt(count), 0.0, 0.0)
    return case_of(numpy.vstack((xyz, beside)))


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
    """The part of each point (triangle): one after another; with global ids, in no order."""
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


# ---- what has come out ----------------------------------------------------------------------------


def numbers_of(array):
    """(n, k) numbers of an array: of words, their sums."""
    if isinstance(array, vtkStringArray):
        words = [array.GetValue(i) for i in range(array.GetNumberOfValues())]
        return numpy.array([[float(int.from_bytes(word.encode()[-6:], "big"))] for word in words]).reshape(-1, 1)
    values = vtk_to_numpy(array)
    return numpy.nan_to_num(values.reshape(len(values), -1).astype("f8"), nan=-1e99, posinf=1e98, neginf=-1e98)


def columns_of(attributes, count, without=()):
    """{name: (type, numbers)} of all arrays but marks, and the numbers that filters give points."""
    found = {}
    for i in range(attributes.GetNumberOfArrays()):
        array = attributes.GetAbstractArray(i)
        if array.GetName() not in (meshes.GHOSTS, "GlobalPointIds", *without):
            words = numbers_of(array) if count else numpy.zeros((0, array.GetNumberOfComponents()))
            found[array.GetName()] = (array.GetClassName(), words)
    return found


def row_of(columns, first):
    return numpy.column_stack([first, *(columns[name][1] for name in sorted(columns))])


def part_made(data):
    """What a part of an output has, as plain arrays."""
    count = data.GetNumberOfPoints()
    kinds, made = {}, {"triangles": numpy.zeros((0, 0)), "holes": numpy.zeros(0), "count": data.GetNumberOfPolys()}
    columns = columns_of(data.GetPointData(), count)
    rows = row_of(columns, numbers_of(data.GetPoints().GetData()) if count else numpy.zeros((0, 3)))
    made["points"] = rows[~meshes.ghosts_of(data)]
    cells = columns_of(data.GetCellData(), data.GetNumberOfCells(), ("HoleId",))
    if count:
        kinds = {"points": data.GetPoints().GetDataType()}
        kinds.update({"point " + name: kind for name, (kind, _) in columns.items()})
        kinds.update({"cell " + name: kind for name, (kind, _) in cells.items()} if data.GetNumberOfPolys() else {})
    made["kinds"] = kinds
    if data.GetNumberOfPolys():
        first = data.GetNumberOfVerts() + data.GetNumberOfLines()
        corners = meshes.turned(meshes.triangles_of(data), rows[:, :3])
        values = row_of(cells, numpy.zeros((data.GetNumberOfCells(), 0)))[first:]
        made["triangles"] = numpy.column_stack((rows[corners].reshape(len(corners), -1), values))
        holes = data.GetCellData().GetArray("HoleId")
        made["holes"] = vtk_to_numpy(holes)[first:].astype(int) if holes else numpy.full(len(corners), -1)
    fields = data.GetFieldData()
    unused = [fields.GetArray("UnusedPoint" + name) for name in ("Ids", "Reasons")]
    made["unused"] = numpy.zeros((0, 2))
    if all(unused) and unused[0].GetNumberOfTuples() and "Number" in columns:
        ids, reasons = (vtk_to_numpy(array) for array in unused)
        made["unused"] = numpy.column_stack((columns["Number"][1][ids], reasons))
    found = fields.GetArray("Lattice")
    made["lattice"] = [found.GetTuple(0)] if found else []
    made["report"] = report_of(data)
    return made


REPORTED = ("Status", "NumberOfEdges", "Perimeter", "Area", "NumberOfInsertedPoints", "Interpolation")


def report_of(data):
    """[(number of the hole, what is told of it, its rim's points in one order)], or of rings the last."""
    cells, found = data.GetCellData(), []
    rows = numbers_of(data.GetPoints().GetData()) if data.GetNumberOfPoints() else None
    ids = cells.GetArray("HoleId")
    for i in range(data.GetNumberOfLines()):
        told = [cells.GetArray(name).GetValue(i) for name in REPORTED] if ids else []
        corners = data.GetCell(data.GetNumberOfVerts() + i).GetPointIds()
        rim = [tuple(rows[corners.GetId(k)]) for k in range(corners.GetNumberOfIds() - 1)]
        found.append((ids.GetValue(i) if ids else i, (*told, *sorted(rim))))
    return found


def leaves(output):
    """The data sets of an output, in order."""
    if isinstance(output, vtkPointSet):
        return [output]
    each, found = output.NewIterator(), []
    each.InitTraversal()
    while not each.IsDoneWithTraversal():
        found.append(each.GetCurrentDataObject())
        each.GoToNextItem()
    return found


def own_names(algorithm, verb):
    """Of the methods that a filter's own class has, those of a verb, without it."""
    return {name[len(verb) :] for name in dir(algorithm)
            if name.startswith(verb) and not hasattr(vtkPolyDataAlgorithm, name)}


GETTERS = ("NumberOf", "LargestElevationError", "EffectiveGapTolerance", "LatticeFound")


def counts_of(*algorithms):
    """{name: value} of what filters count."""
    return {name: getattr(algorithm, "Get" + name)() for algorithm in algorithms
            for name in sorted(own_names(algorithm, "Get"))
            if name.startswith(GETTERS) and not name.startswith("NumberOfThreads")}


def made_by(algorithms, messages):
    """What the last filter of a chain has made on this rank."""
    last = algorithms[-1]
    ports = [[part_made(data) for data in leaves(last.GetOutputDataObject(port))]
             for port in range(last.GetNumberOfOutputPorts())]
    return {"ports": ports, "counts": counts_of(*algorithms), "messages": messages}


def joined(parts, are_in_order=False):
    """What parts of one surface have together. All tell the same counts.

    are_in_order  whether the order of points and triangles counts, too
    """
    whole = {"counts": parts[0]["counts"], "messages": [told for part in parts for told in part["messages"]],
             "alike": all(part["counts"] == parts[0]["counts"] for part in parts), "ports": []}
    whole["shares"] = [sum(block["count"] for block in part["ports"][0]) for part in parts]
    for port in range(min(len(part["ports"]) for part in parts)):
        blocks = []
        for index in range(max(len(part["ports"][port]) for part in parts)):
            each = [part["ports"][port][index] for part in parts if index < len(part["ports"][port])]
            block = {}
            for name in ("points", "triangles", "unused"):
                rows = [one[name] for one in each if len(one[name])]
                widths = {one.shape[1] for one in rows}
                block[name] = numpy.vstack(rows) if len(widths) == 1 else numpy.zeros((len(rows), 0))
            block["holes"] = numpy.concatenate([one["holes"] for one in each])
            block["report"] = [told for one in each for told in one["report"]]
            block["lattice"] = sorted({told for one in each for told in one["lattice"] if port == 0})
            block["kinds"] = {}
            for one in each:
                for name, kind in one["kinds"].items():
                    block["kinds"].setdefault(name, set()).add(kind)
            blocks.append(block)
        whole["ports"].append(blocks)
    # Holes have numbers by the order of triangles; here, by what is told of them.
    for block, told in zip(whole["ports"][0], whole["ports"][1] if len(whole["ports"]) == 2 else []):
        order = sorted(told["report"], key=lambda one: one[1])
        place = {number: i for i, (number, _) in enumerate(order)}
        block["holes"] = numpy.array([place.get(number, -1) for number in block["holes"].tolist()], float)
        if len(block["triangles"]):
            block["triangles"] = numpy.column_stack((block["triangles"], block["holes"]))
    for blocks in whole["ports"]:
        for block in blocks:
            block["report"] = [told for _, told in sorted(block["report"], key=lambda one: one[1])]
            del block["holes"]
            for name in ("points", "triangles", "unused") if not are_in_order else ():
                block[name] = meshes.sorted_rows(block[name])
    return whole


def difference(found, expected):
    """What differs first, in words, or ""."""
    if found["messages"] != expected["messages"]:
        return "messages %s, not %s" % (found["messages"], expected["messages"])
    if not found["alike"]:
        return "counts differ by part"
    for name, value in found["counts"].items():
        if expected["counts"].get(name, value) != value:
            return "%s: %s, not %s" % (name, value, expected["counts"][name])
    for port, (blocks, wanted) in enumerate(zip(found["ports"], expected["ports"])):
        if len(blocks) != len(wanted):
            return "%d blocks, not %d" % (len(blocks), len(wanted))
        for block, right in zip(blocks, wanted):
            for name, value in right.items():
                mine = block[name]
                if isinstance(value, numpy.ndarray):
                    if mine.shape != value.shape and (len(mine) or len(value)):
                        return "output %d: %s %s, not %s" % (port, name, mine.shape, value.shape)
                    if len(mine) and not numpy.array_equal(mine, value):
                        return "output %d: %s differ by %g" % (port, name, numpy.nanmax(abs(mine - value)))
                elif mine != value:
                    return "output %d: %s %s, not %s" % (port, name, str(mine)[:300], str(value)[:300])
    return ""


# ---- modes ----------------------------------------------------------------------------------------


def set_properties(row, of):
    """of(name) -> the filter. A property is of the row's filter, or Filter.Property."""
    for name, value in row.properties.items():
        name = name if "." in name else row.filter + "." + name
        step, name = name.split(".")
        getattr(of(step), "Set" + name)(value)


def noted(*algorithms):
    """The list that gets the messages of filters, without their addresses."""
    messages = []

    def note(_caller, event, text):
        messages.append((event, text.split("): ", 1)[-1].strip()))

    note.CallDataType = "string0"
    for algorithm in algorithms:
        algorithm.AddObserver("ErrorEvent", note)
        algorithm.AddObserver("WarningEvent", note)
    return messages


def chain(row, case, data, threads, has_second=True):
    """{name: filter}: those up to the row's."""
    steps = {name: make() for name, make in FILTERS.items()}
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


def has_pieces(row, case):
    """Whether vtkReconstructPieces can be asked for it: it takes points, and no outline is extracted."""
    return case.triangles is None and not case.composite and (row.filter != "Trim" or bool(case.rings))


def in_pieces(row, case, parts, pieces, count):
    """What those pieces have, where parts [(number, of how many)] of the points are added."""
    source = vtkReconstructPieces()
    of = {name: getattr(source, "Get" + name)() for name in FILTERS}
    for algorithm in of.values():
        algorithm.SetNumberOfThreads(1)
    if case.lines:
        of["Delaunay"].SetSourceData(meshes.lines(*case.lines))
    if case.rings:
        of["Trim"].SetBoundaryData(meshes.rings(case.rings))
    source.SetFillHoles(row.filter == "Fill")
    set_properties(row, of.get)
    messages, made = noted(source), []
    with tempfile.TemporaryDirectory() as folder:
        source.SetFolder(folder)
        is_added = all(source.AddPoints(part_of(case, *part)) for part in parts)
        for piece in pieces if is_added else ():
            source.UpdatePiece(piece, count, 0)
            made.append(made_by([source], []))
            if row.filter != "Fill":
                del made[-1]["ports"][1:]
            if any(event == "ErrorEvent" for event, _ in messages):
                break
        source.Reset()
    made = made or [{"ports": [[]], "counts": {}, "messages": []}]
    made[0]["messages"] = messages
    return made
