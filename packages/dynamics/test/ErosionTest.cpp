#include "Rig.hpp"

#include <coplane_core/ExactSum.hpp>
#include <coplane_material/PseudoCap.hpp>

#include <gtest/gtest.h>

#include <array>

namespace coplane
{
namespace
{
/// A column of five unit cubes along z whose ends part at 60 m/s; elements die as soon as their
/// volume has grown by 1 %.
Model stretchedColumn(const Comm& comm)
{
  Mesh mesh;
  addBox(mesh, "column", {1, 1, 5}, {0, 0, 0}, {1, 1, 5});
  Model model = rockModel(mesh, comm);
  model.blocks[0].velocityField = [](const Vec3& x) {
    return Vec3{0, 0, x.z < 1.5 ? -30.0 : x.z > 3.5 ? 30.0 : 0.0};
  };
  model.blocks[0].erosion.volumeRatio = {0.5, 1.01};
  model.time.fixedStep = 1e-4;
  return model;
}

/// A cube that falls on another one; elements of it die as soon as they are squeezed by 0.15 %.
Model pressed(const Comm& comm)
{
  Model model = rockModel(twoCubes(), comm, 0.25);
  model.blocks[1].velocity = {0, 0, -20};
  model.blocks[1].erosion.volumeRatio = {0.9985, 2};
  return model;
}

std::int64_t deadAfter(Solver& solver, int n)
{
  cycles(solver, n);
  return solver.erosion().elements;
}

struct ErodingBodies : WithForces
{
};
INSTANTIATE_TEST_SUITE_P(, ErodingBodies, WithForces::both(), WithForces::name);
} // namespace

TEST_P(ErodingBodies, keepsMassAndMomentumAndTheEnergyAccount)
{
  const Comm comm;
  Solver solver(stretchedColumn(comm), comm);
  solver.prepare();
  ASSERT_GT(deadAfter(solver, 300), 0);
  const EnergyBalance energy = solver.energy();
  EXPECT_GT(energy.eroded, 0);
  EXPECT_LT(std::abs(energy.error()), 2e-3 * energy.initial);
  EXPECT_LT(norm(solver.momenta().linearError()), 1e-13 * solver.momenta().magnitude);
  EXPECT_LT(norm(solver.momenta().angularError()), 1e-12 * solver.momenta().magnitude);
  ExactSum mass;
  for (int n = 0; n < solver.layout().owned(); ++n)
    mass.add(solver.state().mass(n));
  std::vector<ExactSum> masses{mass};
  EXPECT_EQ(ExactSum::overRanks(masses, comm)[0], 5000); // 5 m^3 of 1000 kg/m^3
  EXPECT_EQ(solver.erosion().mass, 1000.0 * Real(solver.erosion().elements));
}

TEST_P(ErodingBodies, endsPlanesWithTheirEnergy)
{
  const Comm comm;
  Solver solver(pressed(comm), comm);
  solver.prepare();
  int n = 0;
  while (solver.erosion().elements == 0 && n++ < 200)
    solver.advance();
  ASSERT_GT(solver.erosion().elements, 0);
  const EnergyBalance energy = solver.energy();
  EXPECT_GT(energy.contact.eroded, 0);
  EXPECT_LT(std::abs(energy.error()), 5e-3 * energy.initial);
  // No plane is left on a dead element, on any rank.
  std::vector<GlobalId> dead;
  for (std::size_t b = 0; b < solver.blocks().size(); ++b)
    for (int e = 0; e < solver.blocks()[b].count(); ++e)
      if (!solver.blocks()[b].isAlive(e))
        dead.push_back(solver.mesh().blocks[b].elementIds[e]);
  dead = comm.allGather(dead);
  for (std::size_t slot = 0; slot < solver.contact().slots(); ++slot)
    for (const GlobalId face : solver.contact().planeOf(slot).faceId)
      EXPECT_EQ(std::count(dead.begin(), dead.end(), elementOfFace(face)), 0);
  for (const Face& face : solver.contact().faces())
    EXPECT_EQ(std::count(dead.begin(), dead.end(), elementOfFace(face.id)), 0);
}

TEST_P(ErodingBodies, loadsEndWithTheElementThatCarriedThem)
{
  // A pressure of 50 MPa on the end of a cube squeezes it by 5 %: it dies at 1 %, and what is left
  // are nodes that fly on without force.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "cube", {1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  Model model = rockModel(mesh, comm);
  model.conditions.pressures = {
      pressureWhere(model.mesh, 50e6, [](const Vec3& x) { return x.z == 1; })};
  model.blocks[0].erosion.volumeRatio = {0.99, 2};
  model.time.maximumStep = 1e-4; // nothing else limits it in the end
  Solver solver(std::move(model), comm);
  solver.prepare();
  ASSERT_EQ(deadAfter(solver, 20), 1);
  const Vec3 impulse = solver.momenta().impulse;
  EXPECT_LT(impulse.z, 0);
  cycles(solver, 20);
  EXPECT_EQ(solver.momenta().impulse.z, impulse.z);
  EXPECT_EQ(largest(solver.state().force, solver.layout().owned(), comm), 0);
  EXPECT_EQ(solver.contact().faces().size(), 0u);
}

namespace
{
/// Exterior faces and those of them that are thin, of all ranks.
std::array<std::int64_t, 2> facesAndThin(const Solver& solver, const Comm& comm)
{
  std::array<std::int64_t, 2> count{};
  for (const Face& face : solver.contact().localFaces())
    if (face.ownedHere)
    {
      ++count[0];
      count[1] += face.thin;
    }
  return {comm.sum(count[0]), comm.sum(count[1])};
}
} // namespace

TEST_P(ErodingBodies, facesAreThinWhereBodiesAreOneElementThick)
{
  using Counts = std::array<std::int64_t, 2>;
  const Comm comm;
  for (const char* const method : {"multijagged", "scattered"})
  {
    const auto counted = [&](int thick)
    {
      Mesh mesh;
      addBox(mesh, "block", {4, 4, thick}, {0, 0, 0}, {4, 4, Real(thick)});
      return facesAndThin(Solver(rockModel(mesh, comm, 0, method), comm), comm);
    };
    EXPECT_EQ(counted(3), (Counts{80, 0})) << method;
    EXPECT_EQ(counted(2), (Counts{64, 0})) << method;
    EXPECT_EQ(counted(1), (Counts{48, 48})) << method;
  }
  // A plate of two layers goes on beyond its plane of symmetry.
  Mesh half;
  addBox(half, "half", {4, 4, 1}, {0, 0, 0}, {4, 4, 1});
  Model cut = rockModel(half, comm);
  cut.conditions.symmetries = {
      {ownedNodesWhere(cut.mesh, [](const Vec3& x) { return x.z == 0; }), {0, 0, 1}}};
  EXPECT_EQ(facesAndThin(Solver(std::move(cut), comm), comm), (Counts{48, 0}));
  // The middle one of three layers dies: the outer ones are plates then.
  Mesh mesh;
  addBox(mesh, "block", {4, 4, 3}, {0, 0, 0}, {4, 4, 3});
  Model model = rockModel(mesh, comm);
  model.blocks[0].erosion.volumeRatio = {0.5, 1 + 1e-5};
  model.blocks[0].velocityField = [](const Vec3& x) { return Vec3{0, 0, x.z < 1.5 ? -1.0 : 1.0}; };
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 3);
  ASSERT_EQ(solver.erosion().elements, 16);
  EXPECT_EQ(facesAndThin(solver, comm), (Counts{96, 96}));
}

