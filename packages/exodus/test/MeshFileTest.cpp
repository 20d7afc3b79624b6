#include "SampleMeshes.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_exodus/ReadMesh.hpp>
#include <coplane_exodus/WriteMesh.hpp>
#include <coplane_exodus/detail/FileProbe.hpp>

#include <exodusII.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numeric>
#include <tuple>

namespace coplane
{
namespace
{
/// These files concern one process: each rank uses a file of its own.
std::string ownFile(const std::string& name)
{
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return temporaryFile(std::to_string(rank) + "_" + name);
}

void expectSame(const Mesh& a, const Mesh& b)
{
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.dimension, b.dimension);
  EXPECT_EQ(a.nodeIds, b.nodeIds);
  ASSERT_EQ(a.coordinates.size(), b.coordinates.size());
  for (std::size_t i = 0; i < a.coordinates.size(); ++i)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(a.coordinates[i][k], b.coordinates[i][k]);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t i = 0; i < a.blocks.size(); ++i)
  {
    EXPECT_EQ(a.blocks[i].id, b.blocks[i].id);
    EXPECT_EQ(a.blocks[i].name, b.blocks[i].name);
    EXPECT_EQ(a.blocks[i].type, b.blocks[i].type);
    EXPECT_EQ(a.blocks[i].elementIds, b.blocks[i].elementIds);
    EXPECT_EQ(a.blocks[i].connectivity, b.blocks[i].connectivity);
    EXPECT_EQ(a.blocks[i].bodyIds, b.blocks[i].bodyIds);
  }
  ASSERT_EQ(a.nodeSets.size(), b.nodeSets.size());
  for (std::size_t i = 0; i < a.nodeSets.size(); ++i)
  {
    EXPECT_EQ(a.nodeSets[i].id, b.nodeSets[i].id);
    EXPECT_EQ(a.nodeSets[i].name, b.nodeSets[i].name);
    EXPECT_EQ(a.nodeSets[i].nodes, b.nodeSets[i].nodes);
  }
  ASSERT_EQ(a.sideSets.size(), b.sideSets.size());
  for (std::size_t i = 0; i < a.sideSets.size(); ++i)
  {
    EXPECT_EQ(a.sideSets[i].id, b.sideSets[i].id);
    EXPECT_EQ(a.sideSets[i].name, b.sideSets[i].name);
    EXPECT_EQ(a.sideSets[i].elements, b.sideSets[i].elements);
    EXPECT_EQ(a.sideSets[i].sides, b.sideSets[i].sides);
  }
  EXPECT_EQ(a.qaRecords, b.qaRecords);
}

Mesh writtenAndRead(const Mesh& mesh, const std::string& name)
{
  const std::string file = ownFile(name);
  writeMesh(mesh, file);
  Mesh read = readMesh(file);
  std::filesystem::remove(file);
  return read;
}

/// Text of the error, and that it is one of the mesh.
template <class Action>
std::string errorOf(const Action& action, ExitCode code = ExitCode::Mesh)
{
  try
  {
    action();
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), code);
    return error.what();
  }
  return "no error";
}

std::string readError(const Mesh& mesh, const std::string& name)
{
  const std::string text = errorOf([&] { writtenAndRead(mesh, name); });
  std::filesystem::remove(ownFile(name));
  return text;
}

bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

/// One block of one element of any type name.
std::string fileWithElementType(const std::string& type, int nodes, int dimension)
{
  const std::string file = ownFile("type.e");
  int word = 8, fileWord = 8;
  const int exoid = ex_create(file.c_str(), EX_CLOBBER, &word, &fileWord);
  ex_put_init(exoid, "types", dimension, nodes, 1, 1, 0, 0);
  // A unit square, or cube, as far as the nodes go.
  const double x[] = {0, 1, 1, 0, 0, 1, 1, 0}, y[] = {0, 0, 1, 1, 0, 0, 1, 1},
               z[] = {0, 0, 0, 0, 1, 1, 1, 1};
  ex_put_coord(exoid, x, y, z);
  ex_put_block(exoid, EX_ELEM_BLOCK, 12, type.c_str(), 1, nodes, 0, 0, 0);
  const int connectivity[] = {1, 2, 3, 4, 5, 6, 7, 8};
  ex_put_conn(exoid, EX_ELEM_BLOCK, 12, connectivity, nullptr, nullptr);
  ex_close(exoid);
  return file;
}
} // namespace

