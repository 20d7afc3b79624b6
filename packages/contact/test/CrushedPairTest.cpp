// Pairs of faces whose joint is crushed unevenly: energy, gradient, what crushing costs.
#include "FacePairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace coplane
{
namespace
{
using namespace facepairs;

/// Energy and gradient of a pair that is crushed.
template <int Dim>
struct Crushed
{
  Real energy = 0, share = 1, mean = 0, area = 0;
  Vec3 gradient[2][4];

  Crushed(const FaceNodes& a, const FaceNodes& b, const UnevenCrushing* crushing, Real offset,
          unsigned exits = 0, bool sharing = false)
  {
    const HalfStepFace faceA = stepA_faceAtEnd<Dim>(a), faceB = stepA_faceAtEnd<Dim>(b);
    ContactPotentialScale scale(0.1);
    if (!sharing) // sharing is no gradient
      scale.oneEdge = scale.oneBorder = 0;
    PairPotential<Dim, Real> pair(faceA, faceB, scale);
    if (!pair.plane.opposed)
      return;
    EdgesOf<Real> edges;
    for (int e = 0; e < 8; ++e)
      edges.exits[e] = edges.turns[e] = exits >> e & 1;
    if (crushing != nullptr)
      pair.beCrushed(*crushing);
    pair.meet(offset, false, edges);
    if (!(pair.moments.volume > 0))
      return;
    EnergyDensity<Real> density;
    const Real stored = pair.press(1, 0, density);
    share = pair.wayOut;
    area = pair.moments.area;
    if (crushing != nullptr)
      mean = pair.meanCrushing();
    pair.growFrom(1.3, .8);
    pair.differentiate(stored, density);
    energy = pair.materialArea * pair.opposedness * stored;
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < 4; ++i)
        gradient[f][i] = pair.gradient[f][i];
  }
};

/// Largest difference between the gradient and central differences, over the largest entry.
template <int Dim>
Real errorOfGradient(const RandomPair& pair, const UnevenCrushing& crushing, unsigned exits = 0)
{
  const Crushed<Dim> e(pair.a, pair.b, &crushing, 0, exits);
  Real largest = 0, worst = 0;
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < (f == 0 ? pair.a : pair.b).count; ++i)
      for (int c = 0; c < Dim; ++c)
      {
        largest = std::max(largest, std::abs(e.gradient[f][i][c]));
        const auto at = [&](Real h)
        {
          FaceNodes faces[2] = {pair.a, pair.b};
          faces[f].x[i][c] += h;
          return Crushed<Dim>(faces[0], faces[1], &crushing, 0, exits).energy;
        };
        const Real h = 2e-6;
        const Real slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
        worst = std::max(worst, std::abs(slope - e.gradient[f][i][c]));
      }
  return largest > 0 ? worst / largest : 0;
}

/// Crushing of the size of the closures of random pairs, of one sign or both; or steeper, and
/// nothing somewhere in the strip.
UnevenCrushing someCrushing(std::mt19937& random, bool steep)
{
  std::uniform_real_distribution<Real> u(-1, 1);
  if (!steep)
    return {.05 * u(random), {.1 * u(random), .1 * u(random)}};
  const Real along = .6 * u(random);
  return {(.45 + .05 * u(random)) * along, {along, .6 * u(random)}};
}

template <int Dim>
RandomPair somePair(std::mt19937& random, Real warp)
{
  return Dim == 2 ? randomSegments(random) : randomPair(random, warp);
}

/// A strip about as wide as it is deep between edges of both faces.
template <int Dim>
RandomPair someStrip(std::mt19937& random)
{
  std::uniform_real_distribution<Real> u(0, 1);
  if constexpr (Dim == 2)
  {
    const Real width = .05 + .15 * u(random), turn = .05 * (u(random) - .5);
    return {face({{1, 0, 0}, {0, 0, 0}}), face({{1 - width, -.05, 0}, {2, -.05 + turn, 0}})};
  }
  RandomPair pair = randomPair(random, .1 * u(random));
  const Vec3 n = normalised(vectorArea<3>(pair.a.x, pair.a.count));
  const Real deep = .3 * u(random);
  for (int i = 0; i < pair.b.count; ++i)
    pair.b.x[i] -= deep * n;
  return pair;
}

template <int Dim>
void expectGradients(Real warp, bool exits)
{
  std::mt19937 random(21);
  int mixed = 0, kinds[2][2] = {};
  for (int pairs = 0, tried = 0; pairs < 300; ++tried)
  {
    ASSERT_LT(tried, 100000);
    const RandomPair pair = exits ? someStrip<Dim>(random) : somePair<Dim>(random, warp);
    const UnevenCrushing crushing = someCrushing(random, exits);
    const unsigned edges = !exits ? 0 : Dim == 2 ? 1u << 0 | 1u << 4 : unsigned(random() & 255);
    const Crushed<Dim> e(pair.a, pair.b, &crushing, 0, edges);
    const Crushed<Dim> whole(pair.a, pair.b, nullptr, 0, edges);
    if (!(e.energy > 1e-5) || !(e.energy < .98 * whole.energy))
      continue;
    if (exits && !(e.share > .02 && e.share < .98))
      continue;
    ++pairs;
    const UnevenCrushing opposite{-crushing.atCenter, {-crushing.along[0], -crushing.along[1]}};
    mixed += e.mean > 1e-4 && Crushed<Dim>(pair.a, pair.b, &opposite, 0, edges).mean > 1e-4;
    ++kinds[pair.a.count == 3][pair.b.count == 3];
    EXPECT_LT(errorOfGradient<Dim>(pair, crushing, edges), 1e-6)
        << "pair " << pairs << " share " << e.share;

    // Sums of forces and moments.
    Vec3 force, moment;
    Real size = 0;
    const FaceNodes* faces[2] = {&pair.a, &pair.b};
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < faces[f]->count; ++i)
      {
        force += e.gradient[f][i];
        moment += cross(faces[f]->x[i], e.gradient[f][i]);
        size = std::max(size, norm(e.gradient[f][i]));
      }
    EXPECT_LE(norm(force), 1e-12 * size);
    EXPECT_LE(norm(moment), 1e-11 * size);
  }
  EXPECT_GT(mixed, 30);
  for (const auto& of : kinds)
    for (const int kind : of)
    {
      EXPECT_GT(kind, Dim == 3 ? 10 : -1);
    }
}
} // namespace

TEST(CrushedPair, gradientIsThatOfTheEnergy)
{
  for (const Real warp : {0., .02, .2, .4})
  {
    SCOPED_TRACE(testing::Message() << "warp " << warp);
    expectGradients<3>(warp, false);
  }
}

TEST(CrushedPair, gradientInTwoDimensions)
{
  expectGradients<2>(0, false);
}

TEST(CrushedPair, gradientWhereAWayOutIsNear)
{
  expectGradients<2>(0, true);
  expectGradients<3>(.05, true);
}
} // namespace coplane
