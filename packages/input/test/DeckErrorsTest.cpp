#include "TestDecks.hpp"

#include <coplane_joint/JointModel.hpp>
#include <coplane_material/MaterialModel.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace coplane
{
namespace
{
/// The least deck with its own text on line 5 and after.
std::string errorWith(const std::string& lines)
{
  return errorOf(leastDeck + lines);
}

/// The least deck with a material of this content on line 6, from column 6 on.
std::string errorOfMaterial(const std::string& content)
{
  return errorOf("mesh: wall.e\n"
                 "blocks: {bar: {material: m}}\n"
                 "time: {end: 1}\n"
                 "\n"
                 "materials:\n"
                 "  m: {" +
                 content + "}\n");
}

/// The least deck with a joint of this content on line 6, from column 6 on.
std::string errorOfJoint(const std::string& content)
{
  return errorWith("joints:\n  j: {" + content + "}\n");
}

/// One text of all models, as messages list them: a new model needs no new message here.
template <class Model, class Base>
std::string joined(const std::vector<Model>& models, std::string Base::*text, const char* between)
{
  std::vector<std::string> texts;
  for (const Model& model : models)
    texts.push_back(model.*text);
  return fmt::format("{}", fmt::join(texts, between));
}

/// The models that have a key of this name.
template <class Model>
std::string ownersOf(const std::string& name, const std::vector<Model>& models)
{
  std::vector<std::string> owners;
  for (const Model& model : models)
    for (const Key& key : model.keys)
      if (key.name == name)
        owners.push_back(model.name);
  return fmt::format("{}", fmt::join(owners, ", "));
}

TEST(DeckErrors, theLeastDeckHasNone)
{
  EXPECT_EQ(errorOf(leastDeck), "no error");
}

TEST(DeckErrors, tablesHaveAsManyTimesAsValuesAndTimesRise)
{
  const auto errorOfGravity = [](const std::string& table)
  { return errorWith("gravity: [0, " + table + ", 0]\n"); };
  EXPECT_EQ(errorOfGravity("{times: [0, 1], values: [0, -10]}"), "no error");
  EXPECT_EQ(
      errorOfGravity("{times: [0, 0], values: [0, -10]}"),
      "wall.yaml:5:14: gravity.1 has 2 times and 2 values, and 0 s comes after 0 s; accepted: as "
      "many of both, at least 2, with times that rise.");
  EXPECT_EQ(
      errorOfGravity("{times: [0, 1, 2], values: [0, -10]}"),
      "wall.yaml:5:14: gravity.1 has 3 times and 2 values; accepted: as many of both, at least "
      "2, with times that rise.");
  EXPECT_EQ(errorOfGravity("{times: [0, 1]}"),
            "wall.yaml:5:14: gravity.1.values is missing; accepted: a table has times [s] and "
            "values, as in {times: [0, 0.01], values: [0, 1]}.");
  EXPECT_EQ(errorOfGravity("{times: [0, 1], values: [0, -10], scale: big}"),
            "wall.yaml:5:55: gravity.1.scale = 'big' is not a number; accepted: a number.");
  EXPECT_EQ(errorOfGravity("{times: [0, 1], values: [0, -10], factor: 2}"),
            "wall.yaml:5:48: gravity.1.factor is not known. Accepted here: times, values, scale.");
}

TEST(DeckErrors, rigidBlocksNeitherErodeNorCarryStress)
{
  EXPECT_EQ(
      errorOf("mesh: wall.e\nmaterials: {steel: {model: linear_elastic, density: 7850, "
              "youngs_modulus: 200e9, poisson_ratio: 0.3}}\ntime: {end: 1}\nblocks:\n"
              "  bar: {material: steel, rigid: true, erosion: {stable_step: 1e-9}}\n"
              "initial:\n  - {block: bar, stress: [1, 0, 0, 0, 0, 0]}\n"),
      "wall.yaml:5:48: blocks.bar.erosion has no effect because blocks.bar.rigid is true; "
      "remove one of them.\n"
      "wall.yaml:7:5: initial.0: block 'bar' is rigid and carries no stress; remove stress and "
      "stress_gradient, or rigid.");
}

TEST(DeckErrors, erosionNeedsLimitsThatTheStartKeeps)
{
  const auto errorOfErosion = [](const std::string& content)
  {
    return errorOf("mesh: wall.e\nmaterials: {steel: {model: linear_elastic, density: 7850, "
                   "youngs_modulus: 200e9, poisson_ratio: 0.3}}\ntime: {end: 1}\nblocks:\n"
                   "  bar: {material: steel, erosion: {" +
                   content + "}}\n");
  };
  EXPECT_EQ(errorOfErosion("damage: 0.9, plastic_strain: 1, volume_ratio: [0.1, 4], stable_step: "
                           "1e-9, variables: {energy: {above: 1, below: -1}}"),
            "no error");
  EXPECT_EQ(errorOfErosion("volume_ratio: [1, 4]"),
            "wall.yaml:5:50: blocks.bar.erosion.volume_ratio = [1, 4] would take out elements as "
            "they are at the start; accepted: the first below 1, the second above 1.");
  EXPECT_EQ(errorOfErosion("variables: {porosity: {}}"),
            "wall.yaml:5:58: blocks.bar.erosion.variables.porosity has no limit; accepted: above, "
            "below or both, as in porosity: {above: 0.5}.");
}

TEST(DeckErrors, linesThatWouldEndBeforeTheirStage)
{
  const auto of = [](const std::string& firstStage)
  {
    return errorWith("lines: {bar: {points: [[0, 0], [1, 0]], attach: ends, area: 1e-3, "
                     "youngs_modulus: 2e11, stage: two, until: 0.4}}\n"
                     "damping: {local: 0.7, until_force_ratio: 1e-4}\n"
                     "stages: [{name: one, until: 0.5" +
                     firstStage + "}, {name: two}]\n");
  };
  EXPECT_NE(of("").find("lines.bar.until = 0.4 s; accepted: later than the beginning of the stage "
                        "'two', 0.5 s."),
            std::string::npos)
      << of("");
  EXPECT_EQ(of(", at_rest: true"), "no error"); // it may begin earlier
}

TEST(DeckErrors, linesSayWhatDoesNotFit)
{
  const auto lineWith = [](const std::string& keys)
  { return leastDeck + "lines:\n  bolt: {area: 1e-3, youngs_modulus: 200e9, " + keys + "}\n"; };
  const std::string grouted = "segment_length: 0.1, grout: {stiffness: 1e9}, ";
  EXPECT_EQ(errorOf(lineWith(grouted + "points: [[0, 0], [1, 0]]")), "no error");
  const auto expect = [&](const std::string& keys, const std::string& told)
  {
    const std::string error = errorOf(lineWith(keys));
    EXPECT_NE(error.find(told), std::string::npos) << error;
    EXPECT_EQ(error.rfind("wall.yaml:6:", 0), 0u) << error;
  };
  expect(grouted + "points: [[0, 0]]", "lines.bolt.points");
  expect(grouted + "points: [[0, 0], [0, 0]]", "two points, one after the other, are the same");
  expect("attach: ends, points: [[0, 0], [1, 0], [1, 1]]", "straight between them");
  expect("attach: ends, segment_length: 1, points: [[0, 0], [1, 0]]", "segment_length");
  expect("segment_length: 1, points: [[0, 0], [1, 0]]", "grout");
  expect(grouted + "free_length: 2, points: [[0, 0], [1, 0]]", "less than the length of the line");
  expect("segment_length: 1, grout: {stiffness: 1e9, friction: 0.5}, points: [[0, 0], [1, 0]]",
         "friction and perimeter go together");
  expect(grouted + "yield_stress: 1e8, pretension: 2e5, points: [[0, 0], [1, 0]]",
         "not more than yield_stress times area");
  expect(grouted + "diameter: 0.02, compression: false, points: [[0, 0], [1, 0]]",
         "a cable, which does not bend");
  expect(grouted + "diameter: 0.2, points: [[0, 0], [1, 0]]", "one bar of it has 0.03142 m^2");
  expect(grouted + "mirrored: start, free_length: 0.5, points: [[0, 0], [1, 0]]",
         "the line has no grout at its start");
  expect("attach: ends, diameter: 0.02, points: [[0, 0], [1, 0]]", "diameter");
  expect(grouted + "copies: 3, points: [[0, 0], [1, 0]]", "give copy_step");
  expect("segment_length: 1e-12, grout: {stiffness: 1e9}, points: [[0, 0], [1, 0]]",
         "makes 1e+12 segments");
  expect(grouted + "points: [[0, 0], [1, 0]], copies: 2, copy_step: [0, 1, 0]}\n"
                   "  bolt_2: {area: 1e-3, youngs_modulus: 200e9, attach: ends, "
                   "points: [[0, 0], [1, 0]]",
         "copy 2 would be called bolt_2");
  expect(grouted + "from: 0.2, until: 0.2, points: [[0, 0], [1, 0]]", "later than from, 0.2 s");
  expect(grouted + "stage: bolted, points: [[0, 0], [1, 0]]", "'bolted' is not a stage");
  const auto besides = [&](const std::string& output)
  { return errorOf(lineWith(grouted + "points: [[0, 0], [1, 0]]") + "output: " + output + "\n"); };
  EXPECT_EQ(besides("{lines: true}"), "no error");
  EXPECT_NE(besides("{lines: true, results: none}").find("output.lines has no effect without res"),
            std::string::npos);
  EXPECT_NE(errorWith("output: {lines: true}\n").find("without the section lines"),
            std::string::npos);
  const std::string rings =
      errorOf("geometry: axisymmetric\n" + lineWith(grouted + "points: [[0, 0], [1, 0]]"));
  EXPECT_NE(rings.find("axisymmetric"), std::string::npos) << rings;
}

TEST(DeckErrors, allAreReportedAtOnceInTheOrderOfTheFile)
{
  EXPECT_EQ(
      errorOf("mesh: wall.e\n"
              "materials:\n"
              "  steel: {model: j3, density: -1, youngs_modulus: 200e9}\n"
              "blocks: {bar: {material: stel}}\n"
              "time: {end: 0}\n"
              "tilte: x\n"),
      "wall.yaml:3:18: materials.steel.model = 'j3' is not known. Did you mean 'j2'? "
      "Accepted: one of " +
          joined(materialModels(), &MaterialModel::name, ", ") +
          ".\n"
          "wall.yaml:3:31: materials.steel.density = '-1' is out of range; accepted: a number > "
          "0 [kg/m^3].\n"
          "wall.yaml:4:26: blocks.bar.material = 'stel' is not a card in materials. Did you mean "
          "'steel'? There is: steel.\n"
          "wall.yaml:5:13: time.end = '0' is out of range; accepted: a number > 0 [s].\n"
          "wall.yaml:6:1: tilte is not known. Did you mean 'title'? Accepted here: define, "
          "title, mesh, "
          "geometry, "
          "materials, blocks, joints, contact, conditions, lines, initial, gravity, damping, "
          "viscosity, "
          "time, stages, output, history, checkpoint, partition.");
}

TEST(DeckErrors, controlCharactersAreRefusedWithTheirLine)
{
  EXPECT_EQ(
      errorOf(leastDeck + std::string("title: a\0b\n", 11)),
      "wall.yaml:5: the text has a control character (byte 0x00) here: the file is damaged, or "
      "is no text. Write the line again.");
}

TEST(DeckErrors, whatIsNotSeenInAnEditorIsNamed)
{
  EXPECT_EQ(errorOf("\xff\xfet"),
            "wall.yaml:1: the text is UTF-16; accepted: UTF-8. Save it as UTF-8.");
  const std::string tabs = errorOf(leastDeck + std::string("output:\n\tevery: 1\n"));
  EXPECT_NE(tabs.find("wall.yaml:6:1: this line is indented with a tab"), std::string::npos)
      << tabs;
  const std::string zero = errorOf(leastDeck + std::string("title: \"a\\0b\"\n"));
  EXPECT_NE(zero.find("zero byte"), std::string::npos) << zero;
}

TEST(DeckErrors, anUnknownKeyBringsASuggestion)
{
  EXPECT_EQ(errorWith("damping: {mas: 1}\n"),
            "wall.yaml:5:11: damping.mas is not known. Did you mean 'mass'? Accepted here: mass, "
            "local, kinetic, from, until, until_energy_ratio, until_force_ratio.");
}

TEST(DeckErrors, aKeyInTheWrongPlaceIsToldItsPlace)
{
  EXPECT_EQ(errorWith("damping: {fixed_step: 1}\n"),
            "wall.yaml:5:11: damping.fixed_step is not known. Its place is time.fixed_step. "
            "Accepted here: mass, local, kinetic, from, until, until_energy_ratio, "
            "until_force_ratio.");
}

TEST(DeckErrors, aKeyThatPeopleLookForBringsAdvice)
{
  const auto expectAdvice = [](const std::string& error, const std::string& words)
  { EXPECT_NE(error.find(words), std::string::npos) << error; };
  expectAdvice(errorWith("units: SI\n"), "units is not known. A deck names no units");
  expectAdvice(errorWith("dimension: 2\n"), "The mesh says whether");
  expectAdvice(errorWith("checkpoint: {every: 1}\n"),
               "checkpoint.every is not known. Checkpoints come by count of cycles (every_cycles)");
  expectAdvice(errorOfMaterial("model: linear_elastic, density: 1, bulk_modulus: 1, "
                               "shear_modulus: 1"),
               "poisson_ratio = (3 K - 2 G) / (6 K + 2 G)");
}

TEST(DeckErrors, aKeyGivenTwice)
{
  EXPECT_EQ(errorWith("damping:\n  mass: 1\n  mass: 2\n"),
            "wall.yaml:7:3: damping.mass is given twice, first at wall.yaml:6:3; keep one of "
            "them.");
}

TEST(DeckErrors, anUnknownKeyGivenTwiceIsStillUnknown)
{
  EXPECT_EQ(
      errorWith("damping: {a: 1, a: 2}\n"),
      "wall.yaml:5:11: damping.a is not known. Accepted here: mass, local, kinetic, from, until, "
      "until_energy_ratio, until_force_ratio.\n"
      "wall.yaml:5:17: damping.a is given twice, first at wall.yaml:5:11; keep one of them.\n"
      "wall.yaml:5:17: damping.a is not known. Accepted here: mass, local, kinetic, from, until, "
      "until_energy_ratio, until_force_ratio.");
}

TEST(DeckErrors, aNameGivenTwice)
{
  EXPECT_EQ(errorWith("joints:\n  a: {friction: 1}\n  a: {friction: 2}\n"),
            "wall.yaml:7:3: joints.a is given twice, first at wall.yaml:6:3; keep one of them.");
}

TEST(DeckErrors, aMerge)
{
  EXPECT_EQ(errorWith("joints:\n  a: &a {friction: 1}\n  b: {<<: *a}\n"),
            "wall.yaml:7:7: joints.b.<< is a merge of YAML 1.1, which decks do not have; write the "
            "keys out.");
}

TEST(DeckErrors, aKeyThatIsNoWord)
{
  EXPECT_EQ(errorWith("damping: {[1, 2]: 3}\n"),
            "wall.yaml:5:11: a key in damping is a list of 2; accepted: a word.");
}

TEST(DeckErrors, textForANumber)
{
  EXPECT_EQ(
      errorWith("viscosity: {linear: 0.1 m}\n"),
      "wall.yaml:5:21: viscosity.linear = '0.1 m' is not a number: values have no units, write "
      "the number alone; accepted: a number >= 0 [-].");
}

TEST(DeckErrors, aNumberInQuotes)
{
  EXPECT_EQ(errorWith("viscosity: {linear: \"10\"}\n"),
            "wall.yaml:5:21: viscosity.linear = \"10\" is text in quotes, not a number; remove the "
            "quotes; accepted: a number >= 0 [-].");
}

TEST(DeckErrors, areOneLineEachEvenWhenTheTextIsNot)
{
  EXPECT_EQ(errorWith("viscosity: {linear: \"a\\nb\"}\n"),
            "wall.yaml:5:21: viscosity.linear = \"a\\nb\" is not a number; accepted: a number >= 0 "
            "[-].");
}

TEST(DeckErrors, aNumberThatIsNotFinite)
{
  for (const std::string text : {"nan", "inf", "-inf", ".inf", ".nan", "1e999"})
    EXPECT_EQ(errorWith("viscosity: {linear: " + text + "}\n"),
              "wall.yaml:5:21: viscosity.linear = '" + text +
                  "' is not a finite number; accepted: a number >= 0 [-].");
}

TEST(DeckErrors, aKeyWithoutValue)
{
  EXPECT_EQ(errorWith("viscosity: {linear: }\n"),
            "wall.yaml:5:21: viscosity.linear = nothing; accepted: a number >= 0 [-].");
}

TEST(DeckErrors, aGroupWhereAValueBelongs)
{
  EXPECT_EQ(errorWith("title: {a: 1}\n"),
            "wall.yaml:5:8: title = a group of keys; accepted: text.");
}

TEST(DeckErrors, aValueWhereAGroupBelongs)
{
  EXPECT_EQ(errorWith("damping: 3\n"),
            "wall.yaml:5:10: damping = '3'; accepted: keys with values.");
}

TEST(DeckErrors, aMapWhereAListBelongs)
{
  EXPECT_EQ(errorWith("initial: {block: bar}\n"),
            "wall.yaml:5:10: initial = a group of keys: items are wanted, each with '-' before it; "
            "accepted: a list of items with keys and values.");
}

TEST(DeckErrors, aListWhereNamesBelong)
{
  EXPECT_EQ(errorWith("joints: [{friction: 1}]\n"),
            "wall.yaml:5:9: joints = a list of 1: names are wanted, not items with '-'; "
            "accepted: names, each with keys and values.");
}

TEST(DeckErrors, aFlagThatIsNeitherTrueNorFalse)
{
  EXPECT_EQ(errorWith("contact: {couple: yes}\n"),
            "wall.yaml:5:19: contact.couple = 'yes' is not a flag; accepted: true or false.");
}

TEST(DeckErrors, aVectorOfTwoNumbers)
{
  EXPECT_EQ(
      errorWith("gravity: [0, 1]\n"),
      "wall.yaml:5:10: gravity = a list of 2; accepted: a list of 3 numbers, expressions of t "
      "or tables [m/s^2], such as [0, \"-9.81*min(t/0.5, 1)\", 0].");
}

TEST(DeckErrors, anItemOfAVectorThatIsNoNumber)
{
  EXPECT_EQ(errorWith("gravity: [0, g, 0]\n"),
            "wall.yaml:5:14: gravity.1 = 'g' is not an expression of t (Unexpected token \"g\" "
            "found at character 1); accepted: a number, an expression of t or a table "
            "[m/s^2].");
}

TEST(DeckErrors, aNegativeNumberWhereAnExpressionMayStand)
{
  EXPECT_EQ(errorWith("damping: {mass: -1}\n"),
            "wall.yaml:5:17: damping.mass = '-1' is out of range; accepted: a number >= 0, an "
            "expression of t or a table [1/s].");
}

TEST(DeckErrors, anExpressionOfTimeWhereOneOfPlaceIsMeant)
{
  EXPECT_EQ(errorWith("initial: [{block: bar, velocity_field: [\"t\", 0, 0]}]\n"),
            "wall.yaml:5:41: initial.0.velocity_field.0 = \"t\" is not an expression of x, y, z "
            "(Unexpected token \"t\" found at character 1); accepted: a list of 3 numbers or "
            "expressions of x, y, z [m/s].");
}

TEST(DeckErrors, aPointOfAStressThatDoesNotVary)
{
  EXPECT_EQ(errorWith("initial: [{block: bar, stress_point: [0, 1, 0]}]\n"),
            "wall.yaml:5:38: initial.0.stress_point has no effect without "
            "initial.0.stress_gradient; remove it or give that.");
}

TEST(DeckErrors, aSearchIntervalOfZero)
{
  EXPECT_EQ(errorWith("contact: {search_every: 0}\n"),
            "wall.yaml:5:25: contact.search_every = '0' is out of range; accepted: a whole number "
            ">= 1 [cycles] or once or auto.");
}

TEST(DeckErrors, aSearchIntervalThatIsNotWhole)
{
  EXPECT_EQ(errorWith("contact: {search_every: 1.5}\n"),
            "wall.yaml:5:25: contact.search_every = '1.5' is not a whole number; accepted: a whole "
            "number >= 1 [cycles] or once or auto.");
}

TEST(DeckErrors, aComponentGivenTwice)
{
  EXPECT_EQ(errorWith("conditions: [{type: fixed, node_set: a, components: [x, x]}]\n"),
            "wall.yaml:5:53: conditions.0.components = a list of 2 with an item given twice; "
            "accepted: a list of names out of x, y, z.");
}

TEST(DeckErrors, modulesDensitiesAndRatiosOutOfRange)
{
  EXPECT_EQ(errorOfMaterial("model: j2, density: 0, youngs_modulus: -1, poisson_ratio: 0.5, "
                            "yield_stress: 0, hardening_modulus: -1"),
            "wall.yaml:6:27: materials.m.density = '0' is out of range; accepted: a number > 0 "
            "[kg/m^3].\n"
            "wall.yaml:6:46: materials.m.youngs_modulus = '-1' is out of range; accepted: a number "
            "> 0 [Pa].\n"
            "wall.yaml:6:65: materials.m.poisson_ratio = '0.5' is out of range; accepted: a number "
            "> -1 and < 0.5 [-].\n"
            "wall.yaml:6:84: materials.m.yield_stress = '0' is out of range; accepted: a number > "
            "0 [Pa].\n"
            "wall.yaml:6:106: materials.m.hardening_modulus = '-1' is out of range; accepted: a "
            "number >= 0 [Pa].");
}

TEST(DeckErrors, aKeyOfAnotherModel)
{
  EXPECT_EQ(errorOfMaterial("model: linear_elastic, density: 1, youngs_modulus: 1, "
                            "poisson_ratio: 0, yield_stress: 1"),
            "wall.yaml:6:79: materials.m.yield_stress belongs to model: " +
                ownersOf("yield_stress", materialModels()) +
                ", but model is linear_elastic here; remove it or change model.");
}

TEST(DeckErrors, aKeyThatTheModelNeeds)
{
  EXPECT_EQ(
      errorOfMaterial("model: j2, density: 1, youngs_modulus: 1, poisson_ratio: 0"),
      "wall.yaml:6:6: materials.m.yield_stress is missing; accepted: either yield_stress (with "
      "hardening_modulus) or a table, plastic_strains and yield_stresses.");
  EXPECT_EQ(errorOfMaterial("model: j2, density: 1, youngs_modulus: 1, yield_stress: 1"),
            "wall.yaml:6:6: materials.m.poisson_ratio is missing (model: j2 needs it); accepted: a "
            "number > -1 and < 0.5 [-]: Poisson's ratio.");
}

TEST(DeckErrors, aMissingModelIsTheOnlyComplaintAboutIt)
{
  EXPECT_EQ(errorOfMaterial("density: 1, youngs_modulus: 1, poisson_ratio: 0, yield_stress: 1"),
            "wall.yaml:6:6: materials.m.model is missing; accepted: one of " +
                joined(materialModels(), &MaterialModel::name, ", ") + ": law of the continuum: " +
                joined(materialModels(), &MaterialModel::meaning, "; ") + ".");
}

TEST(DeckErrors, aJointWithoutModelIsAPenalty)
{
  EXPECT_EQ(errorOfJoint("normal_stiffness: 1"),
            "wall.yaml:6:7: joints.j.normal_stiffness belongs to model: " +
                ownersOf("normal_stiffness", jointModels()) +
                ", but model is penalty here; remove it or change model.");
}

TEST(DeckErrors, theNameOfAModelInAnotherProgram)
{
  EXPECT_EQ(errorOfMaterial("model: von_mises, density: 1"),
            "wall.yaml:6:14: materials.m.model = 'von_mises' is not known. It is called 'j2' here. "
            "Accepted: one of " +
                joined(materialModels(), &MaterialModel::name, ", ") + ".");
  EXPECT_EQ(errorOfJoint("model: coulomb"),
            "wall.yaml:6:14: joints.j.model = 'coulomb' is not known. It is called 'linear' here. "
            "Accepted: one of " +
                joined(jointModels(), &JointModel::name, ", ") + ".");
}

TEST(DeckErrors, aStiffnessCapBelowTheInitialStiffness)
{
  EXPECT_EQ(errorOfJoint("model: closure_curve, initial_stiffness: 2e10, maximum_closure: 1e-4, "
                         "stiffness_cap: 1e10"),
            "wall.yaml:6:92: joints.j.stiffness_cap = 10000000000 Pa/m is below initial_stiffness "
            "= 20000000000 Pa/m; accepted: at least that.");
}

TEST(DeckErrors, shearStiffnessAndItsRatio)
{
  EXPECT_EQ(errorOfJoint("shear_stiffness: 1, shear_ratio: 1"),
            "wall.yaml:6:40: joints.j.shear_stiffness and joints.j.shear_ratio exclude each other; "
            "keep one of them.");
}

TEST(DeckErrors, fixedAndMaximumStep)
{
  EXPECT_EQ(errorOf("mesh: wall.e\n"
                    "materials: {steel: {model: linear_elastic, density: 1, youngs_modulus: 1, "
                    "poisson_ratio: 0}}\n"
                    "blocks: {bar: {material: steel}}\n"
                    "time:\n"
                    "  end: 1\n"
                    "  fixed_step: 1e-6\n"
                    "  maximum_step: 1e-6\n"),
            "wall.yaml:6:15: time.maximum_step and time.fixed_step exclude each other; keep one of "
            "them.");
}

TEST(DeckErrors, requiredKeysThatAreMissing)
{
  EXPECT_EQ(
      errorOf("title: x\n"),
      "wall.yaml:1:1: mesh is missing; accepted: text: Exodus file, relative to the folder "
      "of the deck.\n"
      "wall.yaml:1:1: blocks is missing; accepted: names, each with keys and values: element "
      "blocks of the mesh, by the names that the mesh gives them; all blocks need a card.\n"
      "wall.yaml:1:1: time is missing; accepted: keys with values, such as {end: 0.041}: time "
      "and its steps.");
}

TEST(DeckErrors, aProbeOfNothingAndAProbeOfTwoThings)
{
  EXPECT_EQ(errorWith("history: {probes: [{name: a}, {name: b, block: c, node_set: d}]}\n"),
            "wall.yaml:5:20: history.probes.0 needs one of the keys node_set, block, point, "
            "plane, between.\n"
            "wall.yaml:5:48: history.probes.1.node_set and history.probes.1.block exclude each "
            "other; keep one of them.");
}

TEST(DeckErrors, aReactionOfABlock)
{
  EXPECT_EQ(errorWith("history: {probes: [{name: a, block: b, reaction: true}]}\n"),
            "wall.yaml:5:50: history.probes.0.reaction belongs to node_set; name a node set that "
            "conditions hold, or remove it.");
}

TEST(DeckErrors, twoProbesOfOneName)
{
  EXPECT_EQ(errorWith("history: {probes: [{name: a, block: b}, {name: a, block: c}]}\n"),
            "wall.yaml:5:48: history.probes.1.name = 'a' is taken; accepted: each name once.");
}

TEST(DeckErrors, twoInitialStatesOfOneBlock)
{
  EXPECT_EQ(errorWith("initial: [{block: b}, {block: b}]\n"),
            "wall.yaml:5:31: initial.1.block = 'b' has a card already; accepted: one for each "
            "block.");
}

TEST(DeckErrors, jointsThatDoNotExist)
{
  EXPECT_EQ(errorWith("joints: {dry: {friction: 1}}\n"
                      "contact:\n"
                      "  default_joint: dri\n"
                      "  pairs: [{blocks: [a, b], joint: wet}]\n"),
            "wall.yaml:7:18: contact.default_joint = 'dri' is not a card in joints. Did you mean "
            "'dry'? There is: dry.\n"
            "wall.yaml:8:35: contact.pairs.0.joint = 'wet' is not a card in joints. There is: "
            "dry.");
}

TEST(DeckErrors, aPairThatAnEarlierOneCovers)
{
  EXPECT_EQ(errorWith("contact: {pairs: [{blocks: [\"*\", a], declared: true}, {blocks: [a, b], "
                      "excluded: true}]}\n"),
            "wall.yaml:5:64: contact.pairs.1.blocks is covered already by contact.pairs.0; the "
            "first item that fits counts. Remove this one or put it first.");
}

TEST(DeckErrors, anExcludedPairWithAJoint)
{
  EXPECT_EQ(errorWith("joints: {dry: {friction: 1}}\n"
                      "contact: {pairs: [{blocks: [a, b], joint: dry, excluded: true}]}\n"),
            "wall.yaml:6:58: contact.pairs.0.excluded: true leaves contact.pairs.0.joint without "
            "effect; remove one of them.");
}

TEST(DeckErrors, aSymmetryWithoutDirection)
{
  EXPECT_EQ(errorWith("conditions: [{type: symmetry, node_set: a, normal: [0, 0, 0.0]}]\n"),
            "wall.yaml:5:52: conditions.0.normal = a list of 3 without direction; accepted: a list "
            "of 3 numbers, not all zero [-].");
}

TEST(DeckErrors, aVelocityOfAComponentThatIsFree)
{
  EXPECT_EQ(errorWith("conditions: [{type: velocity, node_set: a, components: [x], value: [1, 2, "
                      "0]}]\n"),
            "wall.yaml:5:72: conditions.0.value.1 has no effect because conditions.0.components "
            "does not have y; write 0 or add y to components.");
}

TEST(DeckErrors, aWrongExpression)
{
  EXPECT_EQ(errorWith("conditions: [{type: pressure, side_set: a, value: \"2*sn(t)\"}]\n"),
            "wall.yaml:5:51: conditions.0.value = \"2*sn(t)\" is not an expression of t, x, y, "
            "z (Unexpected token \"sn\" found at character 3); accepted: a number, an expression "
            "of t, x, y, z or a table [Pa].");
}

TEST(DeckErrors, wrongYaml)
{
  EXPECT_EQ(errorOf("mesh: wall.e\ntime: {end: 1\n"),
            "wall.yaml:2:7: '{' is not closed; put the missing '}'.");
}

TEST(DeckErrors, anEmptyDeck)
{
  for (const std::string text : {"", "\n\n", "# only a remark\n", "---\n", "~\n"})
    EXPECT_EQ(errorOf(text),
              "wall.yaml: the deck is empty; --help-deck lists the keys that it needs.");
}

TEST(DeckErrors, aDeckThatIsAList)
{
  EXPECT_EQ(errorOf("- mesh: wall.e\n"),
            "wall.yaml:1:1: the deck is a list; accepted: keys with values, such as 'mesh: "
            "bricks.e'. See --help-deck.");
}

TEST(DeckErrors, twoDocuments)
{
  EXPECT_EQ(errorOf("mesh: a\n---\nmesh: b\n"),
            "wall.yaml:3:1: here something begins that does not belong to what is above; a file is "
            "one document. Remove the line '---', or mend the indentation.");
}

TEST(DeckErrors, aPieceThatAnIndentationHasCutOff)
{
  // yaml-cpp 0.7 makes documents without end of it.
  EXPECT_EQ(errorOf("  probes:\n    - {name: tip}\n, and more\ntitle: b\n"),
            "wall.yaml:3:1: here something begins that does not belong to what is above; a file is "
            "one document. Remove the line '---', or mend the indentation.");
}

TEST(DeckErrors, anAliasOfItself)
{
  EXPECT_EQ(
      errorWith("initial: &a [*a]\n"),
      "wall.yaml:5:10: this part of the file is nested too deeply or too large, as aliases (*name) "
      "that contain themselves make it; accepted: 50 levels and a million values more than are "
      "written. Write the values out.");
}

TEST(DeckErrors, aDeckThatDoesNotExist)
{
  try
  {
    readDeck("no/such/deck.yaml");
    FAIL() << "no error";
  }
  catch (const Error& e)
  {
    EXPECT_EQ(e.code(), ExitCode::Deck);
    EXPECT_STREQ(e.what(), "no/such/deck.yaml: the deck cannot be read (No such file or "
                           "directory). Check the path and its permissions.");
  }
}

TEST(DeckErrors, keysThatAreGoneSayWhyAndWhatToDo)
{
  EXPECT_EQ(
      errorOf("mesh: wall.e\n"
              "materials: {steel: {model: linear_elastic, density: 1, youngs_modulus: 1, "
              "poisson_ratio: 0}}\n"
              "blocks: {bar: {material: steel}}\n"
              "contact: {method: common_plane, plane_search: rotations}\ntime: {end: 1}\n"),
      "wall.yaml:4:11: contact.method is no longer a key. There is one kind of contact left, "
      "a Simple Common Plane for each pair of faces. Cundall's plane between elements "
      "(common_plane) was there for comparison only; docs/theory/scp.md compares the two. "
      "Remove the key; forces: common_normal is the contact nearest to Cundall's.\n"
      "wall.yaml:4:33: contact.plane_search is no longer a key. It said how common_plane found "
      "Cundall's plane between elements, which whole runs no longer have. Remove the key.");
}

/// A deck with a rigid block `tool` and a deformable one, and these lines from line 9 on.
std::string errorOfRigid(const std::string& lines)
{
  return errorOf("mesh: wall.e\nmaterials:\n  steel: {model: linear_elastic, density: 1, "
                 "youngs_modulus: 1, poisson_ratio: 0}\nblocks:\n  tool: {material: steel, rigid: "
                 "true}\n  bar: {material: steel}\ntime: {end: 1}\n\n" +
                 lines);
}

TEST(DeckErrors, givenMotionsNeedARigidBlockAndSomethingToGive)
{
  EXPECT_EQ(errorOfRigid("conditions:\n  - {type: rigid_motion, block: tool, velocity: [1, 0, "
                         "\"t\"], angular_velocity: [0, 0, 1]}\n"),
            "no error");
  EXPECT_EQ(errorOfRigid("conditions:\n  - {type: rigid_motion, block: tool}\n"),
            "wall.yaml:10:5: conditions.0 prescribes nothing; accepted: conditions.0.velocity, "
            "conditions.0.angular_velocity or both.");
  EXPECT_EQ(
      errorOfRigid("conditions:\n  - {type: rigid_motion, block: bar, velocity: [1, 0, 0]}\n"),
      "wall.yaml:10:33: conditions.0.block = 'bar' is not rigid; set blocks.bar.rigid, or use type "
      "velocity with a node set.");
  EXPECT_EQ(errorOfRigid("conditions:\n  - {type: rigid_motion, block: tool, components: [x], "
                         "velocity: [1, 2, 0]}\n"),
            "wall.yaml:10:70: conditions.0.velocity.1 has no effect because "
            "conditions.0.components does not have y; write 0 or add y to components.");
  EXPECT_EQ(errorOfRigid("conditions:\n  - {type: rigid_motion, block: tool, components: [x], "
                         "angular_velocity: [1, 2, 0]}\n"),
            "wall.yaml:10:51: conditions.0.components has no effect without "
            "conditions.0.velocity; remove it or give that.");
  EXPECT_EQ(errorOfRigid("conditions:\n  - {type: rigid_motion, block: tool, velocity: [1, 0, "
                         "0]}\n  - {type: rigid_motion, block: tool, angular_velocity: [1, 0, "
                         "0]}\n"),
            "wall.yaml:11:33: conditions.1.block = 'tool' is held by conditions.0 already; "
            "accepted: one item for each block.");
  EXPECT_EQ(errorOfRigid("history: {rigid: [bar]}\n"),
            "wall.yaml:9:19: history.rigid.0 = 'bar' is not a rigid block, or \"*\". There is: "
            "tool.");
}

TEST(DeckErrors, windowsOfDampingNeedADamping)
{
  EXPECT_EQ(errorWith("damping: {kinetic: true, from: 0.5, until: 1.5, until_force_ratio: 1e-4}\n"),
            "no error");
  EXPECT_EQ(errorWith("damping: {until_energy_ratio: 1e-4}\n"),
            "wall.yaml:5:31: damping.until_energy_ratio has no effect without damping.mass, "
            "damping.local or damping.kinetic; remove it or give one of them.");
  EXPECT_EQ(errorWith("damping: {local: 0.5, from: 0.5, until: 0.5}\n"),
            "wall.yaml:5:41: damping.until = 0.5 s is not after damping.from = 0.5 s; accepted: a "
            "later time.");
}

TEST(DeckErrors, variablesAreThoseOfResults)
{
  EXPECT_EQ(errorWith("output: {variables: [stress]}\n"), "no error");
  EXPECT_EQ(errorWith("output: {results: none, variables: [stress]}\n"),
            "wall.yaml:5:36: output.variables has no effect without results, which output.results "
            "switches off; remove one of the two.");
}

TEST(DeckErrors, pointsOfProbesHaveNamesOfTheirOwn)
{
  const auto probes = [](const std::string& a, const std::string& b)
  {
    const std::string line = ", between: [[0, 0, 0], [1, 0, 0]], count: 3}";
    return errorWith("history: {probes: [{name: " + a + line + ", {name: " + b + line + "]}\n");
  };
  EXPECT_EQ(probes("roof", "floor"), "no error");
  EXPECT_NE(probes("roof", "roof").find("history.probes.1.name = 'roof' is taken"),
            std::string::npos);
  EXPECT_NE(errorWith("history: {probes: [{name: roof, between: [[0, 0, 0], [1, 0, 0]], count: 3}, "
                      "{name: roof_2, point: [0, 0, 0]}]}\n")
                .find("point 2 would be called 'roof_2', as another probe is"),
            std::string::npos);
}

TEST(DeckErrors, fragmentsGoWithResults)
{
  EXPECT_EQ(errorWith("output: {fragments: true, fragment_damage: 0.5}\n"), "no error");
  EXPECT_EQ(errorWith("output: {fragments: true, results: none}\n"),
            "wall.yaml:5:21: output.fragments has no effect without results, which output.results "
            "switches off; remove one of the two.");
  EXPECT_EQ(errorWith("output: {fragment_damage: 0.5}\n"),
            "wall.yaml:5:27: output.fragment_damage has no effect without output.fragments: true; "
            "remove it or add that.");
  EXPECT_NE(errorWith("output: {fragments: true, fragment_damage: 1.5}\n"), "no error");
}

TEST(DeckErrors, rigidBodiesOfRevolution)
{
  EXPECT_EQ(errorOf("mesh: wall.e\ngeometry: axisymmetric\n"
                    "materials: {steel: {model: linear_elastic, density: 1, youngs_modulus: 1, "
                    "poisson_ratio: 0}}\n"
                    "blocks: {bar: {material: steel, rigid: true}}\ntime: {end: 1}\n"),
            "wall.yaml:4:40: blocks.bar.rigid is not offered with geometry = 'axisymmetric'; use a "
            "stiff material.");
}

TEST(DeckErrors, hourglassControlBelongsToOnePoint)
{
  EXPECT_NE(errorOf("mesh: wall.e\n"
                    "materials: {steel: {model: linear_elastic, density: 1, youngs_modulus: 1, "
                    "poisson_ratio: 0}}\n"
                    "blocks: {bar: {material: steel, element: full_integration, hourglass: "
                    "{stiffness: 0.1}}}\ntime: {end: 1}\n")
                .find("blocks.bar.hourglass"),
            std::string::npos);
}

TEST(DeckErrors, whatSubcyclingDoesNotGoWith)
{
  const std::vector<std::pair<std::string, std::string>> others = {
      {"time.fixed_step=1e-6", "time.fixed_step"},
      {"time.mass_scaling.step=1e-6", "time.mass_scaling"},
      {"damping.local=0.5", "damping.local"},
      {"damping.kinetic=true", "damping.kinetic"}};
  for (const auto& [assignment, key] : others)
    EXPECT_NE(errorOf(leastDeck, {"time.subcycling.levels=3", assignment})
                  .find("time.subcycling does not go with " + key + ":"),
              std::string::npos)
        << assignment;
  for (const char* levels : {"0", "7"})
    EXPECT_EQ(
        errorOf(leastDeck, {std::string("time.subcycling.levels=") + levels}),
        fmt::format("--set time.subcycling.levels={0}: time.subcycling.levels = '{0}' is out of "
                    "range; accepted: a whole number >= 1 and <= 6 [-].",
                    levels));
}

TEST(DeckErrors, aFolderForADeck)
{
  try
  {
    readDeck("/");
    FAIL() << "no error";
  }
  catch (const Error& e)
  {
    EXPECT_STREQ(e.what(), "/: this is a folder; accepted for the deck: a YAML file.");
  }
}

TEST(DeckSetErrors, anAssignmentWithoutEqualsSign)
{
  EXPECT_EQ(errorOf(leastDeck, {"time.end"}),
            "--set time.end: is not an assignment; accepted: path=value, such as time.end=0.1 or "
            "conditions.0.value=[1, 0, 0].");
}

TEST(DeckSetErrors, anUnknownKey)
{
  EXPECT_EQ(errorOf(leastDeck, {"time.and=3"}),
            "--set time.and=3: time.and is not known. Did you mean 'end'? Accepted here: end, "
            "end_at_rest, step_factor, maximum_step, fixed_step, mass_scaling, subcycling, "
            "energy_tolerance, contact_gain_tolerance.");
}

TEST(DeckSetErrors, aWrongValueNamesTheSetAndNotTheFile)
{
  EXPECT_EQ(errorOf(leastDeck, {"time.end=soon"}),
            "--set time.end=soon: time.end = 'soon' is not a number; accepted: a number > 0 [s].");
}

TEST(DeckSetErrors, anItemThatTheListDoesNotHave)
{
  EXPECT_EQ(errorOf(leastDeck + "gravity: [0, 0, 0]\n", {"gravity.3=1"}),
            "--set gravity.3=1: '3' is no item of gravity, which has 3; accepted: a whole number, "
            "the first item is 0.");
}

TEST(DeckSetErrors, aKeyOfAValue)
{
  EXPECT_EQ(errorOf(leastDeck, {"mesh.name=1"}),
            "--set mesh.name=1: mesh is the value 'wall.e' and has no key 'name'.");
}

TEST(DeckSetErrors, aValueThatIsNotYaml)
{
  EXPECT_EQ(errorOf(leastDeck, {"gravity=[1, 2"}),
            "--set gravity=[1, 2: the value is not YAML: end of sequence flow not found.");
}

TEST(DeckSetErrors, comeAfterThoseOfTheFile)
{
  EXPECT_EQ(errorOf(leastDeck + "titel: x\n", {"mesh.name=1", "time.end=-1"}),
            "wall.yaml:5:1: titel is not known. Did you mean 'title'? Accepted here: define, "
            "title, mesh, "
            "geometry, "
            "materials, blocks, joints, contact, conditions, lines, initial, gravity, damping, "
            "viscosity, "
            "time, stages, output, history, checkpoint, partition.\n"
            "--set mesh.name=1: mesh is the value 'wall.e' and has no key 'name'.\n"
            "--set time.end=-1: time.end = '-1' is out of range; accepted: a number > 0 [s].");
}
} // namespace
} // namespace coplane
