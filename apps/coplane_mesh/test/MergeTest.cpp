#include "Cuts.hpp"
#include "MakeMesh.hpp"
#include "MergeMeshes.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_exodus/MeshReport.hpp>
#include <coplane_exodus/ReadMesh.hpp>
#include <coplane_exodus/WriteMesh.hpp>

#include <gtest/gtest.h>

#include <TestFolder.hpp>
#include <algorithm>

namespace coplane
{
namespace
{
/// A box of 2 x 1 in elements of side 1 from a corner, with a node set, a side set and names that
/// begin alike.
Mesh boxAt(Real x, Real y, const std::string& name, const std::string& more = "")
{
  return makeMeshFromText(
      fmt::format(
          "{{dimension: 2, parts: [{{shape: box, block: {0}, min: [{1}, {2}], size: [2, 1], "
          "divisions: [2, 1]{3}}}], node_sets: {{{0}_left: {{where: {{x: {1}}}}}}}, "
          "side_sets: {{{0}_top: {{normal: [0, 1]}}}}}}",
          name, x, y, more),
      name + ".yaml");
}

std::string errorOf(const std::vector<MeshToMerge>& meshes, Real weld = 0)
{
  try
  {
    mergeMeshes(meshes, weld);
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Mesh);
    return error.what();
  }
  return "no error";
}

void expectIn(const std::string& text, const std::string& part)
{
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

/// Two rows of two elements, one on the other, cut apart by a joint along x = 1.
Mesh cutBox(Real y, const std::string& name)
{
  const Mesh whole = boxAt(0, y, name);
  const std::vector<MeshFace> faces = facesOf(whole);
  const std::string joints = "{joints: {crack: {planes: {point: [1, 0], normal: [1, 0]}}}}";
  return splitMesh(whole, faces, selectCuts(joints, "cuts.yaml", whole, faces).cuts).mesh;
}
} // namespace

TEST(MergedMeshes, thatDoNotMatchAreToldToHangTogetherByNodes)
{
  const Mesh above = makeMeshFromText(
      "{dimension: 2, parts: [{shape: box, block: bar, min: [0, 1], size: [2, 1], divisions: [3, "
      "1]}]}",
      "bar.yaml");
  const MergedMesh merged =
      mergeMeshes({{boxAt(0, 0, "wall"), "a.e", "", false}, {above, "b.e", "", false}}, 1e-3);
  ASSERT_FALSE(merged.notes.empty());
  expectIn(merged.notes[0], "2 of 2 welded nodes lie on no face that two elements share, the first "
                            "at (0, 1, 0) m");
}

TEST(MergedMeshes, keepBlocksSetsAndVolumes)
{
  const MergedMesh merged =
      mergeMeshes({{boxAt(0, 0, "wall"), "a.e", "", false},
                   {boxAt(0, 1, "bar", ", split: triangles"), "b.e", "", false}});
  const Mesh& mesh = merged.mesh;
  EXPECT_EQ(mesh.nodes(), 12);
  EXPECT_EQ(mesh.elements(), 6);
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[0].name, "wall");
  EXPECT_EQ(mesh.blocks[1].name, "bar");
  EXPECT_EQ(mesh.blocks[1].type, ElementType::Tri3);
  EXPECT_EQ(mesh.blocks[1].id, 2);
  EXPECT_EQ(mesh.blocks[1].elementIds.front(), 3);
  EXPECT_EQ(mesh.blocks[1].bodyIds, std::vector<int>(4, 2));
  ASSERT_EQ(mesh.nodeSets.size(), 2u);
  for (const int node : mesh.nodeSets[1].nodes)
    EXPECT_EQ(mesh.coordinates[std::size_t(node)].x, 0);
  ASSERT_EQ(mesh.sideSets.size(), 2u);
  EXPECT_EQ(mesh.sideSets[1].name, "bar_top");
  for (std::size_t s = 0; s < 2; ++s)
    EXPECT_GE(mesh.sideSets[1].elements[s], 2); // after the two of the wall
  const MeshReport report = reportMesh(mesh);
  EXPECT_EQ(report.bodies, 2);
  EXPECT_NEAR(report.blocks[0].volume, 2, 1e-14);
  EXPECT_NEAR(report.blocks[1].volume, 2, 1e-14);
  EXPECT_TRUE(meshProblems(mesh).empty());
}

