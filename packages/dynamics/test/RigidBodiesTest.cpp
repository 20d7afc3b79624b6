#include "Rig.hpp"

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
void makeRigid(Model& model, const Comm& comm, const std::vector<char>& rigid)
{
  model.rigidBodyOfNode = rigidBodiesOf(model.mesh, rigid, comm);
  for (std::size_t b = 0; b < rigid.size(); ++b)
    model.blocks[b].rigid = rigid[b];
}

/// A brick of 1 x 2 x 4 m in free flight, turning about an axis that is none of its own.
Mesh brick()
{
  Mesh mesh;
  addBox(mesh, "brick", {2, 2, 3}, {5, 0, 0}, {1, 2, 4});
  return mesh;
}

Model tumbling(const Comm& comm, Real step)
{
  const Mesh mesh = brick();
  Model model = rockModel(mesh, comm);
  makeRigid(model, comm, {1});
  model.blocks[0].velocity = {3, -2, 1};
  model.blocks[0].angularVelocity = {4, 7, 2};
  model.blocks[0].center = {5.5, 1, 2};
  model.time.fixedStep = step;
  return model;
}

/// A rigid cube that falls on a deformable one, or on a rigid one, and slides over it.
Model falling(const Comm& comm, bool bothRigid)
{
  const Mesh mesh = twoCubes();
  Model model = rockModel(mesh, comm, 0.25);
  makeRigid(model, comm, {char(bothRigid), 1});
  model.blocks[1].velocity = {0.5, 0.25, -1};
  model.blocks[1].angularVelocity = {0.1, 0.2, 0.3};
  model.blocks[1].center = {0.625, 0.5625, 1.5};
  model.time.stepFactor = 0.2;
  model.time.maximumStep = 5e-4; // nothing else limits it after two rigid bodies have parted
  return model;
}

Model fallingOnRigid(const Comm& comm)
{
  return falling(comm, true);
}
Model fallingOnRock(const Comm& comm)
{
  return falling(comm, false);
}
} // namespace

