#include "Rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace coplane
{
namespace
{
constexpr Real waveSpeed = 1095.4451150103321; // of the rock of the rig, with its sides held
constexpr Real rho = 1000;

/// Nodes at one height of a box, of those that are chosen, go to another one.
void moveLayer(
    Mesh& mesh, Real from, Real to,
    const std::function<bool(const Vec3&)>& chosen = [](const Vec3&) { return true; })
{
  for (Vec3& x : mesh.coordinates)
    if (std::abs(x.z - from) < 1e-12 && chosen(x))
      x.z = to;
}

Model withLevels(Model model, int levels)
{
  model.time.subcyclingLevels = levels;
  return model;
}

/// A bar along z, held at its sides, of layers of 0.1 m, a few of which are thin. No viscosity.
Model barOfLayers(const Mesh& mesh, const Comm& comm, const std::string& method = "multijagged")
{
  Model model = rockModel(mesh, comm, 0, method);
  model.contactEnabled = false;
  model.viscosity = {0, 0};
  const std::vector<int> all = ownedNodesWhere(model.mesh, [](const Vec3&) { return true; });
  for (int axis = 0; axis < 2; ++axis)
    model.conditions.symmetries.push_back({all, {Real(axis == 0), Real(axis == 1), 0}});
  return model;
}

Mesh layers(int count)
{
  Mesh mesh;
  addBox(mesh, "bar", {1, 1, count}, {0, 0, 0}, {0.1, 0.1, 0.1 * count});
  return mesh;
}

/// A smooth push of 1 MPa and 1 ms at the lower end of a bar with two thin layers.
Model pushedBar(const Comm& comm)
{
  Mesh mesh = layers(40);
  moveLayer(mesh, 0.6, 0.68);
  moveLayer(mesh, 2.3, 2.38);
  Model model = barOfLayers(mesh, comm);
  model.conditions.pressures = {
      {sidesWhere(model.mesh, [](const Vec3& x) { return std::abs(x.z) < 1e-12; }),
       [](Real t) { return t < 1e-3 ? 1e6 * std::pow(std::sin(3141.592653589793 * t), 2) : 0; }}};
  return model;
}

struct Pushed
{
  Real displacement; ///< of the upper end, when the pulse has been there [m]
  Real energyError;  ///< over the kinetic energy [-]
};

Pushed pushedBar(const Comm& comm, int levels, Real stepFactor)
{
  Model model = withLevels(pushedBar(comm), levels);
  model.time.stepFactor = stepFactor;
  Solver solver(std::move(model), comm);
  solver.prepare();
  while (solver.clock().time < 5.5e-3)
    solver.advance();
  EXPECT_EQ(solver.subcycling().substeps() > 1, levels > 1);
  const EnergyBalance energy = solver.energy();
  EXPECT_LT(std::abs(energy.kinetic - energy.initial - energy.nodalWork), 1e-5 * energy.kinetic);
  EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
  EXPECT_LT(norm(solver.momenta().angularError()), 1e-12 * solver.momenta().magnitude);
  Real top = 0;
  for (int n = 0; n < solver.layout().owned(); ++n)
    if (solver.state().reference(n, 2) > 3.999)
      top = solver.state().x(n, 2) - 4;
  return {comm.max(top), std::abs(energy.error()) / energy.kinetic};
}

/// A cube falls aslant on a corner of another one, where that has some thin elements.
Model crushedCubes(const Comm& comm, const std::string& method = "multijagged")
{
  Mesh mesh;
  addBox(mesh, "lower", {8, 8, 8}, {0, 0, 0}, {1, 1, 1});
  moveLayer(mesh, 0.875, 0.97, [](const Vec3& x) { return x.x < 0.3 && x.y < 0.3; });
  addBox(mesh, "upper", {2, 2, 3}, {0.05, 0.0625, 1}, {0.4, 0.4, 0.5});
  Model model = rockModel(mesh, comm, 0.25, method);
  model.blocks[1].velocity = {0.5, 0.25, -1};
  return withLevels(std::move(model), 4);
}

struct SubcyclingInContact : WithForces
{
};
INSTANTIATE_TEST_SUITE_P(, SubcyclingInContact, WithForces::both(), WithForces::name);
} // namespace

TEST(SubcycledBar, carriesAPulseLikeSmallSteps)
{
  const Comm comm;
  const Real exact = 2 * 0.5e3 / (rho * waveSpeed); // twice the impulse over rho c
  const Pushed small = pushedBar(comm, 1, 0.8), few = pushedBar(comm, 4, 0.8),
               half = pushedBar(comm, 4, 0.4);
  EXPECT_NEAR(small.displacement, exact, 1e-2 * exact);
  EXPECT_NEAR(few.displacement, exact, 1e-2 * exact);
  EXPECT_NEAR(half.displacement, exact, 1e-2 * exact);
  EXPECT_LT(small.energyError, 1e-3);
  EXPECT_LT(few.energyError, 1e-2);
  EXPECT_LT(half.energyError, 0.35 * few.energyError); // of the second order
}

TEST(SubcycledBar, takesFewerCycles)
{
  const Comm comm;
  Solver small(pushedBar(comm), comm), few(withLevels(pushedBar(comm), 4), comm);
  small.prepare();
  few.prepare();
  EXPECT_GT(few.clock().nextStep, 3 * small.clock().nextStep);
  EXPECT_EQ(few.subcycling().substeps(), 4);
  EXPECT_EQ(few.substeppedElements(), 6); // two thin ones and their neighbours
  // No more than it may.
  Solver two(withLevels(pushedBar(comm), 2), comm);
  two.prepare();
  EXPECT_EQ(two.subcycling().substeps(), 2);
  EXPECT_NEAR(two.clock().nextStep, 2 * small.clock().nextStep, 1e-12 * two.clock().nextStep);
}

TEST(SubcycledBar, keepsTheEnergyOfBarsOfAnyLayers)
{
  // Resonance between steps would show as growth: random layers, no viscosity.
  const Comm comm;
  std::mt19937 random(4);
  std::uniform_real_distribution<Real> shift(0, 0.095);
  for (int bar = 0; bar < 4; ++bar)
  {
    Mesh mesh = layers(60);
    for (int layer = 5; layer < 60; layer += 18)
      moveLayer(mesh, 0.1 * layer, 0.1 * layer + shift(random));
    Model model = withLevels(barOfLayers(mesh, comm), 5);
    model.time.stepFactor = 0.9;
    model.blocks[0].velocity = {0, 0, 1};
    model.conditions.symmetries.push_back(
        {ownedNodesWhere(model.mesh, [](const Vec3& x) { return std::abs(x.z) < 1e-12; }),
         {0, 0, 1}});
    Solver solver(std::move(model), comm);
    solver.prepare();
    cycles(solver, 5000);
    const EnergyBalance energy = solver.energy();
    EXPECT_GT(solver.subcycling().substeps(), 1) << "bar " << bar;
    EXPECT_LT(std::abs(energy.error()), 0.02 * energy.initial) << "bar " << bar;
    EXPECT_LT(norm(solver.momenta().linearError()), 1e-11 * solver.momenta().magnitude);
  }
}

TEST(SubcycledBar, staysAtRestUnderStress)
{
  const Comm comm;
  Mesh mesh = layers(60);
  moveLayer(mesh, 3.1, 3.02);
  Model model = withLevels(barOfLayers(mesh, comm), 4);
  model.blocks[0].stress = {-1e6, -1e6, -3e6, 0, 0, 0};
  for (const Real end : {0.0, 6.0})
    model.conditions.pressures.push_back(pressureWhere(
        model.mesh, 3e6, [end](const Vec3& x) { return std::abs(x.z - end) < 1e-12; }));
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 200);
  EXPECT_GT(solver.subcycling().substeps(), 1);
  EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), 1e-12);
}

