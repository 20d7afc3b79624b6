#include "Rig.hpp"

#include <coplane_core/ExactSum.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace coplane
{
namespace
{
bool everywhere(const Vec3&)
{
  return true;
}
} // namespace

TEST(PrescribedVelocity, isTheFunctionAtMidStep)
{
  // v_x = 6 t: v(n + 1/2) = 6 (n + 1/2) dt, and x moves by the sum of dt v = 3 (n dt)^2. The step
  // is a power of two, so all of this is exact.
  const Comm comm;
  Model model = rockModel(unitBox(1, 1, 1), comm);
  PrescribedVelocity condition;
  condition.nodes = ownedNodesWhere(model.mesh, everywhere);
  condition.components = {true, false, false};
  condition.velocity[0] = [](Real t) { return 6 * t; };
  model.conditions.velocities = {condition};
  const Real dt = 1.0 / 8192;
  model.time.fixedStep = dt;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 20);
  for (int n = 0; n < solver.layout().owned(); ++n)
  {
    EXPECT_EQ(solver.state().v(n, 0), 6 * 20.5 * dt);
    EXPECT_EQ(solver.state().x(n, 0) - solver.state().reference(n, 0), 3 * 400 * dt * dt);
  }
}

TEST(PrescribedVelocity, withoutAFunctionFixesTheChosenComponentsOnly)
{
  const Comm comm;
  Model model = rockModel(unitBox(1, 1, 1), comm);
  model.blocks[0].velocity = {1, 2, 3};
  PrescribedVelocity condition;
  condition.nodes = ownedNodesWhere(model.mesh, everywhere);
  condition.components = {false, true, false};
  model.conditions.velocities = {condition};
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 10);
  for (int n = 0; n < solver.layout().owned(); ++n)
  {
    EXPECT_EQ(solver.state().x(n, 1), solver.state().reference(n, 1));
    EXPECT_NEAR(solver.state().v(n, 0), 1, 1e-12); // the cube moves as a rigid body: round-off
    EXPECT_NEAR(solver.state().v(n, 2), 3, 1e-12);
  }
}

TEST(PrescribedVelocity, winsOverASymmetryPlane)
{
  Conditions conditions;
  conditions.symmetries = {{{0}, {0.6, 0.8, 0}}};
  PrescribedVelocity condition;
  condition.nodes = {0};
  condition.components = {true, false, false};
  condition.velocity[0] = [](Real) { return 7.0; };
  conditions.velocities = {condition};
  const NodeVectors v("v", 1);
  set(v, 0, {1, 1, 1});
  conditions.prescribeVelocities(0, v);
  EXPECT_EQ(v(0, 0), 7);
}

TEST(Window, isFromItsStartToBeforeItsEndAndKnowsTheRoundingOfSummedSteps)
{
  const Window when{0.1, 0.2};
  EXPECT_FALSE(when.holds(0.0999));
  Real t = 0; // ten steps of 0.01 are 0.09999999999999999
  for (int n = 0; n < 10; ++n)
    t += 0.01;
  EXPECT_LT(t, 0.1);
  EXPECT_TRUE(when.holds(t));
  EXPECT_TRUE(when.holds(0.1999));
  EXPECT_FALSE(when.holds(0.2));
  EXPECT_FALSE(when.overlaps({0.2, infinity}));
  EXPECT_TRUE(when.overlaps({0, 0.15}));
  EXPECT_TRUE(Window{}.holds(0));
  EXPECT_TRUE(Window{}.holds(1e9));
}

