#include "Rig.hpp"

#include <coplane_contact/ContactTables.hpp>
#include <coplane_core/ExactSum.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

// What a plane inherits, in whole runs: from planes whose area it continues, and from no others.

namespace coplane
{
namespace
{
/// A box, or a rectangle of the same extent along x and z.
void addBlock(Mesh& mesh, int dimension, const std::string& name, int along, const Vec3& corner,
              const Vec3& size)
{
  if (dimension == 3)
    addBox(mesh, name, {along, 1, 1}, corner, size);
  else
    addRectangle(mesh, name, {along, 1}, {corner.x, corner.z, 0}, {size.x, size.z, 0});
}

Vec3 upwards(int dimension)
{
  return dimension == 3 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
}

/// A floor of one element, brick A on it and, 1.5 m away, brick B above it.
///
///         A       B
///     +--[ ]-----[ ]--+
///     +---------------+
Model bricksOnOneFace(int dimension, Real gapOfA, Real gapOfB, const Comm& comm)
{
  Mesh mesh;
  mesh.dimension = dimension;
  addBlock(mesh, dimension, "floor", 1, {0, 0, 0}, {4, 1, 0.5});
  addBlock(mesh, dimension, "A", 1, {0.5, 0.25, 0.5 + gapOfA}, {0.5, 0.5, 0.5});
  addBlock(mesh, dimension, "B", 1, {2.5, 0.25, 0.5 + gapOfB}, {0.5, 0.5, 0.5});
  Model model = rockModel(mesh, comm, 0.5);
  model.blocks[0].material = makeLinearElastic(1e12, 0.25, 1e6); // hardly moves
  model.skin = 0.05;
  model.time.fixedStep = 1e-5;
  return model;
}

struct PlaneOfBlocks
{
  Real area = 0, offset = 0, inherited = 0, shear = 0;
};

/// Of the plane between the floor and a brick, the same on all ranks.
PlaneOfBlocks planeOnFloor(const Solver& solver, int brick)
{
  std::vector<Real> found(4, -infinity);
  const auto& planes = solver.contact().planes();
  for (std::size_t p = 0; p < planes.size(); ++p)
    if (planes[p].block[0] == 0 && planes[p].block[1] == brick && planes[p].area > 0)
      found = {planes[p].area, planes[p].offset, Real(planes[p].isInherited()),
               norm(planes[p].history.shearTraction)};
  solver.comm().max(found);
  if (found[0] < 0)
    return {};
  return {found[0], found[1], found[2], found[3]};
}

struct HandedOnHistory : WithForces
{
};
INSTANTIATE_TEST_SUITE_P(, HandedOnHistory, WithForces::both(), WithForces::name);
} // namespace

TEST_P(HandedOnHistory, aBrickThatFallsBesideAShearedOneGetsNothing)
{
  const Comm comm;
  for (const int dimension : {2, 3})
  {
    SCOPED_TRACE(dimension);
    Model model = bricksOnOneFace(dimension, 0, 2e-3, comm);
    model.blocks[1].velocity = Vec3{2, 0, 0} - upwards(dimension);
    model.blocks[2].velocity = -1.0 * upwards(dimension);
    Solver solver(std::move(model), comm);
    solver.prepare();
    Real shearOfA = 0;
    while (solver.clock().time < 3e-3)
    {
      solver.advance();
      const PlaneOfBlocks b = planeOnFloor(solver, 2);
      if (b.area > 0)
      {
        EXPECT_EQ(b.inherited, 0);
        EXPECT_EQ(b.offset, 0);
        EXPECT_LT(b.shear, 1e-3 * shearOfA); // of waves in the floor
        break;
      }
      shearOfA = std::max(shearOfA, planeOnFloor(solver, 1).shear);
    }
    EXPECT_GT(solver.clock().time, 1.9e-3);
    EXPECT_LT(solver.clock().time, 2.1e-3);
    EXPECT_GT(shearOfA, 1e4); // [Pa]
  }
}

TEST_P(HandedOnHistory, aDeclaredGapDoesNotLiftAnotherBrickOfTheSameFace)
{
  const Comm comm;
  for (const int dimension : {2, 3})
  {
    SCOPED_TRACE(dimension);
    Model model = bricksOnOneFace(dimension, 0.02, 0.03, comm);
    model.contactRules.table[0 * 3 + 1].declared = true;
    model.contactRules.table[1 * 3 + 0].declared = true;
    model.blocks[1].velocity = -0.1 * upwards(dimension);
    model.blocks[2].velocity = -5.0 * upwards(dimension);
    Solver solver(std::move(model), comm);
    solver.prepare();
    Real offsetOfA = 0;
    while (solver.clock().time < 8e-3 && !(planeOnFloor(solver, 2).area > 0))
    {
      solver.advance();
      offsetOfA = std::max(offsetOfA, planeOnFloor(solver, 1).offset);
    }
    EXPECT_NEAR(solver.clock().time, 6e-3, 2e-5) << "30 mm at 5 m/s";
    EXPECT_NEAR(offsetOfA, 0.02, 1e-12);
    EXPECT_EQ(planeOnFloor(solver, 2).offset, 0);
  }
}

namespace
{
/// A slider over a floor of 8 elements, which are one body or two, the second from `seam` on.
Model slider(int dimension, bool seam, const Comm& comm)
{
  Mesh mesh;
  mesh.dimension = dimension;
  if (seam)
  {
    addBlock(mesh, dimension, "left", 3, {0, 0, 0}, {0.75, 1, 0.25});
    addBlock(mesh, dimension, "right", 5, {0.75, 0, 0}, {1.25, 1, 0.25});
  }
  else
    addBlock(mesh, dimension, "floor", 8, {0, 0, 0}, {2, 1, 0.25});
  addBlock(mesh, dimension, "slider", 2, {0.02, 0.25, 0.25}, {0.6, 0.5, 0.3});
  Model model = rockModel(mesh, comm, 0.05);
  model.blocks.back().velocity = {10, 0, 0};
  const Vec3 g = -9.81e2 * upwards(dimension); // so that it stays pressed
  model.conditions.gravity = VectorOfTime(g.x, g.y, g.z);
  model.contact.dampNormal = 0.5;
  model.time.energyTolerance = model.time.contactGainTolerance = infinity;
  return model;
}
} // namespace

TEST_P(HandedOnHistory, aBlockCarriesItsShearTractionOverMeshLinesAndSeams)
{
  const Comm comm;
  for (const int dimension : {2, 3})
    for (const bool seam : {false, true})
    {
      SCOPED_TRACE(testing::Message() << dimension << "D, seam: " << seam);
      Model model = slider(dimension, seam, comm);
      const int sliding = int(model.blocks.size()) - 1;
      PrescribedVelocity foot;
      foot.nodes = ownedNodesWhere(model.mesh,
                                   [&](const Vec3& x) { return dot(x, upwards(dimension)) == 0; });
      for (OfTime& component : foot.velocity)
        component = [](Real) { return 0.0; };
      model.conditions.velocities.push_back(foot);
      Solver solver(std::move(model), comm);
      solver.prepare();
      cycles(solver, 20); // until it has settled on the floor
      std::set<std::pair<GlobalId, GlobalId>> known;
      std::int64_t born = 0, alone = 0;
      while (solver.clock().time < 0.05)
      {
        const auto& planes = solver.contact().planes();
        for (std::size_t p = 0; p < planes.size(); ++p)
        {
          const Plane& plane = planes[p];
          // Not the front of the slider against the hidden side behind the seam.
          if (!plane.countedHere || !plane.isBorn() || plane.block[1] != sliding ||
              std::abs(dot(plane.normal, upwards(dimension))) < 0.9)
            continue;
          if (known.insert({plane.faceId[0], plane.faceId[1]}).second && solver.clock().cycle > 20)
          {
            ++born;
            alone += !plane.isInherited();
          }
        }
        solver.advance();
      }
      EXPECT_GE(comm.sum(born), 2);
      EXPECT_EQ(comm.sum(alone), 0);
    }
}

TEST_P(HandedOnHistory, aBondGoesOnOverMeshLines)
{
  // Two cubes whose meshes do not match, joined by a bond that holds at any stress and gives way by
  // centimetres: however far they are displaced along the joint, all of the area that they share is
  // bonded.
  const Comm comm;
  for (const int dimension : {2, 3})
  {
    SCOPED_TRACE(dimension);
    Mesh mesh;
    mesh.dimension = dimension;
    addBlock(mesh, dimension, "lower", 8, {0, 0, 0}, {1, 1, 0.5});
    addBlock(mesh, dimension, "upper", 9, {0, 0, 0.5}, {1, 1, 0.5});
    Model model = rockModel(mesh, comm);
    for (ContactRule& rule : model.contactRules.table)
      rule.declared = true;
    JointLaw& law = model.contactRules.joints[0].law;
    law.penalty = false;
    law.initialStiffness = 2e7;
    law.shearRatio = 0.05;
    law.bond.kind = Bond::Kind::Brittle;
    law.bond.tensileStrength = 1e9;
    law.cohesion = 1e9;
    model.blocks[0].velocity = {-2, 0, 0};
    model.blocks[1].velocity = {2, 0, 0};
    Solver solver(std::move(model), comm);
    solver.prepare();
    Real least = 1;
    while (solver.clock().time < 0.06)
    {
      solver.advance();
      std::vector<ExactSum> sums(2); // area that is bonded, and that the blocks share
      for (std::size_t p = 0; p < solver.contact().planes().size(); ++p)
      {
        const Plane& plane = solver.contact().planes()[p];
        if (!plane.countedHere || plane.face[0] < 0)
          continue;
        sums[1].add(plane.overlap);
        if (plane.history.bonded)
          sums[0].add(planeNow(solver.contact(), plane, solver.state().x).area);
      }
      const std::vector<Real> areas = ExactSum::overRanks(sums, comm);
      ASSERT_NEAR(areas[0], areas[1], 1e-6) << "t = " << solver.clock().time;
      least = std::min(least, areas[0]);
    }
    EXPECT_LT(least, 0.95) << "displaced by half an element";
    EXPECT_GT(least, 0.8);
  }
}
} // namespace coplane
