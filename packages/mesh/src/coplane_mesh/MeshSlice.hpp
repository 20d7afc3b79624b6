#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_mesh/ContiguousRange.hpp>
#include <coplane_mesh/Mesh.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace coplane
{
/// What a rank reads of a mesh: of the nodes, of every block's elements and of every set's entries
/// the contiguousRange of the file that falls to it; and the sizes of the whole, which all ranks
/// know. Nobody needs to hold the whole mesh. With one rank the slice is the whole mesh.
///
/// A rank is the home of what lies in its slice: who wants to know something about a node or an
/// element asks its home.
struct MeshSlice
{
  /// The ranges. Names, ids and shapes of all blocks and sets, title and QA records are complete.
  /// Indices in connectivity and sets are those of the whole mesh.
  Mesh mine;
  int rank = 0, ranks = 1;
  int nodes = 0;                     ///< of the whole mesh, as are the following
  std::vector<int> firstElements{0}; ///< index of each block's first element; one more at the end
  std::vector<int> nodeSetSizes, sideSetSizes;

  int elements() const { return firstElements.back(); }
  int elementsOf(int block) const { return firstElements[block + 1] - firstElements[block]; }

  IndexRange rangeOf(int items) const { return contiguousRange(items, rank, ranks); }
  IndexRange nodeRange() const { return rangeOf(nodes); }
  IndexRange elementRange(int block) const { return rangeOf(elementsOf(block)); }

  /// Block of an element and its position there.
  std::pair<int, int> placeOf(int element) const
  {
    const auto next = std::upper_bound(firstElements.begin(), firstElements.end(), element);
    const int block = int(next - firstElements.begin()) - 1;
    return {block, element - firstElements[block]};
  }
  int homeOfNode(int node) const { return rankOfItem(node, nodes, ranks); }
  int homeOfElement(int block, int position) const
  {
    return rankOfItem(position, elementsOf(block), ranks);
  }
};

/// A rank's slice of a mesh that is at hand as a whole.
MeshSlice sliceOf(const Mesh& mesh, int rank = 0, int ranks = 1);

/// Brings values of nodes from their homes.
class NodesFromHome
{
public:
  /// Collective.
  /// @param wanted nodes of the whole mesh, ascending, each once
  NodesFromHome(const MeshSlice& slice, const Comm& comm, const std::vector<int>& wanted);

  /// Values of the wanted nodes, in their order. Collective.
  /// @param mine one value for each node of this rank's slice
  template <class T>
  std::vector<T> values(const std::vector<T>& mine) const
  {
    std::vector<std::vector<T>> answers(asked_.size());
    for (std::size_t r = 0; r < asked_.size(); ++r)
    {
      answers[r].reserve(asked_[r].size());
      for (const int node : asked_[r])
        answers[r].push_back(mine[node]);
    }
    return comm_.exchange(answers); // homes ascend with the nodes: this is the order of `wanted`
  }

  /// By rank: the nodes of this slice that it wants, counted from the first of the slice.
  const std::vector<std::vector<int>>& asked() const { return asked_; }

private:
  Comm comm_;
  std::vector<std::vector<int>> asked_;
};
} // namespace coplane
