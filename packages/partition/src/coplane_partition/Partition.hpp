#pragma once

#include <coplane_core/Comm.hpp>
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

/// Cost of every node that a part owns: a corner's part of each element and each exterior face
/// there.
std::vector<Real> nodeCosts(const RankMesh& part, const PartitionCosts& costs);

/// The rank that shall own each node that this rank's part owns now, by a method of Zoltan2:
/// "multijagged", "rcb", "rib" or "hsfc" on the positions of the nodes, or "hypergraph" on who
/// shares elements with whom. Meshes with fewer nodes than a few per rank are dealt out in order,
/// so that ranks without nodes are possible but never an error; in larger ones every rank's part
/// must own a node. Collective.
/// @param costs of the owned nodes; empty: all the same
/// @param places of the owned nodes [m]; null: those of the mesh
std::vector<int> nodeOwners(const RankMesh& part, const Comm& comm, const std::string& method,
                            const std::vector<Real>& costs = {},
                            const std::vector<Vec3>* places = nullptr);

/// How good a partition is.
struct PartitionQuality
{
  Real imbalance = 1;           ///< largest cost of a rank over the mean
  std::int64_t cutElements = 0; ///< elements that several ranks compute
  int fewest = 0, most = 0;     ///< nodes that a rank owns
  int mostOfOthers = 0;         ///< nodes of others that a rank needs for its elements
};
/// Of a partition of which every rank has its part. Collective.
/// @param costs of the owned nodes; empty: all the same
PartitionQuality qualityOf(const RankMesh& part, const std::vector<Real>& costs, const Comm& comm);

/// Largest over ranks and mean of a cost that every rank has. Collective.
std::pair<Real, Real> largestAndMean(Real mine, const Comm& comm);
} // namespace coplane
