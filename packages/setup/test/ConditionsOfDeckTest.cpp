#include "WallOfTwo.hpp"

#include <coplane_core/Log.hpp>
#include <coplane_setup/ConditionsOfDeck.hpp>
#include <coplane_setup/DeckProblems.hpp>

namespace coplane
{
namespace
{
TEST(ConditionsOfDeck, prescribedMotionOfNodes)
{
  const Model model = modelOf(blocksOfTwo + R"(
conditions:
  - {type: fixed, node_set: base, components: [y]}
  - {type: velocity, node_set: lid, value: ["3*t", "x + t", 0]}
  - {type: displacement, node_set: lid, value: [0, {times: [0, 2], values: [0, 1]}, 0], components: [y]}
  - {type: symmetry, node_set: base, normal: [3, 0, 0]}
)");
  const Conditions& conditions = model.conditions;
  ASSERT_EQ(conditions.velocities.size(), 3u);
  const PrescribedVelocity &fixed = conditions.velocities[0], &moved = conditions.velocities[1],
                           &displaced = conditions.velocities[2];
  EXPECT_EQ(countOnAllRanks(fixed.nodes), 3);
  EXPECT_EQ(fixed.components, (std::array<bool, 3>{false, true, false}));
  EXPECT_FALSE(fixed.velocity[1]); // nothing given is zero
  EXPECT_DOUBLE_EQ(moved.velocity[0](2), 6);
  ASSERT_TRUE(moved.field[1]);
  for (std::size_t i = 0; i < moved.nodes.size(); ++i)
  {
    EXPECT_EQ(moved.places[i].x, model.mesh.coordinates[moved.nodes[i]].x);
    EXPECT_DOUBLE_EQ(moved.field[1](2, moved.places[i]), moved.places[i].x + 2);
  }
  EXPECT_EQ(displaced.of, PrescribedVelocity::Of::Displacement);
  EXPECT_DOUBLE_EQ(displaced.speed(displaced.velocity[1], {0.95, 0.1, 0.1}, 0), 0.5);
  ASSERT_EQ(conditions.symmetries.size(), 1u);
  EXPECT_DOUBLE_EQ(conditions.symmetries[0].normal.x, 1); // made a unit vector
}

TEST(ConditionsOfDeck, normalsOfAnyLength)
{
  for (const char* normal : {"[3e-200, 4e-200, 0]", "[3e300, 4e300, 0]", "[3e-310, 4e-310, 0]"})
  {
    const Model model =
        modelOf(blocksOfTwo +
                "conditions:\n  - {type: symmetry, node_set: base, normal: " + normal + "}\n");
    EXPECT_NEAR(model.conditions.symmetries.at(0).normal.x, 0.6, 1e-9) << normal;
    EXPECT_NEAR(model.conditions.symmetries.at(0).normal.y, 0.8, 1e-9) << normal;
  }
}

TEST(ConditionsOfDeck, accelerationsByAScaledTable)
{
  const Model model = modelOf("define: {a: 3}\n" + blocksOfTwo + R"(
conditions:
  - {type: acceleration, node_set: lid, components: [x], value: [{times: [0, 2], values: [0, 1], scale: a/2}, 0, 0]}
)");
  ASSERT_EQ(model.conditions.velocities.size(), 1u);
  const PrescribedVelocity& shaken = model.conditions.velocities[0];
  EXPECT_EQ(shaken.of, PrescribedVelocity::Of::Acceleration);
  EXPECT_DOUBLE_EQ(shaken.velocity[0](1), 0.75);
  EXPECT_DOUBLE_EQ(shaken.speed(shaken.velocity[0], {1, 0.1, 0.05}, 2), 2.075);
}

TEST(ConditionsOfDeck, loadsOnSides)
{
  const Model model = modelOf(blocksOfTwo + R"(
gravity: [0, "-10*t", 0]
conditions:
  - {type: pressure, side_set: load, value: "1e5*t"}
  - {type: pressure, side_set: load, value: "1e5*x*t"}
  - {type: traction, side_set: load, value: [2e4, 0, 0]}
  - {type: absorbing, side_set: floor}
initial: [{block: lower, stress: [0, -5e5, 0, 0, 0, 0]}]
)");
  const Conditions& conditions = model.conditions;
  EXPECT_DOUBLE_EQ(conditions.gravity(2).y, -20);
  ASSERT_EQ(conditions.pressures.size(), 2u);
  EXPECT_DOUBLE_EQ(conditions.pressures[0].pressure(2), 2e5);
  ASSERT_TRUE(conditions.pressures[1].field);
  for (const LoadedSide& side : conditions.pressures[1].sides)
  {
    EXPECT_DOUBLE_EQ(side.place.y, 2); // of the middle of the side
    EXPECT_TRUE(side.place.x == 0.25 || side.place.x == 0.75) << side.place.x;
    EXPECT_DOUBLE_EQ(conditions.pressures[1].field(2, side.place), 2e5 * side.place.x);
  }
  ASSERT_EQ(conditions.tractions.size(), 1u);
  EXPECT_DOUBLE_EQ(conditions.tractions[0].traction(0).x, 2e4);
  ASSERT_EQ(conditions.absorbing.size(), 1u);
  for (const AbsorbingSide& side : conditions.absorbing[0].sides)
  {
    EXPECT_NEAR(side.normalImpedance, std::sqrt(2000 * 1.2e9), 1e-6);
    EXPECT_NEAR(side.shearImpedance, std::sqrt(2000 * 0.4e9), 1e-6);
    EXPECT_DOUBLE_EQ(side.stress[0].yy, -5e5);
  }
}

TEST(ConditionsOfDeck, lastChangeOfLoads) // before the end at 1 s
{
  const auto of = [](const std::string& text)
  {
    return modelOf(blocksOfTwo + "damping: {local: 0.7, until_force_ratio: 1e-6}\n" + text)
        .conditions.relaxation;
  };
  const auto ofPressure = [&](const std::string& keys)
  { return of("conditions: [{type: pressure, side_set: load, " + keys + "}]\n").lastChange; };
  EXPECT_EQ(of("").lastChange, 0);
  EXPECT_EQ(ofPressure("value: 1e5"), 0);
  EXPECT_EQ(ofPressure("value: \"1e5*y\""), 0);
  // Tables and windows exactly; rows that a table repeats at its end are no change.
  EXPECT_EQ(ofPressure("value: {times: [0, 0.05, 0.06, 0.9], values: [0, 0, 1, 1]}"), 0.06);
  EXPECT_EQ(ofPressure("value: {times: [0, 5], values: [0, 1]}"), 1);
  EXPECT_EQ(ofPressure("value: {times: [2, 5], values: [0, 1]}"), 0);
  EXPECT_EQ(ofPressure("value: 1e5, from: 0.07"), 0.07);
  EXPECT_EQ(ofPressure("value: 1e5, from: 0.07, until: 0.09"), 0.09);
  EXPECT_EQ(ofPressure("value: 1e5, from: 7, until: 9"), 0);
  EXPECT_EQ(ofPressure("value: {times: [0, 0.5], values: [0, 1]}, until: 0.09"), 0.09);
  // Expressions to within the distance of the times at which they are asked, 3e-4 of the end.
  EXPECT_NEAR(ofPressure("value: \"1e5*min(t/0.005, 1)\""), 0.005, 5e-5);
  EXPECT_NEAR(ofPressure("value: \"t > 0.99 ? 1e5 : 0\""), 0.99, 3e-4);
  EXPECT_NEAR(ofPressure("value: \"1e5*(1 - exp(-100*t))\""), 0.207, 1e-3);
  EXPECT_EQ(ofPressure("value: \"sin(20*t)\""), 1);
  EXPECT_EQ(ofPressure("value: \"sqrt(0.5 - t)\", until: 0.4"), 0.4);
  EXPECT_NEAR(ofPressure("value: \"1e5*min(t/(0.1*x + 0.01), 1)\""), 0.11, 1e-3); // x up to 1
  EXPECT_NEAR(of("gravity: [0, \"-9.81*min(t/0.02, 1)\", 0]\n").lastChange, 0.02, 2e-4);
  const RelaxationOptions rest =
      of("conditions: [{type: fixed, node_set: base}, {type: fixed, node_set: lid, until: 0.3}]\n");
  EXPECT_EQ(rest.lastChange, 0.3);
  EXPECT_EQ(rest.changing.find("conditions.1 (wall.yaml:"), 0u) << rest.changing;
}

TEST(DeckProblems, probesBesideAllBodies) // elements of 0.5 m, with diagonals of 0.707 m
{
  const Comm comm;
  const Mesh mesh = wallOfTwo();
  const RankMesh part = distribute(mesh, scatteredOwners(mesh, comm.size()), comm.rank());
  const auto problemsOf = [&](const std::string& probe)
  {
    const Deck deck = parseDeck(
        deckOfTwo + blocksOfTwo + "history: {probes: [{name: p, " + probe + "}]}\n", "wall.yaml");
    return problemsOfProbes(deck, part, comm);
  };
  EXPECT_TRUE(problemsOf("point: [0.3, 0.2, 0]").empty());
  EXPECT_TRUE(problemsOf("point: [1.5, 2.4, 0]").empty());
  EXPECT_TRUE(problemsOf("between: [[0, 0], [9, 0]], count: 2").empty()); // a warning
  ASSERT_EQ(problemsOf("plane: [500, 1000, 0]").size(), 1u);
  ASSERT_EQ(problemsOf("point: [1, 3, 0]").size(), 1u);
  EXPECT_NE(problemsOf("point: [1, 3, 0]")[0].find(
                "history.probes.0.point: (1, 3, 0) m is beside all bodies, 1 m from the nearest "
                "node, "),
            std::string::npos)
      << problemsOf("point: [1, 3, 0]")[0];
  EXPECT_NE(problemsOf("point: [1, 3, 0]")[0].find("at (1, 2, 0) m, where elements are 0.707 m"),
            std::string::npos);
}

TEST(DeckProblems, initialStressOfATenthOfTheModulus) // a P-wave modulus of 1.2 GPa
{
  const Comm comm;
  const Mesh mesh = wallOfTwo();
  const RankMesh part = distribute(mesh, scatteredOwners(mesh, comm.size()), comm.rank());
  const auto warningsOf = [&](const std::string& keys)
  {
    const auto count = []
    {
      auto counts = logWarningCounts();
      return counts["initial stress"];
    };
    const Deck deck = parseDeck(
        deckOfTwo + blocksOfTwo + "initial: [{block: upper, " + keys + "}]\n", "wall.yaml");
    const long before = count();
    warnOfInitialStress(deck, mesh, part, comm);
    return count() - before;
  };
  EXPECT_EQ(warningsOf("stress: [0, -119e6, 0, 0, 0, 0]"), 0);
  EXPECT_EQ(warningsOf("stress: [0, 0, 0, -121e6, 0, 0]"), 1);
  // The upper block reaches from y = 1 m to 2 m; at the origin there is nothing.
  const std::string gradient = "stress: [-4e8, 0, 0, 0, 0, 0], stress_gradient: [";
  EXPECT_EQ(warningsOf(gradient + "2.9e8, 0, 0, 0, 0, 0]"), 1);
  EXPECT_EQ(warningsOf(gradient + "2.85e8, 0, 0, 0, 0, 0], stress_point: [0, 0.1, 0]"), 1);
  EXPECT_EQ(warningsOf("stress: [-119e6, 0, 0, 0, 0, 0], stress_gradient: [100e6, 0, 0, 0, 0, 0], "
                       "stress_point: [0, 1, 0]"),
            0);
  const Deck gas = parseDeck("mesh: wall.e\nmaterials: {air: {model: ideal_gas, density: 1.2, "
                             "heat_ratio: 1.4, pressure: 1e5}}\ntime: {end: 1}\n"
                             "blocks: {lower: {material: air}, upper: {material: air}}\n"
                             "initial: [{block: upper, stress: [-1e5, -1e5, -1e5, 0, 0, 0]}]\n",
                             "wall.yaml");
  const auto before = logWarningCounts();
  warnOfInitialStress(gas, mesh, part, comm);
  EXPECT_EQ(logWarningCounts(), before);
}

TEST(ConditionsOfDeck, blastWaveOfACharge)
{
  const Model model = modelOf(blocksOfTwo + R"(
conditions:
  - {type: air_blast, side_set: load, charge_mass: 8, charge_place: [0.5, 12, 0], burst: air, detonation_time: -0.01}
)");
  ASSERT_EQ(model.conditions.airBlasts.size(), 1u);
  for (const BlastSide& face : model.conditions.airBlasts[0].sides)
  {
    const Vec3 way = Vec3{0.5, 12, 0} - face.side.place;
    const BlastValues values = blastValuesAt(Burst::Air, 8, norm(way));
    const Real cosine = way.y / norm(way);
    EXPECT_DOUBLE_EQ(face.wave.arrival, values.arrival - 0.01);
    EXPECT_DOUBLE_EQ(face.wave.reflected.peak, values.reflectedPressure);
    EXPECT_NEAR(face.wave.reflection, cosine * cosine, 1e-14);
  }
}

TEST(ConditionsOfDeck, chargesBeyondTheMeasurementsAreProblems)
{
  const Comm comm;
  const Mesh mesh = wallOfTwo();
  const auto problemsOf = [&](const std::string& text)
  {
    const Deck deck = parseDeck(deckOfTwo + text, "wall.yaml");
    return problemsOfAirBlasts(
        deck, mesh, distribute(mesh, scatteredOwners(mesh, comm.size()), comm.rank()), comm);
  };
  const auto blastAt = [&](const std::string& place, const std::string& before = "")
  {
    return problemsOf(
        before + blocksOfTwo +
        "conditions: [{type: air_blast, side_set: load, charge_mass: 8, charge_place: " + place +
        "}]\n");
  };
  EXPECT_TRUE(blastAt("[0.5, 12, 0]").empty());
  ASSERT_EQ(blastAt("[0.5, 2.1, 0]").size(), 1u);
  EXPECT_NE(blastAt("[0.5, 2.1, 0]")[0].find("accepted for burst: surface: 0.178 to 40 m/kg^(1/3), "
                                             "here 0.356 to 80 m"),
            std::string::npos)
      << blastAt("[0.5, 2.1, 0]")[0];
  EXPECT_EQ(blastAt("[0.5, 90, 0]").size(), 1u);
  EXPECT_EQ(blastAt("[0.5, 12, 0]", "geometry: axisymmetric\n").size(), 1u); // off the axis
  EXPECT_TRUE(blastAt("[0, 12, 0]", "geometry: axisymmetric\n").empty());
}

TEST(ConditionsOfDeck, reactionsThatNothingCanTellAreProblems)
{
  const Comm comm;
  const Mesh mesh = wallOfTwo();
  const auto problemsOf = [&](const std::string& blocks, const std::string& condition)
  {
    const Deck deck =
        parseDeck(deckOfTwo + "blocks: {lower: {material: rock" + blocks +
                      "}, upper: {material: rock}}\n"
                      "history: {probes: [{name: foot, node_set: base, reaction: true}]}\n" +
                      condition,
                  "wall.yaml");
    return problemsOfReactions(
        deck, mesh, distribute(mesh, scatteredOwners(mesh, comm.size()), comm.rank()), comm);
  };
  EXPECT_TRUE(problemsOf("", "conditions: [{type: fixed, node_set: base}]\n").empty());
  EXPECT_TRUE(problemsOf("", "conditions: [{type: symmetry, node_set: base, normal: [0, 1, 0]}]\n")
                  .empty());
  EXPECT_TRUE(problemsOf("", "geometry: axisymmetric\n").empty()); // one node is on the axis
  const auto free = problemsOf("", "conditions: [{type: fixed, node_set: lid}]\n");
  ASSERT_EQ(free.size(), 1u);
  EXPECT_NE(free[0].find("history.probes.0.reaction: no condition holds a node of 'base'"),
            std::string::npos)
      << free[0];
  const auto rigid = problemsOf(", rigid: true", "conditions: [{type: fixed, node_set: base}]\n");
  ASSERT_EQ(rigid.size(), 1u);
  EXPECT_NE(rigid[0].find("node set 'base' has nodes of rigid blocks"), std::string::npos)
      << rigid[0];
}

TEST(ConditionsOfDeck, dashpotsOfTwoConditionsOnOneFaceAreProblems)
{
  const Comm comm;
  Mesh mesh = wallOfTwo();
  mesh.sideSets.push_back({4, "half", {1}, {0}}); // of `floor`
  const auto problemsOf = [&](const std::string& first, const std::string& second)
  {
    const Deck deck = parseDeck(deckOfTwo + blocksOfTwo + "conditions:\n  - {" + first +
                                    "}\n  - {" + second + "}\n",
                                "wall.yaml");
    return problemsOfDashpots(
        deck, mesh, distribute(mesh, scatteredOwners(mesh, comm.size()), comm.rank()), comm);
  };
  const std::string floor = "type: absorbing, side_set: floor";
  EXPECT_TRUE(problemsOf(floor, "type: free_field, side_set: load").empty());
  EXPECT_TRUE(problemsOf(floor, "type: pressure, side_set: floor, value: 1").empty());
  EXPECT_TRUE(problemsOf(floor + ", until: 0.5", floor + ", from: 0.5").empty());
  const auto found = problemsOf(floor, "type: free_field, side_set: half, from: 0.5");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].find("wall.yaml:7:5: free_field side set 'half' has 1 faces that the "
                          "absorbing side set 'floor' of wall.yaml:6:5 has, too, side 1 of element "
                          "2 the first"),
            std::string::npos)
      << found[0];
  EXPECT_EQ(problemsOf(floor, floor).size(), 1u);
}

