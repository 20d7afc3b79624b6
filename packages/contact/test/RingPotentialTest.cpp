// The energy of a pair of rings, in bodies of revolution, and its gradient.
#include "BalancedForces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace coplane
{
namespace
{
using namespace facepairs;

/// What of a pair of rings is as it likes.
struct Ring
{
  std::array<Real, 2> birth = {7, 4}; // areas [m^2]
  Real offset = 0, inverseDepth = 0;
  unsigned exits = 0;
  const LinearOnFace* crushing = nullptr;
  const Layers* laid = nullptr;
  bool bonded = false; // by its mean closure
  bool sharing = false;
};

struct OfRing
{
  Real energy = 0, force = 0, area = 0, phi = 0, share = 1;
  Vec3 gradient[2][4];

  OfRing(const RandomPair& faces, const Ring& ring)
  {
    const HalfStepFace a = stepA_faceAtEnd<2>(faces.a), b = stepA_faceAtEnd<2>(faces.b);
    ContactPotentialScale scale(0.1, true);
    if (!ring.sharing) // sharing is no gradient
      scale.oneEdge = scale.oneBorder = 0;
    PairPotential<2, Real> pair(a, b, scale);
    if (!pair.plane.opposed)
      return;
    EdgesOf<Real> edges;
    for (int e = 0; e < 8; ++e)
      edges.exits[e] = edges.turns[e] = ring.exits >> e & 1;
    if (ring.laid != nullptr)
      pair.lay(true, ring.laid->parts);
    if (ring.crushing != nullptr)
      pair.beCrushed(*ring.crushing);
    pair.meet(ring.offset, ring.bonded, edges);
    if (!(pair.moments.volume > 0))
      return;
    EnergyDensity<Real> density;
    Real stored = pair.press(1, ring.inverseDepth, density);
    share = pair.wayOut;
    pair.growFrom(ring.birth[0], ring.birth[1]);
    if (ring.bonded)
    {
      const Real mean = pair.moments.volume / pair.moments.area;
      stored = .5 * pair.moments.area * mean * mean;
      density = {0, mean, -.5 * mean * mean};
    }
    force = pair.differentiate(stored, density);
    area = pair.moments.area;
    phi = pair.opposedness;
    energy = pair.materialArea * phi * stored;
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < 2; ++i)
        gradient[f][i] = pair.gradient[f][i];
  }
};

/// Largest difference between the gradient and central differences, over the largest entry.
Real errorOfRing(const RandomPair& pair, const Ring& ring)
{
  const OfRing e(pair, ring);
  Real largest = 0, worst = 0;
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < 2; ++i)
      for (int c = 0; c < 2; ++c)
      {
        largest = std::max(largest, std::abs(e.gradient[f][i][c]));
        const auto at = [&](Real h)
        {
          RandomPair moved = pair;
          (f == 0 ? moved.a : moved.b).x[i][c] += h;
          return OfRing(moved, ring).energy;
        };
        const Real h = 2e-6;
        const Real slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
        worst = std::max(worst, std::abs(slope - e.gradient[f][i][c]));
      }
  return largest > 0 ? worst / largest : 0;
}

/// Turned about its middle, and moved until its lowest radius is that.
RandomPair placed(RandomPair pair, Real angle, Real radius)
{
  Real least = infinity;
  const Real c = std::cos(angle), s = std::sin(angle);
  for (FaceNodes* const face : {&pair.a, &pair.b})
    for (int i = 0; i < 2; ++i)
    {
      const Vec3 x = face->x[i];
      face->x[i] = {c * x.x - s * x.y, s * x.x + c * x.y, 0};
      least = std::min(least, face->x[i].x);
    }
  for (FaceNodes* const face : {&pair.a, &pair.b})
    for (int i = 0; i < 2; ++i)
      face->x[i].x += radius - least;
  return pair;
}

