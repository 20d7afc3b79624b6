#include "TestDecks.hpp"

#include <coplane_input/ContactRoles.hpp>
#include <coplane_input/JointCards.hpp>
#include <coplane_input/MaterialCards.hpp>

#include <TestFolder.hpp>

namespace coplane
{
namespace
{
// One deck with everything that the manual's examples use.
const std::string wall = R"yaml(title: Bar against a wall
mesh: meshes/wall.e
materials:
  steel:    {model: j2, density: 7850, youngs_modulus: 200e9, poisson_ratio: 0.3, yield_stress: 1e9, hardening_modulus: 1e9}
  concrete: {model: linear_elastic, density: 2300, youngs_modulus: 33e9, poisson_ratio: 0.2}
blocks:
  bricks: {material: concrete, hourglass: {stiffness: 0.05, viscosity: 0.0}}
  bar: {material: steel}
joints:
  dry:   {model: closure_curve, initial_stiffness: 1e11, maximum_closure: 2e-4, stiffness_cap: 2e11, shear_stiffness: 5e10, friction: 0.6, cohesion: 0}
  touch: {model: penalty, stiffness_fraction: 0.5, shear_ratio: 0.5, friction: 0.3}
  line:  {model: linear, normal_stiffness: 1e10, shear_stiffness: 5e9, friction: 0.5}
contact:
  enabled: true
  default_joint: touch
  pairs:
    - {blocks: [bricks, bricks], joint: dry, declared: true}
    - {blocks: [bar, base], excluded: true}
  search_every: once
  preset: default
conditions:
  - {type: fixed, node_set: base, components: [x, y, z]}
  - {type: velocity, node_set: left, components: [x], value: ["0.05*sin(2*_pi*200*t)", 0, 0]}
  - {type: symmetry, node_set: mid, normal: [0, 0, 1]}
  - {type: pressure, side_set: top, value: "1e5*min(t/0.01,1)"}
initial:
  - {block: bar, velocity: [0, -35, 60.6], angular_velocity: [0,0,0], center: [0,0,0], stress: [0,0,0,0,0,0]}
gravity: [0, -9.81, 0]
damping: {mass: 0, until: 1.5}
viscosity: {linear: 0.06, quadratic: 1.5}
time: {end: 0.041, step_factor: 0.8, maximum_step: 1e-5, energy_tolerance: 0.1}
output: {results: wall.e, every: 1e-3, times: [0.0013], planes: true, file_per_rank: false}
history: {file: wall.csv, every: 1e-4, probes: [{name: tip, node_set: tip}, {name: bar, block: bar}]}
partition: {method: multijagged}
)yaml";

TEST(DeckReader, readsTheManualsDeck)
{
  const Deck deck = parseDeck(wall, "decks/wall.yaml");
  ASSERT_EQ(deck.materials.size(), 2u);
  EXPECT_EQ(deck.materials[0].name, "steel");
  EXPECT_EQ(static_cast<const J2Parameters*>(deck.materials[0].parameters.get())->youngsModulus,
            200e9);
  EXPECT_EQ(deck.materials[1].model, "linear_elastic");
  ASSERT_EQ(deck.joints.size(), 3u);
  EXPECT_EQ(jointLawOf(deck.joints[0]).stiffnessCap, 2e11);
  EXPECT_LT(jointLawOf(deck.joints[1]).shearStiffness, 0); // not given
  EXPECT_EQ(deck.contact.searchEvery, 0);                  // once
  ASSERT_EQ(deck.conditions.size(), 4u);
  EXPECT_EQ(deck.conditions[1].velocity[0].expression, "0.05*sin(2*_pi*200*t)");
  EXPECT_EQ(deck.conditions[1].components, (std::array<bool, 3>{true, false, false}));
  EXPECT_EQ(deck.conditions[3].set, "top");
  EXPECT_EQ(deck.initial[0].velocity.z, 60.6);
  EXPECT_EQ(deck.time.maximumStep, 1e-5);
  EXPECT_EQ(deck.history.probes[1].block, "bar");
}

TEST(DeckReader, theMeshIsSoughtInTheFolderOfTheDeck)
{
  EXPECT_EQ(parseDeck(wall, "decks/wall.yaml").mesh, "decks/meshes/wall.e");
}

TEST(DeckReader, anAbsoluteMeshPathStays)
{
  EXPECT_EQ(parseDeck(wall, "decks/wall.yaml", {"mesh=/data/wall.e"}).mesh, "/data/wall.e");
}

TEST(DeckReader, outputsAreNamedAfterTheDeckInTheWorkingFolder)
{
  const Deck deck = parseDeck(leastDeck, "decks/bar.yaml");
  EXPECT_EQ(deck.output.results, "bar.e");
  EXPECT_EQ(deck.history.file, "bar.csv");
}

TEST(DeckReader, resultsNoneSwitchesThemOff)
{
  EXPECT_EQ(parseDeck(leastDeck, "bar.yaml", {"output.results=none"}).output.results, "");
}

TEST(DeckReader, cardsKnowTheirPlace)
{
  const Deck deck = parseDeck(wall, "wall.yaml");
  EXPECT_EQ(deck.materials[1].where, "wall.yaml:5:3");
  EXPECT_EQ(deck.conditions[0].where, "wall.yaml:22:5");
  EXPECT_EQ(deck.conditions[3].pressure.where, "wall.yaml:25:44");
  EXPECT_EQ(deck.meshWhere, "wall.yaml:2:7");
}

TEST(DeckReader, readsFromAFile)
{
  const TestFolder folder(Comm::alone());
  const std::string file = folder / "deck.yaml";
  std::ofstream(file) << leastDeck;
  const Deck deck = readDeck(file, {"time.end=3"});
  EXPECT_EQ(deck.time.end, 3);
  EXPECT_EQ(deck.file, file);
}

TEST(DeckPreset, seedSetsThreeKeys)
{
  const Deck deck = parseDeck(leastDeck + "contact: {preset: seed}\n", "wall.yaml");
  EXPECT_EQ(deck.contact.area, "full");
  EXPECT_EQ(deck.contact.weights, "centroid");
  EXPECT_EQ(deck.contact.closure, "incremental");
}

TEST(DeckPreset, anExplicitKeyWinsEvenWhenItStandsBeforeThePreset)
{
  const Deck deck = parseDeck(leastDeck + "contact: {closure: total, preset: seed}\n", "wall.yaml");
  EXPECT_EQ(deck.contact.area, "full");
  EXPECT_EQ(deck.contact.closure, "total");
}

TEST(DeckText, isTheFileWordForWordWithoutSet)
{
  EXPECT_EQ(parseDeck(wall, "wall.yaml").text, wall);
}

TEST(DeckText, isTheWholeDeckAfterSet)
{
  const Deck deck = parseDeck(leastDeck, "wall.yaml", {"time.end=0.5", "title=Another bar"});
  EXPECT_EQ(deck.text, "mesh: wall.e\n"
                       "materials: {steel: {model: linear_elastic, density: 7850, youngs_modulus: "
                       "200e9, poisson_ratio: 0.3}}\n"
                       "blocks: {bar: {material: steel}}\n"
                       "time: {end: 0.5}\n"
                       "title: Another bar\n");
}

TEST(DeckText, afterSetReadsBackToItself)
{
  const Deck first = parseDeck(wall, "wall.yaml", {"time.end=0.5"});
  const Deck second = parseDeck(first.text, "wall.yaml", {"time.end=0.5"});
  EXPECT_EQ(first.text, second.text);
  EXPECT_EQ(second.conditions[1].velocity[0].expression, "0.05*sin(2*_pi*200*t)");
}

TEST(DeckSet, replacesAnItemOfAList)
{
  const Deck deck = parseDeck(wall, "wall.yaml", {"conditions.1.value=[3, 0, 0]", "gravity.1=-1"});
  EXPECT_EQ(deck.conditions[1].velocity[0].constant, 3);
  EXPECT_EQ(deck.gravity[1].constant, -1);
}

TEST(DeckSet, makesGroupsThatTheDeckDoesNotHave)
{
  const Deck deck = parseDeck(leastDeck, "wall.yaml", {"contact.damping.normal=0.2"});
  EXPECT_EQ(deck.contact.dampNormal, 0.2);
}

TEST(DeckSet, theLastOneWins)
{
  EXPECT_EQ(parseDeck(leastDeck, "wall.yaml", {"time.end=2", "time.end=3"}).time.end, 3);
}

TEST(DeckSet, reachesNamesWithDots)
{
  const std::string text = "mesh: wall.e\n"
                           "materials: {steel.1: {model: linear_elastic, density: 7850, "
                           "youngs_modulus: 200e9, poisson_ratio: 0.3}}\n"
                           "blocks: {bar: {material: steel.1}}\n"
                           "time: {end: 1}\n";
  EXPECT_EQ(density(materialOf(
                parseDeck(text, "wall.yaml", {"materials.steel.1.density=9"}).materials[0])),
            9);
}

TEST(DeckSet, changesOneOfTwoAliasedCards)
{
  const std::string text = "mesh: wall.e\n"
                           "materials:\n"
                           "  a: &a {model: linear_elastic, density: 1, youngs_modulus: 1, "
                           "poisson_ratio: 0}\n"
                           "  b: *a\n"
                           "blocks: {bar: {material: a}}\n"
                           "time: {end: 1}\n";
  const Deck deck = parseDeck(text, "wall.yaml", {"materials.a.density=5"});
  EXPECT_EQ(density(materialOf(deck.materials[0])), 5);
  EXPECT_EQ(density(materialOf(deck.materials[1])), 1);
}

TEST(DeckPairs, theFirstItemThatFitsCountsInEitherOrder)
{
  const Deck deck = parseDeck(leastDeck + "contact:\n"
                                          "  pairs:\n"
                                          "    - {blocks: [bar, wall], excluded: true}\n"
                                          "    - {blocks: [bar, \"*\"], declared: true}\n",
                              "wall.yaml");
  EXPECT_EQ(contactPairFor(deck.contact, {"wall", "", {}}, {"bar", "", {}}),
            &deck.contact.pairs[0]);
  EXPECT_EQ(contactPairFor(deck.contact, {"floor", "", {}}, {"bar", "", {}}),
            &deck.contact.pairs[1]);
  EXPECT_EQ(contactPairFor(deck.contact, {"wall", "", {}}, {"wall", "", {}}), nullptr);
}
} // namespace

