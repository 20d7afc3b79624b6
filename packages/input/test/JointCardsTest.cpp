#include "TestDecks.hpp"

#include <coplane_input/JointCards.hpp>

#include <cmath>

using namespace coplane;

namespace
{
/// Law of a joint card of this content.
JointLaw jointLawOf(const std::string& content)
{
  return jointLawOf(
      parseDeck(leastDeck + "joints:\n  j: {" + content + "}\n", "wall.yaml").joints[0]);
}

/// Message about a joint of this content on line 6, without its place.
std::string jointProblemOf(const std::string& content)
{
  const std::string text = errorOf(leastDeck + "joints:\n  j: {" + content + "}\n");
  EXPECT_EQ(text.find("wall.yaml:6:"), 0u) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  const auto start = text.find(": ");
  return start == std::string::npos ? text : text.substr(start + 2);
}

const std::string bond = "normal_stiffness: 8.2e10, shear_stiffness: 3.6e10, tensile_strength: "
                         "0.25e6, cohesion: 0.35e6, friction: 0.75, ";
const std::string rough = "model: barton_bandis, wall_strength: 100e6, residual_friction: 0.6, "
                          "peak_slip: 2e-3, ";
} // namespace

TEST(JointCards, penaltyAndLinear)
{
  const JointLaw penalty = jointLawOf("stiffness_fraction: 0.7, friction: 0.3");
  EXPECT_TRUE(penalty.penalty);
  EXPECT_EQ(penalty.stiffnessFraction, .7);
  EXPECT_EQ(penalty.friction, .3);
  const JointLaw linear = jointLawOf("model: linear, normal_stiffness: 2e10, shear_stiffness: 0");
  EXPECT_FALSE(linear.penalty);
  EXPECT_EQ(linear.initialStiffness, 2e10);
  EXPECT_EQ(linear.shearStiffness, 0.0);
  EXPECT_FALSE(linear.cohesive());
}

TEST(JointCards, tensileStrengthOfALinearJointIsABrittleBond)
{
  const JointLaw law = jointLawOf("model: linear, normal_stiffness: 2e10, tensile_strength: 1e6, "
                                  "cohesion: 2e5");
  EXPECT_TRUE(law.cohesive());
  EXPECT_EQ(law.bond.kind, Bond::Kind::Brittle);
  EXPECT_EQ(law.bond.tensileStrength, 1e6);
  EXPECT_EQ(law.cohesion, 2e5);
}

TEST(JointCards, closureCurveAndTable)
{
  const JointLaw curve =
      jointLawOf("model: closure_curve, initial_stiffness: 1e11, maximum_closure: "
                 "2e-4, stiffness_cap: 3e11");
  EXPECT_EQ(curve.initialStiffness, 1e11);
  EXPECT_DOUBLE_EQ(curve.curve.inverseMaximumClosure, 5e3);
  EXPECT_EQ(curve.stiffnessCap, 3e11);
  const JointLaw table = jointLawOf("model: table, closures: [1e-4, 2e-4], tractions: [1e6, 4e6]");
  EXPECT_EQ(table.curve.points, 2);
  const JointFit fit = table.fittedTo(1, 1e12, 1, 1e12);
  EXPECT_NEAR(fit.normalStiffness, 1e10, 1e-5);
  EXPECT_NEAR(table.closureUnder(fit, 2.5e6), 1.5e-4, 1e-18);
}

TEST(JointCards, mortarAndBilinear)
{
  const JointLaw mortar =
      jointLawOf("model: mortar, " + bond + "tension_energy: 18, shear_energy: 125");
  EXPECT_EQ(mortar.bond.kind, Bond::Kind::Exponential);
  EXPECT_DOUBLE_EQ(mortar.bond.openingLength, 18 / .25e6);
  EXPECT_DOUBLE_EQ(mortar.bond.shearingLength, 125 / .35e6);
  EXPECT_EQ(mortar.cohesion, 0.0) << "all of it softens";
  EXPECT_EQ(mortar.friction, .75);
  EXPECT_TRUE(mortar.curve.straight());
  const JointLaw bilinear = jointLawOf("model: bilinear, " + bond +
                                       "tension_energy: 18, shear_energy: "
                                       "125, maximum_closure: 1e-4");
  EXPECT_EQ(bilinear.bond.kind, Bond::Kind::Linear);
  EXPECT_DOUBLE_EQ(bilinear.bond.openingLength, 36 / .25e6);
  EXPECT_DOUBLE_EQ(bilinear.curve.inverseMaximumClosure, 1e4);
}

