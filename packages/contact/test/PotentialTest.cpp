// The energy of a pair of faces and its gradient.
#include "BalancedForces.hpp"

#include <coplane_contact/detail/PotentialKernel.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace coplane
{
namespace
{
using namespace facepairs;

/// Energy and gradient of one pair with the linear law; the faces were born with given areas.
template <int Dim>
struct Evaluation
{
  Real energy = 0, force = 0, area = 0, xi = 0, phi = 0, ratio = 0, share = 1;
  Vec3 gradient[2][4];

  Evaluation(const FaceNodes& a, const FaceNodes& b, Real stiffness, Real offset,
             const std::array<Real, 2>& birth = {0, 0}, unsigned exits = 0, Real oneEdge = 1e-3,
             Real inverseDepth = 0, unsigned turns = 0, unsigned seams = 0, bool grows = false)
  {
    const HalfStepFace faceA = stepA_faceAtEnd<Dim>(a), faceB = stepA_faceAtEnd<Dim>(b);
    ContactPotentialScale scale(0.1);
    scale.oneEdge = oneEdge;
    if (oneEdge == 0) // sharing is no gradient
      scale.oneBorder = 0;
    PairPotential<Dim, Real> pair(faceA, faceB, scale);
    xi = -dot(faceA.normal, faceB.normal);
    if (!pair.plane.opposed)
      return;
    EdgesOf<Real> edges;
    for (int e = 0; e < 8; ++e)
    {
      edges.exits[e] = exits >> e & 1;
      edges.turns[e] = (exits | turns) >> e & 1;
      edges.seams[e] = seams >> e & 1;
    }
    pair.meet(offset, false, edges);
    if (!(pair.moments.volume > 0))
      return;
    if (grows)
      pair.growIn();
    EnergyDensity<Real> density;
    energy = pair.press(stiffness, inverseDepth, density);
    share = pair.wayOut;
    pair.growFrom(birth[0] > 0 ? birth[0] : faceA.area, birth[1] > 0 ? birth[1] : faceB.area);
    force = pair.differentiate(energy, density);
    area = pair.moments.area;
    phi = pair.opposedness;
    ratio = pair.moments.squares / pair.moments.volume;
    energy *= pair.materialArea * phi;
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < 4; ++i)
        gradient[f][i] = pair.gradient[f][i];
  }
};

template <int Dim>
Real areaOf(const FaceNodes& face)
{
  return norm(vectorArea<Dim>(face.x, face.count));
}

/// The force of the potential without the factor of material area, whose part is that of the
/// energy over the areas of the faces.
template <int Dim>
Vec3 forceWithoutMaterialArea(const Evaluation<Dim>& e, const FaceNodes (&faces)[2], int f, int i)
{
  Vec3 change;
  for (int c = 0; c < 3; ++c)
  {
    const auto at = [&](Real h)
    {
      FaceNodes moved = faces[f];
      moved.x[i][c] += h;
      return areaOf<Dim>(moved);
    };
    const Real h = 1e-3;
    change[c] = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
  }
  return -e.gradient[f][i] - (.5 * e.energy / areaOf<Dim>(faces[f])) * change;
}

template <int Dim>
void expectForce(const Evaluation<Dim>& e, const FaceNodes (&faces)[2], int f, int i,
                 const Vec3& expected)
{
  const Vec3 got = forceWithoutMaterialArea<Dim>(e, faces, f, i);
  EXPECT_LT(norm(got - expected), 3e-9 * norm(expected))
      << f << i << ": " << got.x << " " << got.y << " " << got.z;
}

/// Largest difference between the gradient and central differences, over the largest entry.
template <int Dim>
Real errorOfGradient(const FaceNodes& a, const FaceNodes& b, Real offset, unsigned exits = 0,
                     Real inverseDepth = 0, bool grows = false)
{
  const std::array<Real, 2> birth = {1.3 * areaOf<Dim>(a), .8 * areaOf<Dim>(b)};
  const auto evaluated = [&](const FaceNodes& first, const FaceNodes& second)
  { return Evaluation<Dim>(first, second, 1, offset, birth, exits, 0, inverseDepth, 0, 0, grows); };
  const Evaluation<Dim> e = evaluated(a, b);
  Real largest = 0, worst = 0;
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < (f == 0 ? a : b).count; ++i)
      for (int c = 0; c < Dim; ++c)
      {
        largest = std::max(largest, std::abs(e.gradient[f][i][c]));
        const auto at = [&](Real h)
        {
          FaceNodes faces[2] = {a, b};
          faces[f].x[i][c] += h;
          return evaluated(faces[0], faces[1]).energy;
        };
        const Real h = 3e-5;
        const Real slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
        worst = std::max(worst, std::abs(slope - e.gradient[f][i][c]));
      }
  return largest > 0 ? worst / largest : 0;
}
} // namespace

