#include "Recipe.hpp"

#include "ExampleFile.hpp"
#include "JointRecipe.hpp"
#include "MakeMesh.hpp"
#include "RecipeReference.hpp"
#include "ShapeModel.hpp"

#include <coplane_core/Error.hpp>

#include <gtest/gtest.h>

#include <functional>

namespace coplane
{
namespace
{
std::string recipeErrorOf(const std::string& recipe)
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
      recipeErrorOf(head +
                    "  - shape: box\n    block: b\n    size: [1, 1]\n    divisons: [1, 1]\n"),
      "r.yaml:6:5: parts.0.divisons is not known. Did you mean 'divisions'? Accepted here: shape, "
      "block, split, rotate, about, offset, min, max, size, divisions, bias, lines.");
}

TEST(Recipe, aMissingKeyIsNamedAtItsMap)
{
  EXPECT_EQ(recipeErrorOf(head + "  - shape: box\n    block: b\n    size: [1, 1]\n"),
            "r.yaml:3:5: parts.0.divisions is missing; accepted: a list of whole numbers >= 1 "
            "[elements], or lines in its place.");
  EXPECT_EQ(recipeErrorOf(head + "  - {shape: cylinder, block: b, across: 4}\n"),
            "r.yaml:3:5: parts.0.radius is missing (shape: cylinder needs it); accepted: a number "
            "> 0 [m]: of the circle.");
}

TEST(Recipe, aKeyGivenTwiceIsRefused)
{
  EXPECT_EQ(recipeErrorOf("dimension: 2\ndimension: 3\nparts: []\n"),
            "r.yaml:2:1: dimension is given twice, first at r.yaml:1:1; keep one of them.");
}

TEST(Recipe, aKeyThatIsNoWordIsRefused)
{
  EXPECT_EQ(recipeErrorOf(head + "  - {shape: box, block: b, size: [1, 1], divisions: [1, 1]}\n"
                                 "node_sets: {~: {block: b}}\n"),
            "r.yaml:4:13: a key in node_sets is nothing; accepted: a word.");
}

TEST(Recipe, anUnknownShapeIsRefusedWithSuggestion)
{
  EXPECT_EQ(
      recipeErrorOf(head + "  - {shape: bax, block: b}\n"),
      "r.yaml:3:13: parts.0.shape = 'bax' is not known. Did you mean 'box'? Accepted: one of "
      "box, quadrilateral, hexahedron, wall, imbricate, rock, cylinder, sphere, projectile, ogive, "
      "sector, dome, cross_vault, half_disc.");
}

TEST(Recipe, anotherDimensionIsRefused)
{
  EXPECT_EQ(
      recipeErrorOf("dimension: 4\nparts: [{shape: box, block: b, size: [1, 1], divisions: [1, "
                    "1]}]\n"),
      "r.yaml:1:12: dimension = '4' is not known. Accepted: one of 2, 3.");
}

TEST(Recipe, aListOfTheWrongLengthIsRefused)
{
  EXPECT_EQ(
      recipeErrorOf(head + "  - {shape: box, block: b, size: [1, 1, 1], divisions: [1, 1]}\n"),
      "r.yaml:3:34: parts.0.size = a list of 3; accepted: a list of 2 numbers > 0 [m].");
}

TEST(Recipe, aLengthThatIsNotPositiveIsRefused)
{
  EXPECT_EQ(recipeErrorOf(head + "  - {shape: box, block: b, size: [1, 0], divisions: [1, 1]}\n"),
            "r.yaml:3:38: parts.0.size.1 = '0' is out of range; accepted: a number > 0 [m].");
}

TEST(Recipe, aLengthBeyondAllSceneryIsRefused)
{
  EXPECT_EQ(
      recipeErrorOf(head + "  - {shape: box, block: b, size: [1, 1e300], divisions: [1, 1]}\n"),
      "r.yaml:3:38: parts.0.size.1 = '1e300' is beyond 1e+12 m; accepted: a number > 0 [m].");
}

