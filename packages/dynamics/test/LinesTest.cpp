// Lines in a mesh: where they are found, what they do to nodes, books, bits.
#include "Rig.hpp"

#include <coplane_checkpoint/StateTables.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace coplane
{
namespace
{
LineSetup boltFrom(const Vec3& a, const Vec3& b, int segments)
{
  LineSetup setup;
  setup.name = "bolt";
  setup.where = "deck.yaml:1:1";
  setup.section.area = 1e-3;
  setup.section.youngsModulus = 200e9;
  setup.bond = {1e9, 4e4, 0, 0};
  const Real length = norm(b - a);
  for (int i = 0; i <= segments; ++i)
  {
    LinePoint point;
    point.place = a + (Real(i) / segments) * (b - a);
    point.tied = i == 0;
    point.bonded = length / segments * (i == 0 || i == segments ? 0.5 : 1);
    setup.points.push_back(point);
  }
  return setup;
}

/// Two cubes that slide and turn on each other, with a bolt through both and its dowel, and a cable
/// that is pretensioned.
Model boltedCubes(const Comm& comm, const std::string& method = "multijagged")
{
  Model model = slidingCubes(comm, method);
  model.lines = {boltFrom({0.4, 0.45, 1.9}, {0.6, 0.5, 0.2}, 9),
                 boltFrom({0.8, 0.8, 1.8}, {0.75, 0.7, 0.1}, 1)};
  model.lines[0].dowel = LineDowel{2e8, 1e4};
  model.lines[0].section.diameter = 0.03; // bends, too
  model.lines[1].name = "cable";
  model.lines[1].points[1].tied = true;
  model.lines[1].pretension = 2e5;
  model.lines[1].pretensionTime = 2e-3;
  model.lines[1].from = 1e-3;
  model.time.energyTolerance = infinity;
  return model;
}
} // namespace

TEST(Lines, bindBodiesWithoutAddingMomentum)
{
  const Comm comm;
  Solver solver(boltedCubes(comm), comm);
  solver.prepare();
  while (solver.clock().time < 8e-3)
    solver.advance();
  const Momenta momenta = solver.momenta();
  EXPECT_LT(norm(momenta.linearError()), 1e-12 * momenta.magnitude);
  EXPECT_LT(norm(momenta.angularError()), 1e-6 * momenta.magnitude);
  const EnergyBalance energy = solver.energy();
  EXPECT_GT(energy.lines.bond, 0);
  EXPECT_GT(energy.lines.stored, 0);
  EXPECT_GT(energy.lines.pretension, 0);
  EXPECT_EQ(solver.lines().lines()[0].dowels().size(), 1u);
  EXPECT_NE(norm(solver.lines().lines()[0].dowels()[0].force), 0);
  EXPECT_LT(std::abs(energy.error()), 1e-3 * energy.scale());
  EXPECT_LT(std::abs(energy.lines.remainder()), 1e-3 * energy.scale());
  EXPECT_EQ(solver.lines().lines()[0].unbalanced(), 0);
}

TEST(Lines, whatHoldsThemBeyondAPlaneOfSymmetryIsInTheBooks)
{
  const Comm comm;
  for (const bool stops : {false, true})
  {
    Model model = boltedCubes(comm);
    model.lines[0].points.front().tied = false;
    model.lines[0].mirrored = {true, false};
    if (stops)
      model.conditions.relaxation = {true, 0, 0};
    Solver solver(std::move(model), comm);
    solver.prepare();
    Real magnitude = 0;
    while (solver.clock().time < 8e-3)
    {
      solver.advance();
      magnitude = std::max(magnitude, solver.momenta().magnitude);
    }
    EXPECT_EQ(solver.relaxation().stops > 0, stops);
    EXPECT_GT(norm(solver.lines().lines()[0].outerMoments()[0]), 0);
    const Momenta momenta = solver.momenta();
    EXPECT_GT(norm(momenta.angularImpulse), 1e-4 * magnitude);
    EXPECT_LT(norm(momenta.angularError()), 1e-6 * magnitude);
  }
}

TEST(Lines, haveTheSameBitsForAnyPartition)
{
  const Comm comm;
  std::vector<std::uint64_t> hashes;
  for (const char* method : {"multijagged", "scattered", "last"})
  {
    Solver solver(boltedCubes(comm, method), comm);
    solver.prepare();
    cycles(solver, 60);
    hashes.push_back(solver.stateHash());
  }
  const Comm alone = Comm::alone();
  Solver solver(boltedCubes(alone), alone);
  solver.prepare();
  cycles(solver, 60);
  for (const std::uint64_t hash : hashes)
    EXPECT_EQ(hash, solver.stateHash());
}

TEST(Lines, goOnWithTheSameBitsFromACheckpointAndAfterARepartition)
{
  const Comm comm;
  Solver whole(boltedCubes(comm), comm), first(boltedCubes(comm), comm);
  whole.prepare();
  first.prepare();
  cycles(whole, 80);
  cycles(first, 40);
  StateTables state(comm);
  first.save(state);
  Solver second(boltedCubes(comm, "scattered"), comm);
  second.restore(state);
  cycles(second, 20);
  second.repartition(boltedCubes(comm, "last"));
  cycles(second, 20);
  EXPECT_EQ(whole.stateHash(), second.stateHash());
  EXPECT_EQ(whole.energy().lines.work, second.energy().lines.work);
}

TEST(Lines, ofAMeshWithoutContactSetTheStepToo)
{
  const Comm comm;
  Model model = rockModel(unitBox(2, 2, 2), comm);
  model.contactEnabled = false;
  const Real free = [&]
  {
    Model copy = model;
    Solver solver(std::move(copy), comm);
    solver.prepare();
    return solver.clock().nextStep;
  }();
  model.lines = {boltFrom({0.5, 0.5, 0.1}, {0.6, 1.5, 1.9}, 4)};
  model.lines[0].section.area = 0.1;
  model.lines[0].bond.stiffness = 1e12;
  Solver solver(std::move(model), comm);
  solver.prepare();
  EXPECT_LT(solver.clock().nextStep, 0.8 * free);
  EXPECT_TRUE(solver.stepControl().line);
  EXPECT_NE(solver.stepControl().text().find("a line at node"), std::string::npos);
}

TEST(Lines, haveBothSidesOfADowelInTheElementsAtTheJoint)
{
  // The first halving finds neither body: the middle of the segment lies in the gap.
  const Comm comm = Comm::alone();
  Model model = rockModel(twoCubes(0.1), comm);
  model.lines = {boltFrom({0.3, 0.3, 0.3}, {0.3, 0.3, 1.8}, 1)};
  model.lines[0].points[1].tied = true;
  model.lines[0].dowel = LineDowel{1e6, infinity};
  Solver solver(std::move(model), comm);
  solver.prepare();
  Real onNodes = 0;
  for (int n = 0; n < solver.mesh().ownedNodes; ++n)
    onNodes += solver.lines().stiffnessAt(n);
  // From the element at the gap, 0.5 m high, the other side of the gap is told with the weights 1.2
  // and -0.2; all else lies within its element.
  const std::vector<Real>& stiffness = solver.lines().lines()[0].stiffness();
  ASSERT_EQ(stiffness.size(), 4u);
  const Real expected = stiffness[0] + stiffness[1] + stiffness[2] + 1.4 * stiffness[3];
  EXPECT_NEAR(onNodes, expected, 1e-6 * expected);
}

TEST(Lines, atRestHaveNoForceAtAll)
{
  // The two sides of a dowel differ by the round-off of their weights.
  const Comm comm;
  Model model = rockModel(twoCubes(), comm);
  model.lines = {boltFrom({0.41, 0.37, 0.13}, {0.63, 0.71, 1.87}, 9)};
  model.lines[0].dowel = LineDowel{1e8, 1e5};
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 10); // with the watch over the balance of energy
  EXPECT_EQ(norm(solver.lines().lines()[0].dowels()[0].force), 0);
  EXPECT_EQ(solver.energy().kinetic, 0);
}

TEST(Lines, outsideOfTheMeshAreRefused)
{
  const Comm comm;
  Model model = rockModel(unitBox(2, 2, 2), comm);
  model.lines = {boltFrom({0.5, 0.5, 0.1}, {0.5, 0.5, 2.5}, 5)};
  try
  {
    Solver solver(std::move(model), comm);
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Deck);
    EXPECT_TRUE(error.onAllRanks());
    EXPECT_NE(std::string(error.what()).find("lines.bolt"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("2.02"), std::string::npos); // the first outside
  }
}
} // namespace coplane
