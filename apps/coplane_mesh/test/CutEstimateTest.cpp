#include "CutEstimate.hpp"

#include "CubesOfTetrahedra.hpp"
#include "MeasureOfElements.hpp"
#include "OpeningSection.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_exodus/MeshReport.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace coplane
{
namespace
{
const Vec3 low{500000, 4000000, 0}, high{500010, 4000010, 10};

BlocksRecipe farRecipe(const std::string& joints, const std::string& more = "")
{
  return parseBlocksRecipe("{dimension: 3, domain: {box: {min: [500000, 4000000, 0], max: [500010, "
                           "4000010, 10]}}, elements: {size: 1" +
                               more + "}, joints: {" + joints + "}}",
                           "blocks.yaml");
}

std::vector<JointSurface> farSurfaces(const BlocksRecipe& recipe)
{
  Problems problems;
  auto surfaces = jointSurfaces(recipe, "blocks.yaml", low, high, problems);
  EXPECT_EQ(problems.text(), "");
  return surfaces;
}

std::string refusalOf(const BlocksRecipe& recipe)
{
  try
  {
    demandFewParts(recipe, "blocks.yaml", farSurfaces(recipe), low, high, 0.1);
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Deck);
    return error.what();
  }
  return "accepted";
}

std::string setOf(const std::string& name, int dip, int direction, Real spacing)
{
  return fmt::format("{}: {{set: {{dip: {}, dip_direction: {}, spacing: {}}}}}", name, dip,
                     direction, spacing);
}

TEST(EstimatedParts, areThoseOfSetsAtRightAngles)
{
  // Planes go through the middle: 5 of a spacing of 2 m, 9 of 1.1 m, 3 of 4 m.
  const std::string a = setOf("a", 0, 0, 2), b = setOf("b", 90, 0, 1.1), c = setOf("c", 90, 90, 4);
  const auto partsOf = [](const std::string& joints)
  { return estimatedParts(farSurfaces(farRecipe(joints)), 3, low, high); };
  EXPECT_NEAR(partsOf(a), 6, 1e-9);
  EXPECT_NEAR(partsOf(a + ", " + b), 6 * 10, 1e-9);
  EXPECT_NEAR(partsOf(a + ", " + b + ", " + c), 6 * 10 * 4, 1e-9);
  // In the plane a trace counts by its length inside.
  std::vector<JointSurface> traces{{0, {{-5, 5, 0}, {15, 5, 0}}, ""},
                                   {0, {{5, 0, 0}, {5, 5, 0}}, ""},
                                   {0, {{20, 0, 0}, {30, 5, 0}}, ""}};
  EXPECT_NEAR(estimatedParts(traces, 2, {0, 0, 0}, {10, 10, 0}), 2 * 1.5, 1e-12);
}

TEST(JointsInWrongUnits, areRefusedBeforeAnythingIsCut)
{
  const auto contains = [](const std::string& text, const std::string& part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  const std::string grid = setOf("b", 90, 0, 0.5) + ", " + setOf("c", 90, 90, 0.5);
  EXPECT_EQ(refusalOf(farRecipe(setOf("a", 0, 0, 2))), "accepted");
  contains(refusalOf(farRecipe(setOf("a", 0, 0, 0.002))),
           "joints.a.set: spacing = 0.002 m is not more than slivers.thickness = 0.1 m");
  contains(refusalOf(farRecipe("a: {planes: {point: [500001, 4000001, 1], normal: [0, 0, 1], "
                               "spacing: 0.001, count: 4}}")),
           "joints.a.planes: spacing = 0.001 m");
  contains(refusalOf(farRecipe(setOf("a", 0, 0, 0.2) + ", " + grid)),
           "about 2e+04 parts (87 surfaces of joints.a, 35 surfaces of joints.b, 35 surfaces of "
           "joints.c)");
  const std::string cells = "grains: {voronoi: {cells: 6000}}";
  contains(refusalOf(farRecipe(cells + ", " + setOf("a", 0, 0, 2))),
           "about 6e+03 parts (6000 cells of joints.grains, 9 surfaces of joints.a)");
  EXPECT_EQ(refusalOf(farRecipe(cells, ", most_parts: 7000")), "accepted");
  EXPECT_EQ(refusalOf(farRecipe(setOf("a", 0, 0, 0.2) + ", " + grid, ", most_parts: 1e5")),
            "accepted");
}

BlocksRecipe openingsOf(const std::string& openings, const std::string& more = "")
{
  return parseBlocksRecipe("{dimension: 2, domain: {box: {min: [-20, -20], max: [20, 20]}}, "
                           "elements: {size: 1" +
                               more + "}, openings: {" + openings + "}}",
                           "blocks.yaml");
}

std::string refusalOfOpenings(const BlocksRecipe& recipe)
{
  try
  {
    demandFewSides(recipe, "blocks.yaml", {-20, -20, 0}, {20, 20, 0});
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Deck);
    return error.what();
  }
  return "accepted";
}

TEST(OpeningsInWrongUnits, areRefusedBeforeAnythingIsCut)
{
  const auto contains = [](const std::string& text, const std::string& part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  EXPECT_EQ(refusalOfOpenings(openingsOf("t: {circle: 3, at: [0, 0]}")), "accepted");
  EXPECT_EQ(refusalOfOpenings(openingsOf("t: {circle: 56, at: [0, 0]}")), "accepted");
  for (const char* radius : {"57", "3000", "3e11"})
    contains(refusalOfOpenings(
                 openingsOf(fmt::format("t: {{circle: {}, at: [0, 0], size: 0.6}}", radius))),
             "and the domain measures 56.57 m from corner to corner. All lengths are in metres");
  contains(refusalOfOpenings(
               openingsOf("a: {circle: 3, at: [0, 0]}, t: {horseshoe: [8, 5000], at: [0, 0]}")),
           "openings.t is 8 m wide and 5000 m high");
  contains(
      refusalOfOpenings(openingsOf("t: {polygon: [[-100, 0], [100, 0], [0, 50]], at: [0, 0]}")),
      "openings.t is 200 m wide and 50 m high");
  const std::string fine = "a: {circle: 3, at: [0, 0]}, t: {circle: 10, at: [5, 0], size: 0.01}";
  contains(refusalOfOpenings(openingsOf(fine)),
           "about 6303 sides (19 of openings.a with elements of 1 m, 6284 of openings.t with "
           "elements of 0.01 m), and up to elements.most_parts = 5000");
  EXPECT_EQ(refusalOfOpenings(openingsOf(fine, ", most_parts: 6400")), "accepted");
}

TEST(CornersOfOpenings, areAsManyAsTheSectionHas)
{
  const BlocksRecipe recipe =
      openingsOf("a: {circle: 3, at: [0, 0]}, b: {circle: 0.1, at: [9, 0]}, c: {horseshoe: [8, 5], "
                 "at: [0, 9]}, d: {horseshoe: [2, 5], at: [0, 9]}, e: {polygon: [[0, 0], [1, 0], "
                 "[0, 2]], at: [0, 0]}");
  ASSERT_EQ(recipe.openings.size(), 5u);
  for (const OpeningCard& card : recipe.openings)
    for (const Real size : {0.01, 0.3, 1.0})
      EXPECT_EQ(cornersOf(card, size), Real(sectionOf(card, size).size())) << card.name;
}

TEST(OpeningsThatTakeMostOfTheDomain, areNoted)
{
  const BlocksRecipe recipe =
      openingsOf("a: {circle: 19, at: [0, 0]}, b: {horseshoe: [8, 5], at: [0, 9]}");
  EXPECT_TRUE(notesOfLargeOpenings(recipe, {0.5, 0.1}).empty());
  const auto notes = notesOfLargeOpenings(recipe, {0.7088, 0.1});
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0],
            "openings.a, 38 m wide and 38 m high, takes 70.9 % of the domain. All lengths "
            "are in metres");
}

