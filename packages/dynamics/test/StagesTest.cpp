#include "Rig.hpp"

#include <coplane_checkpoint/StateTables.hpp>
#include <coplane_core/ExactSum.hpp>
#include <coplane_material/J2Plasticity.hpp>
#include <coplane_material/Jwl.hpp>

#include <gtest/gtest.h>

#include <cstring>

namespace coplane
{
namespace
{
/// A column of four unit cubes along z, two for each block, which share nodes; a cube of its own
/// lies on it.
Mesh columnOfTwo()
{
  Mesh mesh;
  addBox(mesh, "lower", {1, 1, 4}, {0, 0, 0}, {1, 1, 4});
  Mesh::Block upper = mesh.blocks[0];
  Mesh::Block& lower = mesh.blocks[0];
  upper.id = 2;
  upper.name = "upper";
  const auto half = lower.elementIds.size() / 2, nodes = lower.connectivity.size() / 2;
  upper.elementIds.erase(upper.elementIds.begin(), upper.elementIds.begin() + long(half));
  upper.connectivity.erase(upper.connectivity.begin(), upper.connectivity.begin() + long(nodes));
  lower.elementIds.resize(half);
  lower.connectivity.resize(nodes);
  mesh.blocks.push_back(upper);
  addBox(mesh, "stone", {1, 1, 1}, {0.25, 0.125, 4}, {0.5, 0.5, 0.5});
  mesh.blocks.back().id = 3;
  return mesh;
}

/// It flies and vibrates under gravity, and the stone beats on it.
Model flying(const Comm& comm, const std::vector<int>& absent = {},
             const std::string& method = "multijagged")
{
  Model model = rockModel(columnOfTwo(), comm, 0.25, method);
  for (BlockSetup& block : model.blocks)
  {
    block.velocity = {1, 2, -3};
    block.velocityField = [](const Vec3& x) { return Vec3{0.1 * x.z, 0, 0.5 * x.z}; };
  }
  model.blocks[2].velocity = {1, 2, -6};
  model.conditions.gravity = VectorOfTime(0, 0, -9.81);
  // On a side of the column: of both blocks.
  model.conditions.pressures = {
      pressureWhere(model.mesh, 1e4, [](const Vec3& x) { return x.x == 1; })};
  model.time.fixedStep = 1e-4;
  model.inStages = model.blocksComeOrGo = true;
  model.absentBlocks = absent;
  return model;
}

Stage stage(const Comm& comm, const std::vector<int>& remove, const std::vector<int>& add,
            const std::vector<int>& absent = {})
{
  Stage next;
  next.index = 1;
  next.model = flying(comm, absent);
  next.remove = remove;
  next.add = add;
  return next;
}

Real massOf(const Solver& solver)
{
  std::vector<ExactSum> mass(1);
  for (int n = 0; n < solver.layout().owned(); ++n)
    mass[0].add(solver.state().mass(n));
  return ExactSum::overRanks(mass, solver.comm())[0];
}

void expectClosedBooks(const Solver& solver)
{
  const EnergyBalance energy = solver.energy();
  EXPECT_LT(std::abs(energy.error()), 1e-3 * energy.initial);
  EXPECT_LT(std::abs(energy.kinetic - solver.initialEnergy().kinetic - energy.nodalWork),
            1e-12 * energy.initial);
  const Momenta momenta = solver.momenta();
  EXPECT_LT(norm(momenta.linearError()), 1e-12 * momenta.magnitude);
  EXPECT_LT(norm(momenta.angularError()), 1e-11 * momenta.magnitude);
}
} // namespace

TEST(Stages, aBlockLeavesWithItsMassMomentumAndEnergy)
{
  const Comm comm;
  Solver solver(flying(comm), comm);
  solver.prepare();
  EXPECT_EQ(massOf(solver), 4125);
  cycles(solver, 60);
  EXPECT_GT(solver.contact().counts().planes, 0); // of the stone on what leaves
  const EnergyBalance before = solver.energy();
  solver.beginStage(stage(comm, {1}, {}));
  EXPECT_EQ(solver.stage().index, 1);
  EXPECT_EQ(solver.stage().begin, solver.clock().time);
  cycles(solver, 1);
  EXPECT_EQ(massOf(solver), 2125);
  EXPECT_EQ(solver.erosion().mass, 2000);
  EXPECT_EQ(solver.erosion().elements, 2);
  // It takes about half of the energy along.
  EXPECT_GT(solver.energy().eroded, 0.3 * before.kinetic);
  expectClosedBooks(solver);
  cycles(solver, 60);
  expectClosedBooks(solver);
  // Nodes without elements stay where they are.
  for (int n = 0; n < solver.layout().owned(); ++n)
  {
    if (solver.state().mass(n) == 0)
    {
      EXPECT_EQ(norm(at(solver.state().v, n)), 0);
    }
  }
}

TEST(Stages, facesBehindWhatHasLeftAreInContact)
{
  // The stone falls by two metres through where the block was, and beats on the one below.
  const Comm comm;
  Model model = flying(comm);
  model.blocks[2].velocity = {1, 2, -103};
  Solver solver(std::move(model), comm);
  solver.prepare();
  solver.beginStage(stage(comm, {1}, {}));
  cycles(solver, 180); // 1.8 m
  EXPECT_EQ(solver.contact().counts().stick + solver.contact().counts().slip, 0);
  cycles(solver, 30);
  EXPECT_GT(solver.contact().counts().stick + solver.contact().counts().slip, 0);
  EXPECT_EQ(solver.contact().counts().missed, 0);
  expectClosedBooks(solver);
}

TEST(Stages, aBlockComesInFreeOfStressWhereItsNodesAre)
{
  const Comm comm;
  Solver solver(flying(comm, {1}), comm);
  solver.prepare();
  EXPECT_EQ(massOf(solver), 2125);
  cycles(solver, 60);
  expectClosedBooks(solver);
  solver.beginStage(stage(comm, {}, {1}, {1}));
  cycles(solver, 1);
  const ElementBlock& upper = solver.blocks()[1];
  std::vector<ExactSum> volumes(1);
  for (int e = 0; e < upper.count(); ++e)
  {
    EXPECT_TRUE(upper.isAlive(e));
    EXPECT_EQ(upper.stress()(2, e), 0);
    EXPECT_EQ(upper.volume()(e), upper.referenceVolume()(e));
    if (solver.mesh().blocks[1].owned[std::size_t(e)])
      volumes[0].add(upper.referenceVolume()(e));
  }
  const Real volume = ExactSum::overRanks(volumes, comm)[0];
  EXPECT_GT(std::abs(volume - 2), 1e-6); // nodes below it have moved
  EXPECT_NEAR(massOf(solver), 2125 + 1000 * volume, 1e-9);
  cycles(solver, 60);
  EXPECT_LT(solver.energy().eroded, 0); // it came with the motion of the nodes that it shares
  expectClosedBooks(solver);
}

TEST(Stages, loadsOnFacesActFromWhenTheirBlockIsThere)
{
  const Comm comm;
  const auto pushed = [](const Solver& solver)
  {
    std::vector<ExactSum> force(1);
    for (int n = 0; n < solver.layout().owned(); ++n)
      force[0].add(solver.state().external(n, 0));
    return ExactSum::overRanks(force, solver.comm())[0];
  };
  Solver solver(flying(comm, {1}), comm);
  solver.prepare();
  cycles(solver, 5);
  EXPECT_NEAR(pushed(solver), -2e4, 1e2); // two faces of 1 m^2
  solver.beginStage(stage(comm, {}, {1}, {1}));
  cycles(solver, 1);
  EXPECT_NEAR(pushed(solver), -4e4, 2e2);
  solver.beginStage(stage(comm, {0}, {}, {1}));
  cycles(solver, 1);
  EXPECT_NEAR(pushed(solver), -2e4, 1e2);
}

TEST(Stages, aChargeThatComesInIsLitByTheClockOfTheRun)
{
  const Comm comm;
  JwlParameters tnt;
  tnt.density = 1630;
  tnt.a = 371.2e9;
  tnt.b = 3.231e9;
  tnt.r1 = 4.15;
  tnt.r2 = 0.95;
  tnt.omega = 0.3;
  tnt.detonationEnergy = 7e9;
  tnt.detonationSpeed = 6930;
  tnt.detonationPressure = 21e9;
  tnt.lightingPoints = {{0.5, 0.5, 2}};
  for (const Real lit : {5e-3, 1e-3}) // after it has come, and before
  {
    tnt.lightingTimes = {lit};
    Model model = flying(comm, {1});
    model.blocks[1].material = makeLaw(tnt);
    Stage next = stage(comm, {}, {1}, {1});
    next.model.blocks[1].material = makeLaw(tnt);
    Solver solver(std::move(model), comm);
    solver.prepare();
    cycles(solver, 20);
    solver.beginStage(std::move(next));
    cycles(solver, 1);
    Real soonest = infinity, latest = -infinity;
    const ElementBlock& charge = solver.blocks()[1];
    for (int e = 0; e < charge.count(); ++e)
    {
      soonest = std::min(soonest, charge.history(Jwl::TimeToBurn, e));
      latest = std::max(latest, charge.history(Jwl::TimeToBurn, e));
    }
    const Real wait = std::max(lit - solver.clock().time, 0.0), length = 2;
    EXPECT_GE(comm.min(soonest), wait);
    EXPECT_LT(comm.max(latest), wait + length / tnt.detonationSpeed);
  }
}

TEST(Stages, aStiffBlockThatComesInHasItsSayInTheStep)
{
  const Comm comm;
  const auto withStiffUpper = [&]
  {
    Model model = flying(comm, {1});
    model.blocks[1].material = makeLinearElastic(1e15, 0.25, 1000);
    model.time.fixedStep.reset();
    return model;
  };
  Solver solver(withStiffUpper(), comm);
  solver.prepare();
  cycles(solver, 20);
  const Real soft = solver.clock().nextStep;
  Stage next = stage(comm, {}, {1}, {1});
  next.model = withStiffUpper();
  solver.beginStage(std::move(next));
  cycles(solver, 1);
  EXPECT_EQ(solver.clock().step, soft); // without forces of the block
  // Not every rank has elements of the block.
  const Real stiff = comm.min(solver.blocks()[1].smallestStableStep());
  EXPECT_LT(stiff, 0.01 * soft);
  EXPECT_LE(solver.clock().nextStep, stiff);
  cycles(solver, 200);
  const EnergyBalance energy = solver.energy();
  EXPECT_LT(std::abs(energy.error()), 1e-3 * energy.initial);
}

TEST(Stages, whatHasErodedLeavesWithItsBlock)
{
  const Comm comm;
  const auto eroding = [&]
  {
    Model model = flying(comm);
    model.blocks[1].erosion.volumeRatio = {0, 1.00001};
    return model;
  };
  Solver solver(eroding(), comm);
  solver.prepare();
  cycles(solver, 60);
  EXPECT_EQ(solver.erosion().elements, 2);
  EXPECT_EQ(massOf(solver), 4125); // its nodes fly on
  Stage leaves = stage(comm, {1}, {});
  leaves.model = eroding();
  solver.beginStage(std::move(leaves));
  cycles(solver, 1);
  EXPECT_EQ(massOf(solver), 2125);
  EXPECT_EQ(solver.erosion().elements, 2);
  EXPECT_EQ(solver.erosion().mass, 2000);
  expectClosedBooks(solver);
  solver.beginStage(stage(comm, {}, {1})); // it may come in anew
  cycles(solver, 30);
  EXPECT_GT(massOf(solver), 4000);
  expectClosedBooks(solver);
}

TEST(Stages, thatAreImpossibleLeaveTheSolverWhole)
{
  const Comm comm;
  const auto rigidStone = [&]
  {
    Model model = flying(comm);
    model.blocks[2].rigid = true;
    model.rigidBodyOfNode = rigidBodiesOf(model.mesh, {0, 0, 1}, comm);
    return model;
  };
  Solver solver(rigidStone(), comm);
  solver.prepare();
  cycles(solver, 5);
  const std::uint64_t hash = solver.stateHash();
  const Real kinetic = solver.energy().kinetic;
  const auto refused = [&](const std::string& text, const std::function<void(Stage&)>& change)
  {
    Stage next = stage(comm, {}, {});
    next.model = rigidStone();
    change(next);
    for (const bool begins : {false, true})
      try
      {
        begins ? solver.beginStage(next) : solver.demandPossible(next);
        ADD_FAILURE() << text;
      }
      catch (const Error& error)
      {
        EXPECT_TRUE(error.onAllRanks());
        EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
      }
  };
  refused("nodes of a rigid body",
          [](Stage& next)
          {
            PrescribedVelocity held;
            held.nodes = ownedNodesWhere(next.model.mesh, [](const Vec3& x) { return x.z > 4.25; });
            next.model.conditions.velocities = {held};
          });
  refused("shares nodes with a rigid body", [](Stage& next) { next.remove = {2}; });
  refused("law with other variables",
          [](Stage& next)
          {
            next.model.blocks[0].material =
                makeJ2Plasticity(std::get<LinearElastic>(next.model.blocks[0].material), 1e9, 0);
          });
  EXPECT_EQ(solver.stateHash(), hash);
  EXPECT_EQ(solver.energy().kinetic, kinetic);
  cycles(solver, 1);
}

TEST(Stages, haveTheSameBitsFromAnyStateOnAnyPartition)
{
  const Comm comm;
  for (const bool comes : {false, true})
  {
    const std::vector<int> absent = comes ? std::vector<int>{1} : std::vector<int>{};
    const auto next = [&]
    {
      Stage begins = comes ? stage(comm, {}, {1}, absent) : stage(comm, {1}, {});
      begins.zeroDisplacements = true;
      return begins;
    };
    Solver straight(flying(comm, absent), comm);
    straight.prepare();
    cycles(straight, 20);
    StateTables atBorder(comm), within(comm);
    straight.save(atBorder);
    straight.beginStage(next());
    cycles(straight, 15);
    straight.save(within);
    cycles(straight, 15);
    const EnergyBalance expected = straight.energy();

    for (const char* method : {"rcb", "last", "scattered"})
    {
      Solver border(flying(comm, absent, method), comm);
      border.restore(atBorder);
      EXPECT_EQ(border.stage().index, 0);
      border.beginStage(next());
      cycles(border, 30);
      Solver middle(flying(comm, absent, method), comm);
      middle.restore(within);
      EXPECT_EQ(middle.stage().index, 1);
      EXPECT_EQ(Solver::stageIn(within).begin, straight.stage().begin);
      cycles(middle, 5);
      middle.repartition(flying(comm, absent, "rib"));
      cycles(middle, 10);
      for (const Solver* solver : {&border, &middle})
      {
        EXPECT_EQ(solver->stateHash(), straight.stateHash()) << method;
        const EnergyBalance energy = solver->energy();
        EXPECT_EQ(std::memcmp(&energy, &expected, sizeof energy), 0) << method;
      }
    }
  }
}

TEST(Stages, countDisplacementsAnew)
{
  const Comm comm;
  Solver solver(flying(comm), comm);
  solver.prepare();
  cycles(solver, 10);
  Stage next = stage(comm, {}, {});
  next.zeroDisplacements = true;
  solver.beginStage(std::move(next));
  for (int n = 0; n < solver.layout().owned(); ++n)
    EXPECT_EQ(norm(at(solver.state().x, n) - at(solver.state().reference, n)), 0);
}

TEST(Stages, followEachOtherUntilTheLast)
{
  const Comm comm;
  Model model = flying(comm);
  model.time.end = 1e-3;
  Solver solver(std::move(model), comm);
  solver.prepare();
  Recorder recorder;
  int asked = 0;
  const ExitCode code = solver.run(recorder, nullptr,
                                   [&](const Solver& at) -> std::optional<Stage>
                                   {
                                     EXPECT_EQ(at.clock().cycle, 10 * ++asked);
                                     if (asked == 3)
                                       return std::nullopt;
                                     Stage next = stage(comm, {}, {});
                                     next.index = asked;
                                     next.model.time.end = (asked + 1) * 1e-3;
                                     return next;
                                   });
  EXPECT_EQ(code, ExitCode::Success);
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(solver.stage().index, 2);
  EXPECT_EQ(recorder.ends, 30);
}
} // namespace coplane
