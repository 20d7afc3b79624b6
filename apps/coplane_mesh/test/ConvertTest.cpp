#include "ConvertGmsh.hpp"
#include "MeshFaces.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_exodus/MeshReport.hpp>

#include <gtest/gtest.h>

#include <TestFolder.hpp>
#include <algorithm>

namespace coplane
{
namespace
{
const std::string format = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";

ConvertedMesh converted(const std::string& text)
{
  const TestFolder folder(Comm::alone());
  const std::string file = folder / "coplane_convert.msh";
  std::ofstream(file) << text;
  return convertGmsh(readGmshFile(file), "model.msh");
}

/// The text of the error, without the folder of the test.
std::string convertErrorOf(const std::string& text)
{
  try
  {
    converted(text);
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Mesh);
    std::string what = error.what();
    if (const std::size_t at = what.find("coplane_convert.msh"); at != std::string::npos)
      what = "model.msh" + what.substr(at + std::string("coplane_convert.msh").size());
    return what;
  }
  return "no error";
}

/// Two triangles and a quadrilateral in one surface; the border on the left is a group, and so is
/// the line between the shapes, and a point.
///     4----3----6
///     | \  |    |
///     |  \ |    |      node 9 belongs to no element
///     1----2----5
std::string plate(const std::string& names, const std::string& entities, const std::string& height)
{
  return format + "$PhysicalNames\n" + names + "$EndPhysicalNames\n$Entities\n" + entities +
         "$EndEntities\n$Nodes\n1 7 1 9\n2 1 0 7\n1\n2\n3\n4\n5\n6\n9\n0 0 " + height +
         "\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n2 1 0\n7 7 0\n$EndNodes\n"
         "$Elements\n5 6 1 16\n"
         "0 1 15 1\n11 1\n"
         "1 1 1 1\n12 4 1\n"
         "1 2 1 1\n13 2 3\n"
         "2 1 2 2\n14 1 2 4\n15 2 4 3\n" // the second is inside out
         "2 1 3 1\n16 2 5 6 3\n$EndElements\n";
}
const std::string plateNames = "4\n0 7 \"corner\"\n1 1 \"left\"\n1 2 \"middle\"\n2 5 \"plate\"\n";
const std::string plateEntities =
    "1 2 1 0\n1 0 0 0 1 7\n1 0 0 0 0 1 0 1 1 2 4 1\n2 1 0 0 1 1 0 1 2 0\n"
    "1 0 0 0 2 1 0 1 5 2 1 2\n";

std::vector<Vec3> placesOf(const Mesh& mesh, const Mesh::NodeSet& set)
{
  std::vector<Vec3> places;
  for (const int node : set.nodes)
    places.push_back(mesh.coordinates[node]);
  return places;
}

/// One hexahedron of side 1 with the given order of its nodes 1 to 8.
std::string cube(const std::string& order)
{
  return format +
         "$Nodes\n1 8 1 8\n3 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 "
         "1\n1 0 1\n1 1 1\n0 1 1\n$EndNodes\n$Elements\n1 1 1 1\n3 4 5 1\n1 " +
         order + "\n$EndElements\n";
}
} // namespace

