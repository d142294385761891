// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Fill/Heights.h"
#include "Kernel/Fill/Neighbours.h"
#include "Kernel/Fill/Spline.h"

#include "FilledSheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

using namespace testing_sheets;

namespace
{
const Interpolation Smooth[] = { Interpolation::ThinPlate, Interpolation::Cubic,
  Interpolation::Adaptive };

/** Cotangent of the angle at @a c. */
double Cotangent(const Point2& a, const Point2& b, const Point2& c)
{
  const double dot = (a.X - c.X) * (b.X - c.X) + (a.Y - c.Y) * (b.Y - c.Y);
  return dot / ((a.X - c.X) * (b.Y - c.Y) - (a.Y - c.Y) * (b.X - c.X));
}

/** How far new points are from the mean of their neighbours, weighted by cotangents. */
double LargestImbalance(const Outcome& run)
{
  const Index first = run.Surface.NumberOfPoints();
  const auto at = [&](
                    Index id) { return id < first ? run.Surface.Points[id] : run.At(id - first); };
  std::vector<double> sums(run.Patches.NumberOfPoints(), 0.0);
  std::vector<double> weights(run.Patches.NumberOfPoints(), 0.0);
  const std::vector<Index>& ids = run.Patches.Triangles;
  for (Index h = 0; h < static_cast<Index>(ids.size()); ++h)
  {
    const Index a = ids[h];
    const Index b = ids[Mesh::Next(h)];
    const double weight = Cotangent(at(a), at(b), at(ids[Mesh::Previous(h)]));
    for (const auto& [from, to] : { std::make_pair(a, b), std::make_pair(b, a) })
    {
      if (from >= first)
      {
        sums[from - first] += weight * run.ElevationOf(to);
        weights[from - first] += weight;
      }
    }
  }
  double largest = 0.0;
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    largest = std::max(largest, std::fabs(run.Value(i) - sums[i] / weights[i]));
  }
  return largest;
}
} // namespace

TEST(Heights, OfSplinesContinuePlanes)
{
  const Elevation plane = [](const Point2& p) { return 1000.0 + 2.0 * p.X - 3.0 * p.Y; };
  const Mesh disc = Sheet(40, Disc(20, 20, 8));
  const Mesh ring =
    Sheet(40, [](double x, double y) { return std::fabs(std::hypot(x - 20, y - 20) - 6.0) < 3.0; });
  // So many boundary points that not all are centres.
  const Mesh large = Sheet(130, Disc(65, 65, 50));
  for (const Interpolation method : Smooth)
  {
    for (const Mesh& mesh : { disc, ring, large })
    {
      const Outcome run = Fill(mesh, plane, method);
      EXPECT_GT(run.Patches.NumberOfPoints(), 100);
      EXPECT_LT(LargestError(run, plane), 1e-9) << int(method);
    }
  }
}

TEST(Heights, DoNotDependOnWhereTheOriginIs)
{
  const Elevation far = [](const Point2& p) {
    return std::sin(0.2 * (p.X - 4e6)) + 0.1 * (p.Y - 5e6);
  };
  const Elevation near = [](const Point2& p) { return std::sin(0.2 * p.X) + 0.1 * p.Y; };
  Mesh mesh = Sheet(40, Disc(20, 20, 8));
  for (const Interpolation method : Smooth)
  {
    const Outcome here = Fill(mesh, near, method);
    Mesh moved = mesh;
    for (Point2& p : moved.Points)
    {
      p = { p.X + 4e6, p.Y + 5e6 };
    }
    const Outcome there = Fill(moved, far, method);
    ASSERT_EQ(here.Patches.NumberOfPoints(), there.Patches.NumberOfPoints());
    EXPECT_EQ(here.Patches.Reports[0].Method, there.Patches.Reports[0].Method);
    for (Index i = 0; i < here.Patches.NumberOfPoints(); ++i)
    {
      ASSERT_NEAR(here.Value(i), there.Value(i), 1e-7);
    }
  }
}