TEST(RigidBodies, connectedPartsOfRigidBlocksAreBodies)
{
  Mesh mesh;
  addBox(mesh, "soft", {1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "bricks", {1, 1, 1}, {2, 0, 0}, {1, 1, 1});
  addBox(mesh, "more", {2, 1, 1}, {4, 0, 0}, {2, 1, 1});
  // The second brick into the block of the first.
  const auto append = [](auto& to, const auto& from)
  { to.insert(to.end(), from.begin(), from.end()); };
  append(mesh.blocks[1].connectivity, mesh.blocks[2].connectivity);
  append(mesh.blocks[1].elementIds, mesh.blocks[2].elementIds);
  append(mesh.blocks[1].bodyIds, mesh.blocks[2].bodyIds);
  mesh.blocks.resize(2);
  const Comm comm;
  const RankMesh part = rockModel(mesh, comm, 0, "scattered").mesh;
  const std::vector<int> bodies = rigidBodiesOf(part, {0, 1}, comm);
  for (int i = 0; i < part.nodes(); ++i)
  {
    const int n = part.nodePositions[std::size_t(i)];
    EXPECT_EQ(bodies[std::size_t(i)], n < 8 ? -1 : n < 16 ? 0 : 1);
  }
}

TEST(RigidBodies, inertiaIsThatOfTheSolidWhateverTheMesh)
{
  const Comm comm;
  Solver solver(tumbling(comm, 1e-3), comm);
  const RigidBodies& bodies = solver.rigidBodies();
  ASSERT_EQ(bodies.count(), 1);
  EXPECT_NEAR(bodies.mass(0), 8000, 1e-9);
  EXPECT_LT(norm(bodies.center(0) - Vec3{5.5, 1, 2}), 1e-14);
  // M (b^2 + c^2) / 12
  EXPECT_NEAR(bodies.inertia(0)(0, 0), 8000 * (4 + 16) / 12.0, 1e-9);
  EXPECT_NEAR(bodies.inertia(0)(1, 1), 8000 * (1 + 16) / 12.0, 1e-9);
  EXPECT_NEAR(bodies.inertia(0)(2, 2), 8000 * (1 + 4) / 12.0, 1e-9);
  EXPECT_NEAR(bodies.inertia(0)(0, 1), 0, 1e-9);

  // The corner of the unit cube: integral of x^2 is 1/60, so about the centre at 1/4 it is 1/160;
  // that of x y is 1/120, so it is -1/480. J_xx = 2/160, J_xy = 1/480.
  Mesh mesh;
  mesh.nodeIds = {1, 2, 3, 4};
  mesh.coordinates = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Mesh::Block block;
  block.id = 1;
  block.name = "corner";
  block.type = ElementType::Tet4;
  block.elementIds = {1};
  block.bodyIds = {1};
  block.connectivity = {0, 1, 2, 3};
  mesh.blocks = {block};
  Model model = rockModel(mesh, comm);
  makeRigid(model, comm, {1});
  model.contactEnabled = false;
  Solver corner(std::move(model), comm);
  EXPECT_NEAR(corner.rigidBodies().inertia(0)(0, 0), 1000.0 / 80, 1e-12);
  EXPECT_NEAR(corner.rigidBodies().inertia(0)(0, 1), 1000.0 / 480, 1e-12);
}

TEST(RigidBodies, freeFlightKeepsMomentaAndShapeExactlyAndEnergyToSecondOrder)
{
  const Comm comm;
  Real error[2];
  for (const int i : {0, 1})
  {
    Solver solver(tumbling(comm, i == 0 ? 2e-3 : 1e-3), comm);
    solver.prepare();
    const EnergyBalance start = solver.energy();
    // 1/2 M v^2 + 1/2 w J w
    const Real expected = 0.5 * 8000 * 14 + 0.5 * 8000 / 12.0 * (20 * 16 + 17 * 49 + 5 * 4);
    EXPECT_NEAR(start.kinetic, expected, 2e-4 * expected);
    Real largest = 0;
    for (int cycle = 0; cycle < (i == 0 ? 500 : 1000); ++cycle)
    {
      solver.advance();
      largest = std::max(largest, std::abs(solver.energy().error()));
    }
    error[i] = largest / expected;
    const Momenta momenta = solver.momenta();
    EXPECT_LT(norm(momenta.linearError()), 1e-14 * momenta.magnitude);
    EXPECT_LT(norm(momenta.angularError()), 1e-12 * norm(momenta.angular));
    const Vec3 moved = solver.rigidBodies().center(0) - Vec3{5.5, 1, 2};
    EXPECT_LT(norm(moved - Vec3{3, -2, 1}), 1e-12);
    // Every node keeps its distance from the centre.
    for (int n = 0; n < solver.layout().owned(); ++n)
      EXPECT_NEAR(norm(at(solver.state().x, n) - solver.rigidBodies().center(0)),
                  norm(at(solver.state().reference, n) - Vec3{5.5, 1, 2}), 1e-12);
  }
  EXPECT_LT(error[0], 1e-3);
  EXPECT_GT(error[0] / error[1], 3.5);
  EXPECT_LT(error[0] / error[1], 4.5);
}

TEST(RigidBodies, collideWithRigidAndDeformableBodies)
{
  const Comm comm;
  for (const auto& scene : {fallingOnRigid, fallingOnRock})
  {
    Solver solver(scene(comm), comm);
    solver.prepare();
    cycles(solver, 300);
    const EnergyBalance energy = solver.energy();
    EXPECT_GT(energy.contact.friction, 0);
    EXPECT_LT(std::abs(energy.error()), 2e-3 * energy.initial);
    const Momenta momenta = solver.momenta();
    EXPECT_LT(norm(momenta.linearError()), 1e-12 * momenta.magnitude);
    EXPECT_LT(norm(momenta.angularError()), 1e-11 * momenta.magnitude);
    EXPECT_LT(momenta.linear.z, 0);
    EXPECT_EQ(solver.contact().counts().tooDeep, 0);
  }
}

TEST(RigidBodies, haveTheSameBitsOnAnyRanks)
{
  const Comm world, alone(MPI_COMM_SELF);
  for (const auto& scene : {fallingOnRigid, fallingOnRock})
  {
    Solver one(scene(alone), alone), many(scene(world), world);
    one.prepare();
    many.prepare();
    cycles(one, 60);
    cycles(many, 60);
    EXPECT_GT(one.contact().energy().work, 0);
    EXPECT_EQ(many.stateHash(), one.stateHash());
    EXPECT_EQ(many.energy().kinetic, one.energy().kinetic);
    EXPECT_EQ(many.energy().error(), one.energy().error());
    EXPECT_EQ(norm(many.momenta().angular - one.momenta().angular), 0);
    EXPECT_EQ(many.stepControl().text(), one.stepControl().text());
  }
}

TEST(RigidBodies, stepIsThatOfTheWholeBodyOnItsSprings)
{
  // Equal cubes of 1 m and 1000 kg lie on each other, a force along z between them: the upper one
  // sees the springs of its whole base, k A. Nodes count twice that (Gershgorin's circles), the
  // overlap of a face up to 1.5 times, and the plane between two rigid bodies fourfold.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "lower", {1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "upper", {1, 1, 1}, {0, 0, 1 - 1e-6}, {1, 1, 1});
  Model model = rockModel(mesh, comm);
  makeRigid(model, comm, {1, 1});
  Solver solver(std::move(model), comm);
  solver.prepare();
  const StepControl control = solver.stepControl();
  EXPECT_TRUE(control.rigid);
  const Real stiffness = solver.contact().planes().size() > 0
                             ? Real(solver.contact().planes()[0].fit.normalStiffness)
                             : 0;
  const Real k = comm.max(stiffness);
  ASSERT_GT(k, 0);
  const Real both = 2 / std::sqrt(2 * k / 1000.0); // of two bodies against each other
  EXPECT_LT(control.stableStep, both / 2);
  EXPECT_GT(control.stableStep, both / 6);
}

TEST(RigidBodies, stepsSeeThemMeetWithAnEdge)
{
  // Prisms that come with an edge on each other share nothing, and have no stiffness by which a
  // step could be told, before they lie in each other.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "lower", {3, 3, 3}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "upper", {3, 3, 3}, {0, 0, 2}, {1, 1, 1});
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n)
  {
    Vec3& x = mesh.coordinates[n];
    const bool upper = x.z > 1.5;
    const Real y = x.y - .5, z = x.z - (upper ? 2.5 : .5), c = std::sqrt(.5);
    x = {x.x, c * (y - z), c * (y + z) + (upper ? 1.001 : -1) * c};
  }
  Model model = rockModel(mesh, comm);
  makeRigid(model, comm, {1, 1});
  const Real speed = 10;
  model.blocks[1].velocity = {0, 0, -speed};
  model.time.end = .2 / speed;
  Solver solver(std::move(model), comm);
  solver.prepare();
  const StepControl control = solver.stepControl();
  EXPECT_TRUE(control.meeting);
  EXPECT_NE(control.text().find("meet with an edge"), std::string::npos);
  const Real start = solver.energy().kinetic;
  while (solver.clock().time < .2 / speed)
    solver.advance();
  const EnergyBalance end = solver.energy();
  EXPECT_LT(std::abs(end.contact.remainder()), 2e-3 * start);
  EXPECT_LT(end.kinetic + end.contact.stored, 1.003 * start);
  EXPECT_NEAR(solver.rigidBodies().motion(0).velocity.z, -speed, 3e-3 * speed);
}

