#include "Joints.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace coplane;

// Closure and Coulomb friction: the laws `penalty`, `linear` and `closure_curve` of a deck.

namespace
{
constexpr Real maximum = 2e-4; ///< c_m [m]

Joint hyperbolic()
{
  Joint joint;
  joint.fit = {1e11, infinity, 5e10};
  joint.law.curve.inverseMaximumClosure = 1 / maximum;
  joint.law.friction = .6;
  return joint;
}

Joint linear(Real k)
{
  Joint joint;
  joint.fit = {k, infinity, 5e10};
  joint.law.friction = .6;
  return joint;
}

/// Closure under 2 MPa in a linear joint of 1e11 Pa/m.
constexpr Real pressed = 2e-5;

/// Work of the normal traction along a path of closure, by Gauss-Legendre of order 6 in many
/// pieces: exact to round-off where the curve is smooth within a piece.
Real workAlong(const Joint& joint, JointState& state, Real from, Real to)
{
  const Real node[3] = {-std::sqrt(.6), 0, std::sqrt(.6)}, weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  const int pieces = 4000;
  Real work = 0;
  for (int i = 0; i < pieces; ++i)
    for (int g = 0; g < 3; ++g)
    {
      const Real c = from + (to - from) * (i + .5 + .5 * node[g]) / pieces;
      work += joint.normal(c, state).normalTraction * .5 * weight[g] * (to - from) / pieces;
    }
  joint.normal(to, state);
  return work;
}
} // namespace

// The curve: sigma = k c / (1 - x), slope k / (1 - x)^2, W = k c_m^2 (-x - ln(1 - x)), with
// x = c / c_m; what the tangent gives back is U = sigma^2 / (2 slope) = k c_m^2 x^2 / 2. Here
// k c_m = 20 MPa and k c_m^2 = 4000 J/m^2.

TEST(JointLaw_LoadingCurve, tractionAtAFifthHalfAndFourFifthsOfTheMaximumClosure)
{
  const Joint joint = hyperbolic();
  EXPECT_NEAR(joint.loadingTraction(.2 * maximum), 5e6, 5e6 * 1e-14);
  EXPECT_NEAR(joint.loadingTraction(.5 * maximum), 20e6, 20e6 * 1e-14);
  EXPECT_NEAR(joint.loadingTraction(.8 * maximum), 80e6, 80e6 * 1e-14);
}

TEST(JointLaw_LoadingCurve, stiffnessAtAFifthHalfAndFourFifthsOfTheMaximumClosure)
{
  const Joint joint = hyperbolic();
  EXPECT_NEAR(joint.loadingStiffness(.2 * maximum), 1.5625e11, 1e-3);
  EXPECT_NEAR(joint.loadingStiffness(.5 * maximum), 4e11, 1e-3);
  EXPECT_NEAR(joint.loadingStiffness(.8 * maximum), 2.5e12, 1e-2);
}

TEST(JointLaw_LoadingCurve, workIsTheIntegralOfTheTraction)
{
  const Joint joint = hyperbolic();
  for (const Real x : {.001, .009, .011, .2, .5, .8}) // on both sides of the series at x = 0.01
  {
    JointState state;
    const Real expected =
        4000 * (x < .1 ? x * x / 2 + x * x * x / 3 + std::pow(x, 4) / 4 + std::pow(x, 5) / 5 +
                             std::pow(x, 6) / 6 + std::pow(x, 7) / 7 + std::pow(x, 8) / 8
                       : -x - std::log(1 - x));
    EXPECT_NEAR(joint.loadingWork(x * maximum), expected, 1e-13 * expected) << x;
    EXPECT_NEAR(workAlong(joint, state, 0, x * maximum), expected, 1e-11 * expected) << x;
  }
}

TEST(JointLaw_LoadingCurve, lossesOfALoadUnloadCycleAreThoseOfTheTangent)
{
  const Joint joint = hyperbolic();
  // x, -x - ln(1-x), x^2/2 -> loss / work: 13.58 %, 35.28 %, 60.47 %.
  for (const auto& [x, share] : {std::pair{.2, .1358}, {.5, .3528}, {.8, .6047}})
  {
    const Real work = 4000 * (-x - std::log1p(-x)), recovered = 2000 * x * x;
    EXPECT_NEAR(joint.hysteresisWork(x * maximum), work - recovered, 1e-12 * work);
    EXPECT_NEAR(joint.hysteresisWork(x * maximum) / joint.loadingWork(x * maximum), share, 5e-5);
  }
}

