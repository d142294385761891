// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Fill/Membrane.h"

#include "WorkOf.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace elevation;

namespace
{
/** A lattice of unknowns in a frame of known vertices. */
struct Frame
{
  Frame(Index columns, Index rows)
    : Columns(columns)
    , Rows(rows)
  {
    this->Graph.NumberOfKnown = 2 * (columns + rows);
    for (Index y = 0; y < rows; ++y)
    {
      for (Index x = 0; x < columns; ++x)
      {
        this->Add(x > 0 ? this->Unknown(x - 1, y) : 2 * columns + y);
        this->Add(x + 1 < columns ? this->Unknown(x + 1, y) : 2 * columns + rows + y);
        this->Add(y > 0 ? this->Unknown(x, y - 1) : x);
        this->Add(y + 1 < rows ? this->Unknown(x, y + 1) : columns + x);
        this->Graph.Offsets.push_back(this->Graph.Neighbors.size());
      }
    }
  }

  Index Unknown(Index x, Index y) const
  {
    return this->Graph.NumberOfKnown + y * this->Columns + x;
  }

  void Add(Index neighbor)
  {
    this->Graph.Neighbors.push_back(neighbor);
    this->Graph.Weights.push_back(1.0);
  }

  /** A harmonic function at the frame and, by Solve(), inside. */
  double Saddle(double x, double y) const
  {
    return (x * x - y * y) / (double(this->Columns) * this->Columns);
  }

  std::vector<double> Known() const
  {
    std::vector<double> known(this->Graph.NumberOfKnown);
    for (Index x = 0; x < this->Columns; ++x)
    {
      known[x] = this->Saddle(x, -1);
      known[this->Columns + x] = this->Saddle(x, this->Rows);
    }
    for (Index y = 0; y < this->Rows; ++y)
    {
      known[2 * this->Columns + y] = this->Saddle(-1, y);
      known[2 * this->Columns + this->Rows + y] = this->Saddle(this->Columns, y);
    }
    return known;
  }

  Index Columns;
  Index Rows;
  Adjacency Graph;
};
} // namespace

TEST(Membrane, IsHarmonicForAnySize)
{
  for (const Index size : { 1, 2, 30, 122, 123, 350 })
  {
    const Frame frame(size, size);
    const Membrane membrane(frame.Graph);
    EXPECT_EQ(membrane.IsLarge(), size > 122) << size; // 15,000 unknowns
    const std::vector<double> values = membrane.Solve(frame.Known());
    for (Index y = 0; y < size; ++y)
    {
      for (Index x = 0; x < size; ++x)
      {
        ASSERT_NEAR(values[y * size + x], frame.Saddle(x, y), 1e-8) << size;
      }
    }
  }
}

TEST(Membrane, SeveralSetsOfValuesAreAsEachAlone)
{
  // Factorised, and by multigrid.
  for (const Index size : { 30, 130 })
  {
    const Frame frame(size, size);
    const Membrane membrane(frame.Graph);
    const std::vector<double> known = frame.Known();
    std::vector<double> together;
    for (const double value : known)
    {
      together.insert(together.end(), { value, 1.0 - value, value * value });
    }
    const std::vector<double> values = membrane.Solve(together);
    ASSERT_EQ(values.size(), 3u * size * size);
    for (std::size_t set = 0; set < 3; ++set)
    {
      std::vector<double> alone;
      for (std::size_t i = set; i < together.size(); i += 3)
      {
        alone.push_back(together[i]);
      }
      const std::vector<double> expected = membrane.Solve(alone);
      for (std::size_t i = 0; i < expected.size(); ++i)
      {
        ASSERT_NEAR(values[3 * i + set], expected[i], 1e-12) << size;
      }
    }
  }
}

TEST(Membrane, IsSolvedFasterTheLessAccurate)
{
  const Frame frame(300, 300);
  const Membrane membrane(frame.Graph);
  int reports[2] = { 0, 0 };
  for (int k = 0; k < 2; ++k)
  {
    membrane.Solve(frame.Known(), k == 0 ? 1e-2 : 1e-10, [&](double) { return ++reports[k]; });
  }
  EXPECT_LT(2 * reports[0], reports[1]);
}

TEST(Membrane, IsNotSilentForLong)
{
  // The coarsest system has about as many unknowns as are factorised at most.
  const Frame frame(640, 600);
  testing_work::Silence silence;
  const Membrane membrane(frame.Graph, silence.Monitor());
  membrane.Solve(frame.Known(), 1e-4, silence.Monitor());
  silence.End();
  EXPECT_LT(silence.Longest, 2900000u);
  EXPECT_GT(silence.Reports, 50);
}
