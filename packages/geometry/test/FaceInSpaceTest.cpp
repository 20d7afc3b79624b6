#include <coplane_geometry/AffineWeights.hpp>
#include <coplane_geometry/FaceCorners.hpp>
#include <coplane_geometry/PlaneAxes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace coplane
{
namespace
{
using Random = std::mt19937;

Vec3 randomVector(Random& random)
{
  std::uniform_real_distribution<Real> number(-1, 1);
  const Real x = number(random), y = number(random);
  return {x, y, number(random)};
}

void expectNear(const Vec3& a, const Vec3& b, Real tolerance)
{
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

/// Integral of dx/dxi x dx/deta over the bilinear patch, by Gauss points that are exact for it.
Vec3 integralOverPatch(const Vec3 (&x)[4])
{
  Vec3 sum{};
  const Real g = 1 / std::sqrt(3.0);
  for (const Real xi : {-g, g})
    for (const Real eta : {-g, g})
    {
      const Vec3 alongXi = 0.25 * ((1 - eta) * (x[1] - x[0]) + (1 + eta) * (x[2] - x[3]));
      const Vec3 alongEta = 0.25 * ((1 - xi) * (x[3] - x[0]) + (1 + xi) * (x[2] - x[1]));
      sum += cross(alongXi, alongEta);
    }
  return sum;
}
} // namespace

TEST(FaceInSpace, vectorAreaIsTheIntegralOverAWarpedPatch)
{
  Random random(1);
  for (int i = 0; i < 100; ++i)
  {
    Vec3 x[4];
    for (Vec3& corner : x)
      corner = randomVector(random);
    expectNear(vectorArea(x, 4, 3), integralOverPatch(x), 1e-14);
    expectNear(vectorArea(x, 3, 3), 0.5 * cross(x[1] - x[0], x[2] - x[0]), 0);
  }
}

TEST(FaceInSpace, areaOfASegmentPointsAwayFromTheBodyOnItsLeft)
{
  const Vec3 x[2] = {{1, 1, 0}, {3, 1, 0}}; // the body is above
  expectNear(vectorArea(x, 2, 2), {0, -2, 0}, 0);
  EXPECT_EQ(faceSize(2, 2), 2);
  EXPECT_EQ(faceSize(4, 3), 2);
}

TEST(FaceInSpace, cornersLieAtTheNodes)
{
  const NodeVectors x("x", 4);
  for (int n = 0; n < 4; ++n)
    set(x, n, {Real(n), Real(n * n), 0});
  struct
  {
    int count = 3;
    int nodes[4] = {3, 1, 2, -1};
  } face;
  const FaceCorners corners = cornersAt(x, face);
  ASSERT_EQ(corners.count, 3);
  expectNear(corners.x[0], {3, 9, 0}, 0);
  expectNear(corners.center(), {2, 14.0 / 3, 0}, 1e-14);
  expectNear(corners.area(3), vectorArea<3>(corners.x, 3), 0);
}

TEST(FaceInSpace, axesOfAPlaneAreRightHandedAndOfLengthOne)
{
  Random random(2);
  std::vector<Vec3> normals{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int i = 0; i < 1000; ++i)
    normals.push_back(normalised(randomVector(random)));
  for (const Vec3& n : normals)
  {
    const PlaneAxes axes = planeAxes(n, 3);
    expectNear(cross(axes.e1, axes.e2), n, 1e-14);
    EXPECT_NEAR(norm(axes.e1), 1, 1e-14);
    EXPECT_NEAR(norm(axes.e2), 1, 1e-14);
    EXPECT_NEAR(dot(axes.e1, n), 0, 1e-14);
  }
  const Vec3 n{0.6, 0.8, 0};
  expectNear(cross(n, planeAxes(n, 2).e1), {0, 0, 1}, 1e-15);
}

TEST(FaceInSpace, affineWeightsReproduceAnyPointAndHaveTheLeastNorm)
{
  const Vec2 corners[4] = {{0, 0}, {2, 0.1}, {1.5, 1}, {0.2, 1.4}};
  const Vec2 point{0.7, 3};
  Real w[4];
  affineWeights(corners, 4, point, w);
  Real sum = 0;
  Vec2 at;
  for (int i = 0; i < 4; ++i)
  {
    sum += w[i];
    at = at + w[i] * corners[i];
  }
  EXPECT_NEAR(sum, 1, 1e-14);
  EXPECT_NEAR(at.x, point.x, 1e-14);
  EXPECT_NEAR(at.y, point.y, 1e-14);
  // What changes neither the sum nor the point is normal to them: the four minors of (1, x, y).
  Real off = 0;
  for (int i = 0; i < 4; ++i)
  {
    const Vec2 a = corners[(i + 1) % 4], b = corners[(i + 2) % 4], c = corners[(i + 3) % 4];
    off += (i % 2 ? -1 : 1) * cross(b - a, c - a) * w[i];
  }
  EXPECT_NEAR(off, 0, 1e-13);
}

TEST(FaceInSpace, evenWeightsAreMeansOfTheShapeFunctionsAtTheCentroid)
{
  // A third of a triangle, cut at the middles of its sides and its centroid; a trapezium.
  const Vec2 kite[4] = {{0, 0}, {0.5, 0}, {1.0 / 3, 1.0 / 3}, {0, 0.5}};
  Real w[4];
  evenWeights(kite, 4, {7.0 / 36, 7.0 / 36}, w);
  const Real expected[4] = {7.0 / 24, 6.0 / 24, 5.0 / 24, 6.0 / 24};
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(w[i], expected[i], 1e-15);
  affineWeights(kite, 4, {7.0 / 36, 7.0 / 36}, w);
  EXPECT_NEAR(w[2] - expected[2], 3.0 / 216, 1e-15); // 1.4 % of the force
  // Whatever the corners and the point, convex or not, either way round or folded.
  Random random(5);
  std::uniform_real_distribution<Real> number(-1, 1);
  for (int k = 0; k < 2000; ++k)
  {
    Vec2 corners[4];
    for (Vec2& corner : corners)
      corner = {number(random), number(random)};
    const Vec2 point{number(random), number(random)};
    evenWeights(corners, 4, point, w);
    Vec2 at;
    Real sum = 0, most = 0;
    for (int i = 0; i < 4; ++i)
    {
      sum += w[i];
      at = at + w[i] * corners[i];
      most = std::max(most, std::abs(w[i]));
    }
    Real least[4];
    affineWeights(corners, 4, point, least);
    const Real scale = std::max(1.0, most);
    EXPECT_NEAR(sum, 1, 1e-13 * scale);
    EXPECT_NEAR(at.x, point.x, 1e-13 * scale);
    EXPECT_NEAR(at.y, point.y, 1e-13 * scale);
    Real affine = 1;
    for (const Real l : least)
      affine = std::max(affine, std::abs(l));
    EXPECT_LT(most, 4 * affine);
  }
}
} // namespace coplane