TEST_P(ErodingBodies, damageIsAGateForTheOtherLimits)
{
  // Concrete that is torn: every stretch is beyond the limit of the volume, but only what is broken
  // dies.
  const Comm comm;
  const auto torn = [&](std::optional<Real> damage)
  {
    Model model = stretchedColumn(comm);
    PseudoCapParameters concrete = concreteC40();
    concrete.fractureEnergy = 1000; // elements of 1 m shall not spring back
    model.blocks[0].material = makeLaw(concrete);
    model.blocks[0].velocityField = [](const Vec3& x) { return Vec3{0, 0, x.z - 2.5}; };
    model.blocks[0].erosion.volumeRatio = {0.5, 1 + 1e-9};
    model.blocks[0].erosion.damage = damage;
    model.time.fixedStep.reset();
    model.time.maximumStep = 5e-6;
    return model;
  };
  const auto living = [&](const Solver& solver, auto&& chosen)
  {
    std::int64_t count = 0;
    const ElementBlock& block = solver.blocks()[0];
    for (int e = 0; e < block.count(); ++e)
      count += solver.mesh().blocks[0].owned[e] && block.isAlive(e) && chosen(block, e);
    return comm.sum(count);
  };
  const auto stretched = [](const ElementBlock& block, int e)
  { return block.volume()(e) > (1 + 1e-9) * block.referenceVolume()(e); };
  const auto damaged = [](const ElementBlock& block, int e)
  { return block.history()(block.historyRow("damage"), e) > 0.3; };
  Solver open(torn({}), comm), gated(torn(0.3), comm);
  open.prepare();
  gated.prepare();
  cycles(open, 3);
  cycles(gated, 3);
  EXPECT_EQ(open.erosion().elements, 5);
  EXPECT_EQ(gated.erosion().elements, 0);
  EXPECT_EQ(living(gated, stretched), 5);

  int n = 0;
  while (gated.erosion().elements == 0 && n++ < 2000)
    gated.advance();
  ASSERT_GT(gated.erosion().elements, 0);
  EXPECT_EQ(living(gated, [&](const ElementBlock& block, int e)
                   { return damaged(block, e) && stretched(block, e); }),
            0);
}

