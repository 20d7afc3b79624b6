#include "Laws.hpp"
#include "Paths.hpp"

#include <coplane_core/Lanes.hpp>
#include <coplane_core/Rotate.hpp>
#include <coplane_material/Invariants.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

// What every law has to keep, whatever it describes.

using namespace coplane;
using namespace coplane::testing;

namespace
{
std::array<Real, 6> componentsOf(const SymTensor& s)
{
  return {s.xx, s.yy, s.zz, s.xy, s.yz, s.zx};
}

Mat3 randomGradient(std::mt19937& random, Real size)
{
  std::uniform_real_distribution<Real> uniform(-size, size);
  Mat3 l;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      l(i, j) = uniform(random);
  return l;
}

/// A rotation about a skew axis.
Mat3 someRotation()
{
  const Real c = std::cos(0.7), s = std::sin(0.7), d = std::cos(-1.1), e = std::sin(-1.1);
  const Mat3 aboutZ{{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
  const Mat3 aboutX{{{1, 0, 0}, {0, d, -e}, {0, e, d}}};
  return aboutZ * aboutX;
}

Mat3 transposed(const Mat3& m)
{
  Mat3 r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r(i, j) = m(j, i);
  return r;
}

/// A material point as the element kernel makes it, from the state and the motion of a probe.
MaterialPoint<Real> pointOf(const MaterialProbe& probe, const Mat3& l, Real dt, Real size)
{
  MaterialPoint<Real> point;
  point.dt = dt;
  const auto mean = [&](int i, int j) { return 0.5 * (l(i, j) + l(j, i)); };
  point.strainIncrement = {l(0, 0), l(1, 1), l(2, 2), mean(0, 1), mean(1, 2), mean(2, 0)};
  point.displacementGradient = l;
  point.rotation = someRotation();
  point.volumeRatio = probe.volumeRatio() * (1 + l(0, 0) + l(1, 1) + l(2, 2));
  point.halfVolumeRatio = 0.5 * (probe.volumeRatio() + point.volumeRatio);
  point.energy = probe.energy();
  point.size = size;
  point.oldStress = probe.stress();
  point.stress = rotated(probe.stress(), point.rotation);
  std::copy(probe.history().begin(), probe.history().end(), point.history);
  return point;
}

class LawProperties : public ::testing::TestWithParam<NamedLaw>
{
protected:
  const Material& law() const { return GetParam().law; }
  Real strain() const { return GetParam().strain; }
  Real shearModulus() const { return elasticity(law()).shearModulus; }
  int histories() const { return int(historyNames(law()).size()); }
};
} // namespace

TEST_P(LawProperties, everyLaneHasTheBitsOfTheScalar)
{
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial)
  {
    MaterialPoint<Real> one[laneCount];
    for (int lane = 0; lane < laneCount; ++lane)
    {
      // Lanes that differ: from hardly strained to far beyond yield, some compressed, some pulled.
      MaterialProbe probe(law(), 0.01 * (lane + 1));
      const Real reach = strain() * std::pow(0.1, lane);
      const Real volume = (trial % 3 - 1) * reach;
      for (int i = 0; i < trial % 5; ++i)
      {
        Mat3 l = randomGradient(random, reach);
        for (int k = 0; k < 3; ++k)
          l(k, k) += volume;
        probe.advance(l, 1e-6);
      }
      Mat3 l = randomGradient(random, reach);
      for (int k = 0; k < 3; ++k)
        l(k, k) += volume;
      one[lane] = pointOf(probe, l, 1e-6, 0.01 * (lane + 1));
      one[lane].bendingSquared = trial % 2 * std::pow(lane * reach * shearModulus(), 2);
    }
    MaterialPoint<Lanes> all;
    all.dt = 1e-6;
    const auto gather = [&](auto member)
    { return Lanes([&](auto lane) { return member(one[int(lane)]); }); };
    const auto gatherTensor = [&](auto SymTensor::*k, auto tensor)
    { return gather([&](const MaterialPoint<Real>& p) { return (p.*tensor).*k; }); };
    const auto tensors = [&](SymTensorOf<Lanes>& to, SymTensor MaterialPoint<Real>::*from)
    {
      to = {gatherTensor(&SymTensor::xx, from), gatherTensor(&SymTensor::yy, from),
            gatherTensor(&SymTensor::zz, from), gatherTensor(&SymTensor::xy, from),
            gatherTensor(&SymTensor::yz, from), gatherTensor(&SymTensor::zx, from)};
    };
    using P = MaterialPoint<Real>;
    tensors(all.strainIncrement, &P::strainIncrement);
    tensors(all.oldStress, &P::oldStress);
    tensors(all.stress, &P::stress);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        all.displacementGradient(i, j) =
            gather([&](const P& p) { return p.displacementGradient(i, j); });
        all.rotation(i, j) = gather([&](const P& p) { return p.rotation(i, j); });
      }
    all.volumeRatio = gather([](const P& p) { return p.volumeRatio; });
    all.halfVolumeRatio = gather([](const P& p) { return p.halfVolumeRatio; });
    all.energy = gather([](const P& p) { return p.energy; });
    all.bendingSquared = gather([](const P& p) { return p.bendingSquared; });
    all.size = gather([](const P& p) { return p.size; });
    for (int k = 0; k < histories(); ++k)
      all.history[k] = gather([&](const P& p) { return p.history[k]; });

    lawFunction(law())(all);
    for (int lane = 0; lane < laneCount; ++lane)
    {
      P& p = one[lane];
      lawFunction(law())(p);
      const SymTensor stress{all.stress.xx[lane], all.stress.yy[lane], all.stress.zz[lane],
                             all.stress.xy[lane], all.stress.yz[lane], all.stress.zx[lane]};
      EXPECT_EQ(componentsOf(stress), componentsOf(p.stress)) << "trial " << trial;
      for (int k = 0; k < histories(); ++k)
        EXPECT_EQ(Real(all.history[k][lane]), p.history[k]) << k;
      EXPECT_EQ(Real(all.dissipation[lane]), p.dissipation);
      EXPECT_EQ(Real(all.stiffening[lane]), p.stiffening);
      EXPECT_EQ(Real(all.integrity[lane]), p.integrity);
      EXPECT_EQ(Real(all.bendingScale[lane]), p.bendingScale);
      EXPECT_TRUE(std::isfinite(p.stress.xx));
    }
  }
}

