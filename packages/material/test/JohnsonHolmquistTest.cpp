#include "Laws.hpp"
#include "Paths.hpp"

#include <coplane_core/Error.hpp>

#include <gtest/gtest.h>

#include <cmath>

// The ceramic of the one-element tests of Johnson and Holmquist (1994), and the sandstone of
// Baranowski, Kucewicz and Janiszewski (2024), which has all of the law's parameters.

using namespace coplane;
using namespace coplane::testing;

namespace
{
constexpr Real gigapascal = 1e9;
const auto unrecorded = [](const MaterialProbe&) {};

JohnsonHolmquistParameters sandstone()
{
  JohnsonHolmquistParameters p;
  p.density = 2350;
  p.shearModulus = 2.686e9;
  p.bulkModuli = {3.7356e9, 9e9, 22e9};
  p.elasticLimit = 1.982e9;
  p.elasticLimitPressure = 1.374e9;
  p.tensileStrength = 8e6;
  p.intactFactor = 0.71;
  p.intactExponent = 0.55;
  p.fracturedFactor = 0.3;
  p.fracturedExponent = 0.4;
  p.largestFractured = 0.25;
  p.rateFactor = 0.022;
  p.damageFactor = 0.002;
  p.damageExponent = 1.2;
  return p;
}

/// Cases A, B and C: no strength when fractured, at once or by and by; and with some.
JohnsonHolmquistParameters ceramic(char which)
{
  JohnsonHolmquistParameters p = ceramicJh2();
  if (which != 'C')
    p.fracturedFactor = 0;
  if (which == 'A')
    p.damageFactor = 0;
  return p;
}

/// Largest axial stress on a path with constant stress on the sides.
Real peakOf(const Material& law, Real strain, Real lateral)
{
  MaterialProbe probe(law, 0.01);
  if (lateral != 0)
  {
    ProbeStep step;
    step.stressGiven.fill(true);
    step.value = {lateral, lateral, lateral, 0, 0, 0};
    probe.advance(step);
  }
  Real peak = 0;
  ProbeStep step;
  step.stressGiven = {false, true, true, false, false, false};
  step.value = {strain / 4000, lateral, lateral, 0, 0, 0};
  try
  {
    while (probe.history("damage") < 1 && std::abs(probe.strain().xx) < std::abs(strain))
    {
      probe.advance(step);
      peak = std::max(peak, std::abs(probe.stress().xx));
    }
    EXPECT_EQ(probe.history("damage"), 1);
  }
  catch (const Error&)
  {
    // It breaks in one step, and then no strain gives the stress on the sides.
  }
  return peak;
}
} // namespace

TEST(JohnsonHolmquist, bulkingPressuresOfTheOneElementTestsAreThePublishedOnes)
{
  // Uniaxial strain of 5 % of the length and back: published 0.56, 0.72 and 0.65 GPa.
  for (const auto& [which, published] : {std::pair{'A', 0.56}, {'B', 0.72}, {'C', 0.65}})
  {
    MaterialProbe probe(makeLaw(ceramic(which)), 1);
    strainPath(probe, {std::log(0.95), 0, 0, 0, 0, 0}, 5000, unrecorded);
    EXPECT_EQ(probe.history("damage"), 1) << which;
    strainPath(probe, {}, 5000, unrecorded);
    EXPECT_NEAR(probe.history("bulking_pressure") / gigapascal, published, 0.006) << which;
    EXPECT_NEAR(probe.pressure(), probe.history("bulking_pressure"), 1) << which;
  }
}

TEST(JohnsonHolmquist, instantFractureTurnsTheShearEnergyIntoPressure)
{
  // Case A: yields at q = sigmaHEL A ((p + T) / PHEL)^N on the elastic line q = 2 G eps,
  // p = K (1/J - 1); then q^2 / 6G is in the pressure, (p + dp)^2 - p^2 = 2 K q^2 / 6G.
  MaterialProbe probe(makeLaw(ceramic('A')), 1);
  Real q = 0, p = 0;
  ProbeStep step;
  step.value = {-1e-6, 0, 0, 0, 0, 0};
  while (probe.history("damage") == 0)
  {
    q = probe.vonMises();
    p = probe.pressure();
    probe.advance(step);
  }
  EXPECT_NEAR(q, 2e9 * 0.93 * std::pow((p + 0.2e9) / 1.46e9, 0.6), 1e-4 * q);
  EXPECT_NEAR(p, 130.95e9 * std::expm1(q / (2 * 90.16e9)), 1e-3 * p);
  EXPECT_EQ(probe.history("damage"), 1);
  EXPECT_EQ(probe.vonMises(), 0);
  const Real raised = std::sqrt(p * p + 130.95e9 * q * q / (3 * 90.16e9)) - p;
  EXPECT_NEAR(probe.history("bulking_pressure"), raised, 1e-3 * raised);
  // All of it is in the pressure: nothing is lost yet but what flowed in one step.
  EXPECT_NEAR(probe.dissipation(), 0, 1e-3 * q * q / (6 * 90.16e9));
}

