// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DelaunayMesh.h"
#include "ErrorMessage.h"
#include "WorkOf.h"

#include "Kernel/Base/Predicates.h"
#include "Kernel/Mesh/RecoverSegments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

using namespace elevation;
using namespace testing_surfaces;

namespace
{

/** The rules of a constrained Delaunay mesh; both sides of an edge are constrained, or none. */
void ExpectConstrainedDelaunay(const Mesh& mesh, const std::vector<char>& constrained)
{
  ASSERT_EQ(constrained.size(), mesh.Triangles.size());
  ValidateOptions rules = RulesOfSurface();
  rules.Delaunay = true;
  rules.Constrained = &constrained;
  ASSERT_EQ(FindingsOf(mesh, rules), "");
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    ASSERT_TRUE(mesh.IsBorder(h) || constrained[h] == constrained[mesh.Twin(h)]);
  }
}

bool LiesBetween(const Point2& a, const Point2& b, const Point2& p)
{
  return Orientation(a, b, p) == Zero && std::min(a.X, b.X) <= p.X && p.X <= std::max(a.X, b.X) &&
    std::min(a.Y, b.Y) <= p.Y && p.Y <= std::max(a.Y, b.Y);
}

/** The constrained edges are those of the segments, cut at the vertices on them; no others. */
void ExpectEdgesOf(
  const Mesh& mesh, const std::vector<Segment>& segments, const std::vector<char>& constrained)
{
  using Edge = std::pair<Index, Index>;
  std::set<Edge> expected;
  for (const Segment& s : segments)
  {
    const Point2& a = mesh.PointOf(s.A);
    const Point2& b = mesh.PointOf(s.B);
    std::vector<Index> on;
    for (Index v = 0; v < mesh.NumberOfPoints(); ++v)
    {
      if (LiesBetween(a, b, mesh.PointOf(v)))
      {
        on.push_back(v);
      }
    }
    std::sort(on.begin(), on.end(),
      [&](Index v, Index w) { return IsLower(mesh.PointOf(v), mesh.PointOf(w)); });
    for (std::size_t i = 1; i < on.size(); ++i)
    {
      expected.insert(std::minmax(on[i - 1], on[i]));
    }
  }
  std::set<Edge> found;
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    if (constrained[h])
    {
      found.insert(std::minmax(mesh.Origin(h), mesh.Destination(h)));
    }
  }
  EXPECT_EQ(found, expected);
}

/** Whether the segments have more in common than end points, or points through which both run. */
bool Cross(const Mesh& mesh, const Segment& s, const Segment& t)
{
  const Point2& a = mesh.PointOf(s.A);
  const Point2& b = mesh.PointOf(s.B);
  const Point2& c = mesh.PointOf(t.A);
  const Point2& d = mesh.PointOf(t.B);
  return Orientation(a, b, c) * Orientation(a, b, d) < 0 &&
    Orientation(c, d, a) * Orientation(c, d, b) < 0;
}

bool CrossInVertex(const Mesh& mesh, const Segment& s, const Segment& t)
{
  for (const Point2& p : mesh.Points)
  {
    if (LiesBetween(mesh.PointOf(s.A), mesh.PointOf(s.B), p) &&
      LiesBetween(mesh.PointOf(t.A), mesh.PointOf(t.B), p))
    {
      return true;
    }
  }
  return false;
}

std::vector<Segment> RandomSegments(Random& random, const Mesh& mesh, int tries)
{
  std::vector<Segment> segments;
  for (int i = 0; i < tries; ++i)
  {
    const Segment s{ random.Below(mesh.NumberOfPoints()), random.Below(mesh.NumberOfPoints()) };
    bool fits = s.A != s.B;
    for (const Segment& t : segments)
    {
      fits = fits && (!Cross(mesh, s, t) || CrossInVertex(mesh, s, t));
    }
    if (fits)
    {
      segments.push_back(s);
    }
  }
  return segments;
}

