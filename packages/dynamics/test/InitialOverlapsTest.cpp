#include "Rig.hpp"

#include <coplane_contact/InitialOverlaps.hpp>
#include <coplane_mesh/Bodies.hpp>

#include <gtest/gtest.h>

#include <cmath>

// Bodies that lie in each other before the first step: who, how deep, how much.

namespace coplane
{
namespace
{
using Change = std::function<void(Model&)>;

std::vector<InitialOverlap> overlapsOf(const Mesh& mesh, const Comm& comm,
                                       const Change& change = {},
                                       const std::string& method = "multijagged")
{
  Model model = rockModel(mesh, comm, 0, method);
  if (change)
    change(model);
  const Solver solver(std::move(model), comm);
  return initialOverlaps(solver.contact(), solver.state().x,
                         bodyLabels(solver.mesh(), std::vector<char>(mesh.blocks.size(), 1), comm));
}

void declareAll(Model& model)
{
  for (ContactRule& rule : model.contactRules.table)
    rule.declared = true;
}

void excludeAll(Model& model)
{
  for (ContactRule& rule : model.contactRules.table)
    rule.excluded = true;
}

/// A cube on a slab, `depth` in it, its mesh shifted against that of the slab.
Mesh cubeInSlab(int dimension, Real depth)
{
  Mesh mesh;
  if (dimension == 3)
  {
    addBox(mesh, "slab", {5, 5, 2}, {0, 0, 0}, {2, 2, 0.5});
    addBox(mesh, "cube", {3, 3, 3}, {0.37, 0.41, 0.5 - depth}, {1, 1, 1});
  }
  else
  {
    addRectangle(mesh, "slab", {5, 2}, {0, 0, 0}, {2, 0.5, 0});
    addRectangle(mesh, "cube", {3, 3}, {0.37, 0.5 - depth, 0}, {1, 1, 0});
  }
  return mesh;
}

/// Turns the whole mesh about an oblique axis, or in the plane.
Mesh turned(Mesh mesh)
{
  const Vec3 axis = mesh.dimension == 2 ? Vec3{0, 0, 1} : normalised(Vec3{1, 2, -0.5});
  const Real c = std::cos(0.7), s = std::sin(0.7);
  for (Vec3& x : mesh.coordinates)
    x = c * x + s * cross(axis, x) + ((1 - c) * dot(axis, x)) * axis;
  return mesh;
}
} // namespace

TEST(InitialOverlaps, areMeasuredByVolumeAndDepth)
{
  const Comm comm;
  for (const int dimension : {2, 3})
    for (const Real depth : {2e-3, 0.01, 0.1})
      for (const bool oblique : {false, true})
      {
        SCOPED_TRACE(testing::Message()
                     << dimension << "D, " << depth << " m, turned: " << oblique);
        const Mesh mesh = cubeInSlab(dimension, depth);
        const auto found = overlapsOf(oblique ? turned(mesh) : mesh, comm);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0].block[0], 0);
        EXPECT_EQ(found[0].block[1], 1);
        EXPECT_NEAR(found[0].depth, depth, 1e-9);
        // Samples of faces of the slab at the rim of the cube are in or out as a whole.
        EXPECT_NEAR(found[0].volume, depth, 0.3 * depth);
        EXPECT_GE(found[0].faces, dimension == 2 ? 3 : 9);
      }
}

TEST(InitialOverlaps, areNoneWhereFacesOnlyTouchOrRoundOffMovesThem)
{
  const Comm comm;
  for (const int dimension : {2, 3})
    for (const Real depth : {-1e-3, -1e-10, 0.0, 1e-15, 1e-9, 1e-6})
    {
      EXPECT_TRUE(overlapsOf(cubeInSlab(dimension, depth), comm).empty()) << depth;
      EXPECT_TRUE(overlapsOf(turned(cubeInSlab(dimension, depth)), comm).empty()) << depth;
    }
}

