#include "WallOfTwo.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_setup/DeckProblems.hpp>
#include <coplane_setup/detail/BlocksOfDeck.hpp>

namespace coplane
{
namespace
{
TEST(BlocksOfDeck, takeTheirMaterialStartAndErosion)
{
  const Model model = modelOf(R"(
blocks:
  upper: {material: rock, hourglass: {stiffness: 0.1, viscosity: 0.02}, erosion: {volume_ratio: [0.2, 5]}}
  lower: {material: rock, rigid: true}
initial: [{block: upper, velocity: [1, -2, 0], velocity_field: ["y", 0, 0], stress: [-1e6, -2e6, 0, 3e5, 0, 0]}]
)");
  ASSERT_EQ(model.blocks.size(), 2u);
  const BlockSetup &lower = model.blocks[0], &upper = model.blocks[1]; // order of the mesh
  EXPECT_EQ(lower.name, "lower");
  EXPECT_TRUE(lower.rigid);
  EXPECT_FALSE(upper.rigid);
  EXPECT_EQ(upper.materialName, "rock");
  EXPECT_DOUBLE_EQ(elasticity(upper.material).density, 2000);
  EXPECT_DOUBLE_EQ(elasticity(upper.material).shearModulus, 0.4e9);
  EXPECT_DOUBLE_EQ(upper.hourglass.stiffness, 0.1);
  EXPECT_DOUBLE_EQ(upper.hourglass.viscosity, 0.02);
  ASSERT_TRUE(upper.erosion.volumeRatio);
  EXPECT_DOUBLE_EQ((*upper.erosion.volumeRatio)[1], 5);
  EXPECT_FALSE(lower.erosion.any());
  const Vec3 v = upper.velocityAt({0, 1.5, 0});
  EXPECT_DOUBLE_EQ(v.x, 2.5); // 1 of the body, 1.5 of the field
  EXPECT_DOUBLE_EQ(v.y, -2);
  EXPECT_DOUBLE_EQ(upper.stressAt({0, 0, 0}).xy, 3e5);
  // Nodes of the rigid block belong to one body, the others to none.
  for (int n = 0; n < model.mesh.nodes(); ++n)
    EXPECT_EQ(model.rigidBodyOfNode[n], model.mesh.nodeIds[n] <= 9 ? 0 : -1) << n;
}

TEST(BlocksOfDeck, refuseAFormThatTheirElementsDoNotHave)
{
  try
  {
    modelOf("blocks: {lower: {material: rock}, upper: {material: rock, element: nodal_pressure}}");
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Deck);
    EXPECT_NE(std::string(error.what())
                  .find("'nodal_pressure' is for TRI3 and TETRA4, but the "
                        "block has QUAD4"),
              std::string::npos)
        << error.what();
  }
}

TEST(DeckProblems, nameVariablesThatALawDoesNotHave)
{
  const Deck deck = parseDeck(deckOfTwo + R"(
blocks:
  lower: {material: rock, erosion: {damage: 0.9}}
  upper: {material: rock}
)",
                              "wall.yaml");
  const std::vector<std::string> problems = problemsOfLaws(deck, 2);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("blocks.lower.erosion asks for 'damage'"), std::string::npos)
      << problems[0];
  EXPECT_NE(problems[0].find("has no variables"), std::string::npos) << problems[0];
}

TEST(DeckProblems, nameWhatRigidBlocksCannotDo)
{
  const Comm comm;
  const Deck deck = parseDeck(deckOfTwo + R"(
blocks: {lower: {material: rock, rigid: true}, upper: {material: rock}}
conditions:
  - {type: absorbing, side_set: floor}
  - {type: absorbing, side_set: load}
  - {type: rigid_motion, block: lower, angular_velocity: [1, 0, 2]}
)",
                              "wall.yaml");
  const std::vector<std::string> problems =
      problemsOfRigidBlocks(deck, sliceOf(wallOfTwo(), comm), comm);
  ASSERT_EQ(problems.size(), 2u); // `load` is beside a block that deforms
  EXPECT_NE(problems[0].find("angular_velocity about x"), std::string::npos) << problems[0];
  EXPECT_NE(problems[1].find("absorbing side set 'floor' has a side of the rigid block 'lower'"),
            std::string::npos)
      << problems[1];
}
} // namespace
} // namespace coplane