TEST(Heights, OfTheMembraneAreMeansOfTheirNeighbors)
{
  const Elevation hills = [](const Point2& p) { return std::sin(0.3 * p.X) * std::cos(0.2 * p.Y); };
  for (const double radius : { 2.0, 9.0, 30.0, 110.0 }) // the last one by multigrid
  {
    const int size = static_cast<int>(2.5 * radius) + 4;
    const Outcome run =
      Fill(Sheet(size, Disc(0.5 * size, 0.5 * size, radius)), hills, Interpolation::Membrane);
    EXPECT_GT(run.Patches.NumberOfPoints(), 2.8 * radius * radius - 10.0);
    EXPECT_LT(LargestImbalance(run), 1e-8) << radius;
    EXPECT_EQ(run.Patches.Reports[0].Method, Interpolation::Membrane);
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      EXPECT_LE(std::fabs(run.Value(i)), 1.0) << "within the range of the boundary";
    }
  }
}

TEST(Heights, OfTheMembraneDoNotDependOnDiagonals)
{
  // The diagonals of all squares run the same way; what is turned by 90 degrees must not notice.
  const auto saddle = [](double x, double y) { return std::tanh(0.2 * (x + y)) * (x - y); };
  const Mesh mesh = Sheet(40, Disc(20, 20, 10));
  const Outcome one = Fill(
    mesh, [&](const Point2& p) { return saddle(p.X - 20, p.Y - 20); }, Interpolation::Membrane);
  const Outcome turned = Fill(
    mesh, [&](const Point2& p) { return saddle(p.Y - 20, 20 - p.X); }, Interpolation::Membrane);
  ASSERT_EQ(one.Patches.NumberOfPoints(), turned.Patches.NumberOfPoints());
  int compared = 0;
  for (Index i = 0; i < one.Patches.NumberOfPoints(); ++i)
  {
    for (Index j = 0; j < one.Patches.NumberOfPoints(); ++j)
    {
      const Point2 p = turned.At(j);
      if (std::hypot(one.At(i).X - p.Y, one.At(i).Y - 40.0 + p.X) < 1e-9)
      {
        EXPECT_NEAR(one.Value(i), turned.Value(j), 1e-9);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 250);
}

TEST(Heights, OfTheMembraneStayInRange)
{
  const Mesh mesh = Sheet(30, Disc(15, 15, 9));
  // A peak beside the hole is no business of the membrane.
  const Outcome run = Fill(
    mesh, [](const Point2& p) { return std::hypot(p.X - 15, p.Y - 15) < 10.5 ? Noise(p) : 1000.0; },
    Interpolation::Membrane);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const Index count = run.Surface.NumberOfPoints();
  for (const Index id : run.Patches.Triangles)
  {
    if (id < count)
    {
      low = std::min(low, run.ElevationOf(id));
      high = std::max(high, run.ElevationOf(id));
    }
  }
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    EXPECT_GE(run.Value(i), low);
    EXPECT_LE(run.Value(i), high);
  }
}

TEST(Heights, OfSplinesKeepARidge)
{
  // A ridge 2 high across a hole of radius 8: the membrane loses half of it.
  const Elevation ridge = [](const Point2& p) {
    return 2.0 * std::exp(-0.01 * (p.Y - 20.0) * (p.Y - 20.0));
  };
  const Mesh mesh = Sheet(40, Disc(20, 20, 8));
  EXPECT_GT(LargestError(Fill(mesh, ridge, Interpolation::NeighborMean), ridge), 0.5);
  EXPECT_GT(LargestError(Fill(mesh, ridge, Interpolation::Membrane), ridge), 0.25);
  EXPECT_LT(LargestError(Fill(mesh, ridge, Interpolation::ThinPlate), ridge), 0.15);
  EXPECT_LT(LargestError(Fill(mesh, ridge, Interpolation::Cubic), ridge), 0.1);
  EXPECT_LT(LargestError(Fill(mesh, ridge, Interpolation::Adaptive), ridge), 0.15);
}

TEST(Heights, OfSplinesRiseToALostSummit)
{
  // A bowl upside down: 0.64 above the rim, a fiftieth of the relief, though nothing around is as
  // high.
  const Elevation dome = [](const Point2& p) {
    return -0.01 * ((p.X - 40.0) * (p.X - 40.0) + (p.Y - 40.0) * (p.Y - 40.0));
  };
  const Mesh mesh = Sheet(80, Disc(40, 40, 8));
  EXPECT_LT(LargestError(Fill(mesh, dome, Interpolation::ThinPlate), dome), 0.06);
  EXPECT_LT(LargestError(Fill(mesh, dome, Interpolation::Cubic), dome), 0.06);
}

TEST(Heights, DoNotOvershootSteepRims)
{
  // The hole lies in a plain, and walls as steep as they can be stand around it.
  const Mesh mesh = Sheet(40, Disc(20, 20, 8));
  for (const double height : { 100.0, -100.0 })
  {
    const Elevation walls = [height](const Point2& p) {
      return std::hypot(p.X - 20, p.Y - 20) < 8.6 ? 0.0 : height;
    };
    for (const Interpolation method : Smooth)
    {
      const Outcome run = Fill(mesh, walls, method);
      const Index count = run.Surface.NumberOfPoints();
      // Of the surface's edges at the boundary, no more than 100 per spacing.
      for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
      {
        const Index nearest = run.Patches.NearestBoundaryPoints[i];
        ASSERT_LT(nearest, count);
        const Point2& q = run.Surface.Points[nearest];
        const double room = 100.0 * std::hypot(run.At(i).X - q.X, run.At(i).Y - q.Y);
        EXPECT_GE(run.Value(i), std::min(0.0, height) - room);
        EXPECT_LE(run.Value(i), std::max(0.0, height) + room);
      }
    }
  }
  // The same for a bound that is met: one wall, so that the root mean square is known to be small.
  const Elevation spike = [](const Point2& p) { return p.X == 11.0 && p.Y == 20.0 ? 1000.0 : 0.0; };
  for (const Interpolation method : Smooth)
  {
    const Outcome run = Fill(mesh, spike, method);
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      EXPECT_GE(run.Value(i), -1200.0);
      EXPECT_LE(run.Value(i), 1000.0 + 1200.0);
    }
  }
}

