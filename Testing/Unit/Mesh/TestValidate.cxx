// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/Validate.h"

#include <gtest/gtest.h>

using namespace elevation;

namespace
{
/** Two triangles of a unit square, cut from its lowest corner, and a point in the middle of
 * nowhere. */
Mesh Square()
{
  Mesh mesh;
  mesh.Points = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
  mesh.Triangles = { 0, 1, 2, 0, 2, 3 };
  return mesh;
}

/** The rules a mesh breaks, once each. */
std::vector<Rule> BrokenRules(const Mesh& mesh, const ValidateOptions& options = ValidateOptions())
{
  std::vector<Rule> rules;
  for (const Finding& finding : Validate(mesh, options))
  {
    EXPECT_FALSE(finding.Message.empty());
    if (rules.empty() || rules.back() != finding.Broken)
    {
      rules.push_back(finding.Broken);
    }
  }
  return rules;
}
} // namespace

TEST(Validate, FindsNothingInASquare)
{
  EXPECT_TRUE(Validate(Square()).empty());
}

TEST(Validate, FindsIdsThatAreNotPoints)
{
  Mesh mesh = Square();
  mesh.Triangles[4] = 4;
  EXPECT_EQ(BrokenRules(mesh), std::vector<Rule>{ Rule::Ids });
  mesh.Triangles[4] = -1;
  EXPECT_EQ(BrokenRules(mesh), std::vector<Rule>{ Rule::Ids });
  mesh.Triangles[4] = 0;
  EXPECT_EQ(BrokenRules(mesh), std::vector<Rule>{ Rule::Ids });
}

TEST(Validate, FindsClockwiseAndFlatTriangles)
{
  Mesh mesh = Square();
  std::swap(mesh.Triangles[1], mesh.Triangles[2]);
  EXPECT_EQ(BrokenRules(mesh), std::vector<Rule>{ Rule::Orientation });
  mesh = Square();
  mesh.Points[1] = { 0.5, 0.5 };
  EXPECT_EQ(BrokenRules(mesh), std::vector<Rule>{ Rule::Orientation });
}

TEST(Validate, FindsEdgesOfThreeTriangles)
{
  Mesh mesh = Square();
  mesh.Points.push_back({ 0.5, 2.0 });
  mesh.Triangles.insert(mesh.Triangles.end(), { 0, 2, 4 });
  EXPECT_EQ(BrokenRules(mesh), std::vector<Rule>{ Rule::Manifold });
}

TEST(Validate, FindsAPointInACircle)
{
  Mesh mesh = Square();
  mesh.Points[3] = { 0.1, 0.9 };
  EXPECT_EQ(BrokenRules(mesh), std::vector<Rule>{ Rule::EmptyCircle });
  ValidateOptions options;
  const std::vector<char> constrained{ 0, 0, 1, 1, 0, 0 };
  options.Constrained = &constrained;
  EXPECT_TRUE(Validate(mesh, options).empty()) << "constrained edges are exempt";
}

TEST(Validate, FindsTheWrongDiagonalOfASquare)
{
  Mesh mesh = Square();
  mesh.Triangles = { 0, 1, 3, 1, 2, 3 };
  EXPECT_EQ(BrokenRules(mesh), std::vector<Rule>{ Rule::TieRule });
}

TEST(Validate, FindsABorderThatIsNotTheHull)
{
  Mesh mesh = Square();
  mesh.Points.push_back({ 0.25, 0.5 });
  mesh.Triangles = { 0, 1, 4, 1, 2, 4, 2, 3, 4 }; // the triangle 0, 4, 3 is missing
  EXPECT_EQ(BrokenRules(mesh), std::vector<Rule>{ Rule::Hull });
}

TEST(Validate, FindsABorderThatWindsAroundTwice)
{
  // A fan of ten triangles twice around its middle: nowhere does the border turn inwards.
  Mesh mesh;
  mesh.Points = { { 0, 0 } };
  const Point2 corners[] = { { 4, 0 }, { 1, 4 }, { -3, 2 }, { -3, -2 }, { 1, -4 } };
  for (Index i = 0; i < 10; ++i)
  {
    mesh.Points.push_back(corners[i % 5]);
    mesh.Triangles.insert(mesh.Triangles.end(), { 0, 1 + i, 1 + (i + 1) % 10 });
  }
  ValidateOptions options;
  options.Delaunay = options.Overlap = false;
  EXPECT_EQ(BrokenRules(mesh, options), std::vector<Rule>{ Rule::Hull });
}

TEST(Validate, FindsPointsLeftOut)
{
  Mesh mesh = Square();
  mesh.Points.push_back({ 0.5, 0.5 });
  EXPECT_EQ(BrokenRules(mesh), std::vector<Rule>{ Rule::Vertices });
  ValidateOptions options;
  const std::vector<Index> unused{ 4 };
  options.UnusedPoints = &unused;
  EXPECT_TRUE(Validate(mesh, options).empty());
  const std::vector<Index> tooMany{ 3, 4 };
  options.UnusedPoints = &tooMany;
  EXPECT_EQ(BrokenRules(mesh, options), std::vector<Rule>{ Rule::Vertices });
}

TEST(Validate, FindsPlacesCoveredTwice)
{
  Mesh mesh = Square();
  mesh.Points.insert(mesh.Points.end(), { { 0.2, 0.1 }, { 0.8, 0.1 }, { 0.8, 0.4 } });
  mesh.Triangles.insert(mesh.Triangles.end(), { 4, 5, 6 });
  ValidateOptions options;
  options.ConvexHull = false;
  EXPECT_EQ(BrokenRules(mesh, options), std::vector<Rule>{ Rule::Overlap });
}
