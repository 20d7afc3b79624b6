#pragma once

#include <coplane_core/Suggestion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace coplane
{
using Names = std::vector<std::string>;

inline bool contains(const Names& names, const std::string& name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

template <class Card>
Names namesOf(const std::vector<Card>& cards)
{
  Names names;
  for (const auto& card : cards)
    names.push_back(card.name);
  return names;
}

/// "path = 'x' is not a material of this deck. Did you mean 'y'? It has: a, b."
inline std::string unknown(const std::string& path, const std::string& name,
                           const std::string& what, const Names& names)
{
  return fmt::format("{} = '{}' is not {}.{} There {}.", path, shortened(name), what,
                     didYouMean(name, names), names.empty() ? "are none" : "is: " + listOf(names));
}
} // namespace coplane
