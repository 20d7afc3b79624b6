#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_mesh/Mesh.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// What a cycle costs, in any unit: shares of ranks are made equal in it.
struct PartitionCosts
{
  std::vector<Real> ofElement; ///< of one element of each block of the mesh
  Real ofFace = 0;             ///< of one exterior face, for contact
};

/// Cost of every node: a corner's part of each element and each exterior face there.
std::vector<Real> nodeCosts(const Mesh& mesh, const PartitionCosts& costs);

/// The rank that owns each node of the mesh, by a method of Zoltan2: "multijagged", "rcb", "rib" or
/// "hsfc" on the positions of the nodes, or "hypergraph" on who shares elements with whom. Every
/// rank gives its share of the nodes and learns the whole answer. Meshes with fewer nodes than a
/// few per rank are dealt out in order, so that ranks without nodes are possible but never an
/// error. Collective.
/// @param costs of the nodes; empty: all the same
/// @param places of the nodes [m]; null: those of the mesh
std::vector<int> nodeOwners(const Mesh& mesh, const Comm& comm, const std::string& method,
                            const std::vector<Real>& costs = {},
                            const std::vector<Vec3>* places = nullptr);

/// How good a partition is.
struct PartitionQuality
{
  Real imbalance = 1;         ///< largest cost of a rank over the mean
  int cutElements = 0;        ///< elements that several ranks compute
  std::vector<int> owned;     ///< nodes of each rank
  std::vector<int> neighbors; ///< nodes of others that each rank needs for its elements
};
PartitionQuality qualityOf(const Mesh& mesh, const std::vector<int>& owners, int ranks,
                           const std::vector<Real>& costs);

/// This rank's part: the nodes it owns, every element that touches one of them, and those elements'
/// other nodes, all in the order of the file.
RankMesh distribute(const Mesh& mesh, const std::vector<int>& owners, int rank);
} // namespace coplane
