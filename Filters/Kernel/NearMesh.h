// SPDX-FileCopyrightText: Copyright (c) the ElevationSurface authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Lists of triangles that are no mesh yet, and some of their triangles as a mesh of their own.
 */
#ifndef elevation_NearMesh_h
#define elevation_NearMesh_h

#include "Mesh.h"

#include <algorithm>
#include <vector>

namespace elevation
{

/** Triangles as they lie in a cell array, and the points that they name; not owned. */
struct TriangleList
{
  const Index* Corners = nullptr; ///< three a triangle
  Index Count = 0;
  PointView Points;

  const Index* CornersOf(Index t) const { return this->Corners + 3 * static_cast<std::size_t>(t); }
  void PrefetchPoint(Index vertex) const
  {
    const std::size_t k = 3 * static_cast<std::size_t>(vertex);
    this->Points.Double ? Prefetch(this->Points.Double + k) : Prefetch(this->Points.Float + k);
  }
  /** The area of a triangle in parts of a square; to the bit the same from any first corner. */
  double ShareOfSquare(Index t, double side) const
  {
    Point2 a = this->Points.At(this->CornersOf(t)[0]);
    Point2 b = this->Points.At(this->CornersOf(t)[1]);
    Point2 c = this->Points.At(this->CornersOf(t)[2]);
    while (IsLower(b, a) || IsLower(c, a))
    {
      const Point2 first = a;
      a = b;
      b = c;
      c = first;
    }
    const double area = 0.5 * ((b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X));
    const double square = side * side;
    return square > 0.0 ? area / square : std::numeric_limits<double>::infinity();
  }
};

/** A half-edge without a twin. */
struct BorderEdge
{
  Index Origin;
  Index Destination;

  bool operator<(const BorderEdge& other) const
  {
    return this->Origin < other.Origin ||
      (this->Origin == other.Origin && this->Destination < other.Destination);
  }
};

/** A set of vertices, one bit each: small enough to be asked for any vertex at any time. */
class VertexSet
{
public:
  /** Empty; for vertices below @a count. */
  explicit VertexSet(Index count)
    : Bits(static_cast<std::size_t>(count) / 64 + 1, 0)
  {
  }

  void Add(Index vertex) { this->Bits[WordOf(vertex)] |= BitOf(vertex); }
  void AddAll(const Index* three)
  {
    std::for_each(three, three + 3, [this](Index v) { this->Add(v); });
  }
  void RemoveAll(const Index* three)
  {
    std::for_each(three, three + 3, [this](Index v) { this->Bits[WordOf(v)] &= ~BitOf(v); });
  }
  /** Adds the vertices of another set; those that it has already, to @a common as well. */
  void Add(const VertexSet& other, VertexSet& common)
  {
    for (std::size_t word = 0; word < this->Bits.size(); ++word)
    {
      common.Bits[word] |= this->Bits[word] & other.Bits[word];
      this->Bits[word] |= other.Bits[word];
    }
  }
  bool Has(Index vertex) const { return (this->Bits[WordOf(vertex)] & BitOf(vertex)) != 0; }
  /** Whether any of three is in it; without branches. */
  bool HasAny(const Index* three) const
  {
    const std::uint32_t a = three[0], b = three[1], c = three[2];
    return ((this->Bits[a / 64] >> a % 64) | (this->Bits[b / 64] >> b % 64) |
             (this->Bits[c / 64] >> c % 64)) &
      1;
  }

  Index Count() const
  {
    Index count = 0;
    for (const std::uint64_t word : this->Bits)
    {
      count += CountBits(word);
    }
    return count;
  }

  /** Its vertices, increasing; from then on NumberOf() tells where in them a vertex is. */
  std::vector<Index> Number()
  {
    std::vector<Index> ids;
    this->Before.resize(this->Bits.size());
    for (std::size_t word = 0; word < this->Bits.size(); ++word)
    {
      this->Before[word] = static_cast<Index>(ids.size());
      for (std::uint64_t left = this->Bits[word]; left != 0; left &= left - 1)
      {
        ids.push_back(static_cast<Index>(64 * word) + LowestBit(left));
      }
    }
    return ids;
  }
  Index NumberOf(Index vertex) const
  {
    const std::uint64_t lower = this->Bits[WordOf(vertex)] & (BitOf(vertex) - 1);
    return this->Before[WordOf(vertex)] + CountBits(lower);
  }

private:
  static std::size_t WordOf(Index vertex) { return static_cast<std::uint32_t>(vertex) / 64; }
  static std::uint64_t BitOf(Index vertex)
  {
    return std::uint64_t(1) << static_cast<std::uint32_t>(vertex) % 64;
  }

  std::vector<std::uint64_t> Bits;
  std::vector<Index> Before; ///< how many are set before each word
};

/** Puts in the place of each vertex its id. */
inline void ToIds(std::vector<Index>& vertices, const Index* ids, const Progress& progress)
{
  InStretches(static_cast<Index>(vertices.size()), progress, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
    {
      vertices[i] = ids[vertices[i]];
    }
  });
}

/** Some triangles of a list as a mesh, without Twins; its points keep their order. */
struct NearMesh
{
  Mesh Surface;
  std::vector<Index> Ids; ///< of its points in the list

  NearMesh(const TriangleList& list, const std::vector<Index>& triangles, const Progress& progress)
  {
    const Index count = static_cast<Index>(triangles.size());
    VertexSet corners(list.Points.Count);
    InStretches(count, Part(progress, 0.0, 0.4), [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i)
      {
        Prefetch(list.CornersOf(triangles[std::min(i + 16, count - 1)]));
        corners.AddAll(list.CornersOf(triangles[i]));
      }
    });
    this->Ids = corners.Number();
    this->Surface.Points.reserve(this->Ids.size());
    for (std::size_t i = 0; i < this->Ids.size(); ++i)
    {
      list.PrefetchPoint(this->Ids[std::min(i + 16, this->Ids.size() - 1)]);
      this->Surface.Points.push_back(list.Points.At(this->Ids[i]));
    }
    this->Surface.Triangles.reserve(3 * triangles.size());
    InStretches(count, Part(progress, 0.5, 1.0), [&](Index begin, Index end) {
      for (Index i = 3 * begin; i < 3 * end; ++i)
      {
        this->Surface.Triangles.push_back(
          corners.NumberOf(list.CornersOf(triangles[i / 3])[i % 3]));
      }
    });
  }
};

} // namespace elevation

#endif