TEST(ContactPotential, twoSquares)
{
  const FaceNodes faces[2] = {
      face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
      face({{.3, .2, -.01}, {.3, 1.2, -.01}, {1.3, 1.2, -.01}, {1.3, .2, -.01}})};
  const Evaluation<3> e(faces[0], faces[1], 1e6, 0);
  EXPECT_NEAR(e.energy, 28, 1e-11);
  EXPECT_NEAR(e.force, 5600, 1e-9);
  expectForce<3>(e, faces, 0, 0, {0, 0, -699.8125});
  expectForce<3>(e, faces, 0, 1, {-16, 0, -1540.0125});
  expectForce<3>(e, faces, 0, 2, {-24, -22.75, -2100.1875});
  expectForce<3>(e, faces, 1, 0, {24, 22.75, 2100.1875});
}

TEST(ContactPotential, triangleOnWarpedQuadrilateral)
{
  const FaceNodes faces[2] = {face({{0, 0, 0}, {1, .1, 0}, {.2, .9, .1}}),
                              face({{.1, .8, -.02}, {.9, .9, .05}, {1, 0, -.06}, {0, -.1, -.03}})};
  const Evaluation<3> e(faces[0], faces[1], 1e6, .004);
  EXPECT_NEAR(e.xi, .998575564269, 1e-12);
  EXPECT_NEAR(e.area, .436827020001, 1e-12);
  EXPECT_NEAR(e.force, 25259.2594462, 1e-6);
  EXPECT_NEAR(e.energy, 760.345049264, 1e-9);
  EXPECT_NEAR(e.ratio, .0602032732497, 1e-13);
  expectForce<3>(e, faces, 0, 0, {667.6727599, 1277.037996, -8264.131775});
  expectForce<3>(e, faces, 1, 2, {-77.7103033, -321.1029818, 4805.753151});
}

TEST(ContactPotential, facesThatHardlyOpposeEachOther)
{
  FaceNodes quadrilateral = face({{.1, .8, -.02}, {.9, .9, .05}, {1, 0, -.06}, {0, -.1, -.03}});
  const Vec3 about{.5, .4, -.02};
  const Real c = std::cos(1.35), s = std::sin(1.35);
  for (int i = 0; i < 4; ++i)
  {
    const Vec3 r = quadrilateral.x[i] - about;
    quadrilateral.x[i] = about + Vec3{r.x, c * r.y - s * r.z, s * r.y + c * r.z};
  }
  const FaceNodes faces[2] = {face({{0, 0, 0}, {1, .1, 0}, {.2, .9, .1}}), quadrilateral};
  const Evaluation<3> e(faces[0], faces[1], 1e6, .03);
  EXPECT_NEAR(e.xi, .263992046729, 1e-12);
  // The integral, 10007.5 J, is that of a closure of 0.26 of the size of the faces: the range of
  // the opposition is 0.411 in place of 0.2.
  EXPECT_NEAR(e.phi, .3511151513178, 1e-12);
  EXPECT_NEAR(e.energy, 3513.782172211, 1e-7);
  EXPECT_LT(errorOfGradient<3>(faces[0], faces[1], .03), 1e-10);
}

