#include "Rig.hpp"

#include <coplane_contact/Census.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace coplane
{
namespace
{
/// Two blocks of 1 x 1 x 1 m, meshes that do not match, one on the other.
///
///      +-+-+-+-+     4 x 4 x 2 elements
///      |_|_|_|_|
///      +--+--+--+    3 x 3 x 2 elements
///      |__|__|__|
Mesh stack(Real gap)
{
  Mesh mesh;
  addBox(mesh, "lower", {3, 3, 2}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "upper", {4, 4, 2}, {0, 0, 1 + gap}, {1, 1, 1});
  return mesh;
}

Model declaredStack(Real gap, const Comm& comm, Real friction = 0.5)
{
  Model model = rockModel(stack(gap), comm, friction);
  for (ContactRule& rule : model.contactRules.table)
    rule.declared = true;
  return model;
}

bool isTop(const Vec3& x)
{
  return x.z > 1.9;
}
bool isFoot(const Vec3& x)
{
  return x.z == 0;
}

void press(Model& model, Real pressure)
{
  model.conditions.pressures = {pressureWhere(model.mesh, pressure, isTop),
                                pressureWhere(model.mesh, pressure, isFoot)};
}

/// Displacements of all nodes of all ranks by position in the file.
std::vector<Vec3> displacements(const Solver& solver, int nodes)
{
  std::vector<Real> values(3 * nodes, -infinity);
  for (int n = 0; n < solver.layout().owned(); ++n)
    for (int c = 0; c < 3; ++c)
      values[3 * solver.mesh().nodePositions[n] + c] =
          solver.state().x(n, c) - solver.state().reference(n, c);
  solver.comm().max(values);
  std::vector<Vec3> result(nodes);
  for (int n = 0; n < nodes; ++n)
    result[n] = {values[3 * n], values[3 * n + 1], values[3 * n + 2]};
  return result;
}

struct DeclaredJoint : WithForces
{
};
INSTANTIATE_TEST_SUITE_P(, DeclaredJoint, WithForces::both(), WithForces::name);
struct UndeclaredContact : WithForces
{
};
INSTANTIATE_TEST_SUITE_P(, UndeclaredContact, WithForces::both(), WithForces::name);
} // namespace

TEST_P(DeclaredJoint, underTheInitialStressAndItsPressureStaysAtRest)
{
  // 1 MPa of uniaxial compression in the blocks, in the joint, and as pressure on foot and top.
  // Round-off of nodal forces of about 1e5 N on masses of about 10 kg: 1e-12 m/s a cycle.
  const Comm comm;
  Model model = declaredStack(0, comm);
  for (BlockSetup& block : model.blocks)
    block.stress.zz = -1e6;
  press(model, 1e6);
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 200);
  EXPECT_GT(solver.contact().counts().stick, 0);
  EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), 1e-9);
}

TEST_P(DeclaredJoint, carriesTheInitialStressLessThePressureOnItsFaces)
{
  // 1 MPa of compression in the blocks and on their ends, water of 0.4 MPa in the joint: both are
  // at rest when the joint starts with 0.6 MPa. Meshes do not match, so planes of one face have two
  // faces on the other side.
  const Comm comm;
  Model model = declaredStack(0, comm);
  for (BlockSetup& block : model.blocks)
    block.stress.zz = -1e6;
  press(model, 1e6);
  model.conditions.pressures.push_back(
      pressureWhere(model.mesh, 0.4e6, [](const Vec3& x) { return x.z == 1; }));
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 200);
  EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), 1e-9);
  Real least = infinity, most = -infinity;
  const auto planes = solver.contact().planes();
  for (std::size_t p = 0; p < planes.size(); ++p)
    if (planes[p].state != PlaneState::Open)
    {
      const Real traction = std::abs(planes[p].forceOn(1).z) / planes[p].area; // rims act along it
      least = std::min(least, traction);
      most = std::max(most, traction);
    }
  EXPECT_NEAR(comm.min(least), 0.6e6, 1);
  EXPECT_NEAR(comm.max(most), 0.6e6, 1);
}

TEST_P(DeclaredJoint, hasAbsorbedWhatTheMeshHasButNotWhatAStressCloses)
{
  const Comm comm;
  for (const Real gap : {0.0, 1e-3, -1e-3})
  {
    Model model = declaredStack(gap, comm);
    for (BlockSetup& block : model.blocks)
      block.stress.zz = -1e6;
    Solver solver(std::move(model), comm);
    solver.prepare();
    const auto planes = solver.contact().planes();
    int declared = 0;
    for (std::size_t p = 0; p < planes.size(); ++p)
      if (planes[p].declared)
      {
        ++declared;
        EXPECT_EQ(planes[p].history.absorbed, gap != 0) << gap;
        EXPECT_GT(planes[p].offset - gap, 1e-6 * planes[p].depthLimit) << "closed by the stress";
      }
    EXPECT_GT(comm.sum(std::int64_t(declared)), 0);
  }
}

