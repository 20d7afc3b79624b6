#include "FacePairs.hpp"
#include "WithForces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace coplane;
using namespace coplane::facepairs;

namespace
{
constexpr Real dt = .01;

/// Three steps of a pair with friction, positions carried on with the velocities.
PairPlane history(FaceNodes a, FaceNodes b, const ContactOptions& o, int steps = 3)
{
  PairPlane plane = touchingPlane(1e3, .5);
  for (int step = 0; step < steps; ++step)
  {
    updatePlane<3>(plane, a, b, o, dt);
    for (FaceNodes* face : {&a, &b})
      for (int i = 0; i < face->count; ++i)
        face->x[i] += dt * face->v[i];
  }
  return plane;
}

/// Largest relative difference of force and shear traction. `sign` is -1 after a swap of labels.
Real difference(const PairPlane& p, const PairPlane& q, const Mat3& r, Real sign)
{
  const Real size = norm(p.forceOn(1));
  Real d = norm(r * p.forceOn(1) - sign * q.forceOn(1)) / size;
  d = std::max(d,
               norm(r * p.history.shearTraction - sign * q.history.shearTraction) * p.area / size);
  d = std::max(d, std::abs(p.area - q.area) / p.area);
  return std::max(d, norm(sign * q.normal - r * p.normal));
}

const Mat3 none = rotation({0, 0, 1}, 0);

template <class Change>
Real worstOver(int pairs, Real warp, const ContactOptions& o, const Change& change)
{
  std::mt19937 random(21);
  Real worst = 0;
  for (int n = 0; n < pairs;)
  {
    const auto [a, b] = randomPair(random, warp);
    const PairPlane reference = history(a, b, o);
    if (!(norm(reference.forceOn(1)) > .01))
      continue;
    ++n;
    worst = std::max(worst, change(a, b, reference));
  }
  return worst;
}

Real worstSwap(Real warp, const ContactOptions& o)
{
  return worstOver(200, warp, o,
                   [&](const FaceNodes& a, const FaceNodes& b, const PairPlane& reference)
                   {
                     const PairPlane swapped = history(b, a, o);
                     Real worst = difference(reference, swapped, none, -1);
                     for (int i = 0; i < 4; ++i)
                       worst = std::max(
                           worst, (norm(reference.cornerForce[0][i] - swapped.cornerForce[1][i]) +
                                   norm(reference.cornerForce[1][i] - swapped.cornerForce[0][i])) /
                                      norm(reference.forceOn(1)));
                     return worst;
                   });
}

Real worstStart(Real warp, const ContactOptions& o)
{
  return worstOver(200, warp, o,
                   [&](const FaceNodes& a, const FaceNodes& b, const PairPlane& reference)
                   {
                     Real worst = 0;
                     for (int i = 0; i < a.count; ++i)
                       for (int j = 0; j < b.count; ++j)
                       {
                         const PairPlane turned = history(startedAt(a, i), startedAt(b, j), o);
                         worst = std::max(worst, difference(reference, turned, none, 1));
                         for (int k = 0; k < a.count; ++k)
                           worst =
                               std::max(worst, norm(reference.cornerForce[0][(k + i) % a.count] -
                                                    turned.cornerForce[0][k]) /
                                                   norm(reference.forceOn(1)));
                       }
                     return worst;
                   });
}

/// A segment as the side of a slab of thickness 1: nodes at z = 0 and z = 1.
FaceNodes extruded(const FaceNodes& s)
{
  FaceNodes f;
  f.count = 4;
  f.mass = s.mass;
  const Vec3 z{0, 0, 1};
  const int node[4] = {0, 0, 1, 1};
  const Real height[4] = {1, 0, 0, 1};
  for (int i = 0; i < 4; ++i)
  {
    f.x[i] = s.x[node[i]] + height[i] * z;
    f.v[i] = s.v[node[i]];
  }
  return f;
}

struct FacePair_Invariance : WithForces
{
};
INSTANTIATE_TEST_SUITE_P(, FacePair_Invariance, WithForces::both(), WithForces::name);

/// Faces that lie on each other but for round-off count for the step, by the same fraction of their
/// size in any unit.
TEST_P(FacePair_Invariance, whatLiesOnAFaceButForRoundOffCountsForTheStepInAnyUnit)
{
  for (const Real unit : {1.0, 1024.0, 1 / 1024.0})
    for (const bool inSpace : {false, true})
      for (const Real gap : {.5e-8, 1.5e-8})
      {
        FaceNodes a = face({{unit, 0, 0}, {0, 0, 0}}),
                  b = face({{0, gap * unit, 0}, {unit, gap * unit, 0}});
        PairPlane plane = touchingPlane(1);
        if (inSpace)
        {
          a = face({{0, 0, 0}, {unit, 0, 0}, {unit, unit, 0}, {0, unit, 0}});
          b = face({{0, 0, gap * unit},
                    {0, unit, gap * unit},
                    {unit, unit, gap * unit},
                    {unit, 0, gap * unit}});
          updatePlane<3>(plane, a, b, usual, dt);
        }
        else
          updatePlane<2>(plane, a, b, usual, dt);
        EXPECT_EQ(plane.nodeStiffness > 0, gap < 1e-8) << unit << ' ' << inSpace << ' ' << gap;
      }
}

/// What bounds the step may not hang on which of two faces comes first.
TEST(ApproachSpeed, isTheSameWithTheFacesInTheOtherOrder)
{
  const Vec3 normal = normalised(Vec3{0.3, 0.9, -0.2});
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> between(-1, 1);
  for (int trial = 0; trial < 100; ++trial)
  {
    HalfStepFace a{}, b{};
    a.count = 4;
    b.count = 3;
    Real fastest = -infinity, slowest = infinity;
    for (HalfStepFace* face : {&a, &b})
      for (int i = 0; i < face->count; ++i)
      {
        face->v[i] = {between(random), between(random), between(random)};
        const Real along = dot(normal, face->v[i]);
        (face == &a ? fastest : slowest) =
            face == &a ? std::max(fastest, along) : std::min(slowest, along);
      }
    EXPECT_EQ(approachSpeed(normal, a, b), std::max(0.0, fastest - slowest));
    EXPECT_EQ(approachSpeed(normal, a, b), approachSpeed(-normal, b, a));
  }
}
} // namespace

