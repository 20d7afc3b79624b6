#include "Rig.hpp"

#include <coplane_core/ExactSum.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace coplane
{
namespace
{
/// A column of eight cubes of 1 m of rock (P-wave modulus 1.2 GPa), held at its foot and sideways,
/// with its weight at 10 m/s^2.
Model column(const Comm& comm)
{
  Model model = rockModel(unitBox(1, 1, 8), comm);
  model.contactEnabled = false;
  model.viscosity = {0, 0};
  model.conditions.gravity = VectorOfTime(0, 0, -10);
  PrescribedVelocity sides, foot;
  sides.nodes = ownedNodesWhere(model.mesh, [](const Vec3&) { return true; });
  sides.components = {true, true, false};
  foot.nodes = ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.z == 0; });
  model.conditions.velocities = {sides, foot};
  model.time.fixedStep = 4e-4;
  return model;
}

/// Mean displacement along z of the nodes at a height at first [m].
Real sinking(const Solver& solver, Real height)
{
  std::vector<ExactSum> sums(2);
  for (int n = 0; n < solver.layout().owned(); ++n)
    if (solver.state().reference(n, 2) == height)
    {
      sums[0].add(solver.state().x(n, 2) - height);
      sums[1].add(1);
    }
  const std::vector<Real> totals = ExactSum::overRanks(sums, solver.comm());
  return totals[0] / totals[1];
}

/// Until damping has ended; fails after 20000 cycles.
void relax(Solver& solver)
{
  solver.prepare();
  for (int i = 0; i < 20000 && !solver.relaxation().ended; ++i)
    solver.advance();
  ASSERT_TRUE(solver.relaxation().ended);
}

/// u(z) = -rho g (H z - z^2 / 2) / M, exact at the nodes; strains are up to 7e-5, and the column
/// is no longer what it was by that.
void expectStaticColumn(const Solver& solver)
{
  for (const Real z : {2.0, 5.0, 8.0})
  {
    const Real exact = -1000 * 10 * (8 * z - z * z / 2) / 1.2e9;
    EXPECT_NEAR(sinking(solver, z), exact, 1e-4 * std::abs(exact)) << "at " << z << " m";
  }
}

/// Without damping nothing moves any more, and the books are still closed.
void expectRest(Solver& solver, Real kinetic)
{
  cycles(solver, 300);
  const EnergyBalance energy = solver.energy();
  EXPECT_LT(std::abs(energy.kinetic), kinetic * energy.internal);
  EXPECT_LT(std::abs(energy.error()), 1e-3 * energy.internal);
  EXPECT_NEAR(energy.kinetic - energy.initial, energy.nodalWork, 1e-12 * energy.scale());
  const Momenta momenta = solver.momenta();
  // of the weight that gravity gave in all the time
  const Real scale = 8000 * 10 * solver.clock().time;
  EXPECT_LT(norm(momenta.linearError()), 1e-12 * scale);
  EXPECT_LT(norm(momenta.angularError()), 1e-11 * scale);
}

Model columnWithStops(const Comm& comm)
{
  Model model = column(comm);
  model.conditions.relaxation = {true, 1e-10, 1e-6};
  return model;
}
} // namespace

TEST(Relaxation, stopsAtPeaksOfTheKineticEnergyFindTheColumnUnderItsWeight)
{
  const Comm comm;
  Solver solver(columnWithStops(comm), comm);
  relax(solver);
  EXPECT_GT(solver.relaxation().stops, 3);
  EXPECT_LT(solver.relaxation().stops, 200);
  expectStaticColumn(solver);
  // Half of the work of gravity is stored, the other half was motion. The first energy is not zero,
  // by a term of second order in the step.
  const EnergyBalance energy = solver.energy();
  EXPECT_NEAR(energy.kineticDamping - energy.initial, energy.internal, 1e-3 * energy.internal);
  EXPECT_EQ(energy.localDamping, 0);
  expectRest(solver, 1e-9);
}

TEST(Relaxation, localDampingEndsByTheRatioOfForces)
{
  const Comm comm;
  Model model = column(comm);
  model.conditions.localDamping = 0.8;
  model.conditions.relaxation.forceRatio = 1e-7;
  Solver solver(std::move(model), comm);
  relax(solver);
  expectStaticColumn(solver);
  const EnergyBalance energy = solver.energy();
  EXPECT_NEAR(energy.localDamping - energy.initial, energy.internal, 1e-3 * energy.internal);
  EXPECT_EQ(energy.kineticDamping, 0);
  expectRest(solver, 1e-9);
  EXPECT_EQ(solver.energy().localDamping, energy.localDamping); // it has ended
}

