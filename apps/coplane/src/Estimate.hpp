#pragma once

#include <coplane_dynamics/Solver.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>

namespace coplane
{
/// Tries a few cycles and logs what the whole run will take by them: cycles, time, memory, results.
/// The solver is some cycles further afterwards; nothing is written. Throws as a run does when it
/// fails within these cycles. Collective.
void reportEstimate(Solver& solver, const MeshSlice& mesh, const Deck& deck);
} // namespace coplane