TEST(MergedMeshes, areTheSameAfterTheyAreWrittenAndRead)
{
  const TestFolder folder(Comm::alone());
  const Mesh mesh =
      mergeMeshes({{cutBox(0, "wall"), "a.e", "", false}, {cutBox(1, "bar"), "b.e", "up_", false}})
          .mesh;
  writeMesh(mesh, folder / "all.e");
  const Mesh read = readMesh(folder / "all.e");
  ASSERT_EQ(read.sideSets.size(), mesh.sideSets.size());
  for (std::size_t s = 0; s < mesh.sideSets.size(); ++s)
  {
    EXPECT_EQ(read.sideSets[s].name, mesh.sideSets[s].name);
    EXPECT_EQ(read.sideSets[s].elements, mesh.sideSets[s].elements);
    EXPECT_EQ(read.sideSets[s].sides, mesh.sideSets[s].sides);
  }
  // The joints are joints still: both of their faces lie on each other.
  const MeshReport report = reportMesh(read);
  EXPECT_EQ(report.bodies, 4);
  ASSERT_EQ(report.joints.size(), 2u);
  EXPECT_EQ(report.joints[0].name, "crack");
  EXPECT_EQ(report.joints[1].name, "up_crack");
  EXPECT_EQ(report.joints[1].pairs, 1);
}

TEST(MergedMeshes, refuseNamesThatAreThereUnlessTheyAreJoined)
{
  const std::string error =
      errorOf({{boxAt(0, 0, "wall"), "a.e", "", false}, {boxAt(0, 1, "wall"), "b.e", "", false}});
  expectIn(error, "a.e and b.e both have a block 'wall'");
  expectIn(error, "--prefix");
  expectIn(error, "--join");
  expectIn(errorOf({{cutBox(0, "wall"), "a.e", "", false}, {cutBox(1, "bar"), "b.e", "", false}}),
           "both have a side set 'crack'");
  const Mesh joined = mergeMeshes({{cutBox(0, "wall"), "a.e", "", false},
                                   {boxAt(7, 0, "bar"), "b.e", "", false},
                                   {cutBox(1, "wall"), "c.e", "", true}})
                          .mesh;
  ASSERT_EQ(joined.blocks.size(), 2u);
  EXPECT_EQ(joined.blocks[0].elements(), 4);
  EXPECT_EQ(joined.nodeSets[0].nodes.size(), 4u);
  // The elements of the third mesh come before those of the second: sides are still theirs.
  const auto crack = std::find_if(joined.sideSets.begin(), joined.sideSets.end(),
                                  [](const auto& set) { return set.name == "crack"; });
  EXPECT_EQ(crack->elements, (std::vector<int>{0, 1, 2, 3}));
  for (const MeshReport::Joint& joint : reportMesh(joined).joints)
    EXPECT_EQ(joint.pairs, 2);
  expectIn(errorOf({{boxAt(0, 0, "wall"), "a.e", "", false},
                    {boxAt(0, 1, "wall", ", split: triangles"), "b.e", "", true}}),
           "the block 'wall' has QUAD4 elements in a.e and TRI3 in b.e");
}

TEST(MergedMeshes, refuseTwoDimensionsWithThree)
{
  const Mesh cube = makeMeshFromText(
      "{dimension: 3, parts: [{shape: box, block: c, size: [1, 1, 1], divisions: [1, 1, 1]}]}",
      "cube.yaml");
  expectIn(errorOf({{boxAt(0, 0, "wall"), "a.e", "", false}, {cube, "cube.e", "", false}}),
           "a.e has 2 dimensions and cube.e has 3");
}

TEST(MergedMeshes, areWeldedWithinATolerance)
{
  // The second box stands on the first one, 1e-4 m too high; its base has the three nodes there.
  const MergedMesh welded = mergeMeshes(
      {{boxAt(0, 0, "wall"), "a.e", "", false}, {boxAt(0, 1.0001, "bar"), "b.e", "", false}}, 1e-3);
  EXPECT_EQ(welded.welded, (std::vector<int>{0, 3}));
  EXPECT_EQ(welded.mesh.nodes(), 9);
  const MeshReport report = reportMesh(welded.mesh);
  EXPECT_EQ(report.bodies, 1);
  EXPECT_NEAR(report.blocks[0].volume, 2, 1e-14);
  EXPECT_NEAR(report.blocks[1].volume, 2.0002, 1e-12);
  ASSERT_EQ(welded.notes.size(), 1u);
  EXPECT_EQ(welded.notes[0],
            "side set 'wall_top': 2 of its 2 faces lie between two elements of one body");
  expectIn(
      errorOf({{boxAt(0, 0, "wall"), "a.e", "", false}, {boxAt(0, 1.01, "bar"), "b.e", "", false}},
              1e-3),
      "nothing would be welded");
}

