#include "Paths.hpp"

#include <coplane_material/PseudoCap.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

// Concrete that is stronger when it is strained fast. The closed forms are written here as in
// their sources: in decades, with their own constants.

using namespace coplane;
using namespace coplane::testing;

namespace
{
constexpr Real elementEdge = 0.01; // [m]

/// Malvar and Ross (1998): (rate / s)^d, from 1/s on b (rate / s)^(1/3) with log b = 6 d - 2.
Real malvarAndRoss(Real rate, Real megapascals)
{
  const Real d = 1 / (1 + 8 * megapascals / 10), slow = 1e-6;
  if (rate <= slow)
    return 1;
  return rate <= 1 ? std::pow(rate / slow, d) : std::pow(10, 6 * d - 2) * std::cbrt(rate / slow);
}

/// CEB (1990): (rate / s)^(1.026 a), from 30/s on g (rate / s)^(1/3) with log g = 6.156 a - 2.
Real ceb(Real rate, Real megapascals)
{
  const Real a = 1 / (5 + 9 * megapascals / 10), slow = 30e-6;
  if (rate <= slow)
    return 1;
  return rate <= 30 ? std::pow(rate / slow, 1.026 * a)
                    : std::pow(10, 6.156 * a - 2) * std::cbrt(rate / slow);
}

PseudoCapParameters fastC40(Real largestRate = 1000)
{
  PseudoCapParameters parameters = concreteC40();
  parameters.rateEffects = true;
  parameters.largestRate = largestRate;
  return parameters;
}

std::vector<Real> ratesOfTests()
{
  std::vector<Real> rates;
  for (int i = 0; i <= 36; ++i)
    rates.push_back(std::pow(10, -6 + 0.25 * i)); // 1e-6 to 1e3
  return rates;
}

ProbeStep alongX(Real increment, Real rate)
{
  ProbeStep step;
  step.stressGiven = {false, true, true, false, false, false};
  step.value = {increment, 0, 0, 0, 0, 0};
  step.dt = std::abs(increment) / rate;
  return step;
}

/// Largest stress along x in a uniaxial test at a rate, in steps of `increment`.
Real peakAt(const Material& law, Real rate, Real increment, int steps)
{
  MaterialProbe probe(law, elementEdge);
  Real peak = 0;
  for (int i = 0; i < steps; ++i)
  {
    probe.advance(alongX(increment, rate));
    peak = std::max(peak, std::abs(probe.stress().xx));
  }
  return peak;
}

/// Energy that a point keeps: of the deviator, and of the pressure as that of a linear solid.
Real storedBy(const MaterialProbe& probe, const PseudoCap& law)
{
  const Real q = probe.vonMises(), p = probe.pressure();
  return q * q / (6 * law.elastic.shearModulus) + p * p / (2 * law.elastic.bulkModulus);
}
} // namespace

TEST(RateEffect, factorsAreThoseOfTheirSources)
{
  for (const Real strength : {20e6, 40e6, 120e6})
  {
    const RateEffect effect = rateEffectOf(strength, 1000);
    for (const Real rate : ratesOfTests())
    {
      const Real tension = malvarAndRoss(rate, strength / 1e6);
      const Real compression = ceb(rate, strength / 1e6);
      EXPECT_NEAR(effect.tension(rate), tension, 1e-13 * tension) << rate;
      EXPECT_NEAR(effect.compression(rate), compression, 1e-13 * compression) << rate;
    }
  }
}

TEST(RateEffect, branchesMeetAtTheirEnds)
{
  const RateEffect effect = rateEffectOf(40e6, 300);
  for (const Real end : {1e-6, 3e-5, 1.0, 30.0, 300.0})
    for (const Real side : {1 - 1e-9, 1 + 1e-9})
    {
      EXPECT_NEAR(effect.tension(side * end), effect.tension(end), 1e-9 * effect.tension(end));
      EXPECT_NEAR(effect.compression(side * end), effect.compression(end),
                  1e-9 * effect.compression(end));
    }
  EXPECT_EQ(effect.tension(1e-7), 1);
  EXPECT_EQ(effect.compression(1e-6), 1);
  EXPECT_EQ(effect.tension(0.0), 1);
  EXPECT_EQ(effect.tension(1e5), effect.tension(300.0));
  EXPECT_EQ(effect.compression(1e5), effect.compression(300.0));
}

TEST(RateEffect, endsWhereInertiaBeginsUnlessARateIsGiven)
{
  const RateEffect plain = rateEffectOf(40e6, 0), all = rateEffectOf(40e6, 1000);
  for (const Real rate : {1e-3, 0.5, 1.0, 5.0, 30.0, 200.0})
  {
    EXPECT_EQ(plain.tension(rate), all.tension(std::min(rate, 1.0))) << rate;
    EXPECT_EQ(plain.compression(rate), all.compression(std::min(rate, 30.0))) << rate;
  }
  EXPECT_TRUE(plain.counts());
  EXPECT_FALSE(RateEffect{}.counts());
}

