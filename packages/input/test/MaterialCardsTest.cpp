#include "TestDecks.hpp"

#include <coplane_input/MaterialCards.hpp>

#include <cmath>

using namespace coplane;

namespace
{
std::string deckWith(const std::string& content, const std::string& block = "m")
{
  return "mesh: wall.e\nmaterials: {m: {" + content + "}}\nblocks: {bar: {material: " + block +
         "}}\ntime: {end: 1}\n";
}

Material lawOf(const std::string& content)
{
  return materialOf(parseDeck(deckWith(content), "wall.yaml").materials[0]);
}

/// Message about a material of this content, which stands on line 2.
std::string materialProblemOf(const std::string& content)
{
  const std::string text = errorOf(deckWith(content));
  EXPECT_EQ(text.find("wall.yaml:2:"), 0u) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  return text;
}

void expectPart(const std::string& text, const std::string& part)
{
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

const std::string steel = "density: 7850, youngs_modulus: 200e9, poisson_ratio: 0.3, ";
} // namespace

TEST(MaterialCards, everySetOfTheLibraryIsALaw)
{
  for (const std::string& name : materialSetNames())
  {
    const auto deck = parseDeck(
        "mesh: wall.e\nblocks: {bar: {material: " + name + "}}\ntime: {end: 1}\n", "wall.yaml");
    ASSERT_EQ(deck.materials.size(), 1u) << name;
    EXPECT_EQ(deck.materials[0].name, name);
    EXPECT_GT(soundSpeed(materialOf(deck.materials[0])), 500) << name;
  }
}

TEST(MaterialCards, valuesOfACardOverruleItsSet)
{
  const auto law = std::get<PseudoCap>(lawOf("set: concrete_c40, fracture_energy: 90"));
  EXPECT_EQ(law.fractureEnergy, 90);
  EXPECT_EQ(law.strength, 40e6);
  // From the command line too, for a set that a block names itself.
  const auto deck = parseDeck("mesh: wall.e\nblocks: {bar: {material: concrete_c40}}\ntime: {end: "
                              "1}\n",
                              "wall.yaml", {"materials.concrete_c40.fracture_energy=100"});
  ASSERT_EQ(deck.materials.size(), 1u);
  const auto given = std::get<PseudoCap>(materialOf(deck.materials[0]));
  EXPECT_EQ(given.fractureEnergy, 100);
  EXPECT_EQ(given.strength, 40e6);
}

TEST(MaterialCards, aCardOfTheDeckHidesASetOfTheSameName)
{
  const auto deck =
      parseDeck("mesh: wall.e\nmaterials: {granite: {model: linear_elastic, " + steel +
                    "}}\nblocks: {bar: {material: granite}}\ntime: {end: "
                    "1}\n",
                "wall.yaml");
  ASSERT_EQ(deck.materials.size(), 1u);
  EXPECT_EQ(density(materialOf(deck.materials[0])), 7850);
}

TEST(MaterialCards, unknownSetsAreNamedWithASuggestion)
{
  expectPart(materialProblemOf("set: concrete_c4, model: linear_elastic, " + steel),
             "materials.m.set = 'concrete_c4' is not known. Did you mean 'concrete_c40'?");
}

TEST(MaterialCards, j2TakesTheFastLawWhereItIsEnough)
{
  const std::string j2 = "model: j2, " + steel;
  EXPECT_TRUE(std::holds_alternative<J2Plasticity>(
      lawOf(j2 + "yield_stress: 4e8, hardening_modulus: 1e9")));
  const auto table = std::get<HardeningPlasticity>(
      lawOf(j2 + "plastic_strains: [0, 0.1], yield_stresses: [3e8, 4e8], kinematic_modulus: 1e9"));
  EXPECT_EQ(table.points, 2);
  EXPECT_EQ(table.slope[0], 1e9);
  EXPECT_EQ(table.kinematicModulus, 1e9);
  const auto shocked = std::get<HardeningPlasticity>(
      lawOf(j2 + "yield_stress: 4e8, hardening_modulus: 1e9, eos: mie_grueneisen, sound_speed: "
                 "4570, shock_slope: 1.49, grueneisen: 1.93"));
  EXPECT_EQ(shocked.eos.stiffness, 7850 * 4570.0 * 4570.0);
  EXPECT_EQ(shocked.elastic.bulkModulus, shocked.eos.stiffness);
  EXPECT_EQ(shocked.slope[0], 1e9);
  expectPart(materialProblemOf(j2), "materials.m.yield_stress is missing");
  expectPart(
      materialProblemOf(j2 + "yield_stress: 1e8, yield_stresses: [1e8], plastic_strains: [0]"),
      "stands beside a table");
  expectPart(materialProblemOf(j2 + "plastic_strains: [0, 0.1], yield_stresses: [3e8, 2e8]"),
             "a yield stress is 200000000 Pa, but must be at least the one before it");
  expectPart(materialProblemOf(j2 + "yield_stress: 1e8, sound_speed: 4570"),
             "materials.m.sound_speed has no effect with eos: none");
  expectPart(materialProblemOf(j2 + "yield_stress: 1e8, eos: mie_grueneisen"),
             "sound_speed is 0, but eos: mie_grueneisen needs a positive one [m/s]");
}

TEST(MaterialCards, impossibleConcretesAreRefused)
{
  expectPart(materialProblemOf("set: concrete_c40, compressive_strength: -40e6"),
             "materials.m.compressive_strength = '-40e6' is out of range");
  expectPart(materialProblemOf("set: concrete_c40, tensile_strength: 41e6"),
             "materials.m: tensile strength is 41000000 Pa, but must be between 0 and a "
             "quarter");
  expectPart(materialProblemOf("set: concrete_c40, poisson_ratio: 0.5"),
             "materials.m.poisson_ratio = '0.5' is out of range");
  expectPart(materialProblemOf("set: concrete_hjc_48, crush_pressure: 900e6"),
             "materials.m: crush pressure is 900000000 Pa");
  expectPart(materialProblemOf("set: clay_brick, tensile_strength: 6e6"),
             "at most cohesion / friction");
}

TEST(MaterialCards, anglesAreGivenByTheirTangents)
{
  const auto law = std::get<MohrCoulomb>(lawOf("model: mohr_coulomb, " + steel +
                                               "cohesion: 1e6, residual_cohesion: 1e6, friction: "
                                               "0.57735026918962576, dilation: 0"));
  EXPECT_NEAR(law.friction, 3, 1e-12); // 30 degrees
  EXPECT_NEAR(law.dilation, 1, 1e-12);
}

TEST(MaterialCards, tablesOfMohrCoulombReplaceCohesionAndFriction)
{
  const std::string table =
      "plastic_shears: [0, 0.02], cohesions: [5e6, 1e6], frictions: [0.7, 0.5], ";
  const auto law =
      std::get<MohrCoulomb>(lawOf("model: mohr_coulomb, " + steel + table + "dilation: 0.1"));
  EXPECT_EQ(law.points, 2);
  EXPECT_EQ(law.cohesions[1], 1e6);
  EXPECT_EQ(law.frictionTangents[1], 0.5);
  expectPart(materialProblemOf("model: mohr_coulomb, " + steel + table + "cohesion: 1e6"),
             "materials.m.cohesion has no effect beside a table");
  expectPart(materialProblemOf("model: mohr_coulomb, " + steel + "cohesions: [5e6, 1e6]"),
             "materials.m.plastic_shears is missing");
}

TEST(MaterialCards, ratesCountWhenAsked)
{
  const auto endsOf = [](const RateEffect& rates)
  { return std::pair(rates.largestTension, rates.largestCompression); };
  const auto rateOf = [&](const std::string& keys)
  { return endsOf(std::get<PseudoCap>(lawOf("set: concrete_c40" + keys)).rates); };
  EXPECT_EQ(rateOf(""), std::pair(0.0, 0.0));
  EXPECT_EQ(rateOf(", rate_effects: false"), std::pair(0.0, 0.0));
  EXPECT_EQ(rateOf(", rate_effects: true"), std::pair(1.0, 30.0));
  EXPECT_EQ(rateOf(", rate_effects: true, largest_rate: 50"), std::pair(50.0, 50.0));
  const auto kcc =
      std::get<KaragozianCase>(lawOf("set: concrete_kcc_45, rate_effects: true")).rates;
  EXPECT_EQ(endsOf(kcc), std::pair(1.0, 30.0));
  expectPart(materialProblemOf("set: concrete_c40, largest_rate: 50"),
             "materials.m.largest_rate has no effect without rate_effects: true");
  expectPart(materialProblemOf("set: concrete_c40, rate_effects: true, largest_rate: 0"),
             "materials.m.largest_rate = '0' is out of range");
}

TEST(MaterialCards, aFluidIsAnEquationOfState)
{
  const auto law =
      std::get<Fluid>(lawOf("model: fluid, density: 1000, eos: linear, sound_speed: 1500"));
  EXPECT_EQ(law.elastic.bulkModulus, 1000 * 1500.0 * 1500.0);
  EXPECT_EQ(law.elastic.shearModulus, 0);
  expectPart(materialProblemOf("model: fluid, density: 1000"), "materials.m.eos is missing");
  expectPart(materialProblemOf("model: fluid, density: 1000, eos: linear"),
             "sound_speed is 0, but eos: linear needs a positive one [m/s]");
}

TEST(MaterialCards, largestElementFollowsFromTheFractureEnergy)
{
  // G_F E / ft^2 = 120 * 33e9 / 16e12.
  const auto deck = parseDeck(deckWith("set: concrete_c40"), "wall.yaml");
  EXPECT_NEAR(softeningLimit(deck.materials[0]).size, 0.2475, 1e-12);
  // The steepest fall of kcc in uniaxial tension is that of E.
  const auto generated = parseDeck(deckWith("set: concrete_kcc_45"), "wall.yaml");
  EXPECT_NEAR(softeningLimit(generated.materials[0]).size, 0.28496, 1e-5);
  const auto elastic = parseDeck(deckWith("set: granite"), "wall.yaml");
  EXPECT_EQ(softeningLimit(elastic.materials[0]).size, infinity);
}
