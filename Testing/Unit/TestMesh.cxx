// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeSurface.h"

#include <gtest/gtest.h>

using namespace elevation;
using testing_surfaces::Draw;

TEST(Mesh, TwinsRunTheOtherWay)
{
  const Mesh mesh = Draw({ "###", "# #", "###" });
  Index borders = 0;
  for (Index h = 0; h < mesh.NumberOfHalfEdges(); ++h)
  {
    if (mesh.IsBorder(h))
    {
      ++borders;
      continue;
    }
    EXPECT_EQ(mesh.Twin(mesh.Twin(h)), h);
    EXPECT_EQ(mesh.Origin(mesh.Twin(h)), mesh.Destination(h));
    EXPECT_EQ(mesh.Destination(mesh.Twin(h)), mesh.Origin(h));
  }
  EXPECT_EQ(borders, 12 + 4);
}

TEST(Mesh, RefusesAnEdgeOfThreeTriangles)
{
  Mesh mesh;
  mesh.Points = { { 0, 0 }, { 1, 0 }, { 0, 1 }, { 0, -1 }, { 1, 1 } };
  mesh.Triangles = { 0, 1, 2, 1, 0, 3, 0, 1, 4 };
  try
  {
    mesh.ConnectTwins();
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("points 0 and 1"), std::string::npos) << error.what();
  }
}

TEST(Mesh, RefusesTwoTrianglesOnOneSideOfAnEdge)
{
  Mesh mesh;
  mesh.Points = { { 0, 0 }, { 1, 0 }, { 0, 1 }, { 1, 1 } };
  mesh.Triangles = { 0, 1, 2, 0, 1, 3 };
  EXPECT_THROW(mesh.ConnectTwins(), Error);
}

TEST(TraceBorder, KeepsTheSurfaceOnTheLeft)
{
  const Mesh mesh = Draw({ "###", "# #", "###" });
  const Rings walks = TraceBorder(mesh);
  ASSERT_EQ(walks.Count(), 2);
  std::vector<double> areas;
  for (Index w = 0; w < walks.Count(); ++w)
  {
    double twiceArea = 0.0;
    for (const Index* h = walks.Begin(w); h != walks.End(w); ++h)
    {
      const Point2& p = mesh.PointOf(mesh.Origin(*h));
      const Point2& q = mesh.PointOf(mesh.Destination(*h));
      twiceArea += p.X * q.Y - p.Y * q.X;
    }
    areas.push_back(twiceArea / 2);
  }
  std::sort(areas.begin(), areas.end());
  EXPECT_EQ(areas[0], -1.0) << "clockwise around the hole";
  EXPECT_EQ(areas[1], 9.0) << "counter-clockwise around the outside";
}

TEST(TraceBorder, SeparatesHolesThatShareAVertex)
{
  // The two empty squares meet in one vertex: each walk stays along its own empty region.
  const Rings walks = TraceBorder(Draw({ "####", "# ##", "## #", "####" }));
  ASSERT_EQ(walks.Count(), 3);
  std::vector<Index> sizes{ walks.Size(0), walks.Size(1), walks.Size(2) };
  std::sort(sizes.begin(), sizes.end());
  EXPECT_EQ(sizes, (std::vector<Index>{ 4, 4, 16 }));
}

TEST(TraceBorder, JoinsTwoPiecesThatShareAVertex)
{
  // One outside with a waist: the empty region around both pieces is one, so is the walk.
  const Rings walks = TraceBorder(Draw({ " #", "# " }));
  ASSERT_EQ(walks.Count(), 1);
  EXPECT_EQ(walks.Size(0), 8);
}
