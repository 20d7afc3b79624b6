#include "Shapes.hpp"

#include "MakeMesh.hpp"

#include <coplane_exodus/MeshReport.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace coplane
{
namespace
{
MeshReport reportOf(const std::string& recipe)
{
  return reportMesh(makeMeshFromText(recipe, "test.yaml"));
}

/// Smallest and largest interior angle of all quadrilaterals [degrees].
std::pair<Real, Real> angles(const Body& body)
{
  Real least = 180, largest = 0;
  for (int e = 0; e < body.elements(); ++e)
    for (int k = 0; k < 4; ++k)
    {
      const auto p = [&](int i) { return body.points[body.connectivity[4 * e + (k + i) % 4]]; };
      const Vec3 a = p(1) - p(0), b = p(3) - p(0);
      const Real angle = std::atan2(a.x * b.y - a.y * b.x, dot(a, b)) * 180 / pi;
      least = std::min(least, angle);
      largest = std::max(largest, angle);
    }
  return {least, largest};
}

/// Area of a regular polygon of n corners in a circle.
Real polygonArea(int n, Real radius)
{
  return 0.5 * n * radius * radius * std::sin(2 * pi / n);
}
} // namespace

TEST(Shapes, aBoxHasItsVolumeAndDivisions)
{
  const MeshReport report = reportOf(
      "{dimension: 3, parts: [{shape: box, block: b, min: [1, 2, 3], size: [2, 3, 4], divisions: "
      "[2, 3, 5]}]}");
  EXPECT_EQ(report.elements, 30);
  EXPECT_EQ(report.nodes, 3 * 4 * 6);
  EXPECT_NEAR(report.blocks[0].volume, 24, 1e-12);
  EXPECT_DOUBLE_EQ(report.lowest.y, 2);
  EXPECT_DOUBLE_EQ(report.highest.z, 7);
  EXPECT_TRUE(meshProblems(report).empty());
}

TEST(Shapes, aBoxTurnedAboutItsMiddleKeepsVolumeAndMiddle)
{
  const MeshReport report = reportOf(
      "{dimension: 3, parts: [{shape: box, block: b, min: [-1, -1, -1], max: [1, 1, 1], divisions: "
      "[2, 2, 2], rotate: [10, 20, 30], offset: [5, 0, 0]}]}");
  EXPECT_NEAR(report.blocks[0].volume, 8, 1e-12);
  EXPECT_NEAR(report.lowest.x + report.highest.x, 10, 1e-12);
  EXPECT_TRUE(report.usable());
}

TEST(Shapes, aQuarterTurnTakesXToY)
{
  const MeshReport report = reportOf("{dimension: 2, parts: [{shape: box, block: b, size: [3, 1], "
                                     "divisions: [3, 1], rotate: 90, about: [0, 0]}]}");
  EXPECT_EQ(report.lowest.x, -1);
  EXPECT_EQ(report.highest.x, 0);
  EXPECT_EQ(report.highest.y, 3);
}

TEST(Shapes, aRunningBondHasHalfBricksInOddCourses)
{
  // 3 courses of 4 bricks: 4 + 5 + 4 bodies; 3 x 4 whole bricks of 4 x 2 x 1 elements in volume.
  const std::string recipe = "{dimension: 3, parts: [{shape: wall, block: b, brick: [0.4, 0.2, "
                             "0.3], courses: 3, length_in_bricks: "
                             "4, divisions: [4, 2, 1]}]}";
  const MeshReport report = reportOf(recipe);
  EXPECT_EQ(report.bodies, 13);
  EXPECT_EQ(report.elements, 12 * 8);
  EXPECT_NEAR(report.blocks[0].volume, 1.6 * 0.6 * 0.3, 1e-13);
  const Mesh mesh = makeMeshFromText(recipe, "test.yaml");
  const std::set<int> ids(mesh.blocks[0].bodyIds.begin(), mesh.blocks[0].bodyIds.end());
  EXPECT_EQ(ids.size(), 13u);
  EXPECT_EQ(*ids.begin(), 1);
  EXPECT_EQ(*ids.rbegin(), 13);
}

TEST(Shapes, touchingBricksHaveTheSameCoordinatesToTheBit)
{
  std::set<Real> x, y;
  for (const Body& brick : runningBond(2, {0.3, 0.1, 0}, 7, 5, {4, 3, 1}))
    for (const Vec3& p : brick.points)
    {
      x.insert(p.x);
      y.insert(p.y);
    }
  // 5 bricks of 4 elements, 7 courses of 3: a coordinate that differed by a rounding would count
  // twice.
  EXPECT_EQ(x.size(), 21u);
  EXPECT_EQ(y.size(), 22u);
}

TEST(Shapes, anImbricateWallHasABrickOnTheAxisInItsFirstLayer)
{
  // 4 layers of 12 brick lengths: 11 whole + 2 half, 12, 13, 12 bodies; 4 * 12 * 100 elements.
  const auto bricks = imbricate(0.0125, 0.05, 4, 12, {5, 20, 1});
  EXPECT_EQ(bricks.size(), 50u);
  int elements = 0;
  for (const Body& brick : bricks)
    elements += brick.elements();
  EXPECT_EQ(elements, 4800);
  // Body 6 of the first layer: y = -0.025 to 0.025. In the second layer a joint lies at y = 0.
  EXPECT_EQ(bricks[6].points.front().y, -0.025);
  EXPECT_EQ(bricks[6].points.back().y, 0.025);
  EXPECT_EQ(bricks[13 + 6].points.front().y, 0.0);
  // Flush ends.
  EXPECT_EQ(bricks[0].points.front().y, -0.3);
  EXPECT_EQ(bricks[13].points.front().y, -0.3);
}

TEST(Shapes, jointedRockFillsItsVolume)
{
  const MeshReport report = reportOf(
      "{dimension: 3, parts: [{shape: rock, block: r, blocks: [2, 3, 4], size: [1, 2, 0.5], "
      "divisions: [2, 2, 1]}]}");
  EXPECT_EQ(report.bodies, 24);
  EXPECT_NEAR(report.blocks[0].volume, 24, 1e-11);
  EXPECT_TRUE(report.usable());
}

TEST(Shapes, aDiskFillsThePolygonOnItsCircleWithGoodQuadrilaterals)
{
  // across = 12: 8 elements on a side of the middle square, 4 sides: a polygon of 32 corners.
  const MeshReport report =
      reportOf("{dimension: 2, parts: [{shape: cylinder, block: c, radius: 0.05, across: 12}]}");
  EXPECT_NEAR(report.blocks[0].volume, polygonArea(32, 0.05), 1e-15);
  EXPECT_TRUE(meshProblems(report).empty());
  const auto [least, largest] = angles(disk(0.05, 12));
  EXPECT_GT(least, 45);
  EXPECT_LT(largest, 130);
}

TEST(Shapes, everyFinenessOfADiskIsValid)
{
  for (int across = 4; across <= 40; across += 2)
  {
    const auto [least, largest] = angles(disk(1, across));
    EXPECT_GT(least, 45) << across;
    EXPECT_LT(largest, 135) << across;
  }
}

TEST(Shapes, aCylinderIsTheDiskTimesItsLength)
{
  const MeshReport report = reportOf("{dimension: 3, parts: [{shape: cylinder, block: c, radius: "
                                     "0.5, across: 12, length: 3, along: 4}]}");
  EXPECT_NEAR(report.blocks[0].volume, 3 * polygonArea(32, 0.5), 1e-12);
  EXPECT_TRUE(report.usable());
}

TEST(Shapes, aRoundNosedProjectileIsRectangleAndHalfPolygon)
{
  // Width 2, length 5: rectangle 2 x 4 and half a polygon of 32 corners; tip at the origin.
  const MeshReport report = reportOf(
      "{dimension: 2, parts: [{shape: projectile, block: p, width: 2, length: 5, across: 12}]}");
  EXPECT_NEAR(report.blocks[0].volume, 8 + 0.5 * polygonArea(32, 1), 1e-12);
  EXPECT_NEAR(report.highest.x, 0, 1e-15);
  EXPECT_DOUBLE_EQ(report.lowest.x, -5);
  EXPECT_EQ(report.bodies, 1);
  EXPECT_TRUE(meshProblems(report).empty());
  const auto [least, largest] = angles(roundNosed(2, 5, 12, 24));
  EXPECT_GT(least, 45);
  EXPECT_LT(largest, 130);
}

TEST(Shapes, aRoundBarApproachesCylinderAndHalfBall)
{
  // Radius 1, straight part 4: 4 pi + 2 pi / 3. Chords cut off about (2 pi / 3) / n^2 of a circle
  // of n corners: with 4 x 16 corners below 0.5 %.
  const MeshReport report = reportOf(
      "{dimension: 3, parts: [{shape: projectile, block: p, width: 2, length: 5, across: 16}]}");
  EXPECT_NEAR(report.blocks[0].volume / (4 * pi + 2 * pi / 3), 1, 0.005);
  EXPECT_LT(report.blocks[0].volume, 4 * pi + 2 * pi / 3);
  EXPECT_NEAR(report.highest.x, 0, 1e-15);
  EXPECT_TRUE(meshProblems(report).empty());
}

TEST(Shapes, aSquareBarHasAHalfCylinderAsNose)
{
  const MeshReport report = reportOf("{dimension: 3, parts: [{shape: projectile, block: p, width: "
                                     "2, length: 5, across: 12, section: square}]}");
  EXPECT_NEAR(report.blocks[0].volume, 2 * (8 + 0.5 * polygonArea(32, 1)), 1e-11);
  EXPECT_DOUBLE_EQ(report.lowest.z, -1);
  EXPECT_DOUBLE_EQ(report.highest.z, 1);
  EXPECT_TRUE(meshProblems(report).empty());
}
} // namespace coplane
