// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Competitor.h"
#include "PolyDataOf.h"

#include "Kernel/Base/Threads.h"
#include "vtkGridDelaunay2D.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkDelaunay2D.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkVersion.h"

#include <functional>
#include <future>

namespace
{
using benchmark::Index;

template <typename Filter>
class VTKCompetitor : public benchmark::Competitor
{
public:
  /** @param setUp  sets the properties of each fresh filter */
  VTKCompetitor(std::string name, std::function<void(Filter*)> setUp)
    : FilterName(std::move(name))
    , SetUp(std::move(setUp))
  {
  }

  std::string Name() const override { return this->FilterName; }

  void SetPoints(const benchmark::Coordinates& coordinates) override
  {
    this->Input->ShallowCopy(benchmark::PolyDataOf(coordinates));
  }

  void Run() override
  {
    this->Input->Modified();
    vtkNew<Filter> filter;
    this->SetUp(filter);
    filter->SetInputData(this->Input);
    filter->Update();
    this->Output = filter->GetOutput();
  }

  bool RunWithoutLattice() override
  {
    if constexpr (std::is_same<Filter, vtkGridDelaunay2D>::value)
    {
      if (this->Output->GetFieldData()->GetArray("Lattice"))
      {
        vtkNew<Filter> filter;
        filter->SetLatticeModeToOff();
        filter->SetInputData(this->Input);
        filter->Update();
        this->Output = filter->GetOutput();
        return true;
      }
    }
    return false;
  }

  void Release() override { this->Output = nullptr; }

  std::size_t OutputBytes() const override
  {
    vtkCellArray* cells = this->Output->GetPolys();
    const std::size_t values =
      static_cast<std::size_t>(cells->GetNumberOfConnectivityIds() + cells->GetNumberOfOffsets());
    return values * (cells->IsStorage64Bit() ? 8 : 4);
  }

  std::vector<Index> Triangles() const override
  {
    std::vector<Index> triangles;
    vtkCellArray* cells = this->Output->GetPolys();
    triangles.reserve(3 * static_cast<std::size_t>(cells->GetNumberOfCells()));
    auto iterator = vtk::TakeSmartPointer(cells->NewIterator());
    for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      iterator->GetCurrentCell(size, ids);
      if (size != 3)
      {
        throw elevation::Error(this->FilterName + " made a cell that is not a triangle");
      }
      for (int i = 0; i < 3; ++i)
      {
        triangles.push_back(static_cast<Index>(ids[i]));
      }
    }
    return triangles;
  }

  std::vector<Index> UnusedPoints() const override
  {
    std::vector<Index> unused;
    auto* ids =
      vtkIdTypeArray::SafeDownCast(this->Output->GetFieldData()->GetArray("UnusedPointIds"));
    for (vtkIdType i = 0; ids && i < ids->GetNumberOfValues(); ++i)
    {
      unused.push_back(static_cast<Index>(ids->GetValue(i)));
    }
    return unused;
  }

private:
  std::string FilterName;
  std::function<void(Filter*)> SetUp;
  vtkNew<vtkPolyData> Input;
  vtkSmartPointer<vtkPolyData> Output;
};

/** One code several times, each on a thread of its own. The result is the first one's. */
class CopiesOfCompetitor : public benchmark::Competitor
{
public:
  CopiesOfCompetitor(int count, const std::function<std::unique_ptr<Competitor>()>& make)
  {
    for (int i = 0; i < count; ++i)
    {
      this->Each.push_back(make());
    }
  }

  std::string Name() const override { return "- " + std::to_string(this->Copies()) + " copies"; }
  int Copies() const override { return static_cast<int>(this->Each.size()); }

  void SetPoints(const benchmark::Coordinates& points) override
  {
    for (const std::unique_ptr<Competitor>& copy : this->Each)
    {
      copy->SetPoints(points);
    }
  }

  void Run() override
  {
    std::vector<std::future<void>> others;
    for (std::size_t i = 1; i < this->Each.size(); ++i)
    {
      others.push_back(std::async(std::launch::async, [this, i]() { this->Each[i]->Run(); }));
    }
    this->Each[0]->Run();
    for (std::future<void>& other : others)
    {
      other.get();
    }
  }

  bool RunWithoutLattice() override { return this->Each[0]->RunWithoutLattice(); }

  void Release() override
  {
    for (const std::unique_ptr<Competitor>& copy : this->Each)
    {
      copy->Release();
    }
  }

  std::size_t OutputBytes() const override
  {
    return this->Each.size() * this->Each[0]->OutputBytes();
  }
  std::vector<Index> Triangles() const override { return this->Each[0]->Triangles(); }
  std::vector<Index> UnusedPoints() const override { return this->Each[0]->UnusedPoints(); }

private:
  std::vector<std::unique_ptr<Competitor>> Each;
};
} // namespace

namespace benchmark
{
std::unique_ptr<Competitor> NewGridDelaunay(int threads)
{
  return std::make_unique<VTKCompetitor<vtkGridDelaunay2D>>("vtkGridDelaunay2D",
    [threads](vtkGridDelaunay2D* filter) { filter->SetNumberOfThreads(threads); });
}

std::unique_ptr<Competitor> NewGridDelaunayOneThread()
{
  return std::make_unique<VTKCompetitor<vtkGridDelaunay2D>>(
    "- one thread", [](vtkGridDelaunay2D* filter) { filter->SetNumberOfThreads(1); });
}

std::unique_ptr<Competitor> NewGridDelaunayCopies(int threads)
{
  return std::make_unique<CopiesOfCompetitor>(
    elevation::ResolveNumberOfThreads(threads), NewGridDelaunayOneThread);
}

std::unique_ptr<Competitor> NewGridDelaunaySearch(int threads, bool isCompactness)
{
  return std::make_unique<VTKCompetitor<vtkGridDelaunay2D>>(
    isCompactness ? "- Compactness" : "- VoxelTraversal",
    [threads, isCompactness](vtkGridDelaunay2D* filter) {
      filter->SetNumberOfThreads(threads);
      filter->SetLatticeModeToOff();
      filter->SetSearchStrategy(
        isCompactness ? vtkGridDelaunay2D::COMPACTNESS : vtkGridDelaunay2D::VOXEL_TRAVERSAL);
    });
}

std::unique_ptr<Competitor> NewVTKDelaunay()
{
  return std::make_unique<VTKCompetitor<vtkDelaunay2D>>(
    std::string("vtkDelaunay2D ") + vtkVersion::GetVTKVersion(), [](vtkDelaunay2D*) {});
}
} // namespace benchmark
