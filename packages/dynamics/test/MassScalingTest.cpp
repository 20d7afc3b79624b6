#include "Rig.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace coplane
{
namespace
{
/// A body of equal elements in flight.
Model flyingBox(const Comm& comm)
{
  Mesh mesh;
  addBox(mesh, "box", {3, 2, 2}, {0, 0, 0}, {0.75, 0.5, 0.5});
  Model model = rockModel(mesh, comm, 0.25);
  model.contactEnabled = false;
  model.blocks[0].velocity = {3, -2, 1};
  return model;
}

Real stepOf(Model model, const Comm& comm)
{
  Solver solver(std::move(model), comm);
  solver.prepare();
  return solver.clock().nextStep;
}

/// The least of m / (mass that the node needs for the step) - 1 over free nodes.
Real leastRoom(const Solver& solver, Real stableStep, const Comm& comm)
{
  Real least = infinity;
  const NodalState& state = solver.state();
  std::vector<Real> needed(std::size_t(solver.layout().owned()), 0);
  for (std::size_t b = 0; b < solver.blocks().size(); ++b)
  {
    const RankMesh::Block& part = solver.mesh().blocks[b];
    for (std::size_t i = 0; i < part.connectivity.size(); ++i)
      if (const int n = part.connectivity[i]; n < solver.layout().owned())
        needed[std::size_t(n)] +=
            solver.blocks()[b].cornerMass(int(i) / 8, int(i) % 8) *
            std::pow(stableStep / solver.blocks()[b].stableStep()(int(i) / 8), 2);
  }
  for (int n = 0; n < solver.layout().owned(); ++n)
    least =
        std::min(least, state.mass(n) / (needed[std::size_t(n)] +
                                         state.contactStiffness(n) * stableStep * stableStep / 4) -
                            1);
  return comm.min(least);
}
} // namespace

TEST(MassScaling, givesTheStepAndKeepsTheVelocityOfFreeFlight)
{
  const Comm comm;
  Model model = flyingBox(comm);
  const Real natural = stepOf(flyingBox(comm), comm);
  model.time.massScaling = MassScalingOptions{3 * natural, 9};
  Solver solver(std::move(model), comm);
  solver.prepare();
  EXPECT_EQ(solver.clock().nextStep, 3 * natural);
  cycles(solver, 50);
  EXPECT_EQ(solver.clock().step, 3 * natural);
  const Vec3 v{3, -2, 1};
  for (int n = 0; n < solver.layout().owned(); ++n)
    EXPECT_LT(norm(at(solver.state().v, n) - v), 1e-9);
  // All masses grow by the square of three; the added mass has eight ninths of all that moves.
  const AddedMass added = solver.addedMasses().at(0);
  EXPECT_NEAR(added.ratio(), 8, 1e-7);
  EXPECT_LT(norm(added.momentum - added.added * v), 1e-6 * norm(added.momentum));
  EXPECT_NEAR(added.kinetic, 0.5 * added.added * dot(v, v), 1e-6 * added.kinetic);
  EXPECT_NEAR(added.kinetic / solver.energy().kinetic, 8.0 / 9, 1e-7);
  EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
}

TEST(MassScaling, addsNothingWhereElementsAllowTheStep)
{
  const Comm comm;
  const Real natural = stepOf(flyingBox(comm), comm);
  Model model = flyingBox(comm);
  model.time.massScaling = MassScalingOptions{0.9 * natural, 0.1};
  Solver solver(std::move(model), comm);
  solver.prepare();
  EXPECT_EQ(solver.addedMasses().at(0).added, 0);
  EXPECT_NEAR(solver.clock().nextStep, natural, 1e-12 * natural); // and no smaller one
}

TEST(MassScaling, gravityActsOnTheMassOfElements)
{
  const Comm comm;
  const Real natural = stepOf(flyingBox(comm), comm);
  Model model = flyingBox(comm);
  model.blocks[0].velocity = {};
  model.conditions.gravity = VectorOfTime(0, 0, -9.81);
  model.time.massScaling = MassScalingOptions{2 * natural, 4};
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 20);
  // The kick to n + 1/2 lies half a step ahead.
  const Real t = solver.clock().time + natural;
  for (int n = 0; n < solver.layout().owned(); ++n)
    EXPECT_NEAR(solver.state().v(n, 2), -9.81 / 4 * t, 1e-7 * 9.81 * t);
  EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
}

TEST(MassScaling, booksWhatComesInTheRun)
{
  const Comm comm;
  Model before = slidingCubes(comm);
  const Real natural = stepOf(std::move(before), comm);
  Model model = slidingCubes(comm);
  const Real step = 2 * natural;
  model.time.massScaling = MassScalingOptions{step, 50};
  Solver solver(std::move(model), comm);
  solver.prepare();
  const auto added = [&]
  {
    Real sum = 0;
    for (const AddedMass& block : solver.addedMasses())
      sum += block.added;
    return sum;
  };
  const Real atStart = added();
  for (int cycle = 0; cycle < 60; ++cycle)
  {
    solver.advance();
    // Every node has what it needs, so no frequency is too high.
    EXPECT_GE(leastRoom(solver, step / solver.model().time.stepFactor, comm), 0);
  }
  EXPECT_GT(added(), 1.005 * atStart); // else nothing was booked; 0.66 % is what comes
  EXPECT_EQ(solver.clock().step, step);
  const Momenta momenta = solver.momenta();
  EXPECT_LT(norm(momenta.linearError()), 1e-12 * momenta.magnitude);
  EXPECT_LT(norm(momenta.angularError()), 1e-11 * momenta.magnitude);
  EXPECT_GT(norm(momenta.impulse), 1e-6 * momenta.magnitude); // of what has come in
  const EnergyBalance energy = solver.energy();
  EXPECT_NEAR(energy.kinetic - solver.initialEnergy().kinetic, energy.nodalWork,
              1e-10 * energy.scale());
  EXPECT_LT(std::abs(energy.error()), 0.02 * energy.scale());
}

TEST(MassScaling, endsTheRunBeyondTheLimit)
{
  const Comm comm;
  const Real natural = stepOf(flyingBox(comm), comm);
  Model model = flyingBox(comm);
  model.time.massScaling = MassScalingOptions{2 * natural, 2.9}; // three times are needed
  Solver solver(std::move(model), comm);
  try
  {
    solver.prepare();
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Computation);
    EXPECT_TRUE(error.onAllRanks());
    EXPECT_NE(std::string(error.what()).find("limit = 2.9: block 'box' 3 times"), std::string::npos)
        << error.what();
  }
}
} // namespace coplane
