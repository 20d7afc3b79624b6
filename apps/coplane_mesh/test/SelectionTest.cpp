#include "MakeMesh.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_exodus/MeshReport.hpp>

#include <gtest/gtest.h>

#include <string>

namespace coplane
{
namespace
{
Mesh made(const std::string& sets)
{
  return makeMeshFromText(
      "dimension: 2\n"
      "parts:\n"
      "  - {shape: box, block: low, size: [4, 1], divisions: [4, 1]}\n"
      "  - {shape: box, block: high, min: [0, 1], size: [4, 1], divisions: [2, 1]}\n" +
          sets,
      "sets.yaml");
}
Mesh inputMesh(const std::string& name)
{
  return makeMesh(std::string(COPLANE_INPUTS) + "/" + name + "/mesh.yaml");
}
} // namespace

TEST(Selection, aPlaneTakesTheNodesOfItsBlockOnly)
{
  // y = 1 is the top of `low` (5 nodes) and the base of `high` (3 nodes).
  EXPECT_EQ(made("node_sets: {a: {block: low, where: {y: 1}}}").nodeSets[0].nodes.size(), 5u);
  EXPECT_EQ(made("node_sets: {a: {block: high, where: {y: 1}}}").nodeSets[0].nodes.size(), 3u);
  EXPECT_EQ(made("node_sets: {a: {where: {y: 1}}}").nodeSets[0].nodes.size(), 8u);
}

TEST(Selection, aRangeIncludesItsEnds)
{
  // x = 1, 2, 3 on the two lines of nodes of `low`.
  EXPECT_EQ(made("node_sets: {a: {block: low, where: {x: [1, 3]}}}").nodeSets[0].nodes.size(), 6u);
}

TEST(Selection, radiusAndAngleAreThoseAboutTheOrigin)
{
  const auto ring = [](const std::string& where)
  {
    return makeMeshFromText("{dimension: 2, parts: [{shape: sector, block: b, inner_radius: 1, "
                            "outer_radius: 2, from: 0, to: 180, divisions: [2, 12]}], node_sets: "
                            "{a: {where: {" +
                                where + "}}}}",
                            "ring.yaml")
        .nodeSets[0]
        .nodes.size();
  };
  EXPECT_EQ(ring("radius: 1"), 13u);
  EXPECT_EQ(ring("radius: [1, 1.5]"), 26u);
  EXPECT_EQ(ring("angle: 90"), 3u);
  EXPECT_EQ(ring("angle: [0, 30]"), 9u); // nodes every 15 degrees
  EXPECT_EQ(ring("angle: [-370, -330]"), 9u);
  EXPECT_EQ(ring("angle: [150, 180], radius: 2"), 3u);
  EXPECT_EQ(ring("angle: [-200, 200]"), 39u);
  EXPECT_THROW(ring("angle: [30, 0]"), Error);
  EXPECT_THROW(ring("radius: 3"), Error);
}

TEST(Selection, theMantleOfACylinder)
{
  const Mesh mesh = makeMeshFromText(
      "{dimension: 3, parts: [{shape: cylinder, block: b, radius: 0.5, across: 4, length: 1, "
      "along: 2, rotate: [90, 0, 0]}], side_sets: {mantle: {where_own: {radius: 0.5}}}}",
      "cylinder.yaml");
  EXPECT_EQ(mesh.sideSets[0].elements.size(), 8u * 2); // two layers; the outline has 8 faces
}

TEST(Selection, everyWrongPartAndSetIsNamed)
{
  try
  {
    makeMeshFromText("{dimension: 2, parts: [{shape: bux, block: a}, {shape: box, block: b, size: "
                     "[1, 1], divisions: [0, 1]}]}",
                     "parts.yaml");
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("parts.0"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("parts.1"), std::string::npos) << error.what();
  }
  try
  {
    made("node_sets: {a: {block: middle}, b: {where: {y: 7}}}\nside_sets: {c: {where: {x: 9}}}");
    FAIL();
  }
  catch (const Error& error)
  {
    for (const char* set : {"node_sets.a", "node_sets.b", "side_sets.c"})
      EXPECT_NE(std::string(error.what()).find(set), std::string::npos) << error.what();
  }
}

TEST(Selection, interiorFacesAreNotInSideSets)
{
  // All exterior faces of `low`: 4 below, 4 above, 2 ends; bodies that touch do not share nodes, so
  // y = 1 is exterior.
  EXPECT_EQ(made("side_sets: {a: {block: low}}").sideSets[0].elements.size(), 10u);
}

TEST(Selection, theNormalTellsSidesApart)
{
  const Mesh mesh =
      made("side_sets: {a: {where: {y: 1}, normal: [0, 1]}, b: {where: {y: 1}, normal: [0, -1]}}");
  EXPECT_EQ(mesh.sideSets[0].elements.size(), 4u);
  EXPECT_EQ(mesh.sideSets[1].elements, (std::vector<int>{4, 5}));
  // The lower side of a quadrilateral of a box is side 0.
  EXPECT_EQ(mesh.sideSets[1].sides, (std::vector<int>{0, 0}));
}

TEST(Selection, ownCoordinatesAreThoseBeforeTheTurn)
{
  const Mesh mesh = makeMeshFromText(
      "{dimension: 2, parts: [{shape: box, block: b, size: [2, 1], divisions: [2, 1], rotate: 33, "
      "offset: [7, 7]}], node_sets: {tip: {where_own: {x: 2}}}}",
      "own.yaml");
  EXPECT_EQ(mesh.nodeSets[0].nodes.size(), 2u);
}

TEST(ExodusInputs, theWallOfTheBarHas210BodiesOnItsBase)
{
  const Mesh mesh = inputMesh("bar_wall_3d");
  const MeshReport report = reportMesh(mesh);
  EXPECT_EQ(report.blocks[0].bodies, 210);
  EXPECT_EQ(report.blocks[0].elements, 6400);
  EXPECT_NEAR(report.blocks[0].volume, 6.4 * 6.4 * 0.64, 1e-11);
  EXPECT_NEAR(report.blocks[1].volume, 0.32 * 0.32 * 5, 1e-12);
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(mesh.nodeSets[0].name, "base");
  EXPECT_EQ(mesh.nodeSets[0].nodes.size(), 250u); // 10 bricks of 5 x 5 nodes
  EXPECT_EQ(mesh.nodeSets[1].nodes.size(), 9u);
}

TEST(ExodusInputs, theBarStartsFiveMillimetresBeforeTheWall)
{
  const Mesh mesh = inputMesh("bar_wall_3d");
  Real highest = -infinity;
  for (const int node : mesh.blocks[1].connectivity)
    highest = std::max(highest, mesh.coordinates[node].z);
  EXPECT_NEAR(highest, -0.005, 1e-9);
}

TEST(ExodusInputs, theWallOfTheProjectileHasFiftyBodies)
{
  const Mesh mesh = inputMesh("projectile_wall_2d");
  const MeshReport report = reportMesh(mesh);
  EXPECT_EQ(report.blocks[0].bodies, 50);
  EXPECT_EQ(report.blocks[0].elements, 4800);
  EXPECT_NEAR(report.blocks[0].volume, 0.6 * 0.05, 1e-13);
  EXPECT_TRUE(report.usable());
}

TEST(ExodusInputs, theOtherMeshesAreFaultless)
{
  for (const char* name : {"bars_2d", "incline", "jointed_rock_2d"})
    EXPECT_TRUE(meshProblems(inputMesh(name)).empty()) << name;
}
} // namespace coplane
