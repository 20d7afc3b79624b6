#include "Rig.hpp"

#include <coplane_core/ExactSum.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
/// Two rows of n unit cubes along x with a gap between; they meet with +-speed.
Model rows(const Comm& comm, Real gap, Real speed, int n = 10)
{
  Mesh mesh;
  addBox(mesh, "left", {n, 1, 1}, {-n - gap, 0, 0}, {Real(n), 1, 1});
  addBox(mesh, "right", {n, 1, 1}, {0, 0, 0}, {Real(n), 1, 1});
  Model model = rockModel(mesh, comm);
  model.blocks[0].velocity = {speed, 0, 0};
  model.blocks[1].velocity = {-speed, 0, 0};
  model.time.energyTolerance = infinity;
  return model;
}

/// A joint that is much stiffer than the elements, M/h = 1.2e9 Pa/m.
void makeStiff(Model& model, Real stiffness)
{
  JointLaw& law = model.contactRules.joints[0].law;
  law.penalty = false;
  law.initialStiffness = stiffness;
}

Real firstStep(Model model, const Comm& comm)
{
  Solver solver(std::move(model), comm);
  solver.prepare();
  return solver.clock().nextStep;
}

struct StableStep : WithForces
{
};
INSTANTIATE_TEST_SUITE_P(, StableStep, WithForces::both(), WithForces::name);
} // namespace

TEST(StepGrowth, fallsAtOnceAndRisesLateAndSlowly)
{
  StepGrowth growth;
  EXPECT_EQ(growth.next(4, 0), 4); // the first step
  EXPECT_EQ(growth.next(1, 4), 1);
  for (int cycle = 0; cycle < StepGrowth::patience; ++cycle)
    EXPECT_EQ(growth.next(4, 1), 1) << cycle;
  EXPECT_EQ(growth.next(4, 1), StepGrowth::perCycle);
  EXPECT_EQ(growth.next(1.01, 1), 1); // not for so little, and then it waits anew
  EXPECT_EQ(growth.next(.5, 1), .5);
  EXPECT_EQ(growth.next(4, .5), .5);
}

TEST(StepGrowth, isNotMovedByPlanesThatChatter)
{
  // Open for ten cycles, closed for ten, as often as you like: one step.
  StepGrowth growth;
  Real step = growth.next(1, 0);
  for (int cycle = 0; cycle < 1000; ++cycle)
  {
    step = growth.next(cycle % 20 < 10 ? 4 : 1, step);
    ASSERT_EQ(step, 1) << cycle;
  }
}

TEST_P(StableStep, looksAheadInTheFirstCycle)
{
  // The gap closes in a hundredth of the first step: that step has to be short enough for the joint
  // already. A gap of many steps does not count.
  const Comm comm;
  Model closing = rows(comm, 1e-6, .1), touching = rows(comm, 0, .1), apart = rows(comm, .09, .1);
  for (Model* model : {&closing, &touching, &apart})
    makeStiff(*model, 1e12);
  const Real step = firstStep(std::move(closing), comm), free = firstStep(std::move(apart), comm);
  EXPECT_NEAR(step / firstStep(std::move(touching), comm), 1, 1e-6);
  EXPECT_LT(step, .05 * free);
}

TEST_P(StableStep, stiffJointsMakeNoEnergy)
{
  // Joints 17 and 170 times as stiff as two elements, and a gap that closes within a step. With a
  // look-ahead by the last step this gave many times the energy of the impact.
  const Comm comm;
  for (const Real stiffness : {1e10, 1e11})
    for (const Real gap : {0.0, 1e-6})
    {
      Model model = rows(comm, gap, .1, 20);
      makeStiff(model, stiffness);
      Solver solver(std::move(model), comm);
      solver.prepare();
      const Real start = solver.energy().kinetic;
      while (solver.clock().time < .1) // five times through a row
      {
        cycles(solver, 20);
        ASSERT_LT(std::abs(solver.energy().error()), 3e-3 * start) << stiffness << ", " << gap;
      }
      // Each bounce of an end node, 1.3 % of all energy, loses or makes some of that.
      EXPECT_LT(std::abs(solver.energy().contact.remainder()), 1e-2 * start)
          << stiffness << ", " << gap;
    }
}

