#pragma once

#include <functional>
#include <string>
#include <vector>

namespace coplane
{
/// A text about the keys of recipes that the program prints.
struct Reference
{
  std::string option; ///< with which it is asked for
  std::string meaning;
  std::function<std::string(const std::string& topic)> text;
  bool hasTopics = false; ///< a topic may be named; empty: everything
};

/// For recipes of meshes and of joints and for examples: plain text, Markdown, JSON Schema.
const std::vector<Reference>& recipeReferences();
} // namespace coplane
