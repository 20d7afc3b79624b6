#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace coplane
{
/// Extent of a face, or of all faces [m].
struct Box
{
  Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
  void include(const Vec3& p)
  {
    for (int c = 0; c < 3; ++c)
    {
      low[c] = p[c] < low[c] ? p[c] : low[c];
      high[c] = p[c] > high[c] ? p[c] : high[c];
    }
  }
  /// Of an empty box nothing.
  void include(const Box& other)
  {
    for (int c = 0; c < 3; ++c)
    {
      low[c] = std::min(low[c], other.low[c]);
      high[c] = std::max(high[c], other.high[c]);
    }
  }
  void grow(Real by)
  {
    low -= {by, by, by};
    high += {by, by, by};
  }
  bool overlaps(const Box& o) const
  {
    // All six comparisons are made: a branch for each would be mispredicted.
    return (low.x <= o.high.x) & (o.low.x <= high.x) & (low.y <= o.high.y) & (o.low.y <= high.y) &
           (low.z <= o.high.z) & (o.low.z <= high.z);
  }
  Real longestSide() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};

/// Step 1's result: orthogonal bins, equal on all ranks. There is one grid for each size of faces
/// (a level), so that a face touches few bins of its own grid and few faces share a bin.
struct Bins
{
  struct Level
  {
    Real largestFace = infinity; ///< longest side of the boxes of its faces [m]
    Real edge = 1;               ///< of a bin [m]
  };
  using Index = std::array<std::int32_t, 3>;

  Box limits;
  std::vector<Level> levels{Level{}}; ///< from small faces to large ones

  /// The level of a face of this size [m].
  int levelOf(Real size) const
  {
    int level = 0;
    while (level + 1 < int(levels.size()) && size > levels[level].largestFace)
      ++level;
    return level;
  }
  /// The limits begin in the middle of a bin: the faces of a flat side need not lie in two.
  Index indexOf(const Vec3& p, int level) const
  {
    constexpr Real farthest = 1 << 30;
    const Real perEdge = 1 / levels[level].edge;
    Index index;
    for (int c = 0; c < 3; ++c)
    {
      const Real bin = std::floor((p[c] - limits.low[c]) * perEdge + 0.5);
      index[c] = std::int32_t(std::max(std::min(farthest, bin), -farthest));
    }
    return index;
  }
  /// Sort key of a bin. Each index counts modulo 2^19: bins so far apart may share a key, which
  /// costs time but adds no pair.
  static std::uint64_t key(int level, const Index& index)
  {
    return std::uint64_t(level) << 57 | std::uint64_t(index[0] & keyMask) << 38 |
           std::uint64_t(index[1] & keyMask) << 19 | std::uint64_t(index[2] & keyMask);
  }
  static constexpr std::int32_t keyMask = (1 << 19) - 1;
};

/// How many bins of a level a box touches.
inline std::size_t countBins(const Bins& bins, int level, const Box& box)
{
  const Bins::Index low = bins.indexOf(box.low, level), high = bins.indexOf(box.high, level);
  std::size_t count = 1;
  for (int c = 0; c < 3; ++c)
    count *= std::size_t(std::max(0, high[c] - low[c] + 1));
  return count;
}

/// One face in one bin.
struct BinEntry
{
  std::uint64_t key;   ///< of the bin
  std::int32_t face;   ///< position in the table of faces
  std::uint8_t corner; ///< bit c: the bin is the face's first along axis c
  bool resident;       ///< the bin is of the face's own level; false: of a coarser one
};

/// Calls visit(index, corner) for all bins of a level that a box touches.
template <class Visit>
void forEachBin(const Bins& bins, int level, const Box& box, const Visit& visit)
{
  const Bins::Index low = bins.indexOf(box.low, level), high = bins.indexOf(box.high, level);
  Bins::Index i;
  for (i[0] = low[0]; i[0] <= high[0]; ++i[0])
    for (i[1] = low[1]; i[1] <= high[1]; ++i[1])
      for (i[2] = low[2]; i[2] <= high[2]; ++i[2])
        visit(i, std::uint8_t((i[0] == low[0]) | (i[1] == low[1]) << 1 | (i[2] == low[2]) << 2));
}

/// Faces of given sizes, in steps of 2^(1/4): what the levels are chosen from. Integer counts have
/// the same sum on any number of ranks.
class SizeHistogram
{
public:
  SizeHistogram() : counts(classes, 0) {}
  void add(Real size) { ++counts[classOf(size)]; }
  void add(const SizeHistogram& other);
  /// `reach`: by how much boxes are longer than faces [m]; `extent`: longest side of the limits
  /// [m].
  std::vector<Bins::Level> levels(Real reach, Real extent) const;

  std::vector<std::int64_t> counts;

private:
  static constexpr int classes = 1024;
  static int classOf(Real size);
  static Real upperBound(int sizeClass);
};
} // namespace coplane
