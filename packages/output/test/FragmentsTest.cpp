#include <coplane_dynamics/Solver.hpp>
#include <coplane_output/Fragments.hpp>

#include <gtest/gtest.h>

#include <BoxMesh.hpp>
#include <algorithm>

namespace coplane
{
namespace
{
/// Elastic rock of 1000 kg/m^3 on ranks to which nodes are dealt like cards.
Model rock(const Mesh& mesh, const Comm& comm)
{
  std::vector<int> owners;
  for (int n = 0; n < mesh.nodes(); ++n)
    owners.push_back(n % comm.size());
  Model model;
  model.mesh = distribute(mesh, owners, comm.rank());
  model.blocks.resize(mesh.blocks.size());
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    model.blocks[b].name = mesh.blocks[b].name;
    model.blocks[b].material = makeLinearElastic(1e9, 0.25, 1000);
  }
  model.contactRules.joints = {JointRecipe{}};
  model.contactRules.tellApart(int(mesh.blocks.size()));
  return model;
}

/// A bar of seven unit cubes along z. The third and the sixth are blocks of their own, which erode
/// as soon as they are stretched by 1e-6; cubes are numbered along z as they come in the mesh.
Model bar(const Comm& comm, Real pullAtThird, Real pullAtSixth)
{
  Mesh mesh = unitBox(1, 1, 7);
  Mesh::Block& whole = mesh.blocks[0];
  Mesh::Block cut = whole;
  cut.id = 2;
  cut.name = "cut";
  std::vector<GlobalId> ids = whole.elementIds;
  const std::vector<int> nodes = whole.connectivity;
  whole.elementIds.clear();
  whole.connectivity.clear();
  whole.bodyIds.clear();
  cut.elementIds.clear();
  cut.connectivity.clear();
  cut.bodyIds.clear();
  for (int e = 0; e < 7; ++e)
  {
    Mesh::Block& block = e == 2 || e == 5 ? cut : whole;
    block.elementIds.push_back(ids[std::size_t(e)]);
    block.bodyIds.push_back(1);
    block.connectivity.insert(block.connectivity.end(), nodes.begin() + 8 * e,
                              nodes.begin() + 8 * (e + 1));
  }
  mesh.blocks.push_back(cut);
  Model model = rock(mesh, comm);
  model.blocks[1].erosion.volumeRatio = {0.5, 1 + 1e-6};
  model.time.fixedStep = 1e-4;
  for (BlockSetup& block : model.blocks)
    block.velocityField = [=](const Vec3& x) {
      return Vec3{0, 0, (x.z > 2.5 ? pullAtThird : 0) + (x.z > 5.5 ? pullAtSixth : 0)};
    };
  return model;
}

std::vector<GlobalId> idsOf(const std::vector<Fragment>& fragments)
{
  std::vector<GlobalId> ids;
  for (const Fragment& fragment : fragments)
    ids.push_back(fragment.id);
  return ids;
}

std::vector<Fragment> fragmentsOf(const Solver& solver, Real damage = 1)
{
  return sumsOf(solver, findBodies(solver, damage));
}
} // namespace

