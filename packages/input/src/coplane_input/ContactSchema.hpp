#pragma once

#include <coplane_schema/Schema.hpp>

namespace coplane
{
/// Keys of a card in `joints`; their target is a JointCard.
std::vector<Key> jointCardKeys();

/// The parts `joints` and `contact` of the deck's schema; their target is the Deck.
Key jointKeys();
Key contactKeys();
} // namespace coplane
