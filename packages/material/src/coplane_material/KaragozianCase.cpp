#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

namespace coplane
{
namespace
{
constexpr Real psi = 6894.757293; // [Pa]

// Of the concrete of 6580 psi to which the source fits its numbers, in psi.
constexpr Real publishedModulus = 2.26650998e6;
constexpr Real publishedPressures[KaragozianCase::tableSize] = {0,
                                                                3.39976496e3,
                                                                7.41148762e3,
                                                                1.18991774e4,
                                                                2.26084370e4,
                                                                3.40996426e4,
                                                                4.83786555e4,
                                                                7.40128833e4,
                                                                4.32110127e5,
                                                                6.60914309e5};
constexpr Real publishedModuli[KaragozianCase::tableSize] = {
    2.26650998e6, 2.26650998e6, 2.29824112e6, 2.41383313e6, 2.87166814e6,
    3.33176967e6, 3.78960468e6, 4.13638071e6, 9.30628996e6, 1.13325499e7};

const KaragozianCase table{}; // of eta

/// b2 of concrete with grains of 12.7 mm, whose bands are 38.1 mm wide.
Real tensileExponentOf(Real strength)
{
  const Real width = 1.5, kips = strength / psi / 1000; // inch, ksi
  return (0.09 * width * width - 0.98 * width + 3.06) *
         (1 - 0.004 * kips * kips + 0.097 * kips - 0.484);
}

/// Stress in uniaxial tension over ft when the share eta is left: the deviator is on the line of
/// tension, at a pressure of minus a third of the stress.
Real tensionAt(Real share)
{
  return 1.5 * share / (1 + 0.5 * share);
}

/// What uniaxial tension dissipates while lambda runs over its table [ft].
Real tensionWork(Real exponent)
{
  Real work = KaragozianCase::peakMeasure * std::pow(2.0 / 3, exponent);
  const int steps = 1000; // midpoints
  for (int i = 5; i < KaragozianCase::softeningSize - 1; ++i)
  {
    const Real from = table.shares[i - 1], to = table.shares[i];
    const Real width = table.measures[i] - table.measures[i - 1];
    for (int k = 0; k < steps; ++k)
    {
      const Real stress = tensionAt(from + (to - from) * (k + 0.5) / steps);
      work += width / steps * stress * std::pow(1 - stress / 3, exponent);
    }
  }
  return work;
}

/// Steepest fall of the stress per plastic strain in uniaxial tension without the factor of size
/// [ft].
Real steepestFall(Real exponent)
{
  Real most = 0;
  for (int i = 5; i < KaragozianCase::softeningSize - 1; ++i)
  {
    const Real from = table.shares[i - 1], to = table.shares[i];
    const Real fall = (from - to) / (table.measures[i] - table.measures[i - 1]);
    for (const Real share : {from, to})
    {
      const Real slope = 1.5 / ((1 + 0.5 * share) * (1 + 0.5 * share));
      most = std::max(most, fall * slope * std::pow(1 - tensionAt(share) / 3, -exponent));
    }
  }
  return most;
}

SofteningLimit largestElement(const KaragozianCaseParameters& given)
{
  const KaragozianCaseParameters p = completed(given);
  const Real exponent = tensileExponentOf(p.compressiveStrength);
  return {
      p.youngsModulus * p.fractureEnergy /
          (p.tensileStrength * p.tensileStrength * tensionWork(exponent) * steepestFall(exponent)),
      "fracture_energy", "tensile_strength"};
}

void checkKaragozianCase(const KaragozianCaseParameters& p, const CardPlace& card)
{
  if (card.gives("largest_rate") && !p.rateEffects)
    card.problem("largest_rate",
                 "has no effect without rate_effects: true; remove it or add that.");
}
} // namespace

KaragozianCaseParameters completed(KaragozianCaseParameters p)
{
  const Real root = psi * std::sqrt(p.compressiveStrength / psi);
  if (p.youngsModulus == 0)
    p.youngsModulus = 57000 * root;
  if (p.tensileStrength == 0)
    p.tensileStrength = 6.7 * root;
  if (p.fractureEnergy == 0)
    p.fractureEnergy = 73 * std::pow(p.compressiveStrength / 1e6, 0.18);
  return p;
}

KaragozianCase makeLaw(const KaragozianCaseParameters& given)
{
  demand(given.compressiveStrength >= 15e6 && given.compressiveStrength <= 150e6,
         "compressive strength", given.compressiveStrength, "Pa",
         "between 15e6 and 150e6, for which the rules hold");
  const KaragozianCaseParameters p = completed(given);
  // From 0.168 fc on, uniaxial tension would meet the surface of first yield.
  const Real most = 0.16 * p.compressiveStrength;
  demand(p.tensileStrength > 0 && p.tensileStrength < most, "tensile strength", p.tensileStrength,
         "Pa", fmt::format("between 0 and 0.16 of the compressive strength ({:.6g} Pa)", most));
  demand(p.fractureEnergy > 0, "fracture energy", p.fractureEnergy, "J/m^2", "positive, e.g. 120");
  demand(p.largestRate >= 0 && std::isfinite(p.largestRate), "largest rate", p.largestRate, "1/s",
         "0 (up to the knees of the curves) or more, e.g. 300");
  KaragozianCase law{};
  law.elastic = makeLinearElastic(p.youngsModulus, p.poissonRatio, p.density);
  law.surfaces = {p.compressiveStrength, p.tensileStrength};
  law.tensileExponent = tensileExponentOf(p.compressiveStrength);
  law.softeningGrowth = p.tensileStrength * tensionWork(law.tensileExponent) / p.fractureEnergy;
  law.rates = p.rateEffects ? rateEffectOf(p.compressiveStrength, p.largestRate) : RateEffect{};
  const Real scale = law.elastic.bulkModulus / publishedModulus;
  for (int i = 0; i < KaragozianCase::tableSize; ++i)
  {
    law.pressures[i] = scale * publishedPressures[i];
    law.moduli[i] = scale * publishedModuli[i];
  }
  return law;
}

void KaragozianCase::startFrom(const SymTensor& stress, Real* history) const
{
  const Real p = branchFree::larger(-meanOf(stress), -surfaces.tensileStrength);
  const auto lack = [&](Real compression) { return p - pressureAt(compression); };
  const Real far = 10;
  const Real compression = p <= 0 ? p / elastic.bulkModulus
                                  : branchFree::fallingRoot(lack, Real(0), far, p, lack(far),
                                                            1e-14 * surfaces.strength, true);
  history[Compression] = branchFree::positivePart(compression);
  history[Precompression] = compression;
}

MaterialModel KaragozianCaseParameters::model()
{
  using P = KaragozianCaseParameters;
  using namespace schema;
  return MaterialModelOf<P>("kcc", "concrete of Karagozian and Case, release III")
      .elsewhere({"concrete_damage_rel3", "mat_072r3", "karagozian_case", "kc_concrete"})
      .costs(4)
      .has({
          schema::density<P>(),
          number("compressive_strength", &P::compressiveStrength)
              .needed()
              .in("Pa")
              .usually(usual::strength)
              .elsewhere({"fc", "fcm"})
              .atLeast(15e6)
              .atMost(150e6)
              .like("40e6")
              .means("fc, in uniaxial compression; what is not given follows from it"),
          number("youngs_modulus", &P::youngsModulus)
              .in("Pa")
              .elsewhere({"E", "young", "elastic_modulus", "modulus", "Emod"})
              .atLeast(0)
              .like("33e9")
              .means("Young's modulus; 0: 57000 sqrt(fc) in psi, 4.73e9 sqrt(fc / MPa)"),
          number("poisson_ratio", &P::poissonRatio)
              .in("-")
              .usually(usual::poisson)
              .elsewhere({"nu", "pr", "poisson", "poissons_ratio"})
              .above(-1)
              .below(0.5)
              .like("0.2")
              .means("Poisson's ratio"),
          number("tensile_strength", &P::tensileStrength)
              .in("Pa")
              .elsewhere({"ft"})
              .atLeast(0)
              .like("4e6")
              .means("ft, in uniaxial tension; 0: 6.7 sqrt(fc) in psi, 0.556e6 sqrt(fc / MPa)"),
          number("fracture_energy", &P::fractureEnergy)
              .in("J/m^2")
              .elsewhere({"gf"})
              .atLeast(0)
              .like("120")
              .means("G_F, per area of a crack; 0: 73 (fc / MPa)^0.18"),
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
      .demands(checkKaragozianCase)
      .softensUpTo(largestElement)
      .comesAs(R"(
concrete_kcc_45: {model: kcc, density: 2300, compressive_strength: 45.4e6}
)");
}
} // namespace coplane
