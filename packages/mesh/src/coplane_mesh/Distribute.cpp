#include <coplane_mesh/Distribute.hpp>

#include <algorithm>
#include <tuple>
#include <unordered_map>

namespace coplane
{
namespace
{
struct NodeRecord
{
  GlobalId id;
  Vec3 x;
  int position, owner;
};

struct NodeEntry ///< of a node set
{
  int set, node;
};

struct SideEntry ///< of a side set
{
  int set, position; ///< in the set
  int block, element, side;
};

class Distribution
{
public:
  Distribution(const MeshSlice& slice, const std::vector<int>& owners, const Comm& comm)
      : slice_(slice), comm_(comm), range_(slice.nodeRange()), owners_(owners)
  {
    findOwners();
  }

  RankMesh part()
  {
    part_.dimension = slice_.mine.dimension;
    takeOwnedNodes();
    takeElements();
    takeOtherNodes();
    for (std::size_t b = 0; b < part_.blocks.size(); ++b)
      markOwned(part_.blocks[b]);
    takeNodeSets();
    takeSideSets();
    return std::move(part_);
  }

private:
  bool isHere(int node) const { return node >= range_.first && node < range_.first + range_.count; }

  int ownerOf(int node) const
  {
    if (isHere(node))
      return owners_[node - range_.first];
    const auto found = std::lower_bound(away_.begin(), away_.end(), node);
    return ownersAway_[std::size_t(found - away_.begin())];
  }

  /// Of all nodes that the slice names but that are at home elsewhere.
  void findOwners()
  {
    const auto note = [&](const std::vector<int>& nodes)
    {
      for (const int node : nodes)
        if (!isHere(node))
          away_.push_back(node);
    };
    for (const Mesh::Block& block : slice_.mine.blocks)
      note(block.connectivity);
    for (const Mesh::NodeSet& set : slice_.mine.nodeSets)
      note(set.nodes);
    std::sort(away_.begin(), away_.end());
    away_.erase(std::unique(away_.begin(), away_.end()), away_.end());
    ownersAway_ = NodesFromHome(slice_, comm_, away_).values(owners_);
  }

  /// The ranks that own a node of an element of the slice, each once.
  const std::vector<int>& ranksOf(const Mesh::Block& block, int element)
  {
    const int corners = topology(block.type).nodes;
    ranks_.clear();
    for (int k = 0; k < corners; ++k)
    {
      const int owner = ownerOf(block.connectivity[std::size_t(element) * corners + k]);
      if (std::find(ranks_.begin(), ranks_.end(), owner) == ranks_.end())
        ranks_.push_back(owner);
    }
    return ranks_;
  }

  NodeRecord recordOf(int i) const
  {
    return {slice_.mine.nodeIds[i], slice_.mine.coordinates[i], range_.first + i, owners_[i]};
  }

  void addNode(const NodeRecord& node)
  {
    part_.nodeIds.push_back(node.id);
    part_.nodePositions.push_back(node.position);
    part_.coordinates.push_back(node.x);
  }

  void takeOwnedNodes()
  {
    std::vector<std::vector<NodeRecord>> toOwners(comm_.size());
    for (int i = 0; i < range_.count; ++i)
      toOwners[owners_[i]].push_back(recordOf(i));
    for (const NodeRecord& node : comm_.exchange(toOwners)) // in the order of the file
      addNode(node);
    part_.ownedNodes = part_.nodes();
  }

  /// Elements come in the order of the file within each block, because slices ascend with the
  /// ranks. Their nodes stay those of the file for the time being.
  void takeElements()
  {
    std::vector<std::vector<int>> numbers(comm_.size()); // block, position, body, nodes
    std::vector<std::vector<GlobalId>> ids(comm_.size());
    for (std::size_t b = 0; b < slice_.mine.blocks.size(); ++b)
    {
      const Mesh::Block& block = slice_.mine.blocks[b];
      const int corners = topology(block.type).nodes;
      const int first = slice_.elementRange(int(b)).first;
      for (int e = 0; e < block.elements(); ++e)
        for (const int r : ranksOf(block, e))
        {
          const int body = block.bodyIds.empty() ? 0 : block.bodyIds[e];
          numbers[r].insert(numbers[r].end(), {int(b), first + e, body});
          const int* nodes = &block.connectivity[std::size_t(e) * corners];
          numbers[r].insert(numbers[r].end(), nodes, nodes + corners);
          ids[r].push_back(block.elementIds[e]);
        }
      RankMesh::Block mine;
      mine.meshBlock = int(b);
      mine.id = block.id;
      mine.type = block.type;
      part_.blocks.push_back(std::move(mine));
    }
    const std::vector<GlobalId> theirIds = comm_.exchange(ids);
    ids.clear();
    const std::vector<int> theirNumbers = comm_.exchange(numbers);
    const int* next = theirNumbers.data();
    for (const GlobalId id : theirIds)
    {
      RankMesh::Block& block = part_.blocks[*next++];
      const int corners = topology(block.type).nodes;
      block.elementIds.push_back(id);
      block.positions.push_back(*next++);
      block.bodyIds.push_back(*next++);
      block.connectivity.insert(block.connectivity.end(), next, next + corners);
      next += corners;
    }
  }

