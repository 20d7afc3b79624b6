#include "Cuts.hpp"
#include "MakeMesh.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_exodus/MeshReport.hpp>
#include <coplane_exodus/ReadMesh.hpp>
#include <coplane_exodus/WriteMesh.hpp>

#include <gtest/gtest.h>

#include <TestFolder.hpp>
#include <algorithm>
#include <set>

namespace coplane
{
namespace
{
SplitMesh cut(const Mesh& mesh, const std::string& joints)
{
  const std::vector<MeshFace> faces = facesOf(mesh);
  return splitMesh(mesh, faces, selectCuts("joints: " + joints, "cuts.yaml", mesh, faces).cuts);
}

std::string errorOf(const Mesh& mesh, const std::string& joints)
{
  try
  {
    cut(mesh, joints);
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Deck);
    return error.what();
  }
  return "no error";
}

/// A square of 4 x 4 with elements of side 1, whole or in triangles.
Mesh square(const std::string& more = "")
{
  return makeMeshFromText(
      "{dimension: 2, parts: [{shape: box, block: rock, size: [4, 4], divisions: [4, 4]" + more +
          "}], node_sets: {left: {where: {x: 0}}}, side_sets: {top: {normal: [0, 1]}}}",
      "square.yaml");
}

Mesh cube(const std::string& more = "")
{
  return makeMeshFromText(
      "{dimension: 3, parts: [{shape: box, block: rock, size: [4, 4, 4], divisions: [4, 4, 4]" +
          more + "}]}",
      "cube.yaml");
}

/// A row of three blocks of 2 x 2 elements that share nodes, below one of 6 x 2: made by hand from
/// a box.
///     +-----------+
///     |    top    |
///     +---+---+---+
///     | a | b | c |
///     +---+---+---+
Mesh blocks()
{
  const Mesh box = makeMeshFromText(
      "{dimension: 2, parts: [{shape: box, block: b, size: [6, 4], divisions: [6, 4]}]}", "b.yaml");
  Mesh mesh = box;
  mesh.blocks.clear();
  for (const char* name : {"a", "b", "c", "top"})
    mesh.blocks.push_back({GlobalId(mesh.blocks.size() + 1), name, ElementType::Quad4, {}, {}, {}});
  for (int e = 0; e < 24; ++e)
  {
    Mesh::Block& block = mesh.blocks[e < 12 ? e % 6 / 2 : 3];
    const auto first = box.blocks[0].connectivity.begin() + 4 * e;
    block.connectivity.insert(block.connectivity.end(), first, first + 4);
    block.bodyIds.push_back(0);
  }
  GlobalId id = 0;
  for (Mesh::Block& block : mesh.blocks)
    for (std::size_t e = 0; e < block.bodyIds.size(); ++e)
      block.elementIds.push_back(++id);
  return mesh;
}

int nodesAt(const Mesh& mesh, const Vec3& place)
{
  return int(std::count_if(mesh.coordinates.begin(), mesh.coordinates.end(),
                           [&](const Vec3& x) { return norm(x - place) < 1e-9; }));
}

/// Area or volume of all, and whether the mesh can be used.
Real volumeOf(const Mesh& mesh)
{
  const MeshReport report = reportMesh(mesh);
  EXPECT_TRUE(report.usable());
  Real volume = 0;
  for (const auto& block : report.blocks)
    volume += block.volume;
  return volume;
}

const Mesh::SideSet& sideSet(const Mesh& mesh, const std::string& name)
{
  return *std::find_if(mesh.sideSets.begin(), mesh.sideSets.end(),
                       [&](const Mesh::SideSet& set) { return set.name == name; });
}

std::vector<Vec3> placesOfSet(const Mesh& mesh, int set)
{
  std::vector<Vec3> places;
  for (const int node : mesh.nodeSets[set].nodes)
    places.push_back(mesh.coordinates[node]);
  return places;
}
} // namespace