/// A strip about as wide as it is deep between ends of both, or faces that may hardly oppose each
/// other.
RandomPair someRings(std::mt19937& random, bool strip)
{
  std::uniform_real_distribution<Real> u(0, 1);
  if (!strip && u(random) < .5)
    return randomSegments(random);
  if (!strip)
  {
    const Real turned = 3 * (u(random) - .5), half = .4 + .1 * u(random);
    const Vec3 along{half * std::cos(turned), half * std::sin(turned), 0};
    const Vec3 center{.4 + .2 * u(random), -.4 * u(random), 0};
    return {face({{1, 0, 0}, {0, 0, 0}}), face({center - along, center + along})};
  }
  const Real width = .05 + .15 * u(random), turn = .05 * (u(random) - .5);
  return {face({{1, 0, 0}, {0, 0, 0}}), face({{1 - width, -.05, 0}, {2, -.05 + turn, 0}})};
}

void expectRingGradients(bool strip, const Ring& ring, bool crushed = false, bool isLaid = false)
{
  std::mt19937 random(31);
  std::uniform_real_distribution<Real> u(-1, 1);
  int pairs = 0, onTheWay = 0;
  for (int tried = 0; pairs < 400; ++tried)
  {
    ASSERT_LT(tried, 100000);
    const Real radius = pairs % 4 == 0 ? 0 : pairs % 4 == 1 ? .01 : .5 * (1 + u(random));
    const RandomPair pair = placed(someRings(random, strip), pi * u(random), radius);
    const LinearOnFace crushing{.05 * u(random), {.1 * u(random), 0}};
    Ring with = ring;
    with.crushing = crushed ? &crushing : nullptr;
    LinearOnFace laid[2];
    for (int f = 0; f < 2 && isLaid; ++f)
      laid[f] = {.05 * u(random), {.1 * u(random), 0}};
    const Layers layers(laid);
    with.laid = isLaid ? &layers : nullptr;
    const OfRing e(pair, with);
    if (!(e.energy > 1e-5))
      continue;
    ++pairs;
    onTheWay += strip ? e.share > .02 && e.share < .98 : e.phi > .02 && e.phi < .98;
    EXPECT_LT(errorOfRing(pair, with), 2e-6) << "pair " << pairs << " share " << e.share;
    Real along = 0, most = 0;
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < 2; ++i)
      {
        along += e.gradient[f][i].y;
        most = std::max(most, norm(e.gradient[f][i]));
      }
    EXPECT_LT(std::abs(along), 1e-12 * most) << "momentum along the axis, pair " << pairs;
  }
  EXPECT_GT(onTheWay, 20);
}
} // namespace

TEST(RingPotential, aFlatRingIsPressedAsItsAreaIs)
{
  // c = 0.01 m between r = 0.5 and 1.5 m: k c^2 / 2 times pi (1.5^2 - 0.5^2). A node has the part
  // of the force that is its of the area, 2 pi Int N r dr.
  const RandomPair pair{face({{1.5, 0, 0}, {.5, 0, 0}}), face({{.5, -.01, 0}, {1.5, -.01, 0}})};
  Ring ring;
  ring.birth = {2 * pi, 2 * pi};
  ring.sharing = true;
  const OfRing e(pair, ring);
  EXPECT_NEAR(e.area, 2 * pi, 1e-14);
  EXPECT_NEAR(e.energy, 1e-4 * pi, 1e-17);
  EXPECT_NEAR(e.force, .02 * pi, 1e-15);
  const Real inner = 2 * pi * (.5 / 2 + 1. / 6), outer = 2 * pi * (1.5 / 2 - 1. / 6);
  EXPECT_NEAR(e.gradient[1][0].y, -.01 * inner, 1e-15);
  EXPECT_NEAR(e.gradient[1][1].y, -.01 * outer, 1e-15);
  EXPECT_NEAR(e.gradient[0][0].y, .01 * outer, 1e-15);
  EXPECT_NEAR(e.gradient[0][1].y, .01 * inner, 1e-15);
}

TEST(RingPotential, tubesThatPressEachOtherAreNotStretched)
{
  // As long as the material keeps its energy while its ring grows, rings that move out together
  // feel no force: what presses is between them.
  const RandomPair pair{face({{1, 0, 0}, {1, 1, 0}}), face({{.99, 1, 0}, {.99, 0, 0}})};
  Ring ring;
  ring.birth = {2 * pi, 2 * pi * .99};
  ring.sharing = true;
  const OfRing e(pair, ring);
  EXPECT_NEAR(e.force, .01 * 2 * pi * .995, 1e-15);
  Real sum = 0;
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < 2; ++i)
      sum += e.gradient[f][i].x;
  EXPECT_LT(std::abs(sum), 1e-4 * e.force);
}