TEST(RigidBodies, countFourfoldInTheStepWhereTheyTouchEachOther)
{
  const Comm comm;
  for (const bool both : {true, false})
  {
    Solver solver(falling(comm, both), comm);
    solver.prepare();
    std::int64_t planes = 0;
    for (std::size_t p = 0; p < solver.contact().planes().size(); ++p)
      if (const Plane& plane = solver.contact().planes()[p]; plane.face[0] >= 0)
      {
        ++planes;
        EXPECT_EQ(plane.pairing == Pairing::Stiff, both);
      }
    EXPECT_GT(comm.max(planes), 0);
  }
}

TEST(RigidBodies, giveWayWithWhatIsNotGiven)
{
  const Comm comm;
  const auto massOf = [&](const std::vector<RigidMotion>& motions)
  {
    Model model = tumbling(comm, 1e-3);
    model.conditions.rigidMotions = motions;
    Solver solver(std::move(model), comm);
    return solver.rigidBodies().massThatYields(0);
  };
  RigidMotion motion;
  motion.block = 0;
  EXPECT_NEAR(massOf({}), 8000, 1e-9);
  motion.components = {true, true, false};
  EXPECT_NEAR(massOf({motion}), 8000, 1e-9);
  // What turns: J / r^2 about the long axis.
  motion.components = {true, true, true};
  EXPECT_NEAR(massOf({motion}), 8000 * (1 + 4) / 12.0 / (0.25 * (1 + 4 + 16)), 1e-9);
  motion.spin.emplace();
  EXPECT_EQ(massOf({motion}), infinity);
}

