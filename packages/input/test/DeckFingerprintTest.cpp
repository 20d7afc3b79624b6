#include <coplane_input/DeckFingerprint.hpp>
#include <coplane_input/DeckReader.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
const std::string deck = "title: a\n"
                         "mesh: a.e\n"
                         "materials: {steel: {density: 7850, model: j2}}\n"
                         "conditions:\n"
                         "  - {type: fixed, node_set: left}\n"
                         "time: {end: 1, step_factor: 0.8}\n"
                         "history: {every: 1e-3, joints: [\"*\"]}\n"
                         "output: {every: 0.1}\n";

using Texts = std::vector<std::string>;

DeckChanges between(const std::string& before, const std::string& now, int stage = 0)
{
  return deckChanges(deckFingerprint(before, "a.yaml"), deckFingerprint(now, "b.yaml"), stage);
}

/// All of them.
Texts changes(const std::string& other)
{
  const DeckChanges found = between(deck, other);
  Texts texts = found.refused;
  texts.insert(texts.end(), found.allowed.begin(), found.allowed.end());
  return texts;
}

std::string with(const std::string& old, const std::string& text)
{
  std::string changed = deck;
  return changed.replace(changed.find(old), old.size(), text);
}
} // namespace

TEST(DeckFingerprint, aDeckWithNamesIsThatWithNumbers)
{
  const auto deckOf = [](const std::string& define, const std::string& speed)
  {
    return parseDeck(define +
                         "mesh: a.e\n"
                         "materials: {m: {model: linear_elastic, density: 7850, youngs_modulus: "
                         "2e11, poisson_ratio: 0.3}}\n"
                         "blocks: {bar: {material: m}}\n"
                         "conditions: [{type: velocity, node_set: a, value: [\"" +
                         speed +
                         "*t\", 0, 0]}]\n"
                         "initial: [{block: bar, velocity: [" +
                         speed + ", 0, 0]}]\ntime: {end: 1}\n",
                     "a.yaml");
  };
  const Deck named = deckOf("define: {h: 0.1, v: 7*h}\n", "v"), plain = deckOf("", "0.7");
  EXPECT_EQ(named.initial[0].velocity.x, 7 * 0.1);
  EXPECT_EQ(named.text.find("define"), std::string::npos);
  EXPECT_NE(named.text.find("0.7000000000000001*t"), std::string::npos) << named.text;
  const DeckChanges found = between(deckOf("define: {v: 0.7}\n", "v").text, plain.text);
  EXPECT_EQ(found.refused, Texts());
  EXPECT_EQ(found.allowed, Texts());
}

TEST(DeckFingerprint, listsValuesByTheirPlacesInOrder)
{
  EXPECT_EQ(deckFingerprint(deck, "a.yaml"), "conditions.0.node_set = left\n"
                                             "conditions.0.type = fixed\n"
                                             "history.joints.0 = *\n"
                                             "materials.steel.density = 7850\n"
                                             "materials.steel.model = j2\n"
                                             "time.step_factor = 0.8\n");
}

TEST(DeckFingerprint, doesNotDependOnHowThingsAreWritten)
{
  EXPECT_TRUE(changes(with("density: 7850, model: j2", "model: j2, density: 7.85e3")).empty());
}

TEST(DeckFingerprint, isTheSameWhenSetChangesWhatMayChange)
{
  // Materials of the library, named by a block and by a card: --set writes the deck with all of
  // their values.
  const std::string text = "mesh: a.e\n"
                           "materials: {mine: {set: concrete_c40, tensile_strength: 3e6}}\n"
                           "blocks: {a: {material: concrete_c40}, b: {material: mine}}\n"
                           "time: {end: 1}\n";
  const std::string changed = parseDeck(text, "a.yaml", {"time.end=2"}).text;
  EXPECT_NE(changed, text);
  EXPECT_EQ(deckFingerprint(changed, "a.yaml"), deckFingerprint(text, "a.yaml"));
}

