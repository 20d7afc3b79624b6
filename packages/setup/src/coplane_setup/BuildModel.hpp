#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Model.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>

namespace coplane
{
/// Joins the deck to this rank's part of the mesh. Names have been checked before. Collective.
Model buildModel(const Deck& deck, const MeshSlice& mesh, RankMesh part, const Comm& comm);
} // namespace coplane
