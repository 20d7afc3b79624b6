#include <coplane_mesh/Bodies.hpp>

#include <algorithm>
#include <numeric>

namespace coplane
{
namespace
{
/// Values of the nodes of others, from their owners.
class Copies
{
public:
  Copies(const RankMesh& part, const Comm& comm)
      : part_(part), comm_(comm), slots_(comm.size()), asked_(comm.size())
  {
    std::vector<std::vector<int>> questions(comm.size());
    for (int n = part.ownedNodes; n < part.nodes(); ++n)
    {
      const int owner = part.ownersOfOthers[n - part.ownedNodes];
      questions[owner].push_back(part.nodePositions[n]);
      slots_[owner].push_back(n);
    }
    std::vector<int> counts;
    const std::vector<int> all = comm.exchange(questions, &counts);
    const auto owned = part.nodePositions.begin();
    auto next = all.begin();
    for (int r = 0; r < comm.size(); ++r)
      for (int i = 0; i < counts[r]; ++i) // owned nodes stand in the order of the file
        asked_[r].push_back(int(std::lower_bound(owned, owned + part.ownedNodes, *next++) - owned));
  }

  void refresh(std::vector<int>& values) const
  {
    std::vector<std::vector<int>> answers(comm_.size());
    for (int r = 0; r < comm_.size(); ++r)
      for (const int node : asked_[r])
        answers[r].push_back(values[node]);
    const std::vector<int> received = comm_.exchange(answers);
    auto next = received.begin();
    for (const std::vector<int>& nodes : slots_)
      for (const int node : nodes)
        values[node] = *next++;
  }

private:
  const RankMesh& part_;
  const Comm& comm_;
  std::vector<std::vector<int>> slots_, asked_;
};
} // namespace

std::vector<int> bodyLabels(const RankMesh& part, const std::vector<char>& blocks, const Comm& comm)
{
  // Within the rank: nodes joined by elements.
  std::vector<int> parent(part.nodes());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int n)
  {
    while (parent[n] != n)
      n = parent[n] = parent[parent[n]];
    return n;
  };
  std::vector<char> counts(part.nodes(), 0);
  for (std::size_t b = 0; b < part.blocks.size(); ++b)
  {
    if (!blocks[b])
      continue;
    const RankMesh::Block& block = part.blocks[b];
    const std::size_t corners = std::size_t(topology(block.type).nodes);
    for (std::size_t i = 0; i < block.connectivity.size(); ++i)
    {
      const int p = root(block.connectivity[i]);
      const int q = root(block.connectivity[i / corners * corners]);
      parent[std::max(p, q)] = std::min(p, q);
      counts[block.connectivity[i]] = 1;
    }
  }

  // Over the ranks. An element that touches nodes of two ranks is held by both, so that each hears
  // of the other's label through the other's nodes.
  std::vector<int> labels = part.nodePositions;
  const Copies copies(part, comm);
  std::int64_t changed = 1;
  while (changed > 0)
  {
    std::vector<int> lowest = labels; // of each root
    for (int n = 0; n < part.nodes(); ++n)
      lowest[root(n)] = std::min(lowest[root(n)], labels[n]);
    changed = 0;
    for (int n = 0; n < part.nodes(); ++n)
    {
      changed += labels[n] != lowest[root(n)];
      labels[n] = lowest[root(n)];
    }
    changed = comm.size() == 1 ? 0 : comm.sum(changed);
    if (changed > 0)
      copies.refresh(labels);
  }
  // A rank holds all elements of the nodes it owns, but not of the copies.
  for (int n = 0; n < part.ownedNodes; ++n)
    if (!counts[n])
      labels[n] = -1;
  copies.refresh(labels);
  return labels;
}
} // namespace coplane