TEST(PrescribedVelocity, actsInItsWindowAndLeavesTheVelocityBehind)
{
  // Mid steps (n + 1/2) dt from 4 dt to 12 dt: eight steps of dt at 1 m/s, all of it exact.
  const Comm comm;
  Model model = rockModel(unitBox(1, 1, 1), comm);
  const Real dt = 1.0 / 8192;
  PrescribedVelocity condition;
  condition.nodes = ownedNodesWhere(model.mesh, everywhere);
  condition.velocity[0] = [](Real) { return 1.0; };
  condition.when = {4 * dt, 12 * dt};
  model.conditions.velocities = {condition};
  model.time.fixedStep = dt;
  Solver solver(std::move(model), comm);
  solver.prepare();
  const auto moved = [&](Real distance)
  {
    for (int n = 0; n < solver.layout().owned(); ++n)
      EXPECT_EQ(solver.state().x(n, 0) - solver.state().reference(n, 0), distance);
  };
  cycles(solver, 4);
  moved(0);
  cycles(solver, 8);
  moved(8 * dt);
  EXPECT_EQ(norm(solver.reaction(0)), 0); // of the kick that let go
  cycles(solver, 8);
  moved(16 * dt);
  EXPECT_NEAR(solver.energy().error(), 0, 1e-12 * solver.energy().kinetic);
}

TEST(SymmetryPlane, holdsInItsWindowOnly)
{
  const Comm comm;
  Model model = rockModel(unitBox(1, 1, 1), comm);
  model.blocks[0].velocity = {1, 2, 0};
  const Real dt = 1.0 / 8192;
  const auto all = ownedNodesWhere(model.mesh, everywhere);
  model.conditions.symmetries = {{all, {1, 0, 0}, {4 * dt, infinity}},
                                 {all, {0.6, 0.8, 0}, {8 * dt, infinity}}};
  model.time.fixedStep = dt;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 12);
  // x is free for four steps, y for eight: from then on both planes hold.
  for (int n = 0; n < solver.layout().owned(); ++n)
  {
    EXPECT_EQ(solver.state().x(n, 0) - solver.state().reference(n, 0), 4 * dt);
    EXPECT_NEAR(solver.state().x(n, 1) - solver.state().reference(n, 1), 16 * dt, 1e-15);
  }
}

TEST(SymmetryPlane, atAnAngleKeepsTheNormalVelocityZeroAndDoesNoWork)
{
  // A cube lies on a slope with the normal n and slides down under gravity: all external work is
  // that of gravity, sum m g . u.
  //
  //        n  /\                          .
  //         \/  \  cube
  //        /  \  \                        .
  //       /    \ /
  const Comm comm;
  const Vec3 n{0.6, 0, 0.8}, along{0.8, 0, -0.6};
  Mesh mesh = unitBox(2, 2, 2);
  for (Vec3& x : mesh.coordinates)
    x = x.x * along + x.y * Vec3{0, 1, 0} + x.z * n;
  Model model = rockModel(mesh, comm);
  const std::vector<int> foot =
      ownedNodesWhere(model.mesh, [&](const Vec3& x) { return std::abs(dot(x, n)) < 1e-12; });
  model.conditions.symmetries = {{foot, n}};
  model.conditions.gravity = {0, 0, -10};
  Solver solver(std::move(model), comm);
  solver.prepare();
  for (int i = 0; i < 100; ++i)
  {
    solver.advance();
    for (const int node : foot)
      EXPECT_NEAR(dot(at(solver.state().v, node), n), 0, 1e-15); // of speeds below 1 m/s
  }
  std::vector<ExactSum> ofGravity(1);
  for (int node = 0; node < solver.layout().owned(); ++node)
    ofGravity[0].add(-10 * solver.state().mass(node) *
                     (solver.state().x(node, 2) - solver.state().reference(node, 2)));
  const Real work = ExactSum::overRanks(ofGravity, comm)[0];
  EXPECT_GT(work, 0);
  EXPECT_NEAR(solver.energy().externalWork, work,
              1e-10 * work); // differences of positions near 2 m
}