TEST(DeckPairs, canNameMaterialsSideSetsAndJointSets)
{
  const Deck deck = parseDeck(leastDeck + "contact:\n"
                                          "  pairs:\n"
                                          "    - {joint_set: bedding, declared: true}\n"
                                          "    - {side_sets: [nose, \"*\"], excluded: true}\n"
                                          "    - {materials: [steel, \"*\"], declared: true}\n",
                              "wall.yaml");
  const ContactTraits bedded{"a", "steel", {"bedding"}}, free{"a", "steel", {}},
      nose{"b", "rock", {"tip", "nose"}}, other{"b", "rock", {}};
  const auto item = [&](const ContactTraits& p, const ContactTraits& q)
  {
    const ContactPairCard* card = contactPairFor(deck.contact, p, q);
    EXPECT_EQ(card, contactPairFor(deck.contact, q, p));
    return card ? card - deck.contact.pairs.data() : -1;
  };
  EXPECT_EQ(item(bedded, bedded), 0);
  EXPECT_EQ(item(bedded, free), 2) << "one of the faces is not in the joint set";
  EXPECT_EQ(item(nose, free), 1);
  EXPECT_EQ(item(free, other), 2);
  EXPECT_EQ(item(other, other), -1);
}

TEST(DeckPairs, facesWithEqualRolesHaveTheSameItems)
{
  const Deck deck = parseDeck(leastDeck + "contact:\n"
                                          "  pairs:\n"
                                          "    - {joint_set: bedding, declared: true}\n"
                                          "    - {side_sets: [nose, \"*\"], excluded: true}\n"
                                          "    - {blocks: [a, c], excluded: true}\n"
                                          "    - {blocks: [b, b], excluded: true}\n"
                                          "    - {materials: [steel, steel], declared: true}\n",
                              "wall.yaml");
  std::vector<ContactTraits> faces;
  for (const char* block : {"a", "b", "c", "d"})
    for (const char* material : {"steel", "rock", "ice", "air"})
      for (const std::vector<std::string>& sets :
           {std::vector<std::string>{}, {"bedding"}, {"nose"}, {"bedding", "nose"}, {"other"}})
        faces.push_back({block, material, sets});
  std::size_t alike = 0;
  for (const ContactTraits& one : faces)
    for (const ContactTraits& same : faces)
    {
      if (contactRoles(deck.contact, one) != contactRoles(deck.contact, same))
        continue;
      ++alike;
      for (const ContactTraits& other : faces)
        EXPECT_EQ(contactPairFor(deck.contact, one, other),
                  contactPairFor(deck.contact, same, other));
    }
  // Nothing tells rock, ice and air from each other, nor a face in `other` from one in no side set:
  // 1 + 3^2 pairs of materials and 1 + 1 + 1 + 2^2 of side sets are alike, in each of 4 blocks.
  EXPECT_EQ(alike, std::size_t(4 * 10 * 7));
}
} // namespace coplane