TEST(SubcycledBar, hasNoReactionsOfSubstepsThatHaveEnded)
{
  const Comm comm;
  Mesh mesh = layers(20);
  moveLayer(mesh, 0.1, 0.015);
  Model model = withLevels(barOfLayers(mesh, comm), 4);
  const std::vector<int> end =
      ownedNodesWhere(model.mesh, [](const Vec3& x) { return std::abs(x.z) < 1e-12; });
  PrescribedVelocity held;
  held.nodes = end;
  held.components = {false, false, true};
  model.conditions.velocities = {held};
  model.blocks[0].velocity = {0, 0, 5};
  model.blocks[0].erosion.volumeRatio = {0.5, 1.01}; // the thin layer tears
  Solver solver(std::move(model), comm);
  solver.prepare();
  EXPECT_GT(solver.subcycling().substeps(), 1);
  cycles(solver, 300);
  EXPECT_GT(solver.erosion().elements, 0);
  EXPECT_EQ(solver.subcycling().substeps(), 1);
  EXPECT_EQ(largest(solver.state().takenOff, solver.layout().owned(), comm), 0);
  for (const int n : end)
    EXPECT_EQ(norm(solver.reaction(n)), 0);
  EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
}

TEST(SubcycledBar, holdsWhatConditionsHold)
{
  // The thin layer is at an end that moves as it is told to; the reaction is what the bar feels.
  const Comm comm;
  Real work[2];
  for (const int levels : {1, 4})
  {
    Mesh mesh = layers(20);
    moveLayer(mesh, 0.1, 0.015);
    Model model = withLevels(barOfLayers(mesh, comm), levels);
    PrescribedVelocity end;
    end.nodes = ownedNodesWhere(model.mesh, [](const Vec3& x) { return std::abs(x.z) < 1e-12; });
    end.components = {false, false, true};
    end.velocity[2] = [](Real t) { return 0.1 * std::min(1.0, t / 5e-4); };
    model.conditions.velocities = {end};
    Solver solver(std::move(model), comm);
    solver.prepare();
    const Momenta before = solver.momenta();
    const NodeVectors felt("felt", 1), moved("moved", 1);
    while (solver.clock().time < 1.6e-3)
    {
      solver.advance();
      const Clock& clock = solver.clock();
      for (const int n : end.nodes)
        felt(0, 2) += 0.5 * (clock.step + clock.nextStep) * solver.reaction(n).z;
    }
    EXPECT_EQ(solver.subcycling().substeps() > 1, levels > 1);
    const Real impulse = solver.momenta().impulse.z - before.impulse.z;
    EXPECT_NEAR(sumOverRanks(felt, 1, comm).z, impulse, 1e-10 * impulse);
    for (const int n : end.nodes) // to the middle of the next step, as the impulse
      moved(0, 2) +=
          0.25 * (solver.state().x(n, 2) + 0.5 * solver.clock().nextStep * solver.state().v(n, 2));
    const Real exact = rho * waveSpeed * 0.01 * sumOverRanks(moved, 1, comm).z; // rho c A u
    EXPECT_NEAR(impulse, exact, 2e-2 * exact);
    const EnergyBalance energy = solver.energy();
    work[levels > 1] = energy.externalWork;
    EXPECT_LT(std::abs(energy.error()), 1e-2 * energy.externalWork);
    EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
  }
  EXPECT_NEAR(work[1], work[0], 2e-2 * work[0]);
}

