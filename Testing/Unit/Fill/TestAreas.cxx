// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Fill/Areas.h"

#include "ErrorMessage.h"
#include "FilledSurface.h"
#include "LatticeSurface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using namespace elevation;
using testing_errors::MessageFrom;
using testing_surfaces::Draw;
using testing_surfaces::ExpectPatchesFit;
using testing_surfaces::Fill;
using testing_surfaces::Outcome;

namespace
{
using Ring = std::vector<Point2>;

/** Polygons, one cell each. */
BoundaryLines Polygons(const std::vector<Ring>& rings)
{
  BoundaryLines lines;
  lines.Name = "area input";
  for (const Ring& ring : rings)
  {
    for (const Point2& p : ring)
    {
      lines.Lines.Vertices.push_back(static_cast<Index>(lines.Points.Places.size()));
      lines.Points.Places.push_back(p);
    }
    lines.Lines.Offsets.push_back(static_cast<Index>(lines.Lines.Vertices.size()));
    lines.IsPolygon.push_back(1);
    lines.Cells.push_back(static_cast<Index>(lines.Cells.size()));
  }
  return lines;
}

Ring Square(double x, double y, double size)
{
  return { { x, y }, { x + size, y }, { x + size, y + size }, { x, y + size } };
}

/** Whether the only hole of a surface touches areas. */
bool Touches(const Mesh& mesh, const std::vector<Ring>& rings)
{
  const Holes holes = FindHoles(mesh);
  EXPECT_EQ(holes.Count(), 1);
  return Areas(Polygons(rings)).Touch(mesh, holes, 0);
}

// A hole from 1 to 7, with an island from 3 to 5.
Mesh Lake()
{
  return Draw({ "########", "#      #", "#      #", "#  ##  #", "#  ##  #", "#      #", "#      #",
    "########" });
}

/** The level that areas give to the only hole of a surface, or the two lines that differ. */
std::string LevelOf(
  const Mesh& mesh, const std::vector<Ring>& rings, const std::vector<double>& levels)
{
  const Holes holes = FindHoles(mesh);
  const Areas areas(Polygons(rings), levels);
  EXPECT_TRUE(areas.HaveLevels());
  try
  {
    const AreaLevel level = areas.LevelOf(mesh, holes, 0);
    EXPECT_EQ(level.Without != None, std::isnan(level.Height));
    return level.Without == None ? ToText(level.Height) : areas.NameOfRing(level.Without);
  }
  catch (const CodedError& error)
  {
    EXPECT_EQ(error.AsMessage().GetCode(), "LevelsDiffer");
    std::string values;
    for (const Message::Value& value : error.AsMessage().GetValues())
    {
      values += (values.empty() ? "" : ", ") + value.second;
    }
    return values;
  }
}

constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

/** What is filled of a hole on the left, from 1 to 2, and one on the right, from 4 to 7. */
std::string Filled(const std::vector<Ring>& rings, FillOptions options)
{
  options.Chosen = std::make_shared<Areas>(Polygons(rings));
  const Outcome run = Fill(Draw({ "########", "# ##   #", "####   #", "########" }), options);
  ExpectPatchesFit(run, 1e-13);
  std::string statuses(2, ' ');
  for (const HoleReport& report : run.Patches.Reports)
  {
    statuses[report.NumberOfEdges == 4 ? 0 : 1] = report.Status == FillStatus::Filled ? 'f'
      : report.Status == FillStatus::NotChosen                                        ? 'n'
      : report.Status == FillStatus::TooLarge                                         ? 'l'
                                                                                      : '?';
  }
  return statuses;
}
} // namespace

TEST(Areas, TouchAHoleWhereverTheyMeetIt)
{
  const Mesh lake = Lake();
  EXPECT_TRUE(Touches(lake, { Square(-1, -1, 20) })) << "all of it";
  EXPECT_TRUE(Touches(lake, { Square(1.5, 1.5, 0.5) })) << "the ring is in the hole";
  EXPECT_TRUE(Touches(lake, { Square(0.2, 0.2, 1.1) })) << "edges cross";
  EXPECT_TRUE(Touches(lake, { Square(2.5, 2.5, 3) })) << "around the island alone";
  EXPECT_FALSE(Touches(lake, { Square(3.2, 3.2, 0.5) })) << "on the island";
  EXPECT_FALSE(Touches(lake, { Square(0.2, 0.2, 0.5) })) << "beside it";
  EXPECT_FALSE(Touches(lake, { Square(20, 20, 5) })) << "far away";
}

