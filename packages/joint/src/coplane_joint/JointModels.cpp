#include "detail/JointKeys.hpp"

#include <algorithm>

namespace coplane
{
const std::vector<JointModel>& jointModels()
{
  static const std::vector<JointModel> models{
      PenaltyParameters::model(), LinearParameters::model(),       ClosureCurveParameters::model(),
      TableParameters::model(),   BartonBandisParameters::model(), MortarParameters::model(),
      BilinearParameters::model()};
  return models;
}

JointLaw shearLaw(const ShearStiffnessParameters& p)
{
  JointLaw law;
  law.penalty = false;
  law.shearStiffness = p.shearStiffness.value_or(-1);
  law.shearRatio = p.shearRatio;
  return law;
}

JointLaw coulombLaw(const CoulombParameters& p)
{
  JointLaw law = shearLaw(p);
  law.friction = p.friction;
  if (p.dynamicFriction && *p.dynamicFriction < p.friction)
  {
    law.dynamicFriction = *p.dynamicFriction;
    law.slipSpeed = p.slipSpeed;
  }
  law.cohesion = p.cohesion;
  law.dilation = p.dilation;
  law.dilationSlip = p.dilationSlip.value_or(infinity);
  return law;
}

void checkCoulomb(const CoulombParameters& p, const CardPlace& card)
{
  if (!p.dynamicFriction)
  {
    if (p.slipSpeed > 0)
      card.problem("slip_speed", "has no effect without dynamic_friction; give both or none.");
  }
  else
  {
    if (p.slipSpeed <= 0)
      card.problem("dynamic_friction",
                   "needs slip_speed, the speed over which friction falls [m/s].");
    if (*p.dynamicFriction > p.friction)
      card.problem("dynamic_friction",
                   fmt::format("= {} is above friction = {}; accepted: at most that.",
                               *p.dynamicFriction, p.friction));
  }
  const Real least = std::min(p.friction, p.dynamicFriction.value_or(p.friction));
  if (p.dilation > least)
    card.problem("dilation",
                 fmt::format("= {} is above {} = {}: the joint would gain energy by slipping; "
                             "accepted: at most that.",
                             p.dilation, p.dynamicFriction ? "dynamic_friction" : "friction",
                             least));
  if (p.dilationSlip && p.dilation <= 0)
    card.problem("dilation_slip", "has no effect without dilation; give both or none.");
}

void checkCap(const std::optional<Real>& cap, const char* what, Real start, const CardPlace& card)
{
  if (cap && start > 0 && *cap < start)
    card.problem("stiffness_cap", fmt::format("= {} Pa/m is below {} = {} Pa/m; accepted: at least "
                                              "that.",
                                              *cap, what, start));
}
} // namespace coplane
