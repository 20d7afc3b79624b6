#include "Schema.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace coplane
{
bool Key::appliesTo(const std::string& model) const
{
  return models.empty() || std::find(models.begin(), models.end(), model) != models.end();
}

std::string acceptedText(const Key& key)
{
  std::string range;
  if (key.lower)
    range += fmt::format(" {} {}", key.lowerOpen ? ">" : ">=", *key.lower);
  if (key.upper)
    range +=
        fmt::format("{} {} {}", key.lower ? " and" : "", key.upperOpen ? "<" : "<=", *key.upper);
  const std::string unit = key.unit.empty() ? "" : fmt::format(" [{}]", key.unit);
  const std::string words = fmt::format("{}", fmt::join(key.choices, ", "));
  const std::string count = key.length ? fmt::format("{} ", key.length) : "";
  switch (key.kind)
  {
  case KeyKind::Text:
    return key.choices.empty() ? "text" : "one of " + words;
  case KeyKind::Number:
    return "a number" + range + unit;
  case KeyKind::Integer:
    return "a whole number" + range + unit +
           (words.empty() ? "" : fmt::format(" or {}", fmt::join(key.choices, " or ")));
  case KeyKind::Flag:
    return "true or false";
  case KeyKind::Numbers:
    return fmt::format("a list of {}numbers{}{}{}", count, range,
                       key.notAllZero ? ", not all zero" : "", unit);
  case KeyKind::Texts:
    return fmt::format("a list of {}names{}", count, words.empty() ? "" : " out of " + words);
  case KeyKind::TimeFunction:
    return "a number" + range + ", an expression of t" + (key.ofPlaceToo ? ", x, y, z" : "") +
           " or a table" + unit;
  case KeyKind::TimeFunctions:
    return fmt::format("a list of {}numbers, expressions of t{} or tables{}", count,
                       key.ofPlaceToo ? ", x, y, z" : "", unit);
  case KeyKind::PlaceFunctions:
    return fmt::format("a list of {}numbers or expressions of x, y, z{}", count, unit);
  case KeyKind::Group:
    return "keys with values";
  case KeyKind::NamedGroups:
    return "names, each with keys and values";
  case KeyKind::GroupList:
    return "a list of items with keys and values";
  }
  return "";
}
} // namespace coplane
