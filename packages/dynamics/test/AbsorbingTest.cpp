#include "Rig.hpp"

#include <coplane_dynamics/Dashpots.hpp>
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

/// Absorbing sides with the impedances of the rock of the rig.
AbsorbingBoundary absorbingWhere(const RankMesh& mesh, const SymTensor& stress,
                                 const std::function<bool(const Vec3&)>& chosen)
{
  const Material rock = makeLinearElastic(1e9, 0.25, 1000);
  AbsorbingBoundary boundary;
  for (const LoadedSide& side : sidesWhere(mesh, chosen))
    boundary.sides.push_back({side,
                              std::sqrt(1000 * pWaveModulus(rock)),
                              std::sqrt(1000 * elasticity(rock).shearModulus),
                              {stress, stress, stress, stress}});
  return boundary;
}

Mesh warpedBox()
{
  Mesh mesh = unitBox(2, 3, 2);
  for (Vec3& x : mesh.coordinates)
    x = x + 0.1 * Vec3{std::sin(x.y + 2 * x.z), std::sin(x.z), std::sin(3 * x.x)};
  return mesh;
}
} // namespace

TEST(CornerAreas, ofAWarpedFaceAddUpToItsVectorArea)
{
  const Vec3 corners[] = {{0, 0, 0.1}, {2, 0.1, 0}, {1.7, 1, 0.3}, {-0.2, 1.2, -0.1}};
  const auto areas = cornerAreas(3, corners, 4);
  expectNear(areas[0] + areas[1] + areas[2] + areas[3], vectorArea<3>(corners, 4), 1e-15);
  // A trapezium, 3 wide at the foot and 1 at the top, is 3 - 2s wide at the height s. Its two lower
  // corners have the integral of (1 - s)(3 - 2s) = 7/6, the upper ones that of s (3 - 2s) = 5/6.
  const Vec3 trapezium[] = {{0, 0, 0}, {3, 0, 0}, {2, 1, 0}, {1, 1, 0}};
  const auto shares = cornerAreas(3, trapezium, 4);
  EXPECT_NEAR(shares[0].z, 7.0 / 12, 1e-15);
  EXPECT_NEAR(shares[1].z, 7.0 / 12, 1e-15);
  EXPECT_NEAR(shares[2].z, 5.0 / 12, 1e-15);
  EXPECT_NEAR(shares[3].z, 5.0 / 12, 1e-15);
}

TEST(AbsorbingSides, holdABodyOfAnyShapeUnderInitialStressAtRest)
{
  const Comm comm;
  Model model = rockModel(warpedBox(), comm);
  const SymTensor stress{-3e6, -2e6, -1e6, 0.5e6, 0.3e6, -0.2e6};
  model.blocks[0].stress = stress;
  model.conditions.absorbing = {
      absorbingWhere(model.mesh, stress, [](const Vec3&) { return true; })};
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 50);
  // Forces of 1e6 N in balance to round-off on nodes of 100 kg, with steps of 1e-4 s.
  EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), 1e-12);
}

TEST(AbsorbingSides, stopARigidBodyByTheirImpedance)
{
  // A cube of 1000 kg, soft against nothing: one cycle changes the momentum by z A (v + v')/2 dt,
  // with z = rho c_d on the face across the motion and rho c_s on one along it.
  const Comm comm;
  const Real zn = std::sqrt(1000 * 1.2e9), zs = std::sqrt(1000 * 0.4e9);
  Model model = rockModel(unitBox(1, 1, 1), comm);
  model.blocks[0].velocity = {0, 0, 2};
  model.conditions.absorbing = {
      absorbingWhere(model.mesh, {}, [](const Vec3& x) { return x.z == 0; }),
      absorbingWhere(model.mesh, {}, [](const Vec3& x) { return x.x == 0; })};
  model.time.fixedStep = 1e-6;
  Solver solver(std::move(model), comm);
  solver.prepare();
  const Momenta first = solver.momenta();
  // Half a kick; the body has not deformed by more than 1e-6 of it.
  EXPECT_NEAR(first.impulse.z, -(zn + zs) * 2 * 0.5e-6, 1e-3 * (zn + zs) * 1e-6);
  cycles(solver, 10);
  EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
}

