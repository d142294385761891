// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Competitor.h"

#include "Kernel/Triangulate/Triangulate.h"

namespace
{
using benchmark::Index;

/** The kernel's triangulation without the filter around it, which offers no choice of instructions. */
class KernelCompetitor : public benchmark::Competitor
{
public:
  KernelCompetitor(std::string name, const elevation::DelaunayOptions& options)
    : CodeName(std::move(name))
    , Options(options)
  {
  }

  std::string Name() const override { return this->CodeName; }
  void SetPoints(const benchmark::Coordinates& points) override
  {
    this->Points.Double = points.data();
    this->Points.Count = static_cast<Index>(points.size() / 3);
  }
  void Run() override { this->Result = elevation::Triangulate(this->Points, this->Options); }
  void Release() override { this->Result = elevation::Triangulation(); }
  std::size_t OutputBytes() const override { return this->Result.Triangles.size() * sizeof(Index); }
  std::vector<Index> Triangles() const override
  {
    return std::vector<Index>(this->Result.Triangles.begin(), this->Result.Triangles.end());
  }
  std::vector<Index> UnusedPoints() const override { return this->Result.UnusedPoints; }

private:
  std::string CodeName;
  elevation::DelaunayOptions Options;
  elevation::PointView Points;
  elevation::Triangulation Result;
};
} // namespace

namespace benchmark
{
std::unique_ptr<Competitor> NewKernelDelaunay(
  int threads, elevation::InstructionSet instructions, const std::string& name)
{
  elevation::DelaunayOptions options;
  options.NumberOfThreads = threads;
  options.Instructions = instructions;
  return std::make_unique<KernelCompetitor>("- " + name, options);
}
} // namespace benchmark
