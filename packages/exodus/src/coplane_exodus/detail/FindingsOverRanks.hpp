#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_exodus/MeshReport.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace coplane
{
/// A finding and what it is ordered by.
template <class T>
struct Ordered
{
  std::int64_t order;
  T found;
};

/// The first few of all ranks. Collective.
template <class T>
Findings<T> findingsOf(std::vector<Ordered<T>> mine, const Comm& comm)
{
  const auto keepFirst = [](std::vector<Ordered<T>>& all)
  {
    std::sort(all.begin(), all.end(),
              [](const Ordered<T>& a, const Ordered<T>& b) { return a.order < b.order; });
    if (all.size() > Findings<T>::kept)
      all.resize(Findings<T>::kept);
  };
  Findings<T> findings;
  findings.count = comm.sum(std::int64_t(mine.size()));
  keepFirst(mine);
  std::vector<Ordered<T>> all = comm.allGather(mine);
  keepFirst(all);
  for (const Ordered<T>& item : all)
    findings.first.push_back(item.found);
  return findings;
}

/// Space cut into boxes, about one for a rank: what lies in one place meets on one rank, and what
/// lies together goes to few.
class Boxes
{
public:
  Boxes(const Vec3& lowest, const Vec3& highest, int ranks) : lowest_(lowest), ranks_(ranks)
  {
    Real volume = 1, longest = 0;
    int dimensions = 0;
    for (int c = 0; c < 3; ++c)
      if (const Real length = highest[c] - lowest[c]; length > 0)
      {
        volume *= length;
        longest = std::max(longest, length);
        ++dimensions;
      }
    if (dimensions > 0) // but not so thin that boxes could not be counted
      edge_ = std::max(std::pow(volume / ranks, Real(1) / dimensions), 1e-6 * longest);
  }
  int rankOf(const Vec3& x) const
  {
    std::uint64_t hash = 0;
    for (int c = 0; c < 3; ++c)
      hash = mix(hash ^ std::uint64_t(std::int64_t(std::floor((x[c] - lowest_[c]) / edge_))));
    return int(hash % std::uint64_t(ranks_));
  }

private:
  Vec3 lowest_;
  Real edge_ = 1;
  int ranks_;
};

/// The side sets of a mesh that hold pairs of faces in one place, of different elements, with
/// opposite normals and equal corners within the tolerance [m]. Collective.
std::vector<MeshReport::Joint> findJoints(const MeshSlice& slice, const RankMesh& home,
                                          const Boxes& boxes, Real tolerance, const Comm& comm);
} // namespace coplane
