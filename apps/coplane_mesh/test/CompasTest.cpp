// Assemblies of COMPAS: the three layouts of their JSON, written by hand.
#include "CompasFile.hpp"

#include <coplane_core/Error.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace coplane
{
namespace
{
/// A cube of side 1 with its lowest corner at (0, 0, z), as COMPAS writes a mesh.
/// @param quote around keys in faces: older files have texts there
std::string cube(int z, const std::string& quote = "")
{
  const auto corner = [&](int k, int x, int y, int up)
  {
    // z = 0 is left to the default.
    const std::string height = z + up == 0 ? "" : ", \"z\": " + std::to_string(z + up);
    return "\"" + std::to_string(k) + "\": {\"x\": " + std::to_string(x) +
           ", \"y\": " + std::to_string(y) + height + "}";
  };
  std::string faces;
  const int corners[6][4] = {{0, 1, 2, 3}, {0, 3, 5, 4}, {3, 2, 6, 5},
                             {2, 1, 7, 6}, {1, 0, 4, 7}, {4, 5, 6, 7}};
  for (int f = 0; f < 6; ++f)
  {
    faces += (f > 0 ? ", \"" : "\"") + std::to_string(f) + "\": [";
    for (int k = 0; k < 4; ++k)
      faces += (k > 0 ? ", " : "") + quote + std::to_string(corners[f][k]) + quote;
    faces += "]";
  }
  return "\"default_vertex_attributes\": {\"x\": 0.0, \"y\": 0.0, \"z\": 0.0}, \"vertex\": {" +
         corner(0, 0, 0, 0) + ", " + corner(1, 0, 1, 0) + ", " + corner(2, 1, 1, 0) + ", " +
         corner(3, 1, 0, 0) + ", " + corner(4, 0, 0, 1) + ", " + corner(5, 1, 0, 1) + ", " +
         corner(6, 1, 1, 1) + ", " + corner(7, 0, 1, 1) + "}, \"face\": {" + faces +
         "}, \"facedata\": {\"0\": {}}, \"edgedata\": {}";
}

class CompasFile : public testing::Test
{
protected:
  std::vector<Polyhedron> read(const std::string& text) const
  {
    std::ofstream(path_) << text;
    return readCompasBlocks(path_.string());
  }
  std::string refusal(const std::string& text) const
  {
    try
    {
      read(text);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "accepted";
  }
  ~CompasFile() override { std::filesystem::remove(path_); }

private:
  const std::filesystem::path path_ =
      std::filesystem::temp_directory_path() /
      (std::string("compas-") + testing::UnitTest::GetInstance()->current_test_info()->name() +
       ".json");
};

Real volumeOf(const Polyhedron& solid)
{
  Real six = 0;
  for (const std::vector<int>& face : solid.faces)
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      six += dot(solid.points[std::size_t(face[0])],
                 cross(solid.points[std::size_t(face[k])], solid.points[std::size_t(face[k + 1])]));
  return std::abs(six) / 6;
}

void expectTwoCubes(const std::vector<Polyhedron>& blocks)
{
  ASSERT_EQ(blocks.size(), 2u);
  for (int b = 0; b < 2; ++b)
  {
    EXPECT_EQ(blocks[std::size_t(b)].points.size(), 8u);
    EXPECT_EQ(blocks[std::size_t(b)].faces.size(), 6u);
    EXPECT_NEAR(volumeOf(blocks[std::size_t(b)]), 1, 1e-14);
    EXPECT_EQ(blocks[std::size_t(b)].points[0].z, b);
    EXPECT_EQ(blocks[std::size_t(b)].support, b == 0);
  }
}
} // namespace

TEST_F(CompasFile, ofTheFirstLayoutIsRead)
{
  for (const std::string nodes : {"vertex", "node"})
    expectTwoCubes(read("{\"assembly\": {\"attributes\": {\"name\": \"Assembly\"}, \"" + nodes +
                        "\": {\"0\": {\"is_support\": true, \"x\": 0.5}, \"1\": {\"is_support\": "
                        "false}}, \"edge\": {}}, \"blocks\": {\"0\": {" +
                        cube(0, "\"") + "}, \"1\": {" + cube(1, "\"") + "}}}"));
}

TEST_F(CompasFile, ofAnAssemblyWithTypesIsRead)
{
  const auto node = [](int z, const std::string& more)
  {
    return "{\"block\": {\"dtype\": \"compas_assembly.datastructures/Block\", \"data\": {" +
           cube(z) + "}, \"name\": \"Box\"}" + more + "}";
  };
  expectTwoCubes(
      read("{\"dtype\": \"compas_assembly.datastructures/Assembly\", \"data\": {\"attributes\": "
           "{}, \"graph\": {\"dtype\": \"compas.datastructures/Graph\", \"data\": {\"node\": "
           "{\"0\": " +
           node(0, ", \"is_support\": true") + ", \"1\": " + node(1, "") +
           "}, \"edge\": {\"0\": {\"1\": {\"interfaces\": [{\"data\": {\"mesh\": {\"data\": "
           "{\"vertex\": {}, \"face\": {}}}}}]}}}}}}}"));
}

TEST_F(CompasFile, ofABlockModelIsReadWithItsPlaces)
{
  const auto element = [](int z, const std::string& support, const std::string& place)
  {
    return "{\"dtype\": \"compas_dem.elements/Block\", \"data\": {\"transformation\": " + place +
           ", \"geometry\": {\"dtype\": \"compas.datastructures/Mesh\", \"data\": {" + cube(z) +
           "}}, \"is_support\": " + support + "}}";
  };
  const auto model = [&](const std::string& place)
  {
    return "{\"dtype\": \"compas_dem.models/BlockModel\", \"data\": {\"transformation\": null, "
           "\"elements\": {\"b74e\": " +
           element(0, "true", "null") + ", \"3cb6\": " + element(1, "false", place) +
           "}, \"graph\": {\"node\": {\"0\": {\"element\": \"b74e\"}}}}}";
  };
  expectTwoCubes(read(model("null")));
  // A quarter turn about z, then 5 along x.
  const auto moved = read(model("{\"dtype\": \"compas.geometry/Transformation\", \"data\": "
                                "{\"matrix\": [[0, -1, 0, 5], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, "
                                "0, 1]]}}"));
  ASSERT_EQ(moved.size(), 2u);
  EXPECT_LT(norm(moved[1].points[1] - Vec3{4, 0, 1}), 1e-15); // from (0, 1, 1)
  EXPECT_NE(refusal(model("{\"data\": {\"rotation\": 3}}")).find("no 4 x 4 matrix"),
            std::string::npos);
}

TEST_F(CompasFile, hasFacesThatAreNotPlaneCutAlike)
{
  std::string lower = cube(0, "\""), upper = cube(1, "\"");
  // One corner of the face between them is 0.1 higher, in both.
  const auto lift = [](std::string text, const std::string& from, const std::string& to)
  {
    const auto place = text.find(from);
    EXPECT_NE(place, std::string::npos);
    return text.replace(place, from.size(), to);
  };
  lower = lift(lower, "\"6\": {\"x\": 1, \"y\": 1, \"z\": 1}",
               "\"6\": {\"x\": 1, \"y\": 1, \"z\": 1.1}");
  upper = lift(upper, "\"2\": {\"x\": 1, \"y\": 1, \"z\": 1}",
               "\"2\": {\"x\": 1, \"y\": 1, \"z\": 1.1}");
  const auto blocks = read("{\"blocks\": {\"a\": {" + lower + "}, \"b\": {" + upper + "}}}");
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0].faces.size(), 12u);
  EXPECT_NEAR(volumeOf(blocks[0]) + volumeOf(blocks[1]), 2, 1e-14);
  EXPECT_NEAR(volumeOf(blocks[0]), 1 + 0.1 / 3,
              1e-14); // from (0, 0, 1): two triangles with (1, 1, 1.1)
}

TEST_F(CompasFile, isRefusedInClearWords)
{
  const auto contains = [&](const std::string& text, const std::string& part)
  { EXPECT_NE(refusal(text).find(part), std::string::npos) << refusal(text); };
  contains("{\"blocks\": ", "is no JSON");
  contains("{\"dtype\": \"compas.geometry/Box\", \"data\": {}}", "no blocks were found");
  contains("[1, 2]", "no blocks were found");
  contains("{\"blocks\": {\"a\": {\"frame\": 1}}}", "no mesh of `vertex` and `face`");
  std::string open = cube(0);
  open = open.replace(open.find("\"5\": [4, 5, 6, 7]"), 17, "\"5\": [4, 5, 6]");
  contains("{\"blocks\": {\"a\": {" + open + "}}}", "is not closed");
  open = cube(0);
  open = open.replace(open.find("[4, 5, 6, 7]"), 12, "[4, 5, 6, 9]");
  contains("{\"blocks\": {\"a\": {" + open + "}}}", "has the vertex 9");
  contains("{\"blocks\": {\"a\": {\"vertex\": {\"0\": {\"x\": \"wide\"}}, \"face\": {}}}}",
           "not as assemblies of COMPAS are written");
}
} // namespace coplane
