#pragma once

#include <coplane_mesh/MeshSlice.hpp>

#include <vector>

namespace coplane
{
/// What a rank writes into a file of its own: the elements of its slice, as a mesh.
struct OwnPart
{
  Mesh mesh;                           ///< nodes ascend in the whole mesh
  NodesFromHome nodes;                 ///< brings values of the nodes
  std::vector<std::vector<int>> sides; ///< of each side set: their positions in the whole set
};

/// The elements of a rank's slice, the nodes that they touch, and nodes of its slice that no
/// element of the mesh touches: they still need a place in the joined mesh. Node sets name a node
/// in every part that has it. Collective.
OwnPart ownPartOf(const MeshSlice& slice, const Comm& comm);
} // namespace coplane
