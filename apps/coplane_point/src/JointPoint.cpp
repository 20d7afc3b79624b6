#include "JointPoint.hpp"

#include <coplane_core/Error.hpp>

#include <cmath>

namespace coplane
{
void JointPoint::moveTo(Real gap, const Vec3& slip, Real dt)
{
  const Vec3 shearBefore = state_.shearTraction, increment = slip - slip_;
  const Real tractionBefore = response_.normalTraction, opening = gap - gap_;
  response_ = law_(fit_, offset_ - gap, increment, dt, state_);
  offset_ += response_.dilation;
  time_ += dt;
  gap_ = gap;
  slip_ = slip;
  work_ -= 0.5 * (tractionBefore + response_.normalTraction) * opening +
           0.5 * dot(shearBefore + state_.shearTraction, increment);
  friction_ += response_.frictionWork;
  fracture_ += response_.fractureWork;
  hysteresis_ += response_.hysteresisWork(tractionBefore);
}

Real JointPoint::balancedGap(const Vec3& slip, Real dt, Real traction, Real stiffness,
                             Real from) const
{
  const auto excess = [&](Real gap)
  {
    JointState trial = state_;
    const JointResponse response = law_(fit_, offset_ - gap, slip - slip_, dt, trial);
    return response.normalTraction - traction - stiffness * (gap - from);
  };
  // The traction falls with the gap: a bracket, then halving with a secant where it is inside.
  const Real unit = (traction + 1) / fit_.normalStiffness;
  Real low = gap_, high = gap_;
  Real atLow = excess(low), atHigh = atLow;
  const Real tolerance = 1e-13 * (traction + fit_.normalStiffness * std::abs(gap_));
  if (std::abs(atLow) <= tolerance)
    return gap_;
  Real reach = 1e-6 * unit;
  for (int i = 0; i < 200 && atLow < 0; ++i, reach *= 2)
    atLow = excess(low = gap_ - reach);
  reach = 1e-6 * unit;
  for (int i = 0; i < 200 && atHigh > 0; ++i, reach *= 2)
    atHigh = excess(high = gap_ + reach);
  if (!(atLow >= 0 && atHigh <= 0))
    fail(ExitCode::Computation,
         "no gap of the joint balances the normal traction of {} Pa at slip {} m; take more steps.",
         traction, norm(slip));
  for (int i = 0; i < 200; ++i)
  {
    Real middle = i % 3 == 2 || atLow == atHigh ? 0.5 * (low + high)
                                                : low + (high - low) * atLow / (atLow - atHigh);
    if (!(middle > low && middle < high))
      middle = 0.5 * (low + high);
    if (!(middle > low && middle < high))
      break;
    const Real value = excess(middle);
    if (std::abs(value) <= tolerance)
      return middle;
    (value > 0 ? low : high) = middle;
    (value > 0 ? atLow : atHigh) = value;
  }
  return std::abs(atLow) < std::abs(atHigh) ? low : high;
}
} // namespace coplane
