#include "AbaqusFile.hpp"
#include "ConvertGmsh.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_exodus/MeshReport.hpp>

#include <gtest/gtest.h>

#include <TestFolder.hpp>
#include <algorithm>

namespace coplane
{
namespace
{
Mesh meshOf(const std::string& text, std::vector<std::string>* notes = nullptr)
{
  const TestFolder folder(Comm::alone());
  const std::string file = folder / "model.inp";
  std::ofstream(file) << text;
  const AbaqusFile read = readAbaqusFile(file);
  if (notes)
    *notes = read.notes;
  return convertGmsh(read.mesh, "model.inp").mesh;
}

std::string abaqusErrorOf(const std::string& text)
{
  try
  {
    meshOf(text);
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Mesh);
    return error.what();
  }
  return "accepted";
}

/// Two cubes along x, with the nodes 1 to 12.
const std::string twoCubes =
    "*HEADING\ntwo cubes\n** a comment\n*Node, nset=ALL\n"
    "1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1., "
    "1.0E0\n9, 2, 0, 0\n10, 2, 1, 0\n11, 2, 0, 1\n12, 2, 1, 1\n"
    "*Element, type=C3D8R,\n elset=left\n1, 1, 2, 3, 4,\n 5, 6, 7, 8\n"
    "*ELEMENT, TYPE=C3D8, ELSET=right\n2, 2, 9, 10, 3, 6, 11, 12, 7\n";

TEST(Abaqus, setsOfElementsAreBlocks)
{
  const Mesh mesh = meshOf(twoCubes);
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[0].name, "left");
  EXPECT_EQ(mesh.blocks[1].name, "right");
  EXPECT_EQ(mesh.nodes(), 12);
  const MeshReport report = reportMesh(mesh);
  EXPECT_EQ(report.bodies, 1);
  EXPECT_NEAR(report.blocks[0].volume, 1, 1e-15);
  ASSERT_EQ(mesh.nodeSets.size(), 1u);
  EXPECT_EQ(mesh.nodeSets[0].name, "ALL");
  EXPECT_EQ(mesh.nodeSets[0].nodes.size(), 12u);
}

TEST(Abaqus, sectionsAreBlocksWhereThereAreSome)
{
  std::vector<std::string> notes;
  const Mesh mesh = meshOf(twoCubes + "*ELSET, ELSET=whole, GENERATE\n1, 2\n*SOLID SECTION, "
                                      "ELSET=whole, MATERIAL=steel\n1.0\n",
                           &notes);
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].name, "whole");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("left, right"), std::string::npos) << notes[0];
}

/// Every face of every shape: its outward normal shows that it is the one that Abaqus means.
TEST(Abaqus, facesOfSurfacesAreThoseOfTheManual)
{
  std::string surfaces;
  for (int face = 1; face <= 6; ++face)
    surfaces += fmt::format("*SURFACE, NAME=s{0}\n1, S{0}\n", face);
  const Mesh mesh = meshOf(twoCubes + surfaces + "*NSET, NSET=base\n1, 2, 3, 4\n");
  ASSERT_EQ(mesh.sideSets.size(), 6u);
  // S1: nodes 1-2-3-4 below, S2: 5-8-7-6 above, S3: 1-5-6-2, S4: 2-6-7-3, S5: 3-7-8-4, S6: 4-8-5-1.
  const std::vector<std::vector<int>> nodes{{1, 2, 3, 4}, {5, 6, 7, 8}, {1, 2, 5, 6},
                                            {2, 3, 6, 7}, {3, 4, 7, 8}, {1, 4, 5, 8}};
  for (int face = 0; face < 6; ++face)
  {
    const Mesh::SideSet& set = mesh.sideSets[std::size_t(face)];
    EXPECT_EQ(set.name, fmt::format("s{}", face + 1));
    // S4 is between the cubes and counts from both sides.
    ASSERT_EQ(set.elements.size(), face == 3 ? 2u : 1u);
    const ElementTopology& hex = topology(ElementType::Hex8);
    std::vector<int> found;
    for (int k = 0; k < 4; ++k)
      found.push_back(mesh.blocks[0].connectivity[std::size_t(hex.sideNodes[set.sides[0]][k])] + 1);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, nodes[std::size_t(face)]) << face;
  }
}

