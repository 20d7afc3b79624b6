#include <coplane_geometry/FaceMap.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace coplane;

namespace
{
Vec2 pointAt(const FaceMap& map, const Vec2* p, Real xi, Real eta)
{
  Real w[4];
  map.weights(xi, eta, xi * eta, w);
  Vec2 sum;
  for (int i = 0; i < map.nodes; ++i)
    sum = sum + w[i] * p[i];
  return sum;
}

Real length(const Vec2& a)
{
  return std::sqrt(dot(a, a));
}

/// sin of the smallest corner angle that counts for the map: 0 where three nodes are in line.
Real flattestCorner(const Vec2* p)
{
  Real least = 1;
  for (int i = 0; i < 4; ++i)
  {
    const Vec2 a = p[(i + 1) % 4] - p[i], b = p[(i + 3) % 4] - p[i];
    least = std::min(least, cross(a, b) / (length(a) * length(b)));
  }
  return least;
}

/// Largest distance between a point and the point that the weights at its coordinates give, over
/// random convex quadrilaterals whose corners are at least as sharp as asked and points inside.
Real worstReproduction(Real sine, int count, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  Real worst = 0;
  for (int n = 0; n < count;)
  {
    Vec2 p[4];
    for (auto& q : p)
      q = {uniform(random), uniform(random)};
    if (!isConvex(p, 4) || flattestCorner(p) < sine)
      continue;
    ++n;
    const FaceMap map(p, 4);
    for (int k = 0; k < 4; ++k)
    {
      const Vec2 at = pointAt(map, p, .999 * uniform(random), .999 * uniform(random));
      const Vec2 c = map.coordinates(at);
      const Real error = length(pointAt(map, p, c.x, c.y) - at);
      worst = std::isfinite(error) ? std::max(worst, error) : infinity;
    }
  }
  return worst;
}
} // namespace

TEST(FaceMap_Coordinates, cornersOfAQuadrilateralAreThoseOfTheReferenceSquare)
{
  const Vec2 p[4] = {{0, 0}, {3, .2}, {2.5, 2}, {-.3, 1.4}};
  const Vec2 expected[4] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const FaceMap map(p, 4);
  for (int i = 0; i < 4; ++i)
  {
    const Vec2 got = map.coordinates(p[i]);
    EXPECT_NEAR(got.x, expected[i].x, 1e-14);
    EXPECT_NEAR(got.y, expected[i].y, 1e-14);
  }
}

TEST(FaceMap_Coordinates, trianglesGiveBarycentricCoordinates)
{
  // p = 0.2 p0 + 0.3 p1 + 0.5 p2.
  const Vec2 p[3] = {{1, 1}, {4, 2}, {2, 5}};
  const FaceMap map(p, 3);
  const Vec2 c = map.coordinates({.2 * 1 + .3 * 4 + .5 * 2, .2 * 1 + .3 * 2 + .5 * 5});
  Real w[4];
  map.weights(c.x, c.y, c.x * c.y, w);
  EXPECT_NEAR(w[0], .2, 4 * epsilon);
  EXPECT_NEAR(w[1], .3, 4 * epsilon);
  EXPECT_NEAR(w[2], .5, 4 * epsilon);
  EXPECT_EQ(w[3], 0.0);
}

TEST(FaceMap_Coordinates, clockwiseShadowsAreMappedAsWell)
{
  // The shadow of the higher face is clockwise.
  const Vec2 p[4] = {{-.3, 1.4}, {2.5, 2}, {3, .2}, {0, 0}};
  const FaceMap map(p, 4);
  const Vec2 at = pointAt(map, p, .3, -.6);
  const Vec2 c = map.coordinates(at);
  EXPECT_NEAR(c.x, .3, 1e-14);
  EXPECT_NEAR(c.y, -.6, 1e-14);
}

