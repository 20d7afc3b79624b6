#include "Rig.hpp"

#include <coplane_core/ExactSum.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
/// The sliding cubes with everything that puts momentum and energy in or takes it out.
Model loadedCubes(const Comm& comm)
{
  Model model = slidingCubes(comm);
  model.conditions.gravity = {1, 2, -10};
  model.conditions.massDamping = [](Real) { return 5.0; };
  model.conditions.pressures = {
      pressureWhere(model.mesh, 1e4, [](const Vec3& x) { return x.z == 2; })};
  PrescribedVelocity foot;
  foot.nodes = ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.z == 0; });
  foot.components = {true, false, true};
  model.conditions.velocities = {foot};
  model.conditions.localDamping = 0.1;
  model.conditions.tractions = {
      {sidesWhere(model.mesh, [](const Vec3& x) { return x.x == 0; }), VectorOfTime(1e4, 0, 2e4)}};
  // Its nodes below are held in x and z.
  AbsorbingBoundary side;
  for (const LoadedSide& face : sidesWhere(model.mesh, [](const Vec3& x) { return x.y == 0; }))
    side.sides.push_back({face, 1.1e6, 6e5, {}});
  model.conditions.absorbing = {side};
  return model;
}
} // namespace

TEST(Energy, workOfAllNodalForcesIsTheGainOfKineticEnergyToRoundOff)
{
  // With a constant step, m v(n-1/2).v(n+1/2) / 2 grows by exactly dt v.(f(n) + f(n+1)) / 2.
  const Comm comm;
  Model model = loadedCubes(comm);
  model.time.fixedStep = 1e-4;
  Solver solver(std::move(model), comm);
  solver.prepare();
  const Real before = solver.energy().kinetic;
  cycles(solver, 100);
  const EnergyBalance after = solver.energy();
  EXPECT_GT(after.contact.friction, 0);
  EXPECT_NEAR(after.kinetic - before, after.nodalWork, 1e-12 * after.scale());
}

TEST(Energy, balanceOfCollidingAndSlidingCubesCloses)
{
  // Truncation of central differences and areas that change at fixed traction are all that is
  // left; both are second order in the step.
  const Comm comm;
  Model model = loadedCubes(comm);
  model.time.stepFactor = 0.25;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 200);
  const EnergyBalance balance = solver.energy();
  EXPECT_GT(balance.contact.friction, 0);
  EXPECT_GT(balance.massDamping, 0);
  EXPECT_NEAR(balance.error(), 0, 1e-3 * balance.scale());
}

TEST(Energy, ofTheStartIsThatOfTheGivenVelocities)
{
  // 1000 kg at |v|^2 = 0.25 + 0.0625 + 1 (m/s)^2; nothing acts before contact, so the mirrored half
  // steps have the same velocity.
  const Comm comm;
  Solver solver(slidingCubes(comm), comm);
  solver.prepare();
  EXPECT_NEAR(solver.energy().kinetic, 500 * 1.3125, 1e-9);
  EXPECT_EQ(solver.energy().error(), 0);
}

TEST(Reactions, areTheImpulsesThatConditionsOnTheMotionGive)
{
  // Weight and reactions are all that acts from outside: in each cycle both together give the
  // change of the impulse, over the time of the kick. The foot goes down along z, and its nodes on
  // a symmetry plane are held along y there; nothing holds them along x.
  const Comm comm;
  Model model = slidingCubes(comm);
  model.conditions.gravity = {1, 2, -10};
  PrescribedVelocity foot;
  foot.nodes = ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.z == 0; });
  foot.components = {false, false, true};
  foot.velocity[2] = [](Real t) { return -20 * t; };
  model.conditions.velocities = {foot};
  model.conditions.symmetries = {
      {ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.y == 0; }), {0, 1, 0}}};
  const Real mass = 2000;
  Solver solver(std::move(model), comm);
  solver.prepare();
  Vec3 largestReaction{};
  for (int cycle = 0; cycle < 50; ++cycle)
  {
    const Vec3 before = solver.momenta().impulse;
    solver.advance();
    const Real kick = 0.5 * (solver.clock().step + solver.clock().nextStep);
    std::vector<ExactSum> sums(3);
    for (int n = 0; n < solver.layout().owned(); ++n)
      for (int c = 0; c < 3; ++c)
        sums[c].add(solver.reaction(n)[c]);
    const std::vector<Real> reaction = ExactSum::overRanks(sums, comm);
    const Vec3 gained = solver.momenta().impulse - before;
    const Vec3 weight{mass, 2 * mass, -10 * mass};
    for (int c = 0; c < 3; ++c)
    {
      EXPECT_NEAR(gained[c], kick * (reaction[c] + weight[c]), 1e-12 * kick * 1e6);
      largestReaction[c] = std::max(largestReaction[c], std::abs(reaction[c]));
    }
  }
  EXPECT_EQ(largestReaction.x, 0);
  EXPECT_GT(largestReaction.y, 1e3);
  EXPECT_GT(largestReaction.z, 1e5);
}

TEST(Momenta, changeByTheImpulsesToRoundOff)
{
  const Comm comm;
  Solver solver(loadedCubes(comm), comm);
  solver.prepare();
  cycles(solver, 200);
  const Momenta momenta = solver.momenta();
  EXPECT_GT(norm(momenta.impulse), 0.1 * momenta.magnitude); // the conditions matter here
  EXPECT_LT(norm(momenta.linearError()), 1e-13 * momenta.magnitude);
  EXPECT_LT(norm(momenta.angularError()), 1e-13 * momenta.magnitude * 2); // arms up to 2 m
}

TEST(Momenta, ofAnIsolatedFrictionalCollisionAreConserved)
{
  const Comm comm;
  Solver solver(slidingCubes(comm), comm);
  solver.prepare();
  cycles(solver, 200);
  const Momenta momenta = solver.momenta();
  EXPECT_GT(solver.energy().contact.friction, 0);
  EXPECT_EQ(norm(momenta.impulse), 0);
  EXPECT_LT(norm(momenta.linearError()), 1e-13 * momenta.magnitude);
  EXPECT_LT(norm(momenta.angularError()), 1e-13 * momenta.magnitude * 2);
}

TEST(Momenta, aSpinningFreeCubeKeepsItsAngularMomentum)
{
  // 100 rad/s about a skew axis through the middle of a unit cube of 1000 kg in 8 elements. The
  // polar inertia of its lumped nodes at -1/2, 0, 1/2 with masses 1:2:1 per axis is m/8 per
  // direction, m/4 = 250 kg m^2 about every axis.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "cube", {2, 2, 2}, {-0.5, -0.5, -0.5}, {1, 1, 1});
  Model model = rockModel(mesh, comm);
  const Vec3 spin{20, 40, 80};
  model.blocks[0].angularVelocity = spin;
  Solver solver(std::move(model), comm);
  solver.prepare();
  const Momenta start = solver.momenta();
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(start.initialAngular[c], 250 * spin[c], 1e-9);
  cycles(solver, 1000); // about 4 turns
  const Momenta end = solver.momenta();
  EXPECT_LT(norm(end.angularError()), 1e-12 * norm(end.initialAngular));
  EXPECT_LT(norm(end.linear), 1e-12 * end.magnitude);
}
} // namespace coplane