TEST_P(SubcyclingInContact, keepsMomentaAndEnergyInContact)
{
  const Comm comm;
  Vec3 velocity[2];
  for (const int levels : {1, 4})
  {
    Solver solver(withLevels(crushedCubes(comm), levels), comm);
    solver.prepare();
    int substeps = 1;
    while (solver.clock().time < 6e-3)
    {
      solver.advance();
      substeps = std::max(substeps, solver.subcycling().substeps());
    }
    EXPECT_EQ(substeps > 1, levels > 1);
    const EnergyBalance energy = solver.energy();
    EXPECT_GT(energy.contact.friction, 0.01 * energy.initial);
    // They begin in contact, at full speed: forces come up in the first cycle.
    EXPECT_LT(std::abs(energy.error()), (levels > 1 ? 5e-3 : 1e-4) * energy.initial);
    EXPECT_LT(std::abs(energy.contact.remainder()), 2e-2 * energy.initial);
    const Momenta momenta = solver.momenta();
    EXPECT_LT(norm(momenta.linearError()), 1e-12 * momenta.magnitude);
    // What is steady acts in all of a cycle, on nodes that turn a little meanwhile.
    EXPECT_LT(norm(momenta.angularError()), (levels > 1 ? 1e-9 : 1e-12) * momenta.magnitude);
    NodeVectors momentum("momentum", std::size_t(solver.layout().owned()));
    for (int n = 0; n < solver.layout().owned(); ++n)
      if (solver.state().reference(n, 2) > 0.999 &&
          solver.state().reference(n, 0) > 0.04) // of the upper one, and a layer of the lower one
        set(momentum, n, solver.state().mass(n) * at(solver.state().v, n));
    velocity[levels > 1] = sumOverRanks(momentum, solver.layout().owned(), comm);
  }
  EXPECT_LT(norm(velocity[1] - velocity[0]), 0.02 * norm(velocity[0]));
}

