#pragma once

#include <coplane_input/Deck.hpp>
#include <coplane_schema/DeckNode.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// Checks that take more than one key: names that must exist in the deck, values that must fit each
/// other.
void checkDeck(const Deck& deck, const DeckNode& root, Problems& problems);

/// Blocks that a stage adds before any removes them.
std::vector<std::string> absentAtStart(const Deck& deck);

/// What keeps a deck from forces that come from a potential: the key and its value, or nothing.
std::string commonNormalBecauseOf(const Deck& deck);
} // namespace coplane
