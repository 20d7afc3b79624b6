#pragma once

#include <coplane_input/DeckNode.hpp>
#include <coplane_input/Schema.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// Reads YAML text by a schema into `target`, which is what the schema's keys fill: for decks of
/// other programs. Problems are collected; text that is no YAML throws Error(ExitCode::Deck). The
/// tree is returned for checks that take more than one key.
DeckNode readBySchema(const Key& schema, const std::string& text, const std::string& file,
                      const std::vector<std::string>& overrides, void* target, Problems& problems);
} // namespace coplane