TEST(Split, aPlaneMakesTwoBodiesWithNodesOfTheirOwn)
{
  const SplitMesh split = cut(square(), "{j: {planes: {point: [2, 0], normal: [1, 0]}}}");
  EXPECT_EQ(split.bodiesBefore, 1);
  EXPECT_EQ(split.bodies, 2);
  EXPECT_EQ(split.copies, 5);
  EXPECT_EQ(split.cuts[0].opened, 4);
  EXPECT_EQ(split.cuts[0].area, 4);
  EXPECT_EQ(split.cuts[0].closed, 0);
  const Mesh& mesh = split.mesh;
  EXPECT_EQ(mesh.nodes(), 30);
  EXPECT_NEAR(volumeOf(mesh), 16, 1e-14);
  // Elements left of the joint are body 1, those right of it body 2, and no node is in both.
  std::set<int> nodes[2];
  for (int e = 0; e < 16; ++e)
  {
    const bool right = e % 4 >= 2;
    EXPECT_EQ(mesh.blocks[0].bodyIds[e], right ? 2 : 1);
    for (int k = 0; k < 4; ++k)
      nodes[right].insert(mesh.blocks[0].connectivity[4 * e + k]);
  }
  EXPECT_EQ(nodes[0].size(), 15u);
  EXPECT_EQ(nodes[1].size(), 15u);
  for (const int node : nodes[0])
    EXPECT_EQ(nodes[1].count(node), 0u);
  // Copies have ids after the largest.
  EXPECT_EQ(mesh.nodeIds[25], 26);
  EXPECT_EQ(mesh.nodeIds[29], 30);
}

TEST(Split, theSideSetOfAJointHoldsBothFacesOfEveryCut)
{
  const Mesh mesh = cut(square(), "{j: {planes: {point: [2, 0], normal: [1, 0]}}}").mesh;
  const Mesh::SideSet& joint = sideSet(mesh, "j");
  // The column left of the joint has it at side 1 (from 1 to 2), the column right of it at side 3.
  EXPECT_EQ(joint.elements, (std::vector<int>{1, 2, 5, 6, 9, 10, 13, 14}));
  EXPECT_EQ(joint.sides, (std::vector<int>{1, 3, 1, 3, 1, 3, 1, 3}));
  EXPECT_EQ(sideSet(mesh, "top").elements.size(), 4u);
  // Both faces are exterior now.
  std::set<std::pair<int, int>> exterior;
  for (const MeshFace& face : facesOf(mesh))
    if (face.count == 1)
      exterior.insert({face.elements[0], face.sides[0]});
  EXPECT_EQ(exterior.size(), 16u + 8u);
  for (std::size_t i = 0; i < joint.elements.size(); ++i)
    EXPECT_EQ(exterior.count({joint.elements[i], joint.sides[i]}), 1u);
}

TEST(Split, aCrossingOfTwoJointsHasFourNodes)
{
  const SplitMesh split = cut(square(), "{h: {planes: {point: [0, 2], normal: [0, 1]}}, "
                                        "v: {planes: {point: [2, 0], normal: [1, 0]}}}");
  EXPECT_EQ(split.bodies, 4);
  EXPECT_EQ(split.copies, 4 + 4 + 3);
  EXPECT_EQ(nodesAt(split.mesh, {2, 2, 0}), 4);
  EXPECT_EQ(nodesAt(split.mesh, {2, 1, 0}), 2);
  EXPECT_EQ(nodesAt(split.mesh, {1, 1, 0}), 1);
}

TEST(Split, aJointThatEndsAtAnotherHasThreeNodesThere)
{
  const SplitMesh split =
      cut(square(), "{h: {planes: {point: [0, 2], normal: [0, 1]}}, "
                    "v: {planes: {point: [2, 0], normal: [1, 0], segment: [[2, 0], [2, 2]]}}}");
  EXPECT_EQ(split.bodies, 3);
  EXPECT_EQ(nodesAt(split.mesh, {2, 2, 0}), 3);
}