TEST(Areas, TouchAHoleAtAPointOrAlongAnEdgeExactly)
{
  const Mesh lake = Lake();
  EXPECT_TRUE(Touches(lake, { { { 0.5, 0.5 }, { 1, 4.5 }, { 0.2, 4 } } })) << "a corner on the rim";
  EXPECT_FALSE(Touches(lake, { { { 0.5, 0.5 }, { std::nextafter(1.0, 0.0), 4.5 }, { 0.2, 4 } } }));
  EXPECT_TRUE(Touches(lake, { Square(0, 2.5, 1) })) << "an edge along the rim";
  EXPECT_TRUE(Touches(lake, { Square(0, 0, 1) })) << "corner to corner";
  EXPECT_TRUE(Touches(lake, { { { 8, 6 }, { 6, 8 }, { 8, 8 } } })) << "the rim's corner on an edge";
  EXPECT_TRUE(Touches(lake, { Square(3, 3, 2) })) << "the shore of the island";
  EXPECT_TRUE(Touches(lake, { Square(1, 1, 6) })) << "the rim itself";
  EXPECT_TRUE(Touches(lake, { Square(4, 4, 1) })) << "from within the island";
}

TEST(Areas, AreBoundedByTheEvenOddRule)
{
  const Mesh lake = Lake();
  EXPECT_FALSE(Touches(lake, { Square(-10, -10, 30), Square(-1, -1, 12) })) << "in an inner ring";
  EXPECT_TRUE(
    Touches(lake, { Square(-10, -10, 30), Square(-2, -2, 14), Square(-1, -1, 12) }));
  EXPECT_TRUE(Touches(lake, { Square(-10, -10, 30), Square(2, 2, 0.5) })) << "the edge counts";
}

TEST(Areas, GiveTheirLevelToAHoleThatTheyTouchInAnyWay)
{
  const Mesh lake = Lake();
  const Ring away = Square(20, 20, 5);
  for (const Ring& ring : { Square(-1, -1, 20), Square(1.5, 1.5, 0.5), Square(0.2, 0.2, 1.1),
         Square(2.5, 2.5, 3), Square(0, 2.5, 1), Square(3, 3, 2), Square(1, 1, 6) })
  {
    EXPECT_EQ(LevelOf(lake, { ring, away }, { 5.5, 7.0 }), "5.5");
    EXPECT_EQ(LevelOf(lake, { away, ring }, { 7.0, 5.5 }), "5.5");
  }
}

TEST(Areas, HaveTheLevelOfTheirOuterRing)
{
  const Mesh lake = Lake();
  const Ring all = Square(-10, -10, 40), inner = Square(2, 2, 0.5);
  EXPECT_EQ(LevelOf(lake, { inner, all }, { 5.0, 5.0 }), "5") << "an island's ring in the hole";
  EXPECT_EQ(LevelOf(lake, { inner, all }, { Unknown, 5.0 }), "5");
  EXPECT_EQ(LevelOf(lake, { inner, all }, { 5.0, Unknown }), "5");
  EXPECT_EQ(LevelOf(lake, { all, Square(-5, -5, 20), Square(-1, -1, 12) }, { 1.0, 2.0, 3.0 }), "3")
    << "an area in an island";
  // The hole touches the island's ring from within the island.
  EXPECT_EQ(LevelOf(lake, { all, Square(1, 1, 6) }, { 5.0, 5.0 }), "5");
  EXPECT_EQ(LevelOf(lake, { all, Square(1, 1, 6) }, { 5.0, Unknown }), "5");
  EXPECT_EQ(LevelOf(lake, { all, Square(-2, -2, 14), Square(4, 0.5, 1) }, { 5.0, 7.0, 9.0 }), "9")
    << "not the area around the island";
}

TEST(Areas, WithACommonEdgeHaveTheirOwnLevels)
{
  const Mesh lake = Lake();
  const Ring left = Square(-10, 1, 10), right = Square(0, 1, 10);
  for (const bool isTurned : { false, true })
  {
    Ring one = left, other = right;
    if (isTurned)
    {
      std::reverse(one.begin(), one.end());
      std::reverse(other.begin() + 1, other.end());
    }
    EXPECT_EQ(LevelOf(lake, { one, other }, { 5.0, 7.0 }), "7");
    EXPECT_EQ(LevelOf(lake, { other, one }, { 7.0, 5.0 }), "7");
  }
}

TEST(Areas, InAnotherHaveNoLevelThatIsDroppedInSilence)
{
  const Mesh lake = Lake();
  const Ring all = Square(-10, -10, 40);
  for (const Ring& inner : { Square(2, 2, 0.5), Square(1, 1, 6), Square(0, 0, 3) })
  {
    EXPECT_EQ(LevelOf(lake, { all, inner }, { 5.0, 7.0 }),
      "the polygon (cell 0), 5, the polygon (cell 1), 7");
  }
}