namespace
{
/** How many edges the middle of the patches is away from the surface. */
int DepthOf(const Outcome& run)
{
  const std::vector<Index>& ids = run.Patches.Triangles;
  std::set<Index> reached;
  for (const Index id : ids)
  {
    if (id < run.Surface.NumberOfPoints())
    {
      reached.insert(id);
    }
  }
  int depth = -1;
  for (std::size_t before = 0; before < reached.size(); ++depth)
  {
    before = reached.size();
    const std::set<Index> last = reached;
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      const std::size_t first = i - i % 3;
      if (last.count(ids[first]) || last.count(ids[first + 1]) || last.count(ids[first + 2]))
      {
        reached.insert(ids[i]);
      }
    }
  }
  return depth;
}

/** The median of slopes, falling outwards, from the boundary to points so many edges away. */
double SlopeOver(int rings, const Outcome& run)
{
  const Mesh& mesh = run.Surface;
  std::vector<std::set<Index>> neighbors(mesh.NumberOfPoints());
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    neighbors[mesh.Origin(h)].insert(mesh.Destination(h));
    neighbors[mesh.Destination(h)].insert(mesh.Origin(h));
  }
  std::map<Index, Index> from; // each point to that of the boundary
  std::set<Index> last;
  for (const Index id : run.Patches.Triangles)
  {
    if (id < mesh.NumberOfPoints())
    {
      from[id] = id;
      last.insert(id);
    }
  }
  for (int ring = 0; ring < rings; ++ring)
  {
    std::set<Index> next;
    for (const Index id : last)
    {
      for (const Index other : neighbors[id])
      {
        if (from.count(other) == 0)
        {
          from[other] = from[id];
          next.insert(other);
        }
      }
    }
    last = next;
  }
  std::vector<double> slopes;
  for (const Index id : last)
  {
    const Point2& a = mesh.PointOf(from[id]);
    const Point2& b = mesh.PointOf(id);
    slopes.push_back(
      (run.ElevationOf(from[id]) - run.ElevationOf(id)) / std::hypot(b.X - a.X, b.Y - a.Y));
  }
  std::sort(slopes.begin(), slopes.end());
  return 0.5 * (slopes[(slopes.size() - 1) / 2] + slopes[slopes.size() / 2]);
}
} // namespace