TEST(Split, theTipsOfAFiniteJointStayOneNode)
{
  // From x = 1 to x = 3 in the middle: one node opens, its ends at x = 1 and 3 are tips.
  const SplitMesh inside =
      cut(square(), "{j: {planes: {point: [0, 2], normal: [0, 1], segment: [[1, 2], [3, 2]]}}}");
  EXPECT_EQ(inside.bodies, 1);
  EXPECT_EQ(inside.copies, 1);
  EXPECT_EQ(inside.cuts[0].opened, 2);
  EXPECT_EQ(nodesAt(inside.mesh, {1, 2, 0}), 1);
  EXPECT_EQ(nodesAt(inside.mesh, {2, 2, 0}), 2);
  EXPECT_EQ(nodesAt(inside.mesh, {3, 2, 0}), 1);
  EXPECT_TRUE(meshProblems(inside.mesh).empty());
  // From the border at x = 0 to x = 2: the mouth opens.
  const SplitMesh edge =
      cut(square(), "{j: {planes: {point: [0, 2], normal: [0, 1], segment: [[0, 2], [2, 2]]}}}");
  EXPECT_EQ(edge.copies, 2);
  EXPECT_EQ(nodesAt(edge.mesh, {0, 2, 0}), 2);
  EXPECT_EQ(nodesAt(edge.mesh, {1, 2, 0}), 2);
  EXPECT_EQ(nodesAt(edge.mesh, {2, 2, 0}), 1);
}

TEST(Split, aFaceWithAllNodesOnTheRimStaysClosed)
{
  const SplitMesh split =
      cut(square(), "{j: {planes: {point: [0, 2], normal: [0, 1], segment: [[1, 2], [2, 2]]}}}");
  EXPECT_EQ(split.copies, 0);
  EXPECT_EQ(split.cuts[0].opened, 0);
  EXPECT_EQ(split.cuts[0].area, 0);
  EXPECT_EQ(split.cuts[0].closed, 1);
  EXPECT_TRUE(sideSet(split.mesh, "j").elements.empty());
}

TEST(Split, threePlanesMakeEightBlocksAndEightNodesInTheMiddle)
{
  for (const std::string more : {"", ", split: tetrahedra"})
  {
    const SplitMesh split = cut(cube(more), "{a: {planes: {point: [2, 2, 2], normal: [1, 0, 0]}}, "
                                            "b: {planes: {point: [2, 2, 2], normal: [0, 1, 0]}}, "
                                            "c: {planes: {point: [2, 2, 2], normal: [0, 0, 1]}}}");
    EXPECT_EQ(split.bodies, 8);
    // Each of eight blocks has 3 x 3 x 3 nodes.
    EXPECT_EQ(split.mesh.nodes(), 8 * 27);
    EXPECT_EQ(nodesAt(split.mesh, {2, 2, 2}), 8);
    EXPECT_EQ(nodesAt(split.mesh, {2, 2, 1}), 4);
    EXPECT_EQ(nodesAt(split.mesh, {2, 1, 1}), 2);
    EXPECT_NEAR(volumeOf(split.mesh), 64, 1e-12);
    const MeshReport report = reportMesh(split.mesh);
    ASSERT_EQ(report.joints.size(), 3u);
    for (const auto& joint : report.joints)
    {
      EXPECT_EQ(joint.pairs, more.empty() ? 16 : 32);
      EXPECT_TRUE(joint.alone.empty());
    }
    // 16 squares in each plane, each in two triangles with tetrahedra.
    for (const CutReport& joint : split.cuts)
      EXPECT_EQ(joint.opened, more.empty() ? 16 : 32);
  }
}

TEST(Split, trianglesSplitLikeQuadrilaterals)
{
  const SplitMesh split =
      cut(square(", split: triangles"), "{h: {planes: {point: [0, 2], normal: [0, 1]}}, "
                                        "v: {planes: {point: [2, 0], normal: [1, 0]}}}");
  EXPECT_EQ(split.bodies, 4);
  EXPECT_EQ(split.mesh.nodes(), 36);
  EXPECT_EQ(nodesAt(split.mesh, {2, 2, 0}), 4);
  EXPECT_NEAR(volumeOf(split.mesh), 16, 1e-13);
}