TEST(Convert, groupsBecomeBlocksAndSets)
{
  const ConvertedMesh result = converted(plate(plateNames, plateEntities, "0"));
  const Mesh& mesh = result.mesh;
  EXPECT_EQ(mesh.dimension, 2);
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[0].name, "plate_tri3");
  EXPECT_EQ(mesh.blocks[1].name, "plate_quad4");
  EXPECT_EQ(mesh.blocks[0].elementIds, (std::vector<GlobalId>{14, 15}));
  EXPECT_EQ(mesh.nodeIds, (std::vector<GlobalId>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(mesh.blocks[1].bodyIds, std::vector<int>{1});
  const MeshReport report = reportMesh(mesh);
  EXPECT_EQ(report.blocks[0].volume, 1);
  EXPECT_EQ(report.blocks[1].volume, 1);
  EXPECT_TRUE(meshProblems(report).empty());
  // A border on the surface has one side, a line between two elements both.
  ASSERT_EQ(mesh.sideSets.size(), 2u);
  EXPECT_EQ(mesh.sideSets[0].name, "left");
  EXPECT_EQ(mesh.sideSets[0].elements, std::vector<int>{0});
  EXPECT_EQ(mesh.sideSets[0].sides, std::vector<int>{2}); // from 4 to 1
  EXPECT_EQ(mesh.sideSets[1].name, "middle");
  EXPECT_EQ(mesh.sideSets[1].elements, (std::vector<int>{1, 2}));
  ASSERT_EQ(mesh.nodeSets.size(), 3u);
  EXPECT_EQ(mesh.nodeSets[0].name, "left");
  for (const Vec3& x : placesOf(mesh, mesh.nodeSets[0]))
    EXPECT_EQ(x.x, 0);
  EXPECT_EQ(mesh.nodeSets[1].nodes.size(), 2u);
  EXPECT_EQ(mesh.nodeSets[2].name, "corner");
  EXPECT_EQ(mesh.nodeSets[2].nodes, std::vector<int>{0});
  EXPECT_EQ(result.notes,
            (std::vector<std::string>{"1 nodes belong to no element and are left out",
                                      "1 elements were inside out and have been turned"}));
}

TEST(Convert, groupsWithoutNamesAreCalledByTheirNumbers)
{
  const Mesh mesh = converted(plate("0\n", plateEntities, "0")).mesh;
  EXPECT_EQ(mesh.blocks[0].name, "block_5_tri3");
  EXPECT_EQ(mesh.sideSets[0].name, "surface_1");
  EXPECT_EQ(mesh.nodeSets[2].name, "nodelist_7");
}

TEST(Convert, groupsOfOneNameShareASet)
{
  const Mesh mesh = converted(plate("4\n0 7 \"left\"\n1 1 \"left\"\n1 2 \"left\"\n2 5 \"plate\"\n",
                                    plateEntities, "0"))
                        .mesh;
  ASSERT_EQ(mesh.sideSets.size(), 1u);
  EXPECT_EQ(mesh.sideSets[0].elements, (std::vector<int>{0, 1, 2}));
  ASSERT_EQ(mesh.nodeSets.size(), 1u);
  EXPECT_EQ(mesh.nodeSets[0].nodes, (std::vector<int>{0, 1, 2, 3}));
}

TEST(Convert, withoutGroupsEverySurfaceIsABlock)
{
  const ConvertedMesh result = converted(plate("0\n", "0 0 1 0\n1 0 0 0 2 1 0 0 0\n", "0"));
  EXPECT_EQ(result.mesh.blocks[0].name, "block_1_tri3");
  EXPECT_TRUE(result.mesh.sideSets.empty());
}

TEST(Convert, aHexahedronWhicheverWayUpHasPositiveVolume)
{
  for (const std::string order : {"1 2 3 4 5 6 7 8", "5 6 7 8 1 2 3 4", "1 4 3 2 5 8 7 6"})
  {
    const ConvertedMesh result = converted(cube(order));
    EXPECT_EQ(result.mesh.dimension, 3);
    EXPECT_EQ(result.mesh.blocks[0].name, "block_4");
    EXPECT_NEAR(reportMesh(result.mesh).blocks[0].volume, 1, 1e-15) << order;
    EXPECT_EQ(result.notes.size(), order[0] == '1' && order[2] == '2' ? 0u : 1u) << order;
  }
}

TEST(Convert, aTetrahedronInsideOutIsTurned)
{
  const std::string head = format +
                           "$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 "
                           "1\n$EndNodes\n$Elements\n1 1 1 1\n3 1 4 1\n1 ";
  for (const std::string order : {"1 2 3 4", "2 1 3 4"})
    EXPECT_NEAR(reportMesh(converted(head + order + "\n$EndElements\n").mesh).blocks[0].volume,
                1.0 / 6, 1e-15);
}

TEST(Convert, textAndBinaryFilesOfGmshGiveTheSameMesh)
{
  // Written by Gmsh 4.8.4 from two_regions.geo; the surface "lining" looks down.
  const std::string folder = COPLANE_GMSH_FILES;
  const ConvertedMesh text =
      convertGmsh(readGmshFile(folder + "/two_regions.msh"), "two_regions.msh");
  const ConvertedMesh binary =
      convertGmsh(readGmshFile(folder + "/two_regions_binary.msh"), "two_regions_binary.msh");
  const MeshReport report = reportMesh(text.mesh);
  EXPECT_EQ(report.blocks[0].name, "rock");
  EXPECT_EQ(report.blocks[1].name, "lining");
  EXPECT_NEAR(report.blocks[0].volume, 1, 1e-14);
  EXPECT_NEAR(report.blocks[1].volume, 1, 1e-14);
  EXPECT_TRUE(meshProblems(report).empty());
  EXPECT_EQ(text.mesh.sideSets[0].name, "border");
  EXPECT_EQ(text.mesh.sideSets[0].elements.size(), 4u); // two lines, both sides
  EXPECT_EQ(text.mesh.sideSets[1].elements.size(), 2u);
  EXPECT_EQ(text.mesh.nodeSets[2].name, "corner");
  EXPECT_EQ(text.notes, binary.notes);
  ASSERT_EQ(text.mesh.nodes(), binary.mesh.nodes());
  EXPECT_EQ(text.mesh.nodeIds, binary.mesh.nodeIds);
  for (int node = 0; node < text.mesh.nodes(); ++node) // text has 16 digits
    EXPECT_NEAR(norm(text.mesh.coordinates[node] - binary.mesh.coordinates[node]), 0, 1e-15);
  for (int b = 0; b < 2; ++b)
    EXPECT_EQ(text.mesh.blocks[b].connectivity, binary.mesh.blocks[b].connectivity);
  for (int s = 0; s < 2; ++s)
  {
    EXPECT_EQ(text.mesh.sideSets[s].elements, binary.mesh.sideSets[s].elements);
    EXPECT_EQ(text.mesh.sideSets[s].sides, binary.mesh.sideSets[s].sides);
  }
}

TEST(Convert, aPlaneMeshOutsideZZeroIsRefused)
{
  EXPECT_EQ(
      convertErrorOf(plate(plateNames, plateEntities, "0.5")),
      "model.msh: the mesh has no volume elements, and node 1 is at z = 0.5 m; a mesh of two "
      "dimensions lies in z = 0. Move or turn the model, or add the volumes to a physical group "
      "and mesh in three dimensions.");
}

TEST(Convert, elementsInTwoGroupsAreRefused)
{
  EXPECT_EQ(
      convertErrorOf(
          plate("2\n2 5 \"plate\"\n2 6 \"other\"\n", "0 0 1 0\n1 0 0 0 2 1 0 2 5 6 0\n", "0")),
      "model.msh: surface 1 is in the physical groups 'plate' and 'other'; an element belongs "
      "to one block. Take it out of one of them.");
}

TEST(Convert, otherVersionsSayHowToExport)
{
  const std::string advice =
      " Save it as version 4.1: gmsh model.geo -3 -format msh41 (two dimensions: -2), or File > "
      "Export with 'Version 4 ASCII'.";
  EXPECT_EQ(convertErrorOf("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"),
            "model.msh: the format is version 2.2; 4.1 is accepted." + advice);
  EXPECT_EQ(convertErrorOf("$NOD\n1\n"),
            "model.msh: the file does not begin with $MeshFormat: it is no mesh of Gmsh, or older "
            "than version 2." +
                advice);
}

TEST(Convert, otherElementsAreRefused)
{
  const std::string head = format + "$Nodes\n0 0 0 0\n$EndNodes\n$Elements\n1 1 1 1\n3 4 ";
  EXPECT_EQ(
      convertErrorOf(head + "6 1\n"),
      "model.msh: volume 4 has prisms; triangles, quadrilaterals, tetrahedra and hexahedra are "
      "accepted. Mesh it with tetrahedra, or with hexahedra only.");
  EXPECT_EQ(
      convertErrorOf(head + "11 1\n"),
      "model.msh: volume 4 has elements of Gmsh's type 11, of order two or higher; order one is "
      "accepted. Set Mesh.ElementOrder = 1 and mesh again.");
}

TEST(Convert, aDamagedFileIsNamedWithItsLine)
{
  std::string text = cube("1 2 3 4 5 6 7 8");
  EXPECT_EQ(
      convertErrorOf(cube("1 2 3 4 5 6 7 9")),
      "model.msh:27: element 1 uses node 9, which the file does not have. The file is damaged "
      "or no Gmsh mesh; save it again.");
  EXPECT_EQ(convertErrorOf(cube("1 2 3 four")),
            "model.msh:27: 'four' is found for a node of an element, which is a whole number. The "
            "file is damaged or no Gmsh mesh; save it again.");
  EXPECT_EQ(
      convertErrorOf(text.substr(0, text.find("$EndNodes"))),
      "model.msh:22: $EndNodes is missing. The file is damaged or no Gmsh mesh; save it again.");
  EXPECT_EQ(convertErrorOf(format),
            "model.msh:4: $Elements is missing. The file is damaged or no Gmsh mesh; "
            "save it again.");
}

TEST(Convert, aModelWithoutSurfacesIsRefused)
{
  EXPECT_EQ(
      convertErrorOf(format +
                     "$Nodes\n1 1 1 1\n0 1 0 1\n1\n0 0 0\n$EndNodes\n$Elements\n1 1 1 1\n0 1 "
                     "15 1\n1 1\n$EndElements\n"),
      "model.msh: the file has no elements of a surface or a volume. Mesh the model in two or "
      "three dimensions, and put what shall be saved into physical groups.");
}

TEST(Convert, whatIsInNoGroupIsLeftOut)
{
  // Surface 2 has the quadrilateral and is in no group.
  std::string text =
      plate("1\n2 5 \"plate\"\n", "0 0 2 0\n1 0 0 0 1 1 0 1 5 0\n2 1 0 0 2 1 0 0 0\n", "0");
  text.replace(text.find("2 1 3 1\n16"), 7, "2 2 3 1");
  const ConvertedMesh result = converted(text);
  EXPECT_EQ(result.mesh.elements(), 2);
  EXPECT_EQ(result.mesh.nodes(), 4);
  EXPECT_EQ(result.mesh.blocks[0].name, "plate");
  EXPECT_EQ(result.notes[0], "1 elements are in no physical group and are left out");
  EXPECT_EQ(result.notes[1], "3 nodes belong to no element and are left out");
}
} // namespace coplane
