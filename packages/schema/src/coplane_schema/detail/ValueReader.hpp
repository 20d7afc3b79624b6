#pragma once

#include <coplane_schema/DeckNode.hpp>
#include <coplane_schema/Definitions.hpp>
#include <coplane_schema/Schema.hpp>

#include <optional>
#include <string>

namespace coplane
{
/// "a.b", or "b" at the top; for messages, so that names are not longer than messages may be.
std::string join(const std::string& path, const std::string& name);

/// What stands in a node, for messages.
std::string foundText(const DeckNode& node);

/// What the values of a file are read with.
struct Reading
{
  const FileKind& file;
  Problems& problems;
  Definitions definitions;

  /// "path = what is found, what is wrong; accepted: ...".
  void wrong(const DeckNode& node, const std::string& path, const std::string& what,
             const std::string& accepted);
  /// Keys must be words, given once; merges are refused because yaml-cpp would ignore them.
  void checkNames(const DeckNode& map, const std::string& path);
};

/// The value of a key that is no group; nothing when it is wrong, which is among the problems then.
/// An expression of names in `define` has its value in the tree afterwards.
std::optional<KeyValue> readValue(Reading& reading, const Key& key, DeckNode& node,
                                  const std::string& path);
} // namespace coplane