TEST(Heights, OfSplinesKeepToTheBound)
{
  // A ditch around the hole, of which the spline makes a hill inside, and gentle slopes beyond.
  const Mesh mesh = Sheet(90, Disc(45, 45, 20));
  const Elevation ditch = [](const Point2& p) {
    const double r = std::hypot(p.X - 45, p.Y - 45);
    return r < 20.8 ? 0.0 : (r < 21.8 ? -1.0 : 0.02 * (20.5 - r));
  };
  const Outcome run = Fill(mesh, ditch, Interpolation::Cubic);
  const int half = DepthOf(run) / 2;
  ASSERT_GE(half, 3);
  for (const int rings : { half - 1, half, half + 1 })
  {
    int atTheBound = 0;
    const double slope = SlopeOver(rings, run);
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      const Point2& q = mesh.Points[run.Patches.NearestBoundaryPoints[i]];
      const double room = slope * std::hypot(run.At(i).X - q.X, run.At(i).Y - q.Y);
      atTheBound += std::fabs(run.Value(i) - room) < 1e-9 ? 1 : 0;
      if (rings == half)
      {
        EXPECT_LE(run.Value(i), room + 1e-9);
      }
    }
    EXPECT_EQ(atTheBound > 5, rings == half) << atTheBound;
  }
}

TEST(Heights, DoNotContinueWhatIsRoughOnlyNearBy)
{
  // A ditch around the hole, beyond which all is level: slopes over several edges are none.
  const Mesh mesh = Sheet(90, Disc(45, 45, 20));
  const Elevation ditch = [](const Point2& p) {
    const double r = std::hypot(p.X - 45, p.Y - 45);
    return r > 20.8 && r < 21.8 ? -1.0 : 0.0;
  };
  for (const Interpolation method : { Interpolation::ThinPlate, Interpolation::Cubic })
  {
    const Outcome run = Fill(mesh, ditch, method);
    double high = 0.0;
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      high = std::max(high, run.Value(i));
    }
    EXPECT_LT(high, 1.0);
  }
}

TEST(Heights, LeaveTheRangeOfTheRimWithMostSlopesOnly)
{
  // On a third of its sides the surface rises towards the hole, by 0.5; on the others it is level.
  const Mesh mesh = Sheet(60, Disc(30, 30, 10));
  const Elevation ramp = [](const Point2& p) {
    return 0.5 * std::min(0.0, p.X - 24.0) + 0.1 * Noise(p);
  };
  for (const Interpolation method : Smooth)
  {
    const Outcome run = Fill(mesh, ramp, method);
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      const Point2& q = mesh.Points[run.Patches.NearestBoundaryPoints[i]];
      const double room = 0.03 * std::hypot(run.At(i).X - q.X, run.At(i).Y - q.Y);
      EXPECT_LE(run.Value(i), 0.2 + room) << static_cast<int>(method); // 0.2 is the most noise
    }
  }
}

