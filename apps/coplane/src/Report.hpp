#pragma once

#include <coplane_dynamics/Solver.hpp>
#include <coplane_mesh/MeshSlice.hpp>

namespace coplane
{
/// Logs masses per block, the stable step and what limits it, and the census of contact pairs.
/// Collective.
void reportModel(const Solver& solver, const MeshSlice& mesh);
/// Logs where the time went, the energy balance and the hash of the state. Collective.
void reportEnd(const Solver& solver);
} // namespace coplane