TEST(JointLaw_LoadingCurve, closureUnderATractionInvertsTheCurve)
{
  Joint joint = hyperbolic();
  joint.fit.stiffnessCap = 4e11;
  for (const Real c : {1e-9, 2e-5, 9e-5, 1e-4, 1.5e-4, 5e-4})
    EXPECT_NEAR(joint.closureUnder(joint.loadingTraction(c)), c, 1e-13 * c);
  EXPECT_EQ(joint.closureUnder(0), 0.0);
  EXPECT_EQ(joint.closureUnder(-1e5), 0.0)
      << "a joint does not open under tension: it carries none";
}

TEST(JointLaw_Unloading, followsTheTangentDownToTheResidualClosure)
{
  // Zero where sigma / slope is used up: c_res = c - c (1 - x) = c^2 / c_m.
  const Joint joint = hyperbolic();
  for (const Real x : {.2, .5, .8})
  {
    JointState state;
    joint.normal(x * maximum, state);
    const Real residual = x * x * maximum;
    const Real slope = 1e11 / ((1 - x) * (1 - x));
    const Real half = .5 * (x * maximum + residual);
    EXPECT_NEAR(joint.normal(half, state).normalTraction, slope * (half - residual),
                1e-12 * slope * half);
    EXPECT_NEAR(joint.normal(residual * (1 + 1e-12), state).normalTraction, 0,
                slope * residual * 1e-11);
    EXPECT_EQ(joint.normal(residual * (1 - 1e-12), state).normalTraction, 0.0);
    EXPECT_EQ(state.maximumClosure, x * maximum);
  }
}

TEST(JointLaw_Unloading, openJointCarriesNoTensionAndKeepsItsMaximumClosure)
{
  const Joint joint = hyperbolic();
  JointState state;
  joint.normal(1e-4, state);
  EXPECT_EQ(joint.normal(-1e-3, state).normalTraction, 0.0);
  EXPECT_EQ(state.maximumClosure, 1e-4);
}

TEST(JointLaw_Unloading, drivenPathReturnsTheEnergiesOfTheCurve)
{
  // 0 -> .5 c_m -> c_res = .25 c_m -> .8 c_m -> 0.
  const Joint joint = hyperbolic();
  JointState state;
  const Real work5 = 4000 * (-.5 - std::log(.5)), work8 = 4000 * (-.8 - std::log1p(-.8));
  EXPECT_NEAR(workAlong(joint, state, 0, .5 * maximum), work5, 1e-10 * work5);
  EXPECT_NEAR(workAlong(joint, state, .5 * maximum, .25 * maximum), -500, 500e-10);
  // Back up the tangent: 500 J/m^2, then on along the hyperbola.
  EXPECT_NEAR(workAlong(joint, state, .25 * maximum, .5 * maximum), 500, 500e-10);
  EXPECT_NEAR(workAlong(joint, state, .5 * maximum, .8 * maximum), work8 - work5, 1e-10 * work8);
  // Down to zero at .64 c_m and nothing below; the kink is given as an end of a part.
  EXPECT_NEAR(workAlong(joint, state, .8 * maximum, .64 * maximum), -1280, 1280e-10);
  EXPECT_NEAR(workAlong(joint, state, .64 * maximum, 0), 0, 1280e-10);
  EXPECT_NEAR(joint.hysteresisWork(state.maximumClosure), work8 - 1280, 1e-10 * work8);
}

TEST(JointLaw_StiffnessCap, continuesTheCurveWithItsOwnSlope)
{
  // k_max = 4 k: slope reached at x = 1 - sqrt(1/4) = 1/2, where sigma = 20 MPa.
  Joint joint = hyperbolic();
  joint.fit.stiffnessCap = 4e11;
  EXPECT_NEAR(joint.cappedFrom(), 1e-4, 1e-18);
  EXPECT_NEAR(joint.loadingTraction(3e-4), 20e6 + 4e11 * 2e-4, 1e-4);
  EXPECT_EQ(joint.loadingStiffness(3e-4), 4e11);
  EXPECT_TRUE(std::isfinite(joint.loadingTraction(10 * maximum)));
}

