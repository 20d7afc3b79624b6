#include "TestDecks.hpp"

#include <coplane_input/MeshChecks.hpp>

namespace coplane
{
namespace
{
const std::vector<std::string> blocks{"bar", "bricks"}, nodeSets{"base", "tip"}, sideSets{"top"};

std::vector<std::string> messagesOf(const std::string& text)
{
  return checkNamesAgainstMesh(parseDeck(text, "wall.yaml"), blocks, nodeSets, sideSets);
}

// The least deck with cards for both blocks of the mesh.
const std::string fittingDeck = []
{
  std::string text = leastDeck;
  return text.replace(text.find("bar: {material: steel}"), 22,
                      "bar: {material: steel}, bricks: {material: steel}");
}();

TEST(CheckNamesAgainstMesh, isSilentWhenAllFits)
{
  EXPECT_TRUE(messagesOf(fittingDeck +
                         "contact: {pairs: [{blocks: [bar, \"*\"], declared: true}]}\n"
                         "conditions: [{type: pressure, side_set: top, value: 1}]\n"
                         "history: {probes: [{name: a, node_set: tip}]}\n")
                  .empty());
}

TEST(CheckNamesAgainstMesh, aBlockOfTheMeshNeedsACard)
{
  EXPECT_EQ(messagesOf(leastDeck),
            std::vector<std::string>{"wall.yaml:3:9: blocks has no card for the element block "
                                     "'bricks' of the mesh; add 'bricks: {material: ...}'."});
}

TEST(CheckNamesAgainstMesh, aCardNeedsABlock)
{
  std::string text = fittingDeck;
  text.replace(text.find("bricks:"), 7, "brick: ");
  EXPECT_EQ(messagesOf(text),
            (std::vector<std::string>{
                "wall.yaml:3:9: blocks has no card for the element block 'bricks' of the mesh; add "
                "'bricks: {material: ...}'. The most similar card is 'brick'.",
                "wall.yaml:3:34: blocks = 'brick' is not an element block of the mesh. Did you "
                "mean 'bricks'? There is: bar, bricks."}));
}

TEST(CheckNamesAgainstMesh, setsOfConditionsMustExist)
{
  EXPECT_EQ(messagesOf(fittingDeck + "conditions:\n"
                                     "  - {type: fixed, node_set: bass}\n"
                                     "  - {type: pressure, side_set: base, value: 1}\n"),
            (std::vector<std::string>{
                "wall.yaml:6:5: conditions.0.node_set = 'bass' is not a node set of the mesh. Did "
                "you mean 'base'? There is: base, tip.",
                "wall.yaml:7:5: conditions.1.side_set = 'base' is not a side set of the mesh. "
                "There is: top. 'base' is a node set."}));
}

TEST(CheckNamesAgainstMesh, contactPairsInitialStatesAndProbesMustExist)
{
  EXPECT_EQ(messagesOf(fittingDeck +
                       "contact: {pairs: [{blocks: [bar, brcks], declared: true}]}\n"
                       "initial: [{block: bat}]\n"
                       "history: {probes: [{name: a, node_set: pit}, {name: b, block: wall}]}\n"),
            (std::vector<std::string>{
                "wall.yaml:5:19: contact.pairs.0.blocks.1 = 'brcks' is not an element block of the "
                "mesh. Did you mean 'bricks'? There is: bar, bricks.",
                "wall.yaml:6:11: initial.0.block = 'bat' is not an element block of the mesh. Did "
                "you mean 'bar'? There is: bar, bricks.",
                "wall.yaml:7:20: history.probes.0.node_set = 'pit' is not a node set of the mesh. "
                "There is: base, tip.",
                "wall.yaml:7:46: history.probes.1.block = 'wall' is not an element block of the "
                "mesh. There is: bar, bricks."}));
}
} // namespace
} // namespace coplane
