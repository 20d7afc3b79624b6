#pragma once

#include <coplane_element/ElementBlock.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace coplane
{
/// When an element of a block dies: as soon as its damage, if that is asked for, is above a value,
/// and one of the limits, if there are any, is exceeded.
struct ErosionCriteria
{
  /// A variable of the law, by its name.
  struct Limit
  {
    std::string variable;
    Real above = infinity, below = -infinity; ///< exceeded above the one or below the other
  };
  std::optional<Real> damage; ///< of the law's variable `damage` [-]
  std::vector<Limit> variables;
  /// Exceeded outside: volume over the first one; and when some part has turned inside out.
  std::optional<std::array<Real, 2>> volumeRatio;
  std::optional<Real> stableStep; ///< exceeded below [s]

  bool hasLimits() const { return !variables.empty() || volumeRatio || stableStep; }
  bool any() const { return damage || hasLimits(); }
  /// Names of the law's variables that are asked for.
  std::vector<std::string> variableNames() const;
};

/// The criteria of one block with the places of its law's variables.
class ErosionRule
{
public:
  ErosionRule(const ErosionCriteria& criteria, const ElementBlock& block);
  /// Whether a living element dies. A value that is not a number exceeds its limit.
  bool kills(const ElementBlock& block, int element) const;

private:
  bool exceedsLimit(const ElementBlock& block, int element) const;

  ErosionCriteria criteria_;
  int damageRow_ = -1;
  std::vector<int> rows_;
};
} // namespace coplane
