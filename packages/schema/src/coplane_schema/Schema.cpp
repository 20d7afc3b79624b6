#include "Schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
bool Key::appliesTo(const std::string& model) const
{
  return models.empty() || std::find(models.begin(), models.end(), model) != models.end();
}

void fitToDimension(Key& key, int dimension)
{
  if (key.byDimension)
  {
    (key.kind == KeyKind::Points ? key.itemLength : key.length) = std::size_t(dimension);
    key.example.clear(); // which is that of either dimension
  }
  key.byDimension = false;
  if (key.dimension && key.dimension != dimension)
    key.noPlace = fmt::format("is for {} dimensions only", key.dimension == 2 ? "two" : "three");
  for (Key& one : key.keys)
    fitToDimension(one, dimension);
}

namespace
{
void addNumbers(Real value, std::vector<Real>& numbers)
{
  numbers.push_back(value);
}

void addNumbers(const TimeFunction& function, std::vector<Real>& numbers)
{
  numbers.push_back(function.constant);
  numbers.insert(numbers.end(), function.values.begin(), function.values.end());
}

/// The numbers that are written in a value.
std::vector<Real> numbersIn(const KeyValue& value)
{
  std::vector<Real> numbers;
  if (const auto* one = std::get_if<Real>(&value))
    addNumbers(*one, numbers);
  else if (const auto* list = std::get_if<std::vector<Real>>(&value))
    numbers = *list;
  else if (const auto* functions = std::get_if<std::vector<TimeFunction>>(&value))
    for (const TimeFunction& function : *functions)
      addNumbers(function, numbers);
  return numbers;
}
} // namespace

std::string oddityOf(const Key& key, const KeyValue& value)
{
  const UsualRange& usual = key.usual;
  for (const Real number : numbersIn(value))
    if (const Real size = std::abs(number);
        size > 0 && (size < usual.least || size > usual.largest))
      return fmt::format("{:g}{} is {}. {}", number, key.unit == "-" ? "" : " " + key.unit,
                         size < usual.least
                             ? fmt::format("unusually small; usual: from {:g} on", usual.least)
                             : fmt::format("unusually large; usual: up to {:g}", usual.largest),
                         usual.slip);
  return "";
}

namespace
{
std::string rangeOf(const Key& key)
{
  std::string range;
  if (key.lower)
    range += fmt::format(" {} {}", key.lowerOpen ? ">" : ">=", *key.lower);
  if (key.upper)
    range +=
        fmt::format("{} {} {}", key.lower ? " and" : "", key.upperOpen ? "<" : "<=", *key.upper);
  return range;
}

std::string unitOf(const Key& key)
{
  return key.unit.empty() ? "" : fmt::format(" [{}]", key.unit);
}

/// "3 ", or nothing where any number of items is accepted.
std::string countOf(const Key& key, std::size_t length)
{
  return length ? fmt::format("{} ", length) : key.byDimension ? "2 or 3 " : "";
}

/// What is accepted for a key that takes a list of values.
std::string acceptedList(const Key& key)
{
  const std::string words = fmt::format("{}", fmt::join(key.choices, ", "));
  const std::string unit = unitOf(key);
  const std::string count = key.kind == KeyKind::Points
                                ? (key.length ? fmt::format("{} ", key.length) : "")
                                : countOf(key, key.length);
  const std::string many = key.leastLength ? fmt::format("at least {} ", key.leastLength) : count;
  const std::string alone = key.aloneToo ? " or one alone" : "";
  switch (key.kind)
  {
  case KeyKind::Numbers:
    return fmt::format("a list of {}numbers{}{}{}{}", many, rangeOf(key),
                       key.notAllZero ? ", not all zero" : "", unit, alone);
  case KeyKind::Integers:
    return fmt::format("a list of {}whole numbers{}{}", many, rangeOf(key), unit);
  case KeyKind::Points:
    return fmt::format("a list of {}points, each a list of {}numbers{}", many,
                       countOf(key, key.itemLength), unit);
  case KeyKind::Texts:
    return fmt::format("a list of {}names{}{}", count, words.empty() ? "" : " out of " + words,
                       alone);
  case KeyKind::TextLists:
    return fmt::format("{}{}a list of lists of {}names", fmt::join(key.choices, " or "),
                       words.empty() ? "" : " or ", countOf(key, key.itemLength));
  case KeyKind::TimeFunctions:
    return fmt::format("a list of {}numbers, expressions of t{} or tables{}", count,
                       key.ofPlaceToo ? ", x, y, z" : "", unit);
  default:
    return fmt::format("a list of {}numbers or expressions of x, y, z{}", count, unit);
  }
}
} // namespace

std::string acceptedText(const Key& key)
{
  switch (key.kind)
  {
  case KeyKind::Text:
    return key.choices.empty() ? "text" : fmt::format("one of {}", fmt::join(key.choices, ", "));
  case KeyKind::Number:
    return "a number" + rangeOf(key) + unitOf(key);
  case KeyKind::Integer:
    return "a whole number" + rangeOf(key) + unitOf(key) +
           (key.choices.empty() ? "" : fmt::format(" or {}", fmt::join(key.choices, " or ")));
  case KeyKind::Flag:
    return "true or false";
  case KeyKind::TimeFunction:
    return "a number" + rangeOf(key) + ", an expression of t" +
           (key.ofPlaceToo ? ", x, y, z" : "") + " or a table" + unitOf(key);
  case KeyKind::Definitions:
    return "names, each with a number or an expression of names before it";
  case KeyKind::Changes:
    return "paths of keys, each with a value";
  case KeyKind::Group:
    for (const Key& one : key.keys)
      if (one.required && !one.example.empty())
        return fmt::format("keys with values, such as {{{}: {}}}", one.name, one.example);
    return "keys with values";
  case KeyKind::NamedGroups:
    return "names, each with keys and values";
  case KeyKind::GroupList:
    return "a list of items with keys and values" +
           std::string(key.aloneToo ? ", or one item alone" : "");
  default:
    return acceptedList(key);
  }
}
} // namespace coplane
