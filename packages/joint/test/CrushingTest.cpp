#include "Joints.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace coplane;

namespace
{
// The walls of Lourenco and Rots (1997): f_m 10.5 MPa, G_fc 5 N/mm, k_p .09 mm, C_ss 9.
constexpr Real fm = 10.5e6, Gc = 5e3, kp = 9e-5, Css = 9, masonryKn = 8.2e10, masonryKs = 3.6e10;

/// f of the formulas in docs/theory/joints.md, written anew.
Real strengthAt(Real k, Real energy = Gc)
{
  const Real L = 75. / 67 * energy / fm;
  if (k <= kp)
    return fm / 3 + 2 * fm / 3 * std::sqrt(2 * k / kp - k * k / (kp * kp));
  if (k <= kp + L)
    return fm - .5 * fm * std::pow((k - kp) / L, 2);
  return .1 * fm + .4 * fm * std::exp(-fm / L * (k - kp - L) / (.4 * fm));
}

Real onEllipse(const JointRun& run)
{
  return std::sqrt(run.sigma() * run.sigma() +
                   Css * dot(run.state.shearTraction, run.state.shearTraction));
}
Real crushing(const JointRun& run)
{
  return run.joint.law.curve.crushing.crushedAt(run.state.maximumClosure, masonryKn);
}
} // namespace

TEST(Crushing_Compression, followsThePublishedCurveWhateverTheSteps)
{
  for (const int steps : {1, 3, 50})
    for (const Real loss : {0., .5, 1.})
      for (const Real k : {1e-9, 3e-6, 4e-5, kp, 2e-4, 6e-4, 7e-4, 3e-3})
      {
        JointRun run(crushedMortar(loss));
        const Real sigma = strengthAt(k);
        run.go(-(k + sigma / masonryKn), {}, steps);
        EXPECT_NEAR(run.sigma(), sigma, 1e-10 * fm) << k << " in " << steps;
        EXPECT_NEAR(crushing(run), k, 1e-14);
      }
}

TEST(Crushing_Compression, isNoMoreThanBearsACompression)
{
  const Crushing law = crushedMortar().law.curve.crushing;
  for (const Real most : {0., 3e-5, kp, 3e-4, 7e-4, 3e-3})
  {
    EXPECT_EQ(law.crushedUpTo(0, most), most);
    EXPECT_EQ(law.crushedUpTo(.999 * strengthAt(most), most), most);
    EXPECT_NEAR(law.crushedUpTo(1.1 * fm, most), std::min(most, kp), 1e-15);
    if (most > kp)
    {
      const Real compression = .5 * (strengthAt(most) + fm);
      const Real k = law.crushedUpTo(compression, most);
      EXPECT_LT(k, most);
      EXPECT_NEAR(strengthAt(k), compression, 1e-9 * fm);
    }
  }
}

TEST(Crushing_Compression, isElasticUpToAThirdAndItsPeakIsTheStrength)
{
  JointRun run(crushedMortar());
  run.go(-.333 * fm / masonryKn, {}, 5);
  EXPECT_NEAR(run.sigma(), .333 * fm, 1e-6);
  EXPECT_NEAR(run.stored(), .5 * run.sigma() * run.sigma() / masonryKn, 1e-10);
  EXPECT_NEAR(run.hysteresis, 0, 1e-12);
  run.step(-(kp + fm / masonryKn), {});
  EXPECT_NEAR(run.sigma(), fm, 1e-9 * fm);
  Real peak = 0;
  for (int i = 0; i <= 20000; ++i)
  {
    run.step(-2e-3 * i / 20000, {});
    peak = std::max(peak, run.sigma());
  }
  EXPECT_LE(peak, fm * (1 + 1e-14));
  EXPECT_GT(peak, .9999 * fm);
}

TEST(Crushing_Compression, areaAfterThePeakAndAboveTheResidualIsTheFractureEnergy)
{
  for (const Real residual : {.1, .2, 1. / 7})
    for (const Real loss : {0., .5, 1.})
    {
      Joint joint = crushedMortar(loss);
      joint.law.curve.crushing.residual = residual;
      joint.law.curve.crushing.length = Crushing::lengthFrom(fm, Gc, residual);
      JointRun run(joint);
      run.go(-(kp + fm / masonryKn), {}, 4000);
      // Hardening: k_p f_m (1/3 + 2/3 pi/4), of which a secant gives back half the loss.
      const Real hardening = kp * fm * (1. / 3 + pi / 6);
      EXPECT_NEAR(run.hysteresis, hardening - .5 * loss * fm * kp, 1e-5 * hardening);
      const Real end = 2e-2;               // where exp(-..) is nothing
      run.work = .5 * fm * fm / masonryKn; // of the elastic closure; the rest is inelastic
      run.go(-(end + residual * fm / masonryKn), {}, 40000);
      const Real inelastic = run.work - .5 * std::pow(residual * fm, 2) / masonryKn;
      EXPECT_NEAR(inelastic - residual * fm * (end - kp), Gc, 1e-5 * Gc);
    }
}

