#include <coplane_partition/Partition.hpp>

#include <algorithm>
#include <numeric>

namespace coplane
{
std::vector<Real> nodeCosts(const RankMesh& part, const PartitionCosts& costs)
{
  std::vector<Real> ofNode(part.nodes(), 0);
  for (std::size_t b = 0; b < part.blocks.size(); ++b)
  {
    const Real corner = costs.ofElement[b] / topology(part.blocks[b].type).nodes;
    for (const int node : part.blocks[b].connectivity)
      ofNode[node] += corner;
  }
  if (costs.ofFace > 0)
    for (const ExteriorFace& face : exteriorFaces(part))
      for (int k = 0; k < face.nodeCount; ++k)
        ofNode[face.nodes[k]] += costs.ofFace / face.nodeCount;
  ofNode.resize(part.ownedNodes);
  return ofNode;
}

std::pair<Real, Real> largestAndMean(Real mine, const Comm& comm)
{
  const std::vector<Real> all = comm.allGather(std::vector<Real>{mine});
  return {*std::max_element(all.begin(), all.end()),
          std::accumulate(all.begin(), all.end(), Real(0)) / comm.size()};
}

PartitionQuality qualityOf(const RankMesh& part, const std::vector<Real>& costs, const Comm& comm)
{
  PartitionQuality quality;
  const auto [largest, mean] = largestAndMean(
      costs.empty() ? part.ownedNodes : std::accumulate(costs.begin(), costs.end(), Real(0)), comm);
  if (mean > 0)
    quality.imbalance = largest / mean;
  quality.fewest = int(comm.min(std::int64_t(part.ownedNodes)));
  quality.most = int(comm.max(std::int64_t(part.ownedNodes)));
  quality.mostOfOthers = int(comm.max(std::int64_t(part.nodes() - part.ownedNodes)));

  std::int64_t cut = 0;
  for (const RankMesh::Block& block : part.blocks)
  {
    const std::size_t corners = std::size_t(topology(block.type).nodes);
    for (int e = 0; e < block.elements(); ++e)
    {
      const auto first = block.connectivity.begin() + std::ptrdiff_t(e * corners);
      cut += block.owned[e] && std::any_of(first, first + std::ptrdiff_t(corners),
                                           [&](int n) { return n >= part.ownedNodes; });
    }
  }
  quality.cutElements = comm.sum(cut);
  return quality;
}
} // namespace coplane
