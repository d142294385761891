# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The program in the processes of this test, which are its ranks: the surface that it writes has the arrays, of
the same types, that it has on one. Run by mpirun.
"""

import os
import shutil
import tempfile

import meshes
import numpy
from on_ranks import RANK, RANKS, check, check_equal, end, gather
from vtkelevationsurface.command import main as program
from vtkelevationsurface.ranks import packed, unpacked
from vtkelevationsurface.reading.vtk_files import run_vtk_reader
from vtkelevationsurface.writing import write_surface
from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray, vtk_to_numpy

RANDOM = numpy.random.default_rng(4)
XYZ = RANDOM.uniform(0.0, 30.0, (600, 3))
XYZ = XYZ[numpy.hypot(XYZ[:, 0] - 12.0, XYZ[:, 1] - 14.0) > 5.0]


def points(have_ids):
    """Points with numbers of wells, and perhaps with global ids."""
    wells = numpy_to_vtkIdTypeArray(2**35 + numpy.arange(len(XYZ)), deep=True)
    wells.SetName("Well")
    data = meshes.cloud(XYZ, 2**34 + 3 * numpy.arange(len(XYZ)) if have_ids else None, [("Value", 2.0 * XYZ[:, 2])])
    data.GetPointData().AddArray(wells)
    return data


def arrays_of(data):
    """{(kind of data, name): (type, number of components, sorted values)} and which array has global ids."""
    found = {}
    for kind in ("PointData", "CellData", "FieldData"):
        attributes = getattr(data, "Get" + kind)()
        for i in range(attributes.GetNumberOfArrays()):
            array = attributes.GetAbstractArray(i)
            values = numpy.sort(vtk_to_numpy(array), axis=0).tolist() if hasattr(array, "GetTuple1") else None
            if array.GetName() != "HoleId":  # numbers of holes follow the order of triangles
                found[kind, array.GetName()] = (array.GetDataTypeAsString(), array.GetNumberOfComponents(), values)
    ids = data.GetPointData().GetGlobalIds()
    return found, ids and ids.GetName()


def written(folder, name, ranks, *arguments):
    """The arrays of what the program writes, on the first rank."""
    path = os.path.join(folder, "surface.vtp")
    code = program([os.path.join(folder, name), "--no-picture", "--quiet", "-o", path, *arguments], ranks)
    check_equal(code, 0, "the exit code, " + name)
    return None if RANK else arrays_of(run_vtk_reader(path))


def check_same(folder, name, *arguments):
    found = written(folder, name, RANKS, *arguments)
    if RANK == 0:
        (arrays, ids), (expected, expected_ids) = found, written(folder, name, None, *arguments)
        check_equal(arrays.keys(), expected.keys(), "names of arrays, " + name)
        for array in expected.keys() & arrays.keys():
            check_equal(arrays[array], expected[array], "%s, %s" % (array, name))
        check_equal(ids, expected_ids, "global ids, " + name)
        check(("FieldData", "NumberOfOutwardTriangles") in expected, "there are counts, " + name)
    gather(None)  # all wait for the first


def main():
    data = points(True)
    check_equal(arrays_of(unpacked(packed(data))), arrays_of(data), "ids of data that have been sent")
    folder = gather(tempfile.mkdtemp() if RANK == 0 else None)[0]
    for name, have_ids in (("wells.vtp", False), ("ids.vtp", True)):
        if RANK == 0:
            write_surface(points(have_ids), os.path.join(folder, name))
        check_same(folder, name)
    if RANK == 0:
        shutil.rmtree(folder)
    return "the program"


if __name__ == "__main__":
    end(main())