TEST(Abaqus, planeShapesAndSurfacesOfSetsAreRead)
{
  const Mesh mesh =
      meshOf("*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n5,2,0\n*ELEMENT,TYPE=CPE4R,ELSET=a\n"
             "1,1,2,3,4\n*ELEMENT,TYPE=CPS3,ELSET=b\n7,2,5,3\n*ELSET,ELSET=both\nA,b\n"
             "*SURFACE,NAME=floor,TYPE=ELEMENT\nBOTH,S1\n*SURFACE,NAME=tip,TYPE=NODE\n"
             "5\n");
  EXPECT_EQ(mesh.dimension, 2);
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[1].type, ElementType::Tri3);
  ASSERT_EQ(mesh.sideSets.size(), 1u);
  EXPECT_EQ(mesh.sideSets[0].elements.size(), 2u);
  const auto tip = std::find_if(mesh.nodeSets.begin(), mesh.nodeSets.end(),
                                [](const Mesh::NodeSet& set) { return set.name == "tip"; });
  ASSERT_NE(tip, mesh.nodeSets.end());
  EXPECT_EQ(tip->nodes.size(), 1u);
}

TEST(Abaqus, namesAndNumbersAreReadAsTheManualHasThem)
{
  const std::string node = "\xEF\xBB\xBF*NODE\n1\n2,1.D0\n3,,1\n4,,,1,0,0,1\n";
  const Mesh mesh = meshOf(node + "*ELEMENT, TYPE=T3D2, ELSET=Line1\n1,1,2\n"
                                  "*ELEMENT, TYPE=C3D4, ELSET=\"left, half\"\n2,1,2,3,4\n"
                                  "*NSET, NSET=all, ELSET=\"left, half\"\n"
                                  "*NSET, NSET=some\nP-1.2, P-1.3,\n*NSET, NSET=same\nP-1.some\n");
  EXPECT_EQ(mesh.coordinates[1].x, 1);
  EXPECT_EQ(mesh.coordinates[3].z, 1);
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].name, "left, half");
  ASSERT_EQ(mesh.nodeSets.size(), 3u);
  EXPECT_EQ(mesh.nodeSets[0].nodes.size(), 4u);
  EXPECT_EQ(mesh.nodeSets[1].nodes, (std::vector<int>{1, 2}));
  EXPECT_EQ(mesh.nodeSets[2].nodes, (std::vector<int>{1, 2}));
}

/// Gmsh writes the surfaces of a model as plane elements with the lower numbers.
TEST(Abaqus, surfacesAreThoseOfSolidsWherePlaneElementsStandBefore)
{
  const Mesh mesh = meshOf("*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT, TYPE=CPS3, "
                           "ELSET=s\n1,1,2,3\n*ELEMENT, TYPE=C3D4, ELSET=v\n2,1,2,3,4\n"
                           "*SURFACE, NAME=top\n2, S3\n*NSET, NSET=top\n4\n");
  ASSERT_EQ(mesh.sideSets.size(), 1u);
  EXPECT_EQ(mesh.sideSets[0].elements.size(), 1u);
  ASSERT_EQ(mesh.nodeSets.size(), 2u); // a set of nodes is not mixed with that of a surface
  EXPECT_EQ(mesh.nodeSets[1].name, "top_nodes");
  EXPECT_EQ(mesh.nodeSets[1].nodes, (std::vector<int>{3}));
}

TEST(Abaqus, planeElementsHaveNoHeight)
{
  const Mesh mesh = meshOf("*NODE\n1,0,0,5\n2,1,0,5\n3,0,1,5\n*ELEMENT, TYPE=CPE3, "
                           "ELSET=s\n1,1,2,3\n");
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_EQ(mesh.coordinates[2].z, 0);
}

