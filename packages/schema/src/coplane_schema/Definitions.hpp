#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_schema/DeckNode.hpp>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace coplane
{
/// The names of `define` and their numbers, and which of them a file uses.
class Definitions
{
public:
  /// Reads `define`: names with numbers or with expressions of names before them.
  void read(const DeckNode& node, Problems& problems);

  std::vector<std::string> names() const;
  /// Whether an expression has one of the names, which then count as used.
  bool appearIn(const std::string& expression);
  /// Whether an expression has a name whose number is not known, for a reason told already.
  bool areUnknownIn(const std::string& expression) const;
  /// The value of an expression of these names alone; otherwise `problem` says what is wrong.
  std::optional<Real> value(const std::string& expression, std::string& problem) const;
  /// The expression with numbers in place of the names.
  std::string insertedInto(const std::string& expression) const;
  /// " (did you mean 'x'?)" for a word of the expression that is like one of the names; or empty.
  std::string suggestionFor(const std::string& expression) const;
  /// Names that nothing uses.
  void demandUse(Problems& problems) const;

private:
  void readOne(const DeckNode& name, const DeckNode& value, const DeckNode& all,
               Problems& problems);

  struct Definition
  {
    Real value = 0;
    DeckNode name;
    bool used = false;
    bool isKnown = true; ///< its number; else a message has said why not
  };
  std::map<std::string, Definition> definitions_;
};

/// The number written in a text; nothing when it is not one, infinity when it is too large.
std::optional<Real> numberIn(const std::string& text);
} // namespace coplane