TEST(Heights, MeetALongRim)
{
  // Four times as many boundary points as a spline takes of them, and waves that need them all.
  const Elevation waves = [](const Point2& p) { return std::sin(0.7 * p.X) * std::sin(0.7 * p.Y); };
  FillOptions options;
  options.Method = Interpolation::ThinPlate;
  options.UseLattice = LatticeMode::Off; // no node is as near to the rim as other points
  const Outcome run = Fill(Sheet(220, Disc(110, 110, 75)), waves, options);
  EXPECT_GT(run.Patches.Reports[0].NumberOfEdges, 590);
  double squares = 0.0;
  double all = 0.0;
  for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
  {
    const Point2& q = run.Surface.Points[run.Patches.NearestBoundaryPoints[i]];
    if (std::hypot(run.At(i).X - q.X, run.At(i).Y - q.Y) < 1.0)
    {
      squares += std::pow(run.Value(i) - waves(run.At(i)), 2);
      all += std::pow(waves(run.At(i)), 2);
    }
  }
  EXPECT_LT(squares, 0.4 * all);
}

TEST(Heights, OfSplinesHaveAllTheirCentersOnALongRim)
{
  // Twice as many boundary points as centres. With half the centres the error near the rim is half
  // as much again, or twice as much.
  const Mesh mesh = Sheet(220, Disc(110, 110, 75));
  const std::pair<double, double> largest[] = { { 0.05, 0.025 }, { 0.08, 0.052 } };
  for (const auto& [wave, error] : largest)
  {
    const Elevation hills = [frequency = wave](const Point2& p) {
      return std::sin(frequency * p.X) * std::cos(0.8 * frequency * p.Y);
    };
    const Outcome run = Fill(mesh, hills, Interpolation::ThinPlate);
    EXPECT_GT(run.Patches.Reports[0].NumberOfEdges, 590);
    double squares = 0.0;
    int count = 0;
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      const Point2& q = run.Surface.Points[run.Patches.NearestBoundaryPoints[i]];
      if (std::hypot(run.At(i).X - q.X, run.At(i).Y - q.Y) < 6.0)
      {
        squares += std::pow(run.Value(i) - hills(run.At(i)), 2);
        ++count;
      }
    }
    EXPECT_LT(std::sqrt(squares / count), error) << wave;
  }
}

TEST(Heights, DoNotDependOnOtherHoles)
{
  // A large and a small hole, three squares apart; then the small one alone is filled.
  const Mesh mesh = Sheet(50, [](double x, double y) {
    return std::hypot(x - 20, y - 25) < 9.0 || std::hypot(x - 36, y - 25) < 4.0;
  });
  const Elevation hills = [](const Point2& p) {
    return std::sin(0.3 * p.X) + std::cos(0.2 * p.Y) + 0.1 * Noise(p);
  };
  for (const Interpolation method : Smooth)
  {
    FillOptions options;
    options.Method = method;
    const Outcome both = Fill(mesh, hills, options);
    options.MaximumHoleSize = 14.0;
    const Outcome one = Fill(mesh, hills, options);
    ASSERT_EQ(one.Patches.Reports.size(), 2u);
    const int small = one.Patches.Reports[0].Status == FillStatus::Filled ? 0 : 1;
    ASSERT_GT(one.Patches.NumberOfPoints(), 30);
    ASSERT_EQ(both.Patches.Reports[small].NumberOfInsertedPoints, one.Patches.NumberOfPoints());
    for (Index i = 0; i < one.Patches.NumberOfPoints(); ++i)
    {
      EXPECT_EQ(one.Value(i), both.Value(both.Patches.PointOffsets[small] + i));
    }
  }
}

