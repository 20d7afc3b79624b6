#include "MakeMesh.hpp"

#include <coplane_core/Error.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
std::string errorOf(const std::string& recipe)
{
  try
  {
    makeMeshFromText(recipe, "r.yaml");
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Deck);
    return error.what();
  }
  return "no error";
}

const std::string head = "dimension: 2\nparts:\n";
} // namespace

TEST(Recipe, aMisspeltKeyIsNamedWithPlaceAndSuggestion)
{
  EXPECT_EQ(
      errorOf(head + "  - shape: box\n    block: b\n    size: [1, 1]\n    divisons: [1, 1]\n"),
      "r.yaml:6:5: parts[0].divisons is not known; parts[0] accepts shape, block, split, rotate, "
      "about, offset, min, max, size, "
      "divisions, bias, lines. Did you mean 'divisions'?");
}

TEST(Recipe, aMissingKeyIsNamedAtItsMap)
{
  EXPECT_EQ(errorOf(head + "  - shape: box\n    block: b\n    size: [1, 1]\n"),
            "r.yaml:3:5: parts[0].divisions is missing.");
}

TEST(Recipe, aKeyGivenTwiceIsRefused)
{
  EXPECT_EQ(errorOf("dimension: 2\ndimension: 3\nparts: []\n"),
            "r.yaml:2:1: dimension is given twice; keep one.");
}

TEST(Recipe, aKeyThatIsNoWordIsRefused)
{
  EXPECT_EQ(errorOf("? [a, b]\n: 2\n"), "r.yaml:1:3: a key in the recipe is no word; accepted: a "
                                        "word, such as 'parts:'.");
  EXPECT_EQ(errorOf(head + "  - {shape: box, block: b, size: [1, 1], divisions: [1, 1]}\n"
                           "node_sets: {~: {block: b}}\n"),
            "r.yaml:4:13: a key in node_sets is no word; accepted: a word, such as 'parts:'.");
}

TEST(Recipe, anUnknownShapeIsRefusedWithSuggestion)
{
  EXPECT_EQ(
      errorOf(head + "  - {shape: bax, block: b}\n"),
      "r.yaml:3:13: parts[0].shape = 'bax' is not known; use box, quadrilateral, hexahedron, wall, "
      "imbricate, rock, cylinder, projectile, ogive, sector or half_disc. Did you mean "
      "'box'?");
}

TEST(Recipe, aListOfTheWrongLengthIsRefused)
{
  EXPECT_EQ(errorOf(head + "  - {shape: box, block: b, size: [1, 1, 1], divisions: [1, 1]}\n"),
            "r.yaml:3:34: parts[0].size must be a list of 2 lengths [m].");
}

TEST(Recipe, aLengthThatIsNotPositiveIsRefused)
{
  EXPECT_EQ(errorOf(head + "  - {shape: box, block: b, size: [1, 0], divisions: [1, 1]}\n"),
            "r.yaml:3:34: parts[0].size has the entry 0 m; every length must be greater than 0.");
}

TEST(Recipe, aWordForANumberIsRefused)
{
  EXPECT_EQ(errorOf(head + "  - {shape: cylinder, block: b, radius: wide, across: 4}\n"),
            "r.yaml:3:41: parts[0].radius = 'wide' is not a number.");
}

TEST(Recipe, oddDivisionsOfAWallAreRefused)
{
  EXPECT_EQ(errorOf(head + "  - {shape: wall, block: b, brick: [2, 1], courses: 2, "
                           "length_in_bricks: 2, divisions: [3, 1]}\n"),
            "r.yaml:3:88: parts[0].divisions has 3 elements along a brick, and a half brick takes "
            "half of them; it must be even.");
}

TEST(Recipe, linesThatGoBackAreRefused)
{
  EXPECT_EQ(errorOf(head + "  - {shape: box, block: b, lines: {x: [0, 2, 1], y: [0, 1]}}\n"),
            "r.yaml:3:39: parts[0].lines.x has 1 m after 2 m; coordinates must be ascending.");
}

TEST(Recipe, linesAndDivisionsTogetherAreRefused)
{
  EXPECT_EQ(errorOf(head +
                    "  - {shape: box, block: b, divisions: [1, 1], lines: {x: [0, 1], y: [0, "
                    "1]}}\n"),
            "r.yaml:3:39: parts[0].divisions has no place beside lines; leave one of them out.");
}

