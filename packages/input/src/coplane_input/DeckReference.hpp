#pragma once

#include <string>

namespace coplane
{
/// Every key with what it accepts, its default and its meaning, for --help-deck.
std::string deckReferenceText();

/// The same as tables of Markdown, for the user's manual.
std::string deckReferenceMarkdown();

/// The same as a JSON Schema (draft 7), with which editors complete and check decks while they are
/// written. What one key demands of another (names that must exist, limits between values) is
/// checked by the program only.
std::string deckJsonSchema();
} // namespace coplane
