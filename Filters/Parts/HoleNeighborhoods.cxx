// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/*
 * A hole is filled where its surroundings are. They are all triangles that meet a box around it:
 * those that hold the boundary, the ring of points beside it that gives the slope, and the places
 * nearby where methods are tried (Heights.h). The box is a guess by the size of the hole; the
 * kernel says whether it was enough.
 */
#include "HoleNeighborhoods.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

namespace elevation
{

// By the edges of rim and islands: more is not known of a hole yet.
std::vector<HoleExtent> ExtentsOf(const Holes& holes, const PointView& points)
{
  std::vector<HoleExtent> extents;
  for (Index hole = 0; hole < holes.Count(); ++hole)
  {
    HoleExtent extent{ Box(), 0.0, holes.NumberOfEdges(hole) };
    holes.VisitEdges(hole, [&](Index a, Index b) {
      extent.OfRim.Add(points.At(a));
      extent.MeanEdge += Distance(points.At(a), points.At(b)) / extent.NumberOfEdges;
    });
    extents.push_back(extent);
  }
  return extents;
}

std::vector<int> BalancedRanks(
  const std::vector<HoleExtent>& holes, const std::vector<vtkIdType>& can)
{
  // Even a hole of three edges has trials.
  constexpr double leastWork = 150.0;                // of the trials, in points
  std::vector<std::pair<double, std::size_t>> order; // negative work, hole
  for (std::size_t hole = 0; hole < holes.size(); ++hole)
  {
    const HoleExtent& one = holes[hole];
    // Points of the spacing of its edges in the box of the rim: an upper bound of what is new.
    const double points = one.OfRim.Width() / one.MeanEdge * (one.OfRim.Height() / one.MeanEdge);
    order.emplace_back(-(points + one.NumberOfEdges + leastWork), hole);
  }
  std::sort(order.begin(), order.end());
  std::vector<double> work(can.size(), DBL_MAX);
  for (std::size_t rank = 0; rank < can.size(); ++rank)
  {
    // A rank that gets nothing stays the one with most work.
    work[rank] = can[rank] ? 0.0 : DBL_MAX;
  }
  std::vector<int> rankOf(holes.size(), 0);
  for (const auto& [negative, hole] : order)
  {
    const auto least = std::min_element(work.begin(), work.end());
    rankOf[hole] = static_cast<int>(least - work.begin());
    *least -= negative;
  }
  return rankOf;
}

Box BoxAround(const HoleExtent& hole, int retries, double reach)
{
  const Box& rim = hole.OfRim;
  constexpr int most = 24; // times: 3e14 as wide
  if (retries > most)
  {
    return { { -DBL_MAX, -DBL_MAX }, { DBL_MAX, DBL_MAX } };
  }
  const double size = std::hypot(rim.Width(), rim.Height());
  // On each side, 1.5 times the diagonal of the hole and six edges, which small holes need. No less
  // than what Kernel/Fill/LengthsAround.cxx looks at: it cannot ask for more.
  const double by = std::max(reach, std::pow(4.0, retries) * (1.5 * size + 6.0 * hole.MeanEdge));
  return { { rim.Low.X - by, rim.Low.Y - by }, { rim.High.X + by, rim.High.Y + by } };
}

namespace
{
/**
 * A grid of 256 by 256 cells over a mesh, in which the cells that boxes touch are marked. Cells are
 * coarse, so some triangles just beside a box come along; that does no harm.
 */
class CellsOfBoxes
{
public:
  CellsOfBoxes(const std::vector<Box>& boxes, const Box& all)
    : Bounds(all)
    , Marked(Side, Side)
  {
    for (const Box& box : boxes)
    {
      if (box.Intersects(all))
      {
        const Range r = this->RangeOf(box);
        this->Marked.Mark(r.I0, r.J0, r.I1, r.J1);
      }
    }
    this->Marked.Finish();
  }

  bool Meet(const Box& box) const
  {
    const Range r = this->RangeOf(box);
    return this->Marked.AreAny(r.I0, r.J0, r.I1, r.J1);
  }

private:
  static constexpr Index Side = 256;
  struct Range
  {
    Index I0, I1, J0, J1;
  };

  static Index CellOf(double x, double low, double width)
  {
    // Without an extent there is one column (row). The clamp also takes boxes that reach to
    // infinity.
    const double cell = width > 0.0 ? std::floor((x - low) / width * Side) : 0.0;
    return static_cast<Index>(std::min(std::max(cell, 0.0), Side - 1.0));
  }
  Range RangeOf(const Box& box) const
  {
    const double width = this->Bounds.Width(), height = this->Bounds.Height();
    return { CellOf(box.Low.X, this->Bounds.Low.X, width),
      CellOf(box.High.X, this->Bounds.Low.X, width), CellOf(box.Low.Y, this->Bounds.Low.Y, height),
      CellOf(box.High.Y, this->Bounds.Low.Y, height) };
  }

  const Box Bounds;
  MarkedCells Marked;
};
} // namespace

std::vector<Index> TrianglesIn(const std::vector<Box>& boxes, const Mesh& mesh)
{
  std::vector<Index> near;
  if (boxes.empty() || mesh.Triangles.empty())
  {
    return near;
  }
  Box all;
  for (const Index corner : mesh.Triangles)
  {
    all.Add(mesh.PointOf(corner));
  }
  const CellsOfBoxes cells(boxes, all);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    Box box;
    for (Index k = 0; k < 3; ++k)
    {
      box.Add(mesh.PointOf(mesh.Origin(3 * t + k)));
    }
    // By the box of the triangle: a thin one across a corner may come along without meeting a box.
    if (cells.Meet(box))
    {
      near.push_back(t);
    }
  }
  return near;
}

// Points keep their order, and with it the choice among duplicates.
vtkSmartPointer<vtkPolyData> ChosenTriangles(
  vtkPolyData* source, const Mesh& mesh, const std::vector<Index>& chosen)
{
  IdSet used(static_cast<Index>(source->GetNumberOfPoints()));
  for (const Index t : chosen)
  {
    used.AddAll(mesh.Triangles.data() + 3 * static_cast<std::size_t>(t));
  }
  const vtkSmartPointer<vtkPolyData> part = ChosenPoints(source, used.ListAndRank());
  vtkNew<vtkCellArray> polygons;
  for (const Index t : chosen)
  {
    const Index* const c = mesh.Triangles.data() + 3 * static_cast<std::size_t>(t);
    const vtkIdType corners[] = { used.RankOf(c[0]), used.RankOf(c[1]), used.RankOf(c[2]) };
    polygons->InsertNextCell(3, corners);
  }
  part->SetPolys(polygons);
  return part;
}

} // namespace elevation
