#include "Shapes.hpp"

#include "MakeMesh.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_exodus/MeshReport.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
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
  for (const Body& brick : wallOfBricks(2, Bond::Running, {0.3, 0.1, 0}, 7, 5, {4, 3, 1}))
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

TEST(Shapes, aBallApproachesItsVolumeWithGoodElements)
{
  // Chords cut off a part of the volume that shrinks with the square of the elements.
  Real lost[2];
  for (int fine = 0; fine < 2; ++fine)
  {
    const std::string part = fmt::format("{{dimension: 3, parts: [{{shape: sphere, block: b, "
                                         "radius: 0.5, across: {}",
                                         fine ? 24 : 12);
    const MeshReport report = reportOf(part + "}]}");
    EXPECT_EQ(report.elements, fine ? 12 * 12 * 12 + 6 * 6 * 144 : 6 * 6 * 6 + 6 * 3 * 36);
    EXPECT_EQ(report.bodies, 1);
    EXPECT_TRUE(meshProblems(report).empty());
    EXPECT_GT(report.blocks[0].worstQuality, 0.6);
    EXPECT_NEAR(report.highest.x, 0.5, 1e-15);
    EXPECT_NEAR(report.lowest.z, -0.5, 1e-15);
    lost[fine] = 1 - report.blocks[0].volume / (4 * pi / 3 * 0.125);
    const MeshReport split = reportOf(part + ", split: tetrahedra}]}");
    EXPECT_EQ(split.elements, 5 * report.elements);
    EXPECT_TRUE(split.usable());
  }
  EXPECT_LT(lost[0], 0.03);
  EXPECT_NEAR(lost[0] / lost[1], 4, 0.3);
}