TEST(Fragments, ofABoxThatTumblesAreThoseOfItsCornerMasses)
{
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "first", {1, 1, 1}, {10, 0, 0}, {1, 1, 1});
  addBox(mesh, "box", {2, 3, 4}, {0, 0, 0}, {1, 2, 3});
  Model model = rock(mesh, comm);
  model.blocks[1].velocity = {3, -2, 5};
  model.blocks[1].angularVelocity = {0.1, -0.2, 0.3};
  model.blocks[1].center = {0.5, 1, 1.5};
  Solver solver(std::move(model), comm);
  solver.prepare();
  const std::vector<Fragment> fragments = fragmentsOf(solver);
  if (!comm.isRoot())
  {
    EXPECT_TRUE(fragments.empty());
    return;
  }
  ASSERT_EQ(fragments.size(), 2u);
  EXPECT_EQ(fragments[0].id, 1);
  EXPECT_EQ(fragments[0].elements, 1);
  EXPECT_EQ(norm(fragments[0].spin), 0);
  const Fragment& box = fragments[1];
  EXPECT_EQ(box.id, 2); // the least of its elements
  EXPECT_EQ(box.elements, 24);
  EXPECT_NEAR(box.mass, 6000, 1e-9);
  EXPECT_LT(norm(box.center - Vec3{0.5, 1, 1.5}), 1e-14);
  EXPECT_LT(norm(box.velocity - Vec3{3, -2, 5}), 1e-13);
  EXPECT_LT(norm(box.spin - Vec3{0.1, -0.2, 0.3}), 1e-14);
  EXPECT_LT(norm(box.lowest), 1e-15);
  EXPECT_LT(norm(box.highest - Vec3{1, 2, 3}), 1e-15);
  // Nodes of n equal elements along a length L, half of a mass at the ends: the second moment is
  // m L^2 (1 / 12 + 1 / (6 n^2)).
  const auto moment = [](Real length, int n)
  { return 6000 * length * length * (1.0 / 12 + 1.0 / (6 * n * n)); };
  const Real x = moment(1, 2), y = moment(2, 3), z = moment(3, 4);
  EXPECT_NEAR(box.angularMomentum.x, 0.1 * (y + z), 1e-9);
  EXPECT_NEAR(box.angularMomentum.y, -0.2 * (z + x), 1e-9);
  EXPECT_NEAR(box.angularMomentum.z, 0.3 * (x + y), 1e-9);
}

TEST(Fragments, ofARigidBoxHaveTheMomentsOfTheSolid)
{
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "box", {2, 1, 1}, {0, 0, 0}, {1, 2, 3});
  Model model = rock(mesh, comm);
  model.blocks[0].rigid = true;
  model.rigidBodyOfNode = rigidBodiesOf(model.mesh, {1}, comm);
  model.blocks[0].angularVelocity = {0.1, -0.2, 0.3};
  model.blocks[0].center = {0.5, 1, 1.5};
  Solver solver(std::move(model), comm);
  solver.prepare();
  const std::vector<Fragment> fragments = fragmentsOf(solver);
  const Vec3 ofHistory = solver.momenta().angular;
  if (!comm.isRoot())
    return;
  ASSERT_EQ(fragments.size(), 1u);
  const Fragment& box = fragments[0];
  EXPECT_LT(norm(box.spin - Vec3{0.1, -0.2, 0.3}), 1e-14);
  const Vec3 solid{0.1 * 500 * (4 + 9), -0.2 * 500 * (9 + 1), 0.3 * 500 * (1 + 4)};
  EXPECT_LT(norm(box.angularMomentum - solid), 1e-9);
  EXPECT_LT(norm(ofHistory - solid), 1e-3 * norm(solid)); // half a step later
}

TEST(Fragments, haveNoLineForWhatAStageAdds)
{
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "first", {1, 1, 1}, {10, 0, 0}, {1, 1, 1});
  addBox(mesh, "later", {2, 1, 1}, {0, 0, 0}, {2, 1, 1});
  mesh.blocks.back().id = 2;
  Model model = rock(mesh, comm);
  model.inStages = model.blocksComeOrGo = true;
  model.absentBlocks = {1};
  Solver solver(std::move(model), comm);
  solver.prepare();
  const std::vector<Fragment> fragments = fragmentsOf(solver);
  if (!comm.isRoot())
    return;
  ASSERT_EQ(fragments.size(), 1u);
  EXPECT_EQ(fragments[0].elements, 1);
  EXPECT_EQ(fragments[0].mass, 1000);
}