TEST(Crushing_Compression, unloadsToThePlasticPartOfItsCrushing)
{
  for (const Real loss : {0., .3, 1.})
    for (const Real k : {5e-5, 4e-4, 2e-3})
    {
      JointRun run(crushedMortar(loss));
      const Real sigma = strengthAt(k), closed = k + sigma / masonryKn, rest = (1 - loss) * k;
      run.go(-closed, {}, 30);
      const Real stored = run.stored();
      EXPECT_NEAR(stored, .5 * sigma * (closed - rest), 1e-9 * stored);
      run.step(-(rest + .3 * (closed - rest)), {});
      EXPECT_NEAR(run.sigma(), .3 * sigma, 1e-9 * fm);
      run.step(-(rest - 1e-7), {});
      EXPECT_NEAR(run.sigma(), -masonryKn * 1e-7, 1e-6 * fm) << "the bond pulls from there on";
      run.step(-closed, {});
      EXPECT_NEAR(run.sigma(), sigma, 1e-9 * fm) << "and back along the same line";
      EXPECT_NEAR(run.stored(), stored, 1e-9 * stored);
    }
}

TEST(Crushing_Compression, dissipationAndStoredEnergyAreTheWork)
{
  for (const Real loss : {0., .4, 1.})
  {
    JointRun run(crushedMortar(loss));
    for (const Real gap : {-2e-4, -5e-5, -9e-4, -1e-4, -3e-3})
      run.go(gap, {}, 4000);
    EXPECT_GE(run.leastDissipation, 0);
    EXPECT_NEAR(run.imbalance(), 0, 1e-6 * run.work);
  }
}

TEST(Crushing_Shear, tractionsStayOnTheEllipseAtSeveralCompressions)
{
  // Friction high enough that the cap is met first; slip at a closure that is held.
  for (const Real loss : {0., .5})
    for (const Real part : {.05, .2, .5, .8, .95})
    {
      JointRun run(crushedMortar(loss, 50));
      run.go(-run.joint.closureUnder(part * fm), {}, 1000);
      ASSERT_NEAR(run.sigma(), part * fm, 1e-9 * fm);
      Real most = 0;
      for (int i = 0; i < 20000; ++i)
      {
        const Real before = crushing(run);
        run.step(run.gap, {0, 1e-7, 0});
        if (crushing(run) > before)
          EXPECT_NEAR(onEllipse(run), strengthAt(crushing(run)), 1e-9 * fm);
        else
          EXPECT_LE(onEllipse(run), strengthAt(crushing(run)) * (1 + 1e-9));
        most = std::max(most, onEllipse(run));
      }
      EXPECT_NEAR(most, fm, 1e-4 * fm);
      EXPECT_GE(run.leastDissipation, 0);
      EXPECT_NEAR(run.imbalance(), 0, 1e-9 * run.work);
    }
}

TEST(Crushing_Shear, flowsAlongTheNormalOfTheEllipse)
{
  // One small step of slip from the ellipse, at a compression that a spring beside would keep:
  // inelastic closure over slip is sigma over C_ss tau, and the crushing is the length of both.
  JointRun run(crushedMortar(0, 50));
  run.step(-run.joint.closureUnder(.5 * fm), {});
  run.go(run.gap, {0, 1e-3, 0}, 10000);
  const Real k = crushing(run), sigma = run.sigma(), tau = norm(run.state.shearTraction);
  const Real offset = run.offset, slip = run.state.slip,
             plastic = run.closure() - sigma / masonryKn;
  run.step(run.gap, {0, 1e-8, 0});
  const Real crushed = crushing(run) - k;
  // What is plastic in the closure, less what the offset has risen.
  const Real closing = run.closure() - run.sigma() / masonryKn - plastic - (run.offset - offset);
  const Real sliding = run.state.slip - slip;
  EXPECT_NEAR(closing / sliding, sigma / (Css * tau), 1e-3 * sigma / (Css * tau));
  EXPECT_NEAR(crushed, std::hypot(closing, sliding), 1e-6 * crushed);
}

TEST(Crushing_Shear, whereItMeetsFrictionBothHold)
{
  JointRun run(crushedMortar(0, .75));
  run.go(-run.joint.closureUnder(.8 * fm), {}, 1000);
  bool corner = false;
  for (int i = 0; i < 30000; ++i)
  {
    const Real before = crushing(run);
    run.step(run.gap, {1e-7, 0, 0});
    const Real most = .75 * run.sigma() + .35e6;
    EXPECT_LE(norm(run.state.shearTraction), most * (1 + 1e-12));
    EXPECT_LE(onEllipse(run), strengthAt(crushing(run)) * (1 + 1e-9));
    corner = corner || (crushing(run) > before && run.state.shearing > 0);
  }
  EXPECT_TRUE(corner);
  EXPECT_GE(run.leastDissipation, 0);
  EXPECT_NEAR(run.imbalance(), 0, 1e-9 * run.work);
}

