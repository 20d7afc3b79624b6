#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Model.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/Mesh.hpp>

namespace coplane
{
/// Fills the table of rules and the groups of faces. Side sets that contact.pairs names split the
/// faces of a block into groups; all ranks find the same ones. Collective.
/// @param mesh names of blocks and sets
/// @param model with this rank's part of the mesh
void addContactRules(const Deck& deck, const Mesh& mesh, const Comm& comm, Model& model);
} // namespace coplane
