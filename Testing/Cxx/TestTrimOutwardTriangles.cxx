// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The pipeline side of vtkTrimOutwardTriangles, by numbers: which triangles go where, what
// passes with them, what is counted, and that the inputs are never written.
#include "Check.h"
#include "MeshAndRings.h"
#include "MeshRules.h"
#include "SameMesh.h"
#include "SheetOfSquares.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkGridDelaunay2D.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTestErrorObserver.h"
#include "vtkTrimOutwardTriangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace
{
void TestGivenBoundary()
{
  auto mesh = MakeMesh();
  auto boundary = MakeRings({ { { 1, 1 }, { 7, 2 }, { 6, 7 }, { 2, 6 } }, // twice: 47
    { { 3, 3 }, { 3, 5 }, { 5, 5 }, { 5, 3 } } });                        // 8
  const vtkMTimeType time = mesh->GetMTime();
  const vtkMTimeType boundaryTime = boundary->GetMTime();
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputData(mesh);
  trim->SetBoundaryData(boundary);
  trim->SetBoundaryEdgesToStraight();
  Check(trim->GetBoundary() == boundary, "the boundary can be asked for");
  trim->Update();
  vtkPolyData* kept = trim->GetOutput(0);
  vtkPolyData* outward = trim->GetOutput(1);
  vtkPolyData* used = trim->GetOutput(2);

  Check(
    mesh->GetMTime() == time && boundary->GetMTime() == boundaryTime, "the inputs are not written");
  const double expected = (1 * 2 - 7 * 1) + (7 * 7 - 6 * 2) + (6 * 6 - 2 * 7) + (2 * 1 - 1 * 6) - 8;
  Check(ProjectedArea(kept) == 0.5 * expected, "the kept triangles cover the inside");
  Check(NumberOfFindings({ kept, outward }, RulesOfConstrained()) == 0,
    "both together cover the input, with all of its points");
  Check(kept->GetNumberOfPolys() + outward->GetNumberOfPolys() == mesh->GetNumberOfPolys(),
    "the number of triangles is conserved");
  Check(trim->GetNumberOfOutwardTriangles() == outward->GetNumberOfPolys(), "outward is counted");
  Check(trim->GetNumberOfRecoveredEdges() == 4, "the four slanted edges were missing");
  Check(NumberOfFindings(kept, RulesOfSurface()) == 0 &&
      NumberOfFindings(outward, RulesOfSurface()) == 0,
    "both parts are surfaces, after recovery too");
  Check(trim->GetEffectiveGapTolerance() == 0.0, "no gap tolerance with a boundary given");
  for (vtkPolyData* output : { kept, outward, used })
  {
    vtkFieldData* field = output->GetFieldData();
    Check(field->GetArray("NumberOfOutwardTriangles") &&
        field->GetArray("NumberOfOutwardTriangles")->GetTuple1(0) == outward->GetNumberOfPolys() &&
        field->GetArray("NumberOfRecoveredEdges")->GetTuple1(0) == 4 &&
        field->GetArray("EffectiveGapTolerance")->GetTuple1(0) == 0.0,
      "counts stand in the field data");
  }
  Check(kept->GetPoints() == outward->GetPoints() &&
      kept->GetNumberOfPoints() == mesh->GetNumberOfPoints() &&
      kept->GetPoints()->GetDataType() == VTK_DOUBLE,
    "both parts share the points of the input, in double precision");
  Check(kept->GetPointData()->GetArray("Id") == mesh->GetPointData()->GetArray("Id") &&
      outward->GetPointData()->GetArray("Id") == mesh->GetPointData()->GetArray("Id"),
    "point data passes");
  Check(kept->GetFieldData()->GetAbstractArray("UnusedPointIds") != nullptr, "field data passes");
  Check(kept->GetNumberOfVerts() == 1 && kept->GetNumberOfLines() == 1 &&
      outward->GetNumberOfVerts() == 0 && outward->GetNumberOfLines() == 0,
    "vertices and lines are in output 0");

  Check(used->GetNumberOfLines() == 2 && used->GetNumberOfPoints() == 8, "two rings were used");
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  used->GetLines()->GetCellAtId(0, size, ids);
  Check(size == 5 && ids[0] == ids[4], "the line of a ring is closed");
  Check(used->GetPoint(ids[1])[0] == 7.0 && used->GetPoint(ids[1])[2] == 7.0,
    "the ring has the elevation of the boundary");
}

void TestCellData()
{
  auto mesh = MakeMesh();
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputData(mesh);
  trim->SetBoundaryData(MakeRings({ { { 1, 1 }, { 6, 1 }, { 6, 6 }, { 1, 6 } } }));
  trim->RecoverBoundaryOff();
  trim->Update();
  Check(trim->GetOutput(0)->GetNumberOfPolys() == 50, "25 squares are kept");
  Check(NumberOfFindings(trim->GetOutput(0), RulesOfDelaunayPart()) == 0,
    "along edges of the mesh nothing changes");
  Check(trim->GetOutput(0)->GetCellData()->GetArray("Cell")->GetTuple1(0) == 0 &&
      trim->GetOutput(0)->GetCellData()->GetArray("Cell")->GetTuple1(1) == 1,
    "cell data of vertices and lines passes");
  for (int port = 0; port < 2; ++port)
  {
    vtkPolyData* output = trim->GetOutput(port);
    vtkDataArray* cells = output->GetCellData()->GetArray("Cell");
    const vtkIdType first = output->GetNumberOfCells() - output->GetNumberOfPolys();
    Check(cells && cells->GetNumberOfTuples() == output->GetNumberOfCells(), "cell data fits");
    bool isSame = true;
    for (vtkIdType i = 0; i < output->GetNumberOfPolys(); ++i)
    {
      vtkIdType size = 0;
      const vtkIdType* t = nullptr;
      output->GetPolys()->GetCellAtId(i, size, t);
      const vtkIdType sum = t[0] + t[1] + t[2];
      mesh->GetPolys()->GetCellAtId(
        static_cast<vtkIdType>(cells->GetTuple1(first + i)) - 2, size, t);
      isSame = isSame && sum == t[0] + t[1] + t[2];
    }
    Check(isSame, "a triangle keeps its cell data");
  }
}

/** A boundary drawn anywhere: points inside triangles, on edges, outside; a lake in it. */
void TestBoundaryDrawnAnywhere()
{
  auto mesh = MakeMesh();
  vtkNew<vtkDoubleArray> heights; // linear in x,y, but for one value
  heights->SetName("Heights");
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  vtkNew<vtkStringArray> names;
  names->SetName("Names");
  for (vtkIdType i = 0; i < Size * Size; ++i)
  {
    heights->InsertNextValue(3.0 * (i % Size) - 2.0 * (i / Size));
    normals->InsertNextTuple3(i % 2 ? 1.0 : 0.0, i % 2 ? 0.0 : 1.0, 0.0);
    names->InsertNextValue(std::to_string(i));
  }
  mesh->GetPointData()->AddArray(heights);
  mesh->GetPointData()->SetNormals(normals);
  mesh->GetPointData()->AddArray(names);
  const vtkMTimeType time = mesh->GetMTime();
  auto boundary = MakeRings({ { { 1.25, 1.5 }, { 12, 1.5 }, { 12, 7 }, { 1.25, 7 } },
    { { 3.25, 3.25 }, { 5.5, 3.25 }, { 5.5, 5.75 }, { 3.25, 5.75 } } });
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputData(mesh);
  trim->SetBoundaryData(boundary);
  trim->SetBoundaryEdgesToStraight();
  trim->Update();
  vtkPolyData* kept = trim->GetOutput(0);
  vtkPolyData* outward = trim->GetOutput(1);
  Check(mesh->GetMTime() == time && mesh->GetNumberOfPoints() == Size * Size,
    "the input is not written");
  // Six corners that are not points, and (8, 1.5), where the boundary leaves the mesh.
  Check(trim->GetNumberOfInsertedPoints() == 7,
    "inserted points are counted: " + std::to_string(trim->GetNumberOfInsertedPoints()));
  Check(kept->GetFieldData()->GetArray("NumberOfInsertedPoints") &&
      kept->GetFieldData()->GetArray("NumberOfInsertedPoints")->GetTuple1(0) == 7,
    "and stand in the field data");
  Check(ProjectedArea(kept) == 6.75 * 5.5 - 2.25 * 2.5, "the kept triangles cover the inside");
  Check(NumberOfFindings({ kept, outward }, RulesOfConstrained()) == 0,
    "both together cover the input, with all of its points");
  Check(NumberOfFindings(kept, RulesOfSurface()) == 0 &&
      NumberOfFindings(outward, RulesOfSurface()) == 0,
    "both parts are surfaces");
  Check(kept->GetPoints() == outward->GetPoints() &&
      kept->GetNumberOfPoints() == Size * Size + trim->GetNumberOfInsertedPoints(),
    "both have the input's points and the new ones");
  Check(kept->GetPoints()->GetDataType() == VTK_DOUBLE, "points are double where some are new");
  vtkPointData* data = kept->GetPointData();
  Check(data->GetNormals() != nullptr && data->GetNumberOfArrays() == 5, "point data passes");
  for (vtkIdType i = 0; i < kept->GetNumberOfPoints(); ++i)
  {
    double p[3];
    kept->GetPoint(i, p);
    Check(std::fabs(p[2] - (100.0 + p[0] + Size * p[1])) < 1e-12, "the surface stays as it is");
    Check(std::fabs(data->GetArray("Heights")->GetTuple1(i) - (3.0 * p[0] - 2.0 * p[1])) < 1e-12,
      "point data are interpolated");
    const auto id = static_cast<vtkIdType>(data->GetArray("Id")->GetTuple1(i));
    Check(i < Size * Size ? id == i
                          : std::fabs(mesh->GetPoint(id)[0] - p[0]) <= 0.75 &&
          std::fabs(mesh->GetPoint(id)[1] - p[1]) <= 0.75,
      "ids are those of a corner near by");
    Check(vtkStringArray::SafeDownCast(data->GetAbstractArray("Names"))->GetValue(i) ==
        std::to_string(id),
      "strings too");
    const double* n = data->GetNormals()->GetTuple3(i);
    Check(
      std::fabs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0) < 1e-6, "normals keep their length");
  }
  for (vtkPolyData* output : { kept, outward })
  {
    vtkDataArray* cells = output->GetCellData()->GetArray("Cell");
    Check(cells && cells->GetNumberOfTuples() == output->GetNumberOfCells(), "cell data fits");
  }
  Check(trim->GetOutput(2)->GetNumberOfPoints() == 8, "the boundary is shown as it was given");

  // A boundary around everything changes nothing.
  trim->SetBoundaryData(MakeRings({ { { -5, -5 }, { 20, -5 }, { 20, 20 }, { -5, 20 } } }));
  trim->RecoverBoundaryOff();
  trim->Update();
  Check(trim->GetNumberOfInsertedPoints() == 0 && trim->GetNumberOfOutwardTriangles() == 0 &&
      trim->GetOutput(0)->GetNumberOfPoints() == mesh->GetNumberOfPoints() &&
      trim->GetOutput(0)->GetNumberOfPolys() == mesh->GetNumberOfPolys(),
    "a boundary around the mesh keeps it");

  Check(mesh->GetPoints()->GetDataType() == VTK_FLOAT, "the mesh was in single precision");
}

