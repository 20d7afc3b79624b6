#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_mesh/MeshSlice.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <vector>

namespace coplane
{
/// This rank's part of a mesh of which every rank has a slice: the nodes it owns, every element
/// that touches one of them, and those elements' other nodes, all in the order of the file.
/// Needs memory for the slice and the part, and messages between ranks whose slices and parts meet.
/// Collective.
/// @param owners of the nodes of this rank's slice
RankMesh distribute(const MeshSlice& slice, const std::vector<int>& owners, const Comm& comm);

/// The part that a rank has when it owns the nodes of its slice: there everything about them can be
/// found without asking anybody. Collective.
RankMesh partAtHome(const MeshSlice& slice, const Comm& comm);
} // namespace coplane
