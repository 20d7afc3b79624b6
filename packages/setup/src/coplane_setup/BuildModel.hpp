#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Model.hpp>
#include <coplane_dynamics/Stage.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>

namespace coplane
{
/// Joins the deck to this rank's part of the mesh. Names have been checked before. Collective.
Model buildModel(const Deck& deck, const MeshSlice& mesh, RankMesh part, const Comm& comm);

/// A stage of a run, for this rank's part of the mesh. Collective.
/// @param deck as it is in that stage; index: of the stage, the first is 0
Stage stageOf(const Deck& deck, int index, const MeshSlice& mesh, RankMesh part, const Comm& comm);
} // namespace coplane
