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

using Place = MovingPairs::Place;

/// Whether some of the second face lies behind the first, however deep, where both oppose each
/// other: a plane would not be born there, but must be looked at.
template <int Dim>
bool lieInEachOther(const HalfStepFace& a, const HalfStepFace& b)
{
  PairPotential<Dim, Real> pair(a, b, ContactPotentialScale(ContactOptions().cosOpposed));
  if (!pair.plane.opposed || !mayMeet<Dim>(a, b, ContactOptions()))
    return false;
  pair.meet(0, false, {});
  return pair.moments.volume > 0;
}

struct Found
{
  int far = 0, farAndOpposed = 0, acting = 0;
};

/// What is far at that time since the search [s]: its faces do not lie in each other, nor would
/// they within the look-ahead if nodes went on as they do.
Found foundAt(Real since, MovingPairs& pairs, PairDistances& distances)
{
  pairs.goOn(since);
  distances.follow(pairs.now, pairs.nowV, since, lookAhead);
  const int count = int(pairs.slots.extent(0));
  std::vector<std::uint8_t> areFar(static_cast<std::size_t>(count));
  for (int first = 0; first < count; first += 333)
    distances.areFar(first, std::min(333, count - first), &areFar[std::size_t(first)]);
  Found found;
  for (int p = 0; p < count; ++p)
  {
    const HalfStepFace a = pairs.faceNow(2 * p), b = pairs.faceNow(2 * p + 1);
    const bool acts = actsOrMay(looked(a, b, pairs.dimension));
    found.acting += acts;
    EXPECT_EQ(areFar[std::size_t(p)] != 0, distances.isFar(p)) << p;
    if (!distances.isFar(p))
      continue;
    for (const Real soon : {0.0, 0.3, 0.7, 1.0})
    {
      const HalfStepFace thenA = pairs.faceNow(2 * p, soon * lookAhead),
                         thenB = pairs.faceNow(2 * p + 1, soon * lookAhead);
      const bool lie =
          pairs.dimension == 2 ? lieInEachOther<2>(thenA, thenB) : lieInEachOther<3>(thenA, thenB);
      EXPECT_FALSE(lie || looked(thenA, thenB, pairs.dimension).isBorn())
          << "pair " << p << " after " << since << " s and " << soon << " of the look-ahead";
    }
    ++found.far;
    found.farAndOpposed += pairs.dimension == 2 ? mayMeet<2>(a, b, ContactOptions())
                                                : mayMeet<3>(a, b, ContactOptions());
  }
  return found;
}

constexpr int someTimes = 4;
constexpr Real times[someTimes] = {0.0, 0.2, ahead, 0.8};
} // namespace

TEST(PairDistances, whatIsFarNeitherTouchesNorMaySoon)
{
  constexpr int count = 20000;
  for (const int dimension : {2, 3})
    for (const Real swiftness : {0.0, 0.3, 1.0})
      for (const Real stray : {0.0, 1e-3, 1e-2, 5e-2})
      {
        SCOPED_TRACE(::testing::Message()
                     << dimension << "D, " << swiftness << " m/s, strayed by " << stray << " m");
        MovingPairs pairs(count, 5, swiftness, stray, Place::Anywhere, dimension);
        PairDistances distances = measured(pairs);
        for (const Real since : times)
        {
          const Found found = foundAt(since, pairs, distances);
          EXPECT_GT(found.acting, count / 20);
          if (stray <= 1e-2 && swiftness <= 0.3)
          {
            EXPECT_GT(found.far, count / 10);
            EXPECT_GT(found.farAndOpposed, count / 50);
          }
        }
      }
}

// Most pairs of a wall: neighbours on its joints, which a normal does not keep apart.
TEST(PairDistances, whatLiesBesideIsFar)
{
  constexpr int count = 20000;
  for (const int dimension : {2, 3})
    for (const Real swiftness : {0.0, 0.1, 0.5})
      for (const Real stray : {0.0, 1e-3, 1e-2})
      {
        SCOPED_TRACE(::testing::Message()
                     << dimension << "D, " << swiftness << " m/s, strayed by " << stray << " m");
        MovingPairs pairs(count, 13, swiftness, stray, Place::Beside, dimension);
        PairDistances distances = measured(pairs);
        for (const Real since : times)
        {
          const Found found = foundAt(since, pairs, distances);
          EXPECT_GT(found.acting, count / 100);
          if (stray <= 1e-3 && swiftness <= 0.1)
          {
            EXPECT_GT(found.far, count / 3);
          }
        }
      }
}

