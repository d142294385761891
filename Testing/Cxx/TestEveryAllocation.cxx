// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Each filter runs on a small input as often as it asks for memory, and each time another piece is
// refused. The run ends with an error and empty outputs, or with the usual result where the piece
// was not needed; nothing leaks, and the next run has the usual result.
#include "Check.h"
#include "FailingMemory.h"
#include "Inputs.h"
#include "SameMesh.h"
#include "SheetOfSquares.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFillElevationHoles.h"
#include "vtkGridDelaunay2D.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkReconstructPieces.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkTestErrorObserver.h"
#include "vtkTrimOutwardTriangles.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <new>
#include <string>
#include <vector>

namespace
{
using Filter = vtkSmartPointer<vtkPolyDataAlgorithm>;

vtkSmartPointer<vtkDoubleArray> MakeValues(vtkIdType count)
{
  auto values = vtkSmartPointer<vtkDoubleArray>::New();
  values->SetName("Porosity");
  for (vtkIdType i = 0; i < count; ++i)
  {
    values->InsertNextValue(0.25 * static_cast<double>(i % 7));
  }
  return values;
}

/** Some scattered points; one is there twice, one is not finite. */
vtkSmartPointer<vtkPolyData> MakeCloud()
{
  auto cloud =
    RandomCloud(41, 40, 10.0, VTK_DOUBLE, [](double x, double y) { return 0.1 * x * y; });
  vtkPoints* const points = cloud->GetPoints();
  double p[3];
  points->GetPoint(7, p);
  points->InsertNextPoint(p);
  points->InsertNextPoint(1.0, std::numeric_limits<double>::infinity(), 0.0);
  cloud->GetPointData()->SetScalars(MakeValues(points->GetNumberOfPoints()));
  return cloud;
}

/** Two lines that cross, and a ring. */
vtkSmartPointer<vtkPolyData> MakeLines(const std::vector<std::vector<double>>& lines)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_DOUBLE);
  vtkNew<vtkCellArray> cells;
  for (const std::vector<double>& line : lines)
  {
    cells->InsertNextCell(static_cast<int>(line.size() / 2));
    for (std::size_t i = 0; i < line.size(); i += 2)
    {
      cells->InsertCellPoint(points->InsertNextPoint(line[i], line[i + 1], 0.0));
    }
  }
  auto made = vtkSmartPointer<vtkPolyData>::New();
  made->SetPoints(points);
  made->SetLines(cells);
  return made;
}

vtkSmartPointer<vtkPolyData> MakeSurface(const std::vector<std::string>& picture)
{
  auto surface = MakeSheet(picture, VTK_DOUBLE, [](int x, int y) { return 0.3 * x + 0.1 * x * y; });
  surface->GetPointData()->SetScalars(MakeValues(surface->GetNumberOfPoints()));
  auto values = MakeValues(surface->GetNumberOfCells());
  values->SetName("Number");
  surface->GetCellData()->AddArray(values);
  return surface;
}

using Make = std::function<Filter()>;

/** Makes filters of a kind. */
template <typename Kind>
Make Of(
  vtkPolyData* input, const std::function<void(Kind*)>& set = [](Kind*) {})
{
  return [input = vtkSmartPointer<vtkPolyData>(input), set]() {
    vtkNew<Kind> filter;
    filter->SetInputData(input);
    filter->SetNumberOfThreads(1);
    set(filter);
    return Filter(filter);
  };
}

constexpr const char* Folder = "TestEveryAllocation.pieces";

/** Makes filters that work piece by piece. */
Make OfPieces(const std::function<void(vtkReconstructPieces*)>& set)
{
  return [set]() {
    vtkNew<vtkReconstructPieces> filter;
    filter->SetFolder(Folder);
    // VTK's own pool of threads, in headers and so in our library, ends the program where memory
    // ends.
    filter->GetDelaunay()->SetNumberOfThreads(1);
    set(filter);
    return Filter(filter);
  };
}

/** Has all pieces made anew; those of a filter that works piece by piece from these points. */
void Run(vtkPolyDataAlgorithm* filter, vtkPolyData* points)
{
  if (auto* const pieces = vtkReconstructPieces::SafeDownCast(filter))
  {
    pieces->Reset();
    pieces->AddPoints(points);
    pieces->UpdatePiece(0, 2, 0);
  }
  else
  {
    filter->Modified();
    filter->Update();
  }
}

