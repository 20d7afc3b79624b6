#include "SampleMeshes.hpp"

#include <coplane_exodus/MeshReport.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace coplane
{
TEST(ElementVolume, aShearedHexahedronKeepsItsVolume)
{
  // Base 2 x 3, height 4, top shifted by (1, 0.5): base area times height = 24.
  std::array<Vec3, 8> c{Vec3{0, 0, 0}, {2, 0, 0},  {2, 3, 0},   {0, 3, 0},
                        {1, .5, 4},    {3, .5, 4}, {3, 3.5, 4}, {1, 3.5, 4}};
  EXPECT_NEAR(elementVolume(ElementType::Hex8, c), 24, 100 * epsilon);
}

TEST(ElementVolume, aTrilinearHexahedronWithOneLiftedCornerIsExact)
{
  // Unit cube with node 7 raised by h: the top is z = 1 + h x y, whose mean is 1 + h/4.
  std::array<Vec3, 8> c{Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0},   {0, 1, 0},
                        {0, 0, 1},     {1, 0, 1}, {1, 1, 1.4}, {0, 1, 1}};
  EXPECT_NEAR(elementVolume(ElementType::Hex8, c), 1.1, 20 * epsilon);
}

TEST(ElementVolume, aClockwiseQuadrilateralIsNegative)
{
  std::array<Vec3, 8> c{Vec3{0, 0, 0}, {0, 2, 0}, {3, 2, 0}, {3, 0, 0}};
  EXPECT_DOUBLE_EQ(elementVolume(ElementType::Quad4, c), -6);
}

TEST(ElementVolume, ofTriangleAndTetrahedron)
{
  // Right-angled, legs 2 and 3: area 3; with height 4 above: 3 * 4 / 3 = 4.
  std::array<Vec3, 8> c{Vec3{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {1, 1, 4}};
  EXPECT_DOUBLE_EQ(elementVolume(ElementType::Tri3, c), 3);
  EXPECT_DOUBLE_EQ(elementVolume(ElementType::Tet4, c), 4);
  std::swap(c[1], c[2]);
  EXPECT_DOUBLE_EQ(elementVolume(ElementType::Tri3, c), -3);
  EXPECT_DOUBLE_EQ(elementVolume(ElementType::Tet4, c), -4);
}

TEST(MeshReport, sizesOfTheSampleAreCounted)
{
  const MeshReport report = reportMesh(sampleMesh2d());
  EXPECT_EQ(report.nodes, 10);
  EXPECT_EQ(report.elements, 3);
  EXPECT_EQ(report.bodies, 2);
  EXPECT_DOUBLE_EQ(report.highest.x, 4);
  EXPECT_DOUBLE_EQ(report.shortestEdge, 1);
  EXPECT_DOUBLE_EQ(report.blocks[0].volume, 2);
  EXPECT_TRUE(report.usable());
  EXPECT_TRUE(meshProblems(report).empty());
}

TEST(MeshReport, anInvertedElementIsNamedWithItsBlock)
{
  Mesh mesh = sampleMesh2d();
  std::swap(mesh.blocks[1].connectivity[1], mesh.blocks[1].connectivity[3]);
  const MeshReport report = reportMesh(mesh);
  EXPECT_FALSE(report.usable());
  EXPECT_EQ(meshProblems(report).at(0),
            "1 elements are inside out or flat (area zero or negative): element 8 of block 'shot' "
            "(-1 m^2). Correct the order of "
            "their nodes, or mesh there again.");
}

TEST(MeshReport, aNodeTwiceInAnElementIsFound)
{
  Mesh mesh = sampleMesh2d();
  mesh.blocks[1].connectivity = {6, 7, 9, 9};
  const MeshReport report = reportMesh(mesh);
  ASSERT_EQ(report.repeatedNodes.size(), 1u);
  EXPECT_EQ(report.repeatedNodes[0].element, 8);
  EXPECT_FALSE(report.usable());
}

TEST(MeshReport, aNodeOfNoElementIsFound)
{
  Mesh mesh = sampleMesh2d();
  mesh.nodeIds.push_back(99);
  mesh.coordinates.push_back({9, 9, 0});
  const MeshReport report = reportMesh(mesh);
  EXPECT_EQ(report.unusedNodes, std::vector<GlobalId>{99});
  EXPECT_TRUE(report.usable());
}

TEST(MeshReport, coincidentNodesAreReportedWithinABodyButNotBetweenBodies)
{
  // The shot moved against the wall: its nodes 11 and 13 lie on 30 and 60.
  Mesh mesh = sampleMesh2d();
  for (int node = 6; node < 10; ++node)
    mesh.coordinates[node].x -= 1;
  EXPECT_TRUE(reportMesh(mesh).coincident.empty());
  mesh.blocks[1].bodyIds = {1};
  EXPECT_EQ(reportMesh(mesh).coincident.size(), 2u);
}

TEST(ElementQuality, idealShapesHaveOne)
{
  const Real h = std::sqrt(0.75);
  // Equilateral triangle; the tip of the regular tetrahedron is sqrt(2/3) above its middle.
  const std::array<Vec3, 8> c{
      Vec3{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0.5, h / 3, std::sqrt(2.0 / 3)}};
  EXPECT_NEAR(elementQuality(ElementType::Tri3, c), 1, 8 * epsilon);
  EXPECT_NEAR(elementQuality(ElementType::Tet4, c), 1, 8 * epsilon);
  const std::array<Vec3, 8> cube{Vec3{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0},
                                 {0, 0, 2},     {2, 0, 2}, {2, 2, 2}, {0, 2, 2}};
  EXPECT_DOUBLE_EQ(elementQuality(ElementType::Quad4, cube), 1);
  EXPECT_DOUBLE_EQ(elementQuality(ElementType::Hex8, cube), 1);
}

TEST(ElementQuality, aShearedSquareHasTheSineOfItsAngle)
{
  const std::array<Vec3, 8> c{
      Vec3{0, 0, 0}, {1, 0, 0}, {1.5, std::sqrt(0.75), 0}, {0.5, std::sqrt(0.75), 0}};
  EXPECT_NEAR(elementQuality(ElementType::Quad4, c), std::sqrt(0.75), 8 * epsilon);
}

TEST(MeshReport, aFoldedQuadrilateralIsNamed)
{
  // Corner 3 drawn in beyond the diagonal: area 1 - 0.4 - 0.4 = 0.2, not convex.
  Mesh mesh = sampleMesh2d();
  mesh.coordinates[9] = {3.1, 0.1, 0};
  const MeshReport report = reportMesh(mesh);
  ASSERT_EQ(report.folded.size(), 1u);
  EXPECT_EQ(report.folded[0].element, 8);
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.blocks[1].worstElement, 8);
  EXPECT_LT(report.blocks[1].worstQuality, 0);
  EXPECT_EQ(report.blocks[0].worstQuality, 1);
  EXPECT_EQ(
      meshProblems(report)[0],
      "1 elements are folded at a corner: element 8 of block 'shot'. Their area is positive, but "
      "they are not convex; mesh there again.");
}

