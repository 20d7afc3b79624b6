#include "SampleMeshes.hpp"

#include <coplane_exodus/MeshReport.hpp>
#include <coplane_mesh/Distribute.hpp>

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
            "their nodes, or remesh that region.");
}

TEST(MeshReport, aNodeTwiceInAnElementIsFound)
{
  Mesh mesh = sampleMesh2d();
  mesh.blocks[1].connectivity = {6, 7, 9, 9};
  const MeshReport report = reportMesh(mesh);
  ASSERT_EQ(report.repeatedNodes.count, 1);
  EXPECT_EQ(report.repeatedNodes.first[0].element, 8);
  EXPECT_FALSE(report.usable());
}

TEST(MeshReport, aNodeOfNoElementIsFound)
{
  Mesh mesh = sampleMesh2d();
  mesh.nodeIds.push_back(99);
  mesh.coordinates.push_back({9, 9, 0});
  const MeshReport report = reportMesh(mesh);
  EXPECT_EQ(report.unusedNodes.first, std::vector<GlobalId>{99});
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
  EXPECT_EQ(reportMesh(mesh).coincident.count, 2);
}

TEST(MeshReport, elementsOnOneAnotherAreReported)
{
  // The shot exactly on the left element of the wall, with nodes of its own and in another order.
  Mesh mesh = sampleMesh2d();
  for (int node = 6; node < 10; ++node)
    mesh.coordinates[node].x -= 3;
  mesh.blocks[1].connectivity = {7, 9, 8, 6};
  const MeshReport report = reportMesh(mesh);
  ASSERT_EQ(report.twice.count, 1);
  EXPECT_EQ(report.twice.first[0].first, 7);
  EXPECT_EQ(report.twice.first[0].second, 8);
  EXPECT_DOUBLE_EQ(report.twice.first[0].place.x, 0.5);
  EXPECT_TRUE(report.usable());
  EXPECT_NE(meshProblems(report).at(0).find("elements 7 and 8 at (0.5, 0.5, 0)"),
            std::string::npos);
  // The same element written twice, on the same nodes.
  mesh = sampleMesh2d();
  mesh.blocks[1].connectivity = {0, 1, 4, 3};
  EXPECT_EQ(reportMesh(mesh).twice.count, 1);
}

TEST(MeshReport, edgesAndFacesOfThreeElementsAreReported)
{
  Mesh mesh = sampleMesh2d();
  EXPECT_TRUE(reportMesh(mesh).overused.empty());
  mesh.blocks[1].connectivity = {1, 7, 9, 4}; // on the edge between the elements of the wall
  const MeshReport report = reportMesh(mesh);
  ASSERT_EQ(report.overused.count, 1);
  EXPECT_EQ(report.overused.first[0].count, 3);
  EXPECT_DOUBLE_EQ(report.overused.first[0].place.x, 1);

  Mesh cubes = sampleMesh3d();
  EXPECT_TRUE(reportMesh(cubes).overused.empty());
  const int first = int(cubes.coordinates.size());
  for (const Vec3& x : {Vec3{2, 0, -1}, Vec3{2, 1, -1}, Vec3{2, 0, 2}, Vec3{2, 1, 2}})
  {
    cubes.nodeIds.push_back(900 + GlobalId(cubes.nodeIds.size()));
    cubes.coordinates.push_back(x + Vec3{0.5, 0, 0});
  }
  auto& row = cubes.blocks[0];
  row.elementIds.push_back(40);
  row.bodyIds.push_back(1);
  for (const int n : {1, first, first + 1, 5, 9, first + 2, first + 3, 13})
    row.connectivity.push_back(n);
  ASSERT_EQ(reportMesh(cubes).overused.count, 1);
  EXPECT_EQ(reportMesh(cubes).overused.first[0].count, 3);
}

TEST(MeshReport, poorShapesAndTinyEdgesAreReportedWithTheirPlaces)
{
  Mesh mesh = sampleMesh2d();
  mesh.coordinates[8] = {3.998, 1, 0}; // upper left corner of the shot, 2 mm from the right one
  const MeshReport report = reportMesh(mesh);
  EXPECT_TRUE(report.usable());
  std::string all;
  for (const std::string& problem : meshProblems(report))
    all += problem + "\n";
  EXPECT_NE(all.find("the shortest edge, 0.002 m at (3.999, 1, 0), is 706 times shorter"),
            std::string::npos)
      << all;
  // Sheared until it is all but flat.
  mesh = sampleMesh2d();
  mesh.coordinates[8].x += 100;
  mesh.coordinates[9].x += 100;
  const std::vector<std::string> problems = meshProblems(reportMesh(mesh));
  ASSERT_FALSE(problems.empty());
  EXPECT_NE(problems[0].find("element 8 of block 'shot' at (53.5, 0.5, 0) has the shape 0.01"),
            std::string::npos)
      << problems[0];
}

TEST(MeshReport, aMeshInMillimetresIsAskedFor)
{
  Mesh mesh = sampleMesh2d();
  for (Vec3& x : mesh.coordinates)
    x = 1e4 * x; // 41 km from corner to corner
  EXPECT_NE(meshProblems(mesh).at(0).find("in metres?"), std::string::npos);
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
  ASSERT_EQ(report.folded.count, 1);
  EXPECT_EQ(report.folded.first[0].element, 8);
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.blocks[1].worstElement, 8);
  EXPECT_LT(report.blocks[1].worstQuality, 0);
  EXPECT_EQ(report.blocks[0].worstQuality, 1);
  EXPECT_EQ(
      meshProblems(report)[0],
      "1 elements are folded at a corner: element 8 of block 'shot'. Their area is positive, but "
      "they are not convex; remesh that region.");
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