TEST(ContactPotential, segments)
{
  const FaceNodes faces[2] = {face({{1, 0, 0}, {0, 0, 0}}), face({{.3, -.02, 0}, {1.2, .03, 0}})};
  const Evaluation<2> e(faces[0], faces[1], 1e6, .004);
  EXPECT_NEAR(e.energy, 41.5439496616, 1e-9);
  expectForce<2>(e, faces, 0, 0, {0, -2305.500804, 0});
  expectForce<2>(e, faces, 0, 1, {0, -2887.82613, 0});
  expectForce<2>(e, faces, 1, 0, {46.00016763, 4365.323916, 0});
}

TEST(ContactPotential, gradientIsThatOfTheEnergy)
{
  std::mt19937 random(5);
  for (const Real warp : {0., .02, .2, .4})
  {
    int pairs = 0;
    while (pairs < 200)
    {
      const RandomPair pair = randomPair(random, warp);
      if (!(Evaluation<3>(pair.a, pair.b, 1, 0).energy > 1e-4))
        continue;
      ++pairs;
      for (const Real inverseDepth : {0., 4.})
        EXPECT_LT((errorOfGradient<3>(pair.a, pair.b, 0, 0, inverseDepth)), 3e-5)
            << "warp " << warp << " pair " << pairs;
    }
  }
}

/// A random pair whose second face, of `size` times the first one's, has sunk in by up to 0.4 times
/// its size and turned away by an angle [rad].
RandomPair deepPairTurnedAway(std::mt19937& random, Real angle, Real size = 1)
{
  std::uniform_real_distribution<Real> u(-1, 1);
  RandomPair pair = randomPair(random, .05 * u(random), 0);
  const Vec3 n = normalised(vectorArea<3>(pair.a.x, pair.a.count));
  Vec3 center{};
  for (int i = 0; i < pair.b.count; ++i)
    center += (1.0 / pair.b.count) * pair.b.x[i];
  const Vec3 axis = normalised(cross(n, Vec3{u(random), u(random), u(random)}));
  const Mat3 turn = rotation(axis, angle);
  const Vec3 sunk = -.2 * size * (1 + u(random)) * n;
  for (int i = 0; i < pair.b.count; ++i)
    pair.b.x[i] = center + turn * (size * (pair.b.x[i] - center)) + sunk;
  return pair;
}

/// Of a penalty that hardens from that depth on.
Real stiffnessOverBound(const RandomPair& pair, Real depthLimit)
{
  PairPlane plane = touchingPlane(1);
  plane.depthLimit = depthLimit;
  plane.birthArea[0] = areaOf<3>(pair.a);
  plane.birthArea[1] = areaOf<3>(pair.b);
  return facepairs::stiffnessOverBound<3>(
      pair, plane, ContactOptions::with(ContactOptions::Forces::Potential), 1e-6);
}

TEST(ContactPotential, whatLiesDeepTurnsAwayAtAStiffnessThatTheStepAllowsFor)
{
  // Over a fixed range of 0.008 of the opposition this was 13 000 times the bound. The range grows
  // with what is stored, so that turning is about as stiff as closing: flat pairs
  // as deep as faces are wide reach 13 times the bound through their rims, those at right
  // angles 22.
  std::mt19937 random(10);
  std::uniform_real_distribution<Real> near(.005, .03), wide(.005, .6);
  Real atRightAngles = 0, between = 0, flat = 0;
  for (int pairs = 0; pairs < 300; ++pairs)
  {
    const auto stiffness = [&](Real angle)
    { return stiffnessOverBound(deepPairTurnedAway(random, angle), infinity); };
    flat = std::max(flat, stiffness(.2));
    between = std::max(between, stiffness(std::acos(wide(random))));
    atRightAngles = std::max(atRightAngles, stiffness(std::acos(near(random))));
  }
  EXPECT_LT(flat, 15);
  EXPECT_LT(between, 15);
  EXPECT_LT(atRightAngles, 25);
}