TEST(Areas, ThatCrossAnotherLeaveThatOneItsLevel)
{
  const Mesh lake = Lake();
  const Ring around = Square(-1, -1, 10), river = { { 2, 2 }, { 2.5, 2 }, { 2.5, 40 }, { 2, 40 } };
  const std::string both = "the polygon (cell 0), 5, the polygon (cell 1), 7";
  EXPECT_EQ(LevelOf(lake, { around, river }, { 5.0, 7.0 }), both) << "around all of the hole";
  EXPECT_EQ(LevelOf(lake, { around, river }, { 5.0, Unknown }), "5");
  EXPECT_EQ(LevelOf(lake, { around, river }, { Unknown, 7.0 }), "7");
  // All of it is in three rings that cross each other, and so in an area that all three bound.
  const Ring one = Square(-1, -1, 10), other = Square(-2, 0, 10), third = Square(0, -2, 10);
  EXPECT_EQ(LevelOf(lake, { one, other, third }, { 5.0, 7.0, 5.0 }), both);
  EXPECT_EQ(LevelOf(lake, { one, other, third }, { 5.0, 5.0, 7.0 }),
    "the polygon (cell 0), 5, the polygon (cell 2), 7");
  EXPECT_EQ(LevelOf(lake, { one, other, third }, { 5.0, Unknown, 5.0 }), "5");
  // In two such rings there is no area, but where the river is.
  EXPECT_EQ(LevelOf(lake, { one, river, other }, { 5.0, 7.0, 5.0 }), both);
}

TEST(Areas, AreInAnotherOnlyAsAWhole)
{
  const Mesh lake = Lake();
  // The hole is in the second ring alone. No edges cross: they have parts in common, or corners of
  // one ring are corners of the other or on its edges.
  const std::vector<std::pair<Ring, Ring>> pairs = {
    { { { -9, -1 }, { -2, -1 }, { -2, 20 }, { -9, 20 } },
      { { -3, -1 }, { 20, -1 }, { 20, 20 }, { -3, 20 } } },
    { { { -9, -1 }, { -2, -1 }, { -2, 5 }, { -2, 10 }, { -2, 20 }, { -9, 20 } },
      { { -1, -20 }, { 30, -20 }, { 30, 30 }, { -1, 30 }, { -2, 10 }, { -4, 8 }, { -2, 5 } } },
    { { { -9, -1 }, { -2, -1 }, { -2, 20 }, { -9, 20 } },
      { { -1, -20 }, { 30, -20 }, { 30, 30 }, { -1, 30 }, { -2, 10 }, { -4, 8 }, { -2, 5 } } },
  };
  for (const auto& [beside, around] : pairs)
  {
    for (const int turn : { 0, 1, 2, 3 })
    {
      // Also another lowest vertex.
      const auto turned = [turn](Ring ring) {
        for (Point2& p : ring)
        {
          for (int i = 0; i < turn; ++i)
          {
            p = { 8.0 - p.Y, p.X };
          }
        }
        return ring;
      };
      EXPECT_EQ(LevelOf(lake, { turned(beside), turned(around) }, { 5.0, 7.0 }), "7");
      EXPECT_EQ(LevelOf(lake, { turned(around), turned(beside) }, { 7.0, 5.0 }), "7");
    }
  }
}