TEST(JointLaw_StiffnessCap, tractionAndSlopeAreContinuousWhereItStarts)
{
  Joint joint = hyperbolic();
  joint.fit.stiffnessCap = 4e11;
  const Real before = 1e-4 * (1 - 1e-9), after = 1e-4 * (1 + 1e-9);
  EXPECT_NEAR(joint.loadingTraction(after) - joint.loadingTraction(before), 4e11 * 2e-13, 1e-3);
  EXPECT_NEAR(joint.loadingStiffness(before), joint.loadingStiffness(after), 4e11 * 1e-8);
  EXPECT_NEAR(joint.loadingWork(after) - joint.loadingWork(before), 20e6 * 2e-13, 1e-11);
}

TEST(JointLaw_StiffnessCap, workBeyondItIsTheIntegralOfTheTraction)
{
  Joint joint = hyperbolic();
  joint.fit.stiffnessCap = 4e11;
  JointState state;
  Real work = workAlong(joint, state, 0, 1e-4);
  work += workAlong(joint, state, 1e-4, 3e-4);
  EXPECT_NEAR(joint.loadingWork(3e-4), work, 1e-11 * work);
  // sigma = 100 MPa, slope 4e11: the tangent gives back 100e6^2 / 8e11 = 12500.
  EXPECT_NEAR(joint.hysteresisWork(3e-4), work - 12500, 1e-10 * work);
}

TEST(JointLaw_StiffnessCap, belowTheInitialStiffnessMakesTheJointLinear)
{
  // Coarse elements give a cap of half their own stiffness, which may be less than the joint's.
  Joint joint = hyperbolic();
  joint.fit.stiffnessCap = 4e10;
  EXPECT_EQ(joint.loadingTraction(0), 0.0);
  EXPECT_NEAR(joint.loadingTraction(1e-5), 4e5, 1e-8);
  EXPECT_EQ(joint.loadingStiffness(0), 4e10);
  EXPECT_NEAR(joint.loadingWork(1e-5), .5 * 4e10 * 1e-10, 1e-15);
  EXPECT_NEAR(joint.closureUnder(4e5), 1e-5, 1e-19);
}

TEST(JointLaw_Linear, tractionIsProportionalToClosureInBothDirections)
{
  const Joint joint = linear(1e11);
  JointState state;
  EXPECT_NEAR(joint.normal(2e-5, state).normalTraction, 2e6, 1e-9);
  EXPECT_NEAR(joint.normal(1e-5, state).normalTraction, 1e6, 1e-9);
  EXPECT_EQ(joint.normal(-1e-5, state).normalTraction, 0.0);
  EXPECT_EQ(joint.hysteresisWork(2e-5), 0.0);
  EXPECT_NEAR(joint.loadingWork(2e-5), 20, 1e-13); // k c^2 / 2
}

TEST(JointLaw_Shear, sticksWithTheShearStiffnessUpToTheStrength)
{
  // mu sigma = .6 * 2 MPa = 1.2 MPa, reached at 1.2e6 / 5e10 = 2.4e-5 m. Drag of 1e-6 m a step.
  const Joint joint = linear(1e11);
  JointState state;
  for (int step = 1; step <= 23; ++step)
  {
    const auto response = joint(pressed, {1e-6, 0, 0}, state);
    EXPECT_NEAR(state.shearTraction.x, -5e10 * step * 1e-6, 1.2e6 * 1e-10);
    EXPECT_FALSE(response.slipping);
  }
  EXPECT_EQ(state.slip, 0.0);
}

TEST(JointLaw_Shear, slipsAtTheStrengthAndDissipatesStrengthTimesSlip)
{
  const Joint joint = linear(1e11);
  JointState state;
  Real dissipated = 0;
  for (int step = 1; step <= 100; ++step) // 1e-4 m, of which 2.4e-5 are elastic
    dissipated += joint(pressed, {1e-6, 0, 0}, state).frictionWork;
  EXPECT_NEAR(state.shearTraction.x, -1.2e6, 1.2e6 * 1e-10);
  EXPECT_NEAR(state.slip, 7.6e-5, 7.6e-5 * 1e-10);
  EXPECT_NEAR(dissipated, 1.2e6 * 7.6e-5, 91.2e-10);
}

