#include "detail/JointKeys.hpp"

#include <algorithm>
#include <cmath>

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
  law.bond.resistsBending = p.resistsBending;
  return law;
}

Crushing crushingOf(const MortarParameters& p)
{
  Crushing crushing;
  crushing.strength = p.compressiveStrength;
  crushing.peak = p.peakCrushing;
  crushing.residual = p.residualCompression;
  crushing.length =
      Crushing::lengthFrom(p.compressiveStrength, p.compressionEnergy, p.residualCompression);
  crushing.shearWeight = p.shearInCrushing;
  crushing.loss = p.stiffnessLoss;
  return crushing;
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
  if (p.resistsBending && p.maximumClosure > 0)
    card.problem("resists_bending", "does not go with maximum_closure; remove one of them.");
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
  checkBending(p, p.stiffnessLoss, card);
  if (p.resistsBending && p.compressiveStrength > 0)
    card.problem("resists_bending", "does not go with compressive_strength; remove one of them.");
  if (!(p.compressiveStrength > 0))
  {
    const auto useless = [&](const char* key, bool given)
    {
      if (given)
        card.problem(key, "has no effect without compressive_strength; give both or none.");
    };
    const MortarParameters usual;
    useless("compression_energy", p.compressionEnergy > 0);
    useless("peak_crushing", p.peakCrushing > 0);
    useless("residual_compression", p.residualCompression != usual.residualCompression);
    useless("shear_in_crushing", p.shearInCrushing != usual.shearInCrushing);
    return;
  }
  if (p.maximumClosure > 0)
    card.problem("maximum_closure",
                 "does not go with compressive_strength: a joint that is crushed is straight up "
                 "to a third of its strength; remove one of them.");
  if (!(p.compressionEnergy > 0))
    card.problem("compressive_strength", "needs compression_energy, the fracture energy of "
                                         "crushing [J/m^2].");
  if (!(p.peakCrushing > 0))
    card.problem("compressive_strength", "needs peak_crushing, the inelastic closure at the "
                                         "strength [m].");
  if (!(p.compressionEnergy > 0 && p.peakCrushing > 0 && p.normalStiffness > 0))
    return;
  const Crushing crushing = crushingOf(p);
  const Real shear = p.shearStiffness.value_or(p.shearRatio * p.normalStiffness);
  const Real soft = p.shearInCrushing > 0 && shear > 0
                        ? std::min(p.normalStiffness, std::sqrt(p.shearInCrushing) * shear)
                        : p.normalStiffness;
  if (!(crushing.steepest() < soft))
    card.problem("compression_energy",
                 fmt::format("= {} J/m^2 is too small: beyond its strength of {} Pa the joint "
                             "would have to spring back; accepted: more than {:.4g} J/m^2, or "
                             "larger stiffnesses.",
                             p.compressionEnergy, p.compressiveStrength,
                             p.compressionEnergy * crushing.steepest() / soft));
}
void checkBilinear(const BilinearParameters& p, const CardPlace& card)
{
  checkSoftening(p, 0.5, card);
  checkBending(p, 1, card);
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
      resistsBendingKey<P>(),
  };
  const std::vector<Key> coulomb = coulombKeys<P>();
  keys.insert(keys.end(), coulomb.begin(), coulomb.end());
  return keys;
}
} // namespace

namespace
{
std::vector<Key> crushingKeys()
{
  using P = MortarParameters;
  using namespace schema;
  return {
      number<P, Real>("compressive_strength", &P::compressiveStrength)
          .in("Pa")
          .usually(usual::stress)
          .above(0)
          .like("11e6")
          .defaultIs("none, the joint is never crushed")
          .means("of the joint, f_m: crushing starts at a third of it and goes on along a "
                 "hardening and a softening curve"),
      number<P, Real>("compression_energy", &P::compressionEnergy)
          .in("J/m^2")
          .above(0)
          .like("5e3")
          .defaultIs("none; compressive_strength needs it")
          .means("fracture energy of crushing G_fc: area under the curve of traction over "
                 "inelastic closure, after its peak and above the residual"),
      number<P, Real>("peak_crushing", &P::peakCrushing)
          .in("m")
          .above(0)
          .like("9e-5")
          .defaultIs("none; compressive_strength needs it")
          .means("inelastic closure at which the joint has its compressive strength"),
      number<P, Real>("residual_compression", &P::residualCompression)
          .in("-")
          .above(0)
          .below(0.5)
          .like("0.15")
          .means("part of the compressive strength that a crushed joint keeps"),
      number<P, Real>("shear_in_crushing", &P::shearInCrushing)
          .in("-")
          .atLeast(0)
          .like("9")
          .means("weight C_ss of the shear traction in sigma^2 + C_ss tau^2 = f^2, the limit of "
                 "both tractions under compression; 0: shear does not crush"),
      number<P, Real>("stiffness_loss", &P::stiffnessLoss)
          .in("-")
          .atLeast(0)
          .atMost(1)
          .like("0.5")
          .means("part of the inelastic opening, and of the crushing, that unloading gives back: "
                 "0 unloads with the elastic stiffness, 1 towards zero"),
  };
}
} // namespace

JointLaw makeLaw(const MortarParameters& p)
{
  JointLaw law = softening(p, Bond::Kind::Exponential);
  law.bond.loss = p.stiffnessLoss;
  if (p.compressiveStrength > 0)
    law.curve.crushing = crushingOf(p);
  return law;
}

JointLaw makeLaw(const BilinearParameters& p)
{
  return softening(p, Bond::Kind::Linear);
}

JointModel MortarParameters::model()
{
  return JointModelOf<MortarParameters>("mortar", "a bond with exponential softening")
      .has(bondKeys<MortarParameters>())
      .has(crushingKeys())
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