TEST(Recipe, withoutADimensionNothingElseIsAskedFor)
{
  EXPECT_EQ(recipeErrorOf("parts: [{shape: cylinder, block: b, radius: 1, across: 4}]\n"),
            "r.yaml:1:1: dimension is missing; accepted: one of 2, 3: of space; lists by dimension "
            "have as many numbers.");
  EXPECT_EQ(recipeErrorOf("parts: [{shape: box, block: b, lines: {x: [0, 1], y: [0, 1]}}]\n"),
            "r.yaml:1:1: dimension is missing; accepted: one of 2, 3: of space; lists by dimension "
            "have as many numbers.");
}

TEST(Recipe, aWordForANumberIsRefused)
{
  EXPECT_EQ(recipeErrorOf(head + "  - {shape: cylinder, block: b, radius: wide, across: 4}\n"),
            "r.yaml:3:41: parts.0.radius = 'wide' is not a number; accepted: a number > 0 [m].");
}

TEST(Recipe, whatIsForThreeDimensionsIsRefusedInTwo)
{
  EXPECT_EQ(
      recipeErrorOf(head + "  - {shape: cylinder, block: b, radius: 1, across: 4, along: 2}\n"),
      "r.yaml:3:62: parts.0.along is for three dimensions only; remove it.");
  EXPECT_EQ(
      recipeErrorOf("dimension: 3\nparts:\n  - {shape: cylinder, block: b, radius: 1, across: 4, "
                    "along: 2}\n"),
      "r.yaml:3:5: parts.0.length is missing (shape: cylinder needs it); accepted: a number "
      "> 0 [m]: along z, from z = 0.");
  EXPECT_EQ(
      recipeErrorOf("dimension: 3\nparts:\n  - {shape: imbricate, block: b, brick: [1, 2], layers: "
                    "2, length_in_bricks: 2, divisions: [1, 2]}\n"),
      "r.yaml:3:13: parts.0.shape = 'imbricate' needs two dimensions; use wall.");
  EXPECT_EQ(recipeErrorOf("dimension: 2\nparts: [{shape: hexahedron, block: b}]\n"),
            "r.yaml:2:17: parts.0.shape = 'hexahedron' needs three dimensions; use quadrilateral.");
}

TEST(Recipe, moreNodesThanAMeshCanHaveAreRefusedAtTheirPart)
{
  for (const std::string part :
       {"rock, size: [1, 1], blocks: [2000000000, 2000000000], divisions: [1, 1]",
        "wall, brick: [1, 1], courses: 1000000000, length_in_bricks: 1000, divisions: [2, 2]",
        "imbricate, brick: [1, 1], layers: 1000000000, length_in_bricks: 1000, divisions: [2, 2]",
        "cylinder, radius: 1, across: 1000000000",
        "sector, inner_radius: 1, outer_radius: 2, from: 0, to: 90, count: 2000000000, divisions: "
        "[1, 1]",
        "projectile, width: 1, length: 1e12, across: 4",
        "half_disc, radius: 1, fine: 1e-12, fine_radius: 0.1"})
  {
    const std::string error = recipeErrorOf(head + "  - {block: b, shape: " + part + "}\n");
    EXPECT_EQ(error.rfind("r.yaml:3:5: parts.0 asks for ", 0), 0u) << part << "\n" << error;
  }
}

TEST(Recipe, oneAngleTurnsInThePlaneAndThreeInSpace)
{
  EXPECT_EQ(recipeErrorOf(head +
                          "  - {shape: box, block: b, size: [1, 1], divisions: [1, 1], rotate: "
                          "[0, 0, 9]}\n"),
            "r.yaml:3:69: parts.0.rotate must be one number in two dimensions: the angle about z.");
}