TEST(FaceMap_Coordinates, parallelogramIsRecognisedAndNeedsOneIteration)
{
  const Vec2 p[4] = {{.1, .2}, {1.3, .5}, {1.7, 1.6}, {.5, 1.3}};
  const FaceMap map(p, 4);
  EXPECT_TRUE(map.affine);
  const Vec2 c = map.coordinates(pointAt(map, p, .7, -.9));
  EXPECT_NEAR(c.x, .7, 8 * epsilon);
  EXPECT_NEAR(c.y, -.9, 8 * epsilon);
  const Vec2 trapezium[4] = {{0, 0}, {1, 0}, {1 - 1e-9, 1}, {0, 1}};
  EXPECT_FALSE(FaceMap(trapezium, 4).affine);
}

TEST(FaceMap_Weights, sumToOneWhateverTheMeansAre)
{
  const Vec2 p[4] = {{0, 0}, {3, .2}, {2.5, 2}, {-.3, 1.4}};
  Real w[4];
  FaceMap(p, 4).weights(.31, -.77, .123, w); // xi eta is not the product: a mean over an area
  EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 2 * epsilon);
  FaceMap(p, 3).weights(.31, .27, .123, w);
  EXPECT_NEAR(w[0] + w[1] + w[2], 1, 2 * epsilon);
}

TEST(FaceMap_Weights, reproduceThePointInOrdinaryQuadrilaterals)
{
  EXPECT_LT(worstReproduction(.2, 5000, 1), 1e-13);
}

TEST(FaceMap_Weights, reproduceThePointInQuadrilateralsWithAnAlmostStraightCorner)
{
  EXPECT_LT(worstReproduction(1e-6, 20000, 2), 1e-12);
}

TEST(FaceMap_Weights, meansOverAnAreaReproduceItsCentroid)
{
  // The map is isoparametric: the mean of the weights at some points gives the mean of the points.
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  const Vec2 p[4] = {{0, 0}, {3, .2}, {2.5, 2}, {-.3, 1.4}};
  const FaceMap map(p, 4);
  Vec2 mean, meanOfCoordinates;
  Real meanOfProduct = 0;
  for (int k = 0; k < 16; ++k)
  {
    const Vec2 at = pointAt(map, p, uniform(random), uniform(random));
    const Vec2 c = map.coordinates(at);
    mean = mean + (1.0 / 16) * at;
    meanOfCoordinates = meanOfCoordinates + (1.0 / 16) * c;
    meanOfProduct += c.x * c.y / 16;
  }
  Real w[4];
  map.weights(meanOfCoordinates.x, meanOfCoordinates.y, meanOfProduct, w);
  Vec2 got;
  for (int i = 0; i < 4; ++i)
    got = got + w[i] * p[i];
  EXPECT_NEAR(got.x, mean.x, 1e-14);
  EXPECT_NEAR(got.y, mean.y, 1e-14);
}

TEST(FaceMap_Interpolate, linearFunctionsAreExact)
{
  const Vec2 p[4] = {{0, 0}, {3, .2}, {2.5, 2}, {-.3, 1.4}};
  Real values[4];
  for (int i = 0; i < 4; ++i)
    values[i] = 2 + 3 * p[i].x - p[i].y;
  const FaceMap map(p, 4);
  EXPECT_NEAR(map.interpolate(values, map.coordinates({1.1, .9})), 2 + 3.3 - .9, 1e-14);
}

TEST(FaceMap_IsConvex, tellsConvexFromFoldedAndClockwise)
{
  const Vec2 convex[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const Vec2 clockwise[4] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  const Vec2 reentrant[4] = {{0, 0}, {1, 0}, {.2, .2}, {0, 1}};
  const Vec2 bowTie[4] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  EXPECT_TRUE(isConvex(convex, 4));
  EXPECT_FALSE(isConvex(clockwise, 4));
  EXPECT_FALSE(isConvex(reentrant, 4));
  EXPECT_FALSE(isConvex(bowTie, 4));
}
