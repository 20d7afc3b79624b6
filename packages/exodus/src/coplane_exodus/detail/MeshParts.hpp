#pragma once

#include <coplane_mesh/MeshSlice.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// The files of a mesh that has been split among N ranks by another program, as Exodus names them:
/// mesh.e.N.0 to mesh.e.N.(N-1), numbers filled up with zeros. Empty when there are none. Throws
/// Error(ExitCode::Mesh) when one is missing, or when there are several splits.
std::vector<std::string> partsOfMesh(const std::string& file);

/// Slices of one mesh from its parts: a node that several parts have, known by its id, becomes one.
/// Nodes, and elements within their block, stand in the order of their ids, blocks and sets in the
/// order of the parts. The result is the same for any number of ranks. Collective.
/// @param parts those that this rank has read; ranks have them in the order of their numbers
/// @param blockOrder ids of all blocks in the order of these parts
/// @param file for messages
MeshSlice mergedParts(const std::vector<Mesh>& parts, const std::vector<GlobalId>& blockOrder,
                      const std::string& file, const Comm& comm);

/// Throws on all ranks when an id of a node or an element is not positive or occurs twice.
/// Collective.
void demandUniqueIds(const std::string& file, const MeshSlice& slice, const Comm& comm);
} // namespace coplane