TEST(JointCards, roughJointsAreEstimatedUnlessTheyAreGiven)
{
  const JointLaw estimated = jointLawOf(rough + "roughness: 10, rock_strength: 150e6");
  EXPECT_EQ(estimated.strength, JointLaw::Strength::BartonBandis);
  EXPECT_NEAR(estimated.initialStiffness, 15.35e9, 1);
  EXPECT_NEAR(1 / estimated.curve.inverseMaximumClosure, .227357e-3, 1e-9);
  EXPECT_NEAR(std::tan(estimated.rough.residualAngle), .6, 1e-15);
  const JointLaw given =
      jointLawOf(rough + "roughness: 10, initial_stiffness: 3.5e9, maximum_closure: "
                         "0.57e-3, dilation_slip: 0");
  EXPECT_EQ(given.initialStiffness, 3.5e9);
  EXPECT_NEAR(1 / given.curve.inverseMaximumClosure, .57e-3, 1e-18);
  EXPECT_EQ(given.dilationSlip, 0.0);
}

TEST(JointCards, frictionOfSpeedAndDilation)
{
  const JointLaw law =
      jointLawOf("friction: 0.7, dynamic_friction: 0.4, slip_speed: 0.2, dilation: 0.1, "
                 "dilation_slip: 1e-3");
  EXPECT_EQ(law.dynamicFriction, .4);
  EXPECT_EQ(law.slipSpeed, .2);
  EXPECT_EQ(law.dilation, .1);
  EXPECT_EQ(law.dilationSlip, 1e-3);
  EXPECT_LT(jointLawOf("friction: 0.7").dynamicFriction, 0);
}

TEST(JointCards, frictionOfSpeedNeedsAllOfItsKeys)
{
  EXPECT_EQ(jointProblemOf("friction: 0.7, slip_speed: 0.2"),
            "joints.j.slip_speed has no effect without dynamic_friction; give both or none.");
  EXPECT_EQ(
      jointProblemOf("friction: 0.7, dynamic_friction: 0.2"),
      "joints.j.dynamic_friction needs slip_speed, the speed over which friction falls [m/s].");
  EXPECT_EQ(jointProblemOf("friction: 0.7, dynamic_friction: 0.8, slip_speed: 1"),
            "joints.j.dynamic_friction = 0.8 is above friction = 0.7; accepted: at most that.");
}

TEST(JointCards, dilationMustNotGiveEnergy)
{
  EXPECT_EQ(
      jointProblemOf("friction: 0.3, dilation: 0.4"),
      "joints.j.dilation = 0.4 is above friction = 0.3: the joint would gain energy by slipping; "
      "accepted: at most that.");
  EXPECT_EQ(jointProblemOf("friction: 0.3, dilation_slip: 1e-3"),
            "joints.j.dilation_slip has no effect without dilation; give both or none.");
}

TEST(JointCards, tablesRiseWithRisingSlopes)
{
  EXPECT_EQ(jointProblemOf("model: table, closures: [1e-4, 2e-4], tractions: [1e6]"),
            "joints.j.tractions has 1 numbers, but closures has 2; accepted: as many.");
  EXPECT_EQ(jointProblemOf("model: table, closures: [2e-4, 1e-4], tractions: [1e6, 2e6]"),
            "joints.j.closures does not rise at item 1: 0.0001 m after 0.0002 m.");
  EXPECT_EQ(
      jointProblemOf("model: table, closures: [1e-4, 2e-4], tractions: [3e6, 4e6]"),
      "joints.j.tractions is less steep before item 1 than before: 1e+10 Pa/m after 3e+10 Pa/m; "
      "accepted: slopes that never fall, for the tangent of unloading.");
  std::string closures, tractions;
  for (int i = 1; i <= 17; ++i)
  {
    closures += (i > 1 ? ", " : "") + std::to_string(i);
    tractions += (i > 1 ? ", " : "") + std::to_string(i * i);
  }
  EXPECT_EQ(
      jointProblemOf("model: table, closures: [" + closures + "], tractions: [" + tractions + "]"),
      "joints.j.closures has 17 points; accepted: at most 16.");
}

TEST(JointCards, softeningMustNotSpringBack)
{
  // f_t^2 / k_n = 6.25e10 / 8.2e10 = .7622; half of it for a straight branch. c^2 / k_s = 3.403.
  EXPECT_EQ(
      jointProblemOf("model: mortar, " + bond + "tension_energy: 0.7, shear_energy: 125"),
      "joints.j.tension_energy = 0.7 J/m^2 is too small: beyond its strength of 250000 Pa the "
      "joint would have to spring back; accepted: more than 0.7622 J/m^2, or a larger "
      "normal_stiffness.");
  EXPECT_EQ(errorOf(leastDeck + "joints:\n  j: {model: bilinear, " + bond +
                    "tension_energy: 0.7, shear_energy: 125}\n"),
            "no error");
  EXPECT_EQ(
      jointProblemOf("model: bilinear, " + bond + "tension_energy: 18, shear_energy: 1.5"),
      "joints.j.shear_energy = 1.5 J/m^2 is too small: beyond its strength of 350000 Pa the joint "
      "would have to spring back; accepted: more than 1.701 J/m^2, or a larger shear stiffness.");
}

