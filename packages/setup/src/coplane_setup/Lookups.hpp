#pragma once

#include <coplane_input/Deck.hpp>
#include <coplane_mesh/Mesh.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// Place of the set or block with a name; -1 when there is none.
template <class Sets>
int indexOf(const Sets& sets, const std::string& name)
{
  for (int i = 0; i < int(sets.size()); ++i)
    if (sets[i].name == name)
      return i;
  return -1;
}

/// The card with a name. Names have been checked before.
template <class Card>
const Card& cardNamed(const std::vector<Card>& cards, const std::string& name)
{
  return cards[std::size_t(indexOf(cards, name))];
}

/// What the deck says of a block of the mesh, and of its material.
inline const BlockCard& cardOf(const Deck& deck, const Mesh::Block& block)
{
  return cardNamed(deck.blocks, block.name);
}
inline const MaterialCard& materialCardOf(const Deck& deck, const BlockCard& block)
{
  return cardNamed(deck.materials, block.material);
}
} // namespace coplane
