// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Competitor.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/version.h>

#include <boost/iterator/counting_iterator.hpp>
#include <boost/iterator/transform_iterator.hpp>
#include <boost/iterator/zip_iterator.hpp>

namespace
{
using benchmark::Index;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<Vertex>;
using Triangulation = CGAL::Delaunay_triangulation_2<Kernel, Structure>;

/** Reads a point where the input has it, so that CGAL is not charged for a copy of the input. */
struct PointAt
{
  using result_type = Kernel::Point_2;
  const double* XYZ;
  Kernel::Point_2 operator()(Index i) const
  {
    const double* p = this->XYZ + 3 * static_cast<std::size_t>(i);
    return { p[0], p[1] };
  }
};

/**
 * Range insert with the ids as info: CGAL sorts the points along a space-filling curve and inserts
 * them one by one. The triangles are then written into one array of ids.
 */
class CGALDelaunay : public benchmark::Competitor
{
public:
  std::string Name() const override { return "CGAL " CGAL_VERSION_STR; }

  void SetPoints(const benchmark::Coordinates& points) override
  {
    this->XYZ = points.data();
    this->Count = static_cast<Index>(points.size() / 3);
  }

  void Run() override
  {
    this->Result = std::make_unique<Triangulation>();
    const boost::counting_iterator<Index> first(0), last(this->Count);
    const PointAt at{ this->XYZ };
    this->Result->insert(
      boost::make_zip_iterator(boost::make_tuple(boost::make_transform_iterator(first, at), first)),
      boost::make_zip_iterator(boost::make_tuple(boost::make_transform_iterator(last, at), last)));
    this->Ids.Resize(3 * this->Result->number_of_faces());
    Index* id = this->Ids.data();
    for (auto face = this->Result->finite_faces_begin(); face != this->Result->finite_faces_end();
         ++face)
    {
      *id++ = face->vertex(0)->info();
      *id++ = face->vertex(1)->info();
      *id++ = face->vertex(2)->info();
    }
  }

  void Release() override
  {
    this->Result.reset();
    this->Ids = elevation::Buffer<Index>();
  }

  std::size_t OutputBytes() const override { return this->Ids.size() * sizeof(Index); }

  std::vector<Index> Triangles() const override { return { this->Ids.begin(), this->Ids.end() }; }

private:
  const double* XYZ = nullptr;
  Index Count = 0;
  std::unique_ptr<Triangulation> Result;
  elevation::Buffer<Index> Ids; ///< not initialised before it is written, unlike std::vector
};
} // namespace

namespace benchmark
{
std::unique_ptr<Competitor> NewCGALDelaunay()
{
  return std::make_unique<CGALDelaunay>();
}
} // namespace benchmark
