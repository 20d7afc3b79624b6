#pragma once

#include <coplane_dynamics/Solver.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>

namespace coplane
{
/// Warns of blocks with elements that are too large for the fracture energy of their material. The
/// run goes on: such elements break by themselves, with more energy than they should take.
/// Collective.
void reportSoftening(const Deck& deck, const MeshSlice& mesh, const Solver& solver,
                     const Comm& comm);

/// Tells what the Maxwell elements of blocks give, and warns where that is far from what is asked.
void reportDamping(const Deck& deck);
} // namespace coplane