TEST(MergedMeshes, refuseWeldsThatAreNone)
{
  // At the joint two nodes of each mesh lie on each other.
  expectIn(errorOf({{cutBox(0, "wall"), "a.e", "", false}, {boxAt(0, 1, "bar"), "b.e", "", false}},
                   1e-3),
           "are both within 0.001 m of node");
  expectIn(errorOf({{boxAt(0, 0, "wall"), "a.e", "", false}, {cutBox(1, "bar"), "b.e", "", false}},
                   1e-3),
           "are both within 0.001 m of node");
  // Each node is near one of the other mesh only, and two of an element near the same one.
  const Mesh fine = makeMeshFromText("{dimension: 2, parts: [{shape: box, block: f, min: [0, 1], "
                                     "size: [2, 0.3], divisions: [2, 1]}]}",
                                     "fine.yaml");
  expectIn(errorOf({{boxAt(0, 0, "wall"), "a.e", "", false}, {fine, "fine.e", "", false}}, 0.4),
           "of fine.e are both within 0.4 m of node");
}

TEST(MeshesOfRecipes, arePlacedBesideTheParts)
{
  const TestFolder folder(Comm::alone());
  writeMesh(boxAt(0, 0, "bar"), folder / "bar.e");
  const std::string text =
      "{dimension: 2, parts: [{shape: box, block: slab, size: [4, 1], divisions: [2, 1]}], meshes: "
      "[{file: bar.e, prefix: a_, scale: 0.5, rotate: 90, about: [0, 0], offset: [3, 1]}, {file: "
      "bar.e, prefix: b_, offset: [0, 1]}], node_sets: {base: {where: {y: 0}}, tip: {block: a_bar, "
      "where_own: {x: 1}}}}";
  const Mesh mesh = makeMeshFromText(text, folder / "all.yaml");
  ASSERT_EQ(mesh.blocks.size(), 3u);
  const MeshReport report = reportMesh(mesh);
  EXPECT_NEAR(report.blocks[1].volume, 0.5, 1e-14);
  EXPECT_NEAR(report.blocks[2].volume, 2, 1e-14);
  EXPECT_EQ(report.bodies, 3);
  // A quarter turn: what was at x = 1 (scaled from 2) is at y = 1 + 1.
  const Mesh::NodeSet& tip = mesh.nodeSets.back();
  EXPECT_EQ(tip.name, "tip");
  ASSERT_EQ(tip.nodes.size(), 2u);
  for (const int node : tip.nodes)
    EXPECT_EQ(mesh.coordinates[std::size_t(node)].y, 2);
  EXPECT_EQ(mesh.nodeSets.front().name, "a_bar_left");
  const auto refusal = [&](const std::string& changed)
  {
    try
    {
      makeMeshFromText(changed, folder / "all.yaml");
    }
    catch (const Error& error)
    {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  expectIn(refusal("{dimension: 2, meshes: [{file: bar.e}, {file: bar.e}]}"),
           "both have a block 'bar'");
  EXPECT_EQ(refusal("{dimension: 2, meshes: [{file: bar.e}, {file: bar.e, join: true, offset: [0, "
                    "2]}]}"),
            "accepted");
  expectIn(refusal("{dimension: 3, meshes: {file: bar.e}}"), "has 2 dimensions and the recipe 3");
  expectIn(refusal("{dimension: 2, meshes: {file: missing.e}}"), "missing.e");
  expectIn(refusal("{dimension: 2}"), "no parts and no meshes");
  expectIn(refusal("{dimension: 2, meshes: {file: bar.e}, node_sets: {bar_left: {where: {x: 0}}}}"),
           "node_sets.bar_left has the name of a set of a mesh");
  EXPECT_EQ(meshFilesOf(std::string(COPLANE_INPUTS) + "/bars_2d/mesh.yaml").size(), 0u);
}
} // namespace coplane