TEST(Shapes, everyFinenessOfABallIsValid)
{
  for (int across = 4; across <= 20; across += 2)
  {
    const MeshReport report =
        reportOf(fmt::format("{{dimension: 3, parts: [{{shape: sphere, block: b, radius: 1, "
                             "across: {}}}]}}",
                             across));
    EXPECT_TRUE(meshProblems(report).empty()) << across;
    EXPECT_GT(report.blocks[0].worstQuality, 0.5) << across;
  }
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

TEST(Shapes, aBiasIsTheRatioOfTheLastElementToTheFirst)
{
  // Three elements 1 : 2 : 4 on a length of 7.
  const std::vector<Real> line = gradedLine(1, 8, 3, 4);
  ASSERT_EQ(line.size(), 4u);
  EXPECT_EQ(line[0], 1);
  EXPECT_NEAR(line[1], 2, 1e-14);
  EXPECT_NEAR(line[2], 4, 1e-14);
  EXPECT_EQ(line[3], 8);
}

TEST(Shapes, aBoxOfLinesHasItsNodesOnThem)
{
  const Mesh mesh = makeMeshFromText(
      "{dimension: 2, parts: [{shape: box, block: b, lines: {x: [0, 0.1, 1], y: {ends: [-1, 0, 7], "
      "divisions: [2, 3], bias: [1, 4]}}}]}",
      "test.yaml");
  std::set<Real> x, y;
  for (const Vec3& p : mesh.coordinates)
  {
    x.insert(p.x);
    y.insert(p.y);
  }
  EXPECT_EQ(x, (std::set<Real>{0, 0.1, 1}));
  ASSERT_EQ(y.size(), 6u);
  const Real wanted[] = {-1, -0.5, 0, 1, 3, 7};
  int k = 0;
  for (const Real value : y)
    EXPECT_NEAR(value, wanted[k++], 1e-14);
  EXPECT_EQ(mesh.elements(), 10);
  EXPECT_TRUE(meshProblems(mesh).empty());
}

TEST(Shapes, aQuadrilateralFillsItsCorners)
{
  // A kite of diagonals 2 and 3: area 3. Bilinear elements fill a quadrilateral exactly.
  const MeshReport report = reportOf(
      "{dimension: 2, parts: [{shape: quadrilateral, block: w, corners: [[0, 0], [1, 2], [0, 3], "
      "[-1, 2]], divisions: [3, 5]}]}");
  EXPECT_EQ(report.elements, 15);
  EXPECT_NEAR(report.blocks[0].volume, 3, 1e-14);
  EXPECT_EQ(report.lowest.y, 0);
  EXPECT_EQ(report.highest.y, 3);
  EXPECT_TRUE(meshProblems(report).empty());
}

TEST(Shapes, aHexahedronFillsItsCorners)
{
  // A frustum: base 2 x 2, top 1 x 1, height 3: 3 (4 + 2 + 1) / 3 = 7.
  const MeshReport report = reportOf(
      "{dimension: 3, parts: [{shape: hexahedron, block: w, corners: [[-1, -1, 0], [1, -1, 0], [1, "
      "1, 0], [-1, 1, 0], [-0.5, -0.5, 3], [0.5, -0.5, 3], [0.5, 0.5, 3], [-0.5, 0.5, 3]], "
      "divisions: [3, 4, 5]}]}");
  EXPECT_EQ(report.elements, 60);
  EXPECT_NEAR(report.blocks[0].volume, 7, 1e-13);
  EXPECT_TRUE(meshProblems(report).empty());
}

TEST(Shapes, aSectorMayGrowOutward)
{
  // Radial lengths 1, 2 and 4 from 1 to 8: the outermost is four times the innermost.
  const Body body = sectors(2, 1, 8, 0, 90, 1, 0, {3, 1, 1}, 4).front();
  std::set<Real> radii;
  for (const Vec3& x : body.points)
    if (x.y == 0)
      radii.insert(x.x);
  ASSERT_EQ(radii.size(), 4u);
  const Real expected[] = {1, 2, 4, 8};
  int i = 0;
  for (const Real r : radii)
    EXPECT_NEAR(r, expected[i++], 1e-14);
}

TEST(Shapes, voussoirsFillTheirPolygonAndTouchToTheBit)
{
  // 9 stones of 4 elements around over 180 degrees: chords of 5 degrees.
  const MeshReport report = reportOf("{dimension: 2, parts: [{shape: sector, block: a, "
                                     "inner_radius: 9, outer_radius: 11, from: 0, "
                                     "to: 180, count: 9, divisions: [2, 4]}]}");
  EXPECT_EQ(report.bodies, 9);
  EXPECT_EQ(report.elements, 72);
  EXPECT_NEAR(report.blocks[0].volume, 0.5 * (polygonArea(72, 11) - polygonArea(72, 9)), 1e-12);
  EXPECT_TRUE(meshProblems(report).empty());
  std::set<std::pair<Real, Real>> places;
  for (const Body& stone : sectors(2, 9, 11, 0, 180, 9, 0, {2, 4, 1}))
    for (const Vec3& p : stone.points)
      places.insert({p.x, p.y});
  EXPECT_EQ(places.size(), 37u * 3u);
}

TEST(Shapes, aSweptSectorIsItsAreaTimesItsLength)
{
  const MeshReport report = reportOf(
      "{dimension: 3, parts: [{shape: sector, block: a, inner_radius: 9, outer_radius: 11, from: "
      "30, to: 60, divisions: [2, 6, 3], length: 2}]}");
  EXPECT_NEAR(report.blocks[0].volume, 2 * (polygonArea(72, 11) - polygonArea(72, 9)) / 12, 1e-12);
  EXPECT_TRUE(meshProblems(report).empty());
}

TEST(Shapes, halfADiscForHertzContactIsFineAtItsLowestPoint)
{
  const Real radius = 0.05, fine = 5.4e-4 / 8, fineRadius = 1.1e-3;
  const Body half = halfDisc(radius, fine, fineRadius);
  const auto [least, largest] = angles(half);
  EXPECT_GT(least, 45);
  EXPECT_LT(largest, 135);
  // Nodes of the round border, by x: on the circle, symmetric, and about `fine` apart in the
  // middle.
  std::vector<Vec3> border;
  for (const Vec3& p : half.points)
    if (std::abs(std::hypot(p.x, p.y - radius) - radius) < 1e-12)
      border.push_back(p);
  std::sort(border.begin(), border.end(), [](const Vec3& a, const Vec3& b) { return a.x < b.x; });
  EXPECT_NEAR(border.front().x, -radius, 1e-15);
  EXPECT_NEAR(border.back().x, radius, 1e-15);
  const std::size_t middle = border.size() / 2;
  EXPECT_NEAR(border[middle].x, 0, 1e-18);
  EXPECT_NEAR(border[middle].y, 0, 1e-18);
  for (std::size_t i = 0; i < border.size(); ++i)
    EXPECT_EQ(border[i].x, -border[border.size() - 1 - i].x);
  for (int i = -8; i < 8; ++i)
    EXPECT_NEAR(norm(border[middle + i + 1] - border[middle + i]), fine, 0.1 * fine) << i;
  // Its area is that of the polygon on the border.
  Real polygon = 0, area = 0;
  for (std::size_t i = 0; i + 1 < border.size(); ++i)
    polygon += 0.5 * (border[i + 1].x - border[i].x) * (2 * radius - border[i].y - border[i + 1].y);
  for (int e = 0; e < half.elements(); ++e)
  {
    const auto p = [&](int k) { return half.points[half.connectivity[4 * e + k]]; };
    area += 0.5 * cross(p(2) - p(0), p(3) - p(1)).z;
  }
  EXPECT_NEAR(area / polygon, 1, 1e-12);
  EXPECT_NEAR(area / (pi * radius * radius / 2), 1, 2e-3);
  EXPECT_LT(half.elements(), 5000);
}

TEST(Shapes, everyHalfDiscIsValid)
{
  for (const Real fineRadius : {0.002, 0.02, 0.1, 0.25})
    for (const Real fine : {1.0, 0.5, 0.2, 0.06})
    {
      const auto [least, largest] = angles(halfDisc(1, fine * fineRadius, fineRadius));
      EXPECT_GT(least, 45) << fineRadius << ' ' << fine;
      EXPECT_LT(largest, 140) << fineRadius << ' ' << fine;
    }
}

TEST(Shapes, aSweptHalfDiscIsItsAreaTimesItsLength)
{
  const std::string plane = "shape: half_disc, block: c, radius: 1, fine: 0.05, fine_radius: 0.2";
  const MeshReport two = reportOf("{dimension: 2, parts: [{" + plane + "}]}");
  const MeshReport three =
      reportOf("{dimension: 3, parts: [{" + plane + ", length: 2, along: 3}]}");
  EXPECT_NEAR(three.blocks[0].volume, 2 * two.blocks[0].volume, 1e-13);
  EXPECT_TRUE(meshProblems(three).empty());
}

TEST(Shapes, trianglesHaveAlternatingDiagonals)
{
  // Four quadrilaterals: the diagonals meet in the middle node, or form a diamond around it.
  //   +--+--+
  //   |\ | /|
  //   +--+--+
  //   |/ | \|
  //   +--+--+
  const Body split = inSimplices(box(2, {0, 0, 0}, {2, 2, 0}, {2, 2, 1}));
  ASSERT_EQ(split.elements(), 8);
  std::vector<int> trianglesOf(9, 0);
  for (const int node : split.connectivity)
    ++trianglesOf[node];
  EXPECT_EQ(trianglesOf, (std::vector<int>{2, 2, 2, 2, 8, 2, 2, 2, 2}));
}

TEST(Shapes, everyShapeInTrianglesFillsTheSameArea)
{
  for (const std::string shape :
       {"shape: box, size: [3, 2], divisions: [3, 5]",
        "shape: wall, brick: [0.4, 0.2], courses: 3, length_in_bricks: 2, divisions: [4, 3]",
        "shape: cylinder, radius: 1, across: 10",
        "shape: projectile, width: 1, length: 3, across: 8",
        "shape: sector, inner_radius: 1, outer_radius: 2, from: 0, to: 90, count: 2, divisions: "
        "[3, 5]",
        "shape: half_disc, radius: 1, fine: 0.03, fine_radius: 0.1"})
  {
    const std::string part = "{dimension: 2, parts: [{block: b, " + shape;
    const MeshReport whole = reportOf(part + "}]}"),
                     split = reportOf(part + ", split: triangles}]}");
    EXPECT_EQ(split.elements, 2 * whole.elements) << shape;
    EXPECT_EQ(split.nodes, whole.nodes) << shape;
    EXPECT_EQ(split.bodies, whole.bodies) << shape;
    EXPECT_EQ(split.blocks[0].type, "TRI3");
    EXPECT_NEAR(split.blocks[0].volume / whole.blocks[0].volume, 1, 1e-13) << shape;
    EXPECT_TRUE(meshProblems(split).empty()) << shape;
  }
}

TEST(Shapes, tetrahedraOfABodyAreConforming)
{
  // 3 x 4 x 5 hexahedra: every face inside belongs to two tetrahedra; those outside are two for
  // every outer face: 2 * 2 (12 + 15 + 20).
  const Body split = inSimplices(box(3, {0, 0, 0}, {3, 4, 5}, {3, 4, 5}));
  EXPECT_EQ(split.elements(), 5 * 60);
  std::map<std::array<int, 3>, int> elementsOf;
  const ElementTopology& shape = topology(split.type);
  Real volume = 0;
  for (int e = 0; e < split.elements(); ++e)
  {
    std::array<Vec3, 8> corners{};
    for (int k = 0; k < 4; ++k)
      corners[k] = split.points[split.connectivity[4 * e + k]];
    const Real own = elementVolume(split.type, corners);
    EXPECT_GT(own, 0.16); // a sixth or a third
    volume += own;
    for (int side = 0; side < 4; ++side)
    {
      std::array<int, 3> face;
      for (int k = 0; k < 3; ++k)
        face[k] = split.connectivity[4 * e + shape.sideNodes[side][k]];
      std::sort(face.begin(), face.end());
      ++elementsOf[face];
    }
  }
  EXPECT_NEAR(volume, 60, 1e-12);
  int outside = 0;
  for (const auto& [face, elements] : elementsOf)
  {
    EXPECT_LE(elements, 2);
    outside += elements == 1;
  }
  EXPECT_EQ(outside, 2 * 2 * (12 + 15 + 20));
}

TEST(Shapes, aCylinderInTetrahedraFillsTheSameVolume)
{
  const std::string part = "{dimension: 3, parts: [{shape: cylinder, block: c, radius: 0.5, "
                           "across: 12, length: 3, along: 4";
  const MeshReport whole = reportOf(part + "}]}"),
                   split = reportOf(part + ", split: tetrahedra}]}");
  EXPECT_EQ(split.elements, 5 * whole.elements);
  EXPECT_EQ(split.blocks[0].type, "TETRA4");
  EXPECT_NEAR(split.blocks[0].volume / whole.blocks[0].volume, 1, 1e-13);
  // Five tetrahedra of a brick near the rim are flat: that, and nothing else, is noted.
  for (const std::string& problem : meshProblems(split))
    EXPECT_NE(problem.find("has the shape"), std::string::npos) << problem;
}

/// Ends of bricks along x, by course, without those of the wall.
static std::map<Real, std::set<Real>> jointsOfCourses(const std::vector<Body>& wall, Real length)
{
  std::map<Real, std::set<Real>> joints;
  for (const Body& brick : wall)
    for (const Vec3& end : {brick.points.front(), brick.points.back()})
      if (end.x > 0 && end.x < length)
        joints[brick.points.front().y].insert(end.x);
  return joints;
}

TEST(Walls, haveNoJointAboveAnotherInBonds)
{
  const Vec3 brick{0.2, 0.05, 0.1};
  for (const auto& [bond, bricks] :
       {std::pair{Bond::Running, 5}, {Bond::English, 2}, {Bond::English, 5}, {Bond::Flemish, 7}})
  {
    const auto wall = wallOfBricks(3, bond, brick, 6, bricks, {8, 2, 3});
    const auto joints = jointsOfCourses(wall, 0.2 * bricks);
    ASSERT_EQ(joints.size(), 6u);
    for (auto course = joints.begin(); std::next(course) != joints.end(); ++course)
      for (const Real x : course->second)
        EXPECT_EQ(std::next(course)->second.count(x), 0u) << int(bond) << " at " << x;
    Real volume = 0;
    for (const Body& body : wall)
    {
      const Vec3 size = body.points.back() - body.points.front();
      volume += size.x * size.y * size.z;
    }
    EXPECT_NEAR(volume, 6 * 0.05 * 0.2 * bricks * (bond == Bond::Running ? 0.1 : 0.2), 1e-12);
    // Coordinates that differed by a rounding would count twice.
    std::set<Real> x, z;
    for (const Body& body : wall)
      for (const Vec3& p : body.points)
      {
        x.insert(p.x);
        z.insert(p.z);
      }
    EXPECT_EQ(x.size(), std::size_t(8 * bricks + 1));
    EXPECT_EQ(z.size(), bond == Bond::Running ? 4u : 7u);
  }
}

TEST(Walls, ofBondsHaveTheBricksOfTheBond)
{
  // 5 bricks long: 10 stretchers; 2 headers, 2 closers, 7 headers between.
  EXPECT_EQ(wallOfBricks(3, Bond::English, {0.2, 0.05, 0.1}, 2, 5, {4, 1, 1}).size(), 10u + 11u);
  // 4 bricks: 3 pairs of stretchers and 2 headers; 2 headers, 2 closers, 2 pairs, a header.
  EXPECT_EQ(wallOfBricks(3, Bond::Flemish, {0.2, 0.05, 0.1}, 2, 4, {4, 1, 1}).size(), 8u + 9u);
  EXPECT_EQ(wallOfBricks(2, Bond::Stack, {0.2, 0.05, 0}, 3, 4, {4, 1, 1}).size(), 12u);
}

TEST(Walls, haveOpenings)
{
  const MeshReport report = reportOf(
      "{dimension: 2, parts: [{shape: wall, block: w, brick: [0.2, 0.1], courses: 10, "
      "length_in_bricks: 10, divisions: [4, 2], openings: [{x: [0.55, 1.23], courses: [3, 6]}, {x: "
      "[1.5, 2.5], courses: [9, 10]}]}]}");
  EXPECT_NEAR(report.blocks[0].volume, 2 - 0.68 * 0.4 - 0.5 * 0.2, 1e-13);
  EXPECT_TRUE(meshProblems(report).empty());
}

TEST(Walls, areRefusedInClearWords)
{
  const auto refusal = [](const std::string& keys, int dimension = 3)
  {
    try
    {
      makeMeshFromText(fmt::format("{{dimension: {}, parts: [{{shape: wall, block: w, courses: 4, "
                                   "{}}}]}}",
                                   dimension, keys),
                       "test.yaml");
    }
    catch (const Error& error)
    {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto contains = [](const std::string& text, const std::string& part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  const std::string brick = "brick: [0.2, 0.05, 0.1], divisions: [4, 1, 1], ";
  contains(refusal(brick + "length_in_bricks: 5, bond: flemish"), "4, 7, 10");
  contains(refusal(brick + "length_in_bricks: 1, bond: english"), "2 or more");
  contains(refusal("brick: [0.2, 0.05, 0.09], divisions: [4, 1, 1], length_in_bricks: 5, bond: "
                   "english"),
           "half the length");
  contains(refusal("brick: [0.2, 0.05, 0.1], divisions: [6, 1, 1], length_in_bricks: 5, bond: "
                   "english"),
           "multiple of 4");
  contains(refusal("brick: [0.2, 0.05], divisions: [4, 1], length_in_bricks: 5, bond: english", 2),
           "three dimensions");
  contains(refusal(brick + "length_in_bricks: 5, openings: {x: [0.2, 0.4], courses: [2, 7]}"),
           "the wall has 4");
}

TEST(Vaults, fillTheRingOfTheirSectors)
{
  const auto stones = barrelVault(2, 2.4, 0, 180, 7, 3, 4, {2, 3, 4});
  // 4 and 5 stones in turn.
  EXPECT_EQ(stones.size(), std::size_t(4 * 4 + 3 * 5));
  std::set<Real> z;
  std::set<std::array<Real, 3>> places;
  for (const Body& stone : stones)
    for (const Vec3& p : stone.points)
    {
      z.insert(p.z);
      places.insert({p.x, p.y, p.z});
    }
  EXPECT_EQ(z.size(), 17u);
  // Nodes of the whole grid: what touches has the same coordinates.
  EXPECT_EQ(places.size(), std::size_t(3 * 22 * 17));
}

TEST(CrossVaults, fillTheirBarrelsAndMeetInGroins)
{
  // Of an arm: (half - r |cos|) r over the ring.
  const Real f = 20 * pi / 180, ring = (pi - 2 * f) * (2.3 * 2.3 - 4) / 2;
  const Real whole = 4 * (2.25 * ring - 2 * (1 - std::sin(f)) * (2.3 * 2.3 * 2.3 - 8) / 3);
  Real before = 1;
  for (const int n : {2, 4, 8})
  {
    const MeshReport report = reportOf(fmt::format(
        "{{dimension: 3, parts: [{{shape: cross_vault, block: v, inner_radius: 2, outer_radius: "
        "2.3, from: 20, count: 9, length: 4.5, rows: 3, divisions: [{}, {}, {}]}}]}}",
        n / 2, n, n));
    EXPECT_TRUE(meshProblems(report).empty());
    const Real error = std::abs(1 - report.blocks[0].volume / whole);
    EXPECT_LT(error, 0.3 * before); // of second order
    before = error;
  }
  EXPECT_LT(before, 1e-3);
}

TEST(CrossVaults, haveTheSameNodesOnBothSidesOfAGroin)
{
  std::map<std::array<Real, 3>, std::set<int>> armsAt; // of places above the diagonals
  const auto stones = crossVault(2, 2.3, 20, 9, 4.5, 3, {1, 4, 2});
  ASSERT_EQ(stones.size() % 4, 0u);
  for (std::size_t s = 0; s < stones.size(); ++s)
    for (const Vec3& p : stones[s].points)
      if (std::abs(p.x) == std::abs(p.z))
        armsAt[{p.x, p.y, p.z}].insert(int(4 * s / stones.size()));
  // Two radii; 37 places over each of two groins, which have the crown in common.
  EXPECT_EQ(armsAt.size(), std::size_t(2 * (2 * 37 - 1)));
  for (const auto& [place, arms] : armsAt)
    EXPECT_EQ(arms.size(), place[0] == 0 ? 4u : 2u);
}

TEST(CrossVaults, haveNoJointAboveAnother)
{
  const auto stones = crossVault(2, 2.3, 20, 9, 4.5, 3, {1, 2, 2});
  std::map<int, std::set<Real>> ends; // along the barrel of the first arm, by course
  for (std::size_t s = 0; s < stones.size() / 4; ++s)
  {
    const Vec3 middle = 0.25 * (stones[s].points[0] + stones[s].points[1] + stones[s].points[4] +
                                stones[s].points[5]);
    const int course = int((70 - std::atan2(middle.x, middle.y) * 180 / pi) / (140. / 9));
    ends[course].insert(stones[s].points.back().z);
  }
  ASSERT_EQ(ends.size(), 9u);
  for (int course = 0; course + 1 < 9; ++course)
    for (const Real z : ends[course])
      EXPECT_EQ(ends[course + 1].count(z), z == 2.25 ? 1u : 0u) << course << " " << z;
  EXPECT_EQ(ends[4].size(), 3u) << "the crown has all rows";
}

TEST(CrossVaults, areRefusedInClearWords)
{
  const auto refusal = [](const std::string& keys) -> std::string
  {
    try
    {
      reportOf("{dimension: 3, parts: [{shape: cross_vault, block: v, inner_radius: 2, "
               "outer_radius: 2.3, rows: 3, " +
               keys + "}]}");
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal("from: 20, count: 9, length: 4.5, divisions: [1, 2, 2]"), "accepted");
  const auto contains = [](const std::string& text, const std::string& part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  contains(refusal("from: 0, count: 9, length: 4.5, divisions: [1, 2, 2]"),
           "4.6 m, where the groins");
  contains(refusal("from: 20, count: 8, length: 4.5, divisions: [1, 2, 2]"), "odd count");
  contains(refusal("from: 20, count: 9, length: 4.5, divisions: [1, 3, 2]"), "must be even");
}

TEST(Domes, fillTheirShell)
{
  Real before = 1;
  for (const int n : {2, 4, 8})
  {
    const MeshReport report = reportOf(fmt::format(
        "{{dimension: 3, parts: [{{shape: dome, block: d, inner_radius: 4, outer_radius: 4.4, "
        "from: 0, to: 75, courses: 5, count: 12, divisions: [1, {}, {}]}}]}}",
        n, n));
    EXPECT_EQ(report.bodies, 60);
    EXPECT_TRUE(meshProblems(report).empty());
    const Real shell = 2 * pi * std::sin(75 * pi / 180) * (std::pow(4.4, 3) - 64) / 3;
    const Real error = 1 - report.blocks[0].volume / shell;
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 0.3 * before); // of second order
    before = error;
  }
  EXPECT_LT(before, 2e-3);
  std::set<std::array<Real, 3>> places;
  for (const Body& stone : dome(4, 4.4, 0, 75, 5, 12, {1, 2, 4}))
    for (const Vec3& p : stone.points)
      places.insert({p.x, p.y, p.z});
  EXPECT_EQ(places.size(), std::size_t(2 * 11 * 48));
}
} // namespace coplane