TEST(ContactPotential, aSmallFaceTurnsAwayFromALargeOneNoStifferThanAnyOther)
{
  // What is stored counts by the size of the smaller face. By the geometric mean of both nine out
  // of ten stayed below 8.3. The rest are slivers, as among faces of one size.
  std::mt19937 random(11);
  std::uniform_real_distribution<Real> near(.005, .03);
  std::vector<Real> stiffnesses;
  for (int pairs = 0; pairs < 300; ++pairs)
    stiffnesses.push_back(
        stiffnessOverBound(deepPairTurnedAway(random, std::acos(near(random)), .25), infinity));
  std::sort(stiffnesses.begin(), stiffnesses.end());
  EXPECT_LT(stiffnesses[stiffnesses.size() * 9 / 10], 4);
}

TEST(ContactPotential, gradientOfDeepPairsThatTurnAway)
{
  std::mt19937 random(9);
  std::uniform_real_distribution<Real> angle(-1.5, 1.5);
  int pairs = 0;
  for (int part = 0; part < 200;)
  {
    const RandomPair pair = deepPairTurnedAway(random, angle(random));
    const Evaluation<3> e(pair.a, pair.b, 1, 0, {0, 0}, 0, 0, 4);
    ASSERT_LT(++pairs, 100000);
    if (!(e.energy > 1e-4))
      continue;
    part += e.phi > .02 && e.phi < .98;
    EXPECT_LT((errorOfGradient<3>(pair.a, pair.b, 0, 0, 4)), 3e-5) << "phi " << e.phi;
  }
}

TEST(ContactPotential, gradientOfDeepSegmentsThatTurnAway)
{
  std::mt19937 random(12);
  std::uniform_real_distribution<Real> u(-1, 1);
  int pairs = 0;
  for (int part = 0; part < 200;)
  {
    const FaceNodes a = face({{1, 0, 0}, {0, 0, 0}});
    const Real turn = 1.55 * u(random), deep = .2 * (1 + u(random)), half = .4 + .1 * u(random);
    const Vec3 along{half * std::cos(turn), half * std::sin(turn), 0};
    const Vec3 center{.5 + .2 * u(random), -deep, 0};
    const FaceNodes b = face({center - along, center + along});
    const Evaluation<2> e(a, b, 1, 0, {0, 0}, 0, 0, 4);
    ASSERT_LT(++pairs, 100000);
    if (!(e.energy > 1e-4))
      continue;
    part += e.phi > .02 && e.phi < .98;
    EXPECT_LT((errorOfGradient<2>(a, b, 0, 0, 4)), 3e-5) << "phi " << e.phi;
  }
}

TEST(ContactPotential, whatLiesDeeperStoresMoreAtAnyAngle)
{
  std::mt19937 random(13);
  std::uniform_real_distribution<Real> opposition(.005, .5);
  int part = 0;
  for (int pairs = 0; pairs < 200; ++pairs)
  {
    const RandomPair pair = deepPairTurnedAway(random, std::acos(opposition(random)));
    Real before = 0;
    for (Real offset = -.2; offset < .4; offset += .01)
    {
      const Evaluation<3> e(pair.a, pair.b, 1, offset);
      EXPECT_GE(e.energy, before * (1 - 1e-12)) << "phi " << e.phi << " offset " << offset;
      before = e.energy;
      part += e.phi > .02 && e.phi < .98;
    }
  }
  EXPECT_GT(part, 1000);
}

