#include <coplane_core/Error.hpp>
#include <coplane_dynamics/ErosionRule.hpp>

#include <cmath>

namespace coplane
{
std::vector<std::string> ErosionCriteria::variableNames() const
{
  std::vector<std::string> names;
  if (damage)
    names.push_back("damage");
  for (const Limit& limit : variables)
    names.push_back(limit.variable);
  return names;
}

ErosionRule::ErosionRule(const ErosionCriteria& criteria, const ElementBlock& block)
    : criteria_(criteria)
{
  const auto rowOf = [&](const std::string& variable)
  {
    const int row = block.historyRow(variable);
    if (row < 0)
      fail(ExitCode::Internal, "erosion: the law has no variable '{}'", variable);
    return row;
  };
  if (criteria.damage)
    damageRow_ = rowOf("damage");
  for (const ErosionCriteria::Limit& limit : criteria.variables)
    rows_.push_back(rowOf(limit.variable));
}

bool ErosionRule::exceedsLimit(const ElementBlock& block, int e) const
{
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    const Real value = block.history(rows_[i], e);
    if (!(value <= criteria_.variables[i].above && value >= criteria_.variables[i].below))
      return true;
  }
  if (criteria_.volumeRatio)
  {
    const Real ratio = block.volume(e) / block.referenceVolume(e);
    if (!(ratio >= (*criteria_.volumeRatio)[0] && ratio <= (*criteria_.volumeRatio)[1]))
      return true;
    // With full integration a corner may have turned inside out while the volume is still positive.
    // Stresses that are no numbers have no stable step either, and are no reason to go on.
    bool finite = true;
    for (int c = 0; c < 6; ++c)
      finite = finite && std::isfinite(block.stress(c, e));
    if (finite && !(block.stableStep(e) > 0))
      return true;
  }
  return criteria_.stableStep && !(block.stableStep(e) >= *criteria_.stableStep);
}

bool ErosionRule::kills(const ElementBlock& block, int e) const
{
  if (!block.isAlive(e) || (damageRow_ >= 0 && !(block.history(damageRow_, e) > *criteria_.damage)))
    return false;
  return !criteria_.hasLimits() || exceedsLimit(block, e);
}
} // namespace coplane
