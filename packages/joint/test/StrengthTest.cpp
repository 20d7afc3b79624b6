#include "Joints.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace coplane;

namespace
{
constexpr Real degree = pi / 180;

/// Slow shear under a constant normal traction of a linear joint.
Real tractionAtSpeed(const Joint& joint, Real sigma, Real speed)
{
  JointRun run(joint);
  run.step(-sigma / joint.fit.normalStiffness, {});
  run.go(run.gap, {1e-3, 0, 0}, 100, 1e-5 / speed);
  return norm(run.state.shearTraction);
}
} // namespace

TEST(Friction_OfSpeed, fallsFromStaticToDynamic)
{
  Joint joint = linearJoint(1e11, 5e10, .7);
  joint.law.dynamicFriction = .4;
  joint.law.slipSpeed = .2;
  for (const Real v : {1e-9, .05, .2, 1., 50.})
    EXPECT_NEAR(tractionAtSpeed(joint, 2e6, v), 2e6 * (.4 + .3 * std::exp(-v / .2)), 1e-6);
  EXPECT_NEAR(tractionAtSpeed(joint, 2e6, 1e-9), 1.4e6, 1e-2);
}

TEST(Friction_Dilation, raisesTheOffsetByTheTangentOfTheSlipUntilItsLimit)
{
  // Gap held: sigma = sigma0 + k tan(psi) slip, tau = mu sigma.
  Joint joint = linearJoint(1e11, 5e10, .6);
  joint.law.dilation = .1;
  joint.law.dilationSlip = 1e-4;
  JointRun run(joint);
  run.step(-2e-5, {});
  run.go(-2e-5, {0, 8e-5, 0}, 400);
  const Real slip = run.state.slip;
  ASSERT_LT(slip, 1e-4);
  EXPECT_NEAR(run.offset, .1 * slip, 1e-18);
  EXPECT_NEAR(run.sigma(), 2e6 + 1e11 * .1 * slip, 1e-3);
  EXPECT_NEAR(norm(run.state.shearTraction), .6 * run.sigma(), 1e-3);
  EXPECT_NEAR(run.imbalance(), 0, 1e-10 * run.work);
  run.go(-2e-5, {0, 2e-4, 0}, 400);
  EXPECT_NEAR(run.offset, 1e-5, 1e-18);
  EXPECT_NEAR(run.sigma(), 3e6, 1e-3);
}

TEST(Friction_Dilation, liftsUnderAConstantTraction)
{
  Joint joint = linearJoint(1e11, 5e10, .6);
  joint.law.dilation = std::tan(10 * degree);
  JointRun run(joint);
  run.step(-2e-5, {});
  for (int i = 0; i < 10000; ++i)
    run.step(run.offset - 2e-5, {1e-7, 0, 0});
  EXPECT_NEAR(run.gap + 2e-5, std::tan(10 * degree) * run.state.slip, 1.8e-8)
      << "the gap follows one step of 1e-7 m later";
  EXPECT_NEAR(run.imbalance(), 0, 1e-3 * run.work) << "k (lift of a step)^2 / 2 in each step";
}

// A caller that keeps the shear energy while the area A falls to A / r^2 raises the traction by r.

namespace
{
/// Joints that slide at their strength, 1 mm on.
std::vector<JointRun> slidingJoints()
{
  Joint dilating = linearJoint(1e11, 5e10, .6);
  dilating.law.dilation = .1;
  std::vector<JointRun> runs;
  for (const Joint& joint : {linearJoint(1e11, 5e10, .6), dilating, roughJoint(), mortarJoint()})
  {
    runs.emplace_back(joint);
    runs.back().go(-2e-5, {1e-3, 0, 0}, 1000);
    EXPECT_GT(runs.back().state.slip, 8e-4);
  }
  return runs;
}
} // namespace

TEST(Friction_OfAnAreaThatShrinks, slipsBackToTheStrengthWithoutASlipPath)
{
  for (const JointRun& run : slidingJoints())
    for (const Real r : {1.5, 40., 1e4})
    {
      const Real most = norm(run.state.shearTraction), k = run.joint.fit.shearStiffness;
      JointState state = run.state;
      state.shearTraction = r * state.shearTraction;
      const JointResponse response =
          run.joint.law(run.joint.fit, run.closure(), {}, 1e-6, state, r);
      EXPECT_NEAR(state.slip, run.state.slip, 1e-15);
      EXPECT_NEAR(response.dilation, 0, 1e-16);
      const Real left = norm(state.shearTraction);
      EXPECT_NEAR(left / most, 1, 1e-3) << "the strength of rough joints falls with the slip";
      const Real lost = .5 * (r * r * most * most - left * left) / k;
      EXPECT_NEAR((response.frictionWork + response.fractureWork) / lost, 1, 1e-9);
    }
}

