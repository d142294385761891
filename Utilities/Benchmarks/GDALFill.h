// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * GDAL's FillNodata, run by GDALFill.py in a Python that has osgeo.gdal.
 */
#ifndef GDALFill_h
#define GDALFill_h

#include <vector>

namespace benchmark
{

/** Row after row; NaN where there is no value. */
struct Raster
{
  int Width = 0;
  int Height = 0;
  std::vector<double> Values;
};

/** Whether such a Python was found when this was built. */
bool HasGDAL();

/**
 * Fills all rasters in one run of Python. Without GDAL nothing happens.
 * @throws elevation::Error when the script fails
 */
void FillWithGDAL(const std::vector<Raster*>& rasters);

} // namespace benchmark

#endif