TEST(Areas, GiveNoneOfSeveralLevelsInSilence)
{
  // Rectangles with corners on a lattice, so that many have edges and corners in common. Squares of
  // the lattice decide in which of them a place of the hole is.
  const Mesh lake = Lake();
  struct Rectangle
  {
    int X0, Y0, X1, Y1;
    bool Has(int x, int y) const { return X0 <= x && x < X1 && Y0 <= y && y < Y1; }
    bool Meets(int x, int y) const
    {
      return X0 <= x + 1 && x <= X1 && Y0 <= y + 1 && y <= Y1 &&
        !(X0 < x && x + 1 < X1 && Y0 < y && y + 1 < Y1);
    }
    bool IsIn(const Rectangle& r) const
    {
      return r.X0 <= X0 && r.Y0 <= Y0 && X1 <= r.X1 && Y1 <= r.Y1;
    }
    bool operator<(const Rectangle& r) const
    {
      return std::tie(X0, Y0, X1, Y1) < std::tie(r.X0, r.Y0, r.X1, r.Y1);
    }
  };
  std::mt19937 random(41);
  const auto draw = [&random](int low, int high) {
    return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
  };
  int single = 0, several = 0, none = 0, cautious = 0;
  for (int run = 0; run < 4000; ++run)
  {
    std::set<Rectangle> drawn;
    for (int i = draw(2, 5); i > 0; --i)
    {
      const int x = draw(-3, 8), y = draw(-3, 8);
      drawn.insert({ x, y, draw(x + 1, 11), draw(y + 1, 11) });
    }
    std::vector<Rectangle> all(drawn.begin(), drawn.end());
    std::shuffle(all.begin(), all.end(), random);
    const std::size_t count = all.size();
    std::vector<Ring> rings;
    std::vector<double> levels;
    for (const Rectangle& r : all)
    {
      const double x0 = r.X0, y0 = r.Y0, x1 = r.X1, y1 = r.Y1;
      rings.push_back({ { x0, y0 }, { x1, y0 }, { x1, y1 }, { x0, y1 } });
      std::rotate(rings.back().begin(), rings.back().begin() + draw(0, 3), rings.back().end());
      levels.push_back(static_cast<double>(levels.size()));
    }
    const auto addInnermost = [&all](
                                const std::vector<std::size_t>& of, std::set<std::size_t>& to) {
      std::copy_if(of.begin(), of.end(), std::inserter(to, to.end()), [&](std::size_t i) {
        return std::none_of(
          of.begin(), of.end(), [&](std::size_t j) { return j != i && all[j].IsIn(all[i]); });
      });
    };
    std::set<std::size_t> expected, bounds;
    for (int x = 1; x < 7; ++x)
    {
      for (int y = 1; y < 7; ++y)
      {
        if (3 <= x && x < 5 && 3 <= y && y < 5)
        {
          continue; // the island
        }
        std::vector<std::size_t> around;
        for (std::size_t i = 0; i < count; ++i)
        {
          if (all[i].Meets(x, y))
          {
            expected.insert(i);
          }
          if (all[i].Has(x, y))
          {
            around.push_back(i);
          }
        }
        if (around.size() % 2 != 0)
        {
          addInnermost(around, expected);
        }
      }
    }
    for (const std::size_t i : expected)
    {
      std::vector<std::size_t> around;
      for (std::size_t j = 0; j < count; ++j)
      {
        if (j != i && all[i].IsIn(all[j]))
        {
          around.push_back(j);
        }
      }
      if (around.size() % 2 != 0)
      {
        addInnermost(around, bounds); // an island's ring is an inner bound
      }
    }
    expected.insert(bounds.begin(), bounds.end());
    if (!Touches(lake, rings))
    {
      EXPECT_TRUE(expected.empty());
      ++none;
      continue;
    }
    const std::string found = LevelOf(lake, rings, levels);
    const bool isSingle = found.find(',') == std::string::npos;
    if (isSingle)
    {
      EXPECT_EQ(expected, std::set<std::size_t>{ std::stoul(found) });
    }
    isSingle ? ++single : ++several;
    cautious += !isSingle && expected.size() == 1 ? 1 : 0;
  }
  EXPECT_GT(single, 300);
  EXPECT_GT(several, 300);
  EXPECT_GT(none, 50);
  // A ring around a hole counts even where others leave none of the hole to it alone.
  EXPECT_LT(cautious, 10);
}

TEST(Areas, OfDifferentLevelsAtAHoleAreNamed)
{
  const Mesh lake = Lake();
  const Ring lower = Square(1.5, 1.5, 0.5), upper = Square(1.5, 5.5, 0.5),
             none = Square(5, 1.5, 0.5);
  EXPECT_EQ(LevelOf(lake, { lower, upper }, { 5.0, 7.25 }),
    "the polygon (cell 0), 5, the polygon (cell 1), 7.25");
  EXPECT_EQ(LevelOf(lake, { lower, none, upper }, { 5.0, Unknown, 5.0 }), "5");
  EXPECT_EQ(LevelOf(lake, { none }, { Unknown }), "the polygon (cell 0)");
  EXPECT_EQ(LevelOf(lake, { lower, upper }, { 0.3, 0.1 + 0.2 }),
    "the polygon (cell 0), 0.29999999999999999, the polygon (cell 1), 0.30000000000000004")
    << "with the digits that differ";
  EXPECT_EQ(LevelOf(lake, { Square(1.5, 1.5, 2), Square(2.5, 2.5, 2) }, { 5.0, 6.0 }),
    "the polygon (cell 0), 5, the polygon (cell 1), 6")
    << "rings that cross";
  // The same ring twice, or of two lines.
  EXPECT_EQ(LevelOf(lake, { lower, none, lower }, { 5.0, Unknown, 6.0 }),
    "the polygon (cell 0), 5, the polygon (cell 2), 6");
  BoundaryLines halves =
    Polygons({ { { 2, 2 }, { 3, 2 }, { 3, 3 } }, { { 3, 3 }, { 2, 3 }, { 2, 2 } } });
  halves.IsPolygon = { 0, 0 };
  const Holes holes = FindHoles(lake);
  EXPECT_EQ(Areas(halves, { 5.0, Unknown }).LevelOf(lake, holes, 0).Height, 5.0);
  EXPECT_EQ(MessageFrom([&] {
    Areas(halves, { 5.0, 6.0 }).LevelOf(lake, holes, 0);
  }),
    "It touches areas with different levels: that of the line (cell 0) is 5, that of the line "
    "(cell "
    "1) is 6. Give both the same in LevelArrayName, or leave one out.");
}

