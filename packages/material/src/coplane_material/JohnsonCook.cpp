#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

#include <algorithm>

namespace coplane
{
JohnsonCook checked(const JohnsonCook& law)
{
  demand(law.strength > 0, "strength A", law.strength, "Pa", "positive");
  demand(law.hardening >= 0, "hardening B", law.hardening, "Pa", "0 or more");
  demand(law.exponent > 0 && law.exponent <= 1, "hardening exponent n", law.exponent, "",
         "above 0 and at most 1");
  demand(law.rateFactor >= 0, "rate factor C", law.rateFactor, "", "0 or more");
  demand(law.thermalExponent > 0, "thermal exponent m", law.thermalExponent, "", "positive");
  demand(law.meltingTemperature == 0 || law.meltingTemperature > law.roomTemperature,
         "melting temperature", law.meltingTemperature, "K",
         fmt::format("above the room temperature, {} K", law.roomTemperature));
  demand(law.heatCapacity > 0, "heat capacity", law.heatCapacity, "J/(kg K)", "positive");
  demand(law.heatFraction >= 0 && law.heatFraction <= 1, "heat fraction", law.heatFraction, "",
         "between 0 and 1");
  return law;
}

JohnsonCook makeLaw(const JohnsonCookParameters& p)
{
  JohnsonCook law{};
  law.elastic = makeLaw(static_cast<const ElasticParameters&>(p));
  law.eos = equationOfState(p, p.density, law.elastic.bulkModulus);
  law.elastic = withPressureOf(law.eos, law.elastic);
  law.strength = p.yieldStress;
  law.hardening = p.hardeningModulus;
  law.exponent = p.hardeningExponent;
  law.rateFactor = p.rateFactor;
  law.thermalExponent = p.thermalExponent;
  law.meltingTemperature = p.meltingTemperature;
  law.roomTemperature = p.roomTemperature;
  law.heatCapacity = p.heatCapacity;
  law.heatFraction = p.heatFraction;
  demand(p.fracture.empty() || p.fracture.size() == 5, "number of fracture constants",
         Real(p.fracture.size()), "", "0 or 5");
  std::copy(p.fracture.begin(), p.fracture.end(), law.damage);
  return checked(law);
}

MaterialModel JohnsonCookParameters::model()
{
  using P = JohnsonCookParameters;
  using namespace schema;
  return MaterialModelOf<P>("johnson_cook", "Johnson and Cook")
      .costs(3.4)
      .has(elasticKeys<P>())
      .has({
          number("yield_stress", &P::yieldStress)
              .needed()
              .in("Pa")
              .usually(usual::strength)
              .elsewhere({"A", "sigy", "yield", "yield_strength"})
              .above(0)
              .like("792e6")
              .means("A, static yield stress at room temperature"),
          number("hardening_modulus", &P::hardeningModulus)
              .in("Pa")
              .atLeast(0)
              .like("510e6")
              .means("B, of the hardening B ep^n"),
          number("hardening_exponent", &P::hardeningExponent)
              .in("-")
              .above(0)
              .atMost(1)
              .like("0.26")
              .means("n"),
          number("rate_factor", &P::rateFactor)
              .in("-")
              .atLeast(0)
              .like("0.014")
              .means("C, share by which strength grows with the logarithm of the rate over 1/s"),
          number("thermal_exponent", &P::thermalExponent)
              .in("-")
              .above(0)
              .like("1.03")
              .means("m of the softening 1 - T*^m"),
          number("melting_temperature", &P::meltingTemperature)
              .in("K")
              .usually(usual::temperature)
              .atLeast(0)
              .like("1793")
              .means("at which strength is lost; 0: no thermal softening"),
          number("room_temperature", &P::roomTemperature)
              .in("K")
              .usually(usual::temperature)
              .above(0)
              .like("300")
              .means("at the start"),
          number("heat_capacity", &P::heatCapacity)
              .needed()
              .in("J/(kg K)")
              .above(0)
              .like("477")
              .means("specific heat"),
          number("heat_fraction", &P::heatFraction)
              .in("-")
              .atLeast(0)
              .atMost(1)
              .like("0.95")
              .means("of the plastic work that heats"),
          numbers("fracture", &P::fracture, 5)
              .in("-")
              .like("[0.05, 3.44, -2.12, 0.002, 0.61]")
              .means("D1 to D5 of the strain at fracture; none: it does not fracture"),
      })
      .has(equationOfStateKeys<P>())
      .demands(checkEquationOfState)
      .comesAs(R"(
steel_4340: {model: johnson_cook, density: 7830, youngs_modulus: 201e9, poisson_ratio: 0.3,
             yield_stress: 792e6, hardening_modulus: 510e6, hardening_exponent: 0.26,
             rate_factor: 0.014, thermal_exponent: 1.03, melting_temperature: 1793,
             heat_capacity: 477, fracture: [0.05, 3.44, -2.12, 0.002, 0.61],
             eos: mie_grueneisen, sound_speed: 4570, shock_slope: 1.49, grueneisen: 1.93}
copper_ofhc: {model: johnson_cook, density: 8960, youngs_modulus: 124e9, poisson_ratio: 0.34,
              yield_stress: 90e6, hardening_modulus: 292e6, hardening_exponent: 0.31,
              rate_factor: 0.025, thermal_exponent: 1.09, melting_temperature: 1356,
              heat_capacity: 383, fracture: [0.54, 4.89, -3.03, 0.014, 1.12],
              eos: mie_grueneisen, sound_speed: 3940, shock_slope: 1.489, grueneisen: 2.02}
iron_armco: {model: johnson_cook, density: 7890, youngs_modulus: 207e9, poisson_ratio: 0.29,
             yield_stress: 175e6, hardening_modulus: 380e6, hardening_exponent: 0.32,
             rate_factor: 0.06, thermal_exponent: 0.55, melting_temperature: 1811,
             heat_capacity: 452, fracture: [-2.2, 5.43, -0.47, 0.016, 0.63],
             eos: mie_grueneisen, sound_speed: 4570, shock_slope: 1.49, grueneisen: 1.93}
)");
}
} // namespace coplane