TEST(Heights, FallBackToTheMembraneInALine)
{
  Mesh surface;
  surface.Points = { { 0.0, 0.0 }, { 1.0, 0.0 }, { 0.5, 1e-9 } };
  const VertexStars stars(surface);
  PatchMesh patch;
  patch.BoundaryIds = { 0, 1, 2 };
  patch.Points = { 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, 1e-9, 0.0, 0.5, 4e-10, 0.0 };
  patch.Triangles = { 0, 1, 3, 1, 2, 3, 2, 0, 3 };
  patch.Spacing = 0.5;
  FindNeighbors(patch);
  patch.Nearest = { 2 };
  const Values values = [](Index id) { return 3.0 * id; };
  for (const Interpolation method : Smooth)
  {
    const Heights heights(surface, &stars, patch, method, values);
    EXPECT_EQ(heights.Used(), Interpolation::Membrane);
    const std::vector<double> found = heights.Apply(values);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_GT(found[0], 0.0);
    EXPECT_LT(found[0], 6.0);
  }
}

TEST(Heights, LeaveOutWhatIsNotFinite)
{
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  for (const Interpolation method :
    { Interpolation::Membrane, Interpolation::ThinPlate, Interpolation::Adaptive })
  {
    const Outcome run = Fill(
      Sheet(30, Disc(15, 15, 6)), [=](const Point2& p) { return p.X == p.Y ? nothing : 7.0; },
      method);
    EXPECT_GT(run.Patches.NumberOfPoints(), 80) << run.Patches.Reports[0].Reason.Words();
    EXPECT_EQ(run.Patches.Reports[0].Method, Interpolation::NeighborMean);
    Index numbers = 0;
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      // The only known neighbour may be without a number.
      EXPECT_TRUE(std::isnan(run.Value(i)) || std::fabs(run.Value(i) - 7.0) < 1e-12);
      numbers += std::isnan(run.Value(i)) ? 0 : 1;
    }
    EXPECT_GT(numbers, run.Patches.NumberOfPoints() * 9 / 10);
  }
}

TEST(Heights, OfAttributesAreFoundInTheSameWay)
{
  const Elevation hills = [](const Point2& p) { return std::sin(0.3 * p.X) + 0.2 * Noise(p); };
  const Mesh mesh = Sheet(40, Disc(20, 20, 8));
  for (const int method : { 0, 1, 2, 3, 4 })
  {
    FillOptions options;
    options.Method = static_cast<Interpolation>(method);
    options.Attributes = { [&](Index id) { return 100.0 - 3.0 * hills(mesh.Points[id]); },
      [](Index) { return 5.0; },
      [](Index id) { return id % 7 ? 4.0 : std::numeric_limits<double>::quiet_NaN(); } };
    const Outcome run = Fill(mesh, hills, options);
    ASSERT_EQ(run.Patches.Attributes.size(), 3u);
    for (const std::vector<double>& values : run.Patches.Attributes)
    {
      ASSERT_EQ(values.size(), static_cast<std::size_t>(run.Patches.NumberOfPoints()));
    }
    Index numbers = 0;
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      ASSERT_NEAR(run.Patches.Attributes[0][i], 100.0 - 3.0 * run.Value(i), 1e-9) << method;
      ASSERT_EQ(run.Patches.Attributes[1][i], 5.0);
      // The only known neighbour may be without a number.
      const double value = run.Patches.Attributes[2][i];
      ASSERT_TRUE(std::isnan(value) || std::fabs(value - 4.0) < 1e-12) << value;
      numbers += std::isnan(value) ? 0 : 1;
    }
    EXPECT_GT(numbers, run.Patches.NumberOfPoints() * 9 / 10);
  }
}

