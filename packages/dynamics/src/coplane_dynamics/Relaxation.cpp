// Dynamic relaxation: stops at peaks of the kinetic energy, and the end of damping.
#include <coplane_core/Log.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Relaxation.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
// Without stops the ratios are looked at now and then, and have to be small several times in a row:
// the kinetic energy vanishes for a moment where a motion turns.
constexpr std::int64_t checkEvery = 20, checksInARow = 5;

Real internalEnergy(const Parts& parts)
{
  std::vector<ExactSum> sums(1);
  for (std::size_t b = 0; b < parts.blocks().size(); ++b)
    for (int e = 0; e < parts.blocks()[b].count(); ++e)
      if (parts.mesh().blocks[b].owned[e])
        sums[0].add(parts.blocks()[b].energy(e, ElementEnergy::Internal));
  return ExactSum::overRanks(sums, parts.comm)[0] +
         (parts.contact ? parts.contact->energy().stored : 0);
}

/// Sums of |force out of balance| and of |loads and reactions| [N].
std::pair<Real, Real> forcesOf(const Parts& parts)
{
  const NodalState& state = parts.state;
  std::vector<ExactSum> sums(2);
  for (int n = 0; n < parts.layout.owned(); ++n)
  {
    sums[1].add(norm(at(state.external, n)));
    if (!parts.motion.followsBody(n))
      sums[0].add(norm(at(state.force, n) + at(state.takenOff, n) + at(state.external, n)));
  }
  if (parts.comm.isRoot()) // every rank has all bodies
  {
    sums[0].add(parts.bodies().unbalancedForce());
    sums[1].add(parts.bodies().reactionForce());
  }
  const std::vector<Real> totals = ExactSum::overRanks(sums, parts.comm);
  return {totals[0], totals[1]};
}
} // namespace

RestRatios restRatios(const Parts& parts)
{
  const auto ratio = [](Real part, Real whole) { return part > 0 ? part / whole : Real(0); };
  const auto [unbalanced, given] = forcesOf(parts);
  return {ratio(parts.motion.kineticAtHalfStep(parts.state, parts.comm), internalEnergy(parts)),
          ratio(unbalanced, given)};
}

bool Relaxation::isAtRest(const Parts& parts) const
{
  if (wanted_.energyRatio > 0)
  {
    const Real internal = internalEnergy(parts);
    if (!(parts.motion.kineticAtHalfStep(parts.state, parts.comm) <=
          wanted_.energyRatio * internal))
      return false;
  }
  if (wanted_.forceRatio > 0)
  {
    const auto [unbalanced, given] = forcesOf(parts);
    if (!(unbalanced <= wanted_.forceRatio * given))
      return false;
  }
  return wanted_.looksForRest();
}

bool Relaxation::mayEnd(const Parts& parts, int stage) const
{
  if (!parts.model.time.endAtRest)
    return true;
  // A step later all forces know of a change.
  const Clock& clock = parts.clock;
  const auto& lines = parts.lines.lines();
  return Window::isReached(wanted_.lastChange, clock.time - clock.step) &&
         std::none_of(lines.begin(), lines.end(),
                      [&](const Line& line)
                      { return line.willChange(clock.time, parts.model.time.end, stage); });
}

Relaxation::Verdict Relaxation::look(const Parts& parts, int stage)
{
  const Clock& clock = parts.clock;
  if (state_.ended)
    return {};
  if (!parts.model.conditions.dampsAt(clock.time))
  {
    tellWhenTimeEndsDamping(parts);
    return {};
  }
  if (wanted_.kinetic)
  {
    TimedRegion region("coplane::dynamics::relax");
    const Real kinetic = parts.motion.kineticAtHalfStep(parts.state, parts.comm);
    const bool passed = kinetic < state_.kineticBefore;
    state_.kineticBefore = kinetic;
    return {passed, passed && mayEnd(parts, stage) && isAtRest(parts)};
  }
  if (wanted_.looksForRest() && clock.cycle > 0 && clock.cycle % checkEvery == 0)
  {
    state_.below = mayEnd(parts, stage) && isAtRest(parts) ? state_.below + 1 : 0;
    return {false, state_.below >= checksInARow};
  }
  return {};
}

void Relaxation::tellWhenTimeEndsDamping(const Parts& parts) const
{
  const Clock& clock = parts.clock;
  if (!parts.model.conditions.hasDamping() ||
      !parts.model.conditions.dampsAt(clock.time - clock.step))
    return;
  const RestRatios ratios = restRatios(parts);
  logInfo("cycle {}, t = {:.6e} s: damping ends by damping.until. Kinetic energy is {:.2g} of the "
          "internal one, forces out of balance are {:.2g} of loads and reactions; at rest both "
          "vanish",
          clock.cycle, clock.time, ratios.energy, ratios.force);
}

void Relaxation::bookStop(Real lost, Real left)
{
  state_.work += lost;
  state_.kineticBefore = left;
  ++state_.stops;
}

void Relaxation::end(const Parts& parts)
{
  const Clock& clock = parts.clock;
  state_.ended = true;
  logInfo("cycle {}, t = {:.6e} s: damping ends, at rest within the ratios of damping{}",
          clock.cycle, clock.time,
          clock.time < wanted_.lastChange
              ? fmt::format("; {} changes until t = {:.6g} s, without damping", wanted_.changing,
                            wanted_.lastChange)
              : "");
}
} // namespace coplane