TEST(Crushing_Shear, longSlipIsBookedAtTheStrengthThatCrushingLeaves)
{
  // Steps that slip a thousand times as far as shear is elastic: what is booked before the return
  // to the ellipse is far too much.
  JointRun run(crushedMortar());
  run.state.bonded = false;
  run.step(-run.joint.closureUnder(.6 * fm), {});
  for (int i = 0; i < 200; ++i)
    run.step(run.gap - 1e-6, {1e-2, 0, 0});
  EXPECT_GT(crushing(run), kp);
  EXPECT_GE(run.leastDissipation, 0);
  EXPECT_NEAR(run.imbalance(), 0, 1e-3 * run.work);
}

TEST(Crushing_Shear, whatMayCrushIsForeseen)
{
  JointLaw law = crushedMortar(0).law;
  Crushing& crushing = law.curve.crushing;
  const Real strength = crushing.strengthAt(0), weight = crushing.shearWeight;
  ASSERT_GT(weight, 0);
  const Real sigma = .5 * strength, edge = std::sqrt(.75 / weight) * strength;
  law.friction = 2 * edge / sigma;
  EXPECT_TRUE(law.mayBeCrushed(0, 1.001 * strength, 0));
  EXPECT_FALSE(law.mayBeCrushed(0, .999 * strength, 0));
  EXPECT_TRUE(law.mayBeCrushed(0, sigma, 1.001 * edge));
  EXPECT_FALSE(law.mayBeCrushed(0, sigma, .999 * edge));
  law.cohesion = 0;
  law.friction = .9 * edge / sigma; // holds no more than that
  EXPECT_FALSE(law.mayBeCrushed(0, sigma, 10 * edge));
  law.dynamicFriction = 1.1 * edge / sigma;
  EXPECT_TRUE(law.mayBeCrushed(0, sigma, 10 * edge));
  law.dynamicFriction = -1;
  law.dilation = .1;
  EXPECT_TRUE(law.mayBeCrushed(0, sigma, 0));
}

TEST(Crushing_Shear, withoutWeightShearDoesNotCrush)
{
  Joint joint = crushedMortar(0, 50);
  joint.law.curve.crushing.shearWeight = 0;
  JointRun run(joint);
  run.step(-run.joint.closureUnder(.5 * fm), {});
  const Real k = crushing(run);
  run.go(run.gap, {0, 1e-3, 0}, 1000);
  EXPECT_EQ(crushing(run), k);
}

TEST(Crushing_Tension, aBondThatLosesStiffnessUnloadsToItsPlasticPart)
{
  constexpr Real ft = .25e6, G1 = 18;
  for (const Real loss : {.25, .6, 1.})
    for (const Real k : {1e-5, 7e-5, 2e-4})
    {
      JointRun run(crushedMortar(loss));
      const Real sigma = ft * std::exp(-ft * k / G1), open = k + sigma / masonryKn,
                 rest = (1 - loss) * k;
      run.go(open, {}, 40);
      EXPECT_NEAR(run.sigma(), -sigma, 1e-10 * ft) << "the envelope is the same";
      EXPECT_NEAR(run.stored(), .5 * sigma * (open - rest), 1e-12);
      EXPECT_NEAR(run.fracture, G1 * (1 - sigma / ft) - .5 * loss * sigma * k, 1e-10 * G1);
      run.step(rest + .5 * (open - rest), {});
      EXPECT_NEAR(run.sigma(), -.5 * sigma, 1e-9 * ft);
      run.step(rest - 1e-6, {});
      EXPECT_NEAR(run.sigma(), masonryKn * 1e-6, 1e-9 * masonryKn * 1e-6)
          << "closed, it is stiff again";
      run.step(open, {});
      EXPECT_NEAR(run.sigma(), -sigma, 1e-9 * ft);
    }
}

TEST(Crushing_Tension, cyclesThroughBothSidesKeepTheirLedger)
{
  for (const Real loss : {0., .3, 1.})
  {
    JointRun run(crushedMortar(loss));
    for (const Real gap : {2e-5, -1.5e-4, 6e-5, -6e-4, 0., -1.2e-3, 1e-4, -3e-3, 0.})
    {
      run.go(gap, {3e-6, -2e-6, 0}, 4000);
      EXPECT_GE(run.stored(), 0);
      EXPECT_GE(run.leastDissipation, 0);
    }
    EXPECT_NEAR(run.imbalance(), 0, 1e-3 * run.work);
  }
}