/** The parts of cut triangles have the data of the triangle that they are of. */
void TestCellDataOfParts()
{
  auto mesh = MakeMesh();
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputData(mesh);
  // A small ring in one triangle, around the middle of it: it cuts no other.
  trim->SetBoundaryData(MakeRings({ { { 4.5, 4.125 }, { 4.875, 4.125 }, { 4.75, 4.25 } } }));
  trim->Update();
  Check(trim->GetOutput(0)->GetNumberOfPolys() == 1 && trim->GetNumberOfInsertedPoints() == 3,
    "the ring is one triangle");
  Check(trim->GetOutput(1)->GetNumberOfPolys() == mesh->GetNumberOfPolys() + 5,
    "the others are around it");
  const double parent = trim->GetOutput(0)->GetCellData()->GetArray("Cell")->GetTuple1(2);
  vtkDataArray* cells = trim->GetOutput(1)->GetCellData()->GetArray("Cell");
  int parts = 0;
  for (vtkIdType i = 0; i < cells->GetNumberOfTuples(); ++i)
  {
    parts += cells->GetTuple1(i) == parent;
  }
  Check(parts == 6, "seven parts of one triangle");
}

void TestOutwardTest()
{
  vtkNew<vtkTrimOutwardTriangles> trim;
  Check(trim->GetOutwardTest() == vtkTrimOutwardTriangles::EXACT &&
      std::string(trim->GetOutwardTestAsString()) == "Exact",
    "exact by default");
  trim->SetOutwardTest(7);
  Check(trim->GetOutwardTest() == vtkTrimOutwardTriangles::INWARD_NORMAL &&
      std::string(trim->GetOutwardTestAsString()) == "InwardNormal",
    "clamped from above");
  trim->SetOutwardTest(-7);
  Check(trim->GetOutwardTest() == vtkTrimOutwardTriangles::EXACT, "clamped from below");
  auto mesh = MakeMesh();
  trim->SetInputData(mesh);
  // A lake of one square is emptied; the outside has points that are not on the boundary.
  trim->SetBoundaryData(MakeRings(
    { { { 1, 1 }, { 7, 1 }, { 7, 7 }, { 1, 7 } }, { { 3, 3 }, { 4, 3 }, { 4, 4 }, { 3, 4 } } }));
  trim->SetOutwardTestToInwardNormal();
  trim->Update();
  Check(trim->GetNumberOfOutwardTriangles() == 2 && ProjectedArea(trim->GetOutput(1)) == 1.0,
    "the published test takes the lake, and nothing at points off the boundary");
  Check(ProjectedArea(trim->GetOutput(0)) == 63, "the others stay");
  trim->SetOutwardTestToExact();
  trim->Update();
  Check(ProjectedArea(trim->GetOutput(0)) == 35, "the exact test takes all that is outside");
}

