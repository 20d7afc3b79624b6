#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

namespace coplane
{
PseudoCapParameters concreteC40()
{
  PseudoCapParameters p;
  p.density = 2300;
  p.youngsModulus = 33e9;
  p.poissonRatio = 0.2;
  p.compressiveStrength = 40e6;
  p.tensileStrength = 4e6;
  p.fractureEnergy = 120;
  p.porosity = 0.08;
  p.grainModulus = 40e9;
  p.grainSlope = 1.5;
  p.crushPressure = 80e6;
  p.crushHardening = 300e6;
  p.capRatio = 0.5;
  p.shearCompaction = 2;
  return p;
}

PseudoCap makeLaw(const PseudoCapParameters& p)
{
  PseudoCap law{};
  law.elastic = makeLaw(static_cast<const ElasticParameters&>(p));
  demand(p.compressiveStrength > 0, "compressive strength", p.compressiveStrength, "Pa",
         "positive, e.g. 40e6");
  // From 0.2655 fc on, uniaxial tension would meet the fracture surface of no pressure.
  demand(p.tensileStrength > 0 && p.tensileStrength < p.compressiveStrength / 4, "tensile strength",
         p.tensileStrength, "Pa",
         fmt::format("between 0 and a quarter of the compressive strength ({:.6g} Pa)",
                     p.compressiveStrength / 4));
  demand(p.fractureEnergy > 0, "fracture energy", p.fractureEnergy, "J/m^2", "positive, e.g. 120");
  demand(p.porosity > 0 && p.porosity < 0.6, "porosity", p.porosity, "",
         "between 0 and 0.6; the law lives on its pores");
  demand(p.grainModulus > law.elastic.bulkModulus, "bulk modulus of the grains", p.grainModulus,
         "Pa",
         fmt::format("above that of the porous material, E / 3 (1 - 2 nu) = {:.6g} Pa",
                     law.elastic.bulkModulus));
  demand(p.grainSlope >= 0 && p.grainSlope < 3, "shock slope of the grains", p.grainSlope, "",
         "between 0 and 3, e.g. 1.5");
  demand(p.capRatio > 0 && p.capRatio < 1, "cap ratio", p.capRatio, "", "between 0 and 1");
  demand(p.crushPressure * p.capRatio >= p.compressiveStrength / 3, "crush pressure",
         p.crushPressure, "Pa",
         fmt::format("at least {:.6g} Pa, so that the cap is not reached in uniaxial compression "
                     "(cap ratio times crush pressure over a third of the strength)",
                     p.compressiveStrength / 3 / p.capRatio));
  demand(p.crushHardening > 0, "crush hardening", p.crushHardening, "Pa", "positive, e.g. 300e6");
  demand(p.shearCompaction >= 0, "shear compaction", p.shearCompaction, "", "0 or more");
  demand(p.largestRate >= 0 && std::isfinite(p.largestRate), "largest rate", p.largestRate, "1/s",
         "0 (up to the knees of the curves) or more, e.g. 300");
  demand(p.damageExponent >= 0 && p.damageExponent <= 4, "damage exponent", p.damageExponent, "",
         "between 0 and 4, e.g. 1.6");
  law.rates = p.rateEffects ? rateEffectOf(p.compressiveStrength, p.largestRate) : RateEffect{};
  law.strength = p.compressiveStrength;
  law.tensileStrength = p.tensileStrength;
  law.fractureEnergy = p.fractureEnergy;
  law.porosity = p.porosity;
  law.grainModulus = p.grainModulus;
  law.grainSlope = p.grainSlope;
  law.crushPressure = p.crushPressure;
  law.crushHardening = p.crushHardening;
  law.capRatio = p.capRatio;
  law.shearCompaction = p.shearCompaction;
  law.damageExponent = p.damageExponent;
  law.cracksClose = p.crackClosure;
  return law;
}

void PseudoCap::startFrom(const SymTensor& stress, Real* history) const
{
  const Real p = branchFree::larger(-meanOf(stress), -tensileStrength);
  const Real y = p > crushPressure ? (p - crushPressure) / crushHardening : 0;
  const Real compaction = fullCompaction() * (1 - std::exp(-branchFree::smaller(y, closedPores)));
  // ebar at which the material with that compaction has the pressure p.
  const auto lack = [&](Real strain) { return p - pressure(strain, compaction); };
  const Real low = -0.05, high = 1;
  const Real strain = p == 0 ? 0
                             : branchFree::fallingRoot(lack, low, high, lack(low), lack(high),
                                                       1e-14 * strength, true);
  history[Porosity] = porosityOf(compaction);
  history[Compaction] = compaction;
  history[Precompression] = strain;
}

namespace
{
void checkPseudoCap(const PseudoCapParameters& p, const CardPlace& card)
{
  if (card.gives("largest_rate") && !p.rateEffects)
    card.problem("largest_rate",
                 "has no effect without rate_effects: true; remove it or add that.");
}
} // namespace

MaterialModel PseudoCapParameters::model()
{
  using P = PseudoCapParameters;
  using namespace schema;
  return MaterialModelOf<P>("pseudo_cap", "concrete with a pseudo-cap")
      .costs(5.4)
      .has(elasticKeys<P>())
      .has({
          number("compressive_strength", &P::compressiveStrength)
              .needed()
              .in("Pa")
              .usually(usual::strength)
              .elsewhere({"fc", "fcm"})
              .above(0)
              .like("40e6")
              .means("fc, in uniaxial compression"),
          number("tensile_strength", &P::tensileStrength)
              .needed()
              .in("Pa")
              .usually(usual::strength)
              .elsewhere({"ft"})
              .above(0)
              .like("4e6")
              .means("ft, in uniaxial tension"),
          number("fracture_energy", &P::fractureEnergy)
              .needed()
              .in("J/m^2")
              .usually(usual::fractureEnergy)
              .elsewhere({"gf"})
              .above(0)
              .like("120")
              .means("G_F, per area of a crack"),
          number("porosity", &P::porosity)
              .needed()
              .in("-")
              .above(0)
              .below(0.6)
              .like("0.08")
              .means("share of pores at the start"),
          number("grain_modulus", &P::grainModulus)
              .needed()
              .in("Pa")
              .above(0)
              .like("40e9")
              .means("bulk modulus of the material without pores"),
          number("grain_slope", &P::grainSlope)
              .in("-")
              .atLeast(0)
              .below(3)
              .like("1.4")
              .means("s of the shock speed of the material without pores"),
          number("crush_pressure", &P::crushPressure)
              .needed()
              .in("Pa")
              .above(0)
              .like("80e6")
              .means("from which pores close"),
          number("crush_hardening", &P::crushHardening)
              .needed()
              .in("Pa")
              .above(0)
              .like("300e6")
              .means("growth of the crush pressure while the pores fall to 1/e"),
          number("cap_ratio", &P::capRatio)
              .in("-")
              .above(0)
              .below(1)
              .like("0.6")
              .means("share of the crush pressure from which shear compacts"),
          number("shear_compaction", &P::shearCompaction)
              .in("-")
              .atLeast(0)
              .like("1.5")
              .means("volume strain per plastic shear strain at the crush pressure"),
          number("damage_exponent", &P::damageExponent)
              .in("-")
              .atLeast(0)
              .atMost(4)
              .like("2")
              .means("b1: the larger, the less bulking under pressure damages, and the more "
                     "ductile is crushing"),
          flag("crack_closure", &P::crackClosure)
              .like("true")
              .means("cracks that close bear pressure again; false: what tension damaged is weak "
                     "under pressure, too"),
          flag("rate_effects", &P::rateEffects)
              .like("true")
              .means("strengths grow with the strain rate: in tension as Malvar and Ross say, in "
                     "compression as the CEB does"),
          number("largest_rate", &P::largestRate)
              .in("1/s")
              .above(0)
              .defaultIs("1 in tension, 30 in compression")
              .like("100")
              .means("strain rate from which rate_effects grow no more. Beyond 1/s in tension and "
                     "30/s in compression specimens show inertia, which elements have already"),
      })
      .demands(checkPseudoCap)
      .softensUpTo(elementThatCracks)
      .comesAs(R"(
concrete_c40: {model: pseudo_cap, density: 2300, youngs_modulus: 33e9, poisson_ratio: 0.2,
               compressive_strength: 40e6, tensile_strength: 4e6, fracture_energy: 120,
               porosity: 0.08, grain_modulus: 40e9, grain_slope: 1.5, crush_pressure: 80e6,
               crush_hardening: 300e6, cap_ratio: 0.5, shear_compaction: 2}
)");
}
} // namespace coplane