TEST(RigidBodies, fallFreelyAndStandOnWhatHoldsThem)
{
  const Comm comm;
  Model model = tumbling(comm, 1e-3);
  model.blocks[0].velocity = model.blocks[0].angularVelocity = {};
  model.conditions.gravity = VectorOfTime(0, 0, -10);
  model.time.fixedStep = 1e-3;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 100);
  EXPECT_NEAR(solver.rigidBodies().center(0).z, 2 - 0.05, 1e-12); // g t^2 / 2
  EXPECT_LT(norm(solver.rigidBodies().spin(0)), 1e-12);
  EXPECT_NEAR(solver.energy().externalWork, 8000 * 10 * 0.05, 1e-6);

  Model held = tumbling(comm, 1e-3);
  held.conditions.gravity = VectorOfTime(0, 0, -10);
  PrescribedVelocity fixed;
  fixed.nodes = ownedNodesWhere(held.mesh, [](const Vec3&) { return true; });
  held.conditions.velocities = {fixed};
  held.time.fixedStep = 1e-3;
  Solver standing(std::move(held), comm);
  standing.prepare();
  cycles(standing, 100);
  EXPECT_EQ(standing.rigidBodies().center(0).z, 2);
  EXPECT_EQ(largest(standing.state().v, standing.layout().owned(), comm), 0);
  // Nothing moves: the reaction has taken up the weight, and nothing has done work.
  EXPECT_LT(norm(standing.momenta().linearError()), 1e-9);
  EXPECT_LT(norm(standing.momenta().angularError()), 1e-8);
  EXPECT_EQ(standing.energy().externalWork, 0);
}

TEST(RigidBodies, followPrescribedMotionAlongOneAxisAndAreFreeAlongTheOthers)
{
  // Along x at 2 t; the spin about x stays, the others go.
  const Comm comm;
  Model model = tumbling(comm, 1e-3);
  PrescribedVelocity along;
  along.nodes = ownedNodesWhere(model.mesh, [](const Vec3&) { return true; });
  along.components = {true, false, false};
  along.velocity[0] = [](Real t) { return 2 * t; };
  model.conditions.velocities = {along};
  model.time.fixedStep = 1e-3;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 500);
  EXPECT_NEAR(solver.rigidBodies().center(0).x, 5.5 + 0.25, 1e-12);
  EXPECT_NEAR(solver.rigidBodies().center(0).y, 1 - 2 * 0.5, 1e-12);
  EXPECT_EQ(solver.rigidBodies().spin(0).y, 0);
  EXPECT_NEAR(solver.rigidBodies().spin(0).x, 4, 1e-9);
  EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
  EXPECT_LT(std::abs(solver.energy().error()), 1e-3 * solver.energy().kinetic);
}

TEST(RigidBodies, cannotBeHeldInPart)
{
  const Comm comm;
  Model model = tumbling(comm, 1e-3);
  PrescribedVelocity fixed;
  fixed.nodes = ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.z == 0; });
  model.conditions.velocities = {fixed};
  try
  {
    Solver solver(std::move(model), comm);
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_TRUE(error.onAllRanks());
    EXPECT_EQ(
        std::string(error.what()),
        "conditions: a condition on velocities holds 9 of the 36 nodes of a rigid "
        "body with its centre at (5.5, 1, 2) m; accepted: all of them or none. Use a node set "
        "with the whole block.");
  }
}

TEST(RigidBodies, areDampedLikeTheirMass)
{
  // v = v0 exp(-alpha t), spin too; what is lost is booked.
  const Comm comm;
  Model model = tumbling(comm, 1e-3);
  model.blocks[0].angularVelocity = {0, 0, 2}; // about an axis of its own
  model.conditions.massDamping = [](Real) { return 3.0; };
  model.time.fixedStep = 1e-3;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 500);
  EXPECT_NEAR(solver.rigidBodies().spin(0).z, 2 * std::exp(-1.5), 2e-3);
  EXPECT_NEAR(solver.rigidBodies().center(0).x, 5.5 + (1 - std::exp(-1.5)), 1e-3);
  EXPECT_LT(std::abs(solver.energy().error()), 1e-5 * solver.energy().initial);
  EXPECT_LT(norm(solver.momenta().linearError()), 1e-11 * 8000);
  EXPECT_LT(norm(solver.momenta().angularError()), 1e-10 * 8000);
}
} // namespace coplane
