#include <coplane_mesh/MeshSlice.hpp>

namespace coplane
{
namespace
{
template <class T>
std::vector<T> partOf(const std::vector<T>& all, IndexRange range, int perItem = 1)
{
  const auto begin = all.begin() + std::ptrdiff_t(range.first) * perItem;
  return std::vector<T>(begin, begin + std::ptrdiff_t(range.count) * perItem);
}
} // namespace

MeshSlice sliceOf(const Mesh& mesh, int rank, int ranks)
{
  MeshSlice slice;
  slice.rank = rank;
  slice.ranks = ranks;
  slice.nodes = mesh.nodes();
  slice.mine.title = mesh.title;
  slice.mine.dimension = mesh.dimension;
  slice.mine.qaRecords = mesh.qaRecords;
  slice.mine.nodeIds = partOf(mesh.nodeIds, slice.nodeRange());
  slice.mine.coordinates = partOf(mesh.coordinates, slice.nodeRange());
  for (const Mesh::Block& block : mesh.blocks)
  {
    const IndexRange range = slice.rangeOf(block.elements());
    Mesh::Block part{block.id, block.name, block.type, {}, {}, {}};
    part.elementIds = partOf(block.elementIds, range);
    part.connectivity = partOf(block.connectivity, range, topology(block.type).nodes);
    if (!block.bodyIds.empty())
      part.bodyIds = partOf(block.bodyIds, range);
    slice.mine.blocks.push_back(std::move(part));
    slice.firstElements.push_back(slice.elements() + block.elements());
  }
  for (const Mesh::NodeSet& set : mesh.nodeSets)
  {
    slice.nodeSetSizes.push_back(int(set.nodes.size()));
    slice.mine.nodeSets.push_back(
        {set.id, set.name, partOf(set.nodes, slice.rangeOf(int(set.nodes.size())))});
  }
  for (const Mesh::SideSet& set : mesh.sideSets)
  {
    const IndexRange range = slice.rangeOf(int(set.elements.size()));
    slice.sideSetSizes.push_back(int(set.elements.size()));
    slice.mine.sideSets.push_back(
        {set.id, set.name, partOf(set.elements, range), partOf(set.sides, range)});
  }
  return slice;
}

NodesFromHome::NodesFromHome(const MeshSlice& slice, const Comm& comm,
                             const std::vector<int>& wanted)
    : comm_(comm), asked_(comm.size())
{
  std::vector<std::vector<int>> questions(comm.size());
  for (const int node : wanted)
    questions[slice.homeOfNode(node)].push_back(node);
  std::vector<int> counts;
  const std::vector<int> all = comm.exchange(questions, &counts);
  auto next = all.begin();
  for (int r = 0; r < comm.size(); ++r)
    for (int i = 0; i < counts[r]; ++i)
      asked_[r].push_back(*next++ - slice.nodeRange().first);
}
} // namespace coplane
