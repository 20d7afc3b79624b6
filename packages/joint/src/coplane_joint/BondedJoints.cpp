#include "detail/JointKeys.hpp"

namespace coplane
{
namespace
{
JointLaw softening(const BondParameters& p, Bond::Kind kind)
{
  JointLaw law = coulombLaw(p);
  law.cohesion = 0; // is the bond's
  law.initialStiffness = p.normalStiffness;
  law.curve.inverseMaximumClosure = p.maximumClosure > 0 ? 1 / p.maximumClosure : 0;
  law.stiffnessCap = p.stiffnessCap.value_or(0);
  law.bond = Bond::softening(kind, p.tensileStrength, p.cohesion, p.tensionEnergy, p.shearEnergy);
  return law;
}

/// The softening branch must not be steeper than the elastic one, or it could not be followed.
/// @param share of strength squared over stiffness in the least energy
void checkSoftening(const BondParameters& p, Real share, const CardPlace& card)
{
  checkCap(p.stiffnessCap, "normal_stiffness", p.normalStiffness, card);
  if (p.stiffnessCap && p.maximumClosure <= 0)
    card.problem("stiffness_cap",
                 "has no effect on a straight line; give maximum_closure or remove it.");
  checkCoulomb(p, card);
  const auto enough = [&](const char* key, const char* what, Real energy, Real strength, Real k)
  {
    const Real least = share * strength * strength / k;
    if (energy > 0 && k > 0 && !(energy > least))
      card.problem(key, fmt::format("= {} J/m^2 is too small: beyond its strength of {} Pa the "
                                    "joint would have to spring back; accepted: more than {:.4g} "
                                    "J/m^2, or a larger {}.",
                                    energy, strength, least, what));
  };
  enough("tension_energy", "normal_stiffness", p.tensionEnergy, p.tensileStrength,
         p.normalStiffness);
  const Real shear = p.shearStiffness.value_or(p.shearRatio * p.normalStiffness);
  enough("shear_energy", "shear stiffness", p.shearEnergy, p.cohesion, shear);
}

void checkMortar(const MortarParameters& p, const CardPlace& card)
{
  checkSoftening(p, 1, card);
}
void checkBilinear(const BilinearParameters& p, const CardPlace& card)
{
  checkSoftening(p, 0.5, card);
}

template <class P>
std::vector<Key> bondKeys()
{
  using namespace schema;
  std::vector<Key> keys{
      number<P, Real>("normal_stiffness", &P::normalStiffness)
          .needed()
          .in("Pa/m")
          .above(0)
          .means("traction per closure, and per opening of a bond")
          .like("2e10"),
      number<P, Real>("maximum_closure", &P::maximumClosure)
          .in("m")
          .above(0)
          .like("5e-4")
          .defaultIs("none, a straight line")
          .means("asymptote of a hyperbola in compression, which starts with normal_stiffness"),
      stiffnessCapKey<P>(),
      number<P, Real>("cohesion", &P::cohesion)
          .in("Pa")
          .atLeast(0)
          .like("3e5")
          .means("shear strength of the bond without normal traction; softens"),
      number<P, Real>("tensile_strength", &P::tensileStrength)
          .needed()
          .in("Pa")
          .above(0)
          .like("0.3e6")
          .means("of a declared joint; softens"),
      number<P, Real>("tension_energy", &P::tensionEnergy)
          .needed()
          .in("J/m^2")
          .above(0)
          .like("20")
          .means("fracture energy G_I: area under the curve of traction over opening"),
      number<P, Real>("shear_energy", &P::shearEnergy)
          .needed()
          .in("J/m^2")
          .above(0)
          .like("130")
          .means("fracture energy G_II: area under the cohesive part of traction over slip"),
  };
  const std::vector<Key> coulomb = coulombKeys<P>();
  keys.insert(keys.end(), coulomb.begin(), coulomb.end());
  return keys;
}
} // namespace

JointLaw makeLaw(const MortarParameters& p)
{
  return softening(p, Bond::Kind::Exponential);
}

JointLaw makeLaw(const BilinearParameters& p)
{
  return softening(p, Bond::Kind::Linear);
}

JointModel MortarParameters::model()
{
  return JointModelOf<MortarParameters>("mortar", "a bond with exponential softening")
      .has(bondKeys<MortarParameters>())
      .demands(checkMortar);
}

JointModel BilinearParameters::model()
{
  return JointModelOf<BilinearParameters>("bilinear", "a bond with linear softening")
      .elsewhere({"cohesive"})
      .has(bondKeys<BilinearParameters>())
      .demands(checkBilinear);
}
} // namespace coplane