TEST(MeshFile, aMeshOfQuadrilateralsComesBackAsItWas)
{
  expectSame(writtenAndRead(sampleMesh2d(), "quads.e"), sampleMesh2d());
}

TEST(MeshFile, aMeshOfHexahedraComesBackAsItWas)
{
  expectSame(writtenAndRead(sampleMesh3d(), "hexes.e"), sampleMesh3d());
}

TEST(MeshFile, idsBeyond32BitsComeBack)
{
  Mesh mesh = sampleMesh2d();
  mesh.nodeIds[0] = 5000000000;
  mesh.blocks[0].elementIds[1] = 6000000000;
  expectSame(writtenAndRead(mesh, "wide.e"), mesh);
}

TEST(MeshFile, namesOfMoreThan32CharactersComeBack)
{
  Mesh mesh = sampleMesh2d();
  mesh.blocks[0].name = "the_left_wall_of_the_northern_tower_of_the_castle";
  expectSame(writtenAndRead(mesh, "names.e"), mesh);
}

TEST(MeshFile, unnamedBlocksAndSetsGetNamesFromTheirIds)
{
  Mesh mesh = sampleMesh2d();
  mesh.blocks[0].name = mesh.nodeSets[0].name = mesh.sideSets[0].name = "";
  const Mesh read = writtenAndRead(mesh, "unnamed.e");
  EXPECT_EQ(read.blocks[0].name, "block_5");
  EXPECT_EQ(read.nodeSets[0].name, "nodelist_4");
  EXPECT_EQ(read.sideSets[0].name, "surface_6");
}

TEST(MeshFile, elementTypesAreKnownInAnyCaseAndWithoutNumber)
{
  for (const char* type : {"QUAD", "quad4", "Quad"})
    EXPECT_EQ(readMesh(fileWithElementType(type, 4, 2)).blocks[0].type, ElementType::Quad4) << type;
  for (const char* type : {"TRI", "tri3", "Triangle"})
    EXPECT_EQ(readMesh(fileWithElementType(type, 3, 2)).blocks[0].type, ElementType::Tri3) << type;
  for (const char* type : {"TETRA", "tet4", "TETRA4", "tet"})
    EXPECT_EQ(readMesh(fileWithElementType(type, 4, 3)).blocks[0].type, ElementType::Tet4) << type;
  for (const char* type : {"HEX", "hex8"})
    EXPECT_EQ(readMesh(fileWithElementType(type, 8, 3)).blocks[0].type, ElementType::Hex8) << type;
  std::filesystem::remove(ownFile("type.e"));
}

TEST(MeshFile, aMissingFileIsNamed)
{
  EXPECT_TRUE(contains(errorOf([] { readMesh("nowhere.e"); }),
                       "nowhere.e: the mesh file does not exist (looked in '"));
}

TEST(MeshFile, aTextFileIsNotExodus)
{
  const std::string file = ownFile("text.e");
  std::ofstream(file) << "solid cube\n";
  EXPECT_TRUE(
      contains(errorOf([&] { readMesh(file); }), "text.e: the file is not an Exodus II file"));
  std::filesystem::remove(file);
}

