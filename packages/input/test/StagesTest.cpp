#include <coplane_core/Error.hpp>
#include <coplane_input/DeckChecks.hpp>
#include <coplane_input/DeckReader.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
const std::string head =
    "mesh: a.e\n"
    "define: {p: 1e5, mu: 0.3}\n"
    "materials: {rock: {model: linear_elastic, density: 2600, youngs_modulus: 1e10, "
    "poisson_ratio: 0.2}}\n"
    "blocks: {rock: {material: rock}, core: {material: rock}, lining: {material: rock}, tool: "
    "{material: rock, rigid: true}}\n"
    "joints: {dry: {friction: 2*mu}}\n"
    "conditions: [{type: pressure, side_set: wall, value: p, from: 0.5, until: 1.5}]\n"
    "damping: {kinetic: true, until_force_ratio: 1e-6}\n"
    "time: {end: 4}\n";

std::vector<Deck> decksOf(const std::string& stages)
{
  return parseStages(head + stages, "a.yaml");
}

std::string errorOfStages(const std::string& stages)
{
  try
  {
    decksOf(stages);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "no error";
}

void expectError(const std::string& stages, const std::string& text)
{
  const std::string error = errorOfStages(stages);
  EXPECT_NE(error.find(text), std::string::npos) << error;
}
} // namespace

TEST(Stages, areDecksWithTheChangesOfThoseBefore)
{
  const auto decks =
      decksOf("stages:\n"
              "  - {name: a, until: 1, at_rest: true}\n"
              "  - {name: b, until: 2, remove: [core], set: {joints.dry.friction: mu, "
              "conditions.0.value: \"2*p*t\"}}\n"
              "  - {name: c, add: [lining], zero_displacements: true, set: {damping: "
              "null, gravity: [0, -9.81, 0], conditions.0.until: null}}\n");
  ASSERT_EQ(decks.size(), 3u);
  EXPECT_EQ(decks[0].time.end, 1);
  EXPECT_TRUE(decks[0].time.endAtRest);
  EXPECT_EQ(decks[1].time.end, 2);
  EXPECT_FALSE(decks[1].time.endAtRest);
  EXPECT_EQ(decks[2].time.end, 4);
  EXPECT_EQ(decks[0].conditions[0].pressure.constant, 1e5);
  EXPECT_EQ(decks[0].conditions[0].from, 0.5);
  EXPECT_EQ(decks[0].conditions[0].until, 1.5);
  EXPECT_EQ(decks[1].conditions[0].pressure.expression, "2*100000*t");
  EXPECT_EQ(decks[2].conditions[0].pressure.expression, "2*100000*t");
  EXPECT_FALSE(decks[2].conditions[0].until);
  EXPECT_TRUE(decks[1].kineticDamping);
  EXPECT_FALSE(decks[2].kineticDamping);
  EXPECT_EQ(decks[1].gravity[1].constant, 0);
  EXPECT_EQ(decks[2].gravity[1].constant, -9.81);
  EXPECT_EQ(decks[2].stages[1].remove, std::vector<std::string>{"core"});
  EXPECT_TRUE(decks[2].stages[2].zeroDisplacements);
  EXPECT_EQ(absentAtStart(decks[0]), std::vector<std::string>{"lining"});
  // The text of the run stands alone: no name of `define` is left in it.
  EXPECT_EQ(parseStages(decks[0].text, "b.yaml")[1].conditions[0].pressure.expression,
            "2*100000*t");
}

TEST(Stages, changeCardsWhoseNamesHaveDots)
{
  const std::string dotted =
      "mesh: a.e\n"
      "materials: {rock.1: {model: mohr_coulomb, density: 2600, youngs_modulus: 1e10, "
      "poisson_ratio: 0.2, cohesion: 1e6, friction: 0.6}}\n"
      "blocks: {b.1: {material: rock.1, erosion: {plastic_strain: 0.5}}}\n"
      "joints: {set.1: {friction: 0.6, cohesion: 1e5}, glue.v1: {model: mortar, normal_stiffness: "
      "1e10, cohesion: 1e5, tensile_strength: 1e5, tension_energy: 10, shear_energy: 10}}\n"
      "time: {end: 2}\n"
      "stages:\n"
      "  - {name: a, until: 1}\n"
      "  - {name: b, set: {";
  const auto decks =
      parseStages(dotted + "joints.set.1.friction: 0.3, joints.set.1.cohesion: null, "
                           "materials.rock.1.cohesion: 1e5, blocks.b.1.erosion: null}}\n",
                  "a.yaml");
  EXPECT_EQ(decks[1].joints[0].name, "set.1");
  EXPECT_EQ(decks[1].joints.size(), 2u);
  EXPECT_FALSE(decks[1].blocks[0].erosion.any());
  EXPECT_NE(decks[1].text.find("set.1: {friction: 0.3}"), std::string::npos) << decks[1].text;
  EXPECT_NE(decks[1].text.find("cohesion: 1e5, friction: 0.6}"), std::string::npos);
  try
  {
    parseStages(dotted + "joints.glue.v1.cohesion: 2e5}}\n", "a.yaml");
    FAIL() << "not refused";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what())
                  .find("joints.glue.v1.cohesion was 100000 and is 200000 now; a stage cannot"),
              std::string::npos)
        << error.what();
  }
}

