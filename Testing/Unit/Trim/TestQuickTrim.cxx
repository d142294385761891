// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "DelaunayMesh.h"

#include "Kernel/Mesh/Holes.h"
#include "Kernel/Trim/QuickTrim.h"
#include "Kernel/Mesh/TriangleSweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace elevation;
using namespace testing_surfaces;

namespace
{

struct Surface
{
  std::vector<double> Coordinates; ///< x, y, z
  std::vector<Index> Corners;

  TriangleList List() const
  {
    TriangleList list;
    list.Corners = this->Corners.data();
    list.Count = static_cast<Index>(this->Corners.size() / 3);
    list.Points.Double = this->Coordinates.data();
    list.Points.Count = static_cast<Index>(this->Coordinates.size() / 3);
    return list;
  }
  Point2 At(Index id) const { return { this->Coordinates[3 * id], this->Coordinates[3 * id + 1] }; }
};

Surface SurfaceOf(const std::vector<Point2>& points)
{
  Surface surface;
  for (const Point2& p : points)
  {
    surface.Coordinates.insert(surface.Coordinates.end(), { p.X, p.Y, 1.0 });
  }
  surface.Corners = Delaunay(points).Triangles;
  return surface;
}

Surface RandomSurface(Random& random, int count)
{
  std::vector<Point2> points;
  for (int i = 0; i < count; ++i)
  {
    points.push_back({ random.Unit(), random.Unit() });
  }
  return SurfaceOf(points);
}

/** Takes out the triangles with the flag. */
void Remove(Surface& surface, const std::function<bool(double, double)>& isOut)
{
  std::vector<Index> corners;
  for (std::size_t h = 0; h < surface.Corners.size(); h += 3)
  {
    double x = 0.0, y = 0.0;
    for (std::size_t i = h; i < h + 3; ++i)
    {
      x += surface.At(surface.Corners[i]).X / 3.0;
      y += surface.At(surface.Corners[i]).Y / 3.0;
    }
    if (!isOut(x, y))
    {
      corners.insert(corners.end(), surface.Corners.begin() + h, surface.Corners.begin() + h + 3);
    }
  }
  surface.Corners = corners;
}

void Shuffle(Surface& surface, Random& random)
{
  std::vector<std::array<Index, 3>> triangles;
  for (std::size_t h = 0; h < surface.Corners.size(); h += 3)
  {
    const Index* t = &surface.Corners[h];
    const int first = random.Below(3);
    triangles.push_back({ { t[first], t[(first + 1) % 3], t[(first + 2) % 3] } });
  }
  random.Shuffle(triangles);
  surface.Corners.clear();
  for (const std::array<Index, 3>& t : triangles)
  {
    surface.Corners.insert(surface.Corners.end(), t.begin(), t.end());
  }
}

struct Boundary
{
  std::vector<Point2> Points;
  Rings Lines;

  void Add(const std::vector<Point2>& ring)
  {
    for (const Point2& p : ring)
    {
      this->Lines.Vertices.push_back(static_cast<Index>(this->Points.size()));
      this->Points.push_back(p);
    }
    this->Lines.Offsets.push_back(static_cast<Index>(this->Lines.Vertices.size()));
  }
};

std::vector<Point2> Star(Random& random, Point2 middle, double radius, int corners)
{
  std::vector<Point2> ring;
  const double turn = random.Unit();
  for (int i = 0; i < corners; ++i)
  {
    const double angle = 6.283185307179586 * (i + turn) / corners;
    const double r = radius * (0.7 + 0.3 * random.Unit());
    ring.push_back({ middle.X + r * std::cos(angle), middle.Y + r * std::sin(angle) });
  }
  return ring;
}

/** Everything that comes of trimming. */
struct Everything
{
  std::vector<Index> Corners;
  std::vector<char> IsOutward;
  std::vector<Index> Counts;
  std::vector<Index> Parents;
  std::vector<double> Inserted;

  bool operator==(const Everything& other) const
  {
    return this->Corners == other.Corners && this->IsOutward == other.IsOutward &&
      this->Counts == other.Counts && this->Parents == other.Parents &&
      this->Inserted == other.Inserted;
  }

