#pragma once

#include <coplane_dynamics/Solver.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>

namespace coplane
{
/// Warns of loads that do nothing until the end of the run, most often for a slip of units:
/// conditions that begin after it, blast waves that arrive after it or have passed at its start,
/// explosives that no front reaches or that are rigid, lighting points far from their explosive;
/// and of elements that erosion takes out in the first cycle. Blasts, explosives and elements that
/// stages bring are not looked at. For the start of a run, not for a restart. Collective.
/// @param decks of all stages
/// @param solver at the start
void warnOfIdleLoads(const std::vector<Deck>& decks, const MeshSlice& mesh, const Solver& solver,
                     const Comm& comm);
} // namespace coplane
