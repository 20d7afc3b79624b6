// Bonds that resist bending: forces by the closure at each point of a face.
#include "FacePairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace coplane
{
namespace
{
using namespace facepairs;

constexpr Real k = 2e10, strength = 1e6, energy = 100; // the joint opens to 2e-4 m

PairPlane bondedPlane(Real stiffness = k)
{
  PairPlane plane = touchingPlane(stiffness);
  plane.law.bond = Bond::softening(Bond::Kind::Linear, strength, 5 * strength, energy, energy);
  plane.law.bond.resistsBending = true;
  plane.history.bonded = plane.declared = true;
  return plane;
}

/// A segment of length 1 that looks up, and one above it.
const FaceNodes below = face({{.5, 0, 0}, {-.5, 0, 0}});
FaceNodes above(Real open, Real angle)
{
  const Real c = std::cos(angle), s = std::sin(angle);
  return face({{-.5 * c, open - .5 * s, 0}, {.5 * c, open + .5 * s, 0}});
}

/// Of the forces on face 1 about its middle.
Real momentOnB(const PairPlane& plane, const FaceNodes& b)
{
  const Vec3 middle = .5 * (b.x[0] + b.x[1]);
  return cross(b.x[0] - middle, plane.cornerForce[1][0]).z +
         cross(b.x[1] - middle, plane.cornerForce[1][1]).z;
}

/// How much of k is left where it is open after an inelastic opening.
Real secant(Real opening)
{
  const Real left = strength * (1 - opening * strength / (2 * energy));
  return left / (left / k + opening);
}

/// Largest difference between forces and central differences of what is stored, over the largest
/// force.
template <int Dim>
Real errorOfForces(const RandomPair& pair, PairPlane plane)
{
  updatePlane<Dim>(plane, pair.a, pair.b, ContactOptions{}, 0);
  Real largest = 0, worst = 0;
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < (f == 0 ? pair.a : pair.b).count; ++i)
      for (int c = 0; c < Dim; ++c)
      {
        const auto at = [&](Real h)
        {
          RandomPair moved = pair;
          (f == 0 ? moved.a : moved.b).x[i][c] += h;
          PairPlane there = plane;
          updatePlane<Dim>(there, moved.a, moved.b, ContactOptions{}, 0);
          return there.stored;
        };
        const Real h = 3e-5;
        const Real slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
        largest = std::max(largest, std::abs(plane.cornerForce[f][i][c]));
        worst = std::max(worst, std::abs(slope + plane.cornerForce[f][i][c]));
      }
  return largest > 0 ? worst / largest : 0;
}

/// A bond of stiffness 1 that has lost more than half of it, and wears no further at closures of
/// the size of the random pairs.
PairPlane wornPlane(bool worn)
{
  PairPlane plane = bondedPlane(1);
  plane.law.bond = Bond::softening(Bond::Kind::Linear, 1e3, 1e3, 2e6, 2e6);
  plane.law.bond.resistsBending = true;
  plane.fit.shearStiffness = 0;
  plane.history.opening = worn ? 1e3 : 0;
  return plane;
}

/// Whether two ends lie beside each other along the common plane: there one edge takes over from
/// another, and forces are shared, which is no gradient.
bool endsMeet(const RandomPair& pair)
{
  const Vec3 n = normalised(vectorArea<2>(pair.a.x, 2)) - normalised(vectorArea<2>(pair.b.x, 2));
  const Vec3 along = normalised(Vec3{-n.y, n.x, 0});
  Real least = infinity;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      least = std::min(least, std::abs(dot(along, pair.a.x[i] - pair.b.x[j])));
  return least < 5e-3;
}
} // namespace

TEST(BentBond, aSegmentCarriesTheMomentOfItsStiffness)
{
  const Real angle = 2e-5, open = 1e-6;
  PairPlane plane = bondedPlane();
  plane.law.bond.tensileStrength = 1e9;
  const FaceNodes b = above(open, angle);
  updatePlane<2>(plane, below, b, ContactOptions{}, 0);
  EXPECT_NEAR(plane.forceOn(1).y, -k * open, 1e-4 * k * open);
  EXPECT_NEAR(momentOnB(plane, b), -k * angle / 12, 1e-4 * k * angle / 12);
  EXPECT_NEAR(plane.stored, .5 * k * (open * open + angle * angle / 12), 1e-4 * plane.stored);
  plane.law.bond.resistsBending = false;
  updatePlane<2>(plane, below, b, ContactOptions{}, 0);
  EXPECT_LT(std::abs(momentOnB(plane, b)), 1e-3 * k * angle / 12) << "the others carry none";
}

