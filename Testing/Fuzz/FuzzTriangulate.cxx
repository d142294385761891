// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Points -> mesh: every rule of Validate, an account of every point, the same bytes by every way of
 * searching, and the same triangles from points in another order.
 */
#include "FuzzInput.h"
#include "LatticeRules.h"

#include <map>
#include <utility>

namespace
{
using namespace fuzz;
using testing_points::TriangleSet;

/** Which points must not be vertices, and why, by the definition. */
std::map<Index, UnusedReason> ExpectedUnused(const PointView& points, DuplicatePolicy policy)
{
  std::map<Index, UnusedReason> unused;
  std::map<std::pair<double, double>, Index> kept;
  for (Index id = 0; id < points.Count; ++id)
  {
    const Point2 p = points.At(id);
    if (!IsFinite(p) || !std::isfinite(points.Elevation(id)))
    {
      unused[id] = UnusedReason::NotFinite;
      continue;
    }
    const auto place = kept.emplace(std::make_pair(p.X, p.Y), id);
    if (!place.second)
    {
      Index& other = place.first->second;
      const bool isPreferred = IsPreferred(points, policy, id, other);
      unused[isPreferred ? other : id] = UnusedReason::Duplicate;
      other = isPreferred ? id : other;
    }
  }
  return unused;
}

/** Every point is a vertex, a duplicate, or not finite. */
void RequireAccount(const PointView& points, DuplicatePolicy policy, const Triangulation& result)
{
  const std::map<Index, UnusedReason> expected = ExpectedUnused(points, policy);
  Require(result.UnusedPoints.size() == expected.size() &&
      result.UnusedReasons.size() == expected.size(),
    "as many points are unused as are duplicates or not finite");
  std::size_t i = 0;
  Index duplicates = 0;
  for (const auto& unused : expected)
  {
    Require(result.UnusedPoints[i] == unused.first && result.UnusedReasons[i] == unused.second,
      "points are unused that are duplicates or not finite, with the reason");
    duplicates += unused.second == UnusedReason::Duplicate;
    ++i;
  }
  Require(result.NumberOfDuplicates == duplicates, "the number of duplicates");
  Require(result.NumberOfNotFinite == static_cast<Index>(expected.size()) - duplicates,
    "the number of points not finite");
}

bool AreOnALine(const Cloud& cloud, const std::vector<Index>& unused)
{
  std::vector<Point2> used;
  for (Index id = 0; id < cloud.Count(); ++id)
  {
    if (!std::binary_search(unused.begin(), unused.end(), id))
    {
      used.push_back(cloud.View().At(id));
    }
  }
  for (std::size_t i = 2; i < used.size(); ++i)
  {
    if (Orientation(used[0], used[1], used[i]) != Zero)
    {
      return false;
    }
  }
  return true;
}

/** The order that Triangulate.h promises. */
void RequireOrder(const Cloud& cloud, const Triangulation& result)
{
  const PointView points = cloud.View();
  const Buffer<Index>& corners = result.Triangles;
  for (std::size_t t = 0; t < corners.size(); t += 3)
  {
    const Point2 lowest = points.At(corners[t]);
    Require(IsLower(lowest, points.At(corners[t + 1])) && IsLower(lowest, points.At(corners[t + 2])),
      "a triangle starts with its lowest vertex");
    Require(t == 0 || !IsLower(lowest, points.At(corners[t - 3])),
      "triangles come in the order of their lowest vertices");
  }
}

void RequireSame(const Triangulation& a, const Triangulation& b, const char* claim)
{
  Require(AreSame(a.Triangles, b.Triangles) && a.UnusedPoints == b.UnusedPoints &&
      a.UnusedReasons == b.UnusedReasons && a.NumberOfHullPoints == b.NumberOfHullPoints &&
      a.LatticeFound == b.LatticeFound,
    claim);
}

/** The limit takes triangles away and nothing else; lengths near it are left open. */
void RequireLimited(
  const Cloud& cloud, const Triangulation& all, const Triangulation& limited, double limit)
{
  const PointView points = cloud.View();
  std::size_t next = 0;
  for (std::size_t t = 0; t < all.Triangles.size(); t += 3)
  {
    double longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
    {
      const Point2 p = points.At(all.Triangles[t + i]);
      const Point2 q = points.At(all.Triangles[t + (i + 1) % 3]);
      longest = std::max(longest, std::hypot(q.X - p.X, q.Y - p.Y));
    }
    const bool isKept = next < limited.Triangles.size() &&
      std::memcmp(&limited.Triangles[next], &all.Triangles[t], 3 * sizeof(Index)) == 0;
    next += isKept ? 3 : 0;
    Require(isKept || longest >= limit * (1.0 - 1e-12), "triangles with short edges stay");
    Require(!isKept || longest <= limit * (1.0 + 1e-12), "triangles with a long edge go");
  }
  Require(next == limited.Triangles.size(), "the limit on edges changes nothing else");
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Input input(data, size);
  DelaunayOptions options;
  const unsigned bits = input.Byte();
  options.Duplicates = static_cast<DuplicatePolicy>(input.Below(4));
  static const double tolerances[] = { 0.01, 0.25, 0.1, 0.0, 1e-6, 1e-12 };
  options.LatticeTolerance = input.OneOf(tolerances);
  const Index perStrip = input.Below(20);
  const unsigned limitedBy = input.Byte();
  Cloud cloud = ReadCloud(input, 400);
  std::vector<float> floats;
  PointView points = cloud.View();
  if (bits & 1)
  {
    for (double& value : cloud.Coordinates)
    {
      value = CloudReader::ToFloat(value);
      floats.push_back(static_cast<float>(value));
    }
    points.Double = nullptr;
    points.Float = floats.data();
  }

  Show("points", points);

  const Triangulation plain = Triangulate(points, options);
  Require(!plain.LatticeFound, "no lattice is looked for");
  RequireAccount(points, options.Duplicates, plain);
  if (plain.Triangles.empty())
  {
    Require(AreOnALine(cloud, plain.UnusedPoints), "without triangles all points are on a line");
    Require(plain.NumberOfHullPoints == 0, "without triangles there is no hull");
  }
  else
  {
    RequireNone(FindingsOf(cloud, plain), "triangulation");
    RequireOrder(cloud, plain);
  }

  Triangulation lattice;
  if (bits & 2)
  {
    options.UseLattice = LatticeMode::Automatic;
    lattice = Triangulate(points, options);
    if (lattice.LatticeFound)
    {
      RequireAccount(points, options.Duplicates, lattice);
      RequireNone(testing_points::LatticeFindings(cloud, lattice), "lattice");
    }
    else
    {
      RequireSame(lattice, plain, "without a lattice the triangulation is the plain one");
    }
  }
  const Triangulation& reference = bits & 2 ? lattice : plain;

  DelaunayOptions other = options;
  other.Strategy = bits & 4 ? SearchStrategy::Compactness : SearchStrategy::VoxelTraversal;
  other.Instructions = bits & 8 ? InstructionSet::Scalar : InstructionSet::Bits512;
  other.DivideAtOnce = (bits & 16) != 0;
  other.PointsPerStrip = perStrip;
  other.NumberOfThreads = (bits & 96) == 96 ? 3 : 1;
  RequireSame(Triangulate(points, other), reference, "all ways of searching give the same bytes");

  if (limitedBy > 0 && !reference.Triangles.empty())
  {
    // As long as an edge of the mesh, or about that.
    const Index* corners = &reference.Triangles[3 * (limitedBy % (reference.Triangles.size() / 3))];
    const Point2 p = points.At(corners[0]), q = points.At(corners[1]);
    other.MaximumEdgeLength = std::hypot(q.X - p.X, q.Y - p.Y) * (limitedBy % 2 ? 1.0 : 1.001);
    if (other.MaximumEdgeLength > 1e-290 && std::isfinite(other.MaximumEdgeLength))
    {
      RequireLimited(cloud, reference, Triangulate(points, other), other.MaximumEdgeLength);
    }
  }

  if (bits & 128)
  {
    Cloud reversed;
    for (Index id = cloud.Count(); id-- > 0;)
    {
      const double* c = cloud.Coordinates.data() + 3 * static_cast<std::size_t>(id);
      reversed.Add(c[0], c[1], c[2]);
    }
    const Triangulation turned = Triangulate(reversed.View(), options);
    Require(turned.LatticeFound == reference.LatticeFound, "the order of points hides no lattice");
    Require(TriangleSet(reversed, turned) == TriangleSet(cloud, reference),
      "the order of points does not change the triangles");
  }
  return 0;
}
