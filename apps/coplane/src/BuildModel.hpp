#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Model.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>

namespace coplane
{
/// What blocks ask of their material's law that it does not have, or that it is not in two
/// dimensions.
std::vector<std::string> problemsOfLaws(const Deck& deck, int dimension);

/// What a deck asks of rigid blocks that they cannot do. Names have been checked before.
std::vector<std::string> problemsOfRigidBlocks(const Deck& deck, const MeshSlice& mesh,
                                               const Comm& comm);

/// Warns of conditions that prescribe one component of one node differently: the later one acts.
/// Collective.
/// @param part with every node of this rank
void warnOfDoubleConditions(const Deck& deck, const Mesh& mesh, const RankMesh& part,
                            const Comm& comm);

/// Joins the deck to this rank's part of the mesh. Names have been checked before.
Model buildModel(const Deck& deck, const MeshSlice& mesh, RankMesh part, const Comm& comm);
} // namespace coplane