TEST(Recipe, cornersInTheWrongSenseAreRefused)
{
  EXPECT_EQ(errorOf(head + "  - {shape: quadrilateral, block: b, corners: [[0, 0], [0, 1], [1, 1], "
                           "[1, 0]], divisions: [1, 1]}\n"),
            "r.yaml:3:47: parts[0].corners turn inside out at corner 1. Give them "
            "counter-clockwise; every angle is below 180 degrees.");
}

TEST(Recipe, aCornerOfTheWrongDimensionIsRefused)
{
  EXPECT_EQ(
      errorOf(head + "  - {shape: quadrilateral, block: b, corners: [[0, 0], [0, 1, 2], [1, "
                     "1], [1, 0]], divisions: [1, 1]}\n"),
      "r.yaml:3:47: parts[0].corners has as entry 2 no point; a point is a list of 2 numbers.");
}

TEST(Recipe, aSectorThatEndsBeforeItBeginsIsRefused)
{
  EXPECT_EQ(errorOf(head + "  - {shape: sector, block: b, inner_radius: 1, outer_radius: 2, from: "
                           "90, to: 0, divisions: [1, 1]}\n"),
            "r.yaml:3:79: parts[0].to = 0 degrees must be greater than from = 90 degrees, by 360 "
            "at most.");
}

TEST(Recipe, aFineZoneLargerThanAQuarterOfTheRadiusIsRefused)
{
  EXPECT_EQ(errorOf(head + "  - {shape: half_disc, block: b, radius: 1, fine: 0.1, "
                           "fine_radius: 0.6}\n"),
            "r.yaml:3:69: parts[0].fine_radius = 0.6 m must not exceed a quarter of the radius = "
            "0.25 m.");
}

TEST(Recipe, tetrahedraInTwoDimensionsAreRefused)
{
  EXPECT_EQ(errorOf(head + "  - {shape: box, block: b, size: [1, 1], divisions: [1, 1], split: "
                           "tetrahedra}\n"),
            "r.yaml:3:68: parts[0].split = 'tetrahedra' needs three dimensions; use triangles.");
}

TEST(Recipe, twoElementTypesInABlockAreRefused)
{
  EXPECT_EQ(
      errorOf(head + "  - {shape: box, block: b, size: [1, 1], divisions: [1, 1]}\n"
                     "  - {shape: box, block: b, size: [1, 1], divisions: [1, 1], split: "
                     "triangles}\n"),
      "r.yaml:4:25: parts[1].block = 'b' has QUAD4 elements in other parts and TRI3 in this "
      "one; a block has elements of one type. Give this part a block of its own, or split all "
      "parts of the block.");
}

TEST(Recipe, aSetOfAnUnknownBlockIsRefusedWithSuggestion)
{
  EXPECT_EQ(errorOf(head + "  - {shape: box, block: bricks, size: [1, 1], divisions: [1, "
                           "1]}\nnode_sets: {base: {block: brick}}\n"),
            "r.yaml:4:27: node_sets.base.block = 'brick' is no block of the parts. Did you mean "
            "'bricks'?");
}

TEST(Recipe, anEmptySelectionIsRefused)
{
  EXPECT_EQ(errorOf(head + "  - {shape: box, block: b, size: [1, 1], divisions: [1, "
                           "1]}\nnode_sets: {far: {where: {x: 9}}}\n"),
            "r.yaml:4:26: node_sets.far.where selects no node. Compare it with the bounding box "
            "that coplane_mesh check prints.");
}

TEST(Recipe, invalidYamlIsNamedWithItsPlace)
{
  EXPECT_EQ(errorOf("dimension: [2\n").substr(0, 8), "r.yaml:2");
}

TEST(Recipe, everyShapeAndKeyOfTheHelpIsThere)
{
  const std::string help = recipeHelp();
  for (const char* word :
       {"box",        "wall",      "imbricate", "projectile",   "rock",
        "cylinder",   "rotate",    "about",     "offset",       "where_own",
        "node_sets",  "side_sets", "normal",    "courses",      "length_in_bricks",
        "layers",     "across",    "along",     "section",      "quadrilateral",
        "hexahedron", "corners",   "sector",    "inner_radius", "outer_radius",
        "count",      "half_disc", "fine",      "fine_radius",  "lines",
        "ends",       "bias",      "split",     "triangles",    "tetrahedra",
        "ogive",      "caliber",   "nose"})
    EXPECT_NE(help.find(word), std::string::npos) << word;
}
} // namespace coplane