TEST(PairDistances, facesThatAreApartNeitherTouchNorMaySoon)
{
  constexpr int count = 50000;
  for (const Place place : {Place::Anywhere, Place::Beside})
  {
    MovingPairs pairs(count, 7, 0.5, 1e-2, place);
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
    EXPECT_GT(acting, count / 50);
  }
}

// The mean plane of a warped face lies beyond a corner, the farther along the normal of the pair
// the more the face is tilted.
TEST(PairDistances, warpedFacesAreApartByTheirMeanPlanes)
{
  constexpr Real warp = 0.05;
  int lying = 0;
  for (const Real degrees : {0.0, 20.0, 30.0, 44.0})
    for (const Real part : {0.1, 0.5, 0.9, 1.1})
    {
      const Real tilt = degrees * pi / 180;
      FaceNodes nodes[2];
      for (int f = 0; f < 2; ++f)
      {
        nodes[f].count = 4;
        for (int k = 0; k < 4; ++k)
        {
          const int at = f == 0 ? k : (4 - k) % 4;
          const Vec3 corner{std::cos(pi / 2 * at), std::sin(pi / 2 * at),
                            at % 2 == 0 ? -warp : warp};
          Vec3& x = nodes[f].x[k] = rotation({0, 1, 0}, -tilt) * corner;
          if (f == 1)
            x.z = -x.z;
        }
      }
      Real top = -infinity, low = infinity;
      for (int k = 0; k < 4; ++k)
      {
        top = std::max(top, nodes[0].x[k].z);
        low = std::min(low, nodes[1].x[k].z);
      }
      const Real gap = 2 * warp * (1 + part * (1 / std::cos(tilt) - 1));
      for (int k = 0; k < 4; ++k)
        nodes[1].x[k].z += top - low + gap;
      const HalfStepFace a = stepA_faceAtEnd<3>(nodes[0]), b = stepA_faceAtEnd<3>(nodes[1]);
      const bool lie = lieInEachOther<3>(a, b);
      lying += lie;
      EXPECT_FALSE(lie && areApart(a, b, 0, 0)) << degrees << " degrees, " << part;
      if (part > 1 && degrees > 0)
      {
        EXPECT_TRUE(areApart(a, b, 0, 0)) << degrees << " degrees";
      }
    }
  EXPECT_GT(lying, 3);
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

// What keeps faces apart beside each other does so for as long as the normal of the pair does not
// turn: the farther one lies behind the other, the less that may be.
TEST(PairDistances, whatLiesBesideIsNotFarWhenNormalsTurn)
{
  MovingPairs pairs(1, 3, 0, 0);
  const auto corner = [](int f, int k)
  {
    const bool right = k == 1 || k == 2, up = f == 0 ? k > 1 : k < 2;
    return Vec3{Real(right) - 0.5 + 1.005 * f, Real(up) - 0.5, -3.0 * f};
  };
  for (int f = 0; f < 2; ++f)
  {
    pairs.faces(f).count = 4;
    for (int k = 0; k < 4; ++k)
    {
      pairs.faces(f).nodes[k] = 4 * f + k;
      set(pairs.x, 4 * f + k, corner(f, k));
      set(pairs.v, 4 * f + k, {});
    }
    pairs.planes(f) = facePlane(pairs.faces(f), pairs.x, 3);
  }
  PairDistances distances = measured(pairs);
  pairs.goOn(0);
  bool lay = false;
  for (const Real angle : {0.0, 0.001, -0.001, 0.004, -0.004})
  {
    for (int k = 0; k < 4; ++k)
      set(pairs.now, k, rotation({0, 1, 0}, angle) * corner(0, k));
    distances.follow(pairs.now, pairs.nowV, 0, 0);
    const bool lie = lieInEachOther<3>(pairs.faceNow(0), pairs.faceNow(1));
    lay = lay || lie;
    EXPECT_FALSE(lie && distances.isFar(0)) << "turned by " << angle;
    EXPECT_EQ(distances.isFar(0), angle == 0);
  }
  EXPECT_TRUE(lay);
}
} // namespace coplane