TEST(ContactPotential, gradientInTwoDimensionsAlsoWhereAWayOutIsNear)
{
  std::mt19937 random(6);
  std::uniform_real_distribution<Real> u(-1, 1);
  int pairs = 0, part = 0;
  while (pairs < 500)
  {
    // A strip of the width of the closure between an end of each.
    const Real turn = .2 * u(random), depth = .05, width = .05 + .15 * std::abs(u(random));
    FaceNodes a = face({{1, 0, 0}, {0, 0, 0}});
    FaceNodes b = face({{1 - width, -depth, 0}, {2, -depth + turn * .2, 0}});
    const unsigned exits = 1u << 0 | 1u << 4;
    const Evaluation<2> e(a, b, 1, 0, {0, 0}, exits);
    if (!(e.energy > 0))
      continue;
    ++pairs;
    part += e.share > .01 && e.share < .99;
    for (const Real inverseDepth : {0., 15.})
      EXPECT_LT((errorOfGradient<2>(a, b, 0, exits, inverseDepth)), 1e-5) << pairs;
  }
  EXPECT_GT(part, 100);
}

TEST(ContactPotential, whatBeganDeepGrowsWithTheShareOfTheSmallerFace)
{
  const FaceNodes a = face({{1, 0, 0}, {0, 0, 0}});
  const auto energy = [&](Real share, bool grows)
  {
    const FaceNodes b = face({{1 - share, -.1, 0}, {2 - share, -.1, 0}});
    return Evaluation<2>(a, b, 1, 0, {0, 0}, 0, 0, 0, 0, 0, grows).energy;
  };
  for (const Real share : {.2, .5})
    EXPECT_EQ(energy(share, true), energy(share, false));
  EXPECT_NEAR(energy(.1, true), .5 * energy(.1, false), 1e-16);
  EXPECT_NEAR(energy(.002, true) / energy(.002, false), 3e-4, 3e-6); // 3 z^2 with z = .01
}

TEST(ContactPotential, gradientOfWhatBeganDeep)
{
  std::mt19937 random(9);
  std::uniform_real_distribution<Real> u(0, 1);
  int part = 0;
  while (part < 300)
  {
    RandomPair pair =
        part % 2 == 0 ? randomSegments(random, 1) : randomPair(random, .1 * u(random));
    const Vec3 away{1.2 * u(random), part % 2 == 0 ? -.3 * u(random) : 1.2 * u(random),
                    part % 2 == 0 ? 0 : -.3 * u(random)};
    for (int i = 0; i < pair.b.count; ++i)
      pair.b.x[i] = pair.b.x[i] + away;
    const unsigned exits = unsigned(256 * u(random));
    const auto share = [&](auto evaluate)
    { return evaluate(true).energy / evaluate(false).energy; };
    const auto check = [&](auto dimension)
    {
      constexpr int dim = decltype(dimension)::value;
      const Real grown = share(
          [&](bool grows) {
            return Evaluation<dim>(pair.a, pair.b, 1, 0, {0, 0}, exits, 0, 4, 0, 0, grows);
          });
      if (!(grown > .01 && grown < .99))
        return;
      ++part;
      EXPECT_LT((errorOfGradient<dim>(pair.a, pair.b, 0, exits, 4, true)), 3e-5) << part;
    };
    if (part % 2 == 0)
      check(std::integral_constant<int, 2>());
    else
      check(std::integral_constant<int, 3>());
  }
}

TEST(ContactPotential, gradientInThreeDimensionsAlsoWhereAWayOutIsNear)
{
  std::mt19937 random(8);
  std::uniform_real_distribution<Real> u(0, 1);
  int pairs = 0, part = 0;
  while (part < 300)
  {
    RandomPair pair = randomPair(random, .1 * u(random));
    const Real deep = .3 * u(random);
    for (int i = 0; i < pair.b.count; ++i)
      pair.b.x[i] -= deep * Vec3{0, 0, 1};
    const unsigned exits = unsigned(256 * u(random));
    const Evaluation<3> e(pair.a, pair.b, 1, 0, {0, 0}, exits);
    ASSERT_LT(++pairs, 100000);
    if (!(e.energy > 1e-4) || !(e.share > .02 && e.share < .98))
      continue;
    ++part;
    for (const Real inverseDepth : {0., 4.})
      EXPECT_LT((errorOfGradient<3>(pair.a, pair.b, 0, exits, inverseDepth)), 3e-5)
          << "share " << e.share;
  }
}