TEST(DeckFingerprint, leavesOutWhatMayChange)
{
  EXPECT_TRUE(changes(with("end: 1,", "end: 2,")).empty());
  EXPECT_TRUE(changes(with("{every: 0.1}", "{every: 0.2, planes: false}")).empty());
  EXPECT_TRUE(changes(with("every: 1e-3", "every: 0")).empty());
  EXPECT_TRUE(changes(with("title: a", "title: b")).empty());
}

TEST(DeckDifferences, nameWhatChangedWhatIsNewAndWhatIsGone)
{
  EXPECT_EQ(changes(with("7850", "7800")),
            Texts{"materials.steel.density was 7850 and is 7800 now"});
  EXPECT_EQ(changes(with(", step_factor: 0.8", "")),
            Texts{"time.step_factor was 0.8 and is not there now"});
  EXPECT_EQ(
      changes(deck + "gravity: [0, -9.81, 0]\n"),
      (Texts{"gravity.0 is 0 now and was not there", "gravity.1 is -9.81 now and was not there",
             "gravity.2 is 0 now and was not there"}));
}

TEST(DeckChanges, ofStrengthsLoadsAndDampingsAreAllowedAndOfWhatTheStateHoldsRefused)
{
  const std::string plain =
      "materials:\n"
      "  rock: {model: mohr_coulomb, density: 2600, youngs_modulus: 1e10, cohesion: 1e6}\n"
      "  gas: {model: ideal_gas, density: 1, heat_ratio: 1.4}\n"
      "joints:\n"
      "  dry: {model: linear, normal_stiffness: 1e10, friction: 0.6, cohesion: 1e5}\n"
      "  glued: {model: mortar, normal_stiffness: 1e10, friction: 0.6, cohesion: 1e5}\n"
      "conditions: [{type: pressure, side_set: a, value: 1}]\n"
      "gravity: [0, -9.81, 0]\n"
      "contact: {skin: 0.1, damping: {normal: 0.1}}\n"
      "stages: [{name: a, until: 1}, {name: b, until: 2, remove: [core]}, {name: c}]\n";
  const auto change = [&](const std::string& old, const std::string& text, int stage = 0)
  {
    std::string other = plain;
    other.replace(other.find(old), old.size(), text);
    const DeckChanges found = between(plain, other, stage);
    EXPECT_EQ(found.allowed.size() + found.refused.size(), 1u) << text;
    return found.refused.empty();
  };
  EXPECT_TRUE(change("cohesion: 1e6", "cohesion: 2e6"));
  EXPECT_TRUE(change("youngs_modulus: 1e10", "youngs_modulus: 2e10"));
  EXPECT_FALSE(change("density: 2600", "density: 2700"));
  EXPECT_FALSE(change("heat_ratio: 1.4", "heat_ratio: 1.3"));
  EXPECT_TRUE(change("friction: 0.6", "friction: 0.5"));
  EXPECT_FALSE(change("normal_stiffness: 1e10", "normal_stiffness: 2e10"));
  EXPECT_TRUE(change("cohesion: 1e5}\n  glued", "cohesion: 2e5}\n  glued"));
  EXPECT_FALSE(change("cohesion: 1e5}\ncond", "cohesion: 2e5}\ncond"));
  EXPECT_TRUE(change("value: 1", "value: 2"));
  EXPECT_FALSE(change("joints:\n", "joints:\n  new: {friction: 0.5}\n"));
  EXPECT_TRUE(change("-9.81", "-9.8"));
  EXPECT_TRUE(change("normal: 0.1", "normal: 0.2"));
  EXPECT_FALSE(change("skin: 0.1", "skin: 0.2"));
  // Of stages those to come, and the end of the present one.
  EXPECT_TRUE(change("until: 1", "until: 1.5", 0));
  EXPECT_FALSE(change("until: 1", "until: 1.5", 1));
  EXPECT_TRUE(change("remove: [core]", "remove: [roof]", 0));
  EXPECT_FALSE(change("remove: [core]", "remove: [roof]", 1));
  EXPECT_TRUE(change("until: 2", "until: 3", 1));
}
} // namespace coplane