TEST(RateEffect, rateIsThatAlongTheAxis)
{
  EXPECT_NEAR(largestPrincipal(SymTensor{-3, 0.6, 0.6, 0, 0, 0}), 3, 1e-14);
  EXPECT_NEAR(largestPrincipal(SymTensor{5, 0, 0, 0, 0, 0}), 5, 1e-14);
  EXPECT_NEAR(largestPrincipal(SymTensor{-2, -2, -2, 0, 0, 0}), 2, 1e-14);
  EXPECT_NEAR(largestPrincipal(SymTensor{0, 0, 0, 0, 4, 0}), 4, 1e-14);
  EXPECT_NEAR(largestPrincipal(SymTensor{1, 3, -2, 2, 0, 0}), 2 + std::sqrt(5.0), 1e-14);
  EXPECT_EQ(largestPrincipal(SymTensor{}), 0);
}

TEST(RateEffect, uniaxialStrengthsGrowAsTheFactorsSay)
{
  // The first step that yields ends on the surface of the undamaged material. The cap is kept away,
  // as fast compression would reach it: pl = 2 GPa.
  PseudoCapParameters parameters = fastC40();
  parameters.crushPressure = 4e9;
  const Material law = makeLaw(parameters);
  for (const Real rate : ratesOfTests())
  {
    const Real tension = 4e6 * malvarAndRoss(rate, 40), compression = 40e6 * ceb(rate, 40);
    EXPECT_NEAR(peakAt(law, rate, tension / 33e9 / 20.5, 30), tension, 1e-6 * tension) << rate;
    // Constants of the surface have four digits; near a third of fc the factor goes from that of
    // tension to that of compression by the pressure at the start of the step.
    // Beyond three times fc the pressure of the test itself is one of confined concrete.
    if (compression < 3 * 40e6)
    {
      EXPECT_NEAR(peakAt(law, rate, -compression / 33e9 / 1000.5, 1200), compression,
                  1e-4 * compression)
          << rate;
    }
  }
}

TEST(RateEffect, confinedConcreteIsAsStrongAsInSlowTests)
{
  // Shear at a constant pressure, at 20/s: the factor of compression up to fc, none from 3 fc on.
  const auto strengthAt = [](const PseudoCapParameters& parameters, Real pressure)
  {
    MaterialProbe probe(makeLaw(parameters), elementEdge);
    ProbeStep step;
    step.stressGiven.fill(true);
    for (int i = 1; i <= 400; ++i)
    {
      step.value = {-pressure * i / 400, -pressure * i / 400, -pressure * i / 400, 0, 0, 0};
      probe.advance(step);
    }
    step.stressGiven = {true, true, true, false, true, true};
    step.value = {-pressure, -pressure, -pressure, 1e-6, 0, 0};
    step.dt = 1e-6 / 20;
    Real strength = 0;
    for (int i = 0; i < 8000; ++i)
    {
      probe.advance(step);
      strength = std::max(strength, probe.vonMises());
    }
    return strength;
  };
  PseudoCapParameters fast = fastC40(), slow = concreteC40();
  for (PseudoCapParameters* parameters : {&fast, &slow})
    parameters->crushPressure = 4e9; // the cap is kept away
  EXPECT_NEAR(strengthAt(fast, 130e6), strengthAt(slow, 130e6), 1e-9 * strengthAt(slow, 130e6));
  // r Y(p / r), and of Y the part a0 fc grows with r alone.
  EXPECT_GT(strengthAt(fast, 30e6), 1.08 * strengthAt(slow, 30e6));
}

TEST(RateEffect, meanTensionAndShearGrowAsTension)
{
  const Material law = makeLaw(fastC40());
  for (const Real rate : {1e-6, 1e-2, 1.0, 100.0})
  {
    const Real factor = malvarAndRoss(rate, 40);
    MaterialProbe pulled(law, elementEdge), sheared(law, elementEdge);
    ProbeStep step;
    const Real e = factor * 4e6 / (3 * 18.3e9) / 20.5;
    step.value = {e, e, e, 0, 0, 0};
    step.dt = e / rate;
    Real peak = 0;
    for (int i = 0; i < 30; ++i)
    {
      pulled.advance(step);
      peak = std::max(peak, -pulled.pressure());
    }
    EXPECT_NEAR(peak, factor * 4e6, 1e-6 * peak) << rate;
    // At no pressure: Y = r(30 deg) m_t ft, 3.904 MPa of shear stress. It yields in the 21st step,
    // and dilates: the principal strain is that of the shear and a third of the volume.
    const Real g = factor * 3.904e6 / (2 * 13.75e9) / 20.5;
    step.stressGiven = {true, true, true, false, false, false};
    step.value = {0, 0, 0, g, 0, 0};
    step.dt = g / rate;
    Real normal = 0;
    for (int i = 0; i < 21; ++i)
    {
      normal = sheared.strain().xx;
      sheared.advance(step);
    }
    const Real fastest = rate * (1 + (sheared.strain().xx - normal) / g);
    EXPECT_GT(fastest, 1.02 * rate);
    const Real strength = malvarAndRoss(fastest, 40) * 3.904e6;
    EXPECT_NEAR(sheared.stress().xy, strength, 5e-4 * strength) << rate;
  }
}