TEST_P(DeclaredJoint, holdsOnWhenItsBondOpensByMoreThanTheSkin)
{
  // Two cubes of 1 t part at 1 m/s; the bond softens by exp(-opening / 0.1 m), the skin is 5 cm.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "lower", {1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "upper", {1, 1, 1}, {0, 0, 1}, {1, 1, 1});
  Model model = rockModel(mesh, comm);
  for (ContactRule& rule : model.contactRules.table)
    rule.declared = true;
  model.contactRules.joints[0].law.bond =
      Bond::softening(Bond::Kind::Exponential, 1e3, 1e3, 100, 100);
  model.blocks[1].velocity = {0, 0, 1};
  model.skin = 0.05;
  model.time.fixedStep = 1e-4;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 1500);
  EXPECT_EQ(solver.contact().counts().stick, 1);
  const EnergyBalance balance = solver.energy();
  Real opening = -infinity;
  for (std::size_t p = 0; p < solver.contact().planes().size(); ++p)
    opening = solver.contact().planes()[p].gap;
  opening = comm.max(opening);
  EXPECT_GT(opening, 0.1);
  EXPECT_NEAR(balance.contact.fracture, 100 * (1 - std::exp(-opening / 0.1)), 0.2);
  EXPECT_LT(std::abs(balance.error()), 1e-9 * balance.scale());
}

TEST_P(DeclaredJoint, withAClosureCurveAndAMeshGapStaysAtRestToo)
{
  const Comm comm;
  Model model = declaredStack(1e-4, comm);
  JointRecipe curved;
  curved.law.penalty = false;
  curved.law.initialStiffness = 1e9;            // [Pa/m]
  curved.law.curve.inverseMaximumClosure = 1e3; // closes by 1 mm at most
  curved.law.stiffnessCap = 1e11;
  curved.law.friction = 0.5;
  model.contactRules.joints = {curved};
  for (BlockSetup& block : model.blocks)
    block.stress.zz = -1e6;
  press(model, 1e6);
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 200);
  // Where borders of both blocks lie on each other, the potential gives half of the rim to each:
  // p c / 2 on each length, c = 0.25 mm beyond the permanent closure, 0.1 mm apart. What balances
  // that couple is p c 0.1 mm / 4 = 6 mN on a node of 4 kg that swings with 3000 / s.
  EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), potential() ? 5e-7 : 1e-9);
}

TEST_P(DeclaredJoint, withoutStressAndLoadStaysAtRestWhateverTheMeshGap)
{
  const Comm comm;
  for (const Real gap : {-1e-3, 0.0, 1e-3})
  {
    Solver solver(declaredStack(gap, comm), comm);
    solver.prepare();
    cycles(solver, 50);
    EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), 1e-9) << "gap " << gap;
  }
}

TEST_P(DeclaredJoint, absorbsGapsAndOverlapsOfTheMesh)
{
  // The gap moves one block by 1e-5 of its size and changes nothing else: same displacements under
  // a sudden pressure, to 1e-6 of the largest. The step is fixed, so that all runs end at the same
  // time: 3 ms, when the wave from either end has crossed the joint.
  const Comm comm;
  const auto run = [&](Real gap)
  {
    Model model = declaredStack(gap, comm);
    press(model, 1e5);
    model.time.fixedStep = 1e-4;
    const int nodes = stack(gap).nodes();
    Solver solver(std::move(model), comm);
    solver.prepare();
    cycles(solver, 30);
    return displacements(solver, nodes);
  };
  const std::vector<Vec3> exact = run(0), gap = run(1e-5), overlap = run(-1e-5);
  Real size = 0, offGap = 0, offOverlap = 0;
  for (std::size_t n = 0; n < exact.size(); ++n)
  {
    size = std::max(size, norm(exact[n]));
    offGap = std::max(offGap, norm(gap[n] - exact[n]));
    offOverlap = std::max(offOverlap, norm(overlap[n] - exact[n]));
  }
  EXPECT_GT(size, 1e-5); // 1e5 Pa over 1e9 Pa on 2 m, dynamic
  EXPECT_LT(offGap, 1e-6 * size);
  EXPECT_LT(offOverlap, 1e-6 * size);
}