TEST(Heights, OfSplinesLeaveOutPartsOfLessThanAQuarterOfThePoints)
{
  // A cliff cuts points off the others around the hole. Which of them a spline has for centres is
  // seen in an attribute that does not know the cliff.
  const Mesh mesh = Sheet(20, Disc(10, 10, 3));
  std::set<Index> rim, known;
  const Outcome plain = Fill(
    mesh, [](const Point2& p) { return p.X; }, Interpolation::ThinPlate);
  for (const Index id : plain.Patches.Triangles)
  {
    if (id < mesh.NumberOfPoints())
    {
      rim.insert(id);
    }
  }
  for (std::size_t h = 0; h < mesh.Triangles.size(); ++h)
  {
    for (std::size_t k = h - h % 3; k < h - h % 3 + 3; ++k)
    {
      if (rim.count(mesh.Triangles[h]))
      {
        known.insert(mesh.Triangles[k]);
      }
    }
  }
  const std::size_t quarter = known.size() / 4;
  ASSERT_EQ(4 * quarter, known.size());
  std::vector<Index> fromTheLeft(known.begin(), known.end());
  std::stable_sort(fromTheLeft.begin(), fromTheLeft.end(),
    [&](Index a, Index b) { return mesh.Points[a].X < mesh.Points[b].X; });
  const auto attributeBeside = [&](std::size_t high) {
    std::vector<char> isHigh(mesh.Points.size(), 0);
    for (std::size_t i = 0; i < high; ++i)
    {
      isHigh[fromTheLeft[i]] = 1;
    }
    FillOptions options;
    options.Method = Interpolation::ThinPlate;
    options.Attributes = { [&](Index id) { return std::sin(mesh.Points[id].X); } };
    const Elevation elevation = [&](const Point2& p) {
      const auto id = std::find(mesh.Points.begin(), mesh.Points.end(), p) - mesh.Points.begin();
      return p.X + (isHigh[id] ? 100.0 : 0.0);
    };
    return Fill(mesh, elevation, options).Patches.Attributes[0];
  };
  const std::vector<double> expected = attributeBeside(0);
  EXPECT_EQ(attributeBeside(quarter), expected);
  EXPECT_NE(attributeBeside(quarter - 1), expected);
}

TEST(Heights, TakeValuesOfAnySize)
{
  const Mesh mesh = Sheet(40, Disc(20, 20, 8));
  const Outcome one = Fill(
    mesh, [](const Point2& p) { return Noise(p); }, Interpolation::ThinPlate);
  for (const double scale : { 1e-300, 1e-100, 1e100, 1e300 })
  {
    const Outcome run = Fill(
      mesh, [=](const Point2& p) { return scale * Noise(p); }, Interpolation::ThinPlate);
    for (Index i = 0; i < run.Patches.NumberOfPoints(); ++i)
    {
      ASSERT_NEAR(run.Value(i) / scale, one.Value(i), 1e-9) << scale;
    }
  }
}

TEST(Spline, GoesThroughItsCenters)
{
  std::mt19937 engine(5);
  const auto random = [&] { return static_cast<double>(engine()) / 2147483648.0 - 1.0; };
  for (const Spline::Kernel kernel : { Spline::Kernel::ThinPlate, Spline::Kernel::Cubic })
  {
    for (const int count : { 3, 4, 5, 7, 50, 201 })
    {
      std::vector<Point2> centers;
      std::vector<double> values;
      for (int i = 0; i < count; ++i)
      {
        centers.push_back({ random(), random() });
        values.push_back(random());
      }
      Spline spline;
      ASSERT_TRUE(spline.Prepare(centers, kernel));
      std::vector<double> found(centers.size(), 0.0);
      spline.Add(spline.Interpolate(values), centers.data(), centers.size(), found.data());
      for (int i = 0; i < count; ++i)
      {
        ASSERT_NEAR(found[i], values[i], 1e-8);
      }
    }
  }
}

TEST(Spline, RefusesPointsInALine)
{
  Spline spline;
  EXPECT_FALSE(spline.Prepare({}, Spline::Kernel::ThinPlate));
  EXPECT_FALSE(spline.Prepare({ { 0, 0 }, { 1, 1 } }, Spline::Kernel::ThinPlate));
  EXPECT_FALSE(
    spline.Prepare({ { -1, -0.5 }, { 0, 0 }, { 1, 0.5 }, { 2, 1 } }, Spline::Kernel::Cubic));
  EXPECT_FALSE(
    spline.Prepare({ { 0.5, -1 }, { 0.5, 0 }, { 0.5, 1 }, { 0.5, 2 } }, Spline::Kernel::Cubic));
}