TEST(ContactPotential, theNarrowestStripIsTheWayOut)
{
  // What two squares share at a corner of each: w x l, as deep as w. A strip is w / 2c = 1/2, and a
  // square two of them.
  const auto shareOf = [](Real w, Real l, unsigned exits)
  {
    return Evaluation<3>(face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
                         face({{1 - w, 1 - l, -w}, {1 - w, 2, -w}, {2, 2, -w}, {2, 1 - l, -w}}), 1,
                         0, {0, 0}, exits)
        .share;
  };
  const auto chi = [](Real rho)
  {
    const Real z = (rho - .25) / .75;
    return z * z * z * (10 - 15 * z + 6 * z * z);
  };
  constexpr unsigned across = 1u << 1 | 1u << 6, along = 1u << 2 | 1u << 7;
  EXPECT_NEAR(shareOf(.1, .4, across), chi(.5), 1e-12);
  EXPECT_NEAR(shareOf(.1, .4, across | along), chi(.5 / std::pow(1 + std::pow(.25, 4), .25)),
              1e-12);
  EXPECT_NEAR(shareOf(.1, .1, across | along), chi(.5 / std::pow(2, .25)), 1e-12);
  // Edges at right angles bound none, and neither do two of one face.
  EXPECT_EQ(shareOf(.1, .1, 1u << 1 | 1u << 7), 1);
  EXPECT_EQ(shareOf(.1, .1, 1u << 1 | 1u << 2), 1);
}

TEST(ContactPotential, aStripBeginsWithoutAJump)
{
  // A tilted face sinks into another one beside an edge of each. Where the closed part grows up to
  // the second of these edges it lies between both from then on: half of the energy is at stake.
  for (const Real tilt : {-1., 1.})
  {
    int part = 0;
    Real before[2] = {0, 0};
    for (Real down = 0; down < .2; down += 1e-5)
    {
      const Real left = (tilt > 0 ? 0 : .1) - down, right = left + 1.1 * tilt;
      const Evaluation<2> flat(face({{1, 0, 0}, {0, 0, 0}}), face({{.9, left, 0}, {2, right, 0}}),
                               1, 0, {0, 0}, 1u << 0 | 1u << 4);
      const Evaluation<3> solid(face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
                                face({{.9, 0, left}, {.9, 1, left}, {2, 1, right}, {2, 0, right}}),
                                1, 0, {0, 0}, 1u << 1 | 1u << 6);
      part += flat.share > .01 && flat.share < .99;
      EXPECT_LT(std::abs(flat.energy - before[0]), 2e-7) << down;
      EXPECT_LT(std::abs(solid.energy - before[1]), 2e-7) << down;
      EXPECT_NEAR(solid.share, flat.share, 1e-9) << down;
      before[0] = flat.energy;
      before[1] = solid.energy;
    }
    EXPECT_GT(part, 1000);
  }
}

TEST(ContactPotential, forcesAreNumbersWhereAStripBecomesAFace)
{
  // At three quarters of the smaller face in common a way out stops to count, also to the last bit.
  for (Real off = 1e-2; off > 1e-17; off *= .7)
    for (const Real side : {-off, 0., off})
    {
      const Evaluation<3> e(
          face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
          face({{.25 + side, 0, -.1}, {.25 + side, 1, -.1}, {1.25, 1, -.1}, {1.25, 0, -.1}}), 1e6,
          0, {0, 0}, 0xff);
      for (const auto& ofFace : e.gradient)
        for (const Vec3& g : ofFace)
          EXPECT_TRUE(std::isfinite(norm(g))) << side;
      EXPECT_TRUE(e.share > 0 && e.share <= 1) << side << " " << e.share;
    }
}

