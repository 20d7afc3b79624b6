#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_mesh/Mesh.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// The rank that owns each node of the mesh, by a geometric method of Zoltan2: "multijagged" or
/// "rcb". Every rank gives its share of the coordinates and learns the whole answer. Meshes with
/// fewer nodes than a few per rank are dealt out in order, so that ranks without nodes are possible
/// but never an error. Collective.
std::vector<int> nodeOwners(const Mesh& mesh, const Comm& comm, const std::string& method);

/// This rank's part: the nodes it owns, every element that touches one of them, and those elements'
/// other nodes, all in the order of the file.
RankMesh distribute(const Mesh& mesh, const std::vector<int>& owners, int rank);
} // namespace coplane