  void Add(const TrimResult& trimmed, const std::vector<InsertedVertex>& inserted,
    const std::vector<Point2>& places)
  {
    this->IsOutward = trimmed.IsOutward;
    this->Counts = { trimmed.NumberOfOutwardTriangles, trimmed.NumberOfRecoveredEdges };
    for (std::size_t i = 0; i < inserted.size(); ++i)
    {
      this->Inserted.insert(this->Inserted.end(), { places[i].X, places[i].Y });
      for (int k = 0; k < 3; ++k)
      {
        this->Inserted.push_back(inserted[i].Corners[k]);
        this->Inserted.push_back(inserted[i].Weights[k]);
      }
    }
  }
};

/** @throws Error */
Everything TrimWithTwins(const Surface& surface, const Boundary& boundary, bool recover)
{
  Mesh mesh;
  mesh.Triangles = surface.Corners;
  const Index count = surface.List().Points.Count;
  for (Index i = 0; i < count; ++i)
  {
    mesh.Points.push_back(surface.At(i));
  }
  mesh.ConnectTwins();
  FindHoles(mesh);
  const InsertedRings rings = InsertRings(mesh, boundary.Points, boundary.Lines, recover);
  TrimOptions options;
  options.RecoverBoundary = recover;
  const TrimResult trimmed = Trim(mesh, rings.Vertices, options);
  Everything everything;
  everything.Corners = mesh.Triangles;
  everything.Parents = rings.Parents;
  everything.Add(
    trimmed, rings.Inserted, std::vector<Point2>(mesh.Points.begin() + count, mesh.Points.end()));
  return everything;
}

bool IsDone(const Surface& surface, const Boundary& boundary, bool recover = true)
{
  TrimmedList list;
  return QuickTrim(surface.List(), boundary.Points, boundary.Lines, recover, 1, Progress(), list);
}

Everything TrimQuickly(
  const Surface& surface, const Boundary& boundary, bool recover, int threads = 1)
{
  TrimmedList list;
  Everything everything;
  if (!QuickTrim(
        surface.List(), boundary.Points, boundary.Lines, recover, threads, Progress(), list))
  {
    return everything;
  }
  everything.Corners = surface.Corners;
  auto next = list.Corners.begin();
  for (const Index t : list.Changed)
  {
    std::copy_n(next, 3, everything.Corners.begin() + 3 * t);
    next += 3;
  }
  everything.Corners.insert(everything.Corners.end(), next, list.Corners.end());
  everything.Parents = list.Parents;
  everything.Add(list.Trimmed, list.Inserted, list.Places);
  return everything;
}

/**
 * What both give is the same, in whatever order triangles and corners are. Many triangles in no
 * order may be left alone.
 */
void ExpectSame(const Surface& surface, const Boundary& boundary, Random& random)
{
  const Everything expected = TrimWithTwins(surface, boundary, true);
  EXPECT_GT(expected.Counts[0], 0);
  EXPECT_TRUE(TrimQuickly(surface, boundary, true) == expected);
  Surface shuffled = surface;
  Shuffle(shuffled, random);
  if (surface.List().Count < 2000 || IsDone(shuffled, boundary))
  {
    EXPECT_TRUE(TrimQuickly(shuffled, boundary, true) == TrimWithTwins(shuffled, boundary, true));
  }
  // Single precision too: the places are others.
  std::vector<float> floats(surface.Coordinates.begin(), surface.Coordinates.end());
  Surface rounded = surface;
  rounded.Coordinates.assign(floats.begin(), floats.end());
  TriangleList list = rounded.List();
  list.Points.Double = nullptr;
  list.Points.Float = floats.data();
  TrimmedList fromFloats, fromDoubles;
  ASSERT_EQ(QuickTrim(list, boundary.Points, boundary.Lines, true, 1, Progress(), fromFloats),
    QuickTrim(rounded.List(), boundary.Points, boundary.Lines, true, 1, Progress(), fromDoubles));
  EXPECT_EQ(fromFloats.Trimmed.IsOutward, fromDoubles.Trimmed.IsOutward);
  EXPECT_EQ(fromFloats.Corners, fromDoubles.Corners);
}

Mesh MeshOf(const Surface& surface)
{
  Mesh mesh;
  mesh.Triangles = surface.Corners;
  for (Index i = 0; i < surface.List().Points.Count; ++i)
  {
    mesh.Points.push_back(surface.At(i));
  }
  mesh.ConnectTwins();
  return mesh;
}

/** What ExtractBoundary and QuickExtract find is the same, and so is what is trimmed by it. */
Rings ExpectSameOutline(const Surface& surface, double tolerance)
{
  Mesh mesh = MeshOf(surface);
  ExtractOptions options;
  options.GapTolerance = tolerance;
  const ExtractedBoundary expected = ExtractBoundary(mesh, options);
  for (const int threads : { 1, 3 })
  {
    options.NumberOfThreads = threads;
    TrimmedList list;
    ExtractedBoundary boundary;
    EXPECT_TRUE(QuickExtract(surface.List(), options, list, boundary));
    EXPECT_EQ(boundary.GapTolerance, expected.GapTolerance);
    EXPECT_EQ(boundary.IsSurface, expected.IsSurface);
    EXPECT_EQ(boundary.NumberOfPointsLeftOut, expected.NumberOfPointsLeftOut);
    EXPECT_EQ(boundary.Vertices.Offsets, expected.Vertices.Offsets);
    EXPECT_EQ(boundary.Vertices.Vertices, expected.Vertices.Vertices);
    EXPECT_TRUE(list.Changed.empty() && list.Corners.empty() && list.Inserted.empty());
    if (expected.Vertices.Count() > 0)
    {
      const TrimResult trimmed = Trim(mesh, expected.Vertices, TrimOptions());
      EXPECT_EQ(list.Trimmed.IsOutward, trimmed.IsOutward);
      EXPECT_EQ(list.Trimmed.NumberOfOutwardTriangles, trimmed.NumberOfOutwardTriangles);
      EXPECT_EQ(trimmed.NumberOfRecoveredEdges, 0);
    }
  }
  return expected.Vertices;
}

bool IsExtracted(const Surface& surface)
{
  TrimmedList list;
  ExtractedBoundary boundary;
  return QuickExtract(surface.List(), ExtractOptions(), list, boundary);
}

} // namespace

