#include "Rig.hpp"

#include <coplane_contact/LostContact.hpp>

#include <gtest/gtest.h>

// Bodies that lie deeper in each other than contact reaches, and nothing holds them.

namespace coplane
{
namespace
{
/// Of bodies that have only just been put there: none of their planes carries.
LostContact lostIn(const Mesh& mesh, const Comm& comm, bool excluded = false,
                   const std::string& method = "multijagged")
{
  Model model = rockModel(mesh, comm, 0, method);
  for (ContactRule& rule : model.contactRules.table)
    rule.excluded = excluded;
  Solver solver(std::move(model), comm);
  solver.prepare();
  return lostContact(solver.contact(), solver.state().x);
}

/// A cube of elements of 0.1 m in a slab of such of 0.2 m, `depth` deep.
Mesh cubeInSlab(int dimension, Real depth)
{
  Mesh mesh;
  if (dimension == 3)
  {
    addBox(mesh, "slab", {5, 5, 3}, {0, 0, 0}, {1, 1, 0.6});
    addBox(mesh, "cube", {4, 4, 4}, {0.313, 0.328, 0.6 - depth}, {0.4, 0.4, 0.4});
  }
  else
  {
    addRectangle(mesh, "slab", {5, 3}, {0, 0, 0}, {1, 0.6, 0});
    addRectangle(mesh, "cube", {4, 4}, {0.313, 0.6 - depth, 0}, {0.4, 0.4, 0});
  }
  return mesh;
}
} // namespace

TEST(LostContact, isWhereFacesLieDeeperThanContactBegins)
{
  const Comm comm;
  for (const int dimension : {2, 3})
  {
    EXPECT_EQ(lostIn(cubeInSlab(dimension, -0.05), comm).lost, 0);
    EXPECT_EQ(lostIn(cubeInSlab(dimension, 0.074), comm).lost, 0);
    EXPECT_GT(lostIn(cubeInSlab(dimension, 0.076), comm).lost, 0);
    const LostContact deep = lostIn(cubeInSlab(dimension, 0.17), comm);
    // The lower side of the cube, and the faces beside it, whose centres are 0.12 m deep.
    EXPECT_NEAR(deep.lost, dimension == 2 ? 0.4 + 2 * 0.1 : 0.16 + 4 * 0.04, 1e-12);
    EXPECT_EQ(deep.faces, dimension == 2 ? 7 : 33) << "and one of the slab, in the cube";
    EXPECT_EQ(deep.carrying, 0);
    EXPECT_NEAR(deep.depth, 0.17, 1e-9);
    EXPECT_EQ(deep.block[0] + deep.block[1], 1);
  }
}

TEST(LostContact, doesNotComeOutAtTheBackOfASlab)
{
  // The way out at the back is 0.02 m long, that at the front 0.18 m.
  const Comm comm;
  Mesh mesh;
  addRectangle(mesh, "slab", {5, 1}, {0, 0, 0}, {1, 0.2, 0});
  addRectangle(mesh, "punch", {4, 8}, {0.313, 0.02, 0}, {0.4, 0.8, 0});
  const LostContact found = lostIn(mesh, comm);
  EXPECT_NEAR(found.depth, 0.18, 1e-9);
  EXPECT_GE(found.lost, 0.4);
}

TEST(LostContact, isNoneOfBodiesThatMayLieInEachOther)
{
  const Comm comm;
  Solver solver(rockModel(cubeInSlab(3, 0.17), comm, 0, "multijagged"), comm);
  solver.prepare();
  const auto known = bodiesInEachOther(solver.contact(), solver.state().x);
  EXPECT_EQ(known.size(), 1u);
  EXPECT_EQ(bodiesInEachOther(solver.contact(), solver.state().x, {0}), known);
  EXPECT_TRUE(bodiesInEachOther(solver.contact(), solver.state().x, {2}).empty());
  EXPECT_GT(lostContact(solver.contact(), solver.state().x).lost, 0);
  EXPECT_EQ(lostContact(solver.contact(), solver.state().x, known).lost, 0);
}

TEST(LostContact, isNoneOfExcludedPairsAndOfOneBody)
{
  const Comm comm;
  EXPECT_EQ(lostIn(cubeInSlab(2, 0.17), comm, true).lost, 0);
  Mesh wall;
  for (int i = 0; i < 3; ++i)
    addBox(wall, "b" + std::to_string(i), {2, 2, 2}, {0.3 * i, 0, 0}, {0.3, 0.3, 0.3});
  EXPECT_EQ(lostIn(wall, comm).lost, 0);
}

/// A cube deep in a slab, and one that falls on it and is held.
Model lostAndHeld(const Comm& comm, const std::string& method = "multijagged")
{
  Mesh mesh = cubeInSlab(3, 0.15);
  addBox(mesh, "held", {2, 2, 2}, {0.75, 0.05, 0.601}, {0.2, 0.2, 0.2});
  Model model = rockModel(mesh, comm, 0, method);
  model.blocks[2].velocity = {0, 0, -20};
  return model;
}

TEST(LostContact, countsByPairsOfBodiesAndLeavesOutWhatIsHeld)
{
  const Comm comm;
  Solver solver(lostAndHeld(comm), comm);
  solver.prepare();
  const Real lost = lostContact(solver.contact(), solver.state().x).lost;
  EXPECT_GT(lost, 0);
  while (!(lostContact(solver.contact(), solver.state().x).carrying > 0.03))
    solver.advance();
  // The slab carries the other cube on a fourth of that area: they are no pair that is lost.
  const LostContact found = lostContact(solver.contact(), solver.state().x);
  EXPECT_NEAR(found.lost, lost, 1e-3 * lost);
  EXPECT_LT(found.carrying, 0.05);
  EXPECT_GT(found.surface, 3);
}

TEST(LostContact, isTheSameForAnyPartition)
{
  const Comm comm, alone(MPI_COMM_SELF);
  const auto find = [](const Comm& on, const std::string& method)
  {
    Solver solver(lostAndHeld(on, method), on);
    solver.prepare();
    for (int cycle = 0; cycle < 200; ++cycle)
      solver.advance();
    return lostContact(solver.contact(), solver.state().x);
  };
  const LostContact expected = find(alone, "multijagged");
  ASSERT_GT(expected.lost, 0);
  ASSERT_GT(expected.carrying, 0);
  for (const char* method : {"multijagged", "scattered", "last"})
  {
    const LostContact found = find(comm, method);
    EXPECT_EQ(found.lost, expected.lost);
    EXPECT_EQ(found.carrying, expected.carrying);
    EXPECT_EQ(found.surface, expected.surface);
    EXPECT_EQ(found.faces, expected.faces);
    EXPECT_EQ(found.depth, expected.depth);
    EXPECT_EQ(found.faceId[0], expected.faceId[0]);
    EXPECT_EQ(found.faceId[1], expected.faceId[1]);
  }
}
} // namespace coplane
