// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How fuzz targets make points and lines of bytes.
 */
#ifndef FuzzLines_h
#define FuzzLines_h

#include "FuzzInput.h"

#include "Kernel/Constrain/Constrain.h"

#include <algorithm>
#include <vector>

namespace fuzz
{
/** Lines between the points of a cloud. */
struct Lines
{
  Cloud Own;
  std::vector<std::vector<Index>> Ids;
  std::vector<char> AreClosed;

  ConstraintLines Get() const
  {
    ConstraintLines lines;
    lines.Points = this->Own.View();
    for (std::size_t i = 0; i < this->Ids.size(); ++i)
    {
      lines.Vertices.insert(lines.Vertices.end(), this->Ids[i].begin(), this->Ids[i].end());
      lines.Offsets.push_back(static_cast<Index>(lines.Vertices.size()));
      lines.IsClosed.push_back(this->AreClosed[i]);
      lines.Cells.push_back(static_cast<Index>(i));
    }
    return lines;
  }
  Lines Turned() const
  {
    Lines lines = *this;
    std::reverse(lines.Ids.begin(), lines.Ids.end());
    std::reverse(lines.AreClosed.begin(), lines.AreClosed.end());
    for (std::vector<Index>& ids : lines.Ids)
    {
      std::reverse(ids.begin(), ids.end());
    }
    return lines;
  }
};

struct PointsAndLines
{
  Cloud Points;
  Lines Constraints; ///< without points of their own when no point was drawn
};

/** Up to 8 lines. Their points are a cloud of which the first points are the input. */
inline PointsAndLines ReadPointsAndLines(Input& input, Index most)
{
  PointsAndLines drawn;
  Lines& lines = drawn.Constraints;
  const unsigned shared = input.Byte();
  lines.AreClosed.resize(1 + input.Below(8));
  lines.Ids.resize(lines.AreClosed.size());
  std::vector<std::vector<unsigned>> chosen(lines.Ids.size());
  for (std::size_t i = 0; i < chosen.size(); ++i)
  {
    const unsigned kind = input.Byte();
    lines.AreClosed[i] = kind % 2 != 0;
    chosen[i].resize(1 + kind / 2 % 8);
    for (unsigned& id : chosen[i])
    {
      id = input.Byte();
    }
  }
  lines.Own = ReadCloud(input, most);
  drawn.Points = lines.Own;
  std::vector<double>& coordinates = drawn.Points.Coordinates;
  coordinates.resize(3 * (coordinates.size() / 3 * shared / 255));
  for (std::size_t i = 0; i < chosen.size() && lines.Own.Count() > 0; ++i)
  {
    for (const unsigned id : chosen[i])
    {
      const Index point = static_cast<Index>(id % lines.Own.Count());
      if (IsFinite(lines.Own.View().At(point)) && std::isfinite(lines.Own.View().Elevation(point)))
      {
        lines.Ids[i].push_back(point);
      }
    }
  }
  return drawn;
}

inline void Show(const Cloud& cloud, const ConstraintLines& lines)
{
  Show("points", cloud.View());
  Show("points of the lines", lines.Points);
  Show("ids of the lines", lines.Vertices);
  Show("offsets of the lines", lines.Offsets);
}

} // namespace fuzz

#endif