TEST(Recipe, theNumbersOfDefineAreUsed)
{
  const std::string recipe = "define: {h: 0.25, n: 1/h}\n" + head +
                             "  - {shape: box, block: b, size: [4*h, 1], divisions: [n, 2]}\n";
  const Mesh mesh = makeMeshFromText(recipe, "r.yaml");
  EXPECT_EQ(mesh.elements(), 8);
  EXPECT_EQ(mesh.coordinates.back().x, 1);
  EXPECT_EQ(makeMeshFromText(recipe, "r.yaml", {"define.h=0.5"}).elements(), 4);
}

TEST(Recipe, oddDivisionsOfAWallAreRefused)
{
  EXPECT_EQ(recipeErrorOf(head + "  - {shape: wall, block: b, brick: [2, 1], courses: 2, "
                                 "length_in_bricks: 2, divisions: [3, 1]}\n"),
            "r.yaml:3:88: parts.0.divisions has 3 elements along a brick, and a half brick takes "
            "half of them; it must be even.");
}

TEST(Recipe, linesThatGoBackAreRefused)
{
  EXPECT_EQ(recipeErrorOf(head + "  - {shape: box, block: b, lines: {x: [0, 2, 1], y: [0, 1]}}\n"),
            "r.yaml:3:39: parts.0.lines.x.ends has 1 m after 2 m; coordinates must be ascending.");
}

TEST(Recipe, linesAndDivisionsTogetherAreRefused)
{
  EXPECT_EQ(recipeErrorOf(head +
                          "  - {shape: box, block: b, divisions: [1, 1], lines: {x: [0, 1], y: [0, "
                          "1]}}\n"),
            "r.yaml:3:39: parts.0.divisions has no place beside lines; leave one of them out.");
}

TEST(Recipe, cornersInTheWrongSenseAreRefused)
{
  EXPECT_EQ(recipeErrorOf(head +
                          "  - {shape: quadrilateral, block: b, corners: [[0, 0], [0, 1], [1, 1], "
                          "[1, 0]], divisions: [1, 1]}\n"),
            "r.yaml:3:47: parts.0.corners turn inside out at corner 1. Give them "
            "counter-clockwise; every angle is below 180 degrees.");
}

TEST(Recipe, aCornerOfTheWrongDimensionIsRefused)
{
  EXPECT_EQ(recipeErrorOf(head +
                          "  - {shape: quadrilateral, block: b, corners: [[0, 0], [0, 1, 2], [1, "
                          "1], [1, 0]], divisions: [1, 1]}\n"),
            "r.yaml:3:56: parts.0.corners.1 = a list of 3; accepted: a list of 2 numbers [m].");
}

TEST(Recipe, aSectorThatEndsBeforeItBeginsIsRefused)
{
  EXPECT_EQ(recipeErrorOf(head +
                          "  - {shape: sector, block: b, inner_radius: 1, outer_radius: 2, from: "
                          "90, to: 0, divisions: [1, 1]}\n"),
            "r.yaml:3:79: parts.0.to = 0 degrees must be greater than from = 90 degrees, by 360 "
            "at most.");
}

TEST(Recipe, aFineZoneLargerThanAQuarterOfTheRadiusIsRefused)
{
  EXPECT_EQ(recipeErrorOf(head + "  - {shape: half_disc, block: b, radius: 1, fine: 0.1, "
                                 "fine_radius: 0.6}\n"),
            "r.yaml:3:69: parts.0.fine_radius = 0.6 m must not exceed a quarter of the radius = "
            "0.25 m.");
}

TEST(Recipe, tetrahedraInTwoDimensionsAreRefused)
{
  EXPECT_EQ(recipeErrorOf(head +
                          "  - {shape: box, block: b, size: [1, 1], divisions: [1, 1], split: "
                          "tetrahedra}\n"),
            "r.yaml:3:68: parts.0.split = 'tetrahedra' needs three dimensions; use triangles.");
}