TEST(Split, aPennyShapedCrackHasAClosedRim)
{
  // Centres of faces within 1 of the middle: the four around it. Only the middle node opens.
  const SplitMesh split =
      cut(cube(), "{j: {planes: {point: [2, 2, 2], normal: [0, 0, 1], disc: {centre: [2, 2, 2], "
                  "radius: 1}}}}");
  EXPECT_EQ(split.cuts[0].opened, 4);
  EXPECT_EQ(split.copies, 1);
  EXPECT_EQ(split.bodies, 1);
  // The same four by a polygon, and by a box.
  for (const char* extent : {"polygon: [[1, 1, 2], [3, 1, 2], [3, 3, 2], [1, 3, 2]]",
                             "box: {min: [1, 1, 0], max: [3, 3, 4]}"})
    EXPECT_EQ(cut(cube(), std::string("{j: {planes: {point: [2, 2, 2], normal: [0, 0, 1], ") +
                              extent + "}}}")
                  .cuts[0]
                  .opened,
              4)
        << extent;
}

TEST(Split, hingesOpenWhereTheyAreAskedTo)
{
  // Of four cubes round an edge two stay that have only the edge in common.
  Mesh mesh = makeMeshFromText("{dimension: 3, parts: [{shape: box, block: rock, size: [2, 2, 1], "
                               "divisions: [2, 2, 1]}]}",
                               "hinge.yaml");
  Mesh::Block& block = mesh.blocks[0];
  for (const int gone : {2, 1})
  {
    block.connectivity.erase(block.connectivity.begin() + 8 * gone,
                             block.connectivity.begin() + 8 * gone + 8);
    block.elementIds.erase(block.elementIds.begin() + gone);
    block.bodyIds.erase(block.bodyIds.begin() + gone);
  }
  const std::vector<MeshFace> faces = facesOf(mesh);
  EXPECT_EQ(splitMesh(mesh, faces, {}).bodies, 1);
  const SplitMesh open = splitMesh(mesh, faces, {}, Hinges::Open);
  EXPECT_EQ(open.bodies, 2);
  EXPECT_EQ(open.copies, 2);
  ASSERT_EQ(open.hinges.size(), 2u);
  EXPECT_NEAR(open.hinges[0].x, 1, 1e-14);
  EXPECT_NEAR(open.hinges[0].y, 1, 1e-14);
  const Mesh whole = cube();
  EXPECT_EQ(splitMesh(whole, facesOf(whole), {}, Hinges::Open).copies, 0);
}

TEST(Split, aSetOfPlanesIsRepeatedAtItsSpacing)
{
  // All planes through the square: x = 1, 2, 3; those at 0 and 4 have no faces inside.
  EXPECT_EQ(cut(square(), "{j: {planes: {point: [2, 0], normal: [1, 0], spacing: 1}}}").bodies, 4);
  // From x = 1 along -x there is one plane only; along x two.
  EXPECT_EQ(
      cut(square(), "{j: {planes: {point: [1, 0], normal: [1, 0], spacing: 1, count: 2}}}").bodies,
      3);
  EXPECT_EQ(
      cut(square(), "{j: {planes: {point: [1, 0], normal: [-1, 0], spacing: 1, count: 1}}}").bodies,
      2);
  // Two sets in one joint, of different spacing: 2 x 4 blocks.
  const SplitMesh both =
      cut(square(), "{j: {planes: [{point: [2, 0], normal: [1, 0], spacing: 2}, {point: [0, 0], "
                    "normal: [0, 1], spacing: 1}]}}");
  EXPECT_EQ(both.bodies, 8);
  EXPECT_EQ(both.cuts[0].opened, 4 + 12);
}

TEST(Split, aTurnedMeshIsCutByTurnedPlanes)
{
  const Mesh mesh = makeMeshFromText(
      "{dimension: 2, parts: [{shape: box, block: b, size: [4, 4], divisions: [4, 4], rotate: 30, "
      "about: [0, 0]}]}",
      "t.yaml");
  // The normal (1, 0) turned by 30 degrees.
  EXPECT_EQ(cut(mesh, "{j: {planes: {point: [0, 0], normal: [0.8660254037844386, 0.5], spacing: "
                      "1}}}")
                .bodies,
            4);
}

