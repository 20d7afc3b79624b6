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

TEST(DeckWarnings, timesThatTheRunNeverComesTo)
{
  EXPECT_EQ(warningsOf("damping: {local: 0.7, from: 2}\n"),
            (std::vector<std::string>{
                "wall.yaml:5:29: damping.from = 2 s, but the run ends at time.end = 1 s."}));
  const auto ofLine = [](const std::string& keys)
  {
    return warningsOf("lines: {bar: {points: [[0, 0], [1, 0]], attach: ends, area: 1e-3, "
                      "youngs_modulus: 2e11, pretension: 1e3" +
                      keys + "}}\n");
  };
  EXPECT_EQ(ofLine(", pretension_time: 1"), std::vector<std::string>());
  ASSERT_EQ(ofLine(", from: 2").size(), 1u);
  EXPECT_NE(ofLine(", from: 2")[0].find("lines.bar.from = 2 s, but the run ends"),
            std::string::npos);
  ASSERT_EQ(ofLine(", pretension_time: 0.6, from: 0.5").size(), 1u);
  EXPECT_NE(ofLine(", pretension_time: 0.6, from: 0.5")[0].find(
                "there from 0.5 to 1 s, so it is never pulled on in full"),
            std::string::npos);
}

TEST(DeckWarnings, tablesThatDoNotVaryWhileTheyAct)
{
  const auto ofPressure = [](const std::string& keys)
  { return warningsOf("conditions: [{type: pressure, side_set: roof, " + keys + "}]\n"); };
  EXPECT_EQ(ofPressure("value: {times: [0, 5], values: [0, 1e6]}"), std::vector<std::string>());
  EXPECT_EQ(ofPressure("value: {times: [2, 5], values: [1e6, 1e6]}"), std::vector<std::string>());
  EXPECT_EQ(ofPressure("value: {times: [2, 5], values: [0, 1e6]}"),
            (std::vector<std::string>{
                "wall.yaml:5:54: conditions.0.value: the table has times from 2 to 5 s and is "
                "constant from 0 to 1 s, while it acts. Times are in s, from the start of the run "
                "on."}));
  EXPECT_EQ(ofPressure("value: {times: [0, 0.1], values: [0, 1e6]}, from: 0.2").size(), 1u);
  EXPECT_EQ(ofPressure("value: {times: [0, 5, 6], values: [0, 0, 1e6]}").size(), 1u);
  EXPECT_EQ(warningsOf("gravity: [0, {times: [2, 5], values: [0, -9.81]}, 0]\n").size(), 1u);
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
