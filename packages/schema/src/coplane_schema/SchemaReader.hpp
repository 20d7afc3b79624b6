#pragma once

#include <coplane_schema/DeckNode.hpp>
#include <coplane_schema/Schema.hpp>

#include <functional>
#include <string>
#include <vector>

namespace coplane
{
/// Reads YAML text by a schema into `target`, which is what the schema's keys fill. Problems are
/// collected; text that is no YAML throws Error(ExitCode::Deck). The tree is returned for checks
/// that take more than one key: with values in place of expressions of names in `define`, and
/// without `define`.
/// @param overrides "path=value", applied to the tree before it is read
/// @param prepare completes the tree before it is read, such as from a library; may be empty
DeckNode readBySchema(const Key& schema, const std::string& text, const std::string& file,
                      const std::vector<std::string>& overrides, void* target, Problems& problems,
                      const std::function<void(DeckNode&)>& prepare = {},
                      const FileKind& kind = {});
} // namespace coplane
