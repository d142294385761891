// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What new points and triangles get of arrays of every kind: all attributes of VTK, types of
// several widths and memory layouts, several components, and arrays without a name.
#include "Check.h"
#include "SheetOfSquares.h"
#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFillElevationHoles.h"
#include "vtkFloatArray.h"
#include "vtkIdTypeArray.h"
#include "vtkLongLongArray.h"
#include "vtkLookupTable.h"
#include "vtkPointData.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkShortArray.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedLongLongArray.h"
#include "vtkVariantArray.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

namespace
{
/** Component c of a linear array at a place: what all methods but the mean continue exactly. */
double Linear(double x, double y, int c)
{
  return 5.0 + (c + 1) * x - 2.0 * c * y;
}

template <typename Array>
vtkSmartPointer<Array> MakeLinear(vtkPolyData* surface, const char* name, int components)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(surface->GetNumberOfPoints());
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double p[3];
    surface->GetPoint(i, p);
    for (int c = 0; c < components; ++c)
    {
      array->SetComponent(i, c, Linear(p[0], p[1], c));
    }
  }
  return array;
}

/** Value c of tuple i is 3 i + c + 1. */
template <typename Array>
vtkSmartPointer<Array> MakeNumbered(vtkIdType tuples, const char* name, int components)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < tuples; ++i)
  {
    for (int c = 0; c < components; ++c)
    {
      array->SetComponent(i, c, static_cast<double>(3 * i + c + 1));
    }
  }
  return array;
}

vtkSmartPointer<vtkStringArray> MakeNames(vtkIdType tuples, const char* name, int components)
{
  auto array = vtkSmartPointer<vtkStringArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  for (vtkIdType i = 0; i < components * tuples; ++i)
  {
    array->InsertNextValue("n" + std::to_string(i));
  }
  return array;
}

/** A sheet with a hole in which some new points have several neighbours. */
vtkSmartPointer<vtkPolyData> MakeInput()
{
  auto input = MakeSheet(
    { "########", "########", "##    ##", "##    ##", "##  ####", "########", "########" },
    VTK_DOUBLE, [](double x, double y) { return 3.0 + 0.5 * x - y; });
  const vtkIdType points = input->GetNumberOfPoints();
  vtkPointData* ofPoints = input->GetPointData();
  ofPoints->SetVectors(MakeLinear<vtkFloatArray>(input, "Wind", 3));
  ofPoints->SetTCoords(MakeLinear<vtkFloatArray>(input, "Texture", 2));
  ofPoints->SetTensors(MakeLinear<vtkDoubleArray>(input, "Stress", 9));
  ofPoints->AddArray(MakeLinear<vtkSOADataArrayTemplate<float>>(input, "Separate", 3));
  ofPoints->GetArray("Wind")->SetComponentName(1, "north");
  vtkNew<vtkLookupTable> colors;
  ofPoints->GetArray("Wind")->SetLookupTable(colors);
  auto unnamed = MakeLinear<vtkDoubleArray>(input, "", 1);
  unnamed->SetName(nullptr);
  ofPoints->AddArray(unnamed);

  ofPoints->SetScalars(MakeNumbered<vtkUnsignedCharArray>(points, "Colors", 3));
  ofPoints->AddArray(MakeNumbered<vtkIdTypeArray>(points, "Trace", 1));
  ofPoints->AddArray(MakeNumbered<vtkLongLongArray>(points, "Time", 1));
  ofPoints->AddArray(MakeNumbered<vtkShortArray>(points, "Pair", 2));
  ofPoints->SetPedigreeIds(MakeNames(points, "Origin", 1));
  ofPoints->AddArray(MakeNames(points, "TwoNames", 2));
  vtkNew<vtkVariantArray> variants;
  variants->SetName("Variant");
  vtkNew<vtkBitArray> bits;
  bits->SetName("Bit");
  for (vtkIdType i = 0; i < points; ++i)
  {
    variants->InsertNextValue(vtkVariant(static_cast<int>(i)));
    bits->InsertNextValue(i % 2);
  }
  ofPoints->AddArray(variants);
  ofPoints->AddArray(bits);

  const vtkIdType cells = input->GetNumberOfCells();
  vtkCellData* ofCells = input->GetCellData();
  ofCells->SetGlobalIds(MakeNumbered<vtkIdTypeArray>(cells, "CellIds", 1));
  ofCells->SetPedigreeIds(MakeNames(cells, "CellOrigin", 1));
  ofCells->SetVectors(MakeNumbered<vtkFloatArray>(cells, "Flow", 3));
  ofCells->SetScalars(MakeNumbered<vtkUnsignedCharArray>(cells, "CellColors", 4));
  auto ghosts = MakeNumbered<vtkUnsignedCharArray>(cells, vtkDataSetAttributes::GhostArrayName(), 1);
  for (vtkIdType i = 0; i < cells; ++i)
  {
    ghosts->SetValue(i, ghosts->GetValue(i) & ~vtkDataSetAttributes::HIDDENCELL);
  }
  ofCells->AddArray(ghosts);
  return input;
}

