#pragma once

#include <string>

namespace coplane
{
/// Every key of a deck with what it accepts, its default and its meaning, for --help-deck; those of
/// one topic (see topicText) unless it is empty.
std::string deckReferenceText(const std::string& topic);

/// The same as tables of Markdown, for the user's manual.
std::string deckReferenceMarkdown();

/// The same as a JSON Schema.
std::string deckJsonSchema();
} // namespace coplane