void TestExtractedBoundary()
{
  // Two blocks apart, and a lone point.
  vtkNew<vtkPolyData> cloud;
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 10 * 30; ++i)
  {
    if (i % 30 < 12 || i % 30 > 21)
    {
      points->InsertNextPoint(i % 30, i / 30, 3.0);
    }
  }
  points->InsertNextPoint(16, 40, 0);
  cloud->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  vtkNew<vtkTrimOutwardTriangles> trim;
  trim->SetInputConnection(delaunay->GetOutputPort());
  trim->Update();
  Check(ProjectedArea(trim->GetOutput(0)) == 9 * (11 + 7), "the blocks are kept");
  Check(NumberOfFindings(trim->GetOutput(0), RulesOfDelaunayPart()) == 0 &&
      NumberOfFindings(trim->GetOutput(1), RulesOfDelaunayPart()) == 0,
    "what lies inside and what lies outside are parts of the triangulation");
  Check(trim->GetOutput(2)->GetNumberOfLines() == 2, "each block has its outline");
  Check(trim->GetOutput(2)->GetPoint(0)[2] == 3.0, "the outline has the points' elevation");
  Check(std::fabs(trim->GetEffectiveGapTolerance() - 4.5) < 1e-12, "the tolerance can be read");
  Check(trim->GetNumberOfRecoveredEdges() == 0, "nothing is recovered");
  Check(trim->GetNumberOfPointsLeftOut() == 1 &&
      trim->GetOutput(1)->GetFieldData()->GetArray("NumberOfPointsLeftOut")->GetTuple1(0) == 1,
    "the lone point is reported");
  trim->SetGapTolerance(14.0);
  trim->Update();
  Check(trim->GetOutput(2)->GetNumberOfLines() == 1, "a wide tolerance bridges the gap");
  Check(trim->GetEffectiveGapTolerance() == 14.0, "the tolerance set is the one used");

  // What is left out is reported; a tolerance that is not a number of spacings is refused.
  vtkNew<vtkTest::ErrorObserver> observer;
  trim->AddObserver(vtkCommand::ErrorEvent, observer);
  trim->AddObserver(vtkCommand::WarningEvent, observer);
  vtkNew<vtkTest::ErrorObserver> ofExecutive;
  trim->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, ofExecutive);
  const struct
  {
    double Tolerance;
    const char* Message;
  } wrong[] = { { -1.0, "GapTolerance is -1" }, { std::nan(""), "GapTolerance is nan" },
    { 0.1, "leaves out every point: at a gap tolerance of 0.1 spacings" } };
  for (const auto& tried : wrong)
  {
    observer->Clear();
    trim->SetGapTolerance(tried.Tolerance);
    trim->Update();
    Check(observer->GetErrorMessage().find(tried.Message) != std::string::npos, tried.Message);
    Check(trim->GetOutput(0)->GetNumberOfPoints() == 0, "an error leaves empty outputs");
  }
  // Of the same cloud without most of the blocks, the lone point is much.
  observer->Clear();
  vtkNew<vtkPoints> few;
  for (vtkIdType i = 0; i < 8; ++i)
  {
    few->InsertNextPoint(i % 4, i / 4, 0.0);
    few->InsertNextPoint(i % 4, 2 + i / 4, 0.0);
  }
  few->InsertNextPoint(40, 1, 0);
  cloud->SetPoints(few);
  trim->SetGapTolerance(0.0);
  trim->Update();
  for (const char* part :
    { "leaves out 1 point (5.9 %) and", "A larger GapTolerance keeps more: try " })
  {
    Check(observer->GetWarningMessage().find(part) != std::string::npos, part);
  }
  Check(trim->GetOutput(0)->GetNumberOfPolys() == 18, "the rest is surface");
}