TEST_P(SubcyclingInContact, keepsMomentumWhereElementsDieAndSearchesCome)
{
  // Planes that begin in a substep, and lose an element or meet a search in the same cycle.
  const Comm world, alone(MPI_COMM_SELF);
  const auto run = [](const Comm& comm)
  {
    Model model = crushedCubes(comm);
    for (BlockSetup& block : model.blocks)
      block.erosion.volumeRatio = {0.985, 1.02};
    model.blocks[1].velocity = {60, 20, -30};
    model.skin = 0.01;
    model.time.energyTolerance = model.time.contactGainTolerance = infinity;
    Solver solver(std::move(model), comm);
    solver.prepare();
    int substeps = 1;
    for (int i = 0; i < 150; ++i)
    {
      solver.advance();
      substeps = std::max(substeps, solver.subcycling().substeps());
      EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
    }
    EXPECT_GT(substeps, 1);
    EXPECT_GT(solver.erosion().elements, 4);
    EXPECT_GT(solver.searches(), 10);
    return solver.stateHash();
  };
  EXPECT_EQ(run(world), run(alone));
}

TEST_P(SubcyclingInContact, keepsMomentumWithRigidBodies)
{
  // A rigid body comes to substepped elements, which it stops from being so.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "lower", {8, 8, 8}, {0, 0, 0}, {1, 1, 1});
  moveLayer(mesh, 0.875, 0.97, [](const Vec3& x) { return x.x < 0.3 && x.y < 0.3; });
  addBox(mesh, "rigid", {2, 2, 2}, {-0.4, 0.0625, 1.06}, {0.5, 0.4, 0.5});
  Model model = withLevels(rockModel(mesh, comm, 0.25), 4);
  model.rigidBodyOfNode = rigidBodiesOf(model.mesh, {0, 1}, comm);
  model.blocks[1].rigid = true;
  model.blocks[1].velocity = {24, 1, -18};
  model.skin = 5e-4;
  model.time.energyTolerance = model.time.contactGainTolerance = infinity;
  Solver solver(std::move(model), comm);
  solver.prepare();
  EXPECT_GT(solver.subcycling().substeps(), 1);
  for (int i = 0; i < 150; ++i)
  {
    solver.advance();
    EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
  }
  EXPECT_GT(solver.searches(), 5);
  EXPECT_GT(solver.energy().internal, 0.01 * solver.initialEnergy().kinetic); // they have met
}

TEST_P(SubcyclingInContact, hasTheSameBitsOnAnyRanks)
{
  const Comm world, alone(MPI_COMM_SELF);
  const auto hashAfter = [](Model model, const Comm& comm)
  {
    Solver solver(std::move(model), comm);
    solver.prepare();
    cycles(solver, 24);
    EXPECT_GT(solver.contact().counts().carrying, 0);
    EXPECT_GT(solver.subcycling().substeps(), 1);
    return solver.stateHash();
  };
  const std::uint64_t expected = hashAfter(crushedCubes(alone), alone);
  for (const char* method : {"multijagged", "rcb", "scattered", "last"})
    EXPECT_EQ(hashAfter(crushedCubes(world, method), world), expected) << method;
  const Backend before = currentBackend();
  for (const Backend backend : {Backend::Serial, Backend::Threads})
  {
    setBackend(backend);
    EXPECT_EQ(hashAfter(crushedCubes(world), world), expected);
  }
  setBackend(before);
}

TEST_P(SubcyclingInContact, hasTheBitsOfTheStraightRunWhenThePartitionChanges)
{
  const Comm comm;
  Solver straight(crushedCubes(comm), comm), moved(crushedCubes(comm), comm);
  straight.prepare();
  moved.prepare();
  const std::string methods[] = {"scattered", "rcb", "last", "hsfc"};
  for (int cycle = 1; cycle <= 24; ++cycle)
  {
    straight.advance();
    moved.advance();
    if (cycle % 3 == 0)
      moved.repartition(crushedCubes(comm, methods[cycle / 3 % 4]));
    ASSERT_EQ(moved.stateHash(), straight.stateHash()) << "cycle " << cycle;
    ASSERT_EQ(moved.subcycling().substeps(), straight.subcycling().substeps());
  }
  EXPECT_GT(straight.subcycling().substeps(), 1);
  EXPECT_GT(straight.contact().counts().carrying, 0);
}
} // namespace coplane