TEST(WhatLiesOutside, isNamed)
{
  const std::string file = "estimate_test_fractures.csv";
  std::ofstream(file) << "x,y,z,radius,dip,dip_direction\n500005,4000005,5,1,0,0\n5,5,5,1,0,0\n";
  const BlocksRecipe recipe =
      farRecipe("a: {file: " + file +
                    "}, b: {planes: {point: [500001, 4000001, 1], normal: [0, 0, "
                    "1]}}, " +
                    setOf("c", 0, 0, 5000),
                ", regions: {box: {min: [0, 0, 0], max: [1, 1, 1]}, size: 0.5}");
  const auto surfaces = farSurfaces(recipe);
  std::filesystem::remove(file);
  ASSERT_EQ(surfaces.size(), 4u);
  const auto outside = notesOfOutside(recipe, surfaces, {false, true, true, false});
  ASSERT_EQ(outside.size(), 2u);
  EXPECT_EQ(outside[0], "joints.a: 1 of 2 lie wholly outside of the domain: line 3");
  EXPECT_EQ(outside[1], "joints.b: 1 of 1 lie wholly outside of the domain: plane 1");
  const auto sizes = notesOfSizes(recipe, low, high);
  ASSERT_EQ(sizes.size(), 2u);
  EXPECT_EQ(sizes[0].rfind("joints.c.set: spacing = 5000 m is more than the domain", 0), 0u);
  EXPECT_NE(sizes[1].find("region 1, from (0, 0, 0) to (1, 1, 1) m, lies outside of the domain, "
                          "which reaches from (500000, 4000000, 0)"),
            std::string::npos);
}

