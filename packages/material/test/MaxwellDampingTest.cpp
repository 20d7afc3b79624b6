#include <coplane_core/Error.hpp>
#include <coplane_material/MaterialProbe.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace coplane;

namespace
{
const LinearElastic soil = makeLinearElastic(2e8, 0.3, 1800);

Mat3 shear(Real strain)
{
  Mat3 l;
  l(0, 1) = l(1, 0) = strain; // tensor shear, without spin
  return l;
}
} // namespace

TEST(MaxwellDamping, fitsAConstantRatioOverABand)
{
  for (const Real ratio : {0.005, 0.02, 0.1})
    for (const Real band : {5.0, 20.0, 50.0})
    {
      const MaxwellFit fit = fitMaxwell(ratio, 0.5, 0.5 * band, 3);
      EXPECT_NEAR(fit.least / ratio, 1, 0.03) << ratio << " " << band;
      EXPECT_NEAR(fit.largest / ratio, 1, 0.03) << ratio << " " << band;
      // What it says of itself is so between its samples as well; outside it falls off.
      for (int i = 0; i <= 1000; ++i)
      {
        const Real at = fit.elements.ratio(0.5 * std::pow(band, i / 1000.0));
        EXPECT_GE(at, fit.least - 1e-3 * ratio);
        EXPECT_LE(at, fit.largest + 1e-3 * ratio);
      }
      EXPECT_LT(fit.elements.ratio(0.5 / 20), 0.5 * ratio);
      EXPECT_LT(fit.elements.ratio(0.5 * band * 20), 0.5 * ratio);
    }
}

TEST(MaxwellDamping, oneElementHasItsPeakInTheMiddle)
{
  const MaxwellFit fit = fitMaxwell(0.02, 1, 4, 1);
  EXPECT_NEAR(fit.elements.time[0], 1 / (2 * pi * 2), 1e-15);
  EXPECT_GT(fit.largest, 0.02);
  EXPECT_LT(fit.least, 0.02);
}

TEST(MaxwellDamping, isExactForAConstantRateWhateverTheStep)
{
  // q = 2 G share rate t_k (1 - exp(-t/t_k)), beside 2 G rate t.
  const MaxwellElements elements = fitMaxwell(0.05, 1, 20, 3).elements;
  const Real rate = 1e-3, end = 0.3, twoG = 2 * soil.shearModulus;
  Real exact = twoG * rate * end;
  for (int k = 0; k < 3; ++k)
    exact += twoG * elements.share[std::size_t(k)] * rate * elements.time[std::size_t(k)] *
             -std::expm1(-end / elements.time[std::size_t(k)]);
  for (const int steps : {1, 3, 100})
  {
    MaterialProbe probe(withMaxwell(soil, elements, false), 1);
    for (int i = 0; i < steps; ++i)
      probe.advance(shear(rate * end / steps), end / steps);
    EXPECT_NEAR(probe.stress().xy, exact, 1e-12 * exact) << steps;
    EXPECT_EQ(probe.pressure(), 0);
  }
}

TEST(MaxwellDamping, dilatationIsDampedWhenAskedFor)
{
  const MaxwellElements elements = fitMaxwell(0.05, 1, 20, 3).elements;
  const Real change = 1e-3, fast = 1e-9;
  Mat3 l;
  l(0, 0) = l(1, 1) = l(2, 2) = -change;
  for (const bool volumetric : {false, true})
  {
    MaterialProbe probe(withMaxwell(soil, elements, volumetric), 1);
    probe.advance(l, fast);
    EXPECT_NEAR(probe.pressure(),
                3 * change * soil.bulkModulus * (1 + volumetric * elements.added()),
                1e-6 * soil.bulkModulus * change);
    EXPECT_NEAR(probe.stiffening(), 1 + elements.added(), 1e-15);
  }
}

TEST(MaxwellDamping, cyclesOfStrainTakeTheRatioOfTheElastic)
{
  // Loss of a cycle over 4 pi times the largest stored energy, G' strain^2 / 2 by either shear
  // component: the ratio of critical damping of the modulus at that frequency.
  const MaxwellElements elements = fitMaxwell(0.05, 1, 20, 3).elements;
  for (const Real frequency : {1.0, 4.0, 20.0})
  {
    MaterialProbe probe(withMaxwell(soil, elements, false), 1);
    constexpr int steps = 400, cycles = 40;
    const Real size = 1e-5, dt = 1 / (frequency * steps);
    Real before = 0;
    for (int i = 0; i < cycles * steps; ++i)
    {
      if (i == (cycles - 1) * steps)
        before = probe.dissipation();
      const Real w = 2 * pi / steps;
      probe.advance(shear(size * (std::sin(w * (i + 1)) - std::sin(w * i))), dt);
    }
    const Real stored = 2 * soil.shearModulus * elements.storage(frequency) * size * size;
    EXPECT_NEAR((probe.dissipation() - before) / (4 * pi * stored), elements.ratio(frequency),
                1e-3 * elements.ratio(frequency));
    EXPECT_NEAR(probe.history("maxwell_dissipation"), probe.dissipation(),
                1e-6 * probe.dissipation());
    EXPECT_LT(probe.dissipation(), probe.energy());
  }
}

TEST(MaxwellDamping, leavesTheLawItsOwnStress)
{
  // Beyond yield the law's stress stays where it yields, and the overstress relaxes to nothing.
  J2Parameters parameters;
  parameters.density = 1800;
  parameters.youngsModulus = 2e8;
  parameters.poissonRatio = 0.3;
  parameters.yieldStress = 1e5;
  const Material law = makeLaw(parameters);
  MaterialProbe probe(withMaxwell(law, fitMaxwell(0.05, 1, 20, 3).elements, false), 1);
  for (int i = 0; i < 20; ++i)
    probe.advance(shear(1e-4), 1e-3);
  EXPECT_GT(probe.vonMises(), 1.05e5);
  for (int i = 0; i < 100; ++i)
    probe.advance(Mat3{}, 0.1);
  EXPECT_NEAR(probe.vonMises(), 1e5, 1e-3);
}

TEST(MaxwellDamping, asksForAShearModulus)
{
  EXPECT_THROW(withMaxwell(LinearElastic{1000, 2e9, 0}, fitMaxwell(0.05, 1, 20, 3).elements, false),
               Error);
}
