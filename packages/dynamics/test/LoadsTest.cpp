#include "Rig.hpp"

#include <coplane_partition/Partition.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace coplane
{
namespace
{
void expectNear(const Vec3& a, const Vec3& b, Real tolerance)
{
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}
} // namespace

TEST(FacePressure, isPressureTimesAreaAgainstTheOutwardNormalOfATurnedFace)
{
  // The face z = 2 of a 2 x 3 x 2 box (area 6 m^2), turned about y: e_z becomes n.
  const Comm comm;
  const Vec3 n{0.6, 0, 0.8}, t{0.8, 0, -0.6};
  Mesh mesh = unitBox(2, 3, 2);
  for (Vec3& x : mesh.coordinates)
    x = x.x * t + x.y * Vec3{0, 1, 0} + x.z * n;
  const RankMesh part = distribute(mesh, nodeOwners(mesh, comm, "rcb"), comm.rank());
  NodalState state(part);
  Conditions conditions;
  conditions.pressures = {{sidesWhere(part, [&](const Vec3& x) { return dot(x, n) > 1.99; }),
                           [](Real time) { return 100 * time; }}};
  conditions.applyLoads(3, part.ownedNodes, 0.5, 0, state); // 50 Pa at t = 0.5 s
  expectNear(sumOverRanks(state.external, part.ownedNodes, comm), -300.0 * n, 1e-12);
}

TEST(FacePressure, followsTheMotionOfItsFace)
{
  const Comm comm;
  const Mesh mesh = unitBox(2, 3, 2);
  const RankMesh part = distribute(mesh, nodeOwners(mesh, comm, "rcb"), comm.rank());
  NodalState state(part);
  Conditions conditions;
  conditions.pressures = {pressureWhere(part, 50, [](const Vec3& x) { return x.z == 2; })};
  // A quarter turn about y takes z to x, and the body is stretched to twice its length along y.
  for (int i = 0; i < part.nodes(); ++i)
  {
    const Vec3 x = at(state.x, i);
    set(state.x, i, {x.z, 2 * x.y, -x.x});
  }
  conditions.applyLoads(3, part.ownedNodes, 0, 0, state);
  expectNear(sumOverRanks(state.external, part.ownedNodes, comm), {-600, 0, 0}, 1e-12);
}

TEST(FacePressure, onAllSidesOfABodyHasNoResultant)
{
  const Comm comm;
  Mesh mesh = unitBox(2, 3, 2);
  for (Vec3& x : mesh.coordinates) // warps every face
    x = x + 0.1 * Vec3{std::sin(x.y + 2 * x.z), std::sin(x.z), std::sin(3 * x.x)};
  const RankMesh part = distribute(mesh, nodeOwners(mesh, comm, "rcb"), comm.rank());
  NodalState state(part);
  Conditions conditions;
  conditions.pressures = {pressureWhere(part, 50, [](const Vec3&) { return true; })};
  conditions.applyLoads(3, part.ownedNodes, 0, 0, state);
  expectNear(sumOverRanks(state.external, part.ownedNodes, comm), {}, 1e-12);
}

TEST(Loads, actInTheirWindowsOnly)
{
  const Comm comm;
  const Mesh mesh = unitBox(2, 3, 2);
  const RankMesh part = distribute(mesh, nodeOwners(mesh, comm, "rcb"), comm.rank());
  NodalState state(part);
  Conditions conditions;
  const auto top = [](const Vec3& x) { return x.z == 2; };
  conditions.pressures = {pressureWhere(part, 50, top)};
  conditions.pressures[0].when = {1, 2};
  conditions.tractions = {{sidesWhere(part, top), VectorOfTime(7, 0, 0), {}, {2, 3}}};
  for (const auto& [t, force] : {std::pair{0.5, Vec3{}},
                                 {1.0, Vec3{0, 0, -300}},
                                 {1.5, {0, 0, -300}},
                                 {2.0, {42, 0, 0}},
                                 {3.0, {}}})
  {
    conditions.applyLoads(3, part.ownedNodes, t, 0, state);
    expectNear(sumOverRanks(state.external, part.ownedNodes, comm), force, 1e-12);
  }
}

TEST(FacePressure, ofTwoDimensionsActsOnUnitThickness)
{
  // The side x = 3 of a 3 x 2 rectangle is 2 m long.
  const Comm comm;
  Mesh mesh;
  addRectangle(mesh, "plate", {3, 4}, {0, 0, 0}, {3, 2, 0});
  const RankMesh part = distribute(mesh, nodeOwners(mesh, comm, "rcb"), comm.rank());
  NodalState state(part);
  Conditions conditions;
  conditions.pressures = {pressureWhere(part, 50, [](const Vec3& x) { return x.x == 3; })};
  conditions.applyLoads(2, part.ownedNodes, 0, 0, state);
  expectNear(sumOverRanks(state.external, part.ownedNodes, comm), {-100, 0, 0}, 1e-12);
}

TEST(Gravity, freeFallIsExactForCentralDifferences)
{
  // v(n + 1/2) = g (n + 1/2) dt, hence u(n) = g (n dt)^2 / 2 without truncation error. What is left
  // is round-off: positions up to 2 m know 2e-16 m, and 100 cycles add them up.
  const Comm comm;
  Model model = rockModel(unitBox(1, 2, 1), comm);
  model.conditions.gravity = {1, -2, -9.81};
  model.time.fixedStep = 1e-4;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 100);
  const Real t = solver.clock().time;
  EXPECT_NEAR(t, 1e-2, 1e-15);
  for (int n = 0; n < solver.layout().owned(); ++n)
    expectNear(at(solver.state().x, n) - at(solver.state().reference, n),
               (0.5 * t * t) * Vec3{1, -2, -9.81}, 1e-13);
}

