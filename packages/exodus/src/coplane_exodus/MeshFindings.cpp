#include <coplane_exodus/detail/MeshFindings.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace coplane
{
namespace
{
struct PlacedElement
{
  Vec3 cell, centre;
  std::int64_t position; ///< in the file
  GlobalId id;
};

struct PlacedSide
{
  std::array<int, 4> nodes; ///< positions in the file, ascending; -1: none
  Vec3 centre;
  std::int64_t position; ///< of the element in the file
  GlobalId id;
};

struct PlacedNode
{
  std::int64_t body;
  Vec3 cell;
  int position; ///< in the file
  GlobalId id;
  bool onJoint;
};
} // namespace

std::array<Vec3, 8> cornersOf(const RankMesh& mesh, const RankMesh::Block& block, int element)
{
  std::array<Vec3, 8> corners{};
  const int perElement = topology(block.type).nodes;
  for (int k = 0; k < perElement; ++k)
    corners[k] = mesh.coordinates[block.connectivity[std::size_t(element) * perElement + k]];
  return corners;
}

Vec3 centreOf(const std::array<Vec3, 8>& corners, int count)
{
  std::vector<Vec3> sorted(corners.begin(), corners.begin() + count);
  std::sort(sorted.begin(), sorted.end(),
            [](const Vec3& a, const Vec3& b)
            { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  Vec3 sum{};
  for (const Vec3& corner : sorted)
    sum += corner;
  return (1.0 / count) * sum;
}

Findings<MeshReport::ElementPair> findTwice(const MeshSlice& slice, const RankMesh& home,
                                            const Boxes& boxes, Real tolerance, const Comm& comm)
{
  const Real size = tolerance > 0 ? 2 * tolerance : 1;
  const auto cell = [&](Real value)
  { return tolerance > 0 ? std::floor(value / size + 0.5) : value; };
  std::vector<std::vector<PlacedElement>> toRank(comm.size());
  for (std::size_t b = 0; b < home.blocks.size(); ++b)
  {
    const RankMesh::Block& block = home.blocks[b];
    for (int e = 0; e < block.elements(); ++e)
      if (block.owned[e])
      {
        const Vec3 x = centreOf(cornersOf(home, block, e), topology(block.type).nodes);
        const Vec3 place{cell(x.x), cell(x.y), cell(x.z)};
        toRank[boxes.rankOf(size * place)].push_back(
            {place, x, slice.firstElements[b] + block.positions[e], block.elementIds[e]});
      }
  }
  std::vector<PlacedElement> elements = comm.exchange(toRank);
  const auto key = [](const PlacedElement& e) { return std::tie(e.cell.x, e.cell.y, e.cell.z); };
  std::sort(elements.begin(), elements.end(),
            [&](const PlacedElement& a, const PlacedElement& b)
            { return key(a) != key(b) ? key(a) < key(b) : a.position < b.position; });
  std::vector<Ordered<MeshReport::ElementPair>> pairs;
  for (std::size_t i = 1; i < elements.size(); ++i)
    if (const PlacedElement& a = elements[i - 1], &b = elements[i]; key(a) == key(b))
      pairs.push_back({a.position, {a.id, b.id, a.centre}});
  return findingsOf(pairs, comm);
}

Findings<MeshReport::SharedFace> findOverused(const MeshSlice& slice, const RankMesh& home,
                                              const Comm& comm)
{
  std::vector<std::vector<PlacedSide>> toRank(comm.size());
  for (std::size_t b = 0; b < home.blocks.size(); ++b)
  {
    const RankMesh::Block& block = home.blocks[b];
    const ElementTopology& shape = topology(block.type);
    for (int e = 0; e < block.elements(); ++e)
      for (int s = 0; s < shape.sides && block.owned[e]; ++s)
      {
        PlacedSide side{
            {-1, -1, -1, -1}, {}, slice.firstElements[b] + block.positions[e], block.elementIds[e]};
        std::uint64_t hash = 0;
        for (int k = 0; k < shape.nodesPerSide; ++k)
        {
          const int node = block.connectivity[std::size_t(e) * shape.nodes + shape.sideNodes[s][k]];
          side.nodes[std::size_t(k)] = home.nodePositions[node];
          side.centre += (1.0 / shape.nodesPerSide) * home.coordinates[node];
          hash += mix(std::uint64_t(home.nodePositions[node]));
        }
        std::sort(side.nodes.begin(), side.nodes.end());
        toRank[hash % std::uint64_t(comm.size())].push_back(side);
      }
  }
  std::vector<PlacedSide> sides = comm.exchange(toRank);
  std::sort(sides.begin(), sides.end(),
            [](const PlacedSide& a, const PlacedSide& b)
            { return std::tie(a.nodes, a.position) < std::tie(b.nodes, b.position); });
  std::vector<Ordered<MeshReport::SharedFace>> found;
  for (std::size_t i = 0; i < sides.size();)
  {
    std::size_t end = i;
    while (end < sides.size() && sides[end].nodes == sides[i].nodes)
      ++end;
    if (end - i > 2)
      found.push_back(
          {sides[i].position, {{sides[i].id, sides[i + 1].id}, int(end - i), sides[i].centre}});
    i = end;
  }
  return findingsOf(found, comm);
}

Findings<MeshReport::NodePair> findCoincident(const RankMesh& home,
                                              const std::vector<std::int64_t>& bodies,
                                              const std::vector<char>& onJoint, const Boxes& boxes,
                                              Real tolerance, const Comm& comm)
{
  const auto cell = [&](Real value)
  { return tolerance > 0 ? std::floor(value / (2 * tolerance) + 0.5) : value; };
  std::vector<std::vector<PlacedNode>> toRank(comm.size());
  for (int n = 0; n < home.ownedNodes; ++n)
  {
    if (bodies[n] < 0)
      continue;
    const Vec3& x = home.coordinates[n];
    const Vec3 place{cell(x.x), cell(x.y), cell(x.z)};
    toRank[boxes.rankOf(tolerance > 0 ? 2 * tolerance * place : place)].push_back(
        {bodies[n], place, home.nodePositions[n], home.nodeIds[n], onJoint[n] != 0});
  }
  std::vector<PlacedNode> nodes = comm.exchange(toRank);
  const auto key = [](const PlacedNode& node)
  { return std::tuple(node.body, node.cell.x, node.cell.y, node.cell.z); };
  std::sort(nodes.begin(), nodes.end(),
            [&](const PlacedNode& a, const PlacedNode& b)
            { return std::tuple(key(a), a.position) < std::tuple(key(b), b.position); });
  std::vector<Ordered<MeshReport::NodePair>> pairs;
  for (std::size_t i = 1; i < nodes.size(); ++i)
    if (const PlacedNode& a = nodes[i - 1], &b = nodes[i];
        key(a) == key(b) && !(a.onJoint && b.onJoint))
      pairs.push_back({a.position, {a.id, b.id}});
  return findingsOf(pairs, comm);
}
} // namespace coplane
