#pragma once

#include <coplane_joint/JointLaw.hpp>

#include <cmath>

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

/// Leads a joint along a path of gap and slip, as a plane does, and keeps the ledger: work of the
/// mean tractions of each step.
struct JointRun
{
  explicit JointRun(const Joint& j) : joint(j) { state.bonded = j.law.cohesive(); }

  const Joint joint;
  JointState state;
  JointResponse last;
  Real gap = 0, offset = 0; ///< [m]
  Real work = 0, friction = 0, fracture = 0, hysteresis = 0, leastDissipation = infinity;

  Real closure() const { return offset - gap; }
  Real sigma() const { return last.normalTraction; }
  Real stored() const { return joint.stored(closure(), state); }
  Real imbalance() const { return work - stored() - friction - fracture - hysteresis; }

  void step(Real newGap, const Vec3& increment, Real dt = 1e-6)
  {
    const Vec3 tau = state.shearTraction;
    const Real sigmaBefore = sigma(), opening = newGap - gap;
    gap = newGap;
    last = joint.law(joint.fit, closure(), increment, dt, state);
    offset += last.dilation;
    work -= .5 * (sigmaBefore + sigma()) * opening;
    work -= .5 * dot(tau + state.shearTraction, increment);
    friction += last.frictionWork;
    fracture += last.fractureWork;
    const Real closing = last.hysteresisWork(sigmaBefore);
    hysteresis += closing;
    for (const Real part : {last.frictionWork, last.fractureWork, closing})
      leastDissipation = std::fmin(leastDissipation, part);
  }

  /// In equal steps to a gap, with a slip.
  void go(Real toGap, const Vec3& slip, int steps, Real dt = 1e-6)
  {
    const Real from = gap;
    for (int i = 1; i <= steps; ++i)
      step(from + (toGap - from) * i / steps, (1.0 / steps) * slip, dt);
  }
};

inline Joint linearJoint(Real normalStiffness, Real shearStiffness, Real friction)
{
  Joint joint;
  joint.law.penalty = false;
  joint.law.initialStiffness = normalStiffness;
  joint.law.shearStiffness = shearStiffness;
  joint.law.friction = friction;
  joint.fit = joint.law.fittedTo(1, 1e12, 1, 1e12);
  return joint;
}

/// Mortar between clay bricks: f_t .25 MPa, c .35 MPa, G_I 18 J/m^2, G_II 125 J/m^2.
inline Joint mortarJoint(Bond::Kind kind = Bond::Kind::Exponential)
{
  Joint joint = linearJoint(8.2e10, 3.6e10, .75);
  joint.law.bond = Bond::softening(kind, .25e6, .35e6, 18, 125);
  return joint;
}

/// The same that is crushed as in the walls of Lourenco and Rots: f_m 10.5 MPa, G_fc 5 N/mm, k_p
/// .09 mm, C_ss 9.
/// @param loss of stiffness
inline Joint crushedMortar(Real loss = 0, Real friction = .75)
{
  Joint joint = mortarJoint();
  joint.law.friction = friction;
  joint.law.bond.loss = loss;
  Crushing& crushing = joint.law.curve.crushing;
  crushing.strength = 10.5e6;
  crushing.peak = 9e-5;
  crushing.length = Crushing::lengthFrom(10.5e6, 5e3, crushing.residual);
  crushing.loss = loss;
  return joint;
}

inline Joint roughJoint()
{
  Joint joint = linearJoint(2e10, 1e10, 0);
  joint.law.curve.inverseMaximumClosure = 1 / 2e-4;
  joint.law.strength = JointLaw::Strength::BartonBandis;
  joint.law.rough = {8, 100e6, 30 * BartonBandis::degree, 2e-3};
  joint.fit = joint.law.fittedTo(1, 1e12, 1, 1e12);
  return joint;
}

inline Joint tableJoint()
{
  // Slopes 1e10, 3e10, 1e11 Pa/m.
  Joint joint = linearJoint(0, 5e9, .6);
  joint.law.curve.points = 3;
  const Real c[] = {1e-4, 2e-4, 2.5e-4}, sigma[] = {1e6, 4e6, 9e6};
  for (int i = 0; i < 3; ++i)
  {
    joint.law.curve.closure[i] = c[i];
    joint.law.curve.traction[i] = sigma[i];
  }
  joint.fit = joint.law.fittedTo(1, 1e12, 1, 1e12);
  return joint;
}
} // namespace coplane
