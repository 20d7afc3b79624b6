#include "BlocksRecipe.hpp"
#include "JointSurfaces.hpp"

#include <coplane_core/Error.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

namespace coplane
{
namespace
{
BlocksRecipe recipeOf(const std::string& joints, int dimension = 3)
{
  const char* box =
      dimension == 3 ? "{min: [0, 0, 0], max: [10, 10, 10]}" : "{min: [0, 0], max: [10, 10]}";
  return parseBlocksRecipe(
      fmt::format("{{dimension: {}, domain: {{box: {}}}, elements: {{size: 1}}, "
                  "joints: {{a: {}}}}}",
                  dimension, box, joints),
      "blocks.yaml");
}

std::vector<JointSurface> surfacesOf(const BlocksRecipe& recipe)
{
  Problems problems;
  const Real height = recipe.dimension == 3 ? 10 : 0;
  const auto surfaces = jointSurfaces(recipe, "blocks.yaml", {0, 0, 0}, {10, 10, height}, problems);
  EXPECT_EQ(problems.text(), "");
  return surfaces;
}

Vec3 normalOf(const JointSurface& surface)
{
  const auto& c = surface.corners;
  return normalised(cross(c[1] - c[0], c[2] - c[0]));
}

std::string refusal(const std::string& joints, int dimension = 3)
{
  try
  {
    recipeOf(joints, dimension);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "accepted";
}

TEST(DipNormals, followTheCompass)
{
  const Vec3 up{0, 0, 1}, north{0, 1, 0};
  const Real s = std::sqrt(0.5);
  // A plane that descends at 45 degrees to the east rises to the west: its normal leans east.
  EXPECT_LT(norm(normalOfDip(45, 90, up, north) - Vec3{s, 0, s}), 1e-15);
  EXPECT_LT(norm(normalOfDip(45, 0, up, north) - Vec3{0, s, s}), 1e-15);
  EXPECT_LT(norm(normalOfDip(0, 77, up, north) - up), 1e-15);
  EXPECT_LT(norm(normalOfDip(90, 180, up, north) - Vec3{0, -1, 0}), 1e-15);
  // Up along y, north along -z, so east is x, as on a map laid on a floor.
  EXPECT_LT(norm(normalOfDip(45, 90, {0, 2, 0}, {0, 1, -3}) - Vec3{s, s, 0}), 1e-15);
}

TEST(JointSets, havePlanesAtTheirSpacing)
{
  const auto surfaces = surfacesOf(recipeOf("{set: {dip: 0, dip_direction: 0, spacing: 2, "
                                            "through: [0, 0, 1]}}"));
  std::vector<Real> heights;
  for (const JointSurface& surface : surfaces)
  {
    EXPECT_LT(norm(cross(normalOf(surface), {0, 0, 1})), 1e-15);
    if (const Real z = surface.corners[0].z; z > 0 && z < 10)
      heights.push_back(z);
  }
  ASSERT_EQ(heights.size(), 5u);
  for (int k = 0; k < 5; ++k)
    EXPECT_NEAR(heights[std::size_t(k)], 1 + 2 * k, 1e-14);
}

TEST(JointSets, scatterAboutTheirMeans)
{
  // The mean of the normals by Fisher has the length coth K - 1 / K; here 2000 planes.
  const auto surfaces = surfacesOf(recipeOf("{set: {dip: 30, dip_direction: 60, spacing: 0.0085, "
                                            "spacing_scatter: 0.5, fisher: 50}}"));
  ASSERT_GT(surfaces.size(), 1900u);
  EXPECT_NEAR(Real(surfaces.size()) * 0.0085 / (10 * std::sqrt(3.0)), 1, 0.02);
  const Vec3 mean = normalOfDip(30, 60, {0, 0, 1}, {0, 1, 0});
  Vec3 sum{};
  for (const JointSurface& surface : surfaces)
  {
    const Vec3 normal = normalOf(surface);
    sum += (dot(normal, mean) > 0 ? 1.0 : -1.0) * normal;
  }
  const Vec3 average = (1.0 / Real(surfaces.size())) * sum;
  // Of n draws the mean is off by sqrt((1 - R^2) / n), 0.0044 here; four of these.
  EXPECT_LT(norm(average - (1 / std::tanh(50) - 1.0 / 50) * mean), 0.018);
}

TEST(JointSets, areOpenOverTheirPersistence)
{
  const auto flat =
      surfacesOf(recipeOf("{set: {angle: 0, spacing: 0.01, persistence: 0.6, length: 3}}", 2));
  Real inside = 0, traces = 0;
  std::set<Real> heights;
  for (const JointSurface& part : flat)
  {
    EXPECT_NEAR(norm(part.corners[1] - part.corners[0]), 3, 1e-12);
    const auto clamp = [](Real x) { return std::min(10.0, std::max(0.0, x)); };
    inside += std::abs(clamp(part.corners[1].x) - clamp(part.corners[0].x));
    heights.insert(part.corners[0].y);
  }
  traces = 10 * Real(heights.size());
  // Starts of the parts are random: 1400 traces of two periods each, off by less than 1 %.
  EXPECT_NEAR(inside / traces, 0.6, 0.02);
  const auto solid = surfacesOf(
      recipeOf("{set: {dip: 90, dip_direction: 0, spacing: 100, persistence: 0.25, length: 1}}"));
  for (const JointSurface& part : solid)
    EXPECT_NEAR(norm(cross(part.corners[1] - part.corners[0], part.corners[3] - part.corners[0])),
                1, 1e-12);
  // Squares of 1 m every 2 m, 17 m to all sides.
  EXPECT_NEAR(Real(solid.size()), pi * 9.66 * 9.66 / 4, 12);
}

TEST(JointSets, areTheSameWithTheSameSeed)
{
  const std::string text = "{set: {dip: 40, dip_direction: 10, spacing: 1, spacing_scatter: 0.4, "
                           "fisher: 30, persistence: 0.5, length: 2}}";
  const auto a = surfacesOf(recipeOf(text)), b = surfacesOf(recipeOf(text));
  ASSERT_EQ(a.size(), b.size());
  BlocksRecipe other = recipeOf(text);
  other.seed = 2;
  const auto c = surfacesOf(other);
  bool differs = a.size() != c.size();
  for (std::size_t k = 0; k < a.size(); ++k)
  {
    for (std::size_t i = 0; i < a[k].corners.size(); ++i)
      EXPECT_EQ(norm(a[k].corners[i] - b[k].corners[i]), 0);
    differs = differs || norm(a[k].corners[0] - c[k].corners[0]) > 0;
  }
  EXPECT_TRUE(differs);
}

TEST(FractureTables, areRead)
{
  const std::string file = "blocks_test_fractures.csv";
  std::ofstream(file) << "# from a network\nx, y, z, radius, dip, dip_direction\n5,5,5,2,90,90\n"
                         "\n1,2,3,1,0,0\n";
  const auto surfaces = surfacesOf(recipeOf("{file: " + file + "}"));
  ASSERT_EQ(surfaces.size(), 2u);
  // Polygons of the circle's area.
  Real area = 0;
  const auto& c = surfaces[0].corners;
  for (std::size_t k = 1; k + 1 < c.size(); ++k)
    area += norm(cross(c[k] - c[0], c[k + 1] - c[0])) / 2;
  EXPECT_NEAR(area, pi * 4, 1e-12);
  EXPECT_LT(norm(cross(normalOf(surfaces[0]), {1, 0, 0})), 1e-12);
  std::filesystem::remove(file);
}

TEST(FractureTables, areRefusedWithTheirLine)
{
  const std::string file = "blocks_test_fractures.csv";
  const auto problemOf = [&](const std::string& text)
  {
    std::ofstream(file) << text;
    Problems problems;
    const BlocksRecipe recipe = recipeOf("{file: " + file + "}");
    jointSurfaces(recipe, "blocks.yaml", {0, 0, 0}, {10, 10, 10}, problems);
    std::filesystem::remove(file);
    return problems.text();
  };
  const auto contains = [](const std::string& text, const std::string& part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  contains(problemOf("x,y,z,r,dip,dip_direction\n"), "csv:1: the columns are 'x, y, z, r, dip");
  contains(problemOf("x,y,z,radius,nx,ny,nz\n1,2,3,1,0,0\n"), "csv:2: 6 values for 7 columns");
  contains(problemOf("x,y,z,radius,nx,ny,nz\n1,2,3,1,0,0,nan\n"), "csv:2: 'nan' in column nz");
  contains(problemOf("x,y,z,radius,nx,ny,nz\n1,2,3,1,0,0,0\n"), "csv:2: the normal is zero");
  contains(problemOf("x,y,z,radius,nx,ny,nz\n1,2,3,-1,0,0,1\n"), "csv:2: the radius -1");
  contains(problemOf("x,y,z,radius,nx,ny,nz\n"), "no fracture");
  contains(problemOf("x,y,z,radius,dip,dip_direction\n5,5,5,2,90,0\n5,5,5,2,95,0\n"),
           "csv:3: dip = 95 is not between 0 and 90 degrees");
  contains(problemOf("x,y,z,radius,dip,dip_direction\n5,5,5,2,-5,0\n"), "csv:2: dip = -5 is not");
  contains(problemOf("x,y,z,radius,dip,dip_direction\n5,5,5,2,5,400\n"),
           "csv:2: dip_direction = 400 is not between -360 and 360 degrees");
  EXPECT_EQ(problemOf("x,y,z,radius,dip,dip_direction\n5,5,5,2,0,360\n5,5,5,2,90,-90\n"), "");
  // Byte order mark, quotes, spaces and the line ends of Windows.
  EXPECT_EQ(problemOf("\xEF\xBB\xBF\"x\", \"y\", z,radius,nx,ny,nz\r\n5, \"5\" ,5,2,0,0,1\r\n"),
            "");
}

TEST(PolygonsOfDfnWorks, areRead)
{
  const std::string file = "blocks_test_polygons.dat";
  const auto problemOf = [&](const std::string& text, int dimension = 3)
  {
    std::ofstream(file) << text;
    Problems problems;
    const BlocksRecipe recipe = recipeOf("{file: " + file + "}", dimension);
    jointSurfaces(recipe, "blocks.yaml", {0, 0, 0}, {10, 10, 10}, problems);
    return problems.text();
  };
  const std::string two = "4 {1, 1, 5} {9, 1, 5} {9, 9, 5} {1, 9, 5} \n"
                          "3 {2, 2, 1.5} {8, 2, 1.5} {5, 2, 8e0} \n";
  EXPECT_EQ(problemOf("nPolygons: 2\n" + two), "");
  const auto surfaces = surfacesOf(recipeOf("{file: " + file + "}"));
  ASSERT_EQ(surfaces.size(), 2u);
  EXPECT_EQ(surfaces[0].corners.size(), 4u);
  EXPECT_EQ(surfaces[0].source, "line 2");
  EXPECT_LT(norm(surfaces[1].corners[2] - Vec3{5, 2, 8}), 1e-12);
  EXPECT_LT(norm(cross(normalOf(surfaces[1]), {0, 1, 0})), 1e-15);
  const auto contains = [](const std::string& text, const std::string& part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  contains(problemOf("nPolygons: 3\n" + two),
           "2 polygons, and nPolygons: 3: the file is not whole");
  contains(problemOf("nPolygons: two\n" + two), "dat:1: 'two' is no number");
  contains(problemOf("nPolygons: 1\n4 {1, 1, 5} {9, 1, 5} {9, 9, 5}\n"),
           "dat:2: 9 numbers follow for 4 corners");
  contains(problemOf("nPolygons: 1\n3 {1, 1, 5} {9, x, 5} {9, 9, 5}\n"), "dat:2: 'x' is no number");
  contains(problemOf("nPolygons: 1\n3 {1, 1, 1} {2, 2, 2} {3, 3, 3}\n"),
           "dat:2: the polygon has no area");
  contains(problemOf("nPolygons: 1\n4 {1, 1, 5} {9, 1, 5} {9, 9, 6} {1, 9, 5}\n"),
           "dat:2: the polygon is not plane");
  contains(problemOf("nPolygons: 2\n" + two, 2), "need dimension: 3");
  std::filesystem::remove(file);
}

TEST(BlocksRecipes, mayHaveNoJoints)
{
  EXPECT_TRUE(parseBlocksRecipe("{dimension: 2, domain: {box: {min: [0, 0], max: [9, 9]}}, "
                                "elements: {size: 1}}",
                                "blocks.yaml")
                  .joints.empty());
}

TEST(BlocksRecipes, areRefusedInClearWords)
{
  const auto contains = [](const std::string& text, const std::string& part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  contains(refusal("{set: {dip: 30, spacing: 1}}"), "dip_direction");
  contains(refusal("{set: {angle: 30, spacing: 1}}"), "angle");
  contains(refusal("{set: {dip: 95, dip_direction: 0, spacing: 1}}"), "dip");
  contains(refusal("{set: {angle: 30, spacing: 1, persistence: 0.5}}", 2), "needs length");
  contains(refusal("{set: {angle: 30, spacing: 1, length: 3}}", 2), "needs a persistence");
  contains(refusal("{planes: {point: [0, 0, 0], normal: [0, 0, 1], polygon: [[0, 0, 0], [1, 0, 0], "
                   "[0, 1, 0.1]]}}"),
           "not on the plane");
  contains(refusal("{planes: {point: [0, 0], normal: [0, 1], count: 3}}", 2), "needs spacing");
  contains(refusal("{voronoi: {cells: 1}}"), "cells");
  contains(refusal("{planes: {point: [0, 0], normal: [0, 1], segment: [[1, 0], [1, 4]]}}", 2),
           "segment has no length");
  const auto polygon = [](const char* corners)
  {
    return refusal(
        fmt::format("{{planes: {{point: [0, 0, 0], normal: [0, 0, 1], polygon: {}}}}}", corners));
  };
  contains(polygon("[[0, 0, 0], [3, 3, 0], [3, 0, 0], [0, 3, 0]]"), "crosses itself");
  contains(polygon("[[0, 0, 0], [3, 3, 0], [3, 0, 0], [0, 2, 0]]"), "polygon crosses itself");
  contains(polygon("[[0, 0, 0], [1, 0, 0], [2, 0, 0]]"), "has no area");
  contains(polygon("[[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0]]"), "the corner 2 twice running");
  contains(polygon("[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0]]"), "the corner 4 twice running");
  // Concave ones, and ones with a corner within a side, are polygons.
  EXPECT_EQ(polygon("[[0, 0, 0], [4, 0, 0], [4, 4, 0], [2, 1, 0], [0, 4, 0]]"), "accepted");
  EXPECT_EQ(polygon("[[0, 4, 0], [4, 4, 0], [4, 0, 0], [2, 0, 0], [0, 0, 0]]"), "accepted");
}

TEST(BlocksRecipes, haveNamesOfTheirOwnForAllThatMeshesName)
{
  const auto refusalOf = [](const std::string& rest)
  {
    try
    {
      parseBlocksRecipe("{dimension: 2, domain: {box: {min: [0, 0], max: [9, 9]}}, elements: "
                        "{size: 1}, joints: {a: {planes: {point: [4, 0], normal: [1, 0]}}}, " +
                            rest + "}",
                        "blocks.yaml");
    }
    catch (const Error& error)
    {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto contains = [](const std::string& text, const std::string& part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  contains(refusalOf("side_sets: {a: {where: {x: 0}}}"), "side_sets.a has the name of a joint");
  contains(refusalOf("openings: {rock: {circle: 1, at: [4, 4], keep: true}}"),
           "openings.rock has the name of the domain's block");
  EXPECT_EQ(refusalOf("openings: {rock: {circle: 1, at: [4, 4]}}, node_sets: {a: {where: {x: 0}}}"),
            "accepted");
}

TEST(JointSets, areRefusedWhereThereAreTooManyJoints)
{
  const auto problemOf = [](const std::string& set)
  {
    Problems problems;
    jointSurfaces(recipeOf("{set: {angle: 0, " + set + "}}", 2), "blocks.yaml", {0, 0, 0},
                  {10, 10, 0}, problems);
    return problems.text();
  };
  const auto contains = [](const std::string& text, const std::string& part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  contains(problemOf("spacing: 1e-9"), "joints.a.set makes about");
  contains(problemOf("spacing: 1, through: [0, 1e11]"), "joints.a.set makes about");
  contains(problemOf("spacing: 1, persistence: 0.5, length: 1e-7"), "joints.a.set makes about");
  EXPECT_EQ(problemOf("spacing: 1, through: [0, 1e3]"), "");
}
} // namespace
} // namespace coplane