/** Copies of all outputs. */
std::vector<vtkSmartPointer<vtkPolyData>> ResultOf(vtkPolyDataAlgorithm* filter)
{
  std::vector<vtkSmartPointer<vtkPolyData>> result;
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    result.push_back(vtkSmartPointer<vtkPolyData>::New());
    result.back()->DeepCopy(filter->GetOutput(port));
  }
  return result;
}

bool HasSameValues(vtkAbstractArray* a, vtkAbstractArray* b)
{
  if (auto* const words = vtkStringArray::SafeDownCast(a))
  {
    const vtkStdString* const first = words->GetPointer(0);
    auto* const others = vtkStringArray::SafeDownCast(b);
    return others && std::equal(first, first + words->GetNumberOfValues(), others->GetPointer(0));
  }
  const auto size = static_cast<std::size_t>(a->GetDataTypeSize() * a->GetNumberOfValues());
  return a->GetDataType() == b->GetDataType() &&
    (size == 0 || std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0), size) == 0);
}

bool HasSameArrays(vtkFieldData* a, vtkFieldData* b)
{
  bool isSame = a->GetNumberOfArrays() == b->GetNumberOfArrays();
  for (int i = 0; isSame && i < a->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray *p = a->GetAbstractArray(i), *q = b->GetAbstractArray(i);
    isSame = std::string(p->GetName()) == q->GetName() &&
      p->GetNumberOfValues() == q->GetNumberOfValues() && HasSameValues(p, q);
  }
  return isSame;
}

bool IsEmpty(vtkPolyDataAlgorithm* filter)
{
  bool isEmpty = true;
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    vtkPolyData* const output = filter->GetOutput(port);
    isEmpty = isEmpty &&
      (!output ||
        (output->GetNumberOfPoints() == 0 && output->GetNumberOfCells() == 0 &&
          output->GetFieldData()->GetNumberOfArrays() == 0));
  }
  return isEmpty;
}

/** How a run ended in which a piece was refused. */
struct Outcome
{
  long Asked = 0, Left = 0;
  bool IsError = false; ///< else the result is there
};

class Trial
{
public:
  /** @param points  for filters that work piece by piece */
  Trial(const std::string& name, const Make& make, vtkPolyData* points = nullptr)
    : Name(name)
    , MakeFilter(make)
    , Points(points)
  {
    const Filter usual = make();
    Run(usual, points); // also what is made once a program
    this->Result = ResultOf(usual);
    Check(this->Result[0]->GetNumberOfPoints() > 0, name + " has a result");
  }

  /** Refuses each piece once. @param needed  how many in a hundred are needed, at least */
  void RefuseEach(int needed = 100)
  {
    const long pieces = this->RunOnce(0).Asked;
    long errors = 0;
    for (long refused = 1; refused <= pieces && failures < 20; ++refused)
    {
      errors += this->RunOnce(refused).IsError;
    }
    std::cout << this->Name << ": " << pieces << " pieces, " << errors << " errors\n";
    Check(pieces >= 50, this->Name + " asks for memory");
    Check(100 * errors >= needed * pieces, this->Name + ": most pieces are needed");
  }

private:
  Outcome RunOnce(long refused) const
  {
    Outcome outcome;
    const std::string at = this->Name + ", piece " + std::to_string(refused) + ": ";
    {
      const Filter filter = this->MakeFilter();
      vtkNew<vtkTest::ErrorObserver> observer;
      filter->AddObserver(vtkCommand::ErrorEvent, observer);
      filter->AddObserver(vtkCommand::WarningEvent, observer);
      failing_memory::Begin(refused, reinterpret_cast<const void*>(&vtkGridDelaunay2D::New));
      try
      {
        Run(filter, this->Points);
      }
      catch (const std::bad_alloc&)
      {
        Check(false, at + "no exception leaves the filter");
      }
      outcome.Asked = failing_memory::End();
      outcome.IsError = observer->GetError();
      if (outcome.IsError)
      {
        const std::string text = observer->GetErrorMessage();
        Check(IsEmpty(filter), at + "an error leaves empty outputs");
        Check(text.find("not enough memory") != std::string::npos ||
            text.find("not complete after the error before") != std::string::npos,
          at + "the error was " + text);
      }
      else
      {
        Check(this->HasResult(filter), at + "without an error the result is the usual one");
      }
      observer->Clear();
      Run(filter, this->Points);
      Check(!observer->GetError() && this->HasResult(filter), at + "the next run is as usual");
    }
    outcome.Left = failing_memory::CountOfLeft();
    Check(outcome.Left == 0, at + std::to_string(outcome.Left) + " pieces leak");
    return outcome;
  }

