#include "Laws.hpp"
#include "Paths.hpp"

#include <coplane_core/Error.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace coplane;
using namespace coplane::testing;

namespace
{
const Record nobody = [](const MaterialProbe&) {};

/// One step of uniaxial compression to the volume ratio J.
Mat3 squeeze(Real J)
{
  return Mat3{{{2 * (J - 1) / (J + 1), 0, 0}, {0, 0, 0}, {0, 0, 0}}};
}
} // namespace

TEST(EquationOfState, oneStepFromRestEndsOnTheShockLine)
{
  // The trapezoid of the energy over one step is the jump of Rankine and Hugoniot, e = p (V0 - V)
  // / 2. So without strength p = rho0 Us up at J = 1 - up / Us, Us = c0 + s up, for any up.
  const Material law = Fluid{{7850, steelShock().stiffness, 0}, steelShock()};
  for (const Real up : {100.0, 250.0, 500.0, 1500.0})
  {
    const Real Us = 4570 + 1.49 * up;
    MaterialProbe probe(law, 1);
    probe.advance(squeeze(1 - up / Us), 1e-6);
    EXPECT_NEAR(probe.pressure(), 7850 * Us * up, 1e-9 * 7850 * Us * up);
    EXPECT_NEAR(probe.energy(), 0.5 * 7850 * up * up, 1e-9 * 7850 * up * up);
  }
}

TEST(EquationOfState, strengthAddsToThePressureOfTheShock)
{
  // The deviator is 2/3 Y, its work heats too: p rises by Gamma0 times that work / (1 + ...).
  const Material law = makeHardeningPlasticity(
      withBulkModulus(makeLinearElastic(200e9, 0.3, 7850), steelShock().stiffness), steelShock(),
      {0}, {400e6}, 0);
  MaterialProbe probe(law, 1);
  const Real J = 1 - 500 / 5315.0;
  probe.advance(squeeze(J), 1e-6);
  const Real s = 2.0 / 3.0 * 400e6, work = 0.5 * s * (1 - J); // per reference volume
  const Real p = 7850 * 5315 * 500.0 + 1.93 * work / (1 - 0.5 * 1.93 * (1 - J));
  EXPECT_NEAR(probe.pressure(), p, 1e-9 * p);
  EXPECT_NEAR(-probe.stress().xx, p + s, 1e-9 * p);
}

TEST(EquationOfState, fluidReachesTheShockLineWithoutStrength)
{
  // Us = 4570 + 1.49 * 500 = 5315 m/s: p = rho Us up, J = 1 - up/Us.
  const Material law = makeFluid(7850, steelShock());
  MaterialProbe probe(law, 1);
  probe.advance(squeeze(1 - 500 / 5315.0), 1e-6);
  EXPECT_NEAR(probe.pressure(), 7850 * 5315 * 500.0, 1e-9 * 7850 * 5315 * 500.0);
  EXPECT_EQ(probe.vonMises(), 0);
  EXPECT_THROW(makeFluid(7850, {}), Error);
}

