// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/Validate.h"

#include <gtest/gtest.h>

#include <limits>

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

TEST(Validate, FindsCornersThatMakeNoTriangle)
{
  Mesh mesh = Square();
  mesh.Triangles.push_back(0);
  EXPECT_EQ(BrokenRules(mesh), std::vector<Rule>{ Rule::Ids });
}

TEST(Validate, ReportsNoMoreFindingsThanWanted)
{
  Mesh mesh = Square();
  mesh.Triangles = { 0, 1, 4, 0, 2, 5, 0, 3, 6 };
  EXPECT_EQ(Validate(mesh).size(), 3u);
  ValidateOptions options;
  options.MaximumFindings = 2;
  EXPECT_EQ(Validate(mesh, options).size(), 2u);
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

TEST(Validate, FindsABorderOfTwoLoops)
{
  Mesh mesh = Square();
  for (const Point2& p : Square().Points)
  {
    mesh.Points.push_back({ p.X + 2.0, p.Y });
  }
  mesh.Triangles.insert(mesh.Triangles.end(), { 4, 5, 6, 4, 6, 7 });
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

TEST(Validate, FindsPointsTooFarAboveOrBelowTheMesh)
{
  Mesh mesh = Square();
  mesh.Points.insert(mesh.Points.end(), { { 0.75, 0.25 }, { 0.75, 0.25 }, { 0.25, 0.75 } });
  // On the plane z = x + 2 y the elevation of both places is 1.25 and 1.75.
  const std::vector<double> xyz{ 0, 0, 0, 1, 0, 1, 1, 1, 3, 0, 1, 2, //
    0.75, 0.25, 1.5, 0.75, 0.25, 1.0, 0.25, 0.75, 1.75 };
  const PointView points{ nullptr, xyz.data(), 7 };
  EXPECT_EQ(ToString(ValidateDistance(mesh, points, 0.2500001, 0.0, {})), "");
  const std::vector<Finding> findings = ValidateDistance(mesh, points, 0.2499999, 0.0, {});
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].Broken, Rule::Distance);
  EXPECT_EQ(findings[0].Where, 4);
  EXPECT_EQ(findings[1].Where, 5);
  EXPECT_EQ(ToString(findings), findings[0].Message + "\n" + findings[1].Message + "\n");
  EXPECT_EQ(ValidateDistance(mesh, points, 0.2, 0.0, {}, 1).size(), 1u);
  const std::vector<Finding> others = ValidateDistance(mesh, points, 0.2, 0.0, { 4 });
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(others[0].Where, 5);
}

TEST(Validate, FindsPointsBesideTheMeshUnlessTheyAreNear)
{
  Mesh mesh = Square();
  mesh.Points.push_back({ 0.5, -0.125 });
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> xyz{ 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, -0.125, 1, //
    nan, 0, 0, 0, nan, 0, 0, 0, nan };
  const PointView points{ nullptr, xyz.data(), 8 };
  const auto count = [&](double most, double besideBy) {
    return ValidateDistance(mesh, points, most, besideBy, {}).size();
  };
  EXPECT_EQ(count(2.0, 0.0), 1u) << "points that are not finite are exempt";
  EXPECT_EQ(count(2.0, 0.1249), 1u);
  EXPECT_EQ(count(2.0, 0.1251), 0u);
  EXPECT_EQ(count(0.5, 0.1251), 1u) << "it is measured from the plane beside it";
  EXPECT_NE(
    ToString(ValidateDistance(mesh, points, 2.0, 0.0, {})).find("beside"), std::string::npos);
}
