#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <vector>

namespace coplane
{
/// Parts of a mesh that share no node. For every node of a rank's part the body it belongs to,
/// named by the position in the file of the body's first node; -1 for a node of no element.
///
/// Labels travel from owners to copies of nodes until nothing changes: as many rounds as a body has
/// ranks one behind another. Collective.
/// @param blocks which blocks count, 1 or 0 each
std::vector<int> bodyLabels(const RankMesh& part, const std::vector<char>& blocks,
                            const Comm& comm);
} // namespace coplane
