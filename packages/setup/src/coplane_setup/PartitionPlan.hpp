#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Rebalancer.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>
#include <coplane_mesh/RankMesh.hpp>

namespace coplane
{
/// This rank's part of the mesh, by the method and the costs of the deck; logs how even it is.
/// Collective.
RankMesh partOf(const MeshSlice& mesh, RankMesh home, const Deck& deck, const Comm& comm);

/// Rebalancing as the deck has it. @param secondsToBuild what the solver took at the start
RebalanceOptions rebalanceOptionsOf(const Deck& deck, double secondsToBuild);
} // namespace coplane