TEST(WorthOfCubes, isThatOfTheFinalElements)
{
  // A regular tetrahedron of edge 2, and a flat one: the worth of its cubes goes with the height.
  for (const Real flat : {1.0, 0.05})
  {
    GmshFile mesh;
    mesh.nodeIds = {1, 2, 3, 4};
    mesh.coordinates = {{0, 0, 0},
                        {2, 0, 0},
                        {1, std::sqrt(3.0), 0},
                        {1, std::sqrt(1.0 / 3), flat * std::sqrt(8.0 / 3)}};
    mesh.elements = {{{3, 1}, 4, 1, {0, 1, 2, 3}}};
    cutIntoCubes(mesh);
    ASSERT_EQ(mesh.elements.size(), 4u);
    Real worst = infinity, volume = 0;
    for (const GmshFile::Element& element : mesh.elements)
    {
      std::array<Vec3, 8> x;
      for (std::size_t k = 0; k < 8; ++k)
        x[k] = mesh.coordinates[std::size_t(element.nodes[k])];
      worst = std::min(worst, worthOf(x, 1));
      volume += elementVolume(ElementType::Hex8, x);
    }
    EXPECT_NEAR(volume, flat * std::sqrt(8.0) / 3, 1e-14);
    if (flat == 1)
      EXPECT_NEAR(worst, std::sqrt(0.5), 1e-14); // the shape at the corners of the tetrahedron
    else
      EXPECT_LE(worst, 0.05);
    EXPECT_GT(worst, 0);
  }
}

TEST(MeasureOfElements, findsGapsAndOverlaps)
{
  GmshFile mesh;
  mesh.coordinates = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.elements = {{{3, 1}, 4, 1, {0, 1, 2, 3}}, {{3, 1}, 4, 2, {1, 2, 3, 4}}};
  EXPECT_NEAR(measureOfElements(mesh, 3), 1.0 / 6 + 1.0 / 3, 1e-15);
  mesh.elements.push_back({{3, 1}, 4, 3, {1, 2, 3, 4}});
  EXPECT_TRUE(std::isnan(measureOfElements(mesh, 3)));
  mesh.elements = {{{2, 1}, 2, 1, {0, 2, 1}}, {{2, 1}, 3, 2, {0, 1, 4, 2}}, {{1, 1}, 1, 3, {0, 1}}};
  mesh.coordinates[4] = {1, 1, 0};
  EXPECT_NEAR(measureOfElements(mesh, 2), 1.5, 1e-15);
}
} // namespace
} // namespace coplane
