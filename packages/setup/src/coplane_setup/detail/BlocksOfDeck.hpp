#pragma once

#include <coplane_dynamics/Model.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/Mesh.hpp>

namespace coplane
{
/// When elements of a block die.
ErosionCriteria erosionOf(const ErosionCard& card);

/// What a block of the mesh is made of, and how it starts. Names have been checked before; fails on
/// all ranks when the block's elements have no such form.
BlockSetup setupOf(const Deck& deck, const Mesh::Block& block);
} // namespace coplane