TEST(AbsorbingSides, carryWhatASupportHasCarriedBeforeThem)
{
  // A column under gravity in balance with its weight, on a base that is held until 0.01 s, a time
  // between two steps, and absorbs from then on. It has neither the weight nor a stress in its
  // sides: they go on with the reactions. Held by components, or by rollers.
  for (const bool rollers : {false, true})
  {
    const Comm comm;
    Model model = rockModel(unitBox(1, 1, 3), comm);
    const auto base = [](const Vec3& x) { return x.z == 0; };
    model.conditions.gravity = {0, 0, -10};
    model.blocks[0].stressGradient = {{0, 0, 1e4, 0, 0, 0}, {0, 0, 3}, {0, 0, 1}};
    const std::vector<int> nodes = ownedNodesWhere(model.mesh, base);
    if (rollers)
      model.conditions.symmetries = {{nodes, {0, 0, 1}, {0, 0.01}}};
    else
    {
      PrescribedVelocity fixed;
      fixed.nodes = nodes;
      fixed.when.until = 0.01;
      model.conditions.velocities = {fixed};
    }
    model.conditions.absorbing = {absorbingWhere(model.mesh, {}, base)};
    model.conditions.absorbing[0].when.from = 0.01;
    Solver solver(std::move(model), comm);
    solver.prepare();
    while (solver.clock().time < 0.05)
      solver.advance();
    EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), 1e-12);
    EXPECT_LT(norm(solver.momenta().linearError()), 1e-10);
  }
}

TEST(AbsorbingSides, thatCarryASupportStillLetWavesOut)
{
  // The same column, given a push along when the base is held no more: it loses it by dashpots
  // alone, z A v, and stays where it then is.
  const Comm comm;
  Model model = rockModel(unitBox(1, 1, 1), comm);
  const auto base = [](const Vec3& x) { return x.z == 0; };
  model.conditions.gravity = {0, 0, -10};
  PrescribedVelocity fixed;
  fixed.nodes = ownedNodesWhere(model.mesh, base);
  fixed.when.until = 0.5;
  model.conditions.velocities = {fixed};
  model.conditions.localDamping = 0.8;
  model.conditions.dampingUntil = 0.5;
  model.conditions.absorbing = {absorbingWhere(model.mesh, {}, base)};
  model.conditions.absorbing[0].when.from = 0.5;
  model.conditions.absorbing[0].incident =
      VectorOfTime({OfTime(), OfTime(), [](Real t) { return t > 0.6 && t < 0.65 ? 0.02 : 0; }});
  Solver solver(std::move(model), comm);
  solver.prepare();
  while (solver.clock().time < 0.9)
    solver.advance();
  EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), 1e-9);
  Real rise = 0;
  for (const int n : ownedNodesWhere(solver.mesh(), [](const Vec3&) { return true; }))
    rise = std::max(rise, solver.state().x(n, 2) - solver.state().reference(n, 2));
  EXPECT_NEAR(comm.max(rise), 2 * 0.02 * 0.05, 2e-5);
}

TEST(AbsorbingSides, doNotShortenTheStepHoweverStiffTheyAre)
{
  // With twenty times the impedance of the rock dt C / m is above 20; a force from the old velocity
  // would be unstable from 2 on. The step is that of the free body, and energy only leaves.
  const Comm comm;
  Model model = rockModel(unitBox(2, 2, 2), comm);
  model.blocks[0].velocityField = [](const Vec3& x) { return x.z * Vec3{1, 2, -3}; };
  model.time.stepFactor = 0.95;
  Solver without(model, comm);
  without.prepare();
  AbsorbingBoundary boundary =
      absorbingWhere(model.mesh, {}, [](const Vec3& x) { return x.z == 0; });
  for (AbsorbingSide& side : boundary.sides)
    side.normalImpedance = side.shearImpedance = 2.2e7;
  model.conditions.absorbing = {boundary};
  Solver solver(std::move(model), comm);
  solver.prepare();
  EXPECT_EQ(solver.clock().nextStep, without.clock().nextStep);
  const Real first = solver.energy().total();
  Real work = 0;
  for (int i = 0; i < 30; ++i)
  {
    cycles(solver, 10);
    const EnergyBalance balance = solver.energy();
    EXPECT_LT(balance.kinetic, first);
    EXPECT_LT(balance.externalWork, work);
    EXPECT_NEAR(balance.error(), 0, 1e-2 * balance.scale());
    work = balance.externalWork;
  }
}

TEST(AbsorbingSides, withAnIncidentWaveCarryAFreeBodyAlong)
{
  // The wave with the velocity v_in pushes with 2 z v_in - z v: a free light body ends at 2 v_in,
  // like the free end of a bar.
  const Comm comm;
  Model model = rockModel(unitBox(1, 1, 1), comm);
  model.conditions.absorbing = {
      absorbingWhere(model.mesh, {}, [](const Vec3& x) { return x.z == 0; })};
  model.conditions.absorbing[0].incident = {0.25, 0, 0.5};
  Solver solver(std::move(model), comm);
  solver.prepare();
  while (solver.clock().time < 0.05) // 1000 kg over z A = 1.1e6 N s/m, 0.6e6 along: 1.6 ms
    solver.advance();
  const Vec3 velocity = (1 / 1000.0) * solver.momenta().linear;
  EXPECT_NEAR(velocity.z, 1, 1e-6);
  EXPECT_NEAR(solver.energy().error(), 0, 1e-2 * solver.energy().scale());
}

