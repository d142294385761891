# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""The reader and the whole chain as VTK algorithms, in a pipeline without ParaView."""

import os
import re
import sys
import tempfile
import unittest

import numpy
from vtkelevationsurface import read, reconstruct, vtkGridDelaunay2D
from vtkelevationsurface.block_reports import CONTENTS, RECOGNISED
from vtkelevationsurface.algorithms import ElevationPoints, ReconstructElevationSurface
from vtkelevationsurface.blocks import parts_of
from vtkelevationsurface.clouds import add_words
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_STRING, vtkOutputWindow, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import (
    vtkImageData,
    vtkMultiBlockDataSet,
    vtkMultiPieceDataSet,
    vtkMutableDirectedGraph,
    vtkPartitionedDataSet,
    vtkPartitionedDataSetCollection,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkTable,
)
from vtkmodules.vtkFiltersSources import vtkRegularPolygonSource


def errors_of(algorithm, event="ErrorEvent"):
    errors = []

    def note(_caller, _event, text):
        errors.append(text)

    note.CallDataType = VTK_STRING
    tag = algorithm.AddObserver(event, note)
    algorithm.Update()
    algorithm.RemoveObserver(tag)
    return errors


def points(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def table_of(**columns):
    table = vtkTable()
    for name, values in columns.items():
        if isinstance(values[0], str):
            array = vtkStringArray()
            for word in values:
                array.InsertNextValue(word)
        else:
            array = numpy_to_vtk(numpy.asarray(values), deep=True)
        array.SetName(name)
        table.AddColumn(array)
    return table


GRID = numpy.mgrid[0:6, 0:5].reshape(2, -1).astype(float)


class Algorithms(unittest.TestCase):
    def setUp(self):
        vtkOutputWindow.GetInstance().SetDisplayModeToNever()  # what the algorithms print

    def test_a_pipeline_is_read_and_reconstruct(self):
        path = os.path.join(sys.argv[sys.argv.index("-D") + 1], "aegean_sea.csv")
        reader, chain = ElevationPoints(), ReconstructElevationSurface()
        reader.SetFileName(path)
        chain.SetInputConnection(0, reader.GetOutputPort())
        chain.SetInterpolation("membrane")
        self.assertEqual(errors_of(chain), [])
        expected = reconstruct(read(path), interpolation="membrane")
        surface = chain.GetOutputDataObject(0)
        xyz, triangles = expected.to_numpy()
        numpy.testing.assert_array_equal(points(surface), xyz)
        ids = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
        numpy.testing.assert_array_equal(ids.reshape(-1, 3), triangles)
        self.assertIn("4,650 read", chain.GetReport())
        self.assertGreater(chain.GetOutputDataObject(3).GetNumberOfRows(), 5)

    def test_changed_properties_run_from_their_own_step_and_give_what_a_new_chain_gives(self):
        random = numpy.random.default_rng(11)
        xyz = random.uniform(0, 40, (900, 3)) * [1, 1, 0.1]
        xyz = xyz[numpy.hypot(xyz[:, 0] - 20, xyz[:, 1] - 15) > 5]
        cloud, boundary = vtkPolyData(), vtkPolyData()
        cloud.SetPoints(vtkPoints())
        cloud.GetPoints().SetData(numpy_to_vtk(xyz, deep=True))
        outline = vtkRegularPolygonSource()
        outline.SetRadius(17)
        outline.SetCenter(20, 20, 0)
        outline.SetNumberOfSides(50)
        outline.Update()
        boundary.ShallowCopy(outline.GetOutput())
        changes = [
            ("SetMaximumEdgeLength", [0.0, 6.0], "Triangulating"),
            ("SetGapTolerance", [0.0, 6.0], "Trimming"),
            ("SetOpenEdgeLength", [-1, 0.0, 5.0], "Filling holes"),
            ("SetInterpolation", [0, 1], "Filling holes"),
            ("SetSpacing", [0.0, 0.7], "Filling holes"),
            ("SetTrim", [True, False], "Trimming"),
            ("SetFillHoles", [True, False], "Filling holes"),
            ("SetMaximumHoleSize", [0.0, 5.0], "Filling holes"),
            ("SetMaximumElevationError", [0.0, 1.0], "Triangulating"),
            ("SetRemoveUnusedPoints", [True, False], "Measuring"),
            ("boundary", [None, boundary], "Trimming"),
            ("points", [None], "Triangulating"),
        ]
        order = ["Triangulating", "Trimming", "Filling holes", "Measuring"]
        values, kept, ran = {}, ReconstructElevationSurface(), []

        def note(caller, _event):
            ran.append(caller.GetProgressText())

        def apply(chain):
            chain.SetInputDataObject(0, cloud)
            for name, value in values.items():
                if name == "boundary":
                    chain.SetInputDataObject(1, value)
                elif name != "points":
                    getattr(chain, name)(value)
            chain.Update()
            return [self.contents(chain.GetOutputDataObject(port)) for port in range(3)] + [
                re.sub(r"(?m)^  time .*$", "", chain.GetReport())]

        kept.AddObserver("ProgressEvent", note)
        apply(kept)
        for _ in range(60):
            name, choices, first = changes[random.integers(len(changes))]
            value = choices[random.integers(len(choices))]
            if name == "points":
                cloud.GetPoints().SetPoint(random.integers(len(xyz)), random.uniform(0, 30, 3))
                cloud.GetPoints().Modified()
            elif values.get(name, choices[0]) == value:
                continue
            values[name] = value
            kept.SetProgressText("")
            ran.clear()
            self.assertEqual(apply(kept), apply(ReconstructElevationSurface()), (name, values))
            # Few points within an error are chosen along an outline that is made anew.
            earlier = [] if values.get("SetMaximumElevationError") else order[: order.index(first)]
            self.assertEqual([words for words in ran if words in earlier], [], (name, values))

    def test_the_effective_spacing_is_that_of_the_triangles_between_lines(self):
        random = numpy.random.default_rng(3)
        x, y = numpy.repeat(numpy.arange(0, 100, 8.0), 100), numpy.tile(numpy.arange(100.0), 13)
        xy = numpy.column_stack((x, y)) + random.normal(0, 0.1, (len(x), 2))
        chain = ReconstructElevationSurface()
        data = vtkPolyData()
        data.SetPoints(vtkPoints())
        data.GetPoints().SetData(numpy_to_vtk(numpy.column_stack((xy, numpy.sin(xy[:, 0] / 9))), deep=True))
        chain.SetInputDataObject(data)
        chain.Update()
        surface = chain.GetOutputDataObject(0)
        fills = vtk_to_numpy(surface.GetCellData().GetArray("HoleId")) >= 0
        self.assertGreater(fills.sum(), 1000)
        corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)[fills]
        a, b, c = vtk_to_numpy(surface.GetPoints().GetData())[:, :2].astype("f8")[corners.T]
        u, v = b - a, c - a
        area = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).mean()
        self.assertAlmostEqual(chain.GetEffectiveSpacing() ** 2 * 3**0.5 / 4, area, delta=0.01 * area)

    def test_columns_of_tables_and_axes_of_grids_that_change_count(self):
        x, y = GRID
        table = table_of(x=x, y=y, z=x)
        axes = vtkRectilinearGrid()
        axes.SetDimensions(6, 5, 1)
        for setter, count in ((axes.SetXCoordinates, 6), (axes.SetYCoordinates, 5), (axes.SetZCoordinates, 1)):
            setter(numpy_to_vtk(numpy.arange(float(count)), deep=True))
        heights = numpy_to_vtk(numpy.arange(30.0), deep=True)
        heights.SetName("Height")
        axes.GetPointData().SetScalars(heights)
        for data, array, axis in ((table, table.GetColumnByName("z"), 2), (axes, axes.GetXCoordinates(), 0)):
            chain = ReconstructElevationSurface()
            chain.SetInputDataObject(0, data)
            chain.Update()
            array.SetValue(array.GetNumberOfValues() - 1, 5.5)
            array.Modified()
            chain.SetInterpolation("membrane")
            chain.Update()
            self.assertEqual(points(chain.GetOutputDataObject(0))[:, axis].max(), 5.5)

    def contents(self, data):
        """All that a surface holds, in words."""
        attributes = [data.GetPointData(), data.GetCellData(), data.GetFieldData()]
        arrays = [one.GetAbstractArray(i) for one in attributes for i in range(one.GetNumberOfArrays())]
        columns = {array.GetName(): [array.GetVariantValue(i).ToString()
                   for i in range(array.GetNumberOfValues())] for array in arrays}
        places = points(data).tolist() if data.GetPoints() else []
        cells = [vtk_to_numpy(cells.GetConnectivityArray()).tolist()
                 for cells in (data.GetVerts(), data.GetLines(), data.GetPolys())]
        return repr((places, cells, columns))

    def test_a_table_of_words_and_numbers(self):
        x, y = GRID
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(
            Name=[f"P{i}" for i in range(x.size)], Height=x + y, Northing=[str(v) for v in y], Easting=x))
        self.assertEqual(errors_of(chain), [])
        surface = chain.GetOutputDataObject(0)
        numpy.testing.assert_array_equal(points(surface), numpy.column_stack((x, y, x + y)))
        self.assertEqual(surface.GetPointData().GetAbstractArray("Name").GetValue(3), "P3")

    def test_null_values_of_tables_are_left_out_or_kept(self):
        x, y = GRID
        z = numpy.where(numpy.arange(x.size) == 7, -9999.0, x)
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(x=x, y=y, z=z))
        chain.Update()
        self.assertEqual(points(chain.GetOutputDataObject(0))[:, 2].min(), 0)
        self.assertIn("left out", chain.GetReport())
        chain.SetKeepNulls(True)
        chain.Update()
        self.assertEqual(points(chain.GetOutputDataObject(0))[:, 2].min(), -9999)

    def test_elevations_of_an_image_are_chosen(self):
        image = vtkImageData()
        image.SetDimensions(6, 5, 1)
        for name, factor in (("Top", 1.0), ("Base", 2.0)):
            array = numpy_to_vtk(factor * numpy.arange(30.0), deep=True)
            array.SetName(name)
            image.GetPointData().AddArray(array)
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, image)
        for name, highest in (("", 29), ("Base", 58)):
            chain.SetElevationArray(name)
            chain.Update()
            elevation = chain.GetOutputDataObject(0).GetPointData().GetScalars()
            self.assertEqual((elevation.GetName(), elevation.GetRange()[1]), ("Elevation", highest))

    def test_another_array_of_the_name_elevation_is_kept(self):
        x, y = GRID
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(x=x, y=y, z=x, Elevation=y))
        chain.SetColumns("x,y,z")
        chain.Update()
        data = chain.GetOutputDataObject(0).GetPointData()
        numpy.testing.assert_array_equal(vtk_to_numpy(data.GetArray("Elevation")), x)
        numpy.testing.assert_array_equal(vtk_to_numpy(data.GetArray("Elevation of the input")), y)

    def test_the_count_is_reported_as_that_of_the_file(self):
        for count, words in ((30, "note       f.xyz: 30 points\n"),
                             (24, "note       f.xyz: 30 points; this surface is of 24 points\n")):
            chain, data = ReconstructElevationSurface(), cloud(count)
            add_words(data.GetFieldData(), RECOGNISED, ["f.xyz: 30 points"])
            add_words(data.GetFieldData(), CONTENTS, ["points", "30"])
            chain.SetInputDataObject(0, data)
            self.assertEqual(errors_of(chain), [])
            self.assertIn(words, chain.GetReport())

    def test_rows_without_numbers_are_left_out_and_counted(self):
        with tempfile.TemporaryDirectory() as folder:
            name = os.path.join(folder, "p.xyz")
            for bad, words in (
                ("7 7 inf\n", "1 point with NaN or infinity left out"),
                ("7 7 nan\n8 -inf 7\n", "2 points with NaN or infinity left out"),
                ("7 7 -9999\n", "1 null value (z = -9999) left out"),
            ):
                with open(name, "w", encoding="utf-8") as stream:
                    numpy.savetxt(stream, numpy.column_stack([a.ravel() for a in (*GRID, GRID[0])]))
                    stream.write(bad)
                reader = ElevationPoints()
                reader.SetFileName(name)
                self.assertEqual(errors_of(reader), [])
                self.assertIn(words, reader.GetRecognised().split("\n"))
                self.assertEqual(reader.GetOutputDataObject(0).GetNumberOfPoints(), GRID[0].size)

    def test_an_array_elevation_of_words_is_kept(self):
        x, y = GRID
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(x=x, y=y, z=x, Elevation=["low"] * x.size))
        chain.SetColumns("x,y,z")
        self.assertEqual(errors_of(chain), [])
        data = chain.GetOutputDataObject(0).GetPointData()
        numpy.testing.assert_array_equal(vtk_to_numpy(data.GetArray("Elevation")), x)
        self.assertEqual(data.GetAbstractArray("Elevation of the input").GetValue(3), "low")

    def test_what_has_no_points_is_an_error(self):
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, vtkMutableDirectedGraph())
        for array in ("", "Depth"):
            chain.SetElevationArray(array)
            errors = errors_of(chain)
            self.assertEqual(len(errors), 1, errors)
            self.assertIn("a vtkMutableDirectedGraph has no points", errors[0])

    def test_depths_of_faults_are_turned_over_and_options_of_points_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "faults.txt")
            with open(path, "w", encoding="utf-8") as file:
                file.write("15 33 -18\n155 133 11\n")
            reader = ElevationPoints()
            reader.SetFileName(path)
            reader.SetContents(2)
            reader.SetDepth(True)
            self.assertEqual(errors_of(reader), [])
            self.assertEqual(points(reader.GetOutputDataObject(0))[:, 2].tolist(), [18.0, -11.0])
            for name, value, expected in (
                ("Columns", "1,2,4", "Columns"), ("NoData", "0", "No Data"), ("Band", 2, "Band"),
                ("Classes", "2", "Classes"), ("Layer", "a", "Layer"), ("KeepNulls", 1, "Keep Nulls"),
            ):
                getattr(reader, "Set" + name)(value)
                self.assertIn(f"{expected}: of points only", " ".join(errors_of(reader)))
                getattr(reader, "Set" + name)(type(value)())
            reader.SetContents(0)
            for name, value, expected in (
                ("Classes", "2-5", "Classes takes numbers from 0 to 255, as 2,8"),
                ("Band", -1, "Band takes a number from 1, not -1"),
            ):
                getattr(reader, "Set" + name)(value)
                self.assertIn(expected, " ".join(errors_of(reader)))
                getattr(reader, "Set" + name)(type(value)())

    def test_several_heights_are_reported_and_chosen_by_a_column(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "horizons.csv")
            with open(path, "w", encoding="utf-8") as file:
                file.write("name,x,y,z\n")
                file.writelines(f"{name},{x},{y},{z}\n" for name, z in (("Top", 1), ("Base", 90))
                                for x in range(6) for y in range(6))
            reader = ElevationPoints()
            reader.SetFileName(path)
            chain = ReconstructElevationSurface()
            chain.SetInputConnection(0, reader.GetOutputPort())
            errors = " ".join(errors_of(chain))
            self.assertIn("36 of 36 places have several heights, up to 89 apart", errors)
            chain.SetDuplicates("keep-highest")  # as a panel does, which has always one of them
            self.assertEqual(errors_of(chain), [])
            expected = "36 places have several heights, up to 89 apart: the highest"
            self.assertIn(expected, chain.GetReport())
            reader.SetWhere("name=Base")
            self.assertEqual(errors_of(chain), [])
            self.assertNotIn("several heights", chain.GetReport())
            self.assertEqual(set(points(reader.GetOutputDataObject(0))[:, 2]), {90.0})
            reader.SetWhere("Base")
            self.assertIn("Where takes COLUMN=VALUE", " ".join(errors_of(reader)))

    def test_columns_are_of_tables_and_arrays_of_others(self):
        x, y = GRID
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(x=x, y=y, z=x + y, amp=x))
        chain.SetElevationArray("amp")
        self.assertIn("Columns chooses z", " ".join(errors_of(chain)))
        chain.SetElevationArray("")
        self.assertEqual(errors_of(chain), [])
        of_points = ReconstructElevationSurface()
        of_points.SetInputDataObject(0, chain.GetOutputDataObject(0))
        of_points.SetColumns("x,y,z")
        self.assertIn("Columns is for tables", " ".join(errors_of(of_points)))

    def test_rows_of_a_table_without_numbers_are_left_out(self):
        x, y = GRID
        z = [str(v) for v in x]
        z[3], z[8], z[9] = "N/A", "", "nan"
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(x=x, y=y, z=z))
        self.assertEqual(errors_of(chain), [])
        self.assertIn("27 read; 3 rows without numbers left out", chain.GetReport())
        z[3] = "high"
        chain.SetInputDataObject(0, table_of(x=x, y=y, z=z))
        self.assertIn("row 3 of column z is not a number: high", " ".join(errors_of(chain)))

    def test_depths_and_null_values_of_a_table_are_set_by_options(self):
        x, y = GRID
        depth = numpy.where(numpy.arange(x.size) % 7, 1000 + x, 0)
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(X=x, Y=y, Depth=depth))
        self.assertEqual(errors_of(chain), [])
        self.assertIn("Depth turns it over", chain.GetReport())
        self.assertIn("No Data 0", chain.GetReport())
        chain.SetDepth(1)
        chain.SetNoData("0")
        self.assertEqual(errors_of(chain), [])
        z = points(chain.GetOutputDataObject(0))[:, 2]
        self.assertEqual((z.max(), z.min()), (-1000, -1005))
        self.assertNotIn("upside down", chain.GetReport())
        chain.SetNoData("none")
        self.assertIn("No Data takes a number, not 'none'", " ".join(errors_of(chain)))

    def test_an_array_of_words_is_not_an_elevation(self):
        chain, data = ReconstructElevationSurface(), cloud()
        for array in table_of(s=["a"] * 30, h=numpy.arange(30.0), v=numpy.ones((30, 3))).GetRowData(),:
            for i in range(3):
                data.GetPointData().AddArray(array.GetAbstractArray(i))
        chain.SetInputDataObject(0, data)
        for name, expected in (("s", "point array s holds words"), ("v", "is not a single number"), ("w", "named w")):
            chain.SetElevationArray(name)
            errors = errors_of(chain)
            self.assertIn(expected, errors[0])
            self.assertIn("; there are: h ", errors[0] + " ")

    def test_a_boundary_is_not_a_cloud(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ring.txt")
            with open(path, "w", encoding="utf-8") as file:
                file.write("0 0\n9 0\n9 9\n0 9\n0 0\n")
            reader, chain = ElevationPoints(), ReconstructElevationSurface()
            reader.SetFileName(path)
            reader.SetContents(1)
            chain.SetInputConnection(0, reader.GetOutputPort())
            errors = errors_of(chain)
            self.assertEqual(len(errors), 1, errors)
            self.assertIn("the input is a boundary, which has no elevations", errors[0])

    def test_a_stop_leaves_nothing_however_late(self):
        reader, chain, filtered = ElevationPoints(), ReconstructElevationSurface(), vtkGridDelaunay2D()
        reader.SetFileName(os.path.join(sys.argv[sys.argv.index("-D") + 1], "aegean_sea.csv"))
        chain.SetInputConnection(0, reader.GetOutputPort())
        filtered.SetInputConnection(0, reader.GetOutputPort())
        for algorithm in (reader, chain, filtered):
            algorithm.Update()
            whole = algorithm.GetOutputDataObject(0).GetNumberOfPoints()
            for share in (0.0, 0.6, 0.97):
                with self.subTest(algorithm=type(algorithm).__name__, share=share):
                    def stop(caller, _event):
                        if caller.GetProgress() >= share:
                            caller.SetAbortExecute(1)

                    tag = algorithm.AddObserver("ProgressEvent", stop)
                    algorithm.Modified()
                    errors_of(algorithm, "WarningEvent")
                    algorithm.RemoveObserver(tag)
                    self.assertEqual(algorithm.GetOutputDataObject(0).GetNumberOfPoints(), 0)
                    algorithm.SetAbortExecute(0)
                    algorithm.Modified()
                    algorithm.Update()
                    self.assertEqual(algorithm.GetOutputDataObject(0).GetNumberOfPoints(), whole)

    def test_errors_are_one_line(self):
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, table_of(a=["x"], b=["y"], c=["z"]))
        for wrong in (chain, ElevationPoints()):
            errors = errors_of(wrong)
            self.assertEqual(len(errors), 1, errors)
            self.assertNotIn("\n", errors[0])
            self.assertNotIn("should not happen", errors[0])
            self.assertEqual(wrong.GetOutputDataObject(0).GetNumberOfPoints(), 0)


