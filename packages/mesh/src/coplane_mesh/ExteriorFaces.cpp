#include <coplane_mesh/RankMesh.hpp>

#include <algorithm>

namespace coplane
{
ElementSides::ElementSides(const RankMesh& mesh)
{
  struct Candidate
  {
    std::array<int, 4> sortedNodes;
    ExteriorFace face;
  };
  std::vector<Candidate> candidates;
  for (int b = 0; b < int(mesh.blocks.size()); ++b)
  {
    const RankMesh::Block& block = mesh.blocks[b];
    const ElementTopology& shape = topology(block.type);
    for (int e = 0; e < block.elements(); ++e)
      for (int s = 0; s < shape.sides; ++s)
      {
        Candidate candidate;
        ExteriorFace& face = candidate.face;
        face.id = faceId(block.elementIds[e], s);
        face.block = b;
        face.element = e;
        face.side = s;
        face.nodeCount = shape.nodesPerSide;
        bool local = false;
        int lowest = -1;
        for (int k = 0; k < face.nodeCount; ++k)
        {
          const int node = block.connectivity[e * shape.nodes + shape.sideNodes[s][k]];
          face.nodes[k] = node;
          local = local || node < mesh.ownedNodes;
          if (lowest < 0 || mesh.nodeIds[node] < mesh.nodeIds[lowest])
            lowest = node;
        }
        if (!local)
          continue;
        face.ownedHere = lowest < mesh.ownedNodes;
        candidate.sortedNodes = face.nodes;
        std::sort(candidate.sortedNodes.begin(), candidate.sortedNodes.end());
        candidates.push_back(candidate);
      }
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b)
            { return std::tie(a.sortedNodes, a.face.id) < std::tie(b.sortedNodes, b.face.id); });

  sides_.reserve(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i)
  {
    if (i == 0 || candidates[i].sortedNodes != candidates[i - 1].sortedNodes)
      start_.push_back(int(i));
    sides_.push_back(candidates[i].face);
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
  std::vector<std::vector<char>> alive;
  for (const RankMesh::Block& block : mesh.blocks)
    alive.emplace_back(block.elements(), char(1));
  return ElementSides(mesh).exterior(alive);
}
} // namespace coplane