TEST(SymmetryPlane, pairsAtRightAnglesLeaveTheirCommonNodesOnlyTheCommonLine)
{
  // Planes with the normals x and (0, 0.6, 0.8) meet along (0, 0.8, -0.6), in whose direction
  // (1, 1, 1) has the component 0.2.
  Conditions conditions;
  conditions.symmetries = {{{0}, {1, 0, 0}}, {{0}, {0, 0.6, 0.8}}};
  const NodeVectors v("v", 1);
  set(v, 0, {1, 1, 1});
  conditions.prescribeVelocities(0, v);
  EXPECT_NEAR(v(0, 0), 0, 1e-15);
  EXPECT_NEAR(v(0, 1), 0.16, 1e-15);
  EXPECT_NEAR(v(0, 2), -0.12, 1e-15);
}

TEST(SymmetryPlane, obliquePairsLeaveTheirCommonNodesOnlyTheCommonLine)
{
  // The normals x and (0.6, 0.8, 0) span the x-y plane: of (1, 1, 1) only z is left, in either
  // order.
  const Vec3 x{1, 0, 0}, oblique{0.6, 0.8, 0};
  for (const auto& normals : {std::array<Vec3, 2>{x, oblique}, std::array<Vec3, 2>{oblique, x}})
  {
    Conditions conditions;
    conditions.symmetries = {{{0}, normals[0]}, {{0}, normals[1]}};
    const NodeVectors v("v", 1);
    set(v, 0, {1, 1, 1});
    conditions.prescribeVelocities(0, v);
    EXPECT_NEAR(v(0, 0), 0, 1e-15);
    EXPECT_NEAR(v(0, 1), 0, 1e-15);
    EXPECT_EQ(v(0, 2), 1);
  }
}

TEST(SymmetryPlane, aPlaneGivenTwiceActsOnce)
{
  Conditions conditions;
  conditions.symmetries = {{{0}, {0.6, 0.8, 0}}, {{0}, {0.6, 0.8, 0}}};
  EXPECT_EQ(conditions.projections(0).size(), 1u);
}

TEST(Conditions, constrainedNodesAreSortedAndNamedOnce)
{
  Conditions conditions;
  conditions.symmetries = {{{5, 2}, {1, 0, 0}}};
  PrescribedVelocity fixed;
  fixed.nodes = {9, 2, 0};
  conditions.velocities = {fixed};
  EXPECT_EQ(conditions.constrainedNodes(), (std::vector<int>{0, 2, 5, 9}));
}

TEST(PrescribedVelocity, asDisplacementBringsNodesThereWithoutDrift)
{
  // u = 0.01 sin(50 t) along x, twice that at z = 1: any steps lead to the place of the function.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "cube", {1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  Model model = rockModel(mesh, comm);
  PrescribedVelocity shaken;
  shaken.of = PrescribedVelocity::Of::Displacement;
  shaken.nodes = ownedNodesWhere(model.mesh, [](const Vec3&) { return true; });
  for (const int n : shaken.nodes)
    shaken.places.push_back(model.mesh.coordinates[n]);
  shaken.components = {true, false, false};
  shaken.field[0] = [](Real t, const Vec3& x) { return (1 + x.z) * 0.01 * std::sin(50 * t); };
  model.conditions.velocities = {shaken};
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 100);
  const Real u = 0.01 * std::sin(50 * solver.clock().time);
  ASSERT_GT(std::abs(u), 1e-3);
  for (int n = 0; n < solver.layout().owned(); ++n)
  {
    const Vec3 start = at(solver.state().reference, n);
    EXPECT_NEAR(solver.state().x(n, 0) - start.x, (1 + start.z) * u, 1e-14);
  }
}