TEST(QuickTrim, TakesAHundredRings)
{
  Random random(72);
  const Surface surface = RandomSurface(random, 4000);
  Boundary boundary;
  for (int i = 0; i < 100; ++i)
  {
    boundary.Add(Star(random, { 0.05 + 0.1 * (i % 10), 0.05 + 0.1 * (i / 10) }, 0.045, 3 + i % 20));
  }
  ExpectSame(surface, boundary, random);
}

TEST(QuickTrim, IsTheSameAsTrimmingWithTwinsAlongRingsAnywhere)
{
  Random random(71);
  for (int round = 0; round < 12; ++round)
  {
    const Surface surface = RandomSurface(random, 200 + 400 * round);
    Boundary boundary;
    boundary.Add(Star(random, { 0.5, 0.5 }, 0.45, 3 + 5 * round));
    boundary.Add(Star(random, { 0.5, 0.5 }, 0.2, 3 + round));  // a lake
    boundary.Add(Star(random, { 0.5, 0.5 }, 0.05, 3 + round)); // an island in it
    ExpectSame(surface, boundary, random);
  }
}

TEST(QuickTrim, IsTheSameAlongEdgesAndVerticesOfTheMesh)
{
  Random random(72);
  // Rings between nodes of a lattice: through vertices, along edges and across them, and as
  // long as the mesh; with a lattice's ties.
  std::vector<Point2> points = LatticePoints(random, 50, 40, 2000);
  const Surface surface = SurfaceOf(points);
  Boundary boundary;
  boundary.Add({ { 3, 2 }, { 45, 2 }, { 45, 30 }, { 30, 15 }, { 3, 30 } });
  boundary.Add({ { 10, 5 }, { 20, 5 }, { 20, 12 }, { 10, 12 } });
  ExpectSame(surface, boundary, random);
  Boundary all;
  all.Add({ { 0, 0 }, { 49, 0 }, { 49, 39 }, { 24, 38 }, { 0, 39 } });
  ExpectSame(surface, all, random);
}