  bool HasResult(vtkPolyDataAlgorithm* filter) const
  {
    bool isSame = true;
    for (std::size_t port = 0; isSame && port < this->Result.size(); ++port)
    {
      vtkPolyData *a = filter->GetOutput(static_cast<int>(port)), *b = this->Result[port];
      isSame = a && AreSame(a, b) && HasSameArrays(a->GetPointData(), b->GetPointData()) &&
        HasSameArrays(a->GetCellData(), b->GetCellData()) &&
        HasSameArrays(a->GetFieldData(), b->GetFieldData());
    }
    return isSame;
  }

  const std::string Name;
  const Make MakeFilter;
  vtkPolyData* const Points;
  std::vector<vtkSmartPointer<vtkPolyData>> Result;
};
} // namespace

int TestEveryAllocation(int, char*[])
{
  if (!failing_memory::CanCount())
  {
    std::cerr << "Skipped: pieces of memory cannot be counted with this C library or sanitizer.\n";
    return 125; // as CTest knows it
  }
  using Delaunay = vtkGridDelaunay2D;
  using Trim = vtkTrimOutwardTriangles;
  using Fill = vtkFillElevationHoles;

  const auto cloud = MakeCloud();
  const auto nodes = MakeSurface({ "###", "# #", "###" });
  const auto lines = MakeLines({ { 1.0, 1.0, 9.0, 8.0 }, { 0.0, 9.0, 9.0, 2.0, 9.0, 9.0 } });
  Trial("points", Of<Delaunay>(cloud)).RefuseEach();
  // Lists that are merged can do without memory.
  Trial("points on a lattice", Of<Delaunay>(nodes)).RefuseEach(98);
  Trial("a lattice that is given",
    Of<Delaunay>(nodes, [](Delaunay* filter) { filter->SetLattice(0.0, 0.0, 1.0, 0.0, 0.0, 1.0); }))
    .RefuseEach();
  Trial("an edge limit",
    Of<Delaunay>(cloud,
      [](Delaunay* filter) {
        filter->SetMaximumEdgeLength(1.5); // the advice can be done without
      }))
    .RefuseEach(50);
  Trial("an elevation error",
    Of<Delaunay>(cloud,
      [](Delaunay* filter) {
        filter->SetMaximumElevationError(0.5);
        filter->SetDataDependentEdges(true);
      }))
    .RefuseEach();
  Trial(
    "constraints", Of<Delaunay>(cloud, [lines](Delaunay* filter) { filter->SetSourceData(lines); }))
    .RefuseEach(99);
  Trial("constraints with an elevation error",
    Of<Delaunay>(cloud,
      [lines](Delaunay* filter) {
        filter->SetSourceData(lines);
        filter->SetMaximumElevationError(0.5);
        filter->SetSimplifyConstraints(true);
      }))
    .RefuseEach();

  const auto sheet = MakeSurface({ "########", "########", "##   ###", "##   ###", "########" });
  const auto ring = MakeLines({ { 0.5, 0.5, 7.3, 0.7, 6.9, 4.5, 0.6, 4.1, 0.5, 0.5 } });
  for (const int test : { Trim::EXACT, Trim::INWARD_NORMAL })
  {
    Trial("a boundary, test " + std::to_string(test),
      Of<Trim>(sheet,
        [ring, test](Trim* filter) {
          filter->SetBoundaryData(ring);
          filter->SetOutwardTest(test);
        }))
      .RefuseEach();
  }
  Trial("a boundary that is found", Of<Trim>(sheet)).RefuseEach();

  for (int method = Fill::NEIGHBOR_MEAN; method <= Fill::CUBIC_SPLINE; ++method)
  {
    Trial("a hole, method " + std::to_string(method),
      Of<Fill>(sheet,
        [method](Fill* filter) {
          filter->SetInterpolation(method);
          filter->SetInterpolatePointData(true);
        }))
      .RefuseEach(99);
  }
  Trial("long triangles",
    Of<Fill>(sheet,
      [](Fill* filter) {
        filter->SetMaximumEdgeLength(1.2);
        filter->SetInterpolation(Fill::MEMBRANE);
      }))
    .RefuseEach(99);

  std::filesystem::remove_all(Folder); // of a run that was stopped
  std::filesystem::create_directories(Folder);
  Trial("pieces", OfPieces([](vtkReconstructPieces*) {}), cloud).RefuseEach(99);
  std::filesystem::remove_all(Folder);
  return failures > 0;
}
