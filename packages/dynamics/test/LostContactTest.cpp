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

TEST(LostContact, isWhereFacesLieDeeperThanTheThinnerElement)
{
  const Comm comm;
  for (const int dimension : {2, 3})
  {
    EXPECT_EQ(lostIn(cubeInSlab(dimension, -0.05), comm).lost, 0);
    EXPECT_EQ(lostIn(cubeInSlab(dimension, 0.09), comm).lost, 0);
    const LostContact deep = lostIn(cubeInSlab(dimension, 0.17), comm);
    // The lower side of the cube; the faces beside it are out by 0.12 m at their centres, and lost
    // too, as their way out is up.
    EXPECT_NEAR(deep.lost, dimension == 2 ? 0.4 + 2 * 0.1 : 0.16 + 4 * 0.04, 1e-12);
    EXPECT_EQ(deep.faces, dimension == 2 ? 7 : 33) << "and one of the slab, in the cube";
    EXPECT_EQ(deep.carrying, 0);
    EXPECT_NEAR(deep.depth, 0.17, 1e-9);
    EXPECT_EQ(deep.block[0] + deep.block[1], 1);
  }
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

TEST(LostContact, isTheSameForAnyPartition)
{
  const Comm comm, alone(MPI_COMM_SELF);
  Mesh mesh = cubeInSlab(3, 0.15);
  addBox(mesh, "other", {2, 2, 2}, {0.613, 0.313, 0.3}, {0.2, 0.2, 0.2});
  const LostContact expected = lostIn(mesh, alone);
  ASSERT_GT(expected.lost, 0);
  for (const char* method : {"multijagged", "scattered", "last"})
  {
    const LostContact found = lostIn(mesh, comm, false, method);
    EXPECT_EQ(found.lost, expected.lost);
    EXPECT_EQ(found.faces, expected.faces);
    EXPECT_EQ(found.depth, expected.depth);
    EXPECT_EQ(found.faceId[0], expected.faceId[0]);
    EXPECT_EQ(found.faceId[1], expected.faceId[1]);
  }
}
} // namespace coplane