TEST(QuickTrim, IsTheSameForPartsHolesAndRingsThatLeaveTheMesh)
{
  Random random(73);
  for (int round = 0; round < 6; ++round)
  {
    Surface surface = RandomSurface(random, 3000);
    Remove(surface, [](double x, double y) {
      return std::fabs(x - 0.45) < 0.08 || std::hypot(x - 0.75, y - 0.6) < 0.1 ||
        (std::hypot(x - 0.2, y - 0.3) < 0.15 && std::hypot(x - 0.2, y - 0.3) > 0.05);
    });
    Boundary boundary;
    boundary.Add(Star(random, { 0.4, 0.4 }, 0.9, 9));
    boundary.Add(Star(random, { 0.7, 0.5 }, 0.2, 7));
    ExpectSame(surface, boundary, random);
  }
}

TEST(QuickTrim, KeepsAllInsideAFarRing)
{
  Random random(74);
  const Surface surface = RandomSurface(random, 3000);
  Boundary boundary;
  boundary.Add({ { -9, -9 }, { 10, -8 }, { 10, 10 }, { -9, 10 } });
  const Everything kept = TrimQuickly(surface, boundary, false);
  EXPECT_EQ(kept.Corners, surface.Corners);
  EXPECT_EQ(kept.Counts, (std::vector<Index>{ 0, 0 }));
}

TEST(QuickTrim, LongTrianglesAreNotTakenForTheirCorners)
{
  // Few points far apart, and a ring between them that comes near no corner.
  const Surface surface = SurfaceOf({ { 0, 0 }, { 100, 0 }, { 100, 100 }, { 0, 100 } });
  Boundary boundary;
  Random random(75);
  boundary.Add({ { 45, 40 }, { 55, 40 }, { 55, 60 }, { 45, 60 } });
  ExpectSame(surface, boundary, random);
  // A dense mesh with a long triangle over all of it, beside a ring that it does not touch.
  std::vector<Point2> points;
  for (int i = 0; i < 4000; ++i)
  {
    points.push_back({ random.Unit(), random.Unit() });
  }
  points.insert(points.end(), { { -50, 0.5 }, { 60, 0.4 }, { 0.5, 70 } });
  Boundary small;
  small.Add(Star(random, { 0.5, 0.5 }, 0.3, 40));
  ExpectSame(SurfaceOf(points), small, random);
}

TEST(QuickTrim, IsTheSameOnSeveralThreads)
{
  Random random(81);
  Boundary boundary;
  boundary.Add(Star(random, { 0.5, 0.5 }, 0.45, 60));
  boundary.Add(Star(random, { 0.5, 0.5 }, 0.1, 30));
  Surface surface = RandomSurface(random, 12000);
  // As they are, threads share the vertices of one row; dealt out in turns, those of many.
  for (const std::size_t dealt : { 1, 2, 40 })
  {
    const std::vector<Index> corners = surface.Corners;
    const std::size_t count = corners.size() / 3, piece = count / dealt / 10 + 1;
    surface.Corners.clear();
    for (std::size_t first = 0; first < dealt; ++first)
    {
      for (std::size_t begin = first * piece; begin < count; begin += dealt * piece)
      {
        surface.Corners.insert(surface.Corners.end(), corners.begin() + 3 * begin,
          corners.begin() + 3 * std::min(begin + piece, count));
      }
    }
    ASSERT_EQ(surface.Corners.size(), corners.size());
    const Everything expected = TrimWithTwins(surface, boundary, true);
    for (const int threads : { 1, 2, 4 })
    {
      EXPECT_TRUE(TrimQuickly(surface, boundary, true, threads) == expected);
    }
    ExpectSameOutline(surface, 0.0);
    surface.Corners = corners;
  }
  // What is wrong is seen by any of them.
  for (const std::size_t t : { std::size_t(0), surface.Corners.size() / 3 - 1 })
  {
    Surface turned = surface;
    std::swap(turned.Corners[3 * t], turned.Corners[3 * t + 1]);
    TrimmedList list;
    EXPECT_FALSE(
      QuickTrim(turned.List(), boundary.Points, boundary.Lines, true, 2, Progress(), list));
    turned = surface;
    turned.Corners[3 * t] = 12000;
    EXPECT_FALSE(
      QuickTrim(turned.List(), boundary.Points, boundary.Lines, true, 2, Progress(), list));
  }
}