TEST(ConditionsOfDeck, bodiesOfRevolutionStayOnTheirAxis)
{
  const Model model = modelOf("geometry: axisymmetric\n" + blocksOfTwo);
  EXPECT_TRUE(model.conditions.axisymmetric);
  EXPECT_TRUE(model.contact.axisymmetric);
  ASSERT_EQ(model.conditions.symmetries.size(), 1u);
  EXPECT_EQ(countOnAllRanks(model.conditions.symmetries[0].nodes), 6);

  Mesh beyond = wallOfTwo();
  for (Vec3& x : beyond.coordinates)
    x.x -= 0.25;
  try
  {
    modelOf("geometry: axisymmetric\n" + blocksOfTwo, beyond);
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("node 1 is at x = -0.25 m"), std::string::npos)
        << error.what();
  }
}

TEST(ConditionsOfDeck, rigidMotionNamesItsBlock)
{
  const Model model = modelOf(R"(
blocks: {lower: {material: rock}, upper: {material: rock, rigid: true}}
conditions: [{type: rigid_motion, block: upper, velocity: [0, "-t", 0], angular_velocity: [0, 0, 4], components: [y]}]
)");
  ASSERT_EQ(model.conditions.rigidMotions.size(), 1u);
  const RigidMotion& motion = model.conditions.rigidMotions[0];
  EXPECT_EQ(motion.block, 1);
  EXPECT_EQ(motion.components, (std::array<bool, 3>{false, true, false}));
  EXPECT_DOUBLE_EQ(motion.velocity[1](3), -3);
  ASSERT_TRUE(motion.spin);
  EXPECT_DOUBLE_EQ((*motion.spin)(0).z, 4);
}

TEST(ConditionsOfDeck, rigidMotionsOfZeroHold)
{
  const Model model = modelOf(R"(
blocks: {lower: {material: rock}, upper: {material: rock, rigid: true}}
conditions: [{type: rigid_motion, block: upper, velocity: [0, "-t", 0]}]
)");
  const RigidMotion& motion = model.conditions.rigidMotions.at(0);
  EXPECT_TRUE(motion.components[0]);
  EXPECT_FALSE(motion.velocity[0]);
  EXPECT_TRUE(motion.velocity[1]);
}

TEST(ConditionsOfDeck, massDampingMustNotBeNegative)
{
  const Model model = modelOf(blocksOfTwo + "damping: {mass: \"10 - t\", until: 50}\n");
  EXPECT_DOUBLE_EQ(model.conditions.massDampingAt(4), 6);
  EXPECT_DOUBLE_EQ(model.conditions.massDampingAt(60), 0);
  EXPECT_THROW(model.conditions.massDampingAt(11), Error);
}
} // namespace
} // namespace coplane
