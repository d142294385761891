# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Elevation Points reads any file of points, and reports what it recognised, or why it cannot, once."""
import os

import numpy
from paraview import servermanager, simple

from plugin_testing import (array, check, check_equal, fetch, finish, information, messages_of,
                            points, start)

data_folder, temporary_folder = start()


def written(name, text):
    path = os.path.join(os.path.abspath(temporary_folder), name)
    with open(path, "w", encoding="utf-8") as stream:
        stream.write(text)
    return path


# ---- a file, opened as in the client -----------------------------------------------------------
olinda = os.path.join(data_folder, "olinda_land.xyz")
check_equal(type(simple.OpenDataFile(olinda)).__name__, "ElevationPoints", "reader of olinda_land.xyz")
factory = servermanager.vtkSMProxyManager.GetProxyManager().GetReaderFactory()
session = servermanager.ActiveConnection.Session


def readers_of(suffix):
    """The labels of the readers that ParaView offers for a file, in their order."""
    found = factory.GetReaders(written("reader." + suffix, "1 2 3\n4 5 6\n7 8 10\n"), session)
    return [found.GetString(i) for i in range(2, found.GetNumberOfStrings(), 3)]


hints = servermanager.ProxyManager().GetPrototypeProxy("sources", "ElevationPointsReader").GetHints()
claimed = hints.FindNestedElementByName("ReaderFactory").GetAttribute("extensions").split()
for suffix in claimed:
    if suffix in ("xyz", "las"):
        check_equal(readers_of(suffix)[0], "Elevation Points", "first reader of ." + suffix)
    else:
        check_equal(readers_of(suffix), ["Elevation Points"], "readers of ." + suffix)
horizons = "irap gri cps cps3 ev zmap ts vs pl poi pol hzn hor ixyz iesx p190 str gsi".split()
check_equal(set(horizons) - set(claimed), set(), "names of horizons and survey lines that are not known")
for suffix in ("csv", "txt", "tsv", "dat", "pts", "tif", "dem", "shp", "vtp", "ply", "gz"):
    check("Elevation Points" not in readers_of(suffix), "." + suffix + " is left to ParaView's readers")
table = os.path.join(data_folder, "aegean_sea.csv")
check(fetch(simple.ElevationPoints(FileName=table)).GetNumberOfPoints() > 0, "text is read by choice")

reader = simple.ElevationPoints(FileName=olinda)
cloud = fetch(reader)
check_equal(cloud.GetNumberOfPoints(), 10266, "points of the file")
check_equal(cloud.GetNumberOfVerts(), 10266, "vertices, which make points visible")
check(numpy.array_equal(array(cloud.GetPointData(), "Elevation"), points(cloud)[:, 2]),
      "the array Elevation is z")
recognised = information(reader, "Recognised")
check("10,266 points" in recognised and "separated by blanks" in recognised,
      "the panel shows what was recognised: " + recognised)
words = cloud.GetFieldData().GetAbstractArray("Recognised")
lines = [words.GetValue(i) for i in range(words.GetNumberOfValues())]
check_equal("\n".join(lines), recognised, "the field array holds the same")
shown = simple.Show(reader, simple.CreateRenderView())
check_equal(list(shown.ColorArrayName), ["POINTS", "Elevation"], "what points are coloured by")

# ---- options -----------------------------------------------------------------------------------
table = written("columns.csv", "Top,Easting,Northing,Base\n" + "".join(
    f"{10 + i % 7},{500000 + 10 * (i % 20)},{4000000 + 10 * (i // 20)},{-9999 if i == 5 else i % 5}\n"
    for i in range(200)))
reader = simple.ElevationPoints(FileName=table, Columns="Easting,Northing,Base")
check_equal(fetch(reader).GetNumberOfPoints(), 199, "points without the null value")
check("null values" in information(reader, "Recognised"), "what was left out is reported, with its reason")
reader.KeepNulls = 1
check_equal(points(fetch(reader))[5].tolist(), [500050, 4000000, -9999], "a null value that is kept")
reader.Columns = "2,3,1"
check_equal(points(fetch(reader))[0].tolist(), [500000, 4000000, 10], "columns by number")
reader.Depth = 1
check_equal(points(fetch(reader))[0, 2], -10, "depths are turned over")
reader.NoData = "12"
check((points(fetch(reader))[:, 2] != -12).all(), "an elevation that marks missing data is left out")
reader.Columns, reader.NoData, reader.Depth = "", "", 0