TEST(MeshFile, aProbeTellsHowAProgramEnds)
{
  const auto shell = [](const char* command) { return runProgram({"/bin/sh", "-c", command}, 60); };
  EXPECT_EQ(shell("true"), ProgramEnd::Success);
  EXPECT_EQ(shell("exit 3"), ProgramEnd::Failure);
  EXPECT_EQ(shell("kill -SEGV $$"), ProgramEnd::Failure);
  EXPECT_EQ(runProgram({"/nowhere/coplane_mesh", "probe"}, 60), ProgramEnd::Unknown);
  EXPECT_EQ(runProgram({"/bin/sleep", "60"}, 0.05), ProgramEnd::TooLong);
}

TEST(MeshFile, whatOnlyBeginsLikeHdf5IsRefused)
{
  const std::string file = ownFile("hdf5.e");
  std::ofstream(file) << "\x89HDF\r\n\x1a\n" << std::string(500, 'x');
  EXPECT_TRUE(
      contains(errorOf([&] { readMesh(file); }), "hdf5.e: the file is not an Exodus II file"));
  std::filesystem::remove(file);
}

TEST(MeshFile, aFolderIsNotAMesh)
{
  EXPECT_TRUE(
      contains(errorOf([] { readMesh("/"); }), "/: this is a folder; name an Exodus II file."));
}

TEST(MeshFile, aWedgeIsRefusedWithBlockAndAcceptedTypes)
{
  const std::string text = errorOf([] { readMesh(fileWithElementType("WEDGE", 6, 3)); });
  EXPECT_TRUE(contains(text, "block 12 ('block_12') has elements of type 'WEDGE' with 6 nodes; "
                             "accepted are TRI3 (also TRI, TRIANGLE) with 3 nodes and QUAD4"))
      << text;
}

TEST(MeshFile, aTetrahedronWithMidsideNodesIsRefused)
{
  const std::string text = errorOf([] { readMesh(fileWithElementType("TETRA", 8, 3)); });
  EXPECT_TRUE(contains(text, "has elements of type 'TETRA' with 8 nodes")) << text;
}

TEST(MeshFile, quadrilateralsInSpaceAreRefused)
{
  const std::string text = errorOf([] { readMesh(fileWithElementType("QUAD4", 4, 3)); });
  EXPECT_TRUE(contains(
      text, "has QUAD4 elements in a mesh of 3 dimensions; TRI3 and QUAD4 need 2 dimensions"))
      << text;
  std::filesystem::remove(ownFile("type.e"));
}

TEST(MeshFile, coordinatesThatAreNotFiniteAreRefusedWithTheNode)
{
  Mesh mesh = sampleMesh2d();
  mesh.coordinates[2].y = std::nan("");
  EXPECT_TRUE(contains(readError(mesh, "nan.e"),
                       "node 30 is at (2, nan, 0) m; coordinates must be finite"));
}

TEST(MeshFile, aMeshWithoutElementsIsRefused)
{
  Mesh mesh = sampleMesh2d();
  mesh.blocks.clear();
  mesh.sideSets.clear();
  EXPECT_TRUE(contains(readError(mesh, "empty.e"),
                       "the mesh has no elements (10 nodes, 0 element blocks)"));
}

TEST(MeshFile, listsThatTheLibraryCannotReadAreRefused)
{
  // In the header of CDF-5 a variable is its name, the number and ids of its dimensions, attributes
  // (none: 12 bytes of zero), type.
  const std::string file = ownFile("lists.e");
  writeMesh(sampleMesh2d(), file);
  std::ifstream stream(file, std::ios::binary);
  const std::string good((std::istreambuf_iterator<char>(stream)), {});
  const std::size_t variable = good.find("eb_status");
  ASSERT_NE(variable, std::string::npos);
  const std::size_t dimension = variable + 12 + 8, type = dimension + 8 + 12;
  ASSERT_EQ(good[type + 3], 4); // NC_INT
  for (const auto& [place, value] : {std::pair(type + 3, char(2)), {dimension + 7, char(2)}})
  {
    std::string spoilt = good;
    spoilt[place] = value; // text; or one for each axis
    std::ofstream(file, std::ios::binary) << spoilt;
    try
    {
      readMesh(file);
      FAIL();
    }
    catch (const Error& error)
    {
      EXPECT_EQ(error.code(), ExitCode::Mesh);
      EXPECT_NE(std::string(error.what()).find("'eb_status'"), std::string::npos) << error.what();
    }
  }
}