TEST(Friction_OfAnAreaThatShrinks, countsTheSlipThatHappens)
{
  const Real d = 1e-6;
  for (const JointRun& run : slidingJoints())
    for (const Real r : {1.5, 40., 1e4})
    {
      JointState same = run.state, shrinking = run.state;
      const JointResponse expected =
          run.joint.law(run.joint.fit, run.closure(), {d, 0, 0}, 1e-6, same);
      shrinking.shearTraction = r * shrinking.shearTraction;
      const JointResponse response =
          run.joint.law(run.joint.fit, run.closure(), {.5 * (r + 1) * d, 0, 0}, 1e-6, shrinking, r);
      EXPECT_NEAR(shrinking.slip - run.state.slip, same.slip - run.state.slip, 1e-6 * d);
      EXPECT_NEAR(response.dilation, expected.dilation, 1e-6 * d);
      EXPECT_NEAR(norm(shrinking.shearTraction - same.shearTraction), 0,
                  1e-6 * norm(same.shearTraction));
    }
}

// JRC 8, JCS 100 MPa, phi_r 30 degrees, sigma 1 MPa: log10(100) = 2, i = 16 degrees.

TEST(BartonBandis_Strength, mobilisesFrictionThenRoughnessAndWearsIt)
{
  const BartonBandis rough{8, 100e6, 30 * degree, 2e-3};
  const auto angle = [&](Real ratio)
  { return std::atan(rough.friction(1e6, ratio * 2e-3)) / degree; };
  EXPECT_NEAR(angle(0), 0, 1e-12);
  EXPECT_NEAR(angle(.15), 15, 1e-12);
  EXPECT_NEAR(angle(.3), 30, 1e-12);
  EXPECT_NEAR(angle(.45), 30 + .375 * 16, 1e-12);
  EXPECT_NEAR(angle(.6), 30 + .75 * 16, 1e-12);
  EXPECT_NEAR(angle(1), 46, 1e-12);
  EXPECT_NEAR(angle(2), 30 + .85 * 16, 1e-12);
  EXPECT_NEAR(angle(4), 30 + .7 * 16, 1e-12);
  EXPECT_NEAR(angle(10), 38, 1e-12);
  EXPECT_NEAR(angle(55), 34, 1e-12);
  EXPECT_NEAR(angle(200), 30, 1e-12);
}

TEST(BartonBandis_Strength, neverExceedsSeventyDegreesNorFallsBelowTheResidualAngle)
{
  const BartonBandis rough{20, 100e6, 30 * degree, 2e-3};
  EXPECT_NEAR(rough.friction(1e3, 2e-3), std::tan(70 * degree), 1e-12); // 30 + 20 * 5 degrees
  EXPECT_NEAR(rough.friction(200e6, 2e-3), std::tan(30 * degree), 1e-14);
  EXPECT_NEAR(rough.dilation(1e3, 2e-3), std::tan(20 * degree), 1e-12);
}

TEST(BartonBandis_Strength, dilatesByHalfOfTheMobilisedRoughness)
{
  const BartonBandis rough{8, 100e6, 30 * degree, 2e-3};
  EXPECT_EQ(rough.dilation(1e6, .2 * 2e-3), 0.0);
  EXPECT_NEAR(rough.dilation(1e6, 2e-3), std::tan(8 * degree), 1e-14);
  EXPECT_NEAR(rough.dilation(1e6, 4 * 2e-3), std::tan(5.6 * degree), 1e-14);
}

TEST(BartonBandis_Strength, directShearUnderAConstantTractionReachesThePeakStrength)
{
  JointRun run(roughJoint());
  const Real closure = run.joint.closureUnder(1e6);
  run.go(-closure, {}, 20);
  Real peak = 0, slipAtPeak = 0;
  for (int i = 0; i < 32000; ++i)
  {
    run.step(run.offset - closure, {2.5e-7, 0, 0});
    if (norm(run.state.shearTraction) > peak)
    {
      peak = norm(run.state.shearTraction);
      slipAtPeak = run.state.slip;
    }
  }
  EXPECT_NEAR(peak, 1e6 * std::tan(46 * degree), 2e-3 * 1e6);
  EXPECT_NEAR(slipAtPeak, 2e-3, 1e-5);
  EXPECT_GT(run.offset, 4e-4) << "about 6 mm at five to eight degrees, after the first 0.6 mm";
  EXPECT_GE(run.leastDissipation, 0.0);
}