TEST(PrescribedVelocity, asAccelerationIsKickedAsByAForce)
{
  // a = 6 t: after n kicks, the first of half a step at t = 0, the velocity has grown by the sum of
  // 6 k dt^2, 3 n (n + 1) dt^2, and x by v0 n dt and the sum of that, dt^3 (n - 1) n (n + 1). All
  // of this is exact for a step that is a power of two. The same for a rigid body.
  for (const bool rigid : {false, true})
  {
    const Comm comm;
    Mesh mesh = unitBox(1, 1, 1);
    Model model = rockModel(mesh, comm);
    model.blocks[0].velocity = {0.5, 0, 0};
    model.blocks[0].rigid = rigid;
    if (rigid)
      model.rigidBodyOfNode = std::vector<int>(std::size_t(model.mesh.nodes()), 0);
    PrescribedVelocity shaken;
    shaken.of = PrescribedVelocity::Of::Acceleration;
    shaken.nodes = ownedNodesWhere(model.mesh, everywhere);
    shaken.components = {true, false, false};
    shaken.velocity[0] = [](Real t) { return 6 * t; };
    model.conditions.velocities = {shaken};
    const Real dt = 1.0 / 8192;
    model.time.fixedStep = dt;
    Solver solver(std::move(model), comm);
    solver.prepare();
    cycles(solver, 20);
    const Real exact = rigid ? 1e-15 : 0; // velocities of its nodes are differences of places
    for (int n = 0; n < solver.layout().owned(); ++n)
    {
      EXPECT_NEAR(solver.state().v(n, 0), 0.5 + 3 * 20 * 21 * dt * dt, 1e4 * exact);
      EXPECT_NEAR(solver.state().x(n, 0) - solver.state().reference(n, 0),
                  0.5 * 20 * dt + 19 * 20 * 21 * dt * dt * dt, exact);
    }
    EXPECT_NEAR(solver.momenta().linear.x, 1000 * (0.5 + 3 * 20 * 21 * dt * dt), 1e-9);
    EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
  }
}

TEST(PrescribedVelocity, asAccelerationOutlivesStopsOfKineticDamping)
{
  // Everything stops at peaks of the kinetic energy, but not what is prescribed: the base of a soft
  // block that swings keeps the velocity of its acceleration.
  const Comm comm;
  Model model = rockModel(unitBox(1, 1, 2), comm);
  model.blocks[0].material = makeLinearElastic(1e5, 0.25, 1000);
  PrescribedVelocity shaken;
  shaken.of = PrescribedVelocity::Of::Acceleration;
  shaken.nodes = ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.z == 0; });
  for (const int n : shaken.nodes)
    shaken.places.push_back(model.mesh.coordinates[n]);
  shaken.field[0] = [](Real, const Vec3& x) { return x.z == 0 ? 1e-3 : 0.0; };
  model.blocks[0].velocityField = [](const Vec3& x) { return Vec3{0, 0, x.z}; };
  model.conditions.velocities = {shaken};
  model.conditions.relaxation.kinetic = true;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 300);
  ASSERT_GT(solver.relaxation().stops, 0);
  const Real middle = solver.clock().time + 0.5 * solver.clock().nextStep;
  for (const int n : shaken.nodes)
    EXPECT_NEAR(solver.state().v(n, 0), 1e-3 * middle, 1e-15);
}

TEST(FacePressure, mayVaryFromFaceToFace)
{
  // p = 1000 z on the side x = 0 of two cubes, one on the other: middles at z = 0.5 and 1.5.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "column", {1, 1, 2}, {0, 0, 0}, {1, 1, 2});
  Model model = rockModel(mesh, comm);
  FacePressure load{sidesWhere(model.mesh, [](const Vec3& x) { return x.x == 0; }), {}, {}};
  for (LoadedSide& side : load.sides)
    for (int k = 0; k < 4; ++k)
      side.place += 0.25 * model.mesh.coordinates[side.nodes[k]];
  load.field = [](Real, const Vec3& x) { return 1000 * x.z; };
  model.conditions.pressures = {load};
  Solver solver(std::move(model), comm);
  solver.prepare();
  EXPECT_NEAR(sumOverRanks(solver.state().external, solver.layout().owned(), comm).x, 2000, 1e-10);
}
} // namespace coplane