TEST(QuickTrim, LeavesAloneWhatItCannotDoOrProve)
{
  Random random(76);
  const Surface surface = RandomSurface(random, 2000);
  Boundary boundary;
  boundary.Add(Star(random, { 0.5, 0.5 }, 0.3, 12));
  ASSERT_TRUE(IsDone(surface, boundary));
  EXPECT_FALSE(IsDone(surface, boundary, false)) << "points that are no corners";
  const std::size_t last = surface.Corners.size() - 3;
  for (const std::size_t h : { std::size_t(0), last / 6 * 3, last })
  {
    for (const Index id : { -1, 2000, std::numeric_limits<Index>::max() })
    {
      Surface wrong = surface;
      wrong.Corners[h + 1] = id;
      EXPECT_FALSE(IsDone(wrong, boundary)) << "a point that does not exist";
    }
    Surface turned = surface;
    std::swap(turned.Corners[h], turned.Corners[h + 1]);
    EXPECT_FALSE(IsDone(turned, boundary)) << "a clockwise triangle";
    Surface flat = surface;
    flat.Corners[h] = flat.Corners[h + 1];
    EXPECT_FALSE(IsDone(flat, boundary)) << "a flat triangle";
    Surface twice = surface;
    twice.Corners.insert(
      twice.Corners.end(), surface.Corners.begin() + h, surface.Corners.begin() + h + 3);
    EXPECT_FALSE(IsDone(twice, boundary)) << "a triangle twice";
    for (int i = 0; i < 3; ++i)
    {
      for (const double value : { std::nan(""), std::numeric_limits<double>::infinity() })
      {
        Surface notFinite = surface;
        notFinite.Coordinates[3 * surface.Corners[h + 2] + i] = value;
        EXPECT_FALSE(IsDone(notFinite, boundary)) << "coordinate " << i;
      }
    }
  }
  // A triangle over others, on its own and along an edge.
  Surface folded = surface;
  folded.Coordinates.insert(folded.Coordinates.end(), { 0.1, 0.1, 0, 0.9, 0.1, 0, 0.5, 0.9, 0 });
  folded.Corners.insert(folded.Corners.end(), { 2000, 2001, 2002 });
  EXPECT_FALSE(IsDone(folded, boundary));
  folded.Corners[last + 3] = surface.Corners[0];
  EXPECT_FALSE(IsDone(folded, boundary));
  // Boundaries that are errors.
  Boundary crossing;
  crossing.Add({ { 0.1, 0.1 }, { 0.9, 0.9 }, { 0.9, 0.1 }, { 0.1, 0.9 } });
  EXPECT_FALSE(IsDone(surface, crossing));
  Boundary outside;
  outside.Add({ { 3, 3 }, { 4, 3 }, { 3, 4 } });
  EXPECT_FALSE(IsDone(surface, outside));
  Boundary flat;
  flat.Add({ { 0.1, 0.1 }, { 0.9, 0.9 }, { 0.5, 0.5 } });
  EXPECT_FALSE(IsDone(surface, flat));
  EXPECT_FALSE(IsDone(Surface(), boundary));
}

TEST(QuickExtract, FindsTheSameOutlineAsExtractBoundary)
{
  Random random(78);
  const auto isSea = [](double x, double y) {
    return x < 0.1 + 0.05 * std::sin(20 * y) || std::hypot(x - 0.5, y - 0.4) < 0.15 ||
      std::fabs(x - y) < 0.04;
  };
  for (int round = 0; round < 8; ++round)
  {
    // Random points, then the nodes of a lattice; with islands and lone points at sea.
    std::vector<Point2> points;
    for (const Point2& p : LatticePoints(random, 90, 90, 3000 + 400 * round))
    {
      const Point2 q =
        round % 2 ? Point2{ p.X / 90, p.Y / 90 } : Point2{ random.Unit(), random.Unit() };
      if (!isSea(q.X, q.Y) || random.Below(40) == 0)
      {
        points.push_back(q);
      }
    }
    Surface surface = SurfaceOf(points);
    for (const double tolerance : { 0.0, 1.5, 2.5, 8.0, 1e-9, 1e9 })
    {
      ExpectSameOutline(surface, tolerance);
    }
    EXPECT_GT(ExpectSameOutline(surface, 0.0).Count(), 1);
    Remove(surface, [](double x, double y) {
      return std::hypot(x - 0.7, y - 0.8) < 0.1 || std::fabs(x - 0.4) < 0.02;
    });
    ExpectSameOutline(surface, 0.0);
    if (round < 2)
    {
      Surface shuffled = surface;
      Shuffle(shuffled, random);
      if (IsExtracted(shuffled))
      {
        ExpectSameOutline(shuffled, 0.0);
      }
    }
  }
}

