#include "detail/ValueHints.hpp"

#include "Definitions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <regex>

namespace coplane
{
namespace
{
constexpr std::size_t longest = 40; // letters; longer text is no slip

std::string written(Real value)
{
  return fmt::format("{:.12g}", value);
}

/// "GPa" of Pa: 1e9; nothing when it is not the unit, with or without a prefix.
std::optional<Real> factorOf(const std::string& suffix, const std::string& unit)
{
  static const std::map<std::string, Real> prefixes{
      {"", 1}, {"k", 1e3}, {"M", 1e6}, {"G", 1e9}, {"m", 1e-3}, {"u", 1e-6}, {"n", 1e-9}};
  if (unit.empty() || suffix.size() < unit.size() ||
      suffix.compare(suffix.size() - unit.size(), unit.size(), unit) != 0)
    return std::nullopt;
  const auto prefix = prefixes.find(suffix.substr(0, suffix.size() - unit.size()));
  return prefix == prefixes.end() ? std::nullopt : std::optional(prefix->second);
}

/// Of a number with something behind it.
std::string hintOfSuffix(Real number, const std::string& suffix, const std::string& unit)
{
  if (suffix == "%")
    return fmt::format(": write {}", written(number / 100));
  if (const auto factor = factorOf(suffix, unit))
    return fmt::format(": values have no units, write {}", written(number * *factor));
  return unit.empty() || unit == "-"
             ? ": values have no units, write the number alone"
             : fmt::format(": values have no units, write the number in {} alone", unit);
}

std::string without(std::string text, const char* signs)
{
  const std::string all(signs);
  text.erase(std::remove_if(text.begin(), text.end(),
                            [&](char c) { return all.find(c) != std::string::npos; }),
             text.end());
  return text;
}
} // namespace

std::string hintOfNumber(const std::string& text, const std::string& unit)
{
  static const std::regex number("([+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?) *([^-0-9. +*/^()].*)"),
      comma("[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]+)?"), fortran("[+-]?[0-9.]+[dD][+-]?[0-9]+"),
      apart("[+-]?[0-9]{1,3}(?:[_' ][0-9]{3})+(?:[.][0-9]*)?");
  if (text.size() > longest)
    return "";
  std::string problem;
  if (std::smatch parts; std::regex_match(text, comma))
    return fmt::format(": numbers have a decimal point, write {}",
                       std::string(text).replace(text.find(','), 1, "."));
  else if (std::regex_match(text, fortran))
    return fmt::format(": write {}", std::string(text).replace(text.find_first_of("dD"), 1, "e"));
  else if (std::regex_match(text, apart))
    return fmt::format(": write {}", without(text, "_' "));
  else if (const auto value = Definitions().value(text, problem); value && std::isfinite(*value))
    return fmt::format(": write {}", written(*value));
  else if (std::regex_match(text, parts, number))
    if (const auto value = numberIn(parts[1]))
      return hintOfSuffix(*value, parts[2], unit);
  return "";
}

std::string hintOfExpression(const std::string& text)
{
  static const std::regex pi("(^|[^A-Za-z_0-9])pi([^A-Za-z_0-9]|$)", std::regex::icase),
      time("(^|[^A-Za-z_0-9])(time|T)([^A-Za-z_0-9]|$)");
  if (text.size() > longest * 5)
    return "";
  if (std::regex_search(text, pi))
    return " (the number pi is called _pi)";
  if (text.find("**") != std::string::npos)
    return " (powers are written with ^)";
  if (std::regex_search(text, time))
    return " (the time is called t)";
  return "";
}
} // namespace coplane
