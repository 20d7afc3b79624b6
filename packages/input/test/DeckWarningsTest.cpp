#include "TestDecks.hpp"

namespace coplane
{
namespace
{
std::vector<std::string> warningsOf(const std::string& lines)
{
  return parseDeck(leastDeck + lines, "wall.yaml").warnings;
}
} // namespace

TEST(DeckWarnings, whatIsUsualHasNone)
{
  EXPECT_EQ(warningsOf(""), std::vector<std::string>());
  EXPECT_EQ(warningsOf("gravity: [0, -9.81, 0]\noutput: {every: 1, times: [0.5, 1]}\n"),
            std::vector<std::string>());
}

TEST(DeckWarnings, outputsThatTheRunNeverComesTo)
{
  EXPECT_EQ(warningsOf("output: {every: 2, times: [0.5, 3]}\nhistory: {every: 1.5}\n"),
            (std::vector<std::string>{
                "wall.yaml:5:17: output.every = 2 s is longer than the run (time.end = 1 s): only "
                "its first and last state are written.",
                "wall.yaml:5:27: output.times has 3 s, but the run ends at time.end = 1 s.",
                "wall.yaml:6:18: history.every = 1.5 s is longer than the run (time.end = 1 s): "
                "only its first and last state are written."}));
}

TEST(DeckWarnings, aWeightThatLifts)
{
  EXPECT_EQ(warningsOf("gravity: [0, 9.81, 0]\n"),
            (std::vector<std::string>{"wall.yaml:5:14: gravity.1 = 9.81 m/s^2 pulls along +y, "
                                      "upwards where y points up; there it is -9.81."}));
}

TEST(DeckWarnings, aJointThatActsNowhere)
{
  const std::string joints = "joints: {slick: {model: penalty}, slik: {model: penalty}}\n";
  EXPECT_EQ(warningsOf(joints + "contact: {default_joint: slick, pairs: [{blocks: [\"*\", \"*\"], "
                                "joint: slik}]}\n"),
            std::vector<std::string>());
  const std::vector<std::string> warnings =
      warningsOf(joints + "contact: {default_joint: slick}\n");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("joints.slik acts nowhere"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("Did you mean 'slick'?"), std::string::npos) << warnings[0];
}

TEST(DeckWarnings, theUsualRangeIsThatOfTheModel)
{
  const auto ofDensity = [](const std::string& model)
  {
    return parseDeck("{mesh: wall.e, blocks: {bar: {material: m}}, time: {end: 1}, "
                     "materials: {m: {density: 1.2, " +
                         model + "}}}\n",
                     "wall.yaml")
        .warnings.size();
  };
  EXPECT_EQ(ofDensity("model: ideal_gas, heat_ratio: 1.4, pressure: 1e5"), 0u);
  EXPECT_EQ(ofDensity("model: linear_elastic, youngs_modulus: 1e9, poisson_ratio: 0.2"), 1u);
}
} // namespace coplane