# ---- wrong files and options: one error, in the words of the panel, and empty output ------------
for change, expected in (
    ({"Columns": "1,2,9"}, "there is no column 9"),
    ({"Columns": "1,2"}, "three names"),
    ({"Columns": "", "NoData": "none"}, "No Data takes a number"),
    ({"NoData": "", "Classes": "2"}, "Classes is for LAS files"),
    ({"Classes": "", "FileName": "/no/such/file.csv"}, "no such file"),
    ({"FileName": written("nothing.csv", "")}, "is empty"),
    ({"FileName": written("words.csv", "these are\nno numbers\n")}, "words.csv"),
):
    for name, value in change.items():
        setattr(reader, name, value)
    errors = messages_of(reader)
    check_equal(len(errors), 1, "number of errors with %r: %s" % (change, errors))
    check(errors and expected in errors[0] and "--" not in errors[0] and "\n" not in errors[0],
          "the error with %r does not say why: %s" % (change, errors))
    check_equal(fetch(reader).GetNumberOfPoints(), 0, "points with %r" % change)

# The chain does not report the cause again; nor does it after the user has stopped the reader.
chain = simple.ReconstructElevationSurface(Input=reader)
check_equal(messages_of(chain), [], "errors of the chain behind a reader that failed")
check("reader" in information(chain, "Report"), "the report says who has reported why")
reader.FileName = olinda
algorithm = reader.SMProxy.GetClientSideObject()
tag = algorithm.AddObserver("ProgressEvent", lambda caller, _: caller.SetAbortExecute(1))
check_equal(messages_of(reader), [], "errors when the user stops the reader")
algorithm.RemoveObserver(tag)
check_equal(fetch(reader).GetNumberOfPoints(), 0, "points when the user stops the reader")
check("stopped" in information(reader, "Recognised"), "the panel shows that the reader was stopped")
check_equal(messages_of(chain), [], "errors of the chain behind a reader that was stopped")
algorithm.Modified()
check_equal(fetch(chain).GetNumberOfPoints() > 10266, True, "the surface comes when the file is read")

# ---- the file has changed ----------------------------------------------------------------------
path = written("grows.xyz", "0 0 1\n1 0 2\n0 1 3\n")
reader.FileName = path
check_equal(messages_of(reader), [], "errors after the cause is gone")
check_equal(fetch(reader).GetNumberOfPoints(), 3, "points of the file as it was")
written("grows.xyz", "0 0 1\n1 0 2\n0 1 3\n1 1 4\n")
simple.ReloadFiles(reader)
check_equal(fetch(reader).GetNumberOfPoints(), 4, "points of the file that was read again")

# ---- a series of files -------------------------------------------------------------------------
paths = [written("series_%d.poi" % i, "0 0 %d\n1 0 2\n0 1 3\n" % (10 * i + 5) + "2 2 2\n" * i) for i in range(3)]
series = simple.OpenDataFile(paths)
check_equal(type(series).__name__, "ElevationPoints", "reader of a series")
check_equal(list(series.TimestepValues), [0, 1, 2], "time steps of a series")
chain = simple.ReconstructElevationSurface(Input=series)
for time, step in ((2, 2), (0, 0), (1, 1), (1.5, 1), (7, 2)):
    chain.UpdatePipeline(time)
    cloud = series.SMProxy.GetClientSideObject().GetOutputDataObject(0)
    check_equal((cloud.GetNumberOfPoints(), points(cloud)[0, 2]), (3 + step, 10 * step + 5), "points at %g" % time)
    check(paths[step] in information(series, "Recognised"), "the file at %g" % time)
    surface = chain.SMProxy.GetClientSideObject().GetOutputDataObject(0)
    check_equal(surface.GetPoint(0)[2], 10 * step + 5, "the surface at %g" % time)
check_equal(list(simple.ElevationPoints(FileName=paths[0]).TimestepValues or []), [], "time steps of one file")

# ---- boundaries and faults ---------------------------------------------------------------------
ring = written("ring.txt", "0 0\n4 0\n4 4\n0 0\n\n1 1\n2 1\n2 2\n1 1\n")
boundary = fetch(simple.ElevationPoints(FileName=ring, Contents="Boundary"))
check_equal(boundary.GetNumberOfLines(), 2, "rings of a boundary")
faults = fetch(simple.ElevationPoints(FileName=written("faults.txt", "0 0 1\n1 2 1\n4 4 2\n"),
                                      Contents="Faults"))
check_equal((faults.GetNumberOfLines(), faults.GetNumberOfPoints()), (1, 3), "a fault and its points")

# ---- rasters -----------------------------------------------------------------------------------
grid = simple.ElevationPoints(FileName=written(
    "grid.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -1\n"
                "1 2 3\n4 -1 6\n"))
try:
    from osgeo import gdal  # noqa: F401
except ImportError:
    errors = messages_of(grid)
    check(len(errors) == 1 and "python3-gdal" in errors[0],
          "what is missing for rasters is not reported: %s" % errors)
else:
    check_equal(fetch(grid).GetNumberOfPoints(), 5, "pixels with data")

finish()