TEST_P(ErodingBodies, aCornerThatTurnsInsideOutKillsWithTheLimitOfVolume)
{
  // A corner of a cube flies through the opposite side of it: a point of integration turns inside
  // out while the volume is still within the limits.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "cube", {1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "other", {1, 1, 1}, {5, 0, 0}, {1, 1, 1});
  const auto struck = [&](bool limited)
  {
    Model model = rockModel(mesh, comm);
    model.blocks[0].element.form = ElementForm::FullIntegration;
    model.blocks[0].velocityField = [](const Vec3& x) {
      return x.x * x.y * x.z == 1 ? Vec3{-2000, -2000, -2000} : Vec3{};
    };
    if (limited)
      model.blocks[0].erosion.volumeRatio = {0.05, 4};
    model.time.fixedStep = 2e-5;
    model.time.end = 6e-4;
    return model;
  };
  Solver guarded(struck(true), comm), open(struck(false), comm);
  guarded.prepare();
  open.prepare();
  ASSERT_EQ(deadAfter(guarded, 30), 1);
  EXPECT_LT(norm(guarded.momenta().linearError()), 1e-12 * guarded.momenta().magnitude);
  EXPECT_LT(std::abs(guarded.energy().error()), 0.05 * guarded.energy().initial);
  for (int e = 0; e < guarded.blocks()[0].count(); ++e)
    EXPECT_GT(guarded.blocks()[0].volume()(e), 0.05);
  Recorder recorder;
  EXPECT_THROW(open.run(recorder), Error);
}

TEST_P(ErodingBodies, hasTheSameBitsOnAnyRanks)
{
  const Comm world, alone(MPI_COMM_SELF);
  for (const auto& scene : {stretchedColumn, pressed})
  {
    Solver one(scene(alone), alone), many(scene(world), world);
    one.prepare();
    many.prepare();
    EXPECT_GT(deadAfter(one, 150), 0);
    EXPECT_EQ(deadAfter(many, 150), one.erosion().elements);
    EXPECT_EQ(many.stateHash(), one.stateHash());
    EXPECT_EQ(many.energy().error(), one.energy().error());
    EXPECT_EQ(many.energy().contact.eroded, one.energy().contact.eroded);
  }
}
} // namespace coplane