void CheckRandomSegments(Random& random, const std::vector<Point2>& points, int tries)
{
  Mesh mesh = Delaunay(points);
  if (mesh.Triangles.empty())
  {
    return; // all on one line
  }
  const Mesh before = mesh;
  std::vector<Segment> segments = RandomSegments(random, mesh, tries);
  std::vector<char> constrained;
  RecoverSegments(mesh, segments, constrained);
  EXPECT_EQ(mesh.NumberOfTriangles(), before.NumberOfTriangles());
  ExpectConstrainedDelaunay(mesh, constrained);
  ExpectEdgesOf(mesh, segments, constrained);

  // The same set of triangles from the same positions in another order.
  std::vector<Index> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    order[i] = static_cast<Index>(i);
  }
  random.Shuffle(order);
  std::vector<Point2> shuffledPoints(points.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    shuffledPoints[order[i]] = points[i];
  }
  Mesh shuffled = Delaunay(shuffledPoints);
  for (Segment& s : segments)
  {
    s = { order[s.B], order[s.A] };
  }
  random.Shuffle(segments);
  std::vector<char> shuffledConstrained;
  RecoverSegments(shuffled, segments, shuffledConstrained);
  EXPECT_EQ(PositionsOf(shuffled), PositionsOf(mesh));

  // Asked for again, nothing is missing and nothing changes.
  const Mesh once = shuffled;
  EXPECT_EQ(RecoverSegments(shuffled, segments, shuffledConstrained), 0);
  EXPECT_EQ(shuffled.Triangles, once.Triangles);
}

std::string MessageOf(Mesh mesh, const std::vector<Segment>& segments)
{
  std::vector<char> constrained;
  return testing_errors::MessageFrom([&]() { RecoverSegments(mesh, segments, constrained); });
}

} // namespace

TEST(Constraints, OfRandomSegmentsGiveConstrainedDelaunayMeshes)
{
  Random random(1);
  for (int round = 0; round < 400 && !HasFailure(); ++round)
  {
    CheckRandomSegments(random, ScatteredPoints(random, 4 + random.Below(80)), 40);
  }
}

TEST(Constraints, ThroughVerticesOfALatticeBecomeChains)
{
  Random random(2);
  for (int round = 0; round < 800 && !HasFailure(); ++round)
  {
    const int width = 2 + random.Below(9);
    const int height = 2 + random.Below(9);
    const int count = 4 + random.Below(width * height);
    CheckRandomSegments(random, LatticePoints(random, width, height, count), 30);
  }
}

TEST(Constraints, AreCountedWhenTheyWereMissing)
{
  //  3---2   The fan of the lowest point has the diagonal 0-2.
  //  | / |
  //  0---1
  Mesh mesh = Delaunay({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
  std::vector<char> constrained;
  EXPECT_EQ(RecoverSegments(mesh, { { 0, 2 }, { 0, 1 }, { 1, 1 } }, constrained), 0);
  EXPECT_EQ(std::count(constrained.begin(), constrained.end(), 1), 3);
  constrained.clear();
  EXPECT_EQ(RecoverSegments(mesh, { { 3, 1 }, { 1, 3 } }, constrained), 1);
  EXPECT_EQ(std::count(constrained.begin(), constrained.end(), 1), 2);
}

TEST(Constraints, ChangeOnlyTheTrianglesTheyCross)
{
  // Not Delaunay anywhere: the recovery of one segment must not mend the rest.
  Random random(3);
  Mesh mesh = Delaunay(ScatteredPoints(random, 200));
  std::vector<char> constrained;
  RecoverSegments(mesh, RandomSegments(random, mesh, 300), constrained);
  const Mesh before = mesh;
  constrained.clear();
  const Segment segment{ 5, 150 };
  ASSERT_EQ(RecoverSegments(mesh, { segment }, constrained), 1);
  const Point2& a = mesh.PointOf(segment.A);
  const Point2& b = mesh.PointOf(segment.B);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    bool crossed = false;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      const Point2& c = before.PointOf(before.Origin(h));
      const Point2& d = before.PointOf(before.Destination(h));
      crossed = crossed ||
        (Orientation(a, b, c) * Orientation(a, b, d) < 0 &&
          Orientation(c, d, a) * Orientation(c, d, b) < 0);
    }
    if (!crossed)
    {
      EXPECT_TRUE(std::equal(before.Triangles.begin() + 3 * t, before.Triangles.begin() + 3 * t + 3,
        mesh.Triangles.begin() + 3 * t));
    }
  }
}