TEST(FacePair_InvarianceOfCommonNormal, labelsOfWarpedFacesCanBeSwappedWithCentroidWeights)
{
  for (const auto area : allAreas)
    EXPECT_LT(worstSwap(.1, options(area, ContactOptions::Weights::Centroid)), 1e-12);
}

TEST(FacePair_InvarianceOfCommonNormal, warpedFacesCanBeNumberedFromAnyNodeWithCentroidWeights)
{
  for (const auto area : allAreas)
    EXPECT_LT(worstStart(.1, options(area, ContactOptions::Weights::Centroid)), 1e-12);
}

TEST(FacePair_InvarianceOfCommonNormal, labelsCanBeSwappedWithAllWeights)
{
  for (const Real warp : {0.0, .1})
    for (const auto area : allAreas)
      for (const auto weights : allWeights)
        EXPECT_LT(worstSwap(warp, options(area, weights)), 1e-12)
            << warp << ' ' << int(area) << ' ' << int(weights);
}

TEST(FacePair_InvarianceOfCommonNormal, facesCanBeNumberedFromAnyNodeWithAllWeights)
{
  for (const Real warp : {0.0, .1})
    for (const auto area : allAreas)
      for (const auto weights : allWeights)
        EXPECT_LT(worstStart(warp, options(area, weights)), 1e-12)
            << warp << ' ' << int(area) << ' ' << int(weights);
}

TEST_P(FacePair_Invariance, labelsCanBeSwapped)
{
  for (const Real warp : {0.0, .1})
    EXPECT_LT(worstSwap(warp, usual), 1e-12) << warp;
}

TEST_P(FacePair_Invariance, facesCanBeNumberedFromAnyNode)
{
  for (const Real warp : {0.0, .1})
    EXPECT_LT(worstStart(warp, usual), 1e-12) << warp;
}

TEST_P(FacePair_Invariance, forcesTurnWithTheFaces)
{
  const Real worst =
      worstOver(200, .1, usual,
                [&](const FaceNodes& a, const FaceNodes& b, const PairPlane& reference)
                {
                  const Vec3 shift{10, -20, 5};
                  const PairPlane turned =
                      history(moved(a, oblique(), shift), moved(b, oblique(), shift), usual);
                  return difference(reference, turned, oblique(), 1);
                });
  EXPECT_LT(worst, 1e-11);
}

TEST_P(FacePair_Invariance, commonVelocityChangesNothing)
{
  const Real worst = worstOver(200, .1, usual,
                               [&](FaceNodes a, FaceNodes b, const PairPlane& reference)
                               {
                                 for (FaceNodes* face : {&a, &b})
                                   for (int i = 0; i < face->count; ++i)
                                     face->v[i] += Vec3{100, -50, 20};
                                 return difference(reference, history(a, b, usual), none, 1);
                               });
  EXPECT_LT(worst, 1e-8);
}

TEST(FacePair_Dimensions, segmentsAndTheirExtrusionAgreeAlongAPath)
{
  // 20 steps of random motion: force, closure, area and shear traction of a pair of segments and of
  // the pair of rectangles 1 m wide that they are the sections of.
  std::mt19937 random(22);
  std::uniform_real_distribution<Real> u(-1, 1);
  int loaded = 0;
  std::vector<ContactOptions> all{ContactOptions{}};
  for (const auto area : allAreas)
    for (const auto weights : allWeights)
      all.push_back(options(area, weights));
  for (int n = 0; n < 100; ++n)
    for (ContactOptions o : all)
    {
      o.dampNormal = .1;
      auto [a, b] = randomSegments(random);
      PairPlane flat = touchingPlane(1e3, .5), solid = flat;
      for (int step = 0; step < 20; ++step)
      {
        for (FaceNodes* face : {&a, &b})
          for (int i = 0; i < 2; ++i)
          {
            face->v[i] = {u(random), u(random), 0};
            face->x[i] += .01 * face->v[i];
          }
        updatePlane<2>(flat, a, b, o, .01);
        updatePlane<3>(solid, extruded(a), extruded(b), o, .01);
        const Real size = 1 + norm(flat.forceOn(1));
        ASSERT_NEAR(flat.area, solid.area, 1e-12);
        ASSERT_NEAR(flat.closure, solid.closure, 1e-12);
        ASSERT_LT(norm(flat.forceOn(1) - solid.forceOn(1)), 1e-10 * size);
        ASSERT_LT(norm(flat.history.shearTraction - solid.history.shearTraction), 1e-9);
        ASSERT_NEAR(flat.work, solid.work, 1e-10 * size);
        ASSERT_NEAR(flat.frictionWork, solid.frictionWork, 1e-10 * size);
        loaded += norm(flat.forceOn(1)) > 0;
      }
    }
  EXPECT_GT(loaded, 1000);
}