TEST_P(DeclaredJoint, closesFacesThatLieOnEachOtherAndNoOthers)
{
  // A stone whose sides overhang the floor at 45 and at 70 degrees: they share an edge with the
  // face that it lies on. Its bed is closed, with the gap of the mesh, whatever the skin; the sides
  // are not.
  const Comm comm;
  struct Scene
  {
    int dimension;
    Real gap, skin;
  };
  std::vector<Scene> scenes;
  for (const int dimension : {2, 3})
    for (const Real gap : {-0.02, 0.0, 0.05, 0.19, 0.3})
      for (const Real skin : {0.5, 0.01})
        scenes.push_back({dimension, gap, skin});
  for (const auto& [dimension, gap, skin] : scenes)
  {
    SCOPED_TRACE(testing::Message() << dimension << "D, gap " << gap << ", skin " << skin);
    Mesh mesh;
    const int up = dimension - 1;
    if (dimension == 3)
    {
      addBox(mesh, "floor", {4, 1, 1}, {-2, 0, 0}, {4, 1, 1});
      addBox(mesh, "stone", {1, 1, 1}, {-0.4, 0.1, 1 + gap}, {0.8, 0.8, 0.8});
    }
    else
    {
      addRectangle(mesh, "floor", {4, 1}, {-2, 0, 0}, {4, 1, 0});
      addRectangle(mesh, "stone", {1, 1}, {-0.4, 1 + gap, 0}, {0.8, 0.8, 0});
    }
    for (Vec3& x : mesh.coordinates)
      if (x[up] > 1.7 + gap)
        x.x += x.x < 0 ? -0.8 : 0.8 * std::tan(20 * pi / 180);
    Model model = rockModel(mesh, comm);
    for (ContactRule& rule : model.contactRules.table)
      rule.declared = true;
    model.skin = skin;
    Solver solver(std::move(model), comm);
    solver.prepare();
    std::vector<std::int64_t> closed(3, 0); // on the bed, elsewhere, and pairs in all
    for (std::size_t p = 0; p < solver.contact().planes().size(); ++p)
    {
      const Plane& plane = solver.contact().planes()[p];
      closed[0] += plane.countedHere && plane.declared && std::abs(plane.normal[up]) > 0.99;
      closed[1] += plane.countedHere && plane.declared && std::abs(plane.normal[up]) < 0.99;
    }
    for (std::size_t slot = 0; slot < solver.contact().slots(); ++slot)
      closed[2] += solver.contact().planeOf(slot).countedHere;
    comm.sum(closed);
    EXPECT_EQ(closed[0], gap < 0.2 ? 2 : 0) << "wider than a quarter of the smaller face: no joint";
    EXPECT_EQ(closed[1], 0);
    if (skin > 0.1)
    {
      EXPECT_GT(closed[2], 2) << "the sides are candidates, too";
    }
  }
}

TEST_P(UndeclaredContact, facesThatTouchDoNotOverlap)
{
  const Comm comm;
  Solver solver(rockModel(stack(0), comm, 0.5), comm);
  solver.prepare();
  const ContactCensus found = census(solver.contact());
  EXPECT_GT(found.touching, 0);
  EXPECT_EQ(found.overlapping, 0);
  EXPECT_EQ(found.overlaps.count, 0);
}

TEST_P(UndeclaredContact, doesNotPushOverlapsOfTheMeshApart)
{
  const Comm comm;
  Solver solver(rockModel(stack(-1e-3), comm, 0.5), comm);
  solver.prepare();
  const ContactCensus before = census(solver.contact());
  EXPECT_GT(before.overlapping, 0);
  EXPECT_NEAR(before.overlaps.quantiles.back(), 1e-3, 1e-12);
  for (int i = 0; i < 50; ++i)
  {
    solver.advance();
    EXPECT_LT(largest(solver.state().contactForce, solver.layout().owned(), comm), 1e-6);
  }
  // Contact stiffness times round-off of positions is all that may act: 1e9 N/m times 1e-16 m.
  EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), 1e-9);
}

TEST_P(UndeclaredContact, acrossAnInitialGapActsOnlyWhenItIsClosed)
{
  // A gap of 1 mm at 1 m/s closes after 1 ms.
  const Comm comm;
  Model model = rockModel(stack(1e-3), comm);
  model.blocks[1].velocity = {0, 0, -1};
  model.time.fixedStep = 5e-5;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 19); // t = 0.95 ms
  EXPECT_EQ(largest(solver.state().contactForce, solver.layout().owned(), comm), 0);
  cycles(solver, 3); // t = 1.1 ms: 0.1 mm into contact
  EXPECT_GT(largest(solver.state().contactForce, solver.layout().owned(), comm), 0);
}
} // namespace coplane
