#include "MaterialCards.hpp"

#include <coplane_schema/SchemaBuilder.hpp>

namespace coplane
{
using namespace schema;

std::vector<Key> materialCardKeys()
{
  const std::vector<std::string> elastic = {"linear_elastic", "j2",           "neo_hookean",
                                            "drucker_prager", "mohr_coulomb", "johnson_cook",
                                            "pseudo_cap"};
  return {
      text("model", &MaterialCard::model)
          .needed()
          .oneOf({"linear_elastic", "j2", "neo_hookean", "drucker_prager", "mohr_coulomb",
                  "johnson_cook", "pseudo_cap", "hjc", "fluid", "ideal_gas"})
          .means("law of the continuum: Hooke; von Mises with hardening; rubber; Drucker and "
                 "Prager; Mohr and Coulomb; Johnson and Cook; concrete with a pseudo-cap; concrete "
                 "of Holmquist, Johnson and Cook; an equation of state without strength; gas")
          .like("j2"),
      text("set", &MaterialCard::set)
          .oneOf(materialSetNames())
          .like("concrete_c40")
          .defaultIs("none")
          .means("set of the library, from which all keys come that are not given here, the model "
                 "too"),
      number("density", &MaterialCard::density)
          .needed()
          .in("kg/m^3")
          .above(0)
          .like("7850")
          .means("mass per reference volume"),
      number("youngs_modulus", &MaterialCard::youngsModulus)
          .onlyFor(elastic)
          .needed()
          .in("Pa")
          .above(0)
          .like("210e9")
          .means("Young's modulus"),
      number("poisson_ratio", &MaterialCard::poissonRatio)
          .onlyFor(elastic)
          .needed()
          .in("-")
          .above(-1)
          .below(0.5)
          .like("0.3")
          .means("Poisson's ratio"),
      number("shear_modulus", &MaterialCard::shearModulus)
          .onlyFor({"hjc"})
          .needed()
          .in("Pa")
          .above(0)
          .like("14.86e9")
          .means("shear modulus G"),
      number("yield_stress", &MaterialCard::yieldStress)
          .onlyFor({"j2"})
          .in("Pa")
          .above(0)
          .defaultIs("none")
          .like("1e9")
          .means("uniaxial stress at first yield; or a table"),
      number("hardening_modulus", &MaterialCard::hardeningModulus)
          .onlyFor({"j2"})
          .in("Pa")
          .atLeast(0)
          .like("1e9")
          .means("slope of the yield stress over equivalent plastic strain"),
      numbers("plastic_strains", &MaterialCard::plasticStrains)
          .onlyFor({"j2"})
          .in("-")
          .atLeast(0)
          .like("[0, 0.01, 0.1]")
          .means("equivalent plastic strains of a table, rising from 0; at most 16"),
      numbers("yield_stresses", &MaterialCard::yieldStresses)
          .onlyFor({"j2"})
          .in("Pa")
          .above(0)
          .like("[300e6, 340e6, 400e6]")
          .means("yield stresses at plastic_strains, not falling; the last one stays beyond the "
                 "table"),
      number("kinematic_modulus", &MaterialCard::kinematicModulus)
          .onlyFor({"j2"})
          .in("Pa")
          .atLeast(0)
          .like("2e9")
          .means("uniaxial back stress over plastic strain (Prager)"),
      number("yield_stress", &MaterialCard::yieldStress)
          .onlyFor({"johnson_cook"})
          .needed()
          .in("Pa")
          .above(0)
          .like("792e6")
          .means("A, static yield stress at room temperature"),
      number("hardening_modulus", &MaterialCard::hardeningModulus)
          .onlyFor({"johnson_cook"})
          .in("Pa")
          .atLeast(0)
          .like("510e6")
          .means("B, of the hardening B ep^n"),
      number("hardening_exponent", &MaterialCard::hardeningExponent)
          .onlyFor({"johnson_cook"})
          .in("-")
          .above(0)
          .atMost(1)
          .like("0.26")
          .means("n"),
      number("rate_factor", &MaterialCard::rateFactor)
          .onlyFor({"johnson_cook", "hjc"})
          .in("-")
          .atLeast(0)
          .like("0.014")
          .means("C, share by which strength grows with the logarithm of the rate over 1/s"),
      number("thermal_exponent", &MaterialCard::thermalExponent)
          .onlyFor({"johnson_cook"})
          .in("-")
          .above(0)
          .like("1.03")
          .means("m of the softening 1 - T*^m"),
      number("melting_temperature", &MaterialCard::meltingTemperature)
          .onlyFor({"johnson_cook"})
          .in("K")
          .atLeast(0)
          .like("1793")
          .means("at which strength is lost; 0: no thermal softening"),
      number("room_temperature", &MaterialCard::roomTemperature)
          .onlyFor({"johnson_cook"})
          .in("K")
          .above(0)
          .like("300")
          .means("at the start"),
      number("heat_capacity", &MaterialCard::heatCapacity)
          .onlyFor({"johnson_cook"})
          .needed()
          .in("J/(kg K)")
          .above(0)
          .like("477")
          .means("specific heat"),
      number("heat_fraction", &MaterialCard::heatFraction)
          .onlyFor({"johnson_cook"})
          .in("-")
          .atLeast(0)
          .atMost(1)
          .like("0.95")
          .means("of the plastic work that heats"),
      numbers("fracture", &MaterialCard::fracture, 5)
          .onlyFor({"johnson_cook"})
          .in("-")
          .like("[0.05, 3.44, -2.12, 0.002, 0.61]")
          .means("D1 to D5 of the strain at fracture; none: it does not fracture"),
      text("eos", &MaterialCard::eos)
          .onlyFor({"j2", "johnson_cook", "fluid"})
          .oneOf({"none", "linear", "mie_grueneisen", "p_alpha"})
          .like("linear")
          .means("equation of state for the pressure: rate form with the elastic bulk modulus; "
                 "linear in density; about the shock line; the same with pores that close"),
      number("sound_speed", &MaterialCard::soundSpeed)
          .onlyFor({"j2", "johnson_cook", "fluid"})
          .in("m/s")
          .atLeast(0)
          .like("4570")
          .means("c0 of the shock speed c0 + s up of the solid"),
      number("shock_slope", &MaterialCard::shockSlope)
          .onlyFor({"j2", "johnson_cook", "fluid"})
          .in("-")
          .atLeast(0)
          .like("1.49")
          .means("s of the shock speed"),
      number("grueneisen", &MaterialCard::grueneisen)
          .onlyFor({"j2", "johnson_cook", "fluid"})
          .in("-")
          .atLeast(0)
          .like("1.93")
          .means("Grueneisen's Gamma at the reference density"),
      number("distension", &MaterialCard::distension)
          .onlyFor({"j2", "johnson_cook", "fluid"})
          .in("-")
          .atLeast(1)
          .like("1.5")
          .means("p_alpha: density of the solid over that of the porous material"),
      number("crush_start", &MaterialCard::crushStart)
          .onlyFor({"j2", "johnson_cook", "fluid"})
          .in("Pa")
          .atLeast(0)
          .like("0.2e9")
          .means("p_alpha: pressure from which pores close"),
      number("crush_end", &MaterialCard::crushEnd)
          .onlyFor({"j2", "johnson_cook", "fluid"})
          .in("Pa")
          .atLeast(0)
          .like("2e9")
          .means("p_alpha: pressure at which none is left"),
      number("heat_ratio", &MaterialCard::heatRatio)
          .onlyFor({"ideal_gas"})
          .needed()
          .in("-")
          .above(1)
          .like("1.4")
          .means("ratio of specific heats"),
      number("pressure", &MaterialCard::pressure)
          .onlyFor({"ideal_gas"})
          .needed()
          .in("Pa")
          .above(0)
          .like("1e5")
          .means("initial pressure, for the first sound speed; the state itself comes from the "
                 "initial stress of the block"),
      number("cohesion", &MaterialCard::cohesion)
          .onlyFor({"drucker_prager", "mohr_coulomb"})
          .in("Pa")
          .atLeast(0)
          .like("5e6")
          .means("c"),
      number("friction", &MaterialCard::friction)
          .onlyFor({"drucker_prager", "mohr_coulomb"})
          .in("-")
          .atLeast(0)
          .like("0.6")
          .means("tangent of the friction angle"),
      number("dilation", &MaterialCard::dilation)
          .onlyFor({"drucker_prager", "mohr_coulomb"})
          .in("-")
          .atLeast(0)
          .like("0.2")
          .means("tangent of the dilation angle; at most friction"),
      text("fit", &MaterialCard::fit)
          .onlyFor({"drucker_prager"})
          .oneOf({"compression", "plane_strain"})
          .like("plane_strain")
          .means("the cone touches Mohr and Coulomb's planes in triaxial compression, or has their "
                 "limit in plane strain"),
      number("residual_cohesion", &MaterialCard::residualCohesion)
          .onlyFor({"mohr_coulomb"})
          .in("Pa")
          .atLeast(0)
          .like("1e6")
          .means("c after much slip, when shear_energy is given"),
      number("tensile_strength", &MaterialCard::tensileStrength)
          .onlyFor({"mohr_coulomb"})
          .in("Pa")
          .atLeast(0)
          .like("2e6")
          .means("cut-off of the largest principal stress; at most cohesion / friction"),
      number("shear_energy", &MaterialCard::shearEnergy)
          .onlyFor({"mohr_coulomb"})
          .in("J/m^2")
          .atLeast(0)
          .like("500")
          .means("by which cohesion falls, per area of a slip plane; 0: it stays"),
      number("fracture_energy", &MaterialCard::fractureEnergy)
          .onlyFor({"mohr_coulomb"})
          .in("J/m^2")
          .atLeast(0)
          .like("100")
          .means("by which tensile strength falls, per area of a crack; 0: it stays"),
      numbers("plastic_shears", &MaterialCard::plasticShears)
          .onlyFor({"mohr_coulomb"})
          .in("-")
          .atLeast(0)
          .like("[0, 0.02]")
          .means("plastic shears of a table of cohesion and friction, rising from 0; 2 to 8; the "
                 "last values stay beyond it. The softening depends on the size of elements"),
      numbers("cohesions", &MaterialCard::cohesions)
          .onlyFor({"mohr_coulomb"})
          .in("Pa")
          .atLeast(0)
          .like("[5e6, 1e6]")
          .means("c at plastic_shears"),
      numbers("frictions", &MaterialCard::frictions)
          .onlyFor({"mohr_coulomb"})
          .in("-")
          .atLeast(0)
          .like("[0.7, 0.5]")
          .means("tangents of the friction angle at plastic_shears; not below dilation"),
      number("compressive_strength", &MaterialCard::compressiveStrength)
          .onlyFor({"pseudo_cap", "hjc"})
          .needed()
          .in("Pa")
          .above(0)
          .like("40e6")
          .means("fc, in uniaxial compression"),
      number("tensile_strength", &MaterialCard::tensileStrength)
          .onlyFor({"pseudo_cap", "hjc"})
          .needed()
          .in("Pa")
          .above(0)
          .like("4e6")
          .means("in tension; hjc: the limit T of mean tension"),
      number("fracture_energy", &MaterialCard::fractureEnergy)
          .onlyFor({"pseudo_cap"})
          .needed()
          .in("J/m^2")
          .above(0)
          .like("120")
          .means("G_F, per area of a crack"),
      number("porosity", &MaterialCard::porosity)
          .onlyFor({"pseudo_cap"})
          .needed()
          .in("-")
          .above(0)
          .below(0.6)
          .like("0.08")
          .means("share of pores at the start"),
      number("grain_modulus", &MaterialCard::grainModulus)
          .onlyFor({"pseudo_cap"})
          .needed()
          .in("Pa")
          .above(0)
          .like("40e9")
          .means("bulk modulus of the material without pores"),
      number("grain_slope", &MaterialCard::grainSlope)
          .onlyFor({"pseudo_cap"})
          .in("-")
          .atLeast(0)
          .below(3)
          .like("1.4")
          .means("s of the shock speed of the material without pores"),
      number("crush_pressure", &MaterialCard::crushPressure)
          .onlyFor({"pseudo_cap", "hjc"})
          .needed()
          .in("Pa")
          .above(0)
          .like("80e6")
          .means("from which pores close"),
      number("crush_hardening", &MaterialCard::crushHardening)
          .onlyFor({"pseudo_cap"})
          .needed()
          .in("Pa")
          .above(0)
          .like("300e6")
          .means("growth of the crush pressure while the pores fall to 1/e"),
      number("cap_ratio", &MaterialCard::capRatio)
          .onlyFor({"pseudo_cap"})
          .in("-")
          .above(0)
          .below(1)
          .like("0.6")
          .means("share of the crush pressure from which shear compacts"),
      number("shear_compaction", &MaterialCard::shearCompaction)
          .onlyFor({"pseudo_cap"})
          .in("-")
          .atLeast(0)
          .like("1.5")
          .means("volume strain per plastic shear strain at the crush pressure"),
      flag("rate_effects", &MaterialCard::rateEffects)
          .onlyFor({"pseudo_cap"})
          .like("true")
          .means("strengths grow with the strain rate: in tension as Malvar and Ross say, in "
                 "compression as the CEB does"),
      number("largest_rate", &MaterialCard::largestRate)
          .onlyFor({"pseudo_cap"})
          .in("1/s")
          .above(0)
          .like("100")
          .means("strain rate from which rate_effects grow no more; tests go to about 300"),
      number("cohesive_factor", &MaterialCard::cohesiveFactor)
          .onlyFor({"hjc"})
          .needed()
          .in("-")
          .above(0)
          .like("0.79")
          .means("A, cohesive strength over fc"),
      number("pressure_factor", &MaterialCard::pressureFactor)
          .onlyFor({"hjc"})
          .needed()
          .in("-")
          .atLeast(0)
          .like("1.6")
          .means("B, of B p*^N"),
      number("pressure_exponent", &MaterialCard::pressureExponent)
          .onlyFor({"hjc"})
          .needed()
          .in("-")
          .above(0)
          .like("0.61")
          .means("N"),
      number("largest_strength", &MaterialCard::largestStrength)
          .onlyFor({"hjc"})
          .needed()
          .in("-")
          .above(0)
          .like("7")
          .means("Smax, over fc"),
      number("least_fracture_strain", &MaterialCard::leastFractureStrain)
          .onlyFor({"hjc"})
          .needed()
          .in("-")
          .above(0)
          .like("0.01")
          .means("EFmin"),
      number("damage_factor", &MaterialCard::damageFactor)
          .onlyFor({"hjc"})
          .needed()
          .in("-")
          .above(0)
          .like("0.04")
          .means("D1"),
      number("damage_exponent", &MaterialCard::damageExponent)
          .onlyFor({"hjc"})
          .in("-")
          .atLeast(0)
          .like("1.1")
          .means("D2"),
      number("crush_compression", &MaterialCard::crushCompression)
          .onlyFor({"hjc"})
          .needed()
          .in("-")
          .above(0)
          .like("0.001")
          .means("density over reference density - 1 at crush_pressure"),
      number("lock_pressure", &MaterialCard::lockPressure)
          .onlyFor({"hjc"})
          .needed()
          .in("Pa")
          .above(0)
          .like("800e6")
          .means("at which no pore is left"),
      number("lock_compression", &MaterialCard::lockCompression)
          .onlyFor({"hjc"})
          .needed()
          .in("-")
          .above(0)
          .like("0.1")
          .means("density over reference density - 1 of the locked material without pressure"),
      numbers("lock_moduli", &MaterialCard::lockModuli, 3)
          .onlyFor({"hjc"})
          .needed()
          .in("Pa")
          .like("[85e9, -171e9, 208e9]")
          .means("K1, K2, K3 of the locked pressure"),
  };
}

Key materialKeys()
{
  return named("materials", &Deck::materials, materialCardKeys())
      .decidedBy("model")
      .completedBy("set")
      .means("laws of the continuum, by a name of your choice; blocks may name sets of the library "
             "without a card here");
}
} // namespace coplane