TEST(MeshFile, anIdThatOccursTwiceIsRefused)
{
  Mesh mesh = sampleMesh2d();
  mesh.blocks[1].elementIds[0] = 7;
  EXPECT_TRUE(contains(readError(mesh, "twice.e"),
                       "element id 7 occurs more than once; ids must be unique"));
}

TEST(MeshFile, anIdThatIsNotPositiveIsRefused)
{
  Mesh mesh = sampleMesh2d();
  mesh.nodeIds[1] = 0;
  EXPECT_TRUE(contains(readError(mesh, "zero.e"), "node id 0 is not positive"));
}

TEST(MeshFile, twoBlocksOfOneNameAreRefused)
{
  Mesh mesh = sampleMesh2d();
  mesh.blocks[1].name = "wall";
  EXPECT_TRUE(contains(readError(mesh, "names.e"),
                       "element blocks 5 and 3 are both named 'wall'; names must be unique"));
}

namespace
{
/// Every part gets the elements whose number modulo `parts` is its own, and their nodes; blocks
/// stay everywhere.
void writeParts(const Mesh& mesh, const std::string& file, int parts)
{
  for (int p = 0; p < parts; ++p)
  {
    Mesh part;
    part.title = mesh.title;
    part.dimension = mesh.dimension;
    part.qaRecords = mesh.qaRecords;
    std::vector<int> here(mesh.nodes(), -1), elementHere;
    const auto local = [&](int node)
    {
      if (here[node] < 0)
      {
        here[node] = part.nodes();
        part.nodeIds.push_back(mesh.nodeIds[node]);
        part.coordinates.push_back(mesh.coordinates[node]);
      }
      return here[node];
    };
    int index = 0, kept = 0;
    for (const Mesh::Block& block : mesh.blocks)
    {
      Mesh::Block mine{block.id, block.name, block.type, {}, {}, {}};
      const int corners = topology(block.type).nodes;
      for (int e = block.elements() - 1; e >= 0; --e) // not in the order of ids
      {
        if ((index + e) % parts != p)
          continue;
        mine.elementIds.push_back(block.elementIds[e]);
        mine.bodyIds.push_back(block.bodyIds[e]);
        for (int k = 0; k < corners; ++k)
          mine.connectivity.push_back(local(block.connectivity[e * corners + k]));
      }
      elementHere.resize(index + block.elements(), -1);
      for (int e = block.elements() - 1; e >= 0; --e)
        if ((index + e) % parts == p)
          elementHere[index + e] = kept++;
      index += block.elements();
      part.blocks.push_back(mine);
    }
    for (const Mesh::NodeSet& set : mesh.nodeSets)
    {
      part.nodeSets.push_back({set.id, set.name, {}});
      for (const int node : set.nodes)
        if (here[node] >= 0)
          part.nodeSets.back().nodes.push_back(here[node]);
    }
    for (const Mesh::SideSet& set : mesh.sideSets)
    {
      part.sideSets.push_back({set.id, set.name, {}, {}});
      for (std::size_t i = 0; i < set.elements.size(); ++i)
        if (elementHere[set.elements[i]] >= 0)
        {
          part.sideSets.back().elements.push_back(elementHere[set.elements[i]]);
          part.sideSets.back().sides.push_back(set.sides[i]);
        }
    }
    writeMesh(part, fmt::format("{}.{}.{}", file, parts, p));
  }
}

/// Positions in the order of ids, and the reverse.
std::pair<std::vector<int>, std::vector<int>> orderOf(const std::vector<GlobalId>& ids)
{
  std::vector<int> order(ids.size()), place(ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return ids[a] < ids[b]; });
  for (std::size_t i = 0; i < order.size(); ++i)
    place[order[i]] = int(i);
  return {order, place};
}

