#include "JointCards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
bool softens(const JointCard& card)
{
  return card.model == "mortar" || card.model == "bilinear";
}

bool estimated(const JointCard& card)
{
  return card.model == "barton_bandis" && (card.initialStiffness <= 0 || card.maximumClosure <= 0);
}

BandisEstimate estimateOf(const JointCard& card)
{
  return bandisEstimate(card.roughness, card.wallStrength,
                        card.rockStrength.value_or(card.wallStrength));
}

/// Checks of one card; messages stand at its keys.
class JointCheck
{
public:
  JointCheck(const JointCard& card, const DeckNode& root, Problems& problems)
      : card_(card), root_(root), problems_(problems)
  {
  }

  void all()
  {
    cap();
    frictionOfSpeed();
    dilation();
    if (card_.model == "table")
      table();
    if (softens(card_))
      softening();
    if (estimated(card_))
      estimate();
  }

private:
  template <class... T>
  void problem(const std::string& key, fmt::format_string<T...> text, T&&... values)
  {
    problems_.add(nodeAt(root_, {"joints", card_.name, key}),
                  fmt::format("joints.{}.{} ", card_.name, key) +
                      fmt::format(text, std::forward<T>(values)...));
  }

  void cap()
  {
    if (!card_.stiffnessCap)
      return;
    const Real cap = *card_.stiffnessCap;
    const auto below = [&](const char* what, Real start)
    {
      if (start > 0 && cap < start)
        problem("stiffness_cap", "= {} Pa/m is below {} = {} Pa/m; accepted: at least that.", cap,
                what, start);
    };
    if (softens(card_))
    {
      below("normal_stiffness", card_.normalStiffness);
      if (card_.maximumClosure <= 0)
        problem("stiffness_cap", "has no effect on a straight line; give maximum_closure or remove "
                                 "it.");
    }
    else
      below("initial_stiffness", card_.initialStiffness);
  }

  void frictionOfSpeed()
  {
    if (!card_.dynamicFriction)
    {
      if (card_.slipSpeed > 0)
        problem("slip_speed", "has no effect without dynamic_friction; give both or none.");
      return;
    }
    if (card_.slipSpeed <= 0)
      problem("dynamic_friction", "needs slip_speed, the speed over which friction falls [m/s].");
    if (*card_.dynamicFriction > card_.friction)
      problem("dynamic_friction", "= {} is above friction = {}; accepted: at most that.",
              *card_.dynamicFriction, card_.friction);
  }

  void dilation()
  {
    const Real least = std::min(card_.friction, card_.dynamicFriction.value_or(card_.friction));
    if (card_.dilation > least)
      problem("dilation",
              "= {} is above {} = {}: the joint would gain energy by slipping; accepted: "
              "at most that.",
              card_.dilation, card_.dynamicFriction ? "dynamic_friction" : "friction", least);
    if (card_.dilationSlip && card_.model != "barton_bandis" && card_.dilation <= 0)
      problem("dilation_slip", "has no effect without dilation; give both or none.");
  }

  void table()
  {
    const auto& c = card_.closures;
    const auto& sigma = card_.tractions;
    if (c.empty() || sigma.empty())
      return; // was reported where it was read, unless the list is empty
    if (c.size() != sigma.size())
      return problem("tractions", "has {} numbers, but closures has {}; accepted: as many.",
                     sigma.size(), c.size());
    if (int(c.size()) > ClosureCurve::capacity)
      return problem("closures", "has {} points; accepted: at most {}.", c.size(),
                     ClosureCurve::capacity);
    Real slope = 0;
    for (std::size_t i = 0; i < c.size(); ++i)
    {
      const Real from = i ? c[i - 1] : 0, below = i ? sigma[i - 1] : 0;
      if (!(c[i] > from))
        return problem("closures", "does not rise at item {}: {} m after {} m.", i, c[i], from);
      const Real next = (sigma[i] - below) / (c[i] - from);
      // Points on one straight line may differ by rounding.
      if (!(next > 0) || next < slope * (1 - 1e-12))
        return problem("tractions",
                       "is less steep before item {} than before: {:.6g} Pa/m after {:.6g} Pa/m; "
                       "accepted: slopes that never fall, for the tangent of unloading.",
                       i, next, slope);
      slope = next;
    }
  }