  /// Local number of an owned node, -1 for others.
  int ownedNode(int position) const
  {
    const auto begin = part_.nodePositions.begin(), end = begin + part_.ownedNodes;
    if (begin == end)
      return -1;
    // Mostly the nodes of a rank stand together in the file.
    const std::int64_t guess = std::int64_t(position) - *begin;
    if (guess >= 0 && guess < part_.ownedNodes && begin[guess] == position)
      return int(guess);
    const auto found = std::lower_bound(begin, end, position);
    return found != end && *found == position ? int(found - begin) : -1;
  }

  /// In the order in which the elements name them; and puts local numbers into the elements.
  void takeOtherNodes()
  {
    std::unordered_map<int, int> others;
    std::vector<int> positions;
    for (RankMesh::Block& block : part_.blocks)
      for (int& node : block.connectivity)
      {
        const int position = node;
        node = ownedNode(position);
        if (node >= 0)
          continue;
        const auto [place, isNew] =
            others.emplace(position, part_.ownedNodes + int(positions.size()));
        if (isNew)
          positions.push_back(position);
        node = place->second;
      }
    std::vector<int> wanted = positions;
    std::sort(wanted.begin(), wanted.end());
    std::vector<NodeRecord> mine;
    if (comm_.size() > 1)
      for (int i = 0; i < range_.count; ++i)
        mine.push_back(recordOf(i));
    const std::vector<NodeRecord> found = NodesFromHome(slice_, comm_, wanted).values(mine);
    for (const int position : positions)
    {
      const auto place = std::lower_bound(wanted.begin(), wanted.end(), position);
      const NodeRecord& node = found[std::size_t(place - wanted.begin())];
      addNode(node);
      part_.ownersOfOthers.push_back(node.owner);
    }
  }

  void markOwned(RankMesh::Block& block)
  {
    const int corners = topology(block.type).nodes;
    for (int e = 0; e < block.elements(); ++e)
    {
      const int* nodes = &block.connectivity[std::size_t(e) * corners];
      const int lowest =
          *std::min_element(nodes, nodes + corners,
                            [&](int a, int b) { return part_.nodeIds[a] < part_.nodeIds[b]; });
      block.owned.push_back(lowest < part_.ownedNodes);
    }
  }

  void takeNodeSets()
  {
    std::vector<std::vector<NodeEntry>> toOwners(comm_.size());
    for (std::size_t s = 0; s < slice_.mine.nodeSets.size(); ++s)
      for (const int node : slice_.mine.nodeSets[s].nodes)
        toOwners[ownerOf(node)].push_back({int(s), node});
    part_.nodeSets.resize(slice_.mine.nodeSets.size());
    for (const NodeEntry& entry : comm_.exchange(toOwners))
      part_.nodeSets[entry.set].push_back(ownedNode(entry.node));
  }

  /// By way of the elements' homes, which know who holds them.
  void takeSideSets()
  {
    std::vector<std::vector<SideEntry>> toHomes(comm_.size()), toHolders(comm_.size());
    for (std::size_t s = 0; s < slice_.mine.sideSets.size(); ++s)
    {
      const Mesh::SideSet& set = slice_.mine.sideSets[s];
      const int first = slice_.rangeOf(slice_.sideSetSizes[s]).first;
      for (std::size_t i = 0; i < set.elements.size(); ++i)
      {
        const auto [block, element] = slice_.placeOf(set.elements[i]);
        toHomes[slice_.homeOfElement(block, element)].push_back(
            {int(s), first + int(i), block, element, set.sides[i]});
      }
    }
    for (const SideEntry& entry : comm_.exchange(toHomes))
      for (const int r : ranksOf(slice_.mine.blocks[entry.block],
                                 entry.element - slice_.elementRange(entry.block).first))
        toHolders[r].push_back(entry);
    std::vector<SideEntry> entries = comm_.exchange(toHolders);
    std::sort(entries.begin(), entries.end(),
              [](const SideEntry& a, const SideEntry& b)
              { return std::tie(a.set, a.position) < std::tie(b.set, b.position); });
    part_.sideSets.resize(slice_.mine.sideSets.size());
    for (const SideEntry& entry : entries)
    {
      const std::vector<int>& positions = part_.blocks[entry.block].positions;
      const auto place = std::lower_bound(positions.begin(), positions.end(), entry.element);
      part_.sideSets[entry.set].push_back(
          {entry.block, int(place - positions.begin()), entry.side, entry.position});
    }
  }

  const MeshSlice& slice_;
  const Comm& comm_;
  IndexRange range_;
  const std::vector<int>& owners_;
  std::vector<int> away_, ownersAway_, ranks_;
  RankMesh part_;
};
} // namespace

RankMesh distribute(const MeshSlice& slice, const std::vector<int>& owners, const Comm& comm)
{
  return Distribution(slice, owners, comm).part();
}

RankMesh partAtHome(const MeshSlice& slice, const Comm& comm)
{
  return distribute(slice, std::vector<int>(slice.nodeRange().count, comm.rank()), comm);
}
} // namespace coplane
