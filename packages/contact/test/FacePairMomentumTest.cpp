#include "FacePairs.hpp"
#include "WithForces.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace coplane;
using namespace coplane::facepairs;

namespace
{
struct Worst
{
  int pairs = 0;
  Real force = 0, moment = 0, power = 0, uncoupled = infinity, spurious = 0;
};

/// Random forces on the planes of random pairs; all errors relative to the force (and 1 m).
template <int Dim>
Worst worstOf(const ContactOptions& o, int pairs)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<Real> u(-1, 1);
  Worst worst;
  while (worst.pairs < pairs)
  {
    const RandomPair pair = Dim == 2 ? randomSegments(random) : randomPair(random, .2);
    const auto [a, b] = pair;
    const PairContact c = contactOf<Dim>(a, b, o);
    if (!(c.patch.area > 0))
      continue;
    ++worst.pairs;
    const Vec3 force = normalised({u(random), u(random), Dim == 2 ? 0 : u(random)});
    const Vec3 arm =
        weighted(c.patch.weights[1], b.x, b.count) - weighted(c.patch.weights[0], a.x, a.count);
    Vec3 forces[2][4] = {};
    for (int i = 0; i < 4; ++i)
    {
      forces[0][i] = -c.patch.weights[0][i] * force;
      forces[1][i] = c.patch.weights[1][i] * force;
    }
    // Without the couple the moment is arm x force.
    const Real uncoupled = norm(resultant(a, b, forces).moment);
    worst.spurious = std::max(worst.spurious, std::abs(uncoupled - norm(cross(arm, force))));
    worst.uncoupled = std::min(worst.uncoupled, uncoupled / norm(cross(arm, force)));

    addCouple<Dim>(stepA_halfStepFace<Dim>(a, 0), cross(arm, force), 0, forces[0]);
    addCouple<Dim>(stepA_halfStepFace<Dim>(b, 0), cross(arm, force), 0, forces[1]);
    const Resultant sum = resultant(a, b, forces);
    worst.force = std::max(worst.force, norm(sum.force));
    worst.moment = std::max(worst.moment, norm(sum.moment));
    Real power = 0;
    for (int i = 0; i < 4; ++i)
      power += dot(forces[0][i], a.v[i]) + dot(forces[1][i], b.v[i]);
    const Vec3 jump = c.motion().jump;
    worst.power = std::max(worst.power, std::abs(power - dot(force, jump)));
  }
  return worst;
}

struct FacePair_UpdatePlane : WithForces
{
};
INSTANTIATE_TEST_SUITE_P(, FacePair_UpdatePlane, WithForces::both(), WithForces::name);
} // namespace

TEST(FacePair_CornerForces, warpedFacesGetForcesWithoutResultantAndWithoutMoment)
{
  for (const auto area : allAreas)
    for (const auto weights : allWeights)
    {
      const Worst worst = worstOf<3>(options(area, weights), 1000);
      EXPECT_LT(worst.force, 2e-14);
      EXPECT_LT(worst.moment, 1e-13);
    }
}

TEST(FacePair_CornerForces, segmentsGetForcesWithoutResultantAndWithoutMoment)
{
  for (const auto area : allAreas)
    for (const auto weights : allWeights)
    {
      const Worst worst = worstOf<2>(options(area, weights), 1000);
      EXPECT_LT(worst.force, 1e-14);
      EXPECT_LT(worst.moment, 1e-13);
    }
}

TEST(FacePair_CornerForces, powerIsForceTimesTheRelativeVelocityOfThePointOfContact)
{
  for (const auto area : allAreas)
    for (const auto weights : allWeights)
    {
      EXPECT_LT(worstOf<3>(options(area, weights), 1000).power, 1e-13);
      EXPECT_LT(worstOf<2>(options(area, weights), 1000).power, 1e-13);
    }
}

TEST(FacePair_CornerForces, withoutTheCoupleTheMomentIsArmTimesForce)
{
  const Worst worst = worstOf<3>(alongCommonNormal, 1000);
  EXPECT_GT(worst.uncoupled, .99) << "the error that the couple removes is there";
  EXPECT_LT(worst.spurious, 1e-13);
}

TEST_P(FacePair_UpdatePlane, forcesOfMovingPairsConserveBothMomentaAtTheEndOfTheStep)
{
  // Half-step geometry, forces on x(n+1): the moment must vanish about the latter.
  std::mt19937 random(8);
  int pairs = 0;
  while (pairs < 1000)
  {
    const auto [a, b] = randomPair(random, .1);
    PairPlane plane = touchingPlane(1e3, .5);
    plane.history.shearTraction = {1, 2, 3};
    plane.normal =
        stepB_trialPointOfContact<3>(stepA_halfStepFace<3>(a, 0), stepA_halfStepFace<3>(b, 0))
            .normal;
    updatePlane<3>(plane, a, b, usual, .02);
    const Real force = norm(plane.forceOn(1));
    if (!(force > 0))
      continue;
    ++pairs;
    const Resultant sum = resultant(a, b, plane.cornerForce);
    EXPECT_LT(norm(sum.force), 1e-13 * force);
    EXPECT_LT(norm(sum.moment), 1e-12 * force);
  }
}

