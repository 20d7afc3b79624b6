#pragma once

#include <coplane_dynamics/Solver.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>

namespace coplane
{
/// Logs masses per block, the stable step and what limits it, and the census of contact pairs; at
/// the start of a run also which bodies overlap: an error unless the deck allows it. Collective.
void reportModel(const Solver& solver, const MeshSlice& mesh, const Deck& deck);
/// Logs where the time went, the energy balance and the hash of the state. Collective.
void reportEnd(const Solver& solver);
} // namespace coplane
