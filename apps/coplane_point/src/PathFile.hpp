#pragma once

#include "PointDeck.hpp"

#include <coplane_schema/DeckNode.hpp>

namespace coplane
{
/// Reads times, gaps and slips of a path from a CSV file. All that is wrong becomes problems: of
/// the file with its line and column, after those of the deck.
/// @param key where the deck names the file
void readPathFile(const std::string& file, JointPathCard& card, const DeckNode& key,
                  Problems& problems);
} // namespace coplane