TEST(FaceTraction, keepsItsDirectionWhenTheFaceTurns)
{
  const Comm comm;
  const Mesh mesh = unitBox(2, 3, 2);
  const RankMesh part = distribute(mesh, nodeOwners(mesh, comm, "rcb"), comm.rank());
  NodalState state(part);
  Conditions conditions;
  conditions.tractions = {
      {sidesWhere(part, [](const Vec3& x) { return x.z == 2; }), VectorOfTime(10, 20, -30)}};
  conditions.applyLoads(3, part.ownedNodes, 0, 0, state);
  expectNear(sumOverRanks(state.external, part.ownedNodes, comm), {60, 120, -180}, 1e-12);
  // A quarter turn about y, and twice the length along y: twice the area, the same direction.
  for (int i = 0; i < part.nodes(); ++i)
  {
    const Vec3 x = at(state.x, i);
    set(state.x, i, {x.z, 2 * x.y, -x.x});
  }
  conditions.applyLoads(3, part.ownedNodes, 0, 0, state);
  expectNear(sumOverRanks(state.external, part.ownedNodes, comm), {120, 240, -360}, 1e-12);
}

TEST(LocalDamping, isAFractionOfTheForceOutOfBalanceAgainstTheMotion)
{
  // A free cube under gravity that rises: all of m g is out of balance. While it rises, damping
  // pulls it down with 0.3 m g; when it falls, damping carries 0.3 of it.
  const Comm comm;
  Model model = rockModel(unitBox(1, 1, 1), comm);
  model.blocks[0].velocity = {0, 0, 0.01};
  model.conditions.gravity = {0, 0, -10};
  model.conditions.localDamping = 0.3;
  model.time.fixedStep = 1e-5;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 50);
  EXPECT_NEAR(solver.momenta().linear.z / 1000, 0.01 - 13 * 50.5e-5, 1e-10);
  cycles(solver, 100);
  const Real stop = 0.01 / 13; // within a step
  EXPECT_NEAR(solver.momenta().linear.z / 1000, -7 * (150.5e-5 - stop), 2 * 13e-5);
  const EnergyBalance balance = solver.energy();
  EXPECT_GT(balance.localDamping, 0);
  EXPECT_NEAR(balance.error(), 0, 1e-12 * balance.scale());
  EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
}

TEST(LocalDamping, doesNotFeelForcesThatSupportsTakeUp)
{
  // A block slides along a symmetry plane with the normal n, pressed on it by gravity along -n: no
  // force is out of balance along the plane, so nothing may slow it down.
  const Comm comm;
  const Vec3 n{0.6, 0, 0.8}, along{0.8, 0, -0.6};
  Mesh mesh = unitBox(1, 1, 1);
  for (Vec3& x : mesh.coordinates)
    x = x.x * along + x.y * Vec3{0, 1, 0} + x.z * n;
  Model model = rockModel(mesh, comm);
  model.blocks[0].velocity = along;
  model.conditions.symmetries = {
      {ownedNodesWhere(model.mesh, [](const Vec3&) { return true; }), n}};
  model.conditions.gravity = {-6, 0, -8};
  model.conditions.localDamping = 0.8;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 20);
  EXPECT_NEAR(dot(solver.momenta().linear, along) / 1000, 1, 1e-10);
}

TEST(InitialStress, thatGrowsWithDepthCarriesAColumnUnderGravity)
{
  // Two blocks on rollers, each of two elements, with a declared joint between them: sigma_zz = rho
  // g (z - 2). Elements take the stress of their middle, so nodes are in balance exactly.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "lower", {1, 1, 2}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "upper", {1, 1, 2}, {0, 0, 1}, {1, 1, 1});
  Model model = rockModel(mesh, comm, 0.5);
  for (ContactRule& rule : model.contactRules.table)
    rule.declared = true;
  model.conditions.gravity = {0, 0, -10};
  for (BlockSetup& block : model.blocks)
    block.stressGradient = {{0, 0, 1e4, 0, 0, 0}, {0, 0, 2}, {0, 0, 1}};
  model.conditions.symmetries = {
      {ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.z == 0; }), {0, 0, 1}}};
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 200);
  EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), 1e-12);
  EXPECT_EQ(solver.contact().counts().open, 0);
}

TEST(InitialVelocity, mayVaryWithThePlace)
{
  const Comm comm;
  Model model = rockModel(unitBox(2, 1, 1), comm);
  model.blocks[0].velocity = {0, 1, 0};
  model.blocks[0].velocityField = [](const Vec3& x) { return Vec3{x.x, 0, 2 * x.x}; };
  Solver solver(std::move(model), comm);
  for (int n = 0; n < solver.layout().owned(); ++n)
  {
    const Real x = solver.state().x(n, 0);
    EXPECT_EQ(solver.state().v(n, 0), x);
    EXPECT_EQ(solver.state().v(n, 1), 1);
    EXPECT_EQ(solver.state().v(n, 2), 2 * x);
  }
}
} // namespace coplane
