// Pairs that nobody looks at: what a search foresees, and what nodes have strayed since.
#include "MovingPairs.hpp"

#include <coplane_contact/PairDistances.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
using namespace movingpairs;

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
      SCOPED_TRACE(::testing::Message() << swiftness << " m/s, strayed by " << stray << " m");
      MovingPairs pairs(count, 5, swiftness, stray);
      PairDistances distances = measured(pairs);
      for (const Real since : {0.0, 0.2, ahead, 0.8})
      {
        pairs.goOn(since);
        distances.follow(pairs.now, pairs.nowV, since, lookAhead);
        std::vector<std::uint8_t> areFar(count);
        for (int first = 0; first < count; first += 333)
          distances.areFar(first, std::min(333, count - first), &areFar[std::size_t(first)]);
        int far = 0, farAndOpposed = 0, acting = 0;
        for (int p = 0; p < count; ++p)
        {
          const HalfStepFace a = pairs.faceNow(2 * p), b = pairs.faceNow(2 * p + 1);
          const bool acts = actsOrMay(looked(a, b));
          acting += acts;
          EXPECT_EQ(areFar[std::size_t(p)] != 0, distances.isFar(p)) << p;
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

TEST(PairDistances, slotsWithoutFacesAreNotFar)
{
  MovingPairs pairs(20, 11, 0.3, 1e-3);
  for (int f = 0; f < 2; ++f)
    pairs.slots(7).face[f] = -1;
  PairDistances distances = measured(pairs);
  pairs.goOn(0);
  distances.follow(pairs.now, pairs.nowV, 0, lookAhead);
  std::uint8_t far[20];
  distances.areFar(0, 20, far);
  EXPECT_EQ(far[7], 0);
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
