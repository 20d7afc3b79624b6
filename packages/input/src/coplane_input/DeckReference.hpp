#pragma once

#include <coplane_input/Schema.hpp>

#include <string>

namespace coplane
{
/// Every key with what it accepts, its default and its meaning, for --help-deck.
std::string deckReferenceText();

/// The same as tables of Markdown, for the user's manual.
std::string deckReferenceMarkdown();

/// The same for a deck of another program, without an introduction.
std::string referenceText(const Key& schema);
std::string referenceMarkdown(const Key& schema);

/// Reference of decks as a JSON Schema (draft 7), with which editors complete and check decks while
/// they are written. What one key demands of another (names that must exist, limits between values)
/// is checked by the program only.
std::string deckJsonSchema();
} // namespace coplane