TEST(Stages, aDeckWithoutThemHasOne)
{
  const auto decks = decksOf("");
  ASSERT_EQ(decks.size(), 1u);
  EXPECT_EQ(decks[0].time.end, 4);
}

TEST(Stages, refuseWhatTheyCannotDo)
{
  const std::string first = "stages:\n  - {name: a, until: 1}\n  - ";
  expectError("stages: [{name: a}, {name: b}]\n", "stages.0.until is missing");
  expectError(first + "{name: a}\n", "stages.1.name = 'a' is taken");
  expectError(first + "{name: b, until: 0.5}\n",
              "stages.1.until = 0.5 s; accepted: later than the end of the stage before, 1 s");
  expectError(first + "{name: b, until: 9}\n", "not later than time.end = 4 s");
  expectError(first + "{name: b, remove: [cor]}\n", "Did you mean 'core'?");
  expectError(first + "{name: b, remove: [tool]}\n", "block 'tool' is rigid");
  const std::string removed = "{name: b, until: 2, remove: [core]}\n  - ";
  expectError(first + removed + "{name: c, remove: [core]}\n",
              "stages.2.remove: block 'core' is not there in this stage");
  expectError(first + "{name: b, until: 2, remove: [core]}\n  - {name: c, until: 3, add: [core]}\n"
                      "  - {name: d, add: [core]}\n",
              "stages.3.add: block 'core' is already there in this stage");
  expectError(first + "{name: b, add: [lining]}\n"
                      "initial: [{block: lining, stress: [1, 0, 0, 0, 0, 0]}]\n",
              "block 'lining' is not there at the start");
}

TEST(Stages, addAndTakeOutSingleConditions)
{
  const auto decks = decksOf(
      "stages:\n"
      "  - {name: a, until: 1}\n"
      "  - {name: b, until: 2, set: {conditions.1: {type: fixed, node_set: base}, conditions.2: "
      "{type: fixed, node_set: lid}}}\n"
      "  - {name: c, until: 3, set: {conditions.1: null}}\n"
      "  - {name: d, set: {conditions.0: null, conditions.2.components: [x]}}\n");
  const auto setsOf = [](const Deck& deck)
  {
    std::vector<std::string> sets;
    for (const ConditionCard& card : deck.conditions)
      sets.push_back(card.set);
    return sets;
  };
  using Sets = std::vector<std::string>;
  EXPECT_EQ(setsOf(decks[0]), Sets({"wall"}));
  EXPECT_EQ(setsOf(decks[1]), Sets({"wall", "base", "lid"}));
  EXPECT_EQ(setsOf(decks[2]), Sets({"wall", "lid"}));
  EXPECT_EQ(setsOf(decks[3]), Sets({"lid"})); // which is still number 2
  EXPECT_FALSE(decks[3].conditions[0].components[1]);
}

TEST(Stages, bringTheFirstConditionOfADeckWithoutAny)
{
  std::string bare = head;
  bare.erase(bare.find("conditions:"), bare.find("damping:") - bare.find("conditions:"));
  const auto decks =
      parseStages(bare + "gravity: [0, -p, 0]\n"
                         "stages:\n"
                         "  - {name: a, until: 1}\n"
                         "  - {name: b, set: {conditions.0: {type: fixed, node_set: base}}}\n",
                  "a.yaml");
  EXPECT_TRUE(decks[0].conditions.empty());
  ASSERT_EQ(decks[1].conditions.size(), 1u);
  EXPECT_EQ(decks[1].conditions[0].set, "base");
}

TEST(Stages, changeNothingThatTheStateHolds)
{
  const std::string first = "stages:\n  - {name: a, until: 1}\n  - ";
  expectError(first + "{name: b, set: {materials.rock.density: 3000}}\n",
              "materials.rock.density was 2600 and is 3000 now; a stage cannot change this");
  expectError(first + "{name: b, set: {output.every: 1}}\n",
              "stages.1.set: a stage cannot change output.every. Accepted: conditions, gravity");
  expectError(first + "{name: b, set: {joints.wet.friction: 0.1}}\n", "joints.wet.friction");
  expectError(first + "{name: b, set: {conditions.7.value: 0.1}}\n",
              "'7' is no item of conditions, which has 1");
  expectError(first + "{name: b, set: {conditions.2: {type: fixed, node_set: base}}}\n",
              "'2' is no item of conditions, which has 1");
  expectError("stages: [{name: a, until: 1, remove: [core]}, {name: b}]\n",
              "stages.0.remove: the first stage is the deck as it stands");
  expectError(first + "{name: b, at_rest: true, set: {damping: {local: 0.5}}}\n",
              "stages.1.at_rest has no effect without");
}

TEST(Conditions, endAfterTheyBegin)
{
  std::string deck = head;
  deck.replace(deck.find("until: 1.5"), 10, "until: 0.5");
  try
  {
    parseDeck(deck, "a.yaml");
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what())
                  .find("conditions.0.until = 0.5 s is not after conditions.0.from = 0.5 s"),
              std::string::npos)
        << error.what();
  }
}
} // namespace coplane
