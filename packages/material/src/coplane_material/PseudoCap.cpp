#include <coplane_material/Demand.hpp>
#include <coplane_material/Material.hpp>

namespace coplane
{
PseudoCapParameters concreteC40()
{
  return {2300, 33e9, 0.2, 40e6, 4e6, 120, 0.08, 40e9, 1.5, 80e6, 300e6, 0.5, 2, 0};
}

PseudoCap makePseudoCap(const PseudoCapParameters& p)
{
  PseudoCap law{};
  law.elastic = makeLinearElastic(p.youngsModulus, p.poissonRatio, p.density);
  demand(p.strength > 0, "compressive strength", p.strength, "Pa", "positive, e.g. 40e6");
  demand(
      p.tensileStrength > 0 && p.tensileStrength < p.strength / 3, "tensile strength",
      p.tensileStrength, "Pa",
      fmt::format("between 0 and a third of the compressive strength ({:.6g} Pa)", p.strength / 3));
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
  demand(p.crushPressure * p.capRatio >= p.strength / 3, "crush pressure", p.crushPressure, "Pa",
         fmt::format("at least {:.6g} Pa, so that the cap is not reached in uniaxial compression "
                     "(cap ratio times crush pressure over a third of the strength)",
                     p.strength / 3 / p.capRatio));
  demand(p.crushHardening > 0, "crush hardening", p.crushHardening, "Pa", "positive, e.g. 300e6");
  demand(p.shearCompaction >= 0, "shear compaction", p.shearCompaction, "", "0 or more");
  demand(p.largestRate >= 0 && std::isfinite(p.largestRate), "largest rate", p.largestRate, "1/s",
         "0 (no effect of rates) or more, e.g. 300");
  law.rates = rateEffectOf(p.strength, p.largestRate);
  law.strength = p.strength;
  law.tensileStrength = p.tensileStrength;
  law.fractureEnergy = p.fractureEnergy;
  law.porosity = p.porosity;
  law.grainModulus = p.grainModulus;
  law.grainSlope = p.grainSlope;
  law.crushPressure = p.crushPressure;
  law.crushHardening = p.crushHardening;
  law.capRatio = p.capRatio;
  law.shearCompaction = p.shearCompaction;
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
} // namespace coplane
