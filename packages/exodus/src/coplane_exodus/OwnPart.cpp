#include <coplane_exodus/detail/OwnPart.hpp>

#include <algorithm>
#include <tuple>

namespace coplane
{
namespace
{
struct PartNode
{
  GlobalId id;
  Vec3 x;
};

struct Entry
{
  int set, position; ///< in the set
  int item;          ///< node, or element within its block
  int block, side;
};

bool before(const Entry& a, const Entry& b)
{
  return std::tie(a.set, a.position) < std::tie(b.set, b.position);
}

std::vector<int> touchedNodes(const Mesh& mesh)
{
  std::vector<int> nodes;
  for (const Mesh::Block& block : mesh.blocks)
    nodes.insert(nodes.end(), block.connectivity.begin(), block.connectivity.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// The nodes of this rank's part, ascending.
std::vector<int> nodesOfPart(const MeshSlice& slice, const Comm& comm)
{
  std::vector<int> nodes = touchedNodes(slice.mine);
  std::vector<char> touched(slice.mine.nodeIds.size(), 0);
  const NodesFromHome homes(slice, comm, nodes);
  for (const std::vector<int>& asked : homes.asked())
    for (const int node : asked)
      touched[node] = 1;
  for (std::size_t i = 0; i < touched.size(); ++i)
    if (!touched[i])
      nodes.push_back(slice.nodeRange().first + int(i));
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// Entries of node sets go to the homes of their nodes, and from there to all parts that have them.
std::vector<Entry> nodeEntries(const MeshSlice& slice, const NodesFromHome& nodes, const Comm& comm)
{
  std::vector<std::vector<Entry>> toHomes(comm.size()), toParts(comm.size());
  for (std::size_t s = 0; s < slice.mine.nodeSets.size(); ++s)
  {
    const std::vector<int>& set = slice.mine.nodeSets[s].nodes;
    const int first = slice.rangeOf(slice.nodeSetSizes[s]).first;
    for (std::size_t i = 0; i < set.size(); ++i)
      toHomes[slice.homeOfNode(set[i])].push_back({int(s), first + int(i), set[i], 0, 0});
  }
  const std::vector<Entry> here = comm.exchange(toHomes);
  for (int r = 0; r < comm.size(); ++r)
  {
    const std::vector<int>& asked = nodes.asked()[r]; // ascending
    if (asked.empty())
      continue;
    for (const Entry& entry : here)
      if (std::binary_search(asked.begin(), asked.end(), entry.item - slice.nodeRange().first))
        toParts[r].push_back(entry);
  }
  std::vector<Entry> entries = comm.exchange(toParts);
  std::sort(entries.begin(), entries.end(), before);
  return entries;
}

/// Entries of side sets go to the homes of their elements.
std::vector<Entry> sideEntries(const MeshSlice& slice, const Comm& comm)
{
  std::vector<std::vector<Entry>> toHomes(comm.size());
  for (std::size_t s = 0; s < slice.mine.sideSets.size(); ++s)
  {
    const Mesh::SideSet& set = slice.mine.sideSets[s];
    const int first = slice.rangeOf(slice.sideSetSizes[s]).first;
    for (std::size_t i = 0; i < set.elements.size(); ++i)
    {
      const auto [block, element] = slice.placeOf(set.elements[i]);
      toHomes[slice.homeOfElement(block, element)].push_back(
          {int(s), first + int(i), element, block, set.sides[i]});
    }
  }
  std::vector<Entry> entries = comm.exchange(toHomes);
  std::sort(entries.begin(), entries.end(), before);
  return entries;
}
} // namespace

OwnPart ownPartOf(const MeshSlice& slice, const Comm& comm)
{
  const std::vector<int> positions = nodesOfPart(slice, comm);
  OwnPart part{slice.mine, NodesFromHome(slice, comm, positions), {}};
  const auto partNode = [&](int node)
  { return int(std::lower_bound(positions.begin(), positions.end(), node) - positions.begin()); };
  Mesh& mesh = part.mesh;
  std::vector<PartNode> here;
  for (int i = 0; i < slice.mine.nodes(); ++i)
    here.push_back({slice.mine.nodeIds[i], slice.mine.coordinates[i]});
  mesh.nodeIds.clear();
  mesh.coordinates.clear();
  for (const PartNode& node : part.nodes.values(here))
  {
    mesh.nodeIds.push_back(node.id);
    mesh.coordinates.push_back(node.x);
  }
  std::vector<int> firstElements{0}; // of each block of the part
  for (Mesh::Block& block : mesh.blocks)
  {
    for (int& node : block.connectivity)
      node = partNode(node);
    firstElements.push_back(firstElements.back() + block.elements());
  }
  for (Mesh::NodeSet& set : mesh.nodeSets)
    set.nodes.clear();
  for (const Entry& entry : nodeEntries(slice, part.nodes, comm))
    mesh.nodeSets[entry.set].nodes.push_back(partNode(entry.item));
  for (Mesh::SideSet& set : mesh.sideSets)
  {
    set.elements.clear();
    set.sides.clear();
  }
  part.sides.resize(mesh.sideSets.size());
  for (const Entry& entry : sideEntries(slice, comm))
  {
    mesh.sideSets[entry.set].elements.push_back(firstElements[entry.block] + entry.item -
                                                slice.elementRange(entry.block).first);
    mesh.sideSets[entry.set].sides.push_back(entry.side);
    part.sides[entry.set].push_back(entry.position);
  }
  return part;
}
} // namespace coplane