TEST(EquationOfState, idealGasFollowsItsAdiabatToTheSecondOrder)
{
  const Material law = makeLaw(IdealGasParameters{1.2, 1.4, 1e5});
  const auto error = [&](int steps)
  {
    MaterialProbe probe(law, 1, {-1e5, -1e5, -1e5, 0, 0, 0});
    for (int i = 1; i <= steps; ++i)
      probe.advance(squeeze((1 - 0.5 * i / steps) / probe.volumeRatio()), 1e-6);
    EXPECT_NEAR(probe.volumeRatio(), 0.5, 1e-12);
    EXPECT_NEAR(probe.stiffening(), 2 * 0.5 * probe.pressure() / 1e5, 1e-9 * 2); // g p / (g p0)
    return std::abs(probe.pressure() / (1e5 * std::pow(2.0, 1.4)) - 1);
  };
  const Real coarse = error(50), fine = error(100);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

TEST(EquationOfState, stiffeningIsTheSlopeOfTheIsentrope)
{
  for (const EquationOfState& eos : {steelShock(), porousShock()})
    for (const Real J : {1.02, 0.95, 0.8})
    {
      const Real K = eos.stiffness / eos.distension;
      const Material law = Fluid{{7850, K, 0}, eos};
      MaterialProbe probe(law, 1);
      probe.advance(squeeze(J), 1e-6);
      const Real p = probe.pressure(), tangent = probe.stiffening() * K;
      probe.advance(squeeze(1 + 1e-6), 1e-6); // expansion: pores stay as they are
      EXPECT_NEAR(-(probe.pressure() - p) / 1e-6, tangent, 1e-3 * tangent) << J;
    }
}

TEST(EquationOfState, poresCloseAlongTheCrushCurveAndStayClosed)
{
  const EquationOfState eos = porousShock();
  const Material law = Fluid{{4000, eos.stiffness / 2, 0}, eos};
  MaterialProbe probe(law, 1);
  int onCurve = 0;
  for (int i = 0; i < 60; ++i)
  {
    probe.advance(squeeze(0.99), 1e-6);
    const Real p = probe.pressure(), alpha = probe.history("distension");
    const Real share = (2e9 - p) / 1.8e9;
    if (p > 0.2e9 && p < 2e9)
    {
      EXPECT_NEAR(alpha, 1 + share * share, 1e-8);
      ++onCurve;
    }
    if (i == 20)
    {
      MaterialProbe back = probe; // unloading: alpha stays
      back.advance(squeeze(1.01), 1e-6);
      EXPECT_EQ(back.history("distension"), alpha);
      EXPECT_LT(back.pressure(), p);
    }
  }
  EXPECT_GT(onCurve, 20);
  strainPath(probe, {-0.9, 0, 0, 0, 0, 0}, 100, nobody);
  EXPECT_EQ(probe.history("distension"), 1); // solid
  EXPECT_GT(probe.pressure(), 2e9);
}

TEST(EquationOfState, initialStressIsKept)
{
  for (const NamedLaw& law : allLaws())
    if (law.name.find("Grueneisen") != std::string::npos || law.name == "j2PAlpha" ||
        law.name == "hjc" || law.name == "jh2" || law.name == "kcc" || law.name == "kccRates")
    {
      MaterialProbe probe(law.law, 0.1, {-3e6, -3e6, -3e6, 0, 0, 0});
      probe.advance(Mat3{}, 1e-6);
      EXPECT_NEAR(probe.pressure(), 3e6, 1e-3) << law.name;
    }
}

TEST(JohnsonCook, yieldStressHasTheRateAndTheTemperature)
{
  // Pure shear at 1e4 / s, 100 steps: the formula at the end, with the temperature before the step.
  const JohnsonCook law = steel4340();
  MaterialProbe probe(law, 1);
  Real strain = 0, temperature = 293;
  const Real dt = 1e-7;
  for (int i = 0; i < 200; ++i)
  {
    strain = probe.history("equivalent_plastic_strain");
    temperature = probe.history("temperature");
    probe.advance(Mat3{{{0, 1e-3, 0}, {1e-3, 0, 0}, {0, 0, 0}}}, dt);
  }
  const Real now = probe.history("equivalent_plastic_strain"), rate = (now - strain) / dt;
  EXPECT_NEAR(rate, 2 / std::sqrt(3.0) * 1e4, 0.01 * 1.15e4);
  const Real hot = (temperature - 293) / 1500;
  EXPECT_GT(hot, 0.02);
  const Real yield = (792e6 + 510e6 * std::pow(now, 0.26)) * (1 + 0.014 * std::log(rate)) *
                     (1 - std::pow(hot, 1.03));
  EXPECT_NEAR(probe.vonMises(), yield, 1e-9 * yield);
  // Heat: 0.9 of the plastic work.
  EXPECT_NEAR(probe.history("temperature") - 293, 0.9 * probe.dissipation() / (7830 * 477),
              1e-4); // dissipation is taken per volume in the middle of the step
}

TEST(JohnsonCook, slowFlowHasTheStaticStress)
{
  JohnsonCook law = steel4340();
  law.heatFraction = 0;
  MaterialProbe probe(law, 1);
  uniaxialStress(probe, 0.05, 100, nobody); // steps of a second: below the reference rate
  const Real ep = probe.history("equivalent_plastic_strain");
  EXPECT_NEAR(probe.stress().xx, 792e6 + 510e6 * std::pow(ep, 0.26), 1e-6 * 792e6);
}

TEST(JohnsonCook, fractureComesAtTheStrainOfItsTriaxiality)
{
  JohnsonCook law = steel4340();
  law.heatFraction = 0;
  law.rateFactor = 0;
  law.damage[3] = 0;
  // Pure shear: sigma* = 0, ep_f = D1 + D2 = 3.49. Uniaxial tension: sigma* = 1/3, ep_f = 0.05 +
  // 3.44 exp(-2.12 / 3) = 1.747.
  MaterialProbe shear(law, 1);
  Real last = 0;
  while (shear.vonMises() > 0 || shear.strain().xy == 0)
  {
    last = shear.history("equivalent_plastic_strain");
    shear.advance(Mat3{{{0, 2e-3, 0}, {2e-3, 0, 0}, {0, 0, 0}}}, 1e-3);
    ASSERT_LT(last, 5);
  }
  EXPECT_NEAR(last, 3.49, 5e-3);
  EXPECT_EQ(shear.history("damage"), 1);
  // Broken: bears pressure, no tension.
  shear.advance(Mat3{{{1e-3, 0, 0}, {0, 1e-3, 0}, {0, 0, 1e-3}}}, 1e-3);
  EXPECT_NEAR(shear.stress().xx, 0, 1e-6);

  MaterialProbe tension(law, 1);
  ProbeStep step;
  step.stressGiven = {false, true, true, false, false, false};
  step.value = {2e-3, 0, 0, 0, 0, 0};
  while (tension.history("damage") < 0.5)
    tension.advance(step);
  EXPECT_NEAR(tension.history("equivalent_plastic_strain"), 0.5 * 1.7470, 4e-3);
}

TEST(HolmquistJohnsonCook, intactUniaxialStrengthIsTwiceItsName)
{
  // Root of s = 0.79 + 1.6 (s / 3)^0.61: 2.0634, a known weakness of the set. Damage is kept away.
  HolmquistJohnsonCook law = concreteHjc48();
  law.damage1 = 1e9;
  MaterialProbe probe(law, 0.01);
  Real peak = 0;
  uniaxialStress(probe, -0.02, 2000,
                 [&](const MaterialProbe& p) { peak = std::max(peak, -p.stress().xx); });
  EXPECT_NEAR(peak / 48e6, 2.0634, 1e-4 * 2);
}

TEST(HolmquistJohnsonCook, hydrostatIsElasticCrushesAndLocks)
{
  const HolmquistJohnsonCook law = concreteHjc48();
  // The locked curve reaches plock at mu = 0.1 + 1.1 m, 85 m - 171 m^2 + 208 m^3 = 0.8 GPa.
  const Real m = (law.fullCompression - 0.1) / 1.1;
  EXPECT_NEAR(85e9 * m - 171e9 * m * m + 208e9 * m * m * m, 800e6, 1);
  EXPECT_NEAR(law.fullCompression, 0.11056, 1e-5);
  MaterialProbe probe(law, 0.01);
  const auto to = [&](Real mu)
  {
    const Real e = -std::log(1 + mu) / 3;
    strainPath(probe, {e, e, e, 0, 0, 0}, 2000, nobody);
    return probe.pressure();
  };
  EXPECT_NEAR(to(0.0005), 8e6, 1e3);
  EXPECT_NEAR(to(0.001), 16e6, 1e3);
  const Real slope = 784e6 / (law.fullCompression - 0.001);
  EXPECT_NEAR(to(0.05), 16e6 + slope * 0.049, 1e5);
  // Back by the modulus between: share 0.049 / (full - 0.001).
  const Real share = 0.049 / (law.fullCompression - 0.001);
  const Real back = 16e9 + share * (800e6 / (law.fullCompression - 0.1) - 16e9);
  EXPECT_NEAR(to(0.049), 16e6 + slope * 0.049 - back * 0.001, 1e5);
  EXPECT_NEAR(to(0.05), 16e6 + slope * 0.049, 1e5);
  EXPECT_GT(probe.history("damage"), 0); // lost pores count
  to(0.15);
  const Real n = 0.05 / 1.1;
  EXPECT_NEAR(probe.pressure(), 85e9 * n - 171e9 * n * n + 208e9 * n * n * n, 1e6);
  EXPECT_NEAR(to(0.1), 0, 2e5); // locked: all the way back to mulock
}

TEST(HolmquistJohnsonCook, tensionEndsAtItsLimitWhichFallsWithDamage)
{
  const Material law = concreteHjc48();
  MaterialProbe probe(law, 0.01);
  strainPath(probe, {1e-3, 1e-3, 1e-3, 0, 0, 0}, 100, nobody);
  EXPECT_NEAR(probe.pressure(), -4e6, 1);
  MaterialProbe crushed(law, 0.01);
  strainPath(crushed, {-0.02, 0, 0, 0, 0, 0}, 100, nobody);
  const Real damage = crushed.history("damage");
  EXPECT_GT(damage, 0.1);
  EXPECT_LT(damage, 1);
  strainPath(crushed, {0.02, 0.02, 0.02, 0, 0, 0}, 100, nobody);
  EXPECT_NEAR(crushed.pressure(), -4e6 * (1 - crushed.history("damage")), 4e6 * 0.05);
}

TEST(HolmquistJohnsonCook, workThatIsNotStoredIsLost)
{
  // Torn: no stress is left.
  for (const int steps : {50, 200, 4000})
  {
    MaterialProbe torn(concreteHjc48(), 0.01);
    strainPath(torn, {0.02, 0, 0, 0, 0, 0}, steps, nobody);
    ASSERT_EQ(torn.history("damage"), 1);
    ASSERT_NEAR(torn.vonMises() + torn.pressure(), 0, 1);
    EXPECT_NEAR(torn.dissipation(), torn.energy(), (steps < 100 ? 0.02 : 0.001) * torn.energy())
        << steps;
  }
  // Pores close, up to the locked curve and beyond, and all pressure is taken off again.
  for (const Real volume : {0.02, 0.05, 0.1, 0.15})
  {
    MaterialProbe crushed(concreteHjc48(), 0.01);
    const Real e = -volume / 3;
    strainPath(crushed, {e, e, e, 0, 0, 0}, 2000, nobody);
    const Real lost = crushed.dissipation();
    for (Real back = e; crushed.pressure() > 0; back += 1e-6)
      strainPath(crushed, {back, back, back, 0, 0, 0}, 1, nobody);
    EXPECT_NEAR(crushed.dissipation(), lost, 1e-12 * lost);
    EXPECT_NEAR(lost, crushed.energy(), 0.01 * crushed.energy()) << volume;
  }
}

TEST(HolmquistJohnsonCook, badParametersAreRefused)
{
  HolmquistJohnsonCook law = concreteHjc48();
  law.strength = -48e6;
  EXPECT_THROW(completed(law), Error);
  law = concreteHjc48();
  law.tension = 60e6;
  EXPECT_THROW(completed(law), Error);
  law = concreteHjc48();
  law.crushPressure = 900e6;
  EXPECT_THROW(completed(law), Error);
}