/** All tuples of arrays of the input are there, in arrays of the same kind. */
void CheckFirstTuples(vtkDataSetAttributes* before, vtkDataSetAttributes* after, vtkIdType tuples)
{
  for (int i = 0; i < before->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* old = before->GetAbstractArray(i);
    vtkAbstractArray* kept = after->GetAbstractArray(i);
    const std::string name = old->GetName() ? old->GetName() : "the array without a name";
    Check(kept->GetName() ? name == kept->GetName() : !old->GetName(), name + " keeps its name");
    Check(kept->GetDataType() == old->GetDataType() &&
        kept->GetNumberOfComponents() == old->GetNumberOfComponents() &&
        kept->GetNumberOfTuples() == tuples,
      name + " keeps its type");
    bool isSame = true;
    for (vtkIdType k = 0; k < old->GetNumberOfValues(); ++k)
    {
      isSame = isSame && kept->GetVariantValue(k) == old->GetVariantValue(k);
    }
    Check(isSame, name + " keeps its values");
  }
}

void TestPoints(vtkPolyData* input, vtkPolyData* output)
{
  vtkPointData* data = output->GetPointData();
  const vtkIdType before = input->GetNumberOfPoints();
  const vtkIdType points = output->GetNumberOfPoints();
  CheckFirstTuples(input->GetPointData(), data, points);
  Check(points - before >= 4, "the hole gets points");
  Check(data->GetVectors() && data->GetVectors() == data->GetArray("Wind"), "vectors");
  Check(
    data->GetTCoords() && data->GetTCoords() == data->GetArray("Texture"), "texture coordinates");
  Check(data->GetTensors() && data->GetTensors() == data->GetArray("Stress"), "tensors");
  Check(data->GetScalars() && data->GetScalars() == data->GetArray("Colors"), "scalars");
  Check(data->GetPedigreeIds() && data->GetPedigreeIds() == data->GetAbstractArray("Origin"),
    "pedigree ids keep their role");
  Check(std::string(data->GetArray("Wind")->GetComponentName(1)) == "north", "component names");
  Check(data->GetArray("Wind")->GetLookupTable() != nullptr, "and lookup tables pass");

  auto* names = vtkStringArray::SafeDownCast(data->GetAbstractArray("Origin"));
  auto* twoNames = vtkStringArray::SafeDownCast(data->GetAbstractArray("TwoNames"));
  auto* variants = vtkVariantArray::SafeDownCast(data->GetAbstractArray("Variant"));
  for (vtkIdType i = before; i < points; ++i)
  {
    double p[3];
    output->GetPoint(i, p);
    for (int k = 0; k < data->GetNumberOfArrays(); ++k)
    {
      vtkDataArray* array = data->GetArray(k);
      const std::string name = array && array->GetName() ? array->GetName() : "";
      const bool isAttribute =
        array && name != "FilledError" && name != "FilledLow" && name != "FilledHigh";
      const int type = isAttribute ? array->GetDataType() : 0;
      for (int c = 0;
           c < (type == VTK_FLOAT || type == VTK_DOUBLE ? array->GetNumberOfComponents() : 0); ++c)
      {
        const double difference = array->GetComponent(i, c) - Linear(p[0], p[1], c);
        Check(std::fabs(difference) < (type == VTK_FLOAT ? 1e-4 : 1e-9),
          "floating-point components are continued as z is");
      }
    }

    // All others come from one point of the boundary, the nearest.
    const vtkIdType nearest =
      static_cast<vtkIdType>(data->GetArray("Trace")->GetComponent(i, 0) - 1.0) / 3;
    double q[3];
    input->GetPoint(nearest, q);
    Check(std::hypot(p[0] - q[0], p[1] - q[1]) <= std::sqrt(2.0), "which is near");
    const double number = static_cast<double>(3 * nearest);
    Check(data->GetArray("Time")->GetComponent(i, 0) == number + 1.0, "64-bit integers");
    Check(data->GetArray("Pair")->GetComponent(i, 0) == number + 1.0 &&
        data->GetArray("Pair")->GetComponent(i, 1) == number + 2.0,
      "several integers");
    for (int c = 0; c < 3; ++c)
    {
      Check(data->GetArray("Colors")->GetComponent(i, c) ==
          input->GetPointData()->GetArray("Colors")->GetComponent(nearest, c),
        "colours");
    }
    Check(data->GetArray("Bit")->GetComponent(i, 0) == static_cast<double>(nearest % 2), "bits");
    Check(names->GetValue(i).empty(), "new points have no pedigree ids");
    Check(twoNames->GetValue(2 * i + 1) == "n" + std::to_string(2 * nearest + 1), "two strings");
    Check(variants->GetValue(i).ToInt() == nearest, "variants");
  }
}

