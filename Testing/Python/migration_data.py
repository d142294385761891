# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the rows of Documentation/Migration.md work on, and what tests ask of their results."""

import re
import struct

import numpy
from osgeo import gdal, ogr

import meshes
from meshes import triangles_of as triangles

gdal.UseExceptions()
ogr.UseExceptions()
SIZE, VOID = 100.0, 12.0
STEP, KNOWN = 10.0, (50, 60)  # of dem.tif: pixel, rows and columns


def cloud():
    """Random points around a void, on hills; then one with the x,y of point 0, one near point 1."""
    numbers = numpy.random.RandomState(7)
    xy = numbers.rand(1500, 2) * SIZE
    xy = xy[numpy.hypot(*(xy - SIZE / 2).T) > VOID]
    xy = numpy.vstack((xy, xy[0], xy[1] + 0.05))
    z = 3 * numpy.sin(xy[:, 0] / 20) + xy[:, 1] / 25
    z[-2] -= 1
    return numpy.column_stack((xy, z))


XYZ = cloud()
CORNERS = [int(numpy.hypot(*(XYZ[:-2, :2] - corner).T).argmin())
           for corner in ((20, 20), (32, 22), (30, 32), (18, 30))]


def data(**cells):
    """vtkPolyData with the points of the cloud, and Lines or Polys of ids."""
    result = meshes.cloud(XYZ)
    for kind, ids in cells.items():
        getattr(result, "Set" + kind)(meshes.cells_of([ids]))
    return result


def corners(surface):
    """(n, 3, 2): x,y of the corners of triangles"""
    return meshes.points_of(surface)[:, :2][triangles(surface)]


def area(surface):
    a, b, c = corners(surface).swapaxes(0, 1)
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    return 0.5 * float(abs(ux * vy - uy * vx).sum())


def lengths(surface):
    """(n, 3): of edges, on the map"""
    xy = corners(surface)
    return numpy.linalg.norm(xy - numpy.roll(xy, 1, axis=1), axis=2)


def edges(surface):
    return {tuple(sorted(t[[i, i - 1]])) for t in triangles(surface) for i in range(3)}


def ring_area(xy):
    x, y = xy.T
    return 0.5 * abs(float(x @ numpy.roll(y, 1) - y @ numpy.roll(x, 1)))


# ---- files that the commands read and write -------------------------------------------------------


def pixels(path, band=1):
    """(rows, columns), NaN where there are no data, and the transform of a raster."""
    raster = gdal.Open(path)
    one = raster.GetRasterBand(band)
    values = one.ReadAsArray().astype("f8")
    none = one.GetNoDataValue()
    if none is not None:
        values[values == none] = numpy.nan
    return values, raster.GetGeoTransform()


def features_of(path):
    """The number of features in the first layer."""
    source = ogr.Open(path)
    return source.GetLayer().GetFeatureCount()


def faces_of(path):
    """The number of triangles in the head of a PLY file."""
    with open(path, "rb") as file:
        return int(re.search(rb"element face (\d+)", file.read(2000)).group(1))


def write_vectors(path, geometries, **fields):
    layer_type = {"POINT": ogr.wkbPoint25D, "LINES": ogr.wkbLineString25D, "POLYG": ogr.wkbPolygon}
    source = ogr.GetDriverByName("GPKG").CreateDataSource(path)
    layer = source.CreateLayer("all", None, layer_type[geometries[0][:5]])
    for name in fields:
        layer.CreateField(ogr.FieldDefn(name, ogr.OFTReal))
    layer.StartTransaction()
    for i, geometry in enumerate(geometries):
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(geometry))
        for name, values in fields.items():
            feature.SetField(name, float(values[i]))
        layer.CreateFeature(feature)
    layer.CommitTransaction()


def write_dem(path):
    """Two bands with a gap of 2 x 2 and one of 12 x 12 pixels; edges of pixels are multiples of STEP."""
    rows, columns = KNOWN
    raster = gdal.GetDriverByName("GTiff").Create(path, columns, rows, 2, gdal.GDT_Float32)
    raster.SetGeoTransform((500 * STEP, STEP, 0, 900 * STEP, 0, -STEP))
    y, x = numpy.mgrid[:rows, :columns]
    z = 40 + 5 * numpy.sin(x / 9) + y / 4
    z[5:7, 8:10] = z[20:32, 30:42] = -9999
    for i in (1, 2):
        raster.GetRasterBand(i).SetNoDataValue(-9999)
        raster.GetRasterBand(i).WriteArray(numpy.where(z == -9999, z, z + 100 * (i - 1)))


def write_mask(path):
    """0 in the small gap of write_dem(), 1 elsewhere."""
    rows, columns = KNOWN
    raster = gdal.GetDriverByName("GTiff").Create(path, columns, rows, 1, gdal.GDT_Byte)
    mask = numpy.ones((rows, columns), "u1")
    mask[5:7, 8:10] = 0
    raster.GetRasterBand(1).WriteArray(mask)


def write_las(path):
    """Points of class 2, but the last 100 of class 6; LAS 1.2, format 0, in thousandths."""
    low, high = XYZ.min(axis=0), XYZ.max(axis=0)
    bounds = [value for pair in zip(high, low) for value in pair]
    head = b"LASF" + bytes(20) + bytes((1, 2)) + bytes(68)
    head += struct.pack("<HIIBHI5I", 227, 227, 0, 0, 20, len(XYZ), len(XYZ), 0, 0, 0, 0)
    head += struct.pack("<12d", 1e-3, 1e-3, 1e-3, 0, 0, 0, *bounds)
    with open(path, "wb") as file:
        file.write(head)
        for i, point in enumerate(numpy.rint(XYZ * 1000).astype(int)):
            kind = 6 if i >= len(XYZ) - 100 else 2
            file.write(struct.pack("<iiiHBBbBH", *point, 0, 9, kind, 0, 0, 0))


def write_files():
    numpy.savetxt("survey.csv", XYZ, delimiter=",", header="X,Y,Z", comments="")
    write_las("survey.las")
    write_dem("dem.tif")
    write_mask("mask.tif")
    write_vectors("lakes.gpkg", ["POLYGON ((5085 8935, 5095 8935, 5095 8945, 5085 8945, 5085 8935))"])
    points = ["POINT Z (%r %r %r)" % tuple(map(float, p)) for p in XYZ]
    write_vectors("points.gpkg", points, height=XYZ[:, 2] + 1000)
    write_vectors("lines.gpkg", ["LINESTRING Z (10.5 10.25 3, 90.125 20.5 5)"])
    write_vectors("area.gpkg", ["POLYGON ((20 20, 80 20, 80 80, 20 80, 20 20))"])
