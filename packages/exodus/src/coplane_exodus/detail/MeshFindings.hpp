#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_exodus/MeshReport.hpp>
#include <coplane_exodus/detail/FindingsOverRanks.hpp>

#include <array>
#include <vector>

namespace coplane
{
std::array<Vec3, 8> cornersOf(const RankMesh& mesh, const RankMesh::Block& block, int element);

/// The same bits for the same corners in any order.
Vec3 centreOf(const std::array<Vec3, 8>& corners, int count);

/// Elements whose centres lie in one cell of a grid: written twice, or of bodies on each other.
/// Collective.
Findings<MeshReport::ElementPair> findTwice(const MeshSlice& slice, const RankMesh& home,
                                            const Boxes& boxes, Real tolerance, const Comm& comm);

/// Faces that more than two elements have: there is no inside and outside there. Collective.
Findings<MeshReport::SharedFace> findOverused(const MeshSlice& slice, const RankMesh& home,
                                              const Comm& comm);

/// Nodes of one body in one cell of a grid of two millionths of the shortest edge. Cells are
/// centred on multiples, so that round coordinates with round-off stay in one cell. The two sides
/// of a joint that ends inside a body are meant: their nodes are no finding. Collective.
/// @param bodies of the owned nodes; negative: of no element
Findings<MeshReport::NodePair> findCoincident(const RankMesh& home,
                                              const std::vector<std::int64_t>& bodies,
                                              const std::vector<char>& onJoint, const Boxes& boxes,
                                              Real tolerance, const Comm& comm);
} // namespace coplane
