#include <coplane_core/ExactSum.hpp>
#include <coplane_exodus/MeshReport.hpp>
#include <coplane_exodus/detail/FindingsOverRanks.hpp>
#include <coplane_mesh/Bodies.hpp>
#include <coplane_mesh/Distribute.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace coplane
{
namespace
{
std::array<Vec3, 8> cornersOf(const RankMesh& mesh, const RankMesh::Block& block, int element)
{
  std::array<Vec3, 8> corners{};
  const int perElement = topology(block.type).nodes;
  for (int k = 0; k < perElement; ++k)
    corners[k] = mesh.coordinates[block.connectivity[std::size_t(element) * perElement + k]];
  return corners;
}

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

/// The same bits for the same corners in any order.
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

struct PlacedElement
{
  Vec3 cell, centre;
  std::int64_t position; ///< in the file
  GlobalId id;
};

/// Elements whose centres lie in one cell of a grid: written twice, or of bodies on each other.
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

struct PlacedSide
{
  std::array<int, 4> nodes; ///< positions in the file, ascending; -1: none
  Vec3 centre;
  std::int64_t position; ///< of the element in the file
  GlobalId id;
};

/// Faces that more than two elements have: there is no inside and outside there.
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

struct PlacedNode
{
  std::int64_t body;
  Vec3 cell;
  int position; ///< in the file
  GlobalId id;
  bool onJoint;
};

/// Nodes of one body in one cell of a grid of two millionths of the shortest edge. Cells are
/// centred on multiples, so that round coordinates with round-off stay in one cell. The two sides
/// of a joint that ends inside a body are meant: their nodes are no finding.
/// @param bodies of the owned nodes; negative: of no element
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

// Beyond these a mesh is told of, though it can be used.
constexpr Real poorQuality = 0.03;                         // a corner of 2 degrees in a rectangle
constexpr Real shortEdge = 1.0 / 300;                      // of the longest
constexpr Real largestExtent = 1e5, smallestExtent = 1e-5; // [m]

std::string at(const Vec3& x)
{
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", x.x, x.y, x.z);
}

template <class T, class Text>
std::string firstOf(const Findings<T>& items, const Text& text)
{
  std::string list;
  for (std::size_t i = 0; i < items.first.size(); ++i)
    list += (i ? ", " : "") + text(items.first[i]);
  if (const std::int64_t more = items.count - std::int64_t(items.first.size()); more > 0)
    list += fmt::format(" and {} more", more);
  return list;
}
} // namespace

Real elementVolume(ElementType type, const std::array<Vec3, 8>& c)
{
  if (type == ElementType::Tri3)
    return 0.5 * ((c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y));
  if (type == ElementType::Tet4)
    return dot(cross(c[1] - c[0], c[2] - c[0]), c[3] - c[0]) / 6;
  if (type == ElementType::Quad4)
    return 0.5 * ((c[2].x - c[0].x) * (c[3].y - c[1].y) + (c[1].x - c[3].x) * (c[2].y - c[0].y));
  // V = sum_I x_I B_I, with B_1 of Flanagan & Belytschko 1981 and their index permutations for the
  // other nodes.
  static const int order[8][8] = {{0, 1, 2, 3, 4, 5, 6, 7}, {1, 2, 3, 0, 5, 6, 7, 4},
                                  {2, 3, 0, 1, 6, 7, 4, 5}, {3, 0, 1, 2, 7, 4, 5, 6},
                                  {4, 7, 6, 5, 0, 3, 2, 1}, {5, 4, 7, 6, 1, 0, 3, 2},
                                  {6, 5, 4, 7, 2, 1, 0, 3}, {7, 6, 5, 4, 3, 2, 1, 0}};
  // Positions relative to the first corner: a small element far from the origin loses no digits.
  Vec3 p[8];
  for (int i = 0; i < 8; ++i)
    p[i] = c[i] - c[0];
  Real volume = 0;
  for (const auto& o : order)
  {
    const auto y = [&](int i) { return p[o[i - 1]].y; };
    const auto z = [&](int i) { return p[o[i - 1]].z; };
    const Real b = y(2) * ((z(6) - z(3)) - (z(4) - z(5))) + y(3) * (z(2) - z(4)) +
                   y(4) * ((z(3) - z(8)) - (z(5) - z(2))) + y(5) * ((z(8) - z(6)) - (z(2) - z(4))) +
                   y(6) * (z(5) - z(2)) + y(8) * (z(4) - z(5));
    volume += p[o[0]].x * b / 12;
  }
  return volume;
}

Real elementQuality(ElementType type, const std::array<Vec3, 8>& c)
{
  // For every corner the ends of its edges, right-handed.
  static const int ends[4][8][3] = {
      {{1, 2, 0}, {2, 0, 0}, {0, 1, 0}},
      {{1, 3, 0}, {2, 0, 0}, {3, 1, 0}, {0, 2, 0}},
      {{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}},
      {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};
  // Equilateral triangle: sin 60 degrees; regular tetrahedron: 1 / sqrt(2).
  const int row = type == ElementType::Tri3    ? 0
                  : type == ElementType::Quad4 ? 1
                  : type == ElementType::Tet4  ? 2
                                               : 3;
  const Real ideal[] = {std::sqrt(0.75), 1.0, std::sqrt(0.5), 1.0};
  const ElementTopology& shape = topology(type);
  Real least = infinity;
  for (int k = 0; k < shape.nodes; ++k)
  {
    const int* end = ends[row][k];
    const Vec3 a = c[end[0]] - c[k], b = c[end[1]] - c[k];
    const Vec3 up = shape.dimension == 2 ? Vec3{0, 0, 1} : c[end[2]] - c[k];
    const Real product = norm(a) * norm(b) * norm(up);
    least = std::min(least, product > 0 ? dot(cross(a, b), up) / product : 0.0);
  }
  return least / ideal[row];
}

namespace
{
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

void reportElements(MeshReport& report, const MeshSlice& slice, const RankMesh& home,
                    const Comm& comm)
{
  std::vector<Ordered<FoundElement>> inverted, repeated, folded;
  const std::size_t blocks = home.blocks.size();
  std::vector<ExactSum> volumes(blocks);
  std::vector<Real> worst(blocks, infinity);
  std::vector<std::int64_t> worstPosition(blocks, INT64_MAX);
  std::vector<Vec3> worstPlace(blocks);
  for (std::size_t b = 0; b < blocks; ++b)
  {
    const RankMesh::Block& block = home.blocks[b];
    const ElementTopology& shape = topology(block.type);
    for (int e = 0; e < block.elements(); ++e)
    {
      if (!block.owned[e])
        continue;
      const int* nodes = &block.connectivity[std::size_t(e) * shape.nodes];
      const auto corners = cornersOf(home, block, e);
      const Real v = elementVolume(block.type, corners);
      const Ordered<FoundElement> here{slice.firstElements[b] + block.positions[e],
                                       {int(b), block.elementIds[e], v}};
      volumes[b].add(v);
      if (!(v > 0))
        inverted.push_back(here);
      if (std::set<int>(nodes, nodes + shape.nodes).size() < std::size_t(shape.nodes))
        repeated.push_back(here);
      const Real quality = elementQuality(block.type, corners);
      if (v > 0 && !(quality > 0))
        folded.push_back(here);
      if (quality < worst[b])
      {
        worst[b] = quality;
        worstPosition[b] = block.positions[e];
        worstPlace[b] = centreOf(corners, shape.nodes);
      }
      measureEdges(report, shape, corners);
    }
  }
  report.inverted = badElements(slice, inverted, comm);
  report.repeatedNodes = badElements(slice, repeated, comm);
  report.folded = badElements(slice, folded, comm);
  const Real shortest = report.shortestEdge;
  report.shortestEdge = comm.min(shortest);
  report.shortestPlace = agreedPlace(report.shortestPlace, shortest == report.shortestEdge, comm);
  report.longestEdge = comm.max(report.longestEdge);

  const std::vector<Real> sums = ExactSum::overRanks(volumes, comm);
  for (std::size_t b = 0; b < blocks; ++b)
  {
    const Mesh::Block& block = slice.mine.blocks[b];
    const Real least = comm.min(worst[b]);
    const std::int64_t position = comm.min(worst[b] == least ? worstPosition[b] : INT64_MAX);
    GlobalId id = 0; // of the worst element
    if (worst[b] == least && worstPosition[b] == position && position < INT64_MAX)
    {
      const std::vector<int>& positions = home.blocks[b].positions;
      const auto place = std::lower_bound(positions.begin(), positions.end(), int(position));
      id = home.blocks[b].elementIds[std::size_t(place - positions.begin())];
    }
    report.blocks.push_back({block.id, block.name, topology(block.type).exodusName,
                             slice.elementsOf(int(b)), 0, sums[b], std::min(least, Real(1)),
                             comm.max(std::int64_t(id)),
                             agreedPlace(worstPlace[b], id != 0, comm)});
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

bool MeshReport::tooFar() const
{
  Real most = 0;
  for (int c = 0; c < 3; ++c)
    most = std::max({most, std::abs(lowest[c]), std::abs(highest[c])});
  return shortestEdge > 0 && most > farthest * shortestEdge;
}

namespace
{
using Problems = std::vector<std::string>;

std::string nameOf(const MeshReport::BadElement& e)
{
  return fmt::format("element {} of block '{}'", e.element, e.block);
}

void addProblemsOfElements(const MeshReport& report, Problems& problems)
{
  const char* measure = report.dimension == 2 ? "area" : "volume";
  const char* unit = report.dimension == 2 ? "m^2" : "m^3";
  if (!report.inverted.empty())
    problems.push_back(
        fmt::format("{} elements are inside out or flat ({} zero or negative): {}. "
                    "Correct the order of their nodes, or remesh "
                    "that region.",
                    report.inverted.count, measure,
                    firstOf(report.inverted, [&](const MeshReport::BadElement& e)
                            { return fmt::format("{} ({:.3g} {})", nameOf(e), e.volume, unit); })));
  if (!report.repeatedNodes.empty())
    problems.push_back(fmt::format(
        "{} elements use a node twice: {}. Quadrilaterals and hexahedra may not be collapsed to "
        "other shapes; remesh that region.",
        report.repeatedNodes.count, firstOf(report.repeatedNodes, nameOf)));
  if (!report.folded.empty())
    problems.push_back(fmt::format(
        "{} elements are folded at a corner: {}. Their {} is positive, but they are not convex; "
        "remesh "
        "that region.",
        report.folded.count, firstOf(report.folded, nameOf), measure));
  for (const MeshReport::BlockSummary& block : report.blocks)
    if (block.worstQuality > 0 && block.worstQuality < poorQuality)
      problems.push_back(fmt::format(
          "element {} of block '{}' at {} has the shape {:.3g} (1 is ideal, 0 is flat): it takes a "
          "small time step and is stiff. Remesh that region.",
          block.worstElement, block.name, at(block.worstPlace), block.worstQuality));
}

void addProblemsOfJoints(const MeshReport& report, Problems& problems)
{
  for (const MeshReport::Joint& joint : report.joints)
    if (!joint.alone.empty())
      problems.push_back(fmt::format(
          "side set '{}' is a joint of {} pairs of faces, but {} of its faces have no partner in "
          "it: "
          "{}. Add the faces that they touch, or take them out.",
          joint.name, joint.pairs, joint.alone.count,
          firstOf(joint.alone, [](const std::pair<GlobalId, int>& side)
                  { return fmt::format("side {} of element {}", side.second, side.first); })));
}

void addProblemsOfConnection(const MeshReport& report, Problems& problems)
{
  if (!report.unusedNodes.empty())
    problems.push_back(fmt::format(
        "{} nodes belong to no element: {}. They have no mass; remove them from the mesh.",
        report.unusedNodes.count,
        firstOf(report.unusedNodes, [](GlobalId id) { return fmt::format("node {}", id); })));
  if (!report.coincident.empty())
    problems.push_back(
        fmt::format("{} pairs of nodes of one body lie at one place: {}. If no crack is meant "
                    "there, merge them.",
                    report.coincident.count,
                    firstOf(report.coincident, [](const MeshReport::NodePair& p)
                            { return fmt::format("nodes {} and {}", p.first, p.second); })));
  if (!report.twice.empty())
    problems.push_back(fmt::format(
        "{} pairs of elements have their centres at one place: {}. They are in the file twice, or "
        "bodies lie in each other; remove one of each pair.",
        report.twice.count,
        firstOf(report.twice,
                [](const MeshReport::ElementPair& p) {
                  return fmt::format("elements {} and {} at {}", p.first, p.second, at(p.place));
                })));
  if (!report.overused.empty())
    problems.push_back(fmt::format(
        "{} {} belong to more than two elements: {}. There is no inside and outside there; use "
        "nodes of its own for one of the bodies.",
        report.overused.count, report.dimension == 2 ? "edges" : "faces",
        firstOf(report.overused,
                [](const MeshReport::SharedFace& f)
                {
                  return fmt::format("of {} elements, among them {} and {}, at {}", f.count,
                                     f.elements[0], f.elements[1], at(f.place));
                })));
}

void addProblemsOfLengths(const MeshReport& report, Problems& problems)
{
  if (report.tooFar())
    problems.push_back(fmt::format(
        "coordinates from {} to {} m, and an edge of {:.3g} m at {}: too few of sixteen digits are "
        "left for it; accepted: up to {:.0e} times the shortest edge. Look at the outermost nodes, "
        "at that edge and at the units.",
        at(report.lowest), at(report.highest), report.shortestEdge, at(report.shortestPlace),
        MeshReport::farthest));
  if (report.shortestEdge > 0 && report.shortestEdge < shortEdge * report.longestEdge)
    problems.push_back(fmt::format(
        "the shortest edge, {:.3g} m at {}, is {:.0f} times shorter than the longest: it sets the "
        "time step of all. If that is not intended, remesh that region.",
        report.shortestEdge, at(report.shortestPlace), report.longestEdge / report.shortestEdge));
  const Real extent = norm(report.highest - report.lowest);
  if (report.elements > 0 && (extent > largestExtent || extent < smallestExtent))
    problems.push_back(fmt::format(
        "the mesh measures {:.3g} m from corner to corner. Are its lengths in metres? Scale its "
        "coordinates if not.",
        extent));
}
} // namespace

std::vector<std::string> meshProblems(const MeshReport& report)
{
  Problems problems;
  for (const auto add :
       {addProblemsOfElements, addProblemsOfJoints, addProblemsOfConnection, addProblemsOfLengths})
    add(report, problems);
  return problems;
}

std::vector<std::string> meshProblems(const Mesh& mesh)
{
  return meshProblems(reportMesh(mesh));
}
} // namespace coplane
