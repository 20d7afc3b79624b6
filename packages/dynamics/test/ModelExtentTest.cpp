#include "Rig.hpp"

#include <coplane_dynamics/ModelExtent.hpp>
#include <coplane_partition/Partition.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
/// Of a box of 2 x 3 x 4 m whose lowest corner lies there.
ModelExtent extentAt(const Vec3& corner)
{
  const Comm comm;
  Mesh mesh = unitBox(2, 3, 4);
  for (Vec3& x : mesh.coordinates)
    x += corner;
  return extentOf(distribute(mesh, nodeOwners(mesh, comm, "rcb"), comm.rank()), comm);
}
} // namespace

TEST(ModelExtent, isThatOfAllRanks)
{
  const ModelExtent near = extentAt({0, 0, 0}), below = extentAt({0, -70, 0});
  EXPECT_EQ(near.size, 4);
  EXPECT_EQ(near.farthest, 4);
  EXPECT_EQ(below.size, 4);
  EXPECT_EQ(below.farthest, 70);
}

TEST(ModelExtent, isFarAtMapCoordinatesOnly)
{
  EXPECT_FALSE(extentAt({1000, 0, 0}).isFarFromOrigin());
  EXPECT_TRUE(extentAt({5000, 0, 0}).isFarFromOrigin());
  EXPECT_FALSE(extentAt({5000, 0, 0}).hasFewDigits());
  const ModelExtent map = extentAt({4.5e6, -5.2e6, 300});
  EXPECT_TRUE(map.isFarFromOrigin());
  EXPECT_TRUE(map.hasFewDigits());
  EXPECT_NEAR(map.digits(), 1.2e-9, 1e-10);
}
} // namespace coplane