TEST(JohnsonHolmquist, withoutBulkingTheShearEnergyIsLost)
{
  JohnsonHolmquistParameters dry = ceramic('A');
  dry.bulkingFraction = 0;
  MaterialProbe probe(makeLaw(dry), 1);
  Real q = 0;
  ProbeStep step;
  step.value = {-1e-6, 0, 0, 0, 0, 0};
  while (probe.history("damage") == 0)
  {
    q = probe.vonMises();
    probe.advance(step);
  }
  EXPECT_EQ(probe.history("bulking_pressure"), 0);
  const Real perReference = probe.volumeRatio() * q * q / (6 * 90.16e9);
  EXPECT_NEAR(probe.dissipation(), perReference, 1e-3 * perReference);
}

TEST(JohnsonHolmquist, strengthsOfSandstoneAreTheIntersectionsWithTheIntactSurface)
{
  // 90.000 and 17.932 MPa in compression and tension, 119.886, 138.380 and 158.049 MPa axially
  // under 10, 17 and 25 MPa: roots of q = sigmaHEL A ((p + T) / PHEL)^N.
  const Material law = makeLaw(sandstone());
  EXPECT_NEAR(peakOf(law, -0.02, 0) / 1e6, 90.000, 0.05);
  EXPECT_NEAR(peakOf(law, 0.01, 0) / 1e6, 17.932, 0.05);
  EXPECT_NEAR(peakOf(law, -0.03, -10e6) / 1e6, 119.886, 0.06);
  EXPECT_NEAR(peakOf(law, -0.03, -17e6) / 1e6, 138.380, 0.07);
  EXPECT_NEAR(peakOf(law, -0.03, -25e6) / 1e6, 158.049, 0.08);
}

TEST(JohnsonHolmquist, fracturedStrengthIsThatOfItsPressureUpToItsLargest)
{
  // Sheared for long at a volume that is held: D = 1 and q = sigmaHEL min(B p*^M, SFmax).
  const JohnsonHolmquist law = makeLaw(sandstone());
  for (const Real volume : {0.02, 0.1, 0.4})
  {
    MaterialProbe probe(law, 0.01);
    strainPath(probe, {-volume / 3, -volume / 3, -volume / 3, 0, 0, 0}, 200, unrecorded);
    strainPath(probe, {-volume / 3, -volume / 3, -volume / 3, 0.2, 0, 0}, 4000, unrecorded);
    const Real p = probe.pressure(), most = 912e6 * 0.25;
    const Real expected = std::min(912e6 * 0.3 * std::pow(p / 1374e6, 0.4), most);
    EXPECT_EQ(probe.history("damage"), 1);
    EXPECT_NEAR(probe.vonMises(), expected, 1e-9 * expected);
    EXPECT_EQ(expected == most, volume > 0.2) << p;
    // The pressure is that of the volume and bulking.
    const Real mu = 1 / probe.volumeRatio() - 1;
    EXPECT_NEAR(
        p, 3.7356e9 * mu + 9e9 * mu * mu + 22e9 * mu * mu * mu + probe.history("bulking_pressure"),
        1e-6 * p);
  }
}

