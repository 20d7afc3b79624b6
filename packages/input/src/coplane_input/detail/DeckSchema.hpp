#pragma once

#include <coplane_schema/Schema.hpp>

namespace coplane
{
/// The whole deck: a Group whose target is a Deck.
const Key& deckSchema();
} // namespace coplane