TEST(FacePair_RelativeMotion, vanishesForAnyRigidMotionAlsoAcrossAGap)
{
  std::mt19937 random(9);
  std::uniform_real_distribution<Real> u(-1, 1);
  int pairs = 0;
  while (pairs < 1000)
  {
    auto [a, b] = randomPair(random, .2);
    const Vec3 velocity{u(random), u(random), u(random)}, spin{u(random), u(random), u(random)};
    for (FaceNodes* face : {&a, &b})
      for (int i = 0; i < face->count; ++i)
        face->v[i] = velocity + cross(spin, face->x[i]);
    const PairContact c = contactOf<3>(a, b, alongCommonNormal);
    if (!(c.patch.area > 0))
      continue;
    ++pairs;
    const RelativeMotion motion = c.motion();
    EXPECT_LT(norm(motion.jump), 2e-14);
    EXPECT_LT(norm(motion.spin - spin), 1e-13);
  }
}

TEST(FacePair_RelativeMotion, vanishesForAFiniteRotationOfOneRadianInOneStep)
{
  // From x(n) to x(n+1) = R x(n) + t. At the middle of the chord the velocity field is that of a
  // rigid motion with the spin 2 tan(1/2) / dt, which the least-squares spin finds.
  std::mt19937 random(10);
  std::uniform_real_distribution<Real> u(-1, 1);
  const Real dt = .1;
  int pairs = 0;
  while (pairs < 1000)
  {
    auto [a, b] = randomPair(random, .2);
    const Mat3 r = rotation({u(random), u(random), u(random)}, 1);
    const Vec3 shift{u(random), u(random), u(random)};
    for (FaceNodes* face : {&a, &b})
      for (int i = 0; i < face->count; ++i)
      {
        const Vec3 before = face->x[i];
        face->x[i] = r * before + shift;
        face->v[i] = (1 / dt) * (face->x[i] - before);
      }
    const PairContact c = contactOf<3>(a, b, alongCommonNormal, dt);
    if (!(c.patch.area > 0))
      continue;
    ++pairs;
    const RelativeMotion motion = c.motion();
    EXPECT_LT(dt * norm(motion.jump), 1e-13);
    EXPECT_NEAR(norm(motion.spin) * dt, 2 * std::tan(.5), 1e-12);
  }
}

TEST(FacePair_RelativeMotion, segmentsThatTurnOneRadianTogetherDoNotSlip)
{
  std::mt19937 random(11);
  const Real dt = .1;
  int pairs = 0;
  while (pairs < 1000)
  {
    auto [a, b] = randomSegments(random);
    const Mat3 r = rotation({0, 0, 1}, pairs % 2 ? 1 : -1);
    for (FaceNodes* face : {&a, &b})
      for (int i = 0; i < face->count; ++i)
      {
        const Vec3 before = face->x[i];
        face->x[i] = r * before + Vec3{.3, -.2, 0};
        face->v[i] = (1 / dt) * (face->x[i] - before);
      }
    const PairContact c = contactOf<2>(a, b, alongCommonNormal, dt);
    if (!(c.patch.area > 0))
      continue;
    ++pairs;
    EXPECT_LT(dt * norm(c.motion().jump), 1e-13);
  }
}

TEST(FacePair_RelativeMotion, relativeTranslationIsReturnedUnchanged)
{
  std::mt19937 random(12);
  const Vec3 velocity{.3, -.2, .7};
  int pairs = 0;
  while (pairs < 100)
  {
    auto [a, b] = randomPair(random, .2, 0);
    for (int i = 0; i < b.count; ++i)
      b.v[i] = velocity;
    const PairContact c = contactOf<3>(a, b, alongCommonNormal);
    if (!(c.patch.area > 0))
      continue;
    ++pairs;
    EXPECT_LT(norm(c.motion().jump - velocity), 2e-14);
  }
}

TEST(FacePair_Patch, bothFacesReproduceOneAndTheSamePointOfThePlane)
{
  std::mt19937 random(13);
  for (const auto area : allAreas)
    for (const auto weights : allWeights)
      for (int pairs = 0; pairs < 500;)
      {
        const auto [a, b] = randomPair(random, .2);
        const PairContact c = contactOf<3>(a, b, options(area, weights));
        if (!(c.patch.area > 0))
          continue;
        ++pairs;
        for (const auto* w : {&c.patch.weights, &c.patch.centroidWeights})
        {
          const Vec3 arm = weighted((*w)[1], b.x, b.count) - weighted((*w)[0], a.x, a.count);
          EXPECT_LT(norm(arm - dot(arm, c.trial.normal) * c.trial.normal), 2e-14);
        }
      }
}