TEST(Split, bordersOfBlocksOpen)
{
  const SplitMesh all = cut(blocks(), "{j: {blocks: all}}");
  EXPECT_EQ(all.bodies, 4);
  EXPECT_EQ(nodesAt(all.mesh, {2, 2, 0}), 3);
  EXPECT_EQ(nodesAt(all.mesh, {3, 2, 0}), 2);
  EXPECT_EQ(all.cuts[0].opened, 2 + 2 + 6);
  // Between a and b only: at the end of their border on top, a and b hang together through it.
  const SplitMesh pair = cut(blocks(), "{j: {blocks: [[a, b]]}}");
  EXPECT_EQ(pair.bodies, 1);
  EXPECT_EQ(pair.cuts[0].opened, 2);
  EXPECT_EQ(nodesAt(pair.mesh, {2, 2, 0}), 1);
  EXPECT_EQ(nodesAt(pair.mesh, {2, 0, 0}), 2);
}

TEST(Split, everyFaceOfABlockOpens)
{
  for (const char* more : {"", ", split: triangles"})
  {
    const Mesh whole = square(more);
    const SplitMesh split = cut(whole, "{bonds: {every_face: rock}}");
    const int elements = *more ? 32 : 16, perElement = *more ? 3 : 4;
    EXPECT_EQ(split.bodies, elements) << "each element is a body";
    EXPECT_EQ(split.mesh.nodes(), elements * perElement);
    EXPECT_EQ(split.cuts[0].opened, (elements * perElement - 16) / 2) << "all but the 16 outside";
    EXPECT_EQ(split.cuts[0].closed, 0);
  }
  const SplitMesh boxes = cut(cube(), "{bonds: {every_face: all}}");
  EXPECT_EQ(boxes.bodies, 64);
  EXPECT_EQ(boxes.mesh.nodes(), 8 * 64);
  EXPECT_EQ(boxes.cuts[0].opened, 3 * 48);
}

TEST(Split, everyFaceStaysWithinItsBlocks)
{
  const auto opened = [](const std::string& joints)
  { return cut(blocks(), joints).cuts[0].opened; };
  EXPECT_EQ(opened("{bonds: {every_face: a}}"), 4);
  EXPECT_EQ(opened("{bonds: {every_face: [a, b]}}"), 4 + 4 + 2) << "and the border of both";
  EXPECT_EQ(opened("{bonds: {every_face: top}}"), 6 + 2 * 5);
  const SplitMesh split = cut(blocks(), "{bed: {blocks: all}, bonds: {every_face: all}}");
  EXPECT_EQ(split.cuts[0].opened, 6 + 2 * 2) << "borders belong to the joint before";
  EXPECT_EQ(split.bodies, 24);
  EXPECT_NE(errorOf(blocks(), "{bonds: {every_face: [a, topp]}}")
                .find("names 'topp', which is no block of the mesh. Did you mean 'top'?"),
            std::string::npos);
}

TEST(Split, sideSetsInsideTheMeshOpen)
{
  Mesh mesh = square();
  // Upper sides of the second row, from one side only, and one of them from the other too.
  mesh.sideSets.push_back({7, "crack", {4, 5, 6, 7, 8}, {2, 2, 2, 2, 0}});
  const SplitMesh split = cut(mesh, "{j: {side_sets: crack}}");
  EXPECT_EQ(split.bodies, 2);
  EXPECT_EQ(split.cuts[0].opened, 4);
  EXPECT_EQ(sideSet(split.mesh, "j").id, 8);
  EXPECT_EQ(sideSet(split.mesh, "crack").elements.size(), 5u);
}

TEST(Split, aFaceThatTwoJointsFindBelongsToTheFirst)
{
  const Mesh mesh = square();
  const std::string joints = "{whole: {planes: {point: [2, 0], normal: [1, 0]}}, "
                             "rest: {planes: {point: [2, 0], normal: [1, 0], spacing: 1}}}";
  const SplitMesh split = cut(mesh, joints);
  EXPECT_EQ(split.cuts[0].opened, 4);
  EXPECT_EQ(split.cuts[1].opened, 8);
  const auto selection = selectCuts("joints: " + joints, "cuts.yaml", mesh, facesOf(mesh));
  EXPECT_EQ(selection.notes[0], "joint 'whole': 1 plane, 4 faces");
  EXPECT_EQ(selection.notes[1],
            "joint 'rest': 3 planes, 8 faces; 4 more belong to joints before it");
}