TEST(BentBond, aSquareCarriesTheMomentOfItsStiffness)
{
  const FaceNodes a = face({{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}});
  const Real angle = 1e-6;
  FaceNodes b = face({{0, 2, 0}, {1, 2, 0}, {1, 0, 0}, {0, 0, 0}});
  for (int i = 0; i < 4; ++i)
    b.x[i].z = angle * (b.x[i].y - 1);
  PairPlane plane = bondedPlane();
  updatePlane<3>(plane, a, b, ContactOptions{}, 0);
  const Resultant on = resultant(a, b, plane.cornerForce);
  Vec3 moment{};
  for (int i = 0; i < 4; ++i)
    moment += cross(b.x[i] - Vec3{.5, 1, 0}, plane.cornerForce[1][i]);
  EXPECT_NEAR(moment.x, -k * angle * 8 / 12, 1e-5 * k * angle);
  EXPECT_LT(std::abs(moment.y), 1e-5 * k * angle);
  EXPECT_LT(norm(on.force) + norm(on.moment), 1e-9 * k * angle);
}

TEST(BentBond, whatIsClosedKeepsItsStiffness)
{
  const Real angle = 1e-5, opening = 6e-5, less = secant(opening);
  PairPlane plane = bondedPlane();
  plane.history.opening = opening;
  const FaceNodes b = above(0, angle);
  updatePlane<2>(plane, below, b, ContactOptions{}, 0);
  EXPECT_EQ(plane.history.opening, opening);
  EXPECT_LT(less, .5 * k);
  EXPECT_NEAR(plane.forceOn(1).y, (k - less) * angle / 8, 1e-4 * k * angle);
  EXPECT_NEAR(momentOnB(plane, b), -(k + less) * angle / 24, 1e-4 * k * angle / 24);
  EXPECT_NEAR(plane.stored, .5 * (k + less) * angle * angle / 24, 1e-4 * plane.stored);
  EXPECT_NEAR(plane.normalTraction, plane.forceOn(1).y, 1e-4 * k * angle);
}

TEST(BentBond, forcesAreThoseOfTheEnergyAndWithoutResultant)
{
  std::mt19937 random(3);
  int open = 0;
  for (int n = 0; n < 200; ++n)
    for (const bool worn : {false, true})
    {
      const RandomPair pair = randomPair(random, n % 2 == 0 ? 0 : .1),
                       line = randomSegments(random);
      EXPECT_LT(errorOfForces<3>(pair, wornPlane(worn)), 1e-4) << n << worn;
      if (!endsMeet(line))
      {
        EXPECT_LT(errorOfForces<2>(line, wornPlane(worn)), 1e-4) << n << worn;
      }
      PairPlane plane = wornPlane(worn);
      updatePlane<2>(plane, line.a, line.b, ContactOptions{}, 0);
      const Resultant on = resultant(line.a, line.b, plane.cornerForce);
      EXPECT_LT(norm(on.force) + norm(on.moment), 1e-12);
      open += plane.normalTraction < 0;
    }
  EXPECT_GT(open, 10);
}

TEST(BentBond, bentApartItTakesTheEnergyOfItsOpenPart)
{
  // Closed half k/2 c^2, open half softens: a third of half of G, for the openings of a
  // triangle.
  const Real last = 5e-4;
  for (const int steps : {4000, 8000})
  {
    PairPlane plane = bondedPlane();
    plane.fit.shearStiffness = 0;
    Real largest = 0, broke = 0;
    for (int i = 0; i <= steps; ++i)
    {
      const Real angle = last * i / steps;
      FaceNodes b = above(0, angle);
      b.v[0] = {0, -.5 * last / steps, 0};
      b.v[1] = {0, .5 * last / steps, 0};
      updatePlane<2>(plane, below, b, ContactOptions{}, 1);
      largest = std::max(largest, -momentOnB(plane, b));
      if (broke == 0 && !plane.history.bonded)
        broke = angle;
    }
    // The first fibre reaches the strength at the moment f_t h^2 / 6; then it softens.
    EXPECT_GT(largest, strength / 6);
    EXPECT_NEAR(broke, 4e-4, 2e-6) << "where the outermost point is open by 2 G / f_t";
    EXPECT_NEAR(plane.fractureWork, energy / 6, 2e-3 * energy);
    EXPECT_LT(std::abs(plane.remainder()), (4000. / steps) * 2e-3 * plane.fractureWork);
    EXPECT_NEAR(plane.stored, .5 * k * last * last / 24, 1e-2 * plane.stored);
  }
}
} // namespace coplane