TEST(RingPotential, aTipOnTheAxisHasWhatItsConeHas)
{
  // A cone of 45 degrees whose tip has sunk by c into a plate: each point carries by its closure
  // along the common normal, at the mean of its radius and of that of the plate. Never negative.
  for (const Real c : {1e-6, 1e-3, .1})
  {
    const RandomPair pair{face({{1, 0, 0}, {0, 0, 0}}), face({{0, -c, 0}, {1, 1 - c, 0}})};
    Ring ring;
    ring.birth = {pi, pi * std::sqrt(2)};
    const OfRing e(pair, ring);
    EXPECT_GT(e.area, 0) << c;
    EXPECT_LT(e.area, pi * c * c * 5) << c;
    EXPECT_LT(e.gradient[1][0].y, 0) << c; // driven out
  }
}

TEST(RingPotential, gradientIsThatOfTheEnergy)
{
  for (const Real inverseDepth : {0., 4.})
  {
    Ring ring;
    ring.inverseDepth = inverseDepth;
    expectRingGradients(false, ring);
  }
}

TEST(RingPotential, gradientWhereAWayOutIsNear)
{
  Ring ring;
  ring.exits = 1u << 0 | 1u << 4;
  expectRingGradients(true, ring);
}

TEST(RingPotential, gradientOfWhatIsCrushed)
{
  expectRingGradients(false, {}, true);
  Ring strip;
  strip.exits = 1u << 0 | 1u << 4;
  expectRingGradients(true, strip, true);
}

TEST(RingPotential, gradientOfOneThatHasAbsorbedAnUnevenGap)
{
  Ring strip;
  strip.exits = 1u << 0 | 1u << 4;
  for (const bool crushed : {false, true})
  {
    expectRingGradients(false, {}, crushed, true);
    expectRingGradients(true, strip, crushed, true);
  }
}

TEST(RingPotential, gradientOfABond)
{
  Ring ring;
  ring.bonded = true;
  ring.offset = .3;
  expectRingGradients(false, ring);
}

TEST(RingPotential, farFromTheAxisItIsThatOfPlaneStrain)
{
  // At a radius of 1e6 m, over the circumference there.
  std::mt19937 random(32);
  int pairs = 0;
  while (pairs < 100)
  {
    const Real radius = 1e6;
    const RandomPair pair = placed(randomSegments(random), .3 * pairs, radius);
    const HalfStepFace a = stepA_faceAtEnd<2>(pair.a), b = stepA_faceAtEnd<2>(pair.b);
    PairPotential<2, Real> flat(a, b, ContactPotentialScale(0.1));
    PairPotential<2, Real> ring(a, b, ContactPotentialScale(0.1, true));
    if (!flat.plane.opposed)
      continue;
    Real energy[2];
    for (PairPotential<2, Real>* const p : {&flat, &ring})
    {
      p->meet(0, false, {});
      if (!(p->moments.volume > 1e-3))
        break;
      EnergyDensity<Real> density;
      const Real stored = p->press(1, 0, density);
      p->growFrom(p->faceArea(0), p->faceArea(1));
      p->differentiate(stored, density);
      energy[p == &ring] = stored;
    }
    if (!(ring.moments.volume > 0))
      continue;
    ++pairs;
    const Real around = 2 * pi * radius;
    EXPECT_NEAR(energy[1], around * energy[0], 1e-5 * around * energy[0]);
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < 2; ++i)
        EXPECT_LT(norm(ring.gradient[f][i] - around * flat.gradient[f][i]),
                  1e-4 * around * norm(flat.gradient[0][0]) +
                      1e-4 * around * norm(flat.gradient[1][0]));
  }
}

