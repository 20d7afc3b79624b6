#pragma once

#include <coplane_input/Schema.hpp>

namespace coplane
{
/// The parts `joints` and `contact` of the deck's schema; their target is the Deck.
Key jointKeys();
Key contactKeys();
} // namespace coplane