/// The mesh with nodes, elements within blocks and entries of sets in the order of their ids.
Mesh inOrderOfIds(const Mesh& mesh)
{
  Mesh sorted = mesh;
  const auto [order, place] = orderOf(mesh.nodeIds);
  for (int n = 0; n < mesh.nodes(); ++n)
  {
    sorted.nodeIds[n] = mesh.nodeIds[order[n]];
    sorted.coordinates[n] = mesh.coordinates[order[n]];
  }
  std::vector<int> elementPlace;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const Mesh::Block& block = mesh.blocks[b];
    const int corners = topology(block.type).nodes, first = int(elementPlace.size());
    const auto [elements, places] = orderOf(block.elementIds);
    for (int e = 0; e < block.elements(); ++e)
    {
      sorted.blocks[b].elementIds[e] = block.elementIds[elements[e]];
      sorted.blocks[b].bodyIds[e] = block.bodyIds[elements[e]];
      for (int k = 0; k < corners; ++k)
        sorted.blocks[b].connectivity[e * corners + k] =
            place[block.connectivity[elements[e] * corners + k]];
    }
    for (const int e : places)
      elementPlace.push_back(first + e);
  }
  for (Mesh::NodeSet& set : sorted.nodeSets)
  {
    for (int& node : set.nodes)
      node = place[node];
    std::sort(set.nodes.begin(), set.nodes.end());
  }
  for (Mesh::SideSet& set : sorted.sideSets)
  {
    std::vector<std::pair<int, int>> sides;
    for (std::size_t i = 0; i < set.elements.size(); ++i)
      sides.emplace_back(elementPlace[set.elements[i]], set.sides[i]);
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size(); ++i)
      std::tie(set.elements[i], set.sides[i]) = sides[i];
  }
  return sorted;
}
} // namespace

TEST(MeshFile, everyRankReadsItsSlice)
{
  const Comm comm;
  for (const Mesh& mesh : {sampleMesh2d(), sampleMesh3d()})
  {
    const std::string file = temporaryFile("slices.e");
    if (comm.isRoot())
      writeMesh(mesh, file);
    comm.barrier();
    const MeshSlice read = readMesh(file, comm), expected = sliceOf(mesh, comm.rank(), comm.size());
    expectSame(read.mine, expected.mine);
    EXPECT_EQ(read.nodes, expected.nodes);
    EXPECT_EQ(read.firstElements, expected.firstElements);
    EXPECT_EQ(read.nodeSetSizes, expected.nodeSetSizes);
    EXPECT_EQ(read.sideSetSizes, expected.sideSetSizes);
    comm.barrier();
    if (comm.isRoot())
      std::filesystem::remove(file);
  }
}

TEST(MeshFile, partsAreDealtOutToRanksAndGiveTheSameSlices)
{
  const Comm comm;
  for (const Mesh& mesh : {sampleMesh2d(), sampleMesh3d()})
    for (const int parts : {2, 3, 5})
    {
      const std::string file = temporaryFile("dealt.e");
      if (comm.isRoot())
        writeParts(mesh, file, parts);
      comm.barrier();
      const MeshSlice read = readMesh(file, comm);
      const MeshSlice expected = sliceOf(inOrderOfIds(mesh), comm.rank(), comm.size());
      expectSame(read.mine, expected.mine);
      EXPECT_EQ(read.nodes, expected.nodes);
      EXPECT_EQ(read.firstElements, expected.firstElements);
      EXPECT_EQ(read.nodeSetSizes, expected.nodeSetSizes);
      EXPECT_EQ(read.sideSetSizes, expected.sideSetSizes);
      comm.barrier();
      for (int p = 0; comm.isRoot() && p < parts; ++p)
        std::filesystem::remove(fmt::format("{}.{}.{}", file, parts, p));
    }
}