TEST(ContactPotential, forcesAndMomentsSumToZero)
{
  std::mt19937 random(7);
  for (int n = 0; n < 2000; ++n)
  {
    const RandomPair pair = randomPair(random, .3);
    const Evaluation<3> e(pair.a, pair.b, 1, .02, {1, 1}, random() & 255);
    expectBalanced(pair, e.gradient);
  }
}

TEST(ContactPotential, givesNumbersHoweverLittleFacesOpposeEachOther)
{
  // With cos_opposed 0 the energy begins at a right angle, where round-off says by how much faces
  // oppose each other. A face on edge slides along another one, with friction.
  ContactOptions fromRightAngles;
  fromRightAngles.cosOpposed = 0;
  for (const bool penalty : {false, true})
    for (const Real xi : {.1, 1e-3, 1e-8, 1e-16, 1e-30, 1e-60, 1e-80, 1e-120, 1e-150, 1e-153,
                          1e-155, 1e-160, 1e-200, 1e-300, 5e-324, 0.})
      for (const int dimension : {2, 3})
      {
        SCOPED_TRACE(::testing::Message() << "xi " << xi << ", " << dimension << "D");
        PairPlane plane = touchingPlane(1e6, .3);
        plane.law.penalty = penalty;
        plane.depthLimit = .6;
        const Vec3 velocity{1, .5, 0};
        for (int step = 0; step < 3; ++step)
        {
          const Vec3 shift = (.01 * step) * velocity;
          if (dimension == 2)
            updatePlane<2>(plane, face({{1, 0, 0}, {-1, 0, 0}}),
                           moved(face({{-.5 * xi, -.5, 0}, {.5 * xi, .5, 0}}, velocity),
                                 rotation({0, 0, 1}, 0), shift),
                           fromRightAngles, .01);
          else
            updatePlane<3>(plane, face({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}),
                           moved(face({{-.5 * xi, -.5, -.5},
                                       {-.5 * xi, .5, -.5},
                                       {.5 * xi, .5, .5},
                                       {.5 * xi, -.5, .5}},
                                      velocity),
                                 rotation({0, 0, 1}, 0), shift),
                           fromRightAngles, .01);
          Real sum = plane.stored + plane.work + plane.frictionWork + plane.closure +
                     plane.normalTraction + plane.nodeStiffness + plane.area +
                     norm(plane.history.shearTraction);
          for (const auto& forces : plane.cornerForce)
            for (const Vec3& force : forces)
              sum += norm(force);
          EXPECT_TRUE(std::isfinite(sum)) << "step " << step;
        }
      }
}

TEST(ContactPotential, aSeamKeepsItsBorderBesideACorner)
{
  // The end of a slab, node 0 of the first face, and the tip of a corner, node 1 of the second one,
  // pass each other on the plane. A line of the mesh has another pair behind it that takes back
  // what the tip gets of its border; a seam that opens has none, so it is the gradient that counts.
  const FaceNodes slab = face({{1, 0, 0}, {0, 0, 0}});
  const auto cornerAt = [](Real x) { return face({{x - .7, .67, 0}, {x, -.03, 0}}); };
  const auto worst = [&](unsigned seams)
  {
    Real most = 0;
    for (Real x = .96; x < 1.04; x += 1e-4)
    {
      const auto energyAt = [&](Real place) {
        return Evaluation<2>(slab, cornerAt(place), 1, 0, {1, 1}, 0, 1e-3, 0, 1u << 5, seams);
      };
      const Evaluation<2> here = energyAt(x);
      constexpr Real h = 1e-7;
      const Real slope = (energyAt(x + h).energy - energyAt(x - h).energy) / (2 * h);
      most = std::max(most, std::abs(here.gradient[1][0].x + here.gradient[1][1].x - slope));
    }
    return most;
  };
  const Real border = .5 * .03 * .03;
  EXPECT_LT(worst(1u << 0), 1e-3 * border);
  EXPECT_GT(worst(0), .3 * border);
}