TEST(JointCards, capsOfStraightBondsHaveNoEffect)
{
  EXPECT_EQ(jointProblemOf("model: mortar, " + bond +
                           "tension_energy: 18, shear_energy: 125, "
                           "stiffness_cap: 1e12"),
            "joints.j.stiffness_cap has no effect on a straight line; give maximum_closure or "
            "remove it.");
  EXPECT_EQ(
      jointProblemOf("model: mortar, " + bond +
                     "tension_energy: 18, shear_energy: 125, "
                     "maximum_closure: 1e-4, stiffness_cap: 1e10"),
      "joints.j.stiffness_cap = 10000000000 Pa/m is below normal_stiffness = 82000000000 Pa/m; "
      "accepted: at least that.");
}

TEST(JointCards, estimatesOutOfRangeAreRefused)
{
  // JRC 2, sigma_c = JCS: k_ni = -7.15 + 3.5 + .02 * 100 / .04 is fine; a rock of a third of JCS is
  // not.
  EXPECT_EQ(errorOf(leastDeck + "joints:\n  j: {" + rough + "roughness: 2}\n"), "no error");
  const std::string problem = jointProblemOf(rough + "roughness: 2, rock_strength: 33e6");
  EXPECT_EQ(problem.find("joints.j.roughness = 2, wall_strength = 100000000 Pa and rock_strength = "
                         "33000000 Pa are outside of the range of Bandis' estimates"),
            0u)
      << problem;
}

TEST(JointCards, keysOfOtherModelsAreRefused)
{
  EXPECT_EQ(jointProblemOf(rough + "roughness: 10, friction: 0.6"),
            "joints.j.friction belongs to model: penalty, linear, closure_curve, table, mortar, "
            "bilinear, but model is barton_bandis here; remove it or change model.");
}

TEST(JointCards, bondsThatResistBending)
{
  EXPECT_FALSE(jointLawOf("model: bilinear, tension_energy: 18, shear_energy: 125, " + bond)
                   .bond.resistsBending);
  const std::string bends = bond + "resists_bending: true, ",
                    energies = "tension_energy: 18, shear_energy: 125";
  EXPECT_TRUE(jointLawOf("model: bilinear, " + bends + energies).bond.resistsBending);
  EXPECT_TRUE(
      jointLawOf("model: mortar, stiffness_loss: 1, " + bends + energies).bond.resistsBending);
  EXPECT_TRUE(
      jointLawOf(
          "model: linear, normal_stiffness: 2e10, tensile_strength: 1e6, resists_bending: true")
          .bond.resistsBending);
  EXPECT_NE(jointProblemOf("model: mortar, " + bends + energies).find("needs stiffness_loss: 1"),
            std::string::npos);
  EXPECT_NE(jointProblemOf("model: linear, normal_stiffness: 2e10, resists_bending: true")
                .find("without tensile_strength"),
            std::string::npos);
  EXPECT_NE(jointProblemOf("model: bilinear, dilation: 0.1, " + bends + energies)
                .find("does not go with dilation"),
            std::string::npos);
  EXPECT_NE(jointProblemOf("model: bilinear, maximum_closure: 1e-4, " + bends + energies)
                .find("does not go with maximum_closure"),
            std::string::npos);
}

TEST(JointCards, impulsesAlongThePathNeedForcesOfThePotential)
{
  for (const std::string other : {"forces: common_normal", "preset: seed", "area: full"})
  {
    const std::string text = errorOf(leastDeck + "contact: {impulses: path, " + other + "}\n");
    EXPECT_NE(text.find("contact.impulses = 'path' does not go with contact."), std::string::npos)
        << other << ": " << text;
  }
}

TEST(JointCards, bondsThatResistBendingNeedForcesOfThePotential)
{
  const std::string text = errorOf(
      leastDeck + "joints:\n  j: {model: linear, normal_stiffness: 2e10, tensile_strength: 1e6, "
                  "resists_bending: true}\ncontact: {forces: common_normal}\n");
  EXPECT_NE(text.find("joints.j.resists_bending does not go with contact.forces = 'common_normal'"),
            std::string::npos)
      << text;
}