TEST(Abaqus, isRefusedInClearWords)
{
  const auto contains = [](const std::string& text, const std::string& part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  const std::string node = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n";
  contains(abaqusErrorOf(node + "*ELEMENT, TYPE=C3D10\n1,1,2,3,4\n"),
           ":6: elements of type 'C3D10'");
  contains(abaqusErrorOf(node + "*ELEMENT, TYPE=CPE8\n"), "Accepted: first-order");
  contains(abaqusErrorOf(node + "*ELEMENT, TYPE=C3D4\n1,1,2,3\n*NSET, NSET=a\n1\n"),
           ":8: element 1 has 3 nodes; its type has 4");
  contains(abaqusErrorOf(node + "*ELEMENT, TYPE=C3D4\n1,1,2,3,4,2\n"), ":7: element 1 has 5 nodes");
  contains(abaqusErrorOf(node + "*ELEMENT, TYPE=C3D4\n1,1,2,3,9\n"), "element 1 names node 9");
  contains(abaqusErrorOf(node + "1,0,0,0\n"), ":6: node 1 is given twice");
  contains(abaqusErrorOf("*NODE\n1,x,0\n"), ":2: 'x' is found for a coordinate");
  contains(abaqusErrorOf("*NODE\n1.5,0,0\n"), ":2: '1.5' is found for the number");
  for (const char* const maker : {"*NGEN", "*NFILL", "*NCOPY", "*ELGEN", "*ELCOPY", "*SYSTEM"})
    contains(abaqusErrorOf(node + maker + "\n1, 2, 3\n"), fmt::format(":6: {} is not read", maker));
  contains(abaqusErrorOf("*NODE, INPUT=nodes.txt\n"), ":1: INPUT is not followed");
  contains(abaqusErrorOf("*NODE, SYSTEM=C\n"), "system C");
  contains(abaqusErrorOf(node + "*INSTANCE, NAME=A, PART=P\n*INSTANCE, NAME=B, PART=P\n"),
           ":7: a second instance");
  contains(abaqusErrorOf(node + "*NSET, NSET=a, GENERATE\n1\n"), ":7: GENERATE has lines of");
  contains(abaqusErrorOf(node + "*NSET, NSET=a, GENERATE\n1, 4000000000\n"),
           ":7: GENERATE goes from 1");
  contains(abaqusErrorOf(node + "*NSET, NSET=a\nb\n"), ":7: 'b' is no number, and no set");
  contains(abaqusErrorOf(node + "*NSET\n1\n"), ":6: *NSET has no name");
  contains(abaqusErrorOf(node + "*NSET, NSET=a, ELSET=b\n"), ":6: ELSET names 'b'");
  contains(abaqusErrorOf("*NODE\n1,nan,0\n"), ":2: 'nan' is found");
  contains(abaqusErrorOf("*INCLUDE, INPUT=mesh.inp\n"), ":1: *INCLUDE is not followed");
  contains(abaqusErrorOf("1, 2, 3\n"), ":1: the file does not begin with a keyword");
  contains(abaqusErrorOf("*NODE\n1,0,0\n"), "has no elements");
  const std::string whole = node + "*ELEMENT, TYPE=C3D4\n1,1,2,3,4\n";
  contains(abaqusErrorOf(whole + "*SURFACE, NAME=s\n1, S5\n"), "S5 of element 1, which has 4");
  contains(abaqusErrorOf(whole + "*SURFACE, NAME=s\n1, SPOS\n"),
           ":9: a surface is a set or an element");
  contains(abaqusErrorOf(whole + "*SURFACE, NAME=s\nnone, S1\n"), "names 'none', which is neither");
  contains(abaqusErrorOf(whole + "*NSET, NSET=s\n8\n"), "the set 's' names node 8");
  contains(abaqusErrorOf(whole + "*SOLID SECTION, ELSET=e\n"), "names the element set 'e'");
}
} // namespace
} // namespace coplane