TEST(JointLaw_Shear, reversalUnloadsWithTheShearStiffness)
{
  const Joint joint = linear(1e11);
  JointState state;
  for (int step = 0; step < 40; ++step)
    joint(pressed, {1e-6, 0, 0}, state);
  const Real before = state.shearTraction.x;
  joint(pressed, {-1e-6, 0, 0}, state);
  EXPECT_NEAR((state.shearTraction.x - before) / 1e-6, 5e10, 5e10 * 1e-9);
  // Two strengths until it slips the other way: 4.8e-5 m.
  for (int step = 0; step < 60; ++step)
    joint(pressed, {-1e-6, 0, 0}, state);
  EXPECT_NEAR(state.shearTraction.x, 1.2e6, 1.2e6 * 1e-10);
}

TEST(JointLaw_Shear, workOfAnyPathIsStoredOrDissipated)
{
  // The trapezoid of tractions is exact for the elastic part, so work = stored + friction whatever
  // the steps are.
  const Joint joint = linear(1e11);
  JointState state;
  Real work = 0, friction = 0;
  for (int step = 0; step < 500; ++step)
  {
    const Vec3 increment{3.7e-6 * std::sin(.1 * step), 2.9e-6 * std::cos(.23 * step), 0};
    const Vec3 before = state.shearTraction;
    const auto response = joint(pressed, increment, state);
    work -= .5 * dot(before + state.shearTraction, increment);
    friction += response.frictionWork;
    EXPECT_GE(response.frictionWork, -1e-15);
  }
  const Real stored = .5 * dot(state.shearTraction, state.shearTraction) / 5e10;
  EXPECT_GT(friction, 10 * stored);
  EXPECT_NEAR(work, stored + friction, 1e-10 * work);
}

TEST(JointLaw_Shear, circularDragKeepsTheStrengthAndLagsTheTangent)
{
  // The elastic part is a rope of length a = 2.4e-5 whose end P is led around a circle of radius
  // R = 1e-3 in steps of an angle t; its other end Q is dragged along the line to the new P.
  // Steady: Q goes around a circle of radius r with chords 2 r sin(t/2), and P lies at r sin(t/2) +
  // a from the middle of the chord, so R^2 = r^2 + 2 a r sin(t/2) + a^2. The rope is normal to the
  // radius through that middle: the angle to the tangent at P has cos = r cos(t/2) / R.
  const Joint joint = linear(1e11);
  const Real R = 1e-3, a = 2.4e-5, t = 2 * pi / 10000;
  const Real h = a * std::sin(t / 2);
  const Real r = -h + std::sqrt(h * h + R * R - a * a);
  JointState state;
  for (int step = 1; step <= 12345; ++step)
  {
    // In the plane x = 0, to use all of the vector.
    const Vec3 increment{0, R * (std::cos(step * t) - std::cos((step - 1) * t)),
                         R * (std::sin(step * t) - std::sin((step - 1) * t))};
    joint(pressed, increment, state);
    if (step > 2000)
    {
      ASSERT_NEAR(norm(state.shearTraction), 1.2e6, 1.2e6 * 1e-10);
    }
  }
  const Vec3 tangent{0, -std::sin(12345 * t), std::cos(12345 * t)};
  const Vec3 radius{0, std::cos(12345 * t), std::sin(12345 * t)};
  const Vec3 pull = (-1 / 1.2e6) * state.shearTraction; // from Q to P
  EXPECT_NEAR(dot(pull, tangent), r * std::cos(t / 2) / R, 1e-10);
  EXPECT_GT(dot(pull, radius), 0) << "Q lies inside the circle of P";
  EXPECT_NEAR(std::acos(dot(pull, tangent)), .024, 2e-4 + t); // a / R when the steps are small
}

TEST(JointLaw_Shear, cohesionAddsToTheStrength)
{
  Joint joint = linear(1e11);
  joint.law.cohesion = 3e5;
  JointState state;
  joint(pressed, {0, 1e-3, 0}, state);
  EXPECT_NEAR(state.shearTraction.y, -1.5e6, 1.5e6 * 1e-12);
}

TEST(JointLaw_Shear, lossOfPressureClearsTheTraction)
{
  const Joint joint = linear(1e11);
  JointState state;
  joint(pressed, {1e-5, 0, 0}, state);
  joint(-1e-9, {0, 0, 0}, state);
  EXPECT_EQ(norm(state.shearTraction), 0.0);
}

