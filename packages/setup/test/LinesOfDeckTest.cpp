#include "WallOfTwo.hpp"

#include <coplane_setup/detail/LinesOfDeck.hpp>

namespace coplane
{
namespace
{
TEST(LinesOfDeck, areDividedAndShareTheirGrout)
{
  const Model model = modelOf(R"(
blocks: {lower: {material: rock}, upper: {material: rock}}
lines:
  bolt: {points: [[0.5, 1.5], [0.5, 0.5]], segment_length: 0.26, area: 1e-3, youngs_modulus: 200e9, spacing: 2,
         grout: {stiffness: 1e9, strength: 1e5}, copies: 2, copy_step: [0.25, 0, 0]}
  anchor: {points: [[0.1, 1.9], [0.1, 0.1]], attach: grout, segment_length: 0.4, free_length: 1, area: 1e-3,
           youngs_modulus: 200e9, grout: {stiffness: 1e9}, dowel: {stiffness: 1e7}}
  tie: {points: [[0.9, 1.9], [0.9, 0.1]], attach: ends, area: 1e-3, youngs_modulus: 200e9, yield_stress: 4e8}
  bar: {points: [[0.2, 0.5], [0.2, 1], [0.7, 1]], attach: perfect, segment_length: 0.3, area: 1e-3, youngs_modulus: 200e9}
)");
  ASSERT_EQ(model.lines.size(), 5u);
  const LineSetup &bolt = model.lines[0], &anchor = model.lines[2], &tie = model.lines[3],
                  &bar = model.lines[4];
  EXPECT_EQ(bolt.name, "bolt_1");
  EXPECT_EQ(model.lines[1].name, "bolt_2");
  EXPECT_DOUBLE_EQ(model.lines[1].points[0].place.x, 0.75);
  EXPECT_DOUBLE_EQ(bolt.section.area, 5e-4); // of one metre out of the plane
  EXPECT_DOUBLE_EQ(bolt.bond.strength, 5e4);
  EXPECT_DOUBLE_EQ(bolt.bond.stiffness, 5e8);
  ASSERT_EQ(bolt.points.size(), 5u); // four pieces of 0.25 m
  Real grouted = 0;
  for (const LinePoint& point : bolt.points)
  {
    EXPECT_FALSE(point.tied);
    grouted += point.bonded;
  }
  EXPECT_NEAR(grouted, 1, 1e-14);
  EXPECT_DOUBLE_EQ(bolt.points[0].bonded, 0.125);
  EXPECT_FALSE(bolt.dowel);

  ASSERT_EQ(anchor.points.size(), 4u); // the free length, and 0.8 m in two
  EXPECT_TRUE(anchor.points[0].tied);
  EXPECT_NEAR(anchor.points[1].place.y, 0.9, 1e-14);
  EXPECT_NEAR(anchor.points[1].bonded, 0.2, 1e-14);
  EXPECT_NEAR(anchor.points[2].bonded, 0.4, 1e-14);
  EXPECT_EQ(anchor.bare, 1);
  EXPECT_TRUE(anchor.dowel);
  EXPECT_EQ(anchor.bond.strength, infinity);

  ASSERT_EQ(tie.points.size(), 2u);
  EXPECT_TRUE(tie.points[0].tied && tie.points[1].tied);
  EXPECT_DOUBLE_EQ(tie.section.yieldStress, 4e8);

  ASSERT_EQ(bar.points.size(), 5u); // two pieces of 0.25 m on each leg
  EXPECT_DOUBLE_EQ(bar.points[2].place.y, 1);
  for (const LinePoint& point : bar.points)
    EXPECT_TRUE(point.tied);
}

TEST(LinesOfDeck, bendWithADiameterAndEndOnPlanesOfSymmetry)
{
  const Model model = modelOf(R"(
blocks: {lower: {material: rock}, upper: {material: rock}}
lines:
  bar: {points: [[0.5, 1.5], [0.5, 0.5]], segment_length: 0.25, area: 1e-3, youngs_modulus: 200e9, spacing: 2,
        grout: {stiffness: 1e9}, diameter: 0.02, mirrored: end}
  whole: {points: [[0.2, 1.5], [0.2, 0.5]], segment_length: 0.25, area: 1e-3, youngs_modulus: 200e9,
          grout: {stiffness: 1e9}, mirrored: both}
)");
  const LineSetup &bar = model.lines[0], &whole = model.lines[1];
  EXPECT_EQ(bar.section.diameter, 0.02);
  EXPECT_DOUBLE_EQ(bar.section.area, 5e-4);
  EXPECT_FALSE(bar.mirrored[0]);
  EXPECT_TRUE(bar.mirrored[1]);
  EXPECT_FALSE(bar.points.front().tied);
  EXPECT_TRUE(bar.points.back().tied);
  EXPECT_EQ(whole.section.diameter, 0);
  EXPECT_TRUE(whole.points.front().tied && whole.points.back().tied);
}

TEST(LinesOfDeck, haveGroutFromTheEndOfTheFreeLengthOnAlsoWhereThatIsACorner)
{
  const Model model = modelOf(R"(
blocks: {lower: {material: rock}, upper: {material: rock}}
lines:
  straight: {points: [[0.1, 1.9], [0.1, 0.1]], segment_length: 0.5, free_length: 0.8, area: 1e-3, youngs_modulus: 200e9, grout: {stiffness: 1e9}}
  corner: {points: [[0.1, 1.9], [0.1, 1.1], [0.1, 0.1]], segment_length: 0.5, free_length: 0.8, area: 1e-3, youngs_modulus: 200e9,
           grout: {stiffness: 1e9}}
)");
  const auto &straight = model.lines[0].points, &corner = model.lines[1].points;
  ASSERT_EQ(straight.size(), 4u);
  ASSERT_EQ(corner.size(), 4u);
  for (std::size_t i = 0; i < corner.size(); ++i)
  {
    EXPECT_NEAR(norm(corner[i].place - straight[i].place), 0, 1e-14);
    EXPECT_NEAR(corner[i].bonded, straight[i].bonded, 1e-14);
    EXPECT_EQ(corner[i].tied, straight[i].tied);
  }
}
} // namespace
} // namespace coplane