/** Lists triangles, as far as possible, by closed fans. @return how many of these there are */
int DealOutStars(Surface& surface)
{
  const Index count = surface.List().Count;
  std::vector<std::vector<Index>> at(surface.List().Points.Count); // half-edges that leave a vertex
  for (Index h = 0; h < 3 * count; ++h)
  {
    at[surface.Corners[h]].push_back(h);
  }
  std::vector<char> isListed(count, 0);
  std::vector<Index> corners;
  int stars = 0;
  for (Index v = 0; v < surface.List().Points.Count; ++v)
  {
    std::vector<Index> star;
    const auto cornerAfter = [&](Index h, int steps) {
      return surface.Corners[Mesh::Triangle(h) * 3 + (h + steps) % 3];
    };
    Index next = at[v].empty() ? None : cornerAfter(at[v][0], 1);
    for (std::size_t i = 0; i < at[v].size() && next != None; ++i)
    {
      const auto h = std::find_if(at[v].begin(), at[v].end(), [&](Index other) {
        return cornerAfter(other, 1) == next && !isListed[Mesh::Triangle(other)];
      });
      next = h == at[v].end() ? None : cornerAfter(*h, 2);
      if (next != None)
      {
        star.push_back(*h);
      }
    }
    if (star.size() == at[v].size() && !star.empty() && next == cornerAfter(star[0], 1))
    {
      ++stars;
      for (const Index h : star)
      {
        isListed[Mesh::Triangle(h)] = 1;
        corners.insert(corners.end(), { v, cornerAfter(h, 1), cornerAfter(h, 2) });
      }
    }
  }
  for (Index t = 0; t < count; ++t)
  {
    if (!isListed[t])
    {
      corners.insert(
        corners.end(), surface.Corners.begin() + 3 * t, surface.Corners.begin() + 3 * t + 3);
    }
  }
  surface.Corners = corners;
  return stars;
}

/** A visitor of a sweep that only looks. */
struct Nobody
{
  using Vertex = SweptVertex;
  void Start(Vertex&) const {}
  void Begin(const Vertex&, const Vertex&) {}
  void Visit(Index, const Vertex&, const Vertex&, const Vertex&) {}
};

TEST(Sweep, ClosedFansLeaveNoSlit)
{
  Surface surface;
  surface.Coordinates = { 0, 0, 0 };
  for (int i = 0; i < 6; ++i)
  {
    const double angle = 1.0471975511965976 * i;
    surface.Coordinates.insert(
      surface.Coordinates.end(), { std::cos(angle), std::sin(angle), 0.0 });
    surface.Corners.insert(surface.Corners.end(), { 0, 1 + i, 1 + (i + 1) % 6 });
  }
  const TriangleList list = surface.List();
  TriangleSweep<Nobody> sweep(list, 1);
  ASSERT_TRUE(sweep.Run(Nobody(), Progress()));
  EXPECT_EQ(sweep
              .Border(
                7, Progress(), [](Index id) { return id; }, [](Index, const SweptVertex*) {})
              .size(),
    6u);

  Random random(84);
  for (int round = 0; round < 12; ++round)
  {
    surface = RandomSurface(random, 1000);
    EXPECT_GT(DealOutStars(surface), 100);
    for (const double tolerance : { 0.0, 2.0, 6.0 })
    {
      ExpectSameOutline(surface, tolerance);
    }
  }
}

