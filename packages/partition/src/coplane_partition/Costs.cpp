#include <coplane_partition/Partition.hpp>

#include <algorithm>

namespace coplane
{
std::vector<Real> nodeCosts(const Mesh& mesh, const PartitionCosts& costs)
{
  std::vector<Real> ofNode(mesh.nodes(), 0);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const Real corner = costs.ofElement[b] / topology(mesh.blocks[b].type).nodes;
    for (const int node : mesh.blocks[b].connectivity)
      ofNode[node] += corner;
  }
  if (costs.ofFace > 0)
  {
    // As one rank would have it: local nodes are those of the file.
    const RankMesh whole = distribute(mesh, std::vector<int>(mesh.nodes(), 0), 0);
    for (const ExteriorFace& face : exteriorFaces(whole))
      for (int k = 0; k < face.nodeCount; ++k)
        ofNode[face.nodes[k]] += costs.ofFace / face.nodeCount;
  }
  return ofNode;
}

PartitionQuality qualityOf(const Mesh& mesh, const std::vector<int>& owners, int ranks,
                           const std::vector<Real>& costs)
{
  PartitionQuality quality;
  quality.owned.assign(ranks, 0);
  quality.neighbors.assign(ranks, 0);
  std::vector<Real> sum(ranks, 0);
  Real total = 0;
  for (int n = 0; n < mesh.nodes(); ++n)
  {
    const Real cost = costs.empty() ? 1 : costs[n];
    ++quality.owned[owners[n]];
    sum[owners[n]] += cost;
    total += cost;
  }
  if (total > 0)
    quality.imbalance = *std::max_element(sum.begin(), sum.end()) * ranks / total;

  std::vector<std::pair<int, int>> needed; // rank and node of another rank
  for (const Mesh::Block& block : mesh.blocks)
  {
    const int nodes = topology(block.type).nodes;
    for (int e = 0; e < block.elements(); ++e)
    {
      const int* const corners = &block.connectivity[e * nodes];
      bool cut = false;
      for (int k = 0; k < nodes; ++k)
        for (int l = 0; l < nodes; ++l)
          if (owners[corners[l]] != owners[corners[k]])
          {
            needed.emplace_back(owners[corners[k]], corners[l]);
            cut = true;
          }
      quality.cutElements += cut;
    }
  }
  std::sort(needed.begin(), needed.end());
  needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
  for (const auto& [rank, node] : needed)
    ++quality.neighbors[rank];
  return quality;
}
} // namespace coplane
