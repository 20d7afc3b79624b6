#include "Rig.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace coplane
{
namespace
{
/// A rigid brick of 1 x 2 x 4 m, 8000 kg, at rest; its motion is given.
Model brick(const Comm& comm, RigidMotion motion, Real step)
{
  Mesh mesh;
  addBox(mesh, "brick", {2, 2, 3}, {5, 0, 0}, {1, 2, 4});
  Model model = rockModel(mesh, comm);
  model.rigidBodyOfNode.assign(model.mesh.nodePositions.size(), 0);
  model.blocks[0].rigid = true;
  model.contactEnabled = false;
  motion.block = 0;
  model.conditions.rigidMotions = {std::move(motion)};
  model.time.maximumStep = step;
  return model;
}

constexpr Real inertia[3] = {8000 * 20 / 12.0, 8000 * 17 / 12.0, 8000 * 5 / 12.0};

/// A vector turned by an angle about a unit axis (Rodrigues).
Vec3 turned(const Vec3& r, const Vec3& axis, Real angle)
{
  return std::cos(angle) * r + std::sin(angle) * cross(axis, r) +
         ((1 - std::cos(angle)) * dot(axis, r)) * axis;
}
} // namespace

TEST(RigidMotion, spinAndVelocityBringEveryPointToItsPlaceExactly)
{
  // Spin of 7 rad/s about (2, 3, 6)/7 and 3 m/s along -y, for 1 s.
  const Comm comm;
  RigidMotion motion;
  motion.components = {true, true, true};
  motion.velocity[1] = [](Real) { return -3; };
  motion.spin = VectorOfTime(2, 3, 6);
  Solver solver(brick(comm, motion, 1e-2), comm);
  solver.prepare();
  cycles(solver, 100);
  const Vec3 axis = (1.0 / 7) * Vec3{2, 3, 6};
  for (int n = 0; n < solver.layout().owned(); ++n)
  {
    const Vec3 arm = at(solver.state().reference, n) - Vec3{5.5, 1, 2};
    const Vec3 place = Vec3{5.5, -2, 2} + turned(arm, axis, 7);
    EXPECT_LT(norm(at(solver.state().x, n) - place), 1e-12);
  }
}

TEST(RigidMotion, reactionIsMassTimesAccelerationAndTheGyroscopicMoment)
{
  // v_x = 3 t: force 3 M along x. Steady spin w: moment w x (J w) about the centre, which turns
  // with the body, and no power. Errors are second order in the angle of a step.
  const Comm comm;
  Real error[2];
  for (const int i : {0, 1})
  {
    RigidMotion motion;
    motion.components = {true, true, true};
    motion.velocity[0] = [](Real t) { return 3 * t; };
    motion.spin = VectorOfTime(2, 3, 6);
    Solver solver(brick(comm, motion, i == 0 ? 2e-3 : 1e-3), comm);
    solver.prepare();
    const EnergyBalance start = solver.energy();
    error[i] = 0;
    for (int cycle = 0; cycle < (i == 0 ? 250 : 500); ++cycle)
    {
      solver.advance();
      const RigidBodies::BodyMotion now = solver.rigidBodies().motion(0);
      EXPECT_NEAR(now.force.x, 3 * 8000, 1e-7);
      EXPECT_NEAR(now.force.y, 0, 1e-9);
      // In axes of the body w stays what it is.
      const Vec3 w{2, 3, 6}, axis = (1.0 / 7) * w;
      const Vec3 momentum{inertia[0] * w.x, inertia[1] * w.y, inertia[2] * w.z};
      const Vec3 exact = turned(cross(w, momentum), axis, 7 * solver.clock().time);
      error[i] = std::max(error[i], norm(now.moment - exact) / norm(exact));
    }
    const EnergyBalance energy = solver.energy();
    const Real speed = 3 * solver.clock().time;
    EXPECT_NEAR(energy.kinetic - start.kinetic, 0.5 * 8000 * speed * speed, 2e-3 * energy.kinetic);
    EXPECT_LT(std::abs(energy.error()), 1e-4 * energy.kinetic);
    const Momenta momenta = solver.momenta();
    EXPECT_LT(norm(momenta.linearError()), 1e-12 * momenta.magnitude);
    EXPECT_LT(norm(momenta.angularError()), 1e-11 * norm(momenta.angular));
  }
  EXPECT_LT(error[0], 1e-3);
  EXPECT_NEAR(error[0] / error[1], 4, 0.5);
}

TEST(RigidMotion, spinThatGrowsTakesTheMomentOfItsInertia)
{
  // w_z = 4 t about a principal axis: moment J_zz 4; angle 2 t^2.
  const Comm comm;
  RigidMotion motion;
  motion.spin = VectorOfTime({OfTime{}, OfTime{}, [](Real t) { return 4 * t; }});
  Solver solver(brick(comm, motion, 1e-3), comm);
  solver.prepare();
  cycles(solver, 500);
  const RigidBodies::BodyMotion now = solver.rigidBodies().motion(0);
  EXPECT_NEAR(now.moment.z, 4 * inertia[2], 1e-4 * inertia[2]);
  EXPECT_LT(norm(now.force), 1e-12);
  EXPECT_NEAR(now.spin.z, 2, 1e-5);
  for (int n = 0; n < solver.layout().owned(); ++n)
  {
    const Vec3 arm = at(solver.state().reference, n) - Vec3{5.5, 1, 2};
    EXPECT_LT(norm(at(solver.state().x, n) - Vec3{5.5, 1, 2} - turned(arm, {0, 0, 1}, 0.5)), 1e-6);
  }
}

TEST(RigidMotion, axesThatAreNotGivenAreFree)
{
  // Held along z against gravity; falls along y, turns on freely.
  const Comm comm;
  RigidMotion motion;
  motion.components = {false, false, true};
  Model model = brick(comm, motion, 1e-3);
  model.conditions.gravity = VectorOfTime(0, -10, -10);
  model.blocks[0].angularVelocity = {0, 0, 2};
  model.blocks[0].center = {5.5, 1, 2};
  model.time.fixedStep = 1e-3;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 100);
  const RigidBodies::BodyMotion now = solver.rigidBodies().motion(0);
  EXPECT_EQ(now.displacement.z, 0);
  EXPECT_NEAR(now.displacement.y, -0.05, 1e-12);
  EXPECT_NEAR(now.force.z, 8e4, 1e-7);
  EXPECT_NEAR(now.force.y, 0, 1e-12);
  EXPECT_NEAR(now.spin.z, 2, 1e-6);
  EXPECT_NEAR(norm(now.moment), 0, 1e-6);
}

TEST(RigidMotion, ofABodyOnASymmetryPlaneIsRefused)
{
  const Comm comm;
  RigidMotion motion;
  motion.spin = VectorOfTime(0, 0, 1);
  Model model = brick(comm, motion, 1e-3);
  model.conditions.symmetries = {
      {ownedNodesWhere(model.mesh, [](const Vec3&) { return true; }), {1, 0, 0}}};
  try
  {
    Solver solver(std::move(model), comm);
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_TRUE(error.onAllRanks());
    EXPECT_EQ(std::string(error.what()),
              "conditions: the rigid body with its centre at (5.5, 1, 2) m has a given "
              "rigid_motion and another condition on its motion; accepted: one of them. Take its "
              "nodes out of the node set, or leave out rigid_motion.");
  }
}

TEST(RigidMotion, ofMoreThanOneRadianInAStepIsRefused)
{
  const Comm comm;
  RigidMotion motion;
  motion.spin = VectorOfTime(0, 0, 200);
  Solver solver(brick(comm, motion, 1e-2), comm);
  EXPECT_THROW(solver.prepare(), Error);
}
} // namespace coplane
