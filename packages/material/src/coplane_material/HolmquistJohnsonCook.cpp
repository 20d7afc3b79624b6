#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

#include <algorithm>

namespace coplane
{
HolmquistJohnsonCook completed(HolmquistJohnsonCook law)
{
  demand(law.strength > 0, "compressive strength", law.strength, "Pa", "positive");
  demand(law.tension > 0 && law.tension < law.strength, "tensile limit", law.tension, "Pa",
         "positive and below the compressive strength");
  demand(law.cohesion > 0, "cohesive strength A", law.cohesion, "", "positive");
  demand(law.pressureFactor >= 0, "pressure factor B", law.pressureFactor, "", "0 or more");
  demand(law.pressureExponent > 0, "pressure exponent N", law.pressureExponent, "", "positive");
  demand(law.rateFactor >= 0, "rate factor C", law.rateFactor, "", "0 or more");
  demand(law.mostStrength > 0, "largest strength Smax", law.mostStrength, "", "positive");
  demand(law.leastFracture > 0, "least fracture strain EFmin", law.leastFracture, "", "positive");
  demand(law.damage1 > 0, "damage constant D1", law.damage1, "", "positive");
  demand(law.crushPressure > 0 && law.crushPressure < law.lockPressure, "crush pressure",
         law.crushPressure, "Pa",
         fmt::format("positive and below the locking pressure, {} Pa", law.lockPressure));
  demand(law.crushCompression > 0 && law.crushCompression < law.lockCompression,
         "compression at crushing", law.crushCompression, "",
         fmt::format("positive and below that of the locked material, {}", law.lockCompression));
  demand(law.locked[0] > 0, "locked modulus K1", law.locked[0], "Pa", "positive");
  law.elastic.bulkModulus = law.crushPressure / law.crushCompression;
  // Where the locked curve reaches the locking pressure.
  const auto lack = [&](Real mu) { return law.lockPressure - law.lockedPressure(mu); };
  const Real low = law.lockCompression, high = low + 1;
  demand(lack(high) < 0, "locking pressure", law.lockPressure, "Pa",
         "reached by the locked curve K1 m + K2 m^2 + K3 m^3");
  law.fullCompression = branchFree::fallingRoot(lack, low, high, lack(low), lack(high),
                                                1e-12 * law.lockPressure, true);
  return law;
}
HolmquistJohnsonCook makeLaw(const HolmquistJohnsonCookParameters& p)
{
  HolmquistJohnsonCook law{};
  law.elastic = {p.density, 0, p.shearModulus};
  law.strength = p.compressiveStrength;
  law.cohesion = p.cohesiveFactor;
  law.pressureFactor = p.pressureFactor;
  law.pressureExponent = p.pressureExponent;
  law.rateFactor = p.rateFactor;
  law.mostStrength = p.largestStrength;
  law.tension = p.tensileStrength;
  law.leastFracture = p.leastFractureStrain;
  law.damage1 = p.damageFactor;
  law.damage2 = p.damageExponent;
  law.crushPressure = p.crushPressure;
  law.crushCompression = p.crushCompression;
  law.lockPressure = p.lockPressure;
  law.lockCompression = p.lockCompression;
  demand(p.lockModuli.size() == 3, "number of locked moduli", Real(p.lockModuli.size()), "", "3");
  std::copy(p.lockModuli.begin(), p.lockModuli.end(), law.locked);
  return completed(law);
}

MaterialModel HolmquistJohnsonCookParameters::model()
{
  using P = HolmquistJohnsonCookParameters;
  using namespace schema;
  return MaterialModelOf<P>("hjc", "concrete of Holmquist, Johnson and Cook")
      .costs(1.8)
      .has({
          schema::density<P>(),
          number("shear_modulus", &P::shearModulus)
              .needed()
              .in("Pa")
              .usually(usual::modulus)
              .elsewhere({"G"})
              .above(0)
              .like("14.86e9")
              .means("shear modulus G"),
          number("compressive_strength", &P::compressiveStrength)
              .needed()
              .in("Pa")
              .usually(usual::strength)
              .elsewhere({"fc"})
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
              .means("T, the limit of mean tension"),
          number("cohesive_factor", &P::cohesiveFactor)
              .needed()
              .in("-")
              .above(0)
              .like("0.79")
              .means("A, cohesive strength over fc"),
          number("pressure_factor", &P::pressureFactor)
              .needed()
              .in("-")
              .atLeast(0)
              .like("1.6")
              .means("B, of B p*^N"),
          number("pressure_exponent", &P::pressureExponent)
              .needed()
              .in("-")
              .above(0)
              .like("0.61")
              .means("N"),
          number("rate_factor", &P::rateFactor)
              .in("-")
              .atLeast(0)
              .like("0.014")
              .means("C, share by which strength grows with the logarithm of the rate over 1/s"),
          number("largest_strength", &P::largestStrength)
              .needed()
              .in("-")
              .above(0)
              .like("7")
              .means("Smax, over fc"),
          number("least_fracture_strain", &P::leastFractureStrain)
              .needed()
              .in("-")
              .above(0)
              .like("0.01")
              .means("EFmin"),
          number("damage_factor", &P::damageFactor)
              .needed()
              .in("-")
              .above(0)
              .like("0.04")
              .means("D1"),
          number("damage_exponent", &P::damageExponent).in("-").atLeast(0).like("1.1").means("D2"),
          number("crush_pressure", &P::crushPressure)
              .needed()
              .in("Pa")
              .above(0)
              .like("80e6")
              .means("from which pores close"),
          number("crush_compression", &P::crushCompression)
              .needed()
              .in("-")
              .above(0)
              .like("0.001")
              .means("density over reference density - 1 at crush_pressure"),
          number("lock_pressure", &P::lockPressure)
              .needed()
              .in("Pa")
              .above(0)
              .like("800e6")
              .means("at which no pore is left"),
          number("lock_compression", &P::lockCompression)
              .needed()
              .in("-")
              .above(0)
              .like("0.1")
              .means("density over reference density - 1 of the locked material without pressure"),
          numbers("lock_moduli", &P::lockModuli, 3)
              .needed()
              .in("Pa")
              .like("[85e9, -171e9, 208e9]")
              .means("K1, K2, K3 of the locked pressure"),
      })
      .comesAs(R"(
concrete_hjc_48: {model: hjc, density: 2440, shear_modulus: 14.86e9, compressive_strength: 48e6,
                  cohesive_factor: 0.79, pressure_factor: 1.6, pressure_exponent: 0.61,
                  rate_factor: 0.007, largest_strength: 7, tensile_strength: 4e6,
                  least_fracture_strain: 0.01, damage_factor: 0.04, damage_exponent: 1,
                  crush_pressure: 16e6, crush_compression: 0.001, lock_pressure: 800e6,
                  lock_compression: 0.1, lock_moduli: [85e9, -171e9, 208e9]}
)");
}
} // namespace coplane