TEST(Fragments, keepTheirIdsWhenTheBodySplitsAgain)
{
  // The third cube dies at once, the sixth, which is pulled slowly, later: what is left of a body
  // keeps the id of its least element, and nothing that has an id gets another.
  const Comm comm;
  Solver solver(bar(comm, 10, 4e-3), comm);
  solver.prepare();
  std::vector<std::vector<GlobalId>> seen{{1}};
  const auto look = [&]
  {
    const std::vector<GlobalId> ids = idsOf(fragmentsOf(solver));
    if (comm.isRoot() && ids != seen.back())
      seen.push_back(ids);
  };
  look();
  for (int n = 0; n < 60; ++n)
  {
    solver.advance();
    look();
  }
  ASSERT_EQ(solver.erosion().elements, 2);
  if (!comm.isRoot())
    return;
  const std::vector<std::vector<GlobalId>> expected{{1}, {0, 1, 4}, {0, 1, 4, 7}};
  EXPECT_EQ(seen, expected);
}

TEST(Fragments, haveAllMassAndMomentumAndWhatIsDead)
{
  const Comm comm;
  Solver solver(bar(comm, 10, 10), comm);
  solver.prepare();
  for (int n = 0; n < 5; ++n)
    solver.advance();
  const std::vector<Fragment> fragments = fragmentsOf(solver);
  const Momenta momenta = solver.momenta();
  if (!comm.isRoot())
    return;
  const std::vector<GlobalId> expected{0, 1, 4, 7};
  ASSERT_EQ(idsOf(fragments), expected);
  const Real masses[] = {2000, 2000, 2000, 1000};
  Real momentum = 0;
  for (std::size_t i = 0; i < 4; ++i)
  {
    EXPECT_NEAR(fragments[i].mass, masses[i], 1e-10);
    momentum += fragments[i].mass * fragments[i].velocity.z;
  }
  EXPECT_NEAR(momentum, momenta.linear.z, 1e-11 * momenta.magnitude);
}

TEST(Fragments, areTheSameOnAnyRanks)
{
  const Comm world, alone(MPI_COMM_SELF);
  Solver one(bar(alone, 10, 0), alone), many(bar(world, 10, 0), world);
  one.prepare();
  many.prepare();
  for (int n = 0; n < 40; ++n)
  {
    one.advance();
    many.advance();
    const std::vector<Fragment> whole = fragmentsOf(one), dealt = fragmentsOf(many);
    if (!world.isRoot())
      continue;
    ASSERT_EQ(idsOf(dealt), idsOf(whole));
    for (std::size_t i = 0; i < whole.size(); ++i)
    {
      EXPECT_EQ(dealt[i].elements, whole[i].elements);
      EXPECT_EQ(dealt[i].mass, whole[i].mass);
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_EQ(dealt[i].velocity[c], whole[i].velocity[c]);
        EXPECT_EQ(dealt[i].center[c], whole[i].center[c]);
        EXPECT_EQ(dealt[i].spin[c], whole[i].spin[c]);
        EXPECT_EQ(dealt[i].highest[c], whole[i].highest[c]);
      }
    }
  }
}

TEST(Fragments, joinAndPartWithTheBondOfADeclaredJoint)
{
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "low", {1, 1, 2}, {0, 0, 0}, {1, 1, 2});
  addBox(mesh, "high", {1, 1, 2}, {0, 0, 2}, {1, 1, 2});
  for (const bool bonded : {true, false})
  {
    Model model = rock(mesh, comm);
    for (ContactRule& rule : model.contactRules.table)
      rule.declared = true;
    model.contactRules.joints[0].law.penalty = false;
    model.contactRules.joints[0].law.initialStiffness = 1e10;
    if (bonded)
      model.contactRules.joints[0].law.bond =
          Bond::softening(Bond::Kind::Exponential, 1e5, 1e5, 1, 1);
    model.blocks[1].velocity = {0, 0, 1};
    Solver solver(std::move(model), comm);
    solver.prepare();
    const std::vector<GlobalId> first = idsOf(fragmentsOf(solver));
    for (int n = 0; n < 60; ++n)
      solver.advance();
    const std::vector<GlobalId> last = idsOf(fragmentsOf(solver));
    if (!comm.isRoot())
      continue;
    const std::vector<GlobalId> one{1}, two{1, 3};
    EXPECT_EQ(first, bonded ? one : two);
    EXPECT_EQ(last, two);
  }
}
} // namespace coplane