TEST(Split, aNodeSetAcrossAJointKeepsBothSides)
{
  const Mesh mesh = cut(square(), "{h: {planes: {point: [0, 2], normal: [0, 1]}}}").mesh;
  EXPECT_EQ(mesh.nodeSets[0].nodes.size(), 6u);
  for (const Vec3& x : placesOfSet(mesh, 0))
    EXPECT_EQ(x.x, 0);
}

TEST(Split, aNodeSetAlongAJointKeepsItsOwnSide)
{
  // All nodes of the lower half: the copies above the joint do not belong, whichever side is
  // copied.
  for (const bool upper : {false, true})
  {
    Mesh mesh = square();
    mesh.nodeSets = {{1, "half", {}}, {2, "crossing", {12}}, {3, "joint", {10, 11, 12, 13, 14}}};
    for (int node = 0; node < 15; ++node)
      mesh.nodeSets[0].nodes.push_back(upper ? 24 - node : node);
    const Mesh split = cut(mesh, "{h: {planes: {point: [0, 2], normal: [0, 1]}}, "
                                 "v: {planes: {point: [2, 0], normal: [1, 0]}}}")
                           .mesh;
    const auto places = placesOfSet(split, 0);
    // 3 rows of 5 nodes, and the middle one of each row twice.
    EXPECT_EQ(places.size(), 18u);
    std::set<int> own;
    for (int e = upper ? 8 : 0; e < (upper ? 16 : 8); ++e)
      for (int k = 0; k < 4; ++k)
        own.insert(split.blocks[0].connectivity[4 * e + k]);
    for (const int node : split.nodeSets[0].nodes)
      EXPECT_EQ(own.count(node), 1u) << node;
    // A set that says nothing about sides has all copies: 4 at the crossing, 2 at the others.
    EXPECT_EQ(split.nodeSets[1].nodes.size(), 4u);
    EXPECT_EQ(split.nodeSets[2].nodes.size(), 4u + 4u * 2u);
  }
}

TEST(Split, theFileHasTheSplitMesh)
{
  const SplitMesh split =
      cut(cube(", split: tetrahedra"),
          "{bedding: {planes: {point: [0, 0, 0], normal: [0, 0, 1], spacing: 1}}}");
  const TestFolder folder(Comm::alone());
  const std::string file = folder / "split.e";
  writeMesh(split.mesh, file);
  const Mesh read = readMesh(file);
  EXPECT_EQ(read.nodeIds, split.mesh.nodeIds);
  EXPECT_EQ(read.blocks[0].connectivity, split.mesh.blocks[0].connectivity);
  EXPECT_EQ(read.blocks[0].bodyIds, split.mesh.blocks[0].bodyIds);
  EXPECT_EQ(read.sideSets[0].name, "bedding");
  EXPECT_EQ(read.sideSets[0].elements, split.mesh.sideSets[0].elements);
  EXPECT_EQ(read.sideSets[0].sides, split.mesh.sideSets[0].sides);
  EXPECT_EQ(reportMesh(read).bodies, 4);
}

TEST(Split, planesCloserThanTheToleranceAreRefused)
{
  const std::string error =
      errorOf(square(), "{j: {planes: {point: [0, 0], normal: [0, 1], spacing: 1e-6}}}");
  EXPECT_NE(error.find("planes.tolerance = 5.66e-06 m must be less than half the spacing = 5e-07 m "
                       "(by default it is 1e-6 of the mesh size)"),
            std::string::npos)
      << error;
  EXPECT_NE(errorOf(square(), "{j: {planes: []}}"), "no error");
}