TEST(JohnsonHolmquist, damageIsPlasticStrainOverDuctility)
{
  // Case C, small steps at constant volume: dD = dep' / (D1 (p* + T*)), where dep' is the flow to
  // the surface of the damage before; what damage takes of the surface is flow, too.
  const JohnsonHolmquist law = makeLaw(ceramic('C'));
  MaterialProbe probe(law, 0.01);
  strainPath(probe, {-0.01, -0.01, -0.01, 0, 0, 0}, 100, unrecorded);
  ProbeStep step;
  step.value = {0, 0, 0, 1e-4, 0, 0};
  int grown = 0;
  for (int i = 0; i < 300; ++i)
  {
    const Real damage = probe.history("damage"), p = probe.pressure();
    const Real flowed = probe.history("equivalent_plastic_strain");
    probe.advance(step);
    if (probe.history("damage") == damage || probe.history("damage") == 1)
      continue;
    ++grown;
    const Real dD = probe.history("damage") - damage;
    const Real lost = (law.intactStrength(p, 1.0) - law.fracturedStrength(p, 1.0)) * dD;
    const Real flow = probe.history("equivalent_plastic_strain") - flowed - lost / (3 * 90.16e9);
    EXPECT_NEAR(dD, flow / (0.005 * (p + 0.2e9) / 1.46e9), 1e-9);
  }
  EXPECT_GT(grown, 50);
}

TEST(JohnsonHolmquist, meanTensionEndsAtItsLimitAndAtNothingWhenFractured)
{
  const Material law = makeLaw(ceramic('C'));
  MaterialProbe probe(law, 0.01);
  strainPath(probe, {1e-3, 1e-3, 1e-3, 0, 0, 0}, 100, unrecorded);
  EXPECT_NEAR(probe.pressure(), -0.2e9, 1e-3);
  MaterialProbe torn(law, 0.01);
  strainPath(torn, {0.01, 0, 0, 0, 0, 0}, 1000, unrecorded);
  EXPECT_EQ(torn.history("damage"), 1);
  EXPECT_EQ(torn.pressure(), 0);
  EXPECT_EQ(torn.vonMises(), 0);
  EXPECT_EQ(torn.history("bulking_pressure"), 0); // nothing presses against it
}

TEST(JohnsonHolmquist, whatATornCeramicStoredIsLost)
{
  // No stress is left, so all of the energy is lost: that of shear, and that of mean tension, which
  // opened at the limit before damage took it.
  const auto lackOf = [](const MaterialProbe& probe)
  {
    EXPECT_EQ(probe.history("damage"), 1);
    EXPECT_NEAR(probe.pressure(), 0, 1e-3);
    EXPECT_NEAR(probe.vonMises(), 0, 1e-3);
    return 1 - probe.dissipation() / probe.energy();
  };
  MaterialProbe torn(makeLaw(ceramicJh2()), 0.01);
  strainPath(torn, {0.01, 0, 0, 0, 0, 0}, 4000, unrecorded);
  EXPECT_NEAR(lackOf(torn), 0, 0.01);
  JohnsonHolmquistParameters tough = ceramicJh2();
  tough.damageFactor = 0.05;
  MaterialProbe opened(makeLaw(tough), 0.01);
  strainPath(opened, {0.004, 0.004, 0.004, 0, 0, 0}, 4000, unrecorded);
  EXPECT_EQ(opened.dissipation(), 0); // it is elastic until damage comes
  strainPath(opened, {0.004, 0.004, 0.004, 0.2, 0, 0}, 4000, unrecorded);
  EXPECT_NEAR(lackOf(opened), 0, 0.01);
}

TEST(JohnsonHolmquist, losesNoMoreThanTheWorkInStepsOfAnySize)
{
  for (const int steps : {1, 5, 10, 50, 400})
  {
    MaterialProbe torn(makeLaw(ceramicJh2()), 0.01);
    strainPath(torn, {0.01, 0, 0, 0, 0, 0}, steps, unrecorded);
    EXPECT_NEAR(torn.dissipation(), torn.energy(), 1e-3 * torn.energy()) << steps;
  }
}

TEST(JohnsonHolmquist, breaksWithoutLosingMoreThanTheWork)
{
  // Under uniaxial stress it breaks in steps in which its sides leap out: flow and tension
  // together.
  JohnsonHolmquistParameters tough = ceramicJh2();
  tough.damageFactor = 0.05;
  for (const int steps : {20, 50, 100, 200})
  {
    MaterialProbe probe(makeLaw(tough), 0.01);
    uniaxialStress(probe, -0.01, steps, unrecorded);
    EXPECT_EQ(probe.history("damage"), 1) << steps;
    EXPECT_NEAR(probe.dissipation(), probe.energy(), 0.02 * probe.energy()) << steps;
  }
}

