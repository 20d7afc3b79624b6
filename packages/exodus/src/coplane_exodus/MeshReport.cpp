#include <coplane_core/ExactSum.hpp>
#include <coplane_exodus/MeshReport.hpp>
#include <coplane_exodus/detail/FindingsOverRanks.hpp>
#include <coplane_exodus/detail/MeshFindings.hpp>
#include <coplane_mesh/Bodies.hpp>
#include <coplane_mesh/Distribute.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace coplane
{
namespace
{
void measureEdges(MeshReport& report, const ElementTopology& shape,
                  const std::array<Vec3, 8>& corners)
{
  for (int side = 0; side < shape.sides; ++side)
    for (int k = 0; k < (shape.dimension == 2 ? 1 : shape.nodesPerSide); ++k)
    {
      const Vec3& a = corners[shape.sideNodes[side][k]];
      const Vec3& b = corners[shape.sideNodes[side][(k + 1) % shape.nodesPerSide]];
      const Real length = norm(b - a);
      if (length < report.shortestEdge)
        report.shortestPlace = 0.5 * (a + b);
      report.shortestEdge = std::min(report.shortestEdge, length);
      report.longestEdge = std::max(report.longestEdge, length);
    }
}

/// The place of the rank that has it; of several the one with the lowest coordinates. Collective.
Vec3 agreedPlace(const Vec3& mine, bool isMine, const Comm& comm)
{
  Vec3 place{};
  for (int c = 0; c < 3; ++c)
  {
    place[c] = comm.min(isMine ? mine[c] : infinity);
    isMine = isMine && mine[c] == place[c];
  }
  return place;
}

/// Which owned nodes lie on joints.
std::vector<char> nodesOfJoints(const MeshSlice& slice, const RankMesh& home,
                                const std::vector<MeshReport::Joint>& joints)
{
  std::vector<char> onJoint(home.nodes(), 0);
  for (const MeshReport::Joint& joint : joints)
    for (std::size_t s = 0; s < home.sideSets.size(); ++s)
      if (slice.mine.sideSets[s].id == joint.id)
        for (const RankMesh::Side& side : home.sideSets[s])
        {
          const RankMesh::Block& block = home.blocks[side.block];
          const ElementTopology& shape = topology(block.type);
          for (int k = 0; k < shape.nodesPerSide; ++k)
            onJoint[block.connectivity[std::size_t(side.element) * shape.nodes +
                                       shape.sideNodes[side.side][k]]] = 1;
        }
  return onJoint;
}

/// Counts bodies, of the mesh and of each block.
/// @param labels of the nodes
void countBodies(MeshReport& report, const MeshSlice& slice, const RankMesh& home,
                 const std::vector<int>& labels, const Comm& comm)
{
  std::int64_t first = 0;
  for (int n = 0; n < home.ownedNodes; ++n)
    first += labels[n] == home.nodePositions[n];
  report.bodies = comm.sum(first);
  std::set<std::pair<int, int>> mine; // body and block
  for (std::size_t b = 0; b < home.blocks.size(); ++b)
  {
    const RankMesh::Block& block = home.blocks[b];
    for (int e = 0; e < block.elements(); ++e)
      mine.emplace(labels[block.connectivity[std::size_t(e) * topology(block.type).nodes]], int(b));
  }
  struct BodyInBlock
  {
    int body, block;
  };
  std::vector<std::vector<BodyInBlock>> toHomes(comm.size());
  for (const auto& [body, block] : mine)
    toHomes[slice.homeOfNode(body)].push_back({body, block});
  mine.clear();
  for (const BodyInBlock& item : comm.exchange(toHomes))
    mine.emplace(item.body, item.block);
  std::vector<std::int64_t> counts(home.blocks.size(), 0);
  for (const auto& [body, block] : mine)
    ++counts[block];
  comm.sum(counts);
  for (std::size_t b = 0; b < counts.size(); ++b)
    report.blocks[b].bodies = counts[b];
}

struct FoundElement
{
  int block;
  GlobalId id;
  Real volume;
};

Findings<MeshReport::BadElement> badElements(const MeshSlice& slice,
                                             const std::vector<Ordered<FoundElement>>& mine,
                                             const Comm& comm)
{
  const Findings<FoundElement> found = findingsOf(mine, comm);
  Findings<MeshReport::BadElement> bad{found.count, {}};
  for (const FoundElement& element : found.first)
    bad.first.push_back({element.id, slice.mine.blocks[element.block].name, element.volume});
  return bad;
}

/// The element of a block with the worst shape, of those of this rank.
struct WorstShape
{
  Real quality = infinity;
  std::int64_t position = INT64_MAX; ///< in the block
  Vec3 place;
};

/// What the elements of this rank add up to.
struct Tally
{
  std::vector<Ordered<FoundElement>> inverted, repeated, folded;
  std::vector<ExactSum> volumes; ///< by block
  std::vector<WorstShape> worst; ///< by block
};

void addElement(Tally& tally, MeshReport& report, const MeshSlice& slice, const RankMesh& home,
                std::size_t b, int e)
{
  const RankMesh::Block& block = home.blocks[b];
  const ElementTopology& shape = topology(block.type);
  const int* nodes = &block.connectivity[std::size_t(e) * shape.nodes];
  const auto corners = cornersOf(home, block, e);
  const Real v = elementVolume(block.type, corners);
  const Ordered<FoundElement> here{slice.firstElements[b] + block.positions[e],
                                   {int(b), block.elementIds[e], v}};
  tally.volumes[b].add(v);
  if (!(v > 0))
    tally.inverted.push_back(here);
  if (std::set<int>(nodes, nodes + shape.nodes).size() < std::size_t(shape.nodes))
    tally.repeated.push_back(here);
  const Real quality = elementQuality(block.type, corners);
  if (v > 0 && !(quality > 0))
    tally.folded.push_back(here);
  if (quality < tally.worst[b].quality)
    tally.worst[b] = {quality, block.positions[e], centreOf(corners, shape.nodes)};
  measureEdges(report, shape, corners);
}

/// The id of the element with the worst shape of all ranks on its rank, 0 on the others.
/// Collective.
GlobalId idOfWorst(const WorstShape& mine, Real least, const RankMesh::Block& block,
                   const Comm& comm)
{
  const std::int64_t position = comm.min(mine.quality == least ? mine.position : INT64_MAX);
  if (mine.quality != least || mine.position != position || position == INT64_MAX)
    return 0;
  const std::vector<int>& positions = block.positions;
  const auto place = std::lower_bound(positions.begin(), positions.end(), int(position));
  return block.elementIds[std::size_t(place - positions.begin())];
}

/// Collective.
void reportElements(MeshReport& report, const MeshSlice& slice, const RankMesh& home,
                    const Comm& comm)
{
  const std::size_t blocks = home.blocks.size();
  Tally tally;
  tally.volumes.resize(blocks);
  tally.worst.resize(blocks);
  for (std::size_t b = 0; b < blocks; ++b)
    for (int e = 0; e < home.blocks[b].elements(); ++e)
      if (home.blocks[b].owned[e])
        addElement(tally, report, slice, home, b, e);
  report.inverted = badElements(slice, tally.inverted, comm);
  report.repeatedNodes = badElements(slice, tally.repeated, comm);
  report.folded = badElements(slice, tally.folded, comm);
  const Real shortest = report.shortestEdge;
  report.shortestEdge = comm.min(shortest);
  report.shortestPlace = agreedPlace(report.shortestPlace, shortest == report.shortestEdge, comm);
  report.longestEdge = comm.max(report.longestEdge);

  const std::vector<Real> sums = ExactSum::overRanks(tally.volumes, comm);
  for (std::size_t b = 0; b < blocks; ++b)
  {
    const Mesh::Block& block = slice.mine.blocks[b];
    const Real least = comm.min(tally.worst[b].quality);
    const GlobalId id = idOfWorst(tally.worst[b], least, home.blocks[b], comm);
    const GlobalId worstElement = comm.max(std::int64_t(id));
    report.blocks.push_back({block.id, block.name, topology(block.type).exodusName,
                             slice.elementsOf(int(b)), 0, sums[b], std::min(least, Real(1)),
                             worstElement, agreedPlace(tally.worst[b].place, id != 0, comm)});
  }
}

void reportNodes(MeshReport& report, const MeshSlice& slice, const RankMesh& home, const Comm& comm)
{
  std::vector<Real> lowest(3, infinity), highest(3, -infinity);
  for (int n = 0; n < home.ownedNodes; ++n)
    for (int k = 0; k < 3; ++k)
    {
      lowest[k] = std::min(lowest[k], home.coordinates[n][k]);
      highest[k] = std::max(highest[k], home.coordinates[n][k]);
    }
  comm.min(lowest);
  comm.max(highest);
  report.lowest = {lowest[0], lowest[1], lowest[2]};
  report.highest = {highest[0], highest[1], highest[2]};
  const Boxes boxes(report.lowest, report.highest, comm.size());

  const std::vector<int> labels = bodyLabels(home, std::vector<char>(home.blocks.size(), 1), comm);
  countBodies(report, slice, home, labels, comm);
  std::vector<std::int64_t> bodies(home.nodes(), -1);
  for (const RankMesh::Block& block : home.blocks)
  {
    const int perElement = topology(block.type).nodes;
    for (int e = 0; e < block.elements(); ++e)
      for (int k = 0; k < perElement; ++k)
        bodies[block.connectivity[std::size_t(e) * perElement + k]] = block.bodyIds[e];
  }
  std::vector<Ordered<GlobalId>> unused;
  for (int n = 0; n < home.ownedNodes; ++n)
    if (bodies[n] < 0)
      unused.push_back({home.nodePositions[n], home.nodeIds[n]});
    else if (bodies[n] == 0) // no body ids in the file: parts that share nodes count as bodies
      bodies[n] = (std::int64_t(1) << 32) + labels[n];
  report.unusedNodes = findingsOf(unused, comm);
  if (report.elements == 0)
    return;
  const Real tolerance = 1e-6 * report.shortestEdge;
  report.twice = findTwice(slice, home, boxes, tolerance, comm);
  report.overused = findOverused(slice, home, comm);
  report.joints = findJoints(slice, home, boxes, tolerance, comm);
  report.coincident = findCoincident(home, bodies, nodesOfJoints(slice, home, report.joints), boxes,
                                     tolerance, comm);
}
} // namespace

bool MeshReport::tooFar() const
{
  Real most = 0;
  for (int c = 0; c < 3; ++c)
    most = std::max({most, std::abs(lowest[c]), std::abs(highest[c])});
  return shortestEdge > 0 && most > farthest * shortestEdge;
}

MeshReport reportMesh(const MeshSlice& slice, const RankMesh& home, const Comm& comm)
{
  MeshReport report;
  report.dimension = slice.mine.dimension;
  report.nodes = slice.nodes;
  report.elements = slice.elements();
  report.shortestEdge = infinity;
  reportElements(report, slice, home, comm);
  reportNodes(report, slice, home, comm);
  return report;
}

MeshReport reportMesh(const Mesh& mesh)
{
  const Comm alone = Comm::alone();
  const MeshSlice slice = sliceOf(mesh);
  return reportMesh(slice, partAtHome(slice, alone), alone);
}
} // namespace coplane
