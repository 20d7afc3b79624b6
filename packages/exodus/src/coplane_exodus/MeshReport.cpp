#include <coplane_exodus/MeshReport.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace coplane
{
namespace
{
/// Parts of a mesh that share no node.
class Components
{
public:
  explicit Components(int nodes) : parent_(nodes) { std::iota(parent_.begin(), parent_.end(), 0); }
  int of(int node)
  {
    while (parent_[node] != node)
      node = parent_[node] = parent_[parent_[node]];
    return node;
  }
  void join(int a, int b) { parent_[of(a)] = of(b); }

private:
  std::vector<int> parent_;
};

std::array<Vec3, 8> cornersOf(const Mesh& mesh, const Mesh::Block& block, int element)
{
  std::array<Vec3, 8> corners{};
  const int perElement = topology(block.type).nodes;
  for (int k = 0; k < perElement; ++k)
    corners[k] = mesh.coordinates[block.connectivity[element * perElement + k]];
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
      report.shortestEdge = std::min(report.shortestEdge, length);
      report.longestEdge = std::max(report.longestEdge, length);
    }
}

/// Nodes of one body in one cell of a grid of two millionths of the shortest edge. Cells are
/// centred on multiples, so that round coordinates with round-off stay in one cell.
void findCoincident(MeshReport& report, const Mesh& mesh,
                    const std::vector<std::int64_t>& bodyOfNode)
{
  const Real tolerance = 1e-6 * report.shortestEdge;
  std::vector<int> order;
  for (int node = 0; node < mesh.nodes(); ++node)
    if (bodyOfNode[node] >= 0)
      order.push_back(node);
  const auto& x = mesh.coordinates;
  const auto cell = [&](Real value)
  { return tolerance > 0 ? std::floor(value / (2 * tolerance) + 0.5) : value; };
  const auto key = [&](int node)
  { return std::tuple(bodyOfNode[node], cell(x[node].x), cell(x[node].y), cell(x[node].z)); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (key(order[i - 1]) == key(order[i]))
      report.coincident.push_back({mesh.nodeIds[order[i - 1]], mesh.nodeIds[order[i]]});
}

/// The two sides of a joint that ends inside a body are meant: their nodes are no finding.
void forgetJoints(MeshReport& report, const Mesh& mesh)
{
  std::set<GlobalId> onJoints;
  std::vector<std::pair<int, int>> places; // block and index of each element
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    for (int e = 0; e < mesh.blocks[b].elements(); ++e)
      places.emplace_back(int(b), e);
  for (const MeshReport::Joint& joint : report.joints)
    for (const Mesh::SideSet& set : mesh.sideSets)
      for (std::size_t i = 0; set.id == joint.id && i < set.elements.size(); ++i)
      {
        const auto [b, e] = places[set.elements[i]];
        const ElementTopology& shape = topology(mesh.blocks[b].type);
        for (int k = 0; k < shape.nodesPerSide; ++k)
          onJoints.insert(
              mesh.nodeIds[mesh.blocks[b]
                               .connectivity[e * shape.nodes + shape.sideNodes[set.sides[i]][k]]]);
      }
  auto& pairs = report.coincident;
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                             [&](const MeshReport::NodePair& pair)
                             { return onJoints.count(pair.first) && onJoints.count(pair.second); }),
              pairs.end());
}