TEST(JohnsonHolmquist, energyIsLostOrStored)
{
  for (const char which : {'A', 'B', 'C'})
  {
    MaterialProbe probe(makeLaw(ceramic(which)), 1);
    strainPath(probe, {std::log(0.95), 0, 0, 0, 0, 0}, 5000, unrecorded);
    // Of p = K (1/J - 1) + dp down to no pressure, at J0; q^2 / 6G.
    const Real K = 130.95e9, J = probe.volumeRatio(), q = probe.vonMises();
    const Real J0 = 1 / (1 - probe.history("bulking_pressure") / K);
    const Real stored = K * (std::log(J0 / J) - 1 + J / J0) + q * q / (6 * 90.16e9) * J;
    EXPECT_NEAR(probe.dissipation() + stored, probe.energy(), 0.002 * probe.energy()) << which;
  }
}

TEST(JohnsonHolmquist, bulkingIsThatOfThePressureWhereverItComesFrom)
{
  const Real p = 2e9;
  const JohnsonHolmquist law = makeLaw(ceramic('A'));
  MaterialProbe started(law, 0.01, {-p, -p, -p, 0, 0, 0}), strained(law, 0.01);
  const Real axis = -std::log1p(p / 130.95e9) / 3;
  strainPath(strained, {axis, axis, axis, 0, 0, 0}, 100, unrecorded);
  ASSERT_NEAR(strained.pressure(), p, 1);
  strainPath(started, {0, 0, 0, 0.05, 0, 0}, 1000, unrecorded);
  strainPath(strained, {axis, axis, axis, 0.05, 0, 0}, 1000, unrecorded);
  ASSERT_EQ(started.history("damage"), 1);
  EXPECT_NEAR(started.history("bulking_pressure"), strained.history("bulking_pressure"), 10);
  // (p + dp)^2 - p^2 = 2 K q^2 / 6G, to the step of q.
  const Real q = law.intactStrength(p, Real(1.0));
  const Real raised = std::sqrt(p * p + 130.95e9 * q * q / (3 * 90.16e9)) - p;
  EXPECT_NEAR(started.history("bulking_pressure"), raised, 1e-9 * raised);
}

TEST(JohnsonHolmquist, rateRaisesBothStrengths)
{
  // Shear at a pressure that is held; the equivalent rate is 2 / sqrt3 times the tensor component.
  JohnsonHolmquistParameters rated = ceramicJh2();
  rated.rateFactor = 0.02;
  rated.referenceRate = 10;
  rated.bulkingFraction = 0;
  const auto strengthOf = [](JohnsonHolmquistParameters p, Real damageFactor, Real rate)
  {
    p.damageFactor = damageFactor;
    MaterialProbe probe(makeLaw(p), 0.01, {-1e9, -1e9, -1e9, 0, 0, 0});
    const Real shear = 5e-4;
    ProbeStep step;
    step.value = {0, 0, 0, shear, 0, 0};
    step.dt = shear / rate;
    for (int i = 0; i < 200; ++i)
      probe.advance(step);
    EXPECT_EQ(probe.history("damage") == 1, damageFactor < 1);
    return probe.vonMises();
  };
  const Real factor = 1 + 0.02 * std::log(2 / std::sqrt(3.0) * 1e4 / 10);
  for (const Real damageFactor : {1e9, 0.005})
    EXPECT_NEAR(strengthOf(rated, damageFactor, 1e4) / strengthOf(rated, damageFactor, 1), factor,
                1e-6);
  // The largest strength of the fractured material is one, whatever the rate.
  rated.largestFractured = 0.2;
  EXPECT_NEAR(strengthOf(rated, 0.005, 1e4), 0.2 * 2e9, 1);
  EXPECT_NEAR(strengthOf(rated, 0.005, 1), 0.2 * 2e9, 1);
}

TEST(JohnsonHolmquist, badParametersAreRefusedWithTheNumber)
{
  const auto refused = [](auto&& change, const std::string& part)
  {
    JohnsonHolmquistParameters parameters = ceramicJh2();
    change(parameters);
    try
    {
      makeLaw(parameters);
      ADD_FAILURE() << part;
    }
    catch (const Error& error)
    {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused([](auto& p) { p.bulkModuli = {1e9}; }, "number of bulk moduli is 1");
  refused([](auto& p) { p.elasticLimitPressure = 4e9; },
          "pressure at the Hugoniot elastic limit is 4000000000 Pa");
  refused([](auto& p) { p.tensileStrength = 2e9; }, "tensile limit is 2000000000 Pa");
  refused([](auto& p) { p.bulkingFraction = 2; }, "bulking fraction is 2");
}
