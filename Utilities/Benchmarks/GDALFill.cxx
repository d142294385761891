// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "GDALFill.h"

#include "Kernel/Base/Base.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace benchmark
{

bool HasGDAL()
{
#ifdef ES_BENCHMARK_PYTHON
  return true;
#else
  return false;
#endif
}

void FillWithGDAL(const std::vector<Raster*>& rasters)
{
#ifdef ES_BENCHMARK_PYTHON
  if (rasters.empty())
  {
    return;
  }
  const std::filesystem::path path = std::filesystem::temp_directory_path() /
    ("fill-accuracy-" + std::to_string(std::random_device()()) + ".raster");
  const auto bytesOf = [](const Raster& raster) {
    return static_cast<std::streamsize>(raster.Values.size() * sizeof(double));
  };
  {
    std::ofstream file(path, std::ios::binary);
    for (const Raster* raster : rasters)
    {
      const std::int32_t size[2] = { raster->Width, raster->Height };
      file.write(reinterpret_cast<const char*>(size), sizeof size);
      file.write(reinterpret_cast<const char*>(raster->Values.data()), bytesOf(*raster));
    }
  }
  const std::string command = std::string("\"") + ES_BENCHMARK_PYTHON + "\" \"" +
    ES_BENCHMARK_GDAL_SCRIPT + "\" \"" + path.string() + "\"";
  const bool hasRun = std::system(command.c_str()) == 0;
  bool isWhole = hasRun;
  {
    std::ifstream file(path, std::ios::binary);
    for (Raster* raster : rasters)
    {
      std::int32_t size[2];
      file.read(reinterpret_cast<char*>(size), sizeof size);
      file.read(reinterpret_cast<char*>(raster->Values.data()), bytesOf(*raster));
    }
    isWhole = isWhole && file.good();
  }
  std::filesystem::remove(path);
  if (!isWhole)
  {
    throw elevation::Error("GDAL failed: " + command);
  }
#else
  static_cast<void>(rasters);
#endif
}

} // namespace benchmark