TEST(MeshReport, aJointHasPairsOfFacesAndTellsThoseAlone)
{
  // The shot moved against the wall: its left side lies on the right side of element 9.
  Mesh mesh = sampleMesh2d();
  for (int node = 6; node < 10; ++node)
    mesh.coordinates[node].x -= 1;
  mesh.sideSets = {{1, "joint", {1, 2}, {1, 3}}, {2, "top", {0, 1, 2}, {2, 2, 2}}};
  MeshReport report = reportMesh(mesh);
  ASSERT_EQ(report.joints.size(), 1u);
  EXPECT_EQ(report.joints[0].name, "joint");
  EXPECT_EQ(report.joints[0].pairs, 1);
  EXPECT_TRUE(meshProblems(report).empty());
  // With the lower side of element 7, which touches nothing.
  mesh.sideSets[0] = {1, "joint", {1, 0, 2}, {1, 0, 3}};
  report = reportMesh(mesh);
  EXPECT_EQ(report.joints[0].pairs, 1);
  EXPECT_EQ(
      meshProblems(report),
      (std::vector<std::string>{
          "side set 'joint' is a joint of 1 pairs of faces, but 1 of its faces have no partner "
          "in it: side 1 of element 7. Add the faces that they touch, or take them out."}));
  // Half a side up, the faces meet but do not match: no joint of pairs.
  mesh.sideSets[0] = {1, "joint", {1, 2}, {1, 3}};
  for (int node = 6; node < 10; ++node)
    mesh.coordinates[node].y += 0.5;
  EXPECT_TRUE(reportMesh(mesh).joints.empty());
}
} // namespace coplane