  /// The softening branch must not be steeper than the elastic one, or it could not be followed.
  void softening()
  {
    const Real share = card_.model == "bilinear" ? 0.5 : 1;
    const auto check = [&](const char* key, const char* what, Real energy, Real strength, Real k)
    {
      const Real least = share * strength * strength / k;
      if (energy > 0 && k > 0 && !(energy > least))
        problem(key,
                "= {} J/m^2 is too small: beyond its strength of {} Pa the joint would have to "
                "spring back; accepted: more than {:.4g} J/m^2, or a larger {}.",
                energy, strength, least, what);
    };
    check("tension_energy", "normal_stiffness", card_.tensionEnergy, card_.tensileStrength,
          card_.normalStiffness);
    const Real shear = card_.shearStiffness.value_or(card_.shearRatio * card_.normalStiffness);
    check("shear_energy", "shear stiffness", card_.shearEnergy, card_.cohesion, shear);
  }

  void estimate()
  {
    if (card_.roughness <= 0 || card_.wallStrength <= 0)
      return;
    const BandisEstimate e = estimateOf(card_);
    const bool k = card_.initialStiffness > 0 || e.initialStiffness > 0;
    const bool c = card_.maximumClosure > 0 || e.maximumClosure > 0;
    if (!(e.aperture > 0) || !k || !c)
      problem("roughness",
              "= {}, wall_strength = {} Pa and rock_strength = {} Pa are outside of the range of "
              "Bandis' estimates (initial stiffness {:.4g} Pa/m, maximum closure {:.4g} m); give "
              "initial_stiffness and maximum_closure.",
              card_.roughness, card_.wallStrength, card_.rockStrength.value_or(card_.wallStrength),
              e.initialStiffness, e.maximumClosure);
  }

  const JointCard& card_;
  const DeckNode& root_;
  Problems& problems_;
};
} // namespace

JointLaw jointLawOf(const JointCard& card)
{
  JointLaw law;
  law.penalty = card.model == "penalty";
  law.stiffnessFraction = card.stiffnessFraction;
  law.initialStiffness = card.normalStiffness > 0 ? card.normalStiffness : card.initialStiffness;
  Real maximumClosure = card.maximumClosure;
  if (estimated(card))
  {
    const BandisEstimate estimate = estimateOf(card);
    if (card.initialStiffness <= 0)
      law.initialStiffness = estimate.initialStiffness;
    if (maximumClosure <= 0)
      maximumClosure = estimate.maximumClosure;
  }
  law.curve.inverseMaximumClosure = maximumClosure > 0 ? 1 / maximumClosure : 0;
  law.curve.points = int(card.closures.size());
  std::copy(card.closures.begin(), card.closures.end(), law.curve.closure);
  std::copy(card.tractions.begin(), card.tractions.end(), law.curve.traction);
  law.stiffnessCap = card.stiffnessCap.value_or(0);
  law.shearStiffness = card.shearStiffness.value_or(-1);
  law.shearRatio = card.shearRatio;
  law.friction = card.friction;
  if (card.dynamicFriction && *card.dynamicFriction < card.friction)
  {
    law.dynamicFriction = *card.dynamicFriction;
    law.slipSpeed = card.slipSpeed;
  }
  law.dilation = card.dilation;
  law.dilationSlip = card.dilationSlip.value_or(infinity);
  if (softens(card))
    law.bond =
        Bond::softening(card.model == "mortar" ? Bond::Kind::Exponential : Bond::Kind::Linear,
                        card.tensileStrength, card.cohesion, card.tensionEnergy, card.shearEnergy);
  else
  {
    law.cohesion = card.cohesion;
    if (card.tensileStrength > 0)
    {
      law.bond.kind = Bond::Kind::Brittle;
      law.bond.tensileStrength = card.tensileStrength;
    }
  }
  if (card.model == "barton_bandis")
  {
    law.strength = JointLaw::Strength::BartonBandis;
    law.rough = {card.roughness, card.wallStrength, std::atan(card.residualFriction),
                 card.peakSlip};
  }
  return law;
}

void checkJoints(const std::vector<JointCard>& joints, const DeckNode& root, Problems& problems)
{
  for (const JointCard& card : joints)
    JointCheck(card, root, problems).all();
}
} // namespace coplane