namespace
{
/// Two rows of squares on each other with a joint between, and one of every fault: some inside out
/// (more than are named), one folded, nodes of no element, coincident nodes.
Mesh faultyRows()
{
  Mesh mesh;
  mesh.dimension = 2;
  Mesh::SideSet joint{1, "joint", {}, {}}, top{2, "top", {}, {}};
  for (int row = 0; row < 2; ++row)
  {
    const int first = mesh.nodes(), count = 20;
    Mesh::Block block{row + 1, row ? "upper" : "lower", ElementType::Quad4, {}, {}, {}};
    for (int i = 0; i <= count; ++i)
      for (int j = 0; j < 2; ++j)
      {
        mesh.nodeIds.push_back(1000 - mesh.nodes());
        mesh.coordinates.push_back({Real(i), Real(row + j), 0});
      }
    for (int e = 0; e < count; ++e)
    {
      const int n = first + 2 * e;
      block.elementIds.push_back(100 * row + e + 1);
      block.bodyIds.push_back(0);
      for (const int k : {0, 2, 3, 1})
        block.connectivity.push_back(n + k);
      joint.elements.push_back(count * row + e);
      joint.sides.push_back(row ? 0 : 2);
    }
    mesh.blocks.push_back(block);
  }
  joint.elements.erase(joint.elements.begin() + 3); // its partner is alone
  joint.sides.erase(joint.sides.begin() + 3);
  top.elements = {20, 30};
  top.sides = {2, 2};
  mesh.sideSets = {joint, top};
  for (const int e : {2, 5, 7, 11, 13, 17, 19})
    std::swap(mesh.blocks[1].connectivity[4 * e + 1], mesh.blocks[1].connectivity[4 * e + 3]);
  mesh.coordinates[1].y = -0.5; // folds the first square, or turns it
  for (int i = 0; i < 7; ++i)
  {
    mesh.nodeIds.push_back(2000 + i);
    mesh.coordinates.push_back({Real(i), -1, 0});
  }
  // The lower nodes of the lower row a second time, in squares below: one body with coincident
  // nodes, since one corner is shared.
  mesh.blocks[0].elementIds.push_back(50);
  mesh.blocks[0].bodyIds.push_back(0);
  mesh.nodeIds.insert(mesh.nodeIds.end(), {3000, 3001, 3002});
  mesh.coordinates.insert(mesh.coordinates.end(), {{18, -1, 0}, {19, -1, 0}, {19, 0, 0}});
  for (const int n : {mesh.nodes() - 3, mesh.nodes() - 2, mesh.nodes() - 1, 36})
    mesh.blocks[0].connectivity.push_back(n);
  for (Mesh::SideSet& set : mesh.sideSets)
    for (int& element : set.elements)
      element += element >= 20; // the added element stands before the upper row
  return mesh;
}
} // namespace

TEST(MeshReport, isTheSameForAnyNumberOfRanks)
{
  const Comm comm;
  const Mesh mesh = faultyRows();
  const MeshReport whole = reportMesh(mesh);
  EXPECT_EQ(whole.bodies, 2);
  EXPECT_GE(whole.inverted.count, 7);
  EXPECT_EQ(whole.inverted.first.size(), 5u);
  EXPECT_EQ(whole.unusedNodes.count, 7);
  EXPECT_EQ(whole.coincident.count, 1);
  ASSERT_EQ(whole.joints.size(), 1u);
  // One whose partner is not in the set; both where the upper square is inside out, so that other
  // nodes are its lower side, or the corner has moved: 1 + 2 * 7 + 2.
  EXPECT_EQ(whole.joints[0].alone.count, 17);

  const MeshSlice slice = sliceOf(mesh, comm.rank(), comm.size());
  const MeshReport report = reportMesh(slice, partAtHome(slice, comm), comm);
  EXPECT_EQ(meshProblems(report), meshProblems(whole));
  EXPECT_EQ(report.nodes, whole.nodes);
  EXPECT_EQ(report.elements, whole.elements);
  EXPECT_EQ(report.bodies, whole.bodies);
  EXPECT_EQ(norm(report.lowest - whole.lowest) + norm(report.highest - whole.highest), 0);
  EXPECT_EQ(report.shortestEdge, whole.shortestEdge);
  EXPECT_EQ(report.longestEdge, whole.longestEdge);
  ASSERT_EQ(report.blocks.size(), whole.blocks.size());
  for (std::size_t b = 0; b < whole.blocks.size(); ++b)
  {
    EXPECT_EQ(report.blocks[b].elements, whole.blocks[b].elements);
    EXPECT_EQ(report.blocks[b].bodies, whole.blocks[b].bodies);
    EXPECT_EQ(report.blocks[b].volume, whole.blocks[b].volume);
    EXPECT_EQ(report.blocks[b].worstQuality, whole.blocks[b].worstQuality);
    EXPECT_EQ(report.blocks[b].worstElement, whole.blocks[b].worstElement);
  }
  ASSERT_EQ(report.joints.size(), whole.joints.size());
  EXPECT_EQ(report.joints[0].pairs, whole.joints[0].pairs);
}
} // namespace coplane