TEST(ContactPotential, roundOffDoesNotDecideWhoOwnsARim)
{
  // A face that ends where the other one, of longer edges, has a line of its mesh; pressed less and
  // less evenly, and moved over the line by round-off.
  for (const Real tilt : {0.2, 0.5, 0.8, 1.1, 1.4})
    for (const Real length : {1.5, 3.0})
    {
      const auto height = [&](Real x) { return 0.01 * (1 + tilt * (x - 0.5)); };
      const FaceNodes ends =
          face({{0, 0, height(0)}, {1, 0, height(1)}, {1, 1, height(1)}, {0, 1, height(0)}});
      const auto at = [&](Real x)
      {
        const Real low = 0.5 - 0.5 * length, high = 0.5 + 0.5 * length;
        return Evaluation<3>(ends, face({{x, low, 0}, {x, high, 0}, {2, high, 0}, {2, low, 0}}),
                             1e9, 0, {1, 1}, 0, 1e-3, 0, 0x0f);
      };
      // Where both edges have one shadow on the common plane.
      const Real slope = 0.01 * tilt, line = slope * height(0) / (1 + std::sqrt(1 + slope * slope));
      const Evaluation<3> before = at(line - 1e-12), after = at(line + 1e-12);
      Real largest = 0, difference = 0;
      for (int f = 0; f < 2; ++f)
        for (int n = 0; n < 4; ++n)
        {
          largest = std::max(largest, norm(before.gradient[f][n]));
          difference = std::max(difference, norm(before.gradient[f][n] - after.gradient[f][n]));
        }
      EXPECT_GT(largest, 0) << tilt << " " << length;
      EXPECT_LT(difference, 1e-9 * largest) << tilt << " " << length;
    }
}

TEST(ContactPotential, matchedFacesUnderEvenClosureAreNotSqueezed)
{
  // Rims are shared, and material area takes back what stretching would cost.
  const FaceNodes a = face({{0, 0, 0}, {1, .1, 0}, {1.2, 1, 0}, {-.1, .9, 0}});
  FaceNodes b = a;
  for (int i = 0; i < 4; ++i)
    b.x[i] = a.x[3 - i] + Vec3{1e-6, -2e-6, -.01};
  const Evaluation<3> e(a, b, 1e6, 0);
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < 4; ++i)
    {
      EXPECT_NEAR(e.gradient[f][i].x, 0, 1e-3);
      EXPECT_NEAR(e.gradient[f][i].y, 0, 1e-3);
    }
  // Exactly on each other: to round-off.
  for (int i = 0; i < 4; ++i)
    b.x[i] = a.x[3 - i] + Vec3{0, 0, -.01};
  const Evaluation<3> matched(a, b, 1e6, 0);
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(std::hypot(matched.gradient[f][i].x, matched.gradient[f][i].y), 0, 1e-11);
}

TEST(ContactPotential, anEvenClosureOfAPenaltyBearsWhatItsHardeningSays)
{
  const FaceNodes a = face({{1, 0, 0}, {0, 0, 0}}), b = face({{0, 0, 0}, {1, 0, 0}});
  const Real stiffness = 3e6, depth = .12;
  for (const Real linear : {.002, .03, .1, .3, 2.0})
  {
    const Real closure = linear * hardenedClosure(linear / depth);
    const Evaluation<2> pair(a, b, stiffness, closure, {0, 0}, 0, 1e-3, 1 / depth);
    EXPECT_NEAR(pair.force, stiffness * linear * pair.area, 1e-9 * pair.force);
    EXPECT_NEAR(pair.energy,
                .5 * stiffness * closure * closure * HardenedPenalty<Real>(closure / depth).value,
                1e-9 * pair.energy);
  }
}
} // namespace coplane
