// Pairs that nobody looks at: what a search foresees, and what nodes have strayed since.
#include "FacePairs.hpp"

#include <coplane_contact/PairDistances.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace coplane
{
namespace
{
using namespace facepairs;

constexpr Real ahead = 0.5, lookAhead = 0.02, dt = 0.01; // [s]

/// Pairs of warped quadrilaterals and triangles of about 1 m, in all positions to each other, whose
/// nodes go their ways and stray from them.
struct MovingPairs
{
  explicit MovingPairs(int count, unsigned seed, Real swiftness, Real stray)
      : x("x", 8 * count), v("v", 8 * count), now("now", 8 * count), nowV("nowV", 8 * count),
        faces("faces", 2 * count), slots("slots", count), stray_(stray), random_(seed)
  {
    CandidateRules rules;
    rules.turning = 0.1;
    rules.motion = {v, ahead, {}};
    for (int p = 0; p < count; ++p)
    {
      const Vec3 apart{1.2 * any(), 1.2 * any(), 0.6 * any()};
      const Mat3 all = rotation(vector(), 3 * any()), tilted = rotation(vector(), 1.6 * any());
      const Vec3 drift[2] = {swiftness * vector(), swiftness * vector()};
      for (int f = 0; f < 2; ++f)
      {
        Face& face = faces(2 * p + f);
        face.count = random_() % 3 == 0 ? 3 : 4;
        for (int k = 0; k < face.count; ++k)
        {
          const int node = face.nodes[k] = 8 * p + 4 * f + k;
          const Real side = f == 0 ? 1 : -1; // the second one faces the first
          Vec3 corner{k == 1 || k == 2 ? 0.5 : -0.5, side * (k > 1 ? 0.5 : -0.5), 0};
          corner += 0.1 * vector();
          if (f == 1)
            corner = tilted * corner + apart;
          set(x, node, all * corner);
          set(v, node, drift[f] + 0.2 * swiftness * vector());
        }
        slots(p).face[f] = 2 * p + f;
      }
    }
    planes = Array<FacePlane>("planes", faces.extent(0));
    for (std::size_t f = 0; f < faces.extent(0); ++f)
      planes(f) = rules.planeOf(faces(f), x, 3);
  }

  /// Nodes at that time since the search [s].
  void goOn(Real since)
  {
    for (int n = 0; n < int(x.extent(0)); ++n)
    {
      set(now, n, at(x, n) + std::min(since, ahead) * at(v, n) + stray_ * vector());
      set(nowV, n, at(v, n) + stray_ / ahead * vector());
    }
  }

  HalfStepFace faceNow(int f) const
  {
    FaceNodes nodes;
    nodes.count = faces(f).count;
    for (int k = 0; k < nodes.count; ++k)
    {
      nodes.x[k] = at(now, faces(f).nodes[k]);
      nodes.v[k] = at(nowV, faces(f).nodes[k]);
      nodes.mass[k] = 1;
    }
    return stepA_faceAtEnd<3>(nodes);
  }

  NodeVectors x, v, now, nowV;
  Array<Face> faces;
  PairDistances::SlotTable slots;
  Array<FacePlane> planes;

private:
  Real any() { return std::uniform_real_distribution<Real>(-1, 1)(random_); }
  Vec3 vector()
  {
    const Real a = any(), b = any(), c = any();
    return {a, b, c};
  }

  Real stray_;
  std::mt19937 random_;
};

/// What a cycle makes of a pair that has never touched.
Plane looked(const HalfStepFace& a, const HalfStepFace& b)
{
  PairPlane plane = touchingPlane();
  plane.state = PlaneState::Slot;
  plane.depthLimit = 1;
  ContactOptions options;
  options.lookAhead = lookAhead;
  if (mayMeet<3>(a, b, options))
    updateByForces<3>(plane, a, b, plane.law, options, dt);
  else
    passBy(plane, a, b, dt);
  return plane;
}

bool actsOrMay(const Plane& plane)
{
  return plane.isBorn() || plane.area > 0 || plane.nodeStiffness > 0;
}

PairDistances measured(const MovingPairs& pairs)
{
  PairDistances distances;
  distances.take(pairs.slots, pairs.faces, pairs.planes,
                 Array<std::uint8_t>("mayReach", pairs.slots.extent(0)),
                 {pairs.x, pairs.v, ahead, {}, 0, leastOpposed(ContactOptions())});
  return distances;
}
} // namespace

TEST(PairDistances, whatIsFarNeitherTouchesNorMaySoon)
{
  constexpr int count = 20000;
  for (const Real swiftness : {0.0, 0.3, 1.0})
    for (const Real stray : {0.0, 1e-3, 1e-2, 5e-2})
    {
      SCOPED_TRACE(testing::Message() << swiftness << " m/s, strayed by " << stray << " m");
      MovingPairs pairs(count, 5, swiftness, stray);
      PairDistances distances = measured(pairs);
      for (const Real since : {0.0, 0.2, ahead, 0.8})
      {
        pairs.goOn(since);
        distances.follow(pairs.now, pairs.nowV, since, lookAhead);
        int far = 0, farAndOpposed = 0, acting = 0;
        for (int p = 0; p < count; ++p)
        {
          const HalfStepFace a = pairs.faceNow(2 * p), b = pairs.faceNow(2 * p + 1);
          const bool acts = actsOrMay(looked(a, b));
          acting += acts;
          if (!distances.isFar(p))
            continue;
          EXPECT_FALSE(acts) << "pair " << p << " after " << since << " s";
          ++far;
          farAndOpposed += mayMeet<3>(a, b, ContactOptions());
        }
        EXPECT_GT(acting, count / 20);
        if (stray <= 1e-2 && swiftness <= 0.3)
        {
          EXPECT_GT(far, count / 10);
          EXPECT_GT(farAndOpposed, count / 50);
        }
      }
    }
}

TEST(PairDistances, facesThatAreApartNeitherTouchNorMaySoon)
{
  constexpr int count = 50000;
  MovingPairs pairs(count, 7, 0.5, 1e-2);
  pairs.goOn(0);
  int apart = 0, acting = 0;
  for (int p = 0; p < count; ++p)
  {
    const HalfStepFace a = pairs.faceNow(2 * p), b = pairs.faceNow(2 * p + 1);
    const bool acts = actsOrMay(looked(a, b));
    acting += acts;
    if (!areApart(a, b, 0, lookAhead))
      continue;
    EXPECT_FALSE(acts) << "pair " << p;
    apart += mayMeet<3>(a, b, ContactOptions());
  }
  EXPECT_GT(apart, count / 50);
  EXPECT_GT(acting, count / 20);
}

TEST(PairDistances, reachesTakeOffWhatPlanesAreOffset)
{
  // Squares 0.1 m apart that a plane with an offset of 0.2 m holds to be 0.1 m deep.
  MovingPairs pairs(1, 3, 0, 0);
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 4; ++k)
    {
      Face& face = pairs.faces(f);
      face.count = 4;
      face.nodes[k] = 4 * f + k;
      const bool right = k == 1 || k == 2, up = f == 0 ? k > 1 : k < 2;
      set(pairs.x, face.nodes[k], {Real(right), Real(up), 0.1 * f});
    }
  for (int f = 0; f < 2; ++f)
    pairs.planes(f) = facePlane(pairs.faces(f), pairs.x, 3);
  ASSERT_LT(dot(pairs.planes(0).normal, pairs.planes(1).normal), -0.99);
  pairs.goOn(0);
  const auto far = [&](Real offset, std::uint8_t reaches)
  {
    Array<std::uint8_t> mayReach("mayReach", 1);
    mayReach(0) = reaches;
    PairDistances distances;
    distances.take(pairs.slots, pairs.faces, pairs.planes, mayReach,
                   {pairs.x, pairs.v, ahead, {}, offset, 0.05});
    distances.follow(pairs.now, pairs.nowV, 0, 0);
    return distances.isFar(0);
  };
  EXPECT_TRUE(far(0, 0));
  EXPECT_TRUE(far(0.09, 0));
  EXPECT_FALSE(far(0.2, 0));
  EXPECT_FALSE(far(0, 1)) << "bonds hold at any distance";
}
} // namespace coplane