TEST(Gravity, freeFallIsExactForStepsThatVaryToo)
{
  const Comm comm;
  Model model = rockModel(unitBox(1, 2, 1), comm);
  model.conditions.gravity = {0, 0, -9.81};
  model.time.stepFactor = 0.5;
  // A hot start: waves shorten the stable step from cycle to cycle, symmetric to the middle.
  model.blocks[0].stress = {-1e5, -1e5, -1e5, 0, 0, 0};
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 100);
  const Momenta momenta = solver.momenta();
  // Velocities are those of half a step later than the positions.
  const Real t = solver.clock().time + 0.5 * solver.clock().nextStep;
  EXPECT_NEAR(momenta.linear.z, -9.81 * 2000 * t, 1e-9 * momenta.magnitude); // 2 m^3 of 1000 kg/m^3
}

TEST(MassDamping, slowsARigidBodyByTheFactorOfCentralDifferences)
{
  // The force at n is -alpha m (v(n-1/2) + v(n+1/2))/2, so each kick of length dt multiplies v by
  // (1 - alpha dt/2) / (1 + alpha dt/2); the first is half a step long.
  const Comm comm;
  Model model = rockModel(unitBox(1, 1, 1), comm);
  const Real alpha = 500, dt = 1e-4;
  model.blocks[0].velocity = {2, 0, 0};
  model.conditions.massDamping = [alpha](Real) { return alpha; };
  model.time.fixedStep = dt;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 10);
  const Real expected = 2 * (1 - alpha * dt / 4) / (1 + alpha * dt / 4) *
                        std::pow((1 - alpha * dt / 2) / (1 + alpha * dt / 2), 10);
  for (int n = 0; n < solver.layout().owned(); ++n)
    EXPECT_NEAR(solver.state().v(n, 0), expected, 1e-12);
}

TEST(MassDamping, endsAtItsTime)
{
  const Comm comm;
  Model model = rockModel(unitBox(1, 1, 1), comm);
  model.blocks[0].velocity = {2, 0, 0};
  model.conditions.massDamping = [](Real) { return 500.0; };
  model.conditions.dampingUntil = 0; // before the start: no damping at all
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 10);
  for (int n = 0; n < solver.layout().owned(); ++n)
    EXPECT_NEAR(solver.state().v(n, 0), 2, 1e-12);
}

TEST(TimeStep, fixedAndLargestStepsOfTheDeckAreKept)
{
  const Comm comm;
  Model model = rockModel(unitBox(1, 1, 1), comm);
  model.time.fixedStep = 1e-5;
  Solver fixed(model, comm);
  fixed.prepare();
  cycles(fixed, 3);
  EXPECT_EQ(fixed.clock().nextStep, 1e-5);
  EXPECT_EQ(fixed.clock().cycle, 3);
  model.time.fixedStep.reset();
  model.time.maximumStep = 2e-5;
  Solver limited(model, comm);
  limited.prepare();
  EXPECT_EQ(limited.clock().nextStep, 2e-5);
}
} // namespace coplane
