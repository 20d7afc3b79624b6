#pragma once

#include <coplane_joint/JointLaw.hpp>

namespace coplane
{
/// A law fitted to a pair of faces, with the words of the tests.
struct Joint
{
  JointLaw law;
  JointFit fit;

  Real loadingTraction(Real c) const { return law.curve.at(fit, c).traction; }
  Real loadingStiffness(Real c) const { return law.curve.at(fit, c).stiffness; }
  Real loadingWork(Real c) const { return law.curve.work(fit, c); }
  Real hysteresisWork(Real c) const { return law.hysteresis(fit, c); }
  Real closureUnder(Real sigma) const { return law.closureUnder(fit, sigma); }
  Real cappedFrom() const { return law.curve.cappedFrom(fit); }
  Real stored(Real c, const JointState& state) const { return law.stored(fit, c, state); }

  JointResponse normal(Real c, JointState& state) const { return law(fit, c, {}, 1e-6, state); }
  JointResponse operator()(Real c, const Vec3& increment, JointState& state) const
  {
    return law(fit, c, increment, 1e-6, state);
  }
};
} // namespace coplane
