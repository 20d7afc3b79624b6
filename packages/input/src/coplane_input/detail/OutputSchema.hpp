#pragma once

#include <coplane_schema/Schema.hpp>

namespace coplane
{
/// The parts `output`, `history`, `checkpoint` and `partition` of the deck's schema; their target
/// is the Deck.
Key outputKeys();
Key historyKeys();
Key checkpointKeys();
Key partitionKeys();
} // namespace coplane