TEST(Areas, ChooseWhatIsFilledOrKeptOpen)
{
  FillOptions options;
  EXPECT_EQ(Filled({ Square(1.2, 0.2, 0.5) }, options), "nn") << "below both";
  EXPECT_EQ(Filled({ Square(1.2, 1.2, 1) }, options), "fn");
  EXPECT_EQ(Filled({ Square(5, 2, 0.5) }, options), "nf");
  EXPECT_EQ(Filled({ Square(0.5, 0.5, 9) }, options), "ff");
  options.Mode = AreaMode::KeepOpen;
  EXPECT_EQ(Filled({ Square(1.2, 0.2, 0.5) }, options), "ff");
  EXPECT_EQ(Filled({ Square(1.2, 1.2, 1) }, options), "nf");
  EXPECT_EQ(Filled({ Square(0.5, 0.5, 9) }, options), "nn");
}

TEST(Areas, GoBeforeOtherLimits)
{
  FillOptions options;
  options.MaximumHoleSize = 3.0;
  EXPECT_EQ(Filled({ Square(1.2, 1.2, 1) }, options), "fn");
  EXPECT_EQ(Filled({ Square(5, 2, 0.5) }, options), "nl");
}

TEST(Areas, ChooseRegionsOfLongTriangles)
{
  // A strip of triangles with long edges, between two of short ones.
  std::vector<Point2> points;
  std::vector<Index> triangles;
  const double columns[] = { 0, 1, 2, 9, 10, 11 };
  for (Index y = 0; y < 8; ++y)
  {
    for (const double x : columns)
    {
      points.push_back({ x, static_cast<double>(y) });
    }
    for (Index x = 0; y > 0 && x < 5; ++x)
    {
      const Index a = 6 * (y - 1) + x, b = a + 1, c = b + 6, d = a + 6;
      triangles.insert(triangles.end(), { a, b, c, a, c, d });
    }
  }
  const Mesh mesh = testing_surfaces::Make(points, triangles);
  for (const bool isChosen : { true, false })
  {
    FillOptions options;
    options.Chosen =
      std::make_shared<Areas>(Polygons({ Square(isChosen ? 5.0 : 20.0, 3.0, 1.0) }));
    const Outcome run = Fill(mesh, options, testing_surfaces::Slope, 3.0);
    ASSERT_EQ(run.Found.Count(), 1);
    EXPECT_EQ(
      run.Patches.Reports[0].Status, isChosen ? FillStatus::Replaced : FillStatus::NotChosen);
    EXPECT_EQ(run.Patches.NumberOfPoints() > 0, isChosen);
  }
}

TEST(Areas, AreRefusedByTheNameOfTheirInput)
{
  const auto refusal = [](const BoundaryLines& lines) {
    return MessageFrom([&] { Areas areas(lines); });
  };
  BoundaryLines none;
  none.Name = "area input";
  EXPECT_EQ(refusal(none), "The area input has no line and no polygon.");
  EXPECT_EQ(refusal(Polygons({ { { 0, 0 }, { 1, 0 } } })),
    "The area input's polygon (cell 0) has only 2 different points; a ring has at least three.");
  BoundaryLines open = Polygons({ Square(0, 0, 1) });
  open.IsPolygon[0] = 0;
  EXPECT_EQ(refusal(open).find("The area input is not closed: line (cell 0) ends at point 0"), 0u)
    << refusal(open);
  Message repeated;
  Areas(Polygons({ Square(0, 0, 1), Square(0, 0, 1) }), {}, &repeated);
  EXPECT_EQ(repeated.Words(),
    "Rings of the area input that are there more than once (1 more, the first of them the polygon "
    "(cell 1)) count once.");
}