TEST_P(LawProperties, turningTheWholePathTurnsTheStress)
{
  std::mt19937 random(2);
  const Mat3 r = someRotation();
  for (int trial = 0; trial < 20; ++trial)
  {
    // A law with directions of its own is turned with its body.
    MaterialProbe straight(law(), 0.01), turned(turnedLaw(law(), r), 0.01);
    Real stress = 0;
    for (int i = 0; i < 30; ++i)
    {
      Mat3 l = randomGradient(random, 0.1 * strain());
      for (int k = 0; k < 3; ++k)
        l(k, k) += 0.05 * (trial % 3 - 1) * strain();
      straight.advance(l, 1e-6);
      turned.advance(r * l * transposed(r), 1e-6);
      stress = std::max(stress, straight.vonMises() + std::abs(straight.pressure()));
    }
    const auto expected = componentsOf(rotated(straight.stress(), r));
    const auto found = componentsOf(turned.stress());
    for (int k = 0; k < 6; ++k)
      EXPECT_NEAR(found[k], expected[k], 1e-7 * stress) << "trial " << trial; // roots: 1e-11 a step
  }
}

TEST_P(LawProperties, spinWithoutStrainOnlyTurnsTheStress)
{
  // Hughes and Winget's rotation by 0.02 rad in 1000 steps; everything the law remembers as a
  // tensor has to turn along, so going back by the opposite strain gives the same either way.
  std::mt19937 random(3);
  MaterialProbe probe(law(), 0.01);
  for (int i = 0; i < 10; ++i)
    probe.advance(randomGradient(random, 0.1 * strain()), 1e-6);
  for (int i = 0; i < 300; ++i) // strength that fell with the last step's damage or rate settles
    probe.advance(Mat3{}, 1e-6);
  const auto before = probe;
  Mat3 spin, whole{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  spin(0, 1) = -0.02;
  spin(1, 0) = 0.02;
  const Real c = (1 - 1e-4) / (1 + 1e-4), s = 0.02 / (1 + 1e-4);
  const Mat3 step{{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
  for (int i = 0; i < 100; ++i)
  {
    probe.advance(spin, 1e-6);
    whole = step * whole;
  }
  const Real scale = before.vonMises() + std::abs(before.pressure());
  const auto expected = componentsOf(rotated(before.stress(), whole));
  for (int k = 0; k < 6; ++k)
    EXPECT_NEAR(componentsOf(probe.stress())[k], expected[k], 1e-6 * scale);

  // One more step, and the same step seen from the turned frame.
  MaterialProbe still = before, turned = probe;
  const Mat3 l = randomGradient(random, 0.1 * strain());
  still.advance(l, 1e-6);
  turned.advance(whole * l * transposed(whole), 1e-6);
  const auto after = componentsOf(rotated(still.stress(), whole));
  for (int k = 0; k < 6; ++k)
    EXPECT_NEAR(componentsOf(turned.stress())[k], after[k], 1e-6 * scale);
}

TEST_P(LawProperties, nothingIsGainedOnTheWay)
{
  // Dissipation never falls, over cycles of loading in all directions, and is part of the work.
  std::mt19937 random(4);
  for (int trial = 0; trial < 20; ++trial)
  {
    MaterialProbe probe(law(), 0.01);
    Real before = 0;
    for (int turn = 0; turn < 20; ++turn)
    {
      const Mat3 l = randomGradient(random, 0.02 * strain());
      for (int i = 0; i < 20; ++i)
      {
        probe.advance(l, 1e-6);
        EXPECT_GE(probe.dissipation(), before - 1e-12 * probe.energy());
        before = probe.dissipation();
      }
    }
  }
}

TEST_P(LawProperties, bendingFlowsWithTheDeviatorOrIsLeftAlone)
{
  // With little bending the law does what it does without; with much the whole stays bounded.
  std::mt19937 random(6);
  int flowing = 0, elastic = 0;
  for (int trial = 0; trial < 100; ++trial)
  {
    MaterialProbe probe(law(), 0.01);
    const Real reach = strain() * std::pow(10, -trial % 4);
    const Mat3 direction = randomGradient(random, 0.3 * reach);
    for (int i = 0; i < 10; ++i)
    {
      MaterialPoint<Real> none = pointOf(probe, direction, 1e-6, 0.01), little = none, much = none;
      const Real large = shearModulus();
      little.bendingSquared = 1e-20 * large * large;
      much.bendingSquared = large * large;
      for (MaterialPoint<Real>* point : {&none, &little, &much})
      {
        lawFunction(law())(*point);
        EXPECT_GE(point->bendingScale, 0);
        EXPECT_LE(point->bendingScale, 1);
        EXPECT_TRUE(std::isfinite(point->dissipation));
      }
      EXPECT_NEAR(little.dissipation, none.dissipation, 1e-6 * large * reach);
      const auto expected = componentsOf(none.stress), got = componentsOf(little.stress);
      for (int k = 0; k < 6; ++k)
        EXPECT_NEAR(got[k], expected[k], 1e-6 * large * reach);
      if (lawFunction(law()).hasStrength)
      {
        EXPECT_LT(much.bendingScale, 0.5);
      }
      else
        EXPECT_EQ(much.bendingScale, 1);
      ++(none.bendingScale < 1 ? flowing : elastic);
      probe.advance(direction, 1e-6);
    }
  }
  if (lawFunction(law()).hasStrength)
  {
    EXPECT_GT(flowing, 50);
    EXPECT_GT(elastic, 50);
  }
}

TEST_P(LawProperties, theAnswerIsAContinuousFunctionOfTheStrain)
{
  // Between two strain increments from one state, the half over which the answer changes more is
  // halved again and again. What is left then is a jump: there round-off decides, and bodies that
  // are each other's mirror images part.
  constexpr int halvings = 44; // to 6e-14 of the strain
  // What dashpots take is a small difference of works, so that round-off in it looks like a jump.
  const bool damped = std::holds_alternative<MaxwellDamped>(law());
  std::mt19937 random(7);
  std::array<Real, maximumHistory> largest{};
  Real stress = 0;
  for (int trial = 0; trial < 300; ++trial)
  {
    MaterialProbe probe(law(), 0.01);
    const auto some = [&](Real reach)
    {
      Mat3 l = randomGradient(random, reach);
      const Real volume = std::uniform_real_distribution<Real>(-reach, reach)(random);
      for (int k = 0; k < 3; ++k)
        l(k, k) += volume;
      return l;
    };
    for (int turn = 0; turn < trial % 4; ++turn)
    {
      const Mat3 l = some(0.1 * strain());
      for (int i = 0; i < 10; ++i)
        probe.advance(l, 1e-6);
    }
    const Mat3 first = some(0.1 * strain()), last = some(0.1 * strain());
    const auto answerAt = [&](Real share)
    {
      Mat3 l;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          l(i, j) = (1 - share) * first(i, j) + share * last(i, j);
      MaterialPoint<Real> point = pointOf(probe, l, 1e-6, 0.01);
      point.bendingSquared = trial % 2 * std::pow(0.01 * strain() * shearModulus(), 2);
      lawFunction(law())(point);
      for (const Real s : componentsOf(point.stress))
        stress = std::max(stress, std::abs(s));
      for (int k = 0; k < histories(); ++k)
        largest[k] = std::max(largest[k], std::abs(point.history[k]));
      return point;
    };
    const auto changeOver = [&](const MaterialPoint<Real>& a, const MaterialPoint<Real>& b)
    {
      Real change = 0;
      for (int k = 0; k < 6; ++k)
        change = std::max(change,
                          std::abs(componentsOf(a.stress)[k] - componentsOf(b.stress)[k]) / stress);
      for (int k = 0; k < histories(); ++k)
        if (largest[k] > 0 && !damped)
          change = std::max(change, std::abs(a.history[k] - b.history[k]) / largest[k]);
      return change;
    };
    Real low = 0, high = 1;
    MaterialPoint<Real> atLow = answerAt(low), atHigh = answerAt(high);
    for (int i = 0; i < halvings; ++i)
    {
      const Real middle = 0.5 * (low + high);
      const MaterialPoint<Real> atMiddle = answerAt(middle);
      const bool lower = changeOver(atLow, atMiddle) > changeOver(atMiddle, atHigh);
      (lower ? high : low) = middle;
      (lower ? atHigh : atLow) = atMiddle;
    }
    EXPECT_LT(changeOver(atLow, atHigh), 1e-10)
        << "trial " << trial << ", pressures " << -meanOf(atLow.stress) << " and "
        << -meanOf(atHigh.stress) << " Pa";
  }
}

TEST_P(LawProperties, nothingMovesWithoutMotion)
{
  MaterialProbe probe(law(), 0.01);
  probe.advance(Mat3{}, 1e-6);
  EXPECT_NEAR(probe.vonMises() + std::abs(probe.pressure()), 0, 1e-12 * pWaveModulus(law()));
  EXPECT_EQ(probe.dissipation(), 0);
}

TEST_P(LawProperties, smallStrainsFeelTheElasticConstants)
{
  // A hundred thousandth of the law's strain: Hooke's law, to the law's curvature.
  MaterialProbe probe(law(), 0.01);
  const Real e = 1e-5 * strain();
  probe.advance(Mat3{{{-e, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, 1e-6);
  EXPECT_NEAR(-probe.stress().xx / e, pWaveModulus(law()), 1e-3 * pWaveModulus(law()));
  EXPECT_NEAR(probe.stiffening(), 1, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Laws, LawProperties, ::testing::ValuesIn(allLaws()),
                         [](const auto& law) { return law.param.name; });

namespace
{
/// With so little that the law itself is what is seen.
std::vector<NamedLaw> dampedLaws()
{
  std::vector<NamedLaw> damped;
  for (const NamedLaw& law : allLaws())
    for (const bool volumetric : {false, true})
      if (law.name == "linearElastic" || law.name == "hardeningPlasticity" ||
          law.name == "neoHookean" || law.name == "mohrCoulomb")
        damped.push_back({law.name + (volumetric ? "Volumetric" : ""),
                          withMaxwell(law.law, fitMaxwell(5e-5, 0.1, 1, 3).elements, volumetric),
                          law.strain});
  return damped;
}
} // namespace

INSTANTIATE_TEST_SUITE_P(Damped, LawProperties, ::testing::ValuesIn(dampedLaws()),
                         [](const auto& law) { return law.param.name; });
