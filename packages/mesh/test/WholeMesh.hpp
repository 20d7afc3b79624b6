#pragma once

#include <coplane_mesh/Distribute.hpp>
#include <coplane_partition/Partition.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace coplane
{
inline MeshSlice sliceOf(const Mesh& mesh, const Comm& comm)
{
  return sliceOf(mesh, comm.rank(), comm.size());
}

/// Owners of all nodes, on every rank. Collective.
inline std::vector<int> nodeOwners(const Mesh& mesh, const Comm& comm, const std::string& method,
                                   const std::vector<Real>& costs = {})
{
  const MeshSlice slice = sliceOf(mesh, comm);
  const auto first = costs.begin() + (costs.empty() ? 0 : slice.nodeRange().first);
  const auto end = costs.empty() ? first : first + slice.nodeRange().count;
  return comm.allGather(
      nodeOwners(partAtHome(slice, comm), comm, method, std::vector<Real>(first, end)));
}

/// What any rank of any number has to get, cut out of a whole mesh in one process by the rules'
/// words: what distribute() is compared with, and a way to make parts without other ranks.
inline RankMesh distribute(const Mesh& mesh, const std::vector<int>& owners, int rank)
{
  RankMesh part;
  part.dimension = mesh.dimension;

  // Owned nodes first, in the order of the file.
  std::vector<int> localNode(mesh.nodes(), -1);
  const auto addNode = [&](int node)
  {
    localNode[node] = part.nodes();
    part.nodeIds.push_back(mesh.nodeIds[node]);
    part.nodePositions.push_back(node);
    part.coordinates.push_back(mesh.coordinates[node]);
  };
  for (int n = 0; n < mesh.nodes(); ++n)
    if (owners[n] == rank)
      addNode(n);
  part.ownedNodes = part.nodes();

  std::vector<std::pair<int, int>>
      localElement; // of each element of the file: block and position here
  localElement.assign(mesh.elements(), {-1, -1});
  int index = 0;
  for (int b = 0; b < int(mesh.blocks.size()); ++b)
  {
    const Mesh::Block& block = mesh.blocks[b];
    RankMesh::Block mine;
    mine.meshBlock = b;
    mine.id = block.id;
    mine.type = block.type;
    const int nodes = topology(block.type).nodes;
    for (int e = 0; e < block.elements(); ++e, ++index)
    {
      const int* corners = &block.connectivity[e * nodes];
      if (std::none_of(corners, corners + nodes, [&](int n) { return owners[n] == rank; }))
        continue;
      const int lowest =
          *std::min_element(corners, corners + nodes,
                            [&](int a, int c) { return mesh.nodeIds[a] < mesh.nodeIds[c]; });
      localElement[index] = {b, mine.elements()};
      mine.elementIds.push_back(block.elementIds[e]);
      mine.positions.push_back(e);
      mine.bodyIds.push_back(block.bodyIds.empty() ? 0 : block.bodyIds[e]);
      mine.owned.push_back(owners[lowest] == rank);
      for (int k = 0; k < nodes; ++k)
      {
        if (localNode[corners[k]] < 0)
          addNode(corners[k]);
        mine.connectivity.push_back(localNode[corners[k]]);
      }
    }
    part.blocks.push_back(std::move(mine));
  }

  for (int n = part.ownedNodes; n < part.nodes(); ++n)
    part.ownersOfOthers.push_back(owners[part.nodePositions[n]]);

  for (const Mesh::NodeSet& set : mesh.nodeSets)
  {
    std::vector<int> nodes;
    for (const int n : set.nodes)
      if (owners[n] == rank)
        nodes.push_back(localNode[n]);
    part.nodeSets.push_back(std::move(nodes));
  }
  for (const Mesh::SideSet& set : mesh.sideSets)
  {
    std::vector<RankMesh::Side> sides;
    for (std::size_t i = 0; i < set.elements.size(); ++i)
    {
      const auto [block, element] = localElement[set.elements[i]];
      if (block >= 0)
        sides.push_back({block, element, set.sides[i], int(i)});
    }
    part.sideSets.push_back(std::move(sides));
  }
  return part;
}
} // namespace coplane