TEST(Split, mistakesAreNamedWithTheirPlace)
{
  const Mesh mesh = square();
  EXPECT_EQ(
      errorOf(mesh, "{j: {planes: {point: [2.5, 0], normal: [1, 0]}}}"),
      "cuts.yaml:1:30: joints.j.planes.point and normal find no interior face of an element "
      "within tolerance = 5.66e-06 m and angle. The cut follows element faces: mesh with faces "
      "on the plane, or allow more distance and angle.");
  EXPECT_EQ(errorOf(mesh, "{j: {planes: {point: [4, 0], normal: [1, 0]}}}"),
            "cuts.yaml:1:30: joints.j.planes.point and normal find no interior face of an element "
            "within tolerance = 5.66e-06 m and angle. 4 exterior faces lie there, which are apart "
            "already. The cut follows element faces: mesh with faces on the plane, or allow more "
            "distance and angle.");
  EXPECT_EQ(
      errorOf(mesh, "{j: {planes: {point: [2, 0], normal: [1, 0], spacing: 1, count: 3}}}"),
      "cuts.yaml:1:73: joints.j.planes.count = 3, but plane 3 of them, at distance 2 m, finds "
      "no interior face. Leave count away for all planes that do.");
  EXPECT_EQ(errorOf(mesh, "{j: {planes: {point: [2, 0], normal: [0, 0]}}}"),
            "cuts.yaml:1:46: joints.j.planes.normal = a list of 2 without direction; accepted: a "
            "list of 2 numbers, not all zero [-].");
  EXPECT_EQ(
      errorOf(mesh, "{j: {plane: {point: [2, 0], normal: [0, 0]}}}"),
      "cuts.yaml:1:13: joints.j needs one of the keys planes, blocks, side_sets, every_face.\n"
      "cuts.yaml:1:14: joints.j.plane is not known. Did you mean 'planes'? Accepted here: "
      "planes, blocks, side_sets, every_face.");
  EXPECT_EQ(errorOf(mesh, "{j: {blocks: all}}"),
            "cuts.yaml:1:22: joints.j.blocks = all, but no two "
            "blocks of the mesh have a face in common.");
  EXPECT_EQ(errorOf(mesh, "{j: {side_sets: tap}}"),
            "cuts.yaml:1:25: joints.j.side_sets names 'tap', which is no side set of the mesh. Did "
            "you mean 'top'?");
  EXPECT_EQ(errorOf(mesh, "{j: {side_sets: top}}"),
            "cuts.yaml:1:25: joints.j.side_sets 'top' has no interior face: all 4 are on the "
            "surface, which is apart already.");
  EXPECT_EQ(errorOf(mesh, "{top: {planes: {point: [2, 0], normal: [1, 0]}}}"),
            "cuts.yaml:1:15: joints.top is the name of a side set of the mesh already, and the "
            "joint writes one; name the joint otherwise.");
  EXPECT_EQ(errorOf(blocks(), "{j: {blocks: [[a, c]]}}"),
            "cuts.yaml:1:22: joints.j.blocks 'a' and 'c' have no face in common.");
  EXPECT_EQ(errorOf(blocks(), "{j: {blocks: [[a, tap]]}}"),
            "cuts.yaml:1:22: joints.j.blocks names 'tap', which is no block of the mesh. Did you "
            "mean 'top'?");
}

TEST(Split, allProblemsAreToldAtOnce)
{
  EXPECT_EQ(
      errorOf(square(), "{i: {side_sets: tap}, j: {planes: {point: [2.5, 0, 1], count: 2, "
                        "normal: [1, 0]}}, k: {blocks: every}, l: {}}"),
      "cuts.yaml:1:51: joints.j.planes.point = a list of 3; accepted: a list of 2 numbers "
      "[m].\n"
      "cuts.yaml:1:104: joints.k.blocks = 'every'; accepted: all or a list of lists of 2 "
      "names.\n"
      "cuts.yaml:1:115: joints.l needs one of the keys planes, blocks, side_sets, every_face.");
  EXPECT_EQ(errorOf(square(), "{i: {side_sets: tap}, j: {blocks: [[rok, rock]]}}"),
            "cuts.yaml:1:25: joints.i.side_sets names 'tap', which is no side set of the mesh. Did "
            "you mean 'top'?\n"
            "cuts.yaml:1:43: joints.j.blocks names 'rok', which is no block of the mesh. Did you "
            "mean 'rock'?");
}
} // namespace coplane