template <class Items, class Text>
std::string firstOf(const Items& items, const Text& text)
{
  constexpr std::size_t shown = 5;
  std::string list;
  for (std::size_t i = 0; i < std::min(items.size(), shown); ++i)
    list += (i ? ", " : "") + text(items[i]);
  if (items.size() > shown)
    list += fmt::format(" and {} more", items.size() - shown);
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

MeshReport reportMesh(const Mesh& mesh)
{
  MeshReport report;
  report.dimension = mesh.dimension;
  report.nodes = mesh.nodes();
  report.elements = mesh.elements();
  report.shortestEdge = infinity;
  report.lowest = {infinity, infinity, infinity};
  report.highest = {-infinity, -infinity, -infinity};
  for (const Vec3& x : mesh.coordinates)
    for (int k = 0; k < 3; ++k)
    {
      report.lowest[k] = std::min(report.lowest[k], x[k]);
      report.highest[k] = std::max(report.highest[k], x[k]);
    }

  Components components(mesh.nodes());
  std::vector<std::int64_t> bodyOfNode(mesh.nodes(), -1);
  for (const Mesh::Block& block : mesh.blocks)
  {
    const ElementTopology& shape = topology(block.type);
    Real volume = 0, worst = 1;
    GlobalId worstElement = 0;
    for (int e = 0; e < block.elements(); ++e)
    {
      const int* nodes = &block.connectivity[e * shape.nodes];
      const auto corners = cornersOf(mesh, block, e);
      const Real v = elementVolume(block.type, corners);
      volume += v;
      if (!(v > 0))
        report.inverted.push_back({block.elementIds[e], block.name, v});
      if (std::set<int>(nodes, nodes + shape.nodes).size() < std::size_t(shape.nodes))
        report.repeatedNodes.push_back({block.elementIds[e], block.name, v});
      const Real quality = elementQuality(block.type, corners);
      if (v > 0 && !(quality > 0))
        report.folded.push_back({block.elementIds[e], block.name, v});
      if (e == 0 || quality < worst)
      {
        worst = quality;
        worstElement = block.elementIds[e];
      }
      measureEdges(report, shape, corners);
      for (int k = 0; k < shape.nodes; ++k)
      {
        components.join(nodes[k], nodes[0]);
        bodyOfNode[nodes[k]] = block.bodyIds.empty() ? 0 : block.bodyIds[e];
      }
    }
    report.blocks.push_back(
        {block.id, block.name, shape.exodusName, block.elements(), 0, volume, worst, worstElement});
  }
  std::set<int> all;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    std::set<int> mine;
    const int perElement = topology(mesh.blocks[b].type).nodes;
    for (int e = 0; e < mesh.blocks[b].elements(); ++e)
      mine.insert(components.of(mesh.blocks[b].connectivity[e * perElement]));
    report.blocks[b].bodies = int(mine.size());
    all.insert(mine.begin(), mine.end());
  }
  report.bodies = int(all.size());
  for (int node = 0; node < mesh.nodes(); ++node)
    if (bodyOfNode[node] < 0)
      report.unusedNodes.push_back(mesh.nodeIds[node]);
    else if (bodyOfNode[node] ==
             0) // no body ids in the file: parts that share nodes count as bodies
      bodyOfNode[node] = (std::int64_t(1) << 32) + components.of(node);
  if (report.elements > 0)
  {
    findCoincident(report, mesh, bodyOfNode);
    report.joints = findJoints(mesh, 1e-6 * report.shortestEdge);
    forgetJoints(report, mesh);
  }
  return report;
}

std::vector<std::string> meshProblems(const MeshReport& report)
{
  std::vector<std::string> problems;
  const char* measure = report.dimension == 2 ? "area" : "volume";
  const char* unit = report.dimension == 2 ? "m^2" : "m^3";
  if (!report.inverted.empty())
    problems.push_back(fmt::format("{} elements are inside out or flat ({} zero or negative): {}. "
                                   "Correct the order of their nodes, or mesh "
                                   "there again.",
                                   report.inverted.size(), measure,
                                   firstOf(report.inverted,
                                           [&](const MeshReport::BadElement& e)
                                           {
                                             return fmt::format(
                                                 "element {} of block '{}' ({:.3g} {})", e.element,
                                                 e.block, e.volume, unit);
                                           })));
  if (!report.repeatedNodes.empty())
    problems.push_back(fmt::format(
        "{} elements use a node twice: {}. Quadrilaterals and hexahedra may not be collapsed to "
        "other shapes; mesh there again.",
        report.repeatedNodes.size(),
        firstOf(report.repeatedNodes, [](const MeshReport::BadElement& e)
                { return fmt::format("element {} of block '{}'", e.element, e.block); })));
  if (!report.folded.empty())
    problems.push_back(fmt::format(
        "{} elements are folded at a corner: {}. Their {} is positive, but they are not convex; "
        "mesh "
        "there again.",
        report.folded.size(),
        firstOf(report.folded, [](const MeshReport::BadElement& e)
                { return fmt::format("element {} of block '{}'", e.element, e.block); }),
        measure));
  for (const MeshReport::Joint& joint : report.joints)
    if (!joint.alone.empty())
      problems.push_back(fmt::format(
          "side set '{}' is a joint of {} pairs of faces, but {} of its faces have no partner in "
          "it: "
          "{}. Add the faces that they touch, or take them out.",
          joint.name, joint.pairs, joint.alone.size(),
          firstOf(joint.alone, [](const std::pair<GlobalId, int>& side)
                  { return fmt::format("side {} of element {}", side.second, side.first); })));
  if (!report.unusedNodes.empty())
    problems.push_back(fmt::format(
        "{} nodes belong to no element: {}. They have no mass; remove them from the mesh.",
        report.unusedNodes.size(),
        firstOf(report.unusedNodes, [](GlobalId id) { return fmt::format("node {}", id); })));
  if (!report.coincident.empty())
    problems.push_back(
        fmt::format("{} pairs of nodes of one body lie at one place: {}. If no crack is meant "
                    "there, merge them.",
                    report.coincident.size(),
                    firstOf(report.coincident, [](const MeshReport::NodePair& p)
                            { return fmt::format("nodes {} and {}", p.first, p.second); })));
  return problems;
}

std::vector<std::string> meshProblems(const Mesh& mesh)
{
  return meshProblems(reportMesh(mesh));
}
} // namespace coplane
