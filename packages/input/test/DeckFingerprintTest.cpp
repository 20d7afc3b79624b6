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

std::vector<std::string> changes(const std::string& other)
{
  return deckDifferences(deckFingerprint(deck, "a.yaml"), deckFingerprint(other, "b.yaml"));
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
  EXPECT_EQ(deckDifferences(deckFingerprint(deckOf("define: {v: 0.7}\n", "v").text, "a.yaml"),
                            deckFingerprint(plain.text, "a.yaml")),
            std::vector<std::string>());
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
  using Texts = std::vector<std::string>;
  EXPECT_EQ(changes(with("7850", "7800")),
            Texts{"materials.steel.density was 7850 and is 7800 now"});
  EXPECT_EQ(changes(with(", step_factor: 0.8", "")),
            Texts{"time.step_factor was 0.8 and is not there now"});
  EXPECT_EQ(
      changes(deck + "gravity: [0, -9.81, 0]\n"),
      (Texts{"gravity.0 is 0 now and was not there", "gravity.1 is -9.81 now and was not there",
             "gravity.2 is 0 now and was not there"}));
}

TEST(DeckDifferences, areCountedWhereThereAreMany)
{
  const auto texts =
      deckDifferences(deckFingerprint(deck, "a.yaml"), deckFingerprint("mesh: a.e\n", "b.yaml"), 2);
  ASSERT_EQ(texts.size(), 3u);
  EXPECT_EQ(texts[2], "4 more");
}
} // namespace coplane