TEST(InitialOverlaps, areNoneInAWallOfBlocksWhoseFacesEdgesAndCornersMeet)
{
  const Comm comm;
  Mesh mesh;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 2; ++k)
        addBox(mesh, "b" + std::to_string(i) + std::to_string(j) + std::to_string(k), {2, 1, 2},
               {0.3 * i, 0.7 * j, 0.1 * k}, {0.3, 0.7, 0.1});
  EXPECT_TRUE(overlapsOf(mesh, comm).empty());
  EXPECT_TRUE(overlapsOf(turned(mesh), comm).empty());
}

TEST(InitialOverlaps, ofABodyThatLiesWhollyInAnother)
{
  // Its faces are farther from those of the plate than any contact is deep: step 5 sees none.
  const Comm comm;
  for (const int dimension : {2, 3})
  {
    Mesh mesh;
    if (dimension == 3)
    {
      addBox(mesh, "plate", {10, 10, 10}, {0, 0, 0}, {1, 1, 1});
      addBox(mesh, "ball", {1, 1, 1}, {0.45, 0.43, 0.35}, {0.1, 0.1, 0.1});
    }
    else
    {
      addRectangle(mesh, "plate", {10, 10}, {0, 0, 0}, {1, 1, 0});
      addRectangle(mesh, "ball", {1, 1}, {0.45, 0.35, 0}, {0.1, 0.1, 0});
    }
    const auto found = overlapsOf(mesh, comm);
    ASSERT_EQ(found.size(), 1u);
    // The centre of its lower face is nearest: to the way out, it goes down.
    EXPECT_NEAR(found[0].volume, std::pow(0.1, dimension), 1e-12) << "all of it";
    EXPECT_GT(found[0].depth, 0.4);
    EXPECT_LT(found[0].depth, 0.5);
    EXPECT_EQ(found[0].faces, dimension == 2 ? 4 : 6);
  }
}

TEST(InitialOverlaps, ofANailThroughAPlate)
{
  // No face of one opposes a near one of the other.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "plate", {6, 6, 1}, {0, 0, 0}, {1, 1, 0.1});
  addBox(mesh, "nail", {1, 1, 20}, {0.46, 0.47, -0.5}, {0.05, 0.05, 1});
  const auto found = overlapsOf(mesh, comm);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_GT(found[0].volume, 0.3 * 0.05 * 0.05 * 0.1);
  EXPECT_LT(found[0].volume, 3 * 0.05 * 0.05 * 0.1);
}

TEST(InitialOverlaps, leaveOutWhatJointsAbsorbAndWhatIsExcluded)
{
  const Comm comm;
  for (const int dimension : {2, 3})
  {
    EXPECT_TRUE(overlapsOf(cubeInSlab(dimension, 0.01), comm, declareAll).empty());
    EXPECT_TRUE(overlapsOf(cubeInSlab(dimension, 0.01), comm, excludeAll).empty());
    EXPECT_FALSE(overlapsOf(cubeInSlab(dimension, 0.2), comm, declareAll).empty())
        << "no joint is as wide as half an element";
  }
}

TEST(InitialOverlaps, areTheSameForAnyPartition)
{
  const Comm comm, alone(MPI_COMM_SELF);
  Mesh mesh = cubeInSlab(3, 0.03);
  addBox(mesh, "other", {2, 2, 2}, {1.3, 0.3, 1.2}, {0.5, 0.5, 0.5});
  const auto expected = overlapsOf(mesh, alone);
  ASSERT_EQ(expected.size(), 2u);
  for (const char* method : {"multijagged", "scattered", "last"})
  {
    const auto found = overlapsOf(mesh, comm, {}, method);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      EXPECT_EQ(found[i].block[0], expected[i].block[0]);
      EXPECT_EQ(found[i].block[1], expected[i].block[1]);
      EXPECT_EQ(found[i].faces, expected[i].faces);
      EXPECT_EQ(found[i].depth, expected[i].depth);
      EXPECT_EQ(found[i].volume, expected[i].volume);
      EXPECT_EQ(found[i].faceId[0], expected[i].faceId[0]);
      EXPECT_EQ(found[i].faceId[1], expected[i].faceId[1]);
    }
  }
}
} // namespace coplane
