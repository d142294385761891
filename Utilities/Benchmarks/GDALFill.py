# SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fills rasters with GDAL's FillNodata, as gdal_fillnodata.py does by default.

GDALFill.py FILE: one raster after another, each two 32-bit integers (width, height) and
width * height doubles, row after row, NaN where there is no value. They are filled in place; what
GDAL leaves open stays NaN.
"""
import sys

import numpy
from osgeo import gdal

SEARCH_DISTANCE = 100  # pixels; the default of gdal_fillnodata.py
SMOOTHING_ITERATIONS = 0
NOTHING = -1e30


def fill(values):
    height, width = values.shape
    data = gdal.GetDriverByName("MEM").Create("", width, height, 1, gdal.GDT_Float64)
    band = data.GetRasterBand(1)
    band.SetNoDataValue(NOTHING)
    # Around 0: GDAL computes with single precision.
    middle = numpy.nanmean(values)
    band.WriteArray(numpy.where(numpy.isnan(values), NOTHING, values - middle))
    if gdal.FillNodata(band, None, SEARCH_DISTANCE, SMOOTHING_ITERATIONS) != 0:
        raise RuntimeError("FillNodata failed")
    filled = band.ReadAsArray()
    return numpy.where(filled == NOTHING, numpy.nan, filled + middle)


def main():
    gdal.UseExceptions()
    with open(sys.argv[1], "r+b") as file:
        while True:
            size = numpy.fromfile(file, "=i4", 2)
            if size.size < 2:
                break
            start = file.tell()
            values = numpy.fromfile(file, "=f8", size[0] * size[1]).reshape(size[1], size[0])
            file.seek(start)
            fill(values).astype("=f8").tofile(file)


if __name__ == "__main__":
    main()