TEST_P(StableStep, isConstantWhileBodiesChatterOnTheirContact)
{
  // Two rows that touch, held at their far ends, in free vibration: contact opens and closes many
  // times. With a constant step the work of all nodal forces is the change of the kinetic energy to
  // rounding.
  const Comm comm;
  Model model = rows(comm, 0, 0);
  model.viscosity = {0, 0};
  PrescribedVelocity ends;
  ends.nodes =
      ownedNodesWhere(model.mesh, [](const Vec3& x) { return std::abs(std::abs(x.x) - 10) < .1; });
  ends.components = {true, false, false};
  model.conditions.velocities = {ends};
  for (int b = 0; b < 2; ++b)
    model.blocks[b].velocityField = [b](const Vec3& x) {
      return Vec3{(b == 0 ? 1e-4 : -1e-4) * (10 - std::abs(x.x)), 0, 0};
    };
  Solver solver(std::move(model), comm);
  solver.prepare();
  const Real start = solver.energy().kinetic, step = solver.clock().nextStep;
  std::int64_t changes = 0, open = 0, closed = 0;
  for (int cycle = 0; cycle < 600; ++cycle)
  {
    solver.advance();
    changes += std::abs(solver.clock().nextStep / step - 1) > 1e-3;
    const ContactCounts counts = solver.contact().counts();
    (counts.stick + counts.slip > 0 ? closed : open) += 1;
  }
  EXPECT_GT(open, 30);
  EXPECT_GT(closed, 30);
  EXPECT_EQ(changes, 0);
  const EnergyBalance energy = solver.energy();
  EXPECT_LT(std::abs(energy.kinetic - start - energy.nodalWork), 1e-6 * start);
}

TEST_P(StableStep, contactDampingCountsWhereThereIsContact)
{
  const Comm comm;
  for (const Real gap : {.09, 0.0})
  {
    Model plain = rows(comm, gap, 0), damped = rows(comm, gap, 0);
    damped.contact.dampNormal = 1;
    const Real ratio = firstStep(std::move(damped), comm) / firstStep(std::move(plain), comm);
    if (gap > 0)
      EXPECT_EQ(ratio, 1);
    else
      EXPECT_LT(ratio, .6);
  }
}

TEST_P(StableStep, isBoundByTheMotionOfFaces)
{
  // At v / c = 3 a step by the elements alone would carry the rows through each other.
  const Comm comm;
  Model model = rows(comm, .09, 1.5 * 1095);
  Solver solver(std::move(model), comm);
  solver.prepare();
  EXPECT_TRUE(solver.stepControl().motion);
  EXPECT_LE(solver.clock().nextStep * 3 * 1095, .2 * (1 + 1e-12));
  EXPECT_NE(solver.stepControl().text().find("the motion of faces"), std::string::npos);
}

TEST_P(StableStep, fastBodiesCatchEachOther)
{
  // Centre of mass at rest: each row gives its momentum to the other, or the run ends because
  // elements are crushed; passing through leaves the momenta as they are.
  const Comm comm;
  for (const Real mach : {.15, .65})
  {
    Model model = rows(comm, .09, mach * 1095);
    Solver solver(std::move(model), comm);
    solver.prepare();
    const Real weight = 10 * 1000; // of a row
    const Real before = weight * mach * 1095;
    Real left = before;
    for (int cycle = 0; cycle < 4000 && left > 0; ++cycle)
    {
      solver.advance();
      std::vector<ExactSum> mine(1);
      for (int n = 0; n < solver.layout().owned(); ++n)
        if (solver.state().reference(n, 0) < -.05)
          mine[0].add(solver.state().mass(n) * solver.state().v(n, 0));
      left = ExactSum::overRanks(mine, comm)[0];
    }
    EXPECT_LE(left, 0) << mach;
    EXPECT_EQ(solver.contact().counts().missed, 0) << mach;
  }
}
} // namespace coplane