namespace
{
/// What all ranks say of a mesh in a file.
std::string errorOnAllRanks(const Mesh& mesh, const std::string& name, const Comm& comm)
{
  const std::string file = temporaryFile(name);
  if (comm.isRoot())
    writeMesh(mesh, file);
  comm.barrier();
  std::string text = "no error";
  try
  {
    readMesh(file, comm);
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Mesh);
    EXPECT_TRUE(error.onAllRanks());
    text = error.what();
  }
  EXPECT_EQ(text, comm.broadcast(text));
  comm.barrier();
  if (comm.isRoot())
    std::filesystem::remove(file);
  return text;
}
} // namespace

TEST(MeshFile, whatOneRankFindsAllRanksSay)
{
  const Comm comm;
  Mesh mesh = sampleMesh2d();
  mesh.coordinates.back().y = std::nan(""); // in the slice of the last rank
  EXPECT_TRUE(contains(errorOnAllRanks(mesh, "nan.e", comm), "coordinates must be finite"));
  mesh = sampleMesh2d();
  mesh.blocks[1].elementIds[0] = mesh.blocks[0].elementIds[0]; // of two slices
  EXPECT_TRUE(contains(errorOnAllRanks(mesh, "elements.e", comm),
                       "element id 7 occurs more than once; ids must be unique"));
  mesh = sampleMesh2d();
  mesh.nodeIds.back() = mesh.nodeIds.front();
  EXPECT_TRUE(contains(errorOnAllRanks(mesh, "nodes.e", comm), "occurs more than once"));
  mesh = sampleMesh2d();
  mesh.nodeIds.back() = -3;
  EXPECT_TRUE(contains(errorOnAllRanks(mesh, "minus.e", comm), "node id -3 is not positive"));
}

TEST(MeshFile, partsForSeveralRanksAreOneMesh)
{
  for (const Mesh& mesh : {sampleMesh2d(), sampleMesh3d()})
    for (const int parts : {2, 3, 5}) // with 5 some are empty
    {
      const std::string file = ownFile("split.e");
      writeParts(mesh, file, parts);
      expectSame(readMesh(file), inOrderOfIds(mesh));
      std::filesystem::remove(fmt::format("{}.{}.1", file, parts));
      try
      {
        readMesh(file);
        ADD_FAILURE() << "a missing part is not missed";
      }
      catch (const Error& error)
      {
        EXPECT_NE(std::string(error.what()).find(fmt::format("part 1 of the {} parts", parts)),
                  std::string::npos)
            << error.what();
      }
      for (int p = 0; p < parts; ++p)
        std::filesystem::remove(fmt::format("{}.{}.{}", file, parts, p));
    }
}

TEST(MeshFile, partsOfTwoMeshesAreRefused)
{
  const std::string file = ownFile("mixed.e");
  Mesh mesh = sampleMesh2d();
  writeParts(mesh, file, 2);
  mesh.coordinates[4].x += 0.1; // a node of both elements of the wall
  writeParts(mesh, ownFile("other.e"), 2);
  std::filesystem::rename(ownFile("other.e") + ".2.1", file + ".2.1");
  EXPECT_THROW(readMesh(file), Error);
  for (const std::string& name : {file + ".2.0", file + ".2.1", ownFile("other.e") + ".2.0"})
    std::filesystem::remove(name);
}

TEST(MeshFile, writingIntoAMissingFolderIsAnOutputError)
{
  const std::string text =
      errorOf([] { writeMesh(sampleMesh2d(), "/no/such/folder/mesh.e"); }, ExitCode::Output);
  EXPECT_TRUE(contains(text, "/no/such/folder/mesh.e: the mesh cannot be written (creating the "
                             "file: No such file or directory)"))
      << text;
}
} // namespace coplane