/** The corners of all triangles of an output, in their order. */
std::vector<vtkIdType> CornersOf(vtkPolyData* output)
{
  std::vector<vtkIdType> corners;
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < output->GetNumberOfPolys(); ++i)
  {
    output->GetPolys()->GetCellAtId(i, ids);
    corners.insert(corners.end(), ids->begin(), ids->end());
  }
  return corners;
}

/** The published test along a boundary that is extracted. */
void TestInwardNormalExtracted()
{
  // A block with an empty lake and an empty bay: what is outside has corners on the boundary alone.
  vtkNew<vtkPolyData> cloud;
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 40 * 40; ++i)
  {
    const int x = i % 40, y = i / 40;
    const bool isLake = std::hypot(x - 15.0, y - 20.0) < 9.5;
    const bool isBay = x > 30 && y > 10 && y < 20;
    if (!isLake && !isBay)
    {
      points->InsertNextPoint(x, y, 3.0);
    }
  }
  cloud->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  vtkNew<vtkTrimOutwardTriangles> exact;
  exact->SetInputConnection(delaunay->GetOutputPort());
  exact->Update();
  vtkNew<vtkTrimOutwardTriangles> published;
  published->SetInputConnection(delaunay->GetOutputPort());
  published->SetOutwardTestToInwardNormal();
  published->Update();
  Check(exact->GetNumberOfOutwardTriangles() > 10, "the lake and the bay are outward");
  for (int port = 0; port < 2; ++port)
  {
    Check(CornersOf(exact->GetOutput(port)) == CornersOf(published->GetOutput(port)),
      "without points outside, the published test takes what the exact one takes");
  }
  Check(published->GetOutput(2)->GetNumberOfLines() == 2 &&
      published->GetOutput(2)->GetNumberOfPoints() == exact->GetOutput(2)->GetNumberOfPoints() &&
      published->GetEffectiveGapTolerance() == exact->GetEffectiveGapTolerance(),
    "the boundary is the same");

  // A lone point in the lake is left out; the triangles at it are not on the boundary alone.
  points->InsertNextPoint(15.0, 20.0, 3.0);
  points->Modified();
  cloud->Modified();
  exact->Update();
  published->Update();
  const std::vector<vtkIdType> kept = CornersOf(published->GetOutput(0));
  const std::vector<vtkIdType> exactlyKept = CornersOf(exact->GetOutput(0));
  const vtkIdType lone = cloud->GetNumberOfPoints() - 1;
  const auto atLone = std::count(kept.begin(), kept.end(), lone);
  Check(exact->GetNumberOfPointsLeftOut() == 1 && published->GetNumberOfPointsLeftOut() == 0,
    "points left out are counted by the exact test alone");
  Check(atLone > 0 && std::count(exactlyKept.begin(), exactlyKept.end(), lone) == 0,
    "the published test keeps triangles at a point outside");
  Check(published->GetNumberOfOutwardTriangles() <= exact->GetNumberOfOutwardTriangles() - atLone &&
      published->GetNumberOfOutwardTriangles() > 0,
    "and takes others");
}

