// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Cuts.h"

#include <algorithm>

namespace elevation
{

namespace
{
double Coordinate(Point2 p, bool isY)
{
  return isY ? p.Y : p.X;
}

struct IsLess
{
  bool IsY;
  bool operator()(Point2 p, Point2 q) const
  {
    return Coordinate(p, this->IsY) < Coordinate(q, this->IsY);
  }
};

/**
 * Brings lesser points before greater ones.
 * @return where the greater ones begin: as near to a place as equal coordinates, which stay
 *         together, let it; never the end
 */
std::vector<Point2>::iterator CutAt(std::vector<Point2>::iterator first,
  std::vector<Point2>::iterator place, std::vector<Point2>::iterator last, bool isY)
{
  std::nth_element(first, place, last, IsLess{ isY });
  const Point2 at = *place;
  // Equal coordinates on both sides of the place: the cut goes before or after all of them.
  const auto low =
    std::partition(first, place, [at, isY](Point2 p) { return IsLess{ isY }(p, at); });
  const auto high =
    std::partition(place, last, [at, isY](Point2 p) { return !IsLess{ isY }(at, p); });
  return high == last || place - low <= high - place ? low : high;
}
} // namespace

Cuts::Cuts(std::vector<Point2> sample, int count)
  : Lines(static_cast<std::size_t>(count))
{
  this->Cut(sample.begin(), sample.end(), 0, count);
}

void Cuts::Cut(Iterator first, Iterator last, int begin, int end)
{
  if (end - begin < 2)
  {
    return;
  }
  const int middle = MiddleOf(begin, end);
  Line& line = this->Lines[middle];
  // Without points in a node, its cut is at 0: any cut is right, none matters.
  Iterator cut = first;
  if (first != last)
  {
    Box box;
    std::for_each(first, last, [&box](Point2 p) { box.Add(p); });
    line.IsY = box.Height() > box.Width();
    // Numbers of cells need not be powers of two: of three, one third of the points goes to the
    // first.
    const double ratio = static_cast<double>(middle - begin) / (end - begin);
    cut += static_cast<std::ptrdiff_t>(ratio * static_cast<double>(last - first));
    cut = CutAt(first, cut, last, line.IsY);
    const bool isY = line.IsY;
    // A coordinate of a point, as points on it belong to the upper half.
    line.Value = Coordinate(*std::min_element(cut, last, IsLess{ isY }), isY);
  }
  this->Cut(first, cut, begin, middle);
  this->Cut(cut, last, middle, end);
}

Cell Cuts::CellOf(int begin, int end) const
{
  // From the whole plane down to the node: each cut on the way is a side of it.
  Cell cell;
  int first = 0, last = this->Count();
  while (last - first > end - begin)
  {
    const int middle = MiddleOf(first, last);
    const Line& line = this->Lines[middle];
    const bool isLower = begin < middle;
    Point2& corner = isLower ? cell.High : cell.Low;
    (line.IsY ? corner.Y : corner.X) = line.Value;
    (isLower ? last : first) = middle;
  }
  return cell;
}

} // namespace elevation