def composites():
    """{what it is: composite input}; blocks of two points do not make a surface."""
    nested = blocks(None, blocks(cloud(2), None, cloud(), name="south"), cloud(2), name="north")
    pieces = vtkMultiPieceDataSet()
    pieces.SetPiece(0, cloud(2))
    pieces.SetPiece(1, cloud())
    partitions = vtkPartitionedDataSet()
    for i in range(3):
        partitions.SetPartition(i, cloud(2 if i == 1 else 25 + i))
    collection = vtkPartitionedDataSetCollection()
    for i, counts in enumerate(((30, 2), (2,))):
        collection.SetPartitionedDataSet(i, vtkPartitionedDataSet())
        for k, count in enumerate(counts):
            collection.GetPartitionedDataSet(i).SetPartition(k, cloud(count))
    collection.GetMetaData(1).Set(collection.NAME(), "east")
    return {
        "nested": nested,
        "empty blocks": blocks(cloud(), vtkPolyData(), cloud(2), name="west"),
        "pieces": blocks(pieces, cloud(2), name="first"),
        "partitions": partitions,
        "collection": collection,
    }


def cloud(count=30):
    data = vtkPolyData()
    data.SetPoints(vtkPoints())
    for i in range(count):
        data.GetPoints().InsertNextPoint(i % 6, i // 6, 0.1 * i)
    return data


def blocks(*parts, name):
    """A multiblock whose last block has the name."""
    data = vtkMultiBlockDataSet()
    for i, part in enumerate(parts):
        data.SetBlock(i, part)
    data.GetMetaData(len(parts) - 1).Set(data.NAME(), name)
    return data


def leaves(data):
    """(flat index, points, cells) of each data set of a composite."""
    places, found = data.NewIterator(), []
    places.InitTraversal()
    while not places.IsDoneWithTraversal():
        leaf = places.GetCurrentDataObject()
        found.append((places.GetCurrentFlatIndex(), leaf.GetNumberOfPoints() if leaf.GetNumberOfPolys() else 0,
                      leaf.GetNumberOfPolys()))
        places.GoToNextItem()
    return found


class Composites(unittest.TestCase):
    """The chain and the filters name blocks alike, and a block that fails leaves the others."""

    def setUp(self):
        vtkOutputWindow.GetInstance().SetDisplayModeToNever()

    def test_blocks_are_those_of_the_filters(self):
        for what, data in composites().items():
            with self.subTest(what):
                chain, filtered = ReconstructElevationSurface(), vtkGridDelaunay2D()
                chain.SetTrim(False)
                chain.SetFillHoles(False)
                names = []
                for algorithm, event in ((chain, "ErrorEvent"), (filtered, "WarningEvent")):
                    algorithm.SetInputDataObject(0, data)
                    errors = errors_of(algorithm, event)
                    self.assertEqual(len(errors), 1, errors)
                    names.append(re.findall(r"((?:Block|Partition) [^:\n]*): ", errors[0]))
                self.assertEqual(*names)
                self.assertEqual(len(names[0]), 1 + (what in ("nested", "pieces", "collection")))
                surfaces = chain.GetOutputDataObject(0)
                self.assertEqual(leaves(surfaces), leaves(filtered.GetOutputDataObject(0)))
                self.assertGreater(sum(cells for _, _, cells in leaves(surfaces)), 0)
                self.assertEqual(surfaces.GetClassName(), data.GetClassName())

    def test_blocks_without_points_are_left_out(self):
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, blocks(cloud(), vtkPolyData(), None, cloud(), name="north"))
        self.assertEqual(errors_of(chain), [])
        self.assertIn("all blocks:\npoints     60 read", chain.GetReport())
        self.assertIn('Block 3 ("north"):\n', chain.GetReport())
        chain.SetInputDataObject(0, blocks(vtkPolyData(), None, name="none"))
        errors = errors_of(chain)
        self.assertEqual(len(errors), 1)
        self.assertIn("the input has no points", errors[0])

    def test_an_error_common_to_all_blocks_is_reported_once(self):
        chain = ReconstructElevationSurface()
        chain.SetInputDataObject(0, blocks(cloud(), cloud(), name="north"))
        chain.SetSpacing(-1)
        errors = errors_of(chain)
        self.assertEqual(len(errors), 1)
        self.assertNotIn("Block", errors[0])

    def test_pieces_of_a_block_are_one_surface_on_ranks(self):
        pieces = vtkMultiPieceDataSet()
        pieces.SetPiece(0, cloud())
        pieces.SetPiece(1, cloud())
        parts = parts_of(blocks(pieces, cloud(), name="alone"))
        self.assertEqual([part.surface for part in parts], [(0,), (0,), (1,)])
        self.assertEqual([part.block for part in parts], ["Block 0", "Block 0", 'Block 1 ("alone")'])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
