#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

namespace coplane
{
JohnsonHolmquist makeLaw(const JohnsonHolmquistParameters& p)
{
  demand(p.bulkModuli.size() == 3, "number of bulk moduli", Real(p.bulkModuli.size()), "", "3");
  demand(p.bulkModuli[0] > 0, "bulk modulus K1", p.bulkModuli[0], "Pa", "positive");
  demand(p.elasticLimitPressure > 0 && p.elasticLimitPressure < p.elasticLimit,
         "pressure at the Hugoniot elastic limit", p.elasticLimitPressure, "Pa",
         fmt::format("positive and below the limit itself, {:.6g} Pa", p.elasticLimit));
  demand(p.tensileStrength > 0 && p.tensileStrength < p.elasticLimitPressure, "tensile limit",
         p.tensileStrength, "Pa",
         fmt::format("positive and below the pressure at the Hugoniot elastic limit, {:.6g} Pa",
                     p.elasticLimitPressure));
  demand(p.intactFactor > 0, "intact factor A", p.intactFactor, "", "positive");
  demand(p.intactExponent > 0, "intact exponent N", p.intactExponent, "", "positive");
  demand(p.fracturedFactor >= 0, "fractured factor B", p.fracturedFactor, "", "0 or more");
  demand(p.fracturedExponent > 0, "fractured exponent M", p.fracturedExponent, "", "positive");
  demand(p.largestFractured >= 0, "largest fractured strength", p.largestFractured, "",
         "0 or more");
  demand(p.rateFactor >= 0, "rate factor C", p.rateFactor, "", "0 or more");
  demand(p.referenceRate > 0, "reference rate", p.referenceRate, "1/s", "positive");
  demand(p.damageFactor >= 0, "damage factor D1", p.damageFactor, "", "0 or more");
  demand(p.damageExponent >= 0, "damage exponent D2", p.damageExponent, "", "0 or more");
  demand(p.leastFractureStrain > 0, "least fracture strain", p.leastFractureStrain, "",
         "positive, e.g. 1e-6");
  demand(p.bulkingFraction >= 0 && p.bulkingFraction <= 1, "bulking fraction", p.bulkingFraction,
         "", "between 0 and 1");
  JohnsonHolmquist law{};
  law.elastic = {p.density, p.bulkModuli[0], p.shearModulus};
  law.secondModulus = p.bulkModuli[1];
  law.thirdModulus = p.bulkModuli[2];
  law.strengthAtLimit = 1.5 * (p.elasticLimit - p.elasticLimitPressure);
  law.pressureAtLimit = p.elasticLimitPressure;
  law.tension = p.tensileStrength;
  law.intactFactor = p.intactFactor;
  law.intactExponent = p.intactExponent;
  law.fracturedFactor = p.fracturedFactor;
  law.fracturedExponent = p.fracturedExponent;
  law.mostFractured = p.largestFractured;
  law.rateFactor = p.rateFactor;
  law.referenceRate = p.referenceRate;
  law.damageFactor = p.damageFactor;
  law.damageExponent = p.damageExponent;
  law.leastFracture = p.leastFractureStrain;
  law.bulking = p.bulkingFraction;
  return law;
}

MaterialModel JohnsonHolmquistParameters::model()
{
  using P = JohnsonHolmquistParameters;
  using namespace schema;
  return MaterialModelOf<P>("jh2", "ceramics and rock of Johnson and Holmquist")
      .elsewhere({"johnson_holmquist", "johnson_holmquist_ceramics", "john_holm"})
      .costs(1.8)
      .has({
          schema::density<P>(),
          number("shear_modulus", &P::shearModulus)
              .needed()
              .in("Pa")
              .usually(usual::modulus)
              .elsewhere({"G"})
              .above(0)
              .like("90.16e9")
              .means("shear modulus G"),
          numbers("bulk_moduli", &P::bulkModuli, 3)
              .needed()
              .in("Pa")
              .like("[130.95e9, 0, 0]")
              .means("K1, K2, K3 of the pressure K1 mu + K2 mu^2 + K3 mu^3, mu the density over "
                     "the reference density - 1"),
          number("elastic_limit", &P::elasticLimit)
              .needed()
              .in("Pa")
              .elsewhere({"HEL", "hel"})
              .above(0)
              .like("2.79e9")
              .means("HEL, axial stress at the Hugoniot elastic limit"),
          number("elastic_limit_pressure", &P::elasticLimitPressure)
              .needed()
              .in("Pa")
              .elsewhere({"PHEL", "phel"})
              .above(0)
              .like("1.46e9")
              .means("PHEL, pressure there; strengths are over 3/2 (HEL - PHEL)"),
          number("tensile_strength", &P::tensileStrength)
              .needed()
              .in("Pa")
              .usually(usual::strength)
              .elsewhere({"T"})
              .above(0)
              .like("0.2e9")
              .means("T, the limit of mean tension"),
          number("intact_factor", &P::intactFactor)
              .needed()
              .in("-")
              .above(0)
              .like("0.93")
              .means("A, of the intact strength A (p* + T*)^N"),
          number("intact_exponent", &P::intactExponent)
              .needed()
              .in("-")
              .above(0)
              .like("0.6")
              .means("N"),
          number("fractured_factor", &P::fracturedFactor)
              .in("-")
              .atLeast(0)
              .like("0.31")
              .means("B, of the fractured strength B p*^M; 0: none"),
          number("fractured_exponent", &P::fracturedExponent)
              .in("-")
              .above(0)
              .like("0.6")
              .means("M"),
          number("largest_fractured_strength", &P::largestFractured)
              .in("-")
              .atLeast(0)
              .like("0.8")
              .means("SFmax, over 3/2 (HEL - PHEL)"),
          number("rate_factor", &P::rateFactor)
              .in("-")
              .atLeast(0)
              .like("0.007")
              .means("C, share by which strengths grow with the logarithm of the rate over "
                     "reference_rate"),
          number("reference_rate", &P::referenceRate)
              .in("1/s")
              .above(0)
              .like("0.1")
              .means("strain rate up to which rate_factor has no effect"),
          number("damage_factor", &P::damageFactor)
              .needed()
              .in("-")
              .atLeast(0)
              .like("0.005")
              .means("D1, of the plastic strain to fracture D1 (p* + T*)^D2; 0: at once"),
          number("damage_exponent", &P::damageExponent).in("-").atLeast(0).like("0.7").means("D2"),
          number("least_fracture_strain", &P::leastFractureStrain)
              .in("-")
              .above(0)
              .like("1e-4")
              .means("the plastic strain to fracture is no less, whatever the pressure"),
          number("bulking_fraction", &P::bulkingFraction)
              .in("-")
              .atLeast(0)
              .atMost(1)
              .like("0.5")
              .means("beta, of the elastic energy that damage takes of shear: it goes into "
                     "pressure"),
      })
      .comesAs(R"(
ceramic_jh2: {model: jh2, density: 3700, shear_modulus: 90.16e9, bulk_moduli: [130.95e9, 0, 0],
              elastic_limit: 2.7933333333e9, elastic_limit_pressure: 1.46e9, tensile_strength: 0.2e9,
              intact_factor: 0.93, intact_exponent: 0.6, fractured_factor: 0.31,
              fractured_exponent: 0.6, damage_factor: 0.005}
)");
}
} // namespace coplane
