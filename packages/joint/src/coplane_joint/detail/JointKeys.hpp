#pragma once

#include <coplane_joint/JointModel.hpp>

#include <fmt/format.h>

namespace coplane
{
/// A model of a joint under construction (CardModelBuilder), with the words of joints.
template <class P>
class JointModelOf : public CardModelBuilder<JointModelOf<P>, JointModel, P>
{
public:
  using CardModelBuilder<JointModelOf<P>, JointModel, P>::CardModelBuilder;

  JointModelOf& takesStiffnessFromElements()
  {
    this->model_.needsElements = true;
    return *this;
  }
};

namespace schema
{
// Keys that several models have. P has to be derived from the parameters that are named.

/// Of ShearStiffnessParameters.
template <class P>
std::vector<Key> shearStiffnessKeys()
{
  return {
      number<P, std::optional<Real>>("shear_stiffness", &P::shearStiffness)
          .in("Pa/m")
          .usually(usual::stiffness)
          .elsewhere({"ks", "jks"})
          .atLeast(0)
          .defaultIs("shear_ratio times the normal stiffness")
          .like("5e9")
          .means("shear traction per slip"),
      number<P, Real>("shear_ratio", &P::shearRatio)
          .in("-")
          .atLeast(0)
          .like("0.4")
          .means("shear stiffness over normal stiffness at zero closure"),
  };
}

/// Of a P with stiffnessCap.
template <class P>
Key stiffnessCapKey()
{
  return number<P, std::optional<Real>>("stiffness_cap", &P::stiffnessCap)
      .in("Pa/m")
      .above(0)
      .defaultIs("0.5 M/h of the softer element")
      .like("3e11")
      .means("largest slope of the closure curve; at least its slope at zero closure");
}

/// Of a P with dilationSlip.
template <class P>
Key dilationSlipKey()
{
  return number<P, std::optional<Real>>("dilation_slip", &P::dilationSlip)
      .in("m")
      .atLeast(0)
      .like("1e-3")
      .defaultIs("no limit")
      .means("length of the slip path after which the joint dilates no more");
}

/// Of CoulombParameters, without the cohesion.
template <class P>
std::vector<Key> coulombKeys()
{
  std::vector<Key> keys = shearStiffnessKeys<P>();
  const std::vector<Key> more{
      number<P, Real>("friction", &P::friction)
          .in("-")
          .usually(usual::friction)
          .elsewhere({"phi", "mu", "fs", "jfric", "friction_angle"})
          .atLeast(0)
          .like("0.6")
          .means("tangent of the friction angle, at rest"),
      number<P, std::optional<Real>>("dynamic_friction", &P::dynamicFriction)
          .in("-")
          .usually(usual::friction)
          .elsewhere({"fd", "mu_d"})
          .atLeast(0)
          .like("0.4")
          .defaultIs("friction")
          .means("friction of fast slip mu_d: mu_d + (friction - mu_d) exp(-speed / slip_speed)"),
      number<P, Real>("slip_speed", &P::slipSpeed)
          .in("m/s")
          .above(0)
          .like("0.1")
          .defaultIs("none; dynamic_friction needs it")
          .means("speed of the faces' sliding over which friction falls"),
      number<P, Real>("dilation", &P::dilation)
          .in("-")
          .usually(usual::friction)
          .elsewhere({"jdil", "dilation_angle"})
          .atLeast(0)
          .like("0.1")
          .means("opening per slip: tangent of the dilation angle; at most the friction"),
      dilationSlipKey<P>(),
  };
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

/// Of a P with resistsBending.
template <class P>
Key resistsBendingKey()
{
  return flag<P>("resists_bending", &P::resistsBending)
      .like("true")
      .means("the bond's traction follows the opening at each point of a face, so that a face "
             "carries moments, and breaks from its most open point; false: one traction all over "
             "a face, by its mean opening. With contact.forces: potential");
}

/// Of CoulombParameters of a joint without a bond that softens.
template <class P>
Key cohesionKey()
{
  return number<P, Real>("cohesion", &P::cohesion)
      .in("Pa")
      .usually(usual::stress)
      .elsewhere({"jcoh", "c"})
      .atLeast(0)
      .like("1e5")
      .means("shear strength without normal traction, of a joint that is closed or bonded");
}
} // namespace schema

/// The parts of a law that CoulombParameters give.
JointLaw coulombLaw(const CoulombParameters& parameters);
/// Those of ShearStiffnessParameters.
JointLaw shearLaw(const ShearStiffnessParameters& parameters);

/// What friction and dilation demand of each other.
void checkCoulomb(const CoulombParameters& parameters, const CardPlace& place);

/// What a bond that resists bending demands.
/// @param loss of stiffness where it is open [-]; bonds that break at once have none
template <class P>
void checkBending(const P& p, Real loss, const CardPlace& card)
{
  if (!p.resistsBending)
    return;
  if (!(p.tensileStrength > 0))
    card.problem("resists_bending", "has no effect without tensile_strength; give both or none.");
  if (!(loss >= 1))
    card.problem("resists_bending", "needs stiffness_loss: 1, so that what has opened unloads "
                                    "towards zero at each point.");
  if (p.dilation > 0)
    card.problem("resists_bending", "does not go with dilation; remove one of them.");
}

/// A cap has to be at least the slope of the curve at its start.
/// @param what its key
void checkCap(const std::optional<Real>& cap, const char* what, Real start, const CardPlace& place);
} // namespace coplane