/**
 * One clockwise triangle sends the whole mesh the slow way, where it is turned: the outputs are
 * those of the mesh without it. So are they with ids of 64 bits.
 */
void TestBothWaysAgree()
{
  vtkNew<vtkPolyData> cloud;
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 60 * 60; ++i)
  {
    if (std::hypot(i % 60 - 30.0, i / 60 - 20.0) > 8.0)
    {
      points->InsertNextPoint(i % 60 + 0.3 * std::sin(i), i / 60 + 0.3 * std::cos(3.0 * i), 1.0);
    }
  }
  cloud->SetPoints(points);
  vtkNew<vtkGridDelaunay2D> delaunay;
  delaunay->SetInputData(cloud);
  delaunay->Update();
  vtkNew<vtkPolyData> inOrder;
  inOrder->ShallowCopy(delaunay->GetOutput());
  vtkNew<vtkIdTypeArray> cellIds;
  cellIds->SetName("Cell");
  for (vtkIdType i = 0; i < inOrder->GetNumberOfPolys(); ++i)
  {
    cellIds->InsertNextValue(i);
  }
  inOrder->GetCellData()->AddArray(cellIds);
  vtkNew<vtkPolyData> wide;
  wide->ShallowCopy(inOrder);
  vtkNew<vtkCellArray> wideCells;
  wideCells->DeepCopy(inOrder->GetPolys());
  wideCells->ConvertTo64BitStorage();
  wide->SetPolys(wideCells);
  vtkNew<vtkPolyData> turned;
  turned->ShallowCopy(inOrder);
  vtkNew<vtkCellArray> turnedCells;
  turnedCells->DeepCopy(inOrder->GetPolys());
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  turnedCells->GetCellAtId(7, size, ids);
  turnedCells->ReplaceCellAtId(7, 3, std::array<vtkIdType, 3>{ { ids[0], ids[2], ids[1] } }.data());
  turned->SetPolys(turnedCells);
  auto drawn = MakeRings({ { { -5, 10 }, { 20, 12.5 }, { 70, 9 }, { 50, 50 }, { 4, 44 } },
    { { 30, 20 }, { 40, 20 }, { 35, 41 } } });
  for (vtkPolyData* boundary : { static_cast<vtkPolyData*>(nullptr), drawn.Get() })
  {
    vtkNew<vtkTrimOutwardTriangles> expected;
    expected->SetInputData(inOrder);
    expected->SetBoundaryData(boundary);
    expected->Update();
    Check(expected->GetNumberOfOutwardTriangles() > 0, "there is something outward");
    for (vtkPolyData* mesh : { wide.Get(), turned.Get() })
    {
      vtkNew<vtkTrimOutwardTriangles> trim;
      trim->SetInputData(mesh);
      trim->SetBoundaryData(boundary);
      trim->Update();
      Check(trim->GetEffectiveGapTolerance() == expected->GetEffectiveGapTolerance() &&
          trim->GetNumberOfRecoveredEdges() == expected->GetNumberOfRecoveredEdges() &&
          trim->GetNumberOfInsertedPoints() == expected->GetNumberOfInsertedPoints(),
        "the counts are the same both ways");
      for (int port = 0; port < 3; ++port)
      {
        vtkPolyData* a = expected->GetOutput(port);
        vtkPolyData* b = trim->GetOutput(port);
        bool isSame = AreSame(a, b);
        for (vtkIdType i = 0; isSame && port != 2 && i < a->GetNumberOfCells(); ++i)
        {
          vtkDataArray* ofA = a->GetCellData()->GetArray("Cell");
          vtkDataArray* ofB = b->GetCellData()->GetArray("Cell");
          isSame = ofA->GetTuple1(i) == ofB->GetTuple1(i);
        }
        Check(isSame, "the outputs are the same both ways");
      }
    }
  }
}
} // namespace

int TestTrimOutwardTriangles(int, char*[])
{
  TestGivenBoundary();
  TestCellData();
  TestBoundaryDrawnAnywhere();
  TestCellDataOfParts();
  TestOutwardTest();
  TestExtractedBoundary();
  TestInwardNormalExtracted();
  TestBothWaysAgree();
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
