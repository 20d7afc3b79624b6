#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>

#include <string>
#include <vector>

namespace coplane
{
// What is wrong with a deck once the mesh and the laws are known, a line for each problem.

/// What blocks ask of their material's law that it does not have, or that it is not in two
/// dimensions.
std::vector<std::string> problemsOfLaws(const Deck& deck, int dimension);

/// What a deck asks of rigid blocks that they cannot do. Names have been checked before. The same
/// on all ranks. Collective.
std::vector<std::string> problemsOfRigidBlocks(const Deck& deck, const MeshSlice& mesh,
                                               const Comm& comm);
} // namespace coplane