TEST(JointLaw_Shear, frictionlessJointHasNoShearTractionAndNoDissipation)
{
  Joint joint = linear(1e11);
  joint.law.friction = 0;
  JointState state;
  const auto response = joint(pressed, {1e-5, 2e-5, 0}, state);
  EXPECT_EQ(norm(state.shearTraction), 0.0);
  EXPECT_EQ(response.frictionWork, 0.0);
}

TEST(JointLaw_Shear, lossOfPressureTurnsStoredShearIntoFriction)
{
  // tau = 5e10 * 1e-5 = 5e5 Pa, which holds 5e5^2 / 1e11 = 2.5 J/m^2.
  const Joint joint = linear(1e11);
  JointState state;
  joint(pressed, {1e-5, 0, 0}, state);
  EXPECT_NEAR(joint(-1e-9, {0, 0, 0}, state).frictionWork, 2.5, 1e-14);
}

TEST(JointLaw_Shear, cohesionOfAnOpenJointActsNoMore)
{
  Joint joint = linear(1e11);
  joint.law.cohesion = 3e5;
  JointState state;
  joint(-1e-9, {1e-6, 0, 0}, state);
  EXPECT_EQ(norm(state.shearTraction), 0.0);
}

TEST(JointLaw_Energies, hysteresisOfStepsAddsUpToThatOfTheLargestClosure)
{
  const Joint joint = hyperbolic();
  JointState state;
  Real hysteresis = 0;
  for (const Real x : {.1, .3, .2, .05, .5, -.1, .4, .8, 0.})
    hysteresis += joint.normal(x * maximum, state).curveWork;
  const Real expected = 4000 * (-.8 - std::log1p(-.8)) - 1280;
  EXPECT_NEAR(hysteresis, expected, 1e-12 * expected);
}

TEST(JointLaw_Energies, storedIsWhatUnloadingGivesBack)
{
  const Joint joint = hyperbolic();
  JointState state;
  joint.normal(.5 * maximum, state);
  EXPECT_NEAR(joint.stored(.5 * maximum, state), 500, 1e-10);
  // Half way down the tangent, at c = .375 c_m: half the traction, a quarter of the energy.
  joint(.375 * maximum, {1e-5, 0, 0}, state); // and 2.5 J/m^2 of shear
  EXPECT_NEAR(joint.stored(.375 * maximum, state), 125 + 2.5, 1e-10);
  EXPECT_NEAR(joint.stored(.25 * maximum, state), 2.5, 1e-10);
}

TEST(JointLaw_Fit, penaltyTakesItsStiffnessFromTheElementsInSeries)
{
  // 2 / (.1/1e10 + .3/2e10) = 2 / 2.5e-11 = 8e10.
  JointLaw law;
  const JointFit fit = law.fittedTo(.1, 1e10, .3, 2e10);
  EXPECT_NEAR(fit.normalStiffness, 8e10, 8e-5);
  EXPECT_NEAR(fit.shearStiffness, 4e10, 4e-5);
  EXPECT_EQ(fit.stiffnessCap, infinity);
}

TEST(JointLaw_Fit, curvesAreCappedAtHalfTheSofterElementButNotBelowTheirOwnStart)
{
  JointLaw law;
  law.penalty = false;
  law.initialStiffness = 1e10;
  law.curve.inverseMaximumClosure = 5e3;
  EXPECT_NEAR(law.fittedTo(.1, 1e10, .3, 2e10).stiffnessCap, .5 * 2e10 / .3, 1e-5);
  law.initialStiffness = 4e10;
  EXPECT_EQ(law.fittedTo(.1, 1e10, .3, 2e10).stiffnessCap, 4e10);
  law.stiffnessCap = 9e10;
  law.shearStiffness = 3e9;
  EXPECT_EQ(law.fittedTo(.1, 1e10, .3, 2e10).stiffnessCap, 9e10);
  EXPECT_EQ(law.fittedTo(.1, 1e10, .3, 2e10).shearStiffness, 3e9);
}

TEST(JointLaw_Stiffness, boundIsTheSlopeAtTheLargestClosureOrTheShearStiffness)
{
  Joint joint = hyperbolic();
  JointState state;
  joint.normal(.5 * maximum, state);
  joint.normal(0, state);
  EXPECT_NEAR(joint.law.stiffnessBound(joint.fit, state), 4e11, 1e-3);
  joint.fit.shearStiffness = 7e11;
  EXPECT_EQ(joint.law.stiffnessBound(joint.fit, state), 7e11);
}