TEST(Constraints, InMeshesWithHolesAndPinchedVerticesAreRecoveredOrRefused)
{
  Random random(4);
  int recovered = 0;
  int refused = 0;
  for (int round = 0; round < 600 && !HasFailure(); ++round)
  {
    const std::vector<Point2> points =
      round % 2 ? ScatteredPoints(random, 10 + random.Below(40)) : LatticePoints(random, 6, 6, 36);
    Mesh mesh =
      Without(Delaunay(points), [&](Index) { return random.Below(100) < 5 + round % 40; });
    const Index triangles = mesh.NumberOfTriangles();
    const Mesh start = mesh;
    std::vector<char> constrained;
    std::vector<Segment> done;
    for (const Segment& segment : RandomSegments(random, mesh, 40))
    {
      const Mesh before = mesh;
      const std::vector<char> constrainedBefore = constrained;
      try
      {
        recovered += RecoverSegments(mesh, { segment }, constrained);
        done.push_back(segment);
      }
      catch (const Error&)
      {
        // In pieces, up to where it leaves the mesh, a segment may have been recovered.
        ++refused;
        mesh = before;
        constrained = constrainedBefore;
      }
    }
    ASSERT_EQ(mesh.NumberOfTriangles(), triangles);
    constrained.resize(mesh.Triangles.size(), 0);
    ASSERT_EQ(FindingsOf(mesh), "");
    ExpectEdgesOf(mesh, done, constrained);
    // In one call, where the fans are kept up to date from segment to segment.
    Mesh atOnce = start;
    std::vector<char> constrainedAtOnce;
    RecoverSegments(atOnce, done, constrainedAtOnce);
    EXPECT_EQ(atOnce.Triangles, mesh.Triangles);
    EXPECT_EQ(constrainedAtOnce, constrained);
  }
  EXPECT_GT(recovered, 500);
  EXPECT_GT(refused, 500);
}

TEST(Constraints, AlongAHalfMergedSeamEndInTheOneOfTwoVerticesThatIsMeant)
{
  // Two triangles side by side, with one vertex in common and two at the other end of their seam.
  Mesh mesh;
  mesh.Points = { { 0, 0 }, { 2, 1 }, { 0, 2 }, { 0, 2 }, { -2, 1 } };
  for (const int first : { 0, 1 })
  {
    const Index right[] = { 0, 1, 2 }, left[] = { 0, 3, 4 };
    mesh.Triangles.assign(first == 0 ? right : left, (first == 0 ? right : left) + 3);
    mesh.Triangles.insert(
      mesh.Triangles.end(), first == 0 ? left : right, (first == 0 ? left : right) + 3);
    mesh.ConnectTwins();
    const std::vector<Index> triangles = mesh.Triangles;
    for (const Index end : { 2, 3 })
    {
      for (const Segment& segment : { Segment{ 0, end }, Segment{ end, 0 } })
      {
        std::vector<char> constrained;
        EXPECT_EQ(RecoverSegments(mesh, { segment }, constrained), 0);
        EXPECT_EQ(mesh.Triangles, triangles);
        for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
        {
          EXPECT_EQ(constrained[h] != 0,
            std::minmax(mesh.Origin(h), mesh.Destination(h)) == std::minmax<Index>(0, end))
            << end << " " << h;
        }
      }
    }
  }
}

TEST(Constraints, ThatCrossAreRefusedByName)
{
  const Mesh mesh = Delaunay({ { 0, 0 }, { 4, 0 }, { 4, 4 }, { 0, 4 }, { 2, 1 }, { 2, 5 } });
  const std::string message = MessageOf(mesh, { { 0, 2 }, { 3, 1 } });
  EXPECT_NE(message.find("The segment from point 3 (0, 4) to point 1 (4, 0) crosses"), message.npos)
    << message;
  EXPECT_NE(message.find("point 2 (4, 4)"), message.npos) << message;
}