TEST(Recipe, twoElementTypesInABlockAreRefused)
{
  EXPECT_EQ(
      recipeErrorOf(head + "  - {shape: box, block: b, size: [1, 1], divisions: [1, 1]}\n"
                           "  - {shape: box, block: b, size: [1, 1], divisions: [1, 1], split: "
                           "triangles}\n"),
      "r.yaml:4:25: parts.1.block = 'b' has QUAD4 elements in other parts and TRI3 in this "
      "one; a block has elements of one type. Give this part a block of its own, or split all "
      "parts of the block.");
}

TEST(Recipe, aSetOfAnUnknownBlockIsRefusedWithSuggestion)
{
  EXPECT_EQ(recipeErrorOf(head + "  - {shape: box, block: bricks, size: [1, 1], divisions: [1, "
                                 "1]}\nnode_sets: {base: {block: brick}}\n"),
            "r.yaml:4:27: node_sets.base.block = 'brick' is no block of the parts. Did you mean "
            "'bricks'?");
}

TEST(Recipe, anEmptySelectionIsRefused)
{
  EXPECT_EQ(recipeErrorOf(head + "  - {shape: box, block: b, size: [1, 1], divisions: [1, "
                                 "1]}\nnode_sets: {far: {where: {x: 9}}}\n"),
            "r.yaml:4:26: node_sets.far.where selects no node. Compare it with the bounding box "
            "that coplane_mesh check prints.");
}

TEST(Recipe, invalidYamlIsNamedWithItsPlace)
{
  EXPECT_EQ(recipeErrorOf("dimension: [2\n").substr(0, 11), "r.yaml:1:12");
}

TEST(Recipe, allProblemsAreToldAtOnce)
{
  EXPECT_EQ(recipeErrorOf(head +
                          "  - {shape: box, block: b, size: [1, 1]}\n"
                          "  - {shape: half_disc, block: b, radius: 1, fine: 2, fine_radius: 0.5}\n"
                          "node_sets: {a: {where: {x: [1, 0]}}}\n"),
            "r.yaml:3:5: parts.0.divisions is missing; accepted: a list of whole numbers >= 1 "
            "[elements], or lines in its place.\n"
            "r.yaml:4:51: parts.1.fine = 2 m must not exceed fine_radius = 0.5 m.\n"
            "r.yaml:4:67: parts.1.fine_radius = 0.5 m must not exceed a quarter of the radius = "
            "0.25 m.\n"
            "r.yaml:5:28: node_sets.a.where.x = [1, 0]: the lower end comes first.");
}

TEST(Recipe, eachKeyIsDocumented)
{
  const std::function<void(const Key&)> check = [&](const Key& group)
  {
    for (const Key& key : group.keys)
    {
      EXPECT_FALSE(key.meaning.empty()) << key.name;
      EXPECT_TRUE(key.isGroup() || !key.example.empty()) << key.name;
      const bool number = key.kind == KeyKind::Number || key.kind == KeyKind::Integer ||
                          key.kind == KeyKind::Numbers || key.kind == KeyKind::Integers ||
                          key.kind == KeyKind::Points;
      EXPECT_EQ(number, !key.unit.empty()) << key.name << " [" << key.unit << "]";
      check(key);
    }
  };
  for (const Key* schema : {&recipeSchema(), &jointRecipeSchema(), &exampleSchema()})
    check(*schema);
}

TEST(Recipe, theReferenceHasEveryShapeWithItsKeys)
{
  for (const Reference& reference : recipeReferences())
    if (reference.option == "--help-recipe")
      for (const ShapeModel& shape : shapeModels())
      {
        EXPECT_NE(reference.text("").find(shape.name + ": " + shape.meaning), std::string::npos);
        for (const Key& key : shape.keys)
          EXPECT_NE(reference.text(shape.name).find("parts.<index>." + key.name),
                    std::string::npos);
      }
}
} // namespace coplane