TEST(Relaxation, massDampingEndsByTheRatioOfEnergies)
{
  const Comm comm;
  Model model = column(comm);
  model.conditions.massDamping = [](Real) { return 430.0; }; // twice pi c / (2 H): critical
  model.conditions.relaxation.energyRatio = 1e-12;
  Solver solver(std::move(model), comm);
  relax(solver);
  expectStaticColumn(solver);
  const Real damped = solver.energy().massDamping;
  expectRest(solver, 1e-9);
  EXPECT_EQ(solver.energy().massDamping, damped);
}

TEST(Relaxation, actsInItsWindowOnly)
{
  const Comm comm;
  Model model = columnWithStops(comm);
  model.conditions.relaxation = {true, 0, 0};
  model.conditions.dampingFrom = 0.04;
  model.conditions.dampingUntil = 0.06;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 99); // the column swings once in 29 ms
  EXPECT_EQ(solver.relaxation().stops, 0);
  cycles(solver, 52);
  const std::int64_t stops = solver.relaxation().stops;
  EXPECT_GT(stops, 0);
  cycles(solver, 200);
  EXPECT_EQ(solver.relaxation().stops, stops);
  EXPECT_FALSE(solver.relaxation().ended);
}

TEST(Relaxation, leavesPrescribedMotionAlone)
{
  // The top is drawn at 0.1 m/s by 2 mm and held: the column is stretched uniformly.
  const Comm comm;
  Model model = columnWithStops(comm);
  model.conditions.gravity = {};
  PrescribedVelocity top;
  top.nodes = ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.z == 8; });
  top.components = {false, false, true};
  top.velocity[2] = [](Real t) { return t < 0.02 ? 0.1 : 0; };
  model.conditions.velocities.push_back(top);
  model.conditions.relaxation = {true, 0, 0};
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 1500);
  EXPECT_GT(solver.relaxation().stops, 3);
  EXPECT_NEAR(sinking(solver, 8), 0.002, 1e-12);
  EXPECT_NEAR(sinking(solver, 4), 0.001, 1e-8);
  const EnergyBalance energy = solver.energy();
  EXPECT_NEAR(energy.kinetic - energy.initial, energy.nodalWork, 1e-12 * energy.scale());
  EXPECT_LT(std::abs(energy.error()), 1e-3 * energy.internal);
}

namespace
{
/// A cube that is let go on another one, of rock or rigid.
Model resting(const Comm& comm, bool rigid)
{
  Mesh mesh;
  addBox(mesh, "lower", {2, 2, 2}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "upper", {1, 1, 1}, {0, 0, 1}, {1, 1, 1});
  Model model = rockModel(mesh, comm, 0.5);
  if (rigid)
  {
    model.rigidBodyOfNode = rigidBodiesOf(model.mesh, {0, 1}, comm);
    model.blocks[1].rigid = true;
  }
  model.conditions.gravity = VectorOfTime(0, 0, -10);
  PrescribedVelocity foot;
  foot.nodes = ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.z == 0; });
  model.conditions.velocities = {foot};
  model.conditions.relaxation = {true, 1e-8, 1e-4};
  return model;
}
Model restingRock(const Comm& comm)
{
  return resting(comm, false);
}
Model restingRigid(const Comm& comm)
{
  return resting(comm, true);
}
} // namespace

TEST(Relaxation, aBlockOnAJointPressesWithItsWeight)
{
  const Comm comm;
  for (const auto& scene : {restingRock, restingRigid})
  {
    Solver solver(scene(comm), comm);
    relax(solver);
    cycles(solver, 200);
    // 1000 kg at 10 m/s^2; nothing damps now.
    std::vector<ExactSum> force(1);
    for (int n = 0; n < solver.layout().owned(); ++n)
      if (solver.state().reference(n, 2) >= 1)
        force[0].add(std::max(Real(0), solver.state().contactForce(n, 2)));
    EXPECT_NEAR(ExactSum::overRanks(force, comm)[0], 1e4, 10);
    const EnergyBalance energy = solver.energy();
    EXPECT_LT(std::abs(energy.error()), 2e-3 * energy.scale());
    EXPECT_LT(std::abs(energy.kinetic), 1e-6 * energy.scale());
    const Momenta momenta = solver.momenta();
    EXPECT_LT(norm(momenta.linearError()), 1e-11 * 2e4 * solver.clock().time);
  }
}

TEST(Relaxation, hasTheSameBitsOnAnyRanks)
{
  const Comm world, alone(MPI_COMM_SELF);
  for (const auto& scene : {columnWithStops, restingRock, restingRigid})
  {
    Solver one(scene(alone), alone), many(scene(world), world);
    relax(one);
    relax(many);
    EXPECT_EQ(many.clock().cycle, one.clock().cycle);
    EXPECT_EQ(many.relaxation().stops, one.relaxation().stops);
    EXPECT_EQ(many.relaxation().work, one.relaxation().work);
    EXPECT_EQ(many.stateHash(), one.stateHash());
    EXPECT_EQ(many.energy().error(), one.energy().error());
  }
}
} // namespace coplane