void TestCells(vtkPolyData* input, vtkPolyData* output)
{
  vtkCellData* data = output->GetCellData();
  CheckFirstTuples(input->GetCellData(), data, output->GetNumberOfCells());
  Check(data->GetGlobalIds() == data->GetArray("CellIds"), "global ids of cells stay global ids");
  Check(data->GetPedigreeIds() != nullptr && data->GetVectors() != nullptr &&
      data->GetScalars() == data->GetArray("CellColors"),
    "other attributes of cells keep their roles");
  auto* names = vtkStringArray::SafeDownCast(data->GetAbstractArray("CellOrigin"));
  const vtkIdType cells = input->GetNumberOfCells();
  for (vtkIdType i = cells; i < output->GetNumberOfCells(); ++i)
  {
    Check(data->GetArray("CellIds")->GetComponent(i, 0) == 3.0 * cells - 1.0 + (i - cells),
      "new triangles have ids after the largest");
    Check(names->GetValue(i).empty(), "no name for new triangles");
    Check(std::isnan(data->GetArray("Flow")->GetComponent(i, 2)), "NaN for floating point");
    Check(data->GetArray("CellColors")->GetComponent(i, 3) == 0.0, "0 for colours");
    Check(data->GetArray(vtkDataSetAttributes::GhostArrayName())->GetComponent(i, 0) == 0.0,
      "new triangles are no ghosts");
  }
}

/** Ids are not interpolated, whatever their type; global ids go on where the type has numbers. */
void TestIds()
{
  auto input = MakeInput();
  const vtkIdType points = input->GetNumberOfPoints();
  const vtkIdType cells = input->GetNumberOfCells();
  input->GetPointData()->SetGlobalIds(MakeNumbered<vtkUnsignedLongLongArray>(points, "Large", 1));
  input->GetPointData()->GetGlobalIds()->SetComponent(0, 0, 9007199254740992.0);
  input->GetPointData()->SetPedigreeIds(MakeNumbered<vtkDoubleArray>(points, "Real", 1));
  input->GetCellData()->SetPedigreeIds(MakeNumbered<vtkUnsignedCharArray>(cells, "Small", 1));
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->Update();
  vtkPolyData* output = fill->GetOutput();
  vtkPointData* ofPoints = output->GetPointData();
  auto* large = vtkUnsignedLongLongArray::SafeDownCast(ofPoints->GetArray("Large"));
  Check(!ofPoints->GetGlobalIds(), "without numbers for new points, ids are no global ids");
  Check(ofPoints->GetPedigreeIds() == ofPoints->GetArray("Real"), "pedigree ids of a point");
  for (vtkIdType i = points; i < output->GetNumberOfPoints(); ++i)
  {
    Check(large->GetValue(i) == ~0ull, "the largest number for unsigned ids");
    Check(std::isnan(ofPoints->GetArray("Real")->GetComponent(i, 0)), "NaN for real ids");
    double p[3];
    output->GetPoint(i, p);
    const double wind = ofPoints->GetArray("Wind")->GetComponent(i, 1);
    Check(std::fabs(wind - Linear(p[0], p[1], 1)) < 1e-4, "other arrays get their own values");
  }
  for (vtkIdType i = cells; i < output->GetNumberOfCells(); ++i)
  {
    Check(output->GetCellData()->GetArray("Small")->GetComponent(i, 0) == 255.0, "also of a byte");
  }
}

/** Hidden cells are left out with their values, ids among them. */
void TestHiddenCells()
{
  auto input = MakeInput();
  const vtkIdType cells = input->GetNumberOfCells();
  auto* const ghosts = vtkUnsignedCharArray::SafeDownCast(
    input->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
  ghosts->SetValue(0, vtkDataSetAttributes::HIDDENCELL);
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->Update();
  auto* const ids = vtkIdTypeArray::SafeDownCast(fill->GetOutput()->GetCellData()->GetGlobalIds());
  auto* const names =
    vtkStringArray::SafeDownCast(fill->GetOutput()->GetCellData()->GetPedigreeIds());
  Check(ids && names && fill->GetNumberOfFilledHoles() >= 1, "a surface with a hidden cell is filled");
  for (vtkIdType cell = 0; ids && names && cell + 1 < cells; ++cell)
  {
    Check(ids->GetValue(cell) == 3 * (cell + 1) + 1, "global ids of the cells that are left");
    Check(names->GetValue(cell) == "n" + std::to_string(cell + 1), "and their pedigree ids");
  }
}
} // namespace

int TestFillElevationHolesAttributes(int, char*[])
{
  auto input = MakeInput();
  vtkNew<vtkFillElevationHoles> fill;
  fill->SetInputData(input);
  fill->Update();
  Check(fill->GetNumberOfFilledHoles() == 1, "the hole is filled");
  TestPoints(input, fill->GetOutput());
  TestCells(input, fill->GetOutput());
  TestHiddenCells();
  TestIds();
  // The rims of the second output have the arrays of points.
  vtkPolyData* rims = fill->GetOutput(1);
  Check(rims->GetPointData()->GetAbstractArray("Origin") != nullptr &&
      rims->GetPointData()->GetVectors() != nullptr,
    "rims have the arrays of their points");
  return failures ? EXIT_FAILURE : EXIT_SUCCESS;
}