TEST(BartonBandis_Strength, liftsByItsTangentTimesTheSlipWhateverTheStep)
{
  for (const Real step : {1e-6, 1e-5, 5e-5})
  {
    JointRun run(roughJoint());
    run.go(-run.joint.closureUnder(1e6), {}, 20);
    run.go(run.gap, {2e-3, 0, 0}, 2000);
    const Real slip = run.state.slip, sigma = run.sigma();
    run.step(run.gap, {step, 0, 0});
    const Real tangent = run.joint.law.rough.dilation(sigma, slip);
    ASSERT_GT(tangent, .05);
    EXPECT_NEAR(run.last.dilation, tangent * (run.state.slip - slip), 2e-4 * run.last.dilation);
  }
}

TEST(BartonBandis_Estimate, followsBandisLumsdenAndBarton)
{
  // JRC 10, JCS 100 MPa, sigma_c 150 MPa: a = 2 (.3 - .1) = .4 mm, JCS/a = 250 MPa/mm;
  // k_ni = -7.15 + 17.5 + 5 = 15.35 MPa/mm; c_m = -.296 - .056 + 2.241 * 250^-.245 mm, where
  // 250^-.245 = exp(-1.352758) = .258526, hence .227357 mm.
  const BandisEstimate estimate = bandisEstimate(10, 100e6, 150e6);
  EXPECT_NEAR(estimate.aperture, .4e-3, 1e-16);
  EXPECT_NEAR(estimate.initialStiffness, 15.35e9, 1);
  EXPECT_NEAR(estimate.maximumClosure, .227357e-3, 2e-9);
}

TEST(BartonBandis_Closure, hasTheStiffnessOfThePublishedExpression)
{
  // k_n = k_ni (1 - sigma / (c_m k_ni + sigma))^-2 with k_ni 2e10, c_m 2e-4: c_m k_ni = 4 MPa.
  const Joint joint = roughJoint();
  for (const Real sigma : {1e5, 1e6, 7e6})
    EXPECT_NEAR(joint.loadingStiffness(joint.closureUnder(sigma)),
                2e10 * std::pow(1 - sigma / (4e6 + sigma), -2), 1e-2);
}

// Table: slopes 1e10, 3e10, 1e11 up to 1, 4, 9 MPa at .1, .2, .25 mm.

TEST(ClosureTable, loadsAlongItsPointsAndOnStraight)
{
  const Joint joint = tableJoint();
  EXPECT_NEAR(joint.loadingTraction(.5e-4), .5e6, 1e-8);
  EXPECT_NEAR(joint.loadingTraction(1e-4), 1e6, 1e-8);
  EXPECT_NEAR(joint.loadingTraction(1.5e-4), 2.5e6, 1e-8);
  EXPECT_NEAR(joint.loadingTraction(2.25e-4), 6.5e6, 1e-8);
  EXPECT_NEAR(joint.loadingTraction(3e-4), 14e6, 1e-8);
  for (const Real c : {.3e-4, 1.2e-4, 2.4e-4, 4e-4})
    EXPECT_NEAR(joint.closureUnder(joint.loadingTraction(c)), c, 1e-12 * c);
  EXPECT_NEAR(joint.loadingWork(2e-4), 50 + 250, 1e-10);
  // 4 MPa with the slope ahead of 1e11: gives back 16e12 / 2e11 = 80.
  EXPECT_NEAR(joint.hysteresisWork(2e-4), 300 - 80, 1e-10);
}

TEST(ClosureTable, unloadsAlongTheTangent)
{
  JointRun run(tableJoint());
  run.go(-1.5e-4, {}, 6); // 2.5 MPa on the slope 3e10: zero at 1.5e-4 - 2.5e6 / 3e10
  run.step(-1e-4, {});
  EXPECT_NEAR(run.sigma(), 1e6, 1e-7);
  run.step(-.66e-4, {});
  EXPECT_EQ(run.sigma(), 0.0);
}

TEST(ClosureTable, goesOnWithTheCapWhereItWouldBeSteeper)
{
  Joint joint = tableJoint();
  joint.fit.stiffnessCap = 2e10;
  EXPECT_NEAR(joint.loadingTraction(3e-4), 1e6 + 2e10 * 2e-4, 1e-7);
  EXPECT_EQ(joint.law.stiffnessBound(joint.fit, {}), 2e10);
  EXPECT_NEAR(joint.closureUnder(5e6), 3e-4, 1e-16);
}
