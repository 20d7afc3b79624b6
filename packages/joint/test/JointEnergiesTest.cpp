#include "Joints.hpp"

#include <gtest/gtest.h>

#include <random>

using namespace coplane;

namespace
{
struct Named
{
  const char* name;
  Joint joint;
  Real depth; ///< of the paths [m]
};

std::vector<Named> allJoints()
{
  Joint cohesive = linearJoint(1e11, 5e10, .6);
  cohesive.law.bond.kind = Bond::Kind::Brittle;
  cohesive.law.bond.tensileStrength = 1e6;
  cohesive.law.cohesion = 2e5;
  Joint hyperbola = linearJoint(1e11, 5e10, .6);
  hyperbola.law.curve.inverseMaximumClosure = 1 / 2e-4;
  hyperbola.fit.stiffnessCap = 1e12;
  Joint dilating = linearJoint(1e11, 5e10, .6);
  dilating.law.dilation = .2;
  dilating.law.dilationSlip = 1e-3;
  Joint slippery = linearJoint(1e11, 5e10, .6);
  slippery.law.dynamicFriction = .3;
  slippery.law.slipSpeed = .5;
  Joint curvedMortar = mortarJoint();
  curvedMortar.law.curve.inverseMaximumClosure = 1 / 1e-4;
  curvedMortar.fit = curvedMortar.law.fittedTo(1, 1e12, 1, 1e12);
  // So soft that the paths crush it to the end.
  Joint soft = crushedMortar(), weaker = crushedMortar(.6);
  for (Joint* joint : {&soft, &weaker})
  {
    joint->law.curve.crushing.strength = 8e5;
    joint->law.curve.crushing.peak = 5e-6;
    joint->law.curve.crushing.length = 2e-5;
  }
  return {{"linear", linearJoint(1e11, 5e10, .6), 2e-5},
          {"brittle", cohesive, 2e-5},
          {"hyperbola", hyperbola, 1e-4},
          {"table", tableJoint(), 2.6e-4},
          {"rough", roughJoint(), 1e-4},
          {"dilating", dilating, 2e-5},
          {"speed", slippery, 2e-5},
          {"mortar", mortarJoint(), 2e-5},
          {"crushed mortar", soft, 3e-5},
          {"mortar that loses stiffness", weaker, 3e-5},
          {"curved mortar", curvedMortar, 3e-5},
          {"bilinear", mortarJoint(Bond::Kind::Linear), 2e-5}};
}

/// Smooth path with closing, opening and slip in all directions, in n steps.
void wander(JointRun& run, Real depth, int n,
            const Mat3& turn = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}})
{
  const auto at = [&](Real t) {
    return Vec3{3e-5 * std::sin(7 * t) + 4e-5 * t, 5e-5 * std::sin(3.3 * t + .2), 0};
  };
  const auto gap = [&](Real t)
  { return depth * (-.5 * std::sin(5 * t) - .4 * std::sin(2.1 * t) - .25 * std::sin(.7 * t)); };
  for (int i = 1; i <= n; ++i)
  {
    const Real t = 6. * i / n, before = 6. * (i - 1) / n;
    run.step(gap(t), turn * (at(t) - at(before)), 6. / n * 1e-3);
  }
}
} // namespace

TEST(JointEnergies, workOfASmoothPathIsStoredOrDissipated)
{
  // The ledger takes the mean of the tractions of a step, as the planes do; kinks of the curve, and
  // breaking and opening within a step, are met to first order only.
  for (const auto& [name, joint, depth] : allJoints())
  {
    Real error[2], work = 0;
    for (int k = 0; k < 2; ++k)
    {
      JointRun run(joint);
      wander(run, depth, k ? 16000 : 4000);
      error[k] = std::abs(run.imbalance());
      work = run.friction + run.fracture + run.hysteresis;
      EXPECT_GE(run.leastDissipation, 0.0) << name;
    }
    ASSERT_GT(work, 0) << name;
    EXPECT_LT(error[0], 5e-3 * work) << name;
    EXPECT_LT(error[1], 1.3e-3 * work) << name;
  }
}

TEST(JointEnergies, dissipationIsNeverNegativeWhateverThePath)
{
  for (const auto& [name, joint, depth] : allJoints())
  {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<Real> any(-1, 1);
    for (int path = 0; path < 200; ++path)
    {
      JointRun run(joint);
      for (int i = 0; i < 100; ++i)
      {
        run.step(depth * (any(random) - .3) + run.offset,
                 {5e-5 * any(random), 5e-5 * any(random), 5e-5 * any(random)}, 1e-4);
        ASSERT_GE(run.leastDissipation, 0.0) << name;
        ASSERT_TRUE(std::isfinite(run.sigma()) && std::isfinite(norm(run.state.shearTraction)))
            << name;
        ASSERT_GE(run.stored(), 0.0) << name;
        ASSERT_GE(run.last.dilation, 0.0) << name;
        // What is stored is what the tractions say.
        const Real shear = dot(run.state.shearTraction, run.state.shearTraction);
        Real expected = .5 * shear / joint.fit.shearStiffness;
        if (run.last.normalStiffness > 0)
          expected += .5 * run.sigma() * run.sigma() / run.last.normalStiffness;
        ASSERT_NEAR(run.stored(), expected, 1e-6 * (1 + expected)) << name;
      }
    }
  }
}

TEST(JointEnergies, linearPartsForgetTheirPath)
{
  // Pressed, sheared without slip, and turned around: the same state by two ways, and all work
  // comes back.
  for (const auto& joint : {linearJoint(1e11, 5e10, .6), mortarJoint()})
  {
    JointRun one(joint), two(joint);
    one.go(-2e-5, {1e-6, 2e-6, 0}, 10);
    two.go(-2.5e-5, {3e-6, -1e-6, 0}, 4);
    two.go(-2e-5, {-2e-6, 3e-6, 0}, 3);
    EXPECT_NEAR(one.sigma(), two.sigma(), 1e-9 * one.sigma());
    EXPECT_NEAR(norm(one.state.shearTraction - two.state.shearTraction), 0, 1e-6);
    EXPECT_NEAR(one.work, two.work, 1e-12 * one.work);
    EXPECT_NEAR(one.imbalance(), 0, 1e-13 * one.work);
    EXPECT_EQ(two.friction + two.fracture + two.hysteresis, 0.0);
  }
}

TEST(JointEnergies, turnedPathsGiveTurnedTractions)
{
  // Turned by a third about (1,1,1) and 30 degrees about z.
  const Real c = std::cos(.5235987755982988), s = .5;
  const Mat3 turn{{{0, 0, 1}, {c, -s, 0}, {s, c, 0}}};
  for (const auto& [name, joint, depth] : allJoints())
  {
    JointRun straight(joint), turned(joint);
    wander(straight, depth, 500);
    wander(turned, depth, 500, turn);
    const Vec3 expected = turn * straight.state.shearTraction;
    EXPECT_NEAR(norm(expected - turned.state.shearTraction), 0, 1e-3) << name;
    EXPECT_NEAR(straight.sigma(), turned.sigma(), 1e-3) << name;
    EXPECT_NEAR(straight.work, turned.work, 1e-9 * (1 + std::abs(straight.work))) << name;
  }
}
