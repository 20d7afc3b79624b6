#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/Mesh.hpp>
#include <coplane_mesh/RankMesh.hpp>

namespace coplane
{
/// When the loads and prescribed motions of a deck change for the last time before its end, into
/// conditions.relaxation. Tables, windows and blast waves are known exactly; expressions are
/// evaluated at many times, those of the place also at 27 points of the box around their set. What
/// is left of a function that only tends to a value counts as no change below 1e-9 of its largest
/// one. The same bits on all ranks. Collective.
/// @param part with every node of this rank
void findLastChange(const Deck& deck, const Mesh& mesh, const RankMesh& part, const Comm& comm,
                    Conditions& conditions);
} // namespace coplane