TEST(RateEffect, aCrackTakesTheFactorTimesTheFractureEnergy)
{
  for (const Real rate : {1e-6, 1e-2, 10.0})
  {
    const Real factor = malvarAndRoss(rate, 40);
    MaterialProbe probe(makeLaw(fastC40()), elementEdge);
    const int steps = 12000;
    for (int i = 0; i < steps; ++i)
      probe.advance(alongX(0.03 / steps, rate));
    // Opening by 1 - exp(-w ft / G_F) of it; the opening is the strain less what is elastic.
    EXPECT_NEAR(probe.energy() * elementEdge, factor * 120, 0.01 * factor * 120) << rate;
    EXPECT_NEAR(probe.dissipation() + storedBy(probe, makeLaw(fastC40())), probe.energy(),
                2e-4 * probe.energy());
  }
}

TEST(RateEffect, energyClosesWhenTheRateChangesOnTheWay)
{
  // Loaded fast, then held, unloaded and loaded again slowly and fast: when the rate falls the
  // stress falls at once, and what it loses has to be found in the dissipation.
  const PseudoCap law = makeLaw(fastC40());
  struct Leg
  {
    Real strain, rate; // at the end [-], [1/s]
    int steps;
  };
  const auto follow = [&](const std::vector<Leg>& legs)
  {
    MaterialProbe probe(law, elementEdge);
    Real from = 0, before = 0;
    for (const Leg& leg : legs)
    {
      const Real increment = (leg.strain - from) / leg.steps;
      for (int i = 0; i < leg.steps; ++i)
      {
        ProbeStep step = alongX(increment, leg.rate);
        if (increment == 0)
          step.dt = 1e-6;
        probe.advance(step);
        EXPECT_GE(probe.dissipation(), before);
        before = probe.dissipation();
      }
      from = leg.strain;
      EXPECT_NEAR(storedBy(probe, law) + probe.dissipation(), probe.energy(), 2e-3 * probe.energy())
          << "at strain " << leg.strain << ", rate " << leg.rate;
    }
    return probe;
  };
  const MaterialProbe pulled = follow({{1e-3, 100, 2000},
                                       {1e-3, 0, 10},
                                       {9e-4, 1e-3, 200},
                                       {2e-3, 1e-3, 2000},
                                       {4e-3, 50, 2000},
                                       {3.8e-3, 50, 200}});
  EXPECT_GT(pulled.history("damage"), 0.5);
  const MaterialProbe pressed = follow({{-2e-3, 100, 2000},
                                        {-2e-3, 0, 10},
                                        {-1.5e-3, 1e-3, 500},
                                        {-4e-3, 1e-3, 2000},
                                        {-8e-3, 20, 4000},
                                        {-7e-3, 20, 500}});
  EXPECT_GT(pressed.history("damage"), 0.05);
}

TEST(RateEffect, slowLoadingHasTheBitsOfTheLawWithoutRates)
{
  // Below 1e-6/s both factors are 1; p / 1 and 1 Y are exact.
  const Material plain = makeLaw(concreteC40()), fast = makeLaw(fastC40());
  MaterialProbe a(plain, elementEdge), b(fast, elementEdge);
  const SymTensor strains[] = {{1e-4, -2e-4, 3e-4, 2e-4, 0, -1e-4},
                               {-4e-3, -2e-3, -3e-3, 1e-3, 2e-3, 0},
                               {-6e-3, -5e-3, 1e-3, 0, 2e-3, 1e-3},
                               {1e-3, 2e-3, 1e-3, 0, 0, 0}};
  for (const SymTensor& strain : strains)
    for (int i = 0; i < 50; ++i)
    {
      const Mat3 l{{{strain.xx / 50, strain.xy / 50, strain.zx / 50},
                    {strain.xy / 50, strain.yy / 50, strain.yz / 50},
                    {strain.zx / 50, strain.yz / 50, strain.zz / 50}}};
      a.advance(l, 1e6);
      b.advance(l, 1e6);
      const SymTensor &s = a.stress(), &t = b.stress();
      EXPECT_EQ(s.xx, t.xx);
      EXPECT_EQ(s.yy, t.yy);
      EXPECT_EQ(s.zz, t.zz);
      EXPECT_EQ(s.xy, t.xy);
      EXPECT_EQ(s.yz, t.yz);
      EXPECT_EQ(s.zx, t.zx);
      EXPECT_EQ(a.history(), b.history());
    }
  EXPECT_GT(a.history("damage"), 0.05);
  EXPECT_GT(a.history("compaction"), 0);
}