namespace
{
/// Of rings that were born with these areas [m^2].
Real stiffnessOfRingsOverBound(const RandomPair& pair, const std::array<Real, 2>& birth)
{
  PairPlane plane = touchingPlane(1);
  plane.birthArea[0] = birth[0];
  plane.birthArea[1] = birth[1];
  ContactOptions options = ContactOptions::with(ContactOptions::Forces::Potential);
  options.axisymmetric = true;
  return stiffnessOverBound<2>(pair, plane, options, 1e-7);
}
} // namespace

TEST(RingPotential, theStepAllowsForWhatLiesAsDeepAsItsRadius)
{
  // A tube that has come through a core of radius r by c: without the count of how little is left
  // of the radius it was 23 times the bound.
  for (const Real length : {1., .1})
    for (const Real r : {.1, 1.})
      for (const Real c : {.01, .3, .5, .7, .9, .97})
        for (const bool bornThere : {false, true})
        {
          const Real inner = r * (1 - c);
          const RandomPair pair{face({{r, 0, 0}, {r, length, 0}}),
                                face({{inner, length, 0}, {inner, 0, 0}})};
          ASSERT_GT(dot(normalised(vectorArea<2>(pair.a.x, 2)), Vec3{1, 0, 0}), .9);
          const Real core = 2 * pi * r * length;
          EXPECT_LT(
              stiffnessOfRingsOverBound(pair, {core, bornThere ? 2 * pi * inner * length : core}),
              1)
              << length << " " << r << " " << c << " " << bornThere;
        }
}

TEST(RingPotential, theStepAllowsForNodesAtTheAxis)
{
  // A disc, matching or small, that has sunk into a plate.
  for (const Real size : {.001, .05, .3, 1.})
    for (const Real c : {1e-4, .02})
    {
      const RandomPair pair{face({{1, 0, 0}, {0, 0, 0}}),
                            face({{0, -c * size, 0}, {size, -c * size, 0}})};
      EXPECT_LT(stiffnessOfRingsOverBound(pair, {pi, pi * size * size}), 1) << size << " " << c;
    }
}

TEST(RingPotential, bondsThatBendHaveTheForcesOfTheirEnergy)
{
  std::mt19937 random(33);
  std::uniform_real_distribution<Real> u(-1, 1);
  ContactOptions options = ContactOptions::with(ContactOptions::Forces::Potential);
  options.axisymmetric = true;
  int bent = 0;
  for (int pairs = 0; pairs < 300; ++pairs)
  {
    const RandomPair pair =
        placed(randomSegments(random), pi * u(random), pairs % 3 == 0 ? .01 : .5 * (1 + u(random)));
    PairPlane plane = touchingPlane(1);
    plane.law.bond = Bond::softening(Bond::Kind::Linear, 1e3, 1e3, 2e6, 2e6);
    plane.law.bond.resistsBending = true;
    plane.fit.shearStiffness = 0;
    plane.history.bonded = plane.declared = true;
    plane.history.opening = pairs % 2 ? 1e3 : 0;
    plane.area = 1e-9;
    plane.birthArea[0] = 5;
    plane.birthArea[1] = 3;
    const auto at = [&](int f, int i, int c, Real h)
    {
      RandomPair moved = pair;
      (f == 0 ? moved.a : moved.b).x[i][c] += h;
      PairPlane there = plane;
      updatePlane<2>(there, moved.a, moved.b, options, 0);
      return there;
    };
    const PairPlane now = at(0, 0, 0, 0);
    if (!(now.stored > 1e-6))
      continue;
    ++bent;
    Real largest = 0, worst = 0;
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < 2; ++i)
        for (int c = 0; c < 2; ++c)
        {
          const Real h = 3e-5;
          const auto stored = [&](Real by) { return at(f, i, c, by).stored; };
          const Real slope =
              (8 * (stored(h) - stored(-h)) - (stored(2 * h) - stored(-2 * h))) / (12 * h);
          largest = std::max(largest, std::abs(now.cornerForce[f][i][c]));
          worst = std::max(worst, std::abs(slope + now.cornerForce[f][i][c]));
        }
    // Where ends lie beside each other they share, which is no gradient: few do.
    if (worst > 1e-5 * largest)
      --bent;
  }
  EXPECT_GT(bent, 200);
}
} // namespace coplane