TEST(Constraints, ThatLeaveTheMeshAreRefusedByName)
{
  // A ring of squares around a hole.
  Random random(5);
  const std::vector<Point2> points = LatticePoints(random, 4, 4, 16);
  const Mesh full = Delaunay(points);
  const Mesh mesh = Without(full, [&](Index t) {
    double x = 0.0, y = 0.0;
    for (Index h = 3 * t; h < 3 * t + 3; ++h)
    {
      x += full.PointOf(full.Origin(h)).X / 3;
      y += full.PointOf(full.Origin(h)).Y / 3;
    }
    return 1 < x && x < 2 && 1 < y && y < 2;
  });
  auto at = [&](double x, double y) {
    return static_cast<Index>(
      std::find(points.begin(), points.end(), Point2{ x, y }) - points.begin());
  };
  EXPECT_NE(MessageOf(mesh, { { at(0, 0), at(3, 2) } }).find("leaves the mesh"), std::string::npos);
  EXPECT_NE(MessageOf(mesh, { { at(1, 1), at(2, 2) } }).find("leaves the mesh"), std::string::npos);
  const std::string message = MessageOf(mesh, { { at(0, 0), at(3, 3) } });
  EXPECT_NE(message.find("(0, 0)"), std::string::npos) << message;
  EXPECT_NE(message.find("(3, 3)"), std::string::npos) << message;
  EXPECT_NE(message.find("after point " + std::to_string(at(1, 1)) + " "), std::string::npos)
    << message;
}

TEST(Constraints, ThatEndOutsideTheMeshAreRefusedByName)
{
  const Mesh mesh = Delaunay({ { 0, 0 }, { 1, 0 }, { 0, 1 }, { 0, 0 } });
  EXPECT_NE(MessageOf(mesh, { { 3, 1 } }).find("point 3 (0, 0), which is not the corner"),
    std::string::npos);
  EXPECT_NE(MessageOf(mesh, { { 0, 4 } }).find("point 4, which does not exist"), std::string::npos);
  EXPECT_NE(MessageOf(mesh, { { -1, 0 } }).find("point -1"), std::string::npos);
}

TEST(Constraints, AcrossAHundredThousandEdgesAreRecovered)
{
  // Two rows of points, and a segment slightly slanted between them, over all
  // edges from row to row.
  const int count = 50000;
  std::vector<Point2> points{ { -1.0, 0.4 }, { count + 1.0, 0.6 } };
  for (int i = 0; i < count; ++i)
  {
    points.push_back({ static_cast<double>(i), 0.0 });
    points.push_back({ static_cast<double>(i), 1.0 });
  }
  Mesh mesh = Delaunay(points);
  std::vector<char> constrained;
  const auto recover = [&]() { EXPECT_EQ(RecoverSegments(mesh, { { 0, 1 } }, constrained), 1); };
  const std::size_t work = testing_work::WorkOf(recover);
  EXPECT_LT(work, 22u * count);
  ExpectConstrainedDelaunay(mesh, constrained);
}

TEST(Constraints, StopWhenAsked)
{
  Mesh mesh = Delaunay({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
  std::vector<char> constrained;
  EXPECT_THROW(
    RecoverSegments(mesh, { { 3, 1 } }, constrained, [](double) { return false; }), Aborted);
}

namespace
{
/** Segments from one point to others around it, which other points do not let be edges yet. */
Mesh Star(int count, Random& random, std::vector<Segment>& segments)
{
  std::vector<Point2> points = ScatteredPoints(random, count);
  const Index hub = static_cast<Index>(points.size());
  points.push_back({ 0.5, 0.5 });
  for (int i = 0; i < count; ++i)
  {
    const double angle = 6.283185307179586 * random.Unit(), radius = 0.3 + 0.1 * random.Unit();
    const Segment spoke{ hub, static_cast<Index>(points.size()) };
    points.push_back({ 0.5 + radius * std::cos(angle), 0.5 + radius * std::sin(angle) });
    segments.push_back(random.Below(2) ? spoke : Segment{ spoke.B, spoke.A });
  }
  return Delaunay(points);
}
} // namespace

TEST(Constraints, ThatMeetInOnePointBecomeEdges)
{
  Random random(19);
  std::vector<Segment> segments;
  Mesh mesh = Star(1000, random, segments);
  std::vector<char> constrained;
  EXPECT_GT(RecoverSegments(mesh, segments, constrained), 700);
  ExpectConstrainedDelaunay(mesh, constrained);
  ExpectEdgesOf(mesh, segments, constrained);
}

TEST(Constraints, ThatMeetInOnePointTakeWorkInProportion)
{
  Random random(20);
  std::vector<Segment> segments;
  Mesh mesh = Star(30000, random, segments);
  std::vector<char> constrained;
  const auto recover = [&]() { EXPECT_GT(RecoverSegments(mesh, segments, constrained), 20000); };
  const std::size_t work = testing_work::WorkOf(recover);
  EXPECT_LT(work, 120u * segments.size());
}
