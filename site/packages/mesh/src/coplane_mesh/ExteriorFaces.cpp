#include <coplane_core/Lists.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace coplane
{
namespace
{
/// A side of an element as a face, its nodes from the outside; for owners of none of its nodes
/// without meaning.
ExteriorFace faceOf(const RankMesh& mesh, int b, int e, int s)
{
  const RankMesh::Block& block = mesh.blocks[b];
  const ElementTopology& shape = topology(block.type);
  ExteriorFace face;
  face.id = faceId(block.elementIds[e], s);
  face.block = b;
  face.element = e;
  face.side = s;
  face.nodeCount = shape.nodesPerSide;
  int lowest = -1;
  for (int k = 0; k < face.nodeCount; ++k)
  {
    const int node = block.connectivity[e * shape.nodes + shape.sideNodes[s][k]];
    face.nodes[k] = node;
    if (lowest < 0 || mesh.nodeIds[node] < mesh.nodeIds[lowest])
      lowest = node;
  }
  face.ownedHere = lowest < mesh.ownedNodes;
  return face;
}

std::array<int, 4> sortedNodes(const ExteriorFace& face)
{
  std::array<int, 4> nodes = face.nodes;
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// f(block, element, side) of every side with an owned node.
template <class F>
void forEachSide(const RankMesh& mesh, const F& f)
{
  for (int b = 0; b < int(mesh.blocks.size()); ++b)
  {
    const RankMesh::Block& block = mesh.blocks[b];
    const ElementTopology& shape = topology(block.type);
    for (int e = 0; e < block.elements(); ++e)
      for (int s = 0; s < shape.sides; ++s)
      {
        bool local = false;
        for (int k = 0; k < shape.nodesPerSide; ++k)
          local = local ||
                  block.connectivity[e * shape.nodes + shape.sideNodes[s][k]] < mesh.ownedNodes;
        if (local)
          f(b, e, s);
      }
  }
}
} // namespace

ElementSides::ElementSides(const RankMesh& mesh)
{
  std::vector<std::pair<std::array<int, 4>, ExteriorFace>> all;
  forEachSide(mesh,
              [&](int b, int e, int s)
              {
                const ExteriorFace face = faceOf(mesh, b, e, s);
                all.emplace_back(sortedNodes(face), face);
              });
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b)
            { return std::tie(a.first, a.second.id) < std::tie(b.first, b.second.id); });

  sides_.reserve(all.size());
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    if (i == 0 || all[i].first != all[i - 1].first)
      start_.push_back(int(i));
    sides_.push_back(all[i].second);
  }
  start_.push_back(int(sides_.size()));
}

std::vector<ExteriorFace> ElementSides::exterior(const std::vector<std::vector<char>>& alive) const
{
  std::vector<ExteriorFace> faces;
  for (std::size_t g = 0; g + 1 < start_.size(); ++g)
  {
    const ExteriorFace* only = nullptr;
    int living = 0;
    for (int i = start_[g]; i < start_[g + 1]; ++i)
      if (alive[sides_[i].block][sides_[i].element])
      {
        only = &sides_[i];
        ++living;
      }
    if (living == 1)
      faces.push_back(*only);
  }
  std::sort(faces.begin(), faces.end(),
            [](const ExteriorFace& a, const ExteriorFace& b) { return a.id < b.id; });
  return faces;
}

std::vector<ExteriorFace> exteriorFaces(const RankMesh& mesh)
{
  // Sides in the order of their lowest node, a few bytes for each: only those with the same lowest
  // node can be the same face.
  struct Side
  {
    int block, element, side;
  };
  const auto lowestNode = [&](int b, int e, int s)
  {
    const ElementTopology& shape = topology(mesh.blocks[b].type);
    int lowest = mesh.blocks[b].connectivity[e * shape.nodes + shape.sideNodes[s][0]];
    for (int k = 1; k < shape.nodesPerSide; ++k)
      lowest =
          std::min(lowest, mesh.blocks[b].connectivity[e * shape.nodes + shape.sideNodes[s][k]]);
    return lowest;
  };
  const Lists<Side> sides(mesh.nodeIds.size(),
                          [&](const auto& visit)
                          {
                            forEachSide(mesh,
                                        [&](int b, int e, int s) {
                                          visit(std::size_t(lowestNode(b, e, s)), Side{b, e, s});
                                        });
                          });

  std::vector<ExteriorFace> faces;
  std::vector<ExteriorFace> here;
  std::vector<std::array<int, 4>> nodes;
  for (std::size_t n = 0; n < sides.count(); ++n)
  {
    here.clear();
    nodes.clear();
    for (const Side& side : sides[n])
    {
      here.push_back(faceOf(mesh, side.block, side.element, side.side));
      nodes.push_back(sortedNodes(here.back()));
    }
    for (std::size_t i = 0; i < here.size(); ++i)
      if (std::count(nodes.begin(), nodes.end(), nodes[i]) == 1)
        faces.push_back(here[i]);
  }
  std::sort(faces.begin(), faces.end(),
            [](const ExteriorFace& a, const ExteriorFace& b) { return a.id < b.id; });
  return faces;
}
} // namespace coplane