TEST(Sweep, ReportsWhileItGoesThroughWhatIsPutOff)
{
  // Every other row of squares first, so that both halves of the list share all vertices.
  constexpr Index side = 300;
  Surface surface;
  for (Index i = 0; i < (side + 1) * (side + 1); ++i)
  {
    surface.Coordinates.insert(surface.Coordinates.end(),
      { static_cast<double>(i % (side + 1)), static_cast<double>(i / (side + 1)), 0.0 });
  }
  for (Index i = 0; i < side * side; ++i)
  {
    const Index row = i / side < side / 2 ? 2 * (i / side) : 2 * (i / side - side / 2) + 1;
    const Index v = row * (side + 1) + i % side, above = v + side + 1;
    surface.Corners.insert(surface.Corners.end(), { v, v + 1, above + 1, v, above + 1, above });
  }
  const TriangleList list = surface.List();
  TriangleSweep<Nobody> sweep(list, 2);
  int reports = 0; // in the last tenth, where that is
  ASSERT_TRUE(sweep.Run(Nobody(), [&reports](double done) {
    reports += done >= 0.9;
    return true;
  }));
  EXPECT_GE(reports, sweep.NumberOfRanges() > 1 ? list.Count / 20000 : 0);
  EXPECT_EQ(sweep
              .Border(
                list.Points.Count, Progress(), [](Index id) { return id; },
                [](Index, const SweptVertex*) {})
              .size(),
    4u * side);
}

TEST(QuickExtract, SeesAllOfASmallPiece)
{
  // A lattice, and apart from it six points: a triangle in another one. The inner one is not near
  // the border, but the piece is too small.
  std::vector<Point2> points;
  for (int i = 0; i < 900; ++i)
  {
    points.push_back({ static_cast<double>(i % 30), static_cast<double>(i / 30) });
  }
  Surface surface = SurfaceOf(points);
  const Index first = 900;
  surface.Coordinates.insert(surface.Coordinates.end(), { 100, 0, 0, 102, 0, 0, 101, 1.8, 0 });
  surface.Coordinates.insert(
    surface.Coordinates.end(), { 100.8, 0.5, 0, 101.2, 0.5, 0, 101, 0.8, 0 });
  for (const Index corner : { 0, 1, 3, 1, 4, 3, 1, 2, 4, 2, 5, 4, 2, 0, 5, 0, 3, 5, 3, 4, 5 })
  {
    surface.Corners.push_back(first + corner);
  }
  EXPECT_EQ(ExpectSameOutline(surface, 0.0).Count(), 1);
  // Without the inner one, all is near the border.
  surface.Corners.resize(surface.Corners.size() - 3);
  EXPECT_EQ(ExpectSameOutline(surface, 0.0).Count(), 1);
}

TEST(QuickExtract, LeavesAloneWhatItCannotProve)
{
  Random random(79);
  const Surface surface = RandomSurface(random, 500);
  EXPECT_TRUE(IsExtracted(surface));
  Surface folded = surface;
  folded.Coordinates.insert(folded.Coordinates.end(), { 0.1, 0.1, 0, 0.9, 0.1, 0, 0.5, 0.9, 0 });
  folded.Corners.insert(folded.Corners.end(), { 500, 501, 502 });
  EXPECT_FALSE(IsExtracted(folded));
  Surface turned = surface;
  std::swap(turned.Corners[0], turned.Corners[1]);
  EXPECT_FALSE(IsExtracted(turned));
  Surface large = surface;
  for (double& value : large.Coordinates)
  {
    value *= 1e120;
  }
  EXPECT_FALSE(IsExtracted(large));
  EXPECT_FALSE(IsExtracted(Surface()));
}

TEST(QuickTrim, StopsWhenAsked)
{
  Random random(77);
  const Surface surface = RandomSurface(random, 3000);
  Boundary boundary;
  boundary.Add(Star(random, { 0.5, 0.5 }, 0.3, 12));
  for (int stop = 0; stop < 3; ++stop)
  {
    int reports = 0;
    double before = 0.0;
    TrimmedList list;
    const Progress progress = [&](double done) {
      EXPECT_GE(done, before);
      EXPECT_LE(done, 1.0);
      before = done;
      return ++reports <= 2 * stop;
    };
    EXPECT_THROW(
      QuickTrim(surface.List(), boundary.Points, boundary.Lines, true, 1, progress, list), Aborted);
    reports = 0;
    before = 0.0;
    ExtractOptions options;
    options.Monitor = progress;
    ExtractedBoundary extracted;
    EXPECT_THROW(QuickExtract(surface.List(), options, list, extracted), Aborted);
  }
}
