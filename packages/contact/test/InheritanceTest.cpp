#include <coplane_contact/Inheritance.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
/// Face 10 slides over a surface of quadrilaterals: 21 (nodes 1 2 3 4) and, beside it, 22 (nodes 2
/// 5 6 3). Face 23 (nodes 7 8 9 10) belongs to another body.
Donor planeOf10And(GlobalId face, std::array<GlobalId, 4> nodes, Real area, Real closure)
{
  Donor donor;
  donor.faceId[0] = 10;
  donor.faceId[1] = face;
  for (int k = 0; k < 4; ++k)
  {
    donor.nodes[0][k] = 101 + k;
    donor.nodes[1][k] = nodes[k];
  }
  donor.normal = {0, 0, 1};
  donor.area = area;
  donor.closure = closure;
  donor.offset = -closure;
  return donor;
}

Plane pairOf10And22()
{
  Plane plane;
  plane.faceId[0] = 10;
  plane.faceId[1] = 22;
  return plane;
}
const PairNodes nodes{{{101, 102, 103, 104}, {2, 5, 6, 3}}};
} // namespace

TEST(Inheritance, givesTheMeansOfTheDonorsByTheirAreas)
{
  Plane plane = pairOf10And22();
  std::vector<Donor> donors{planeOf10And(23, {7, 8, 9, 10}, 1, .04),
                            planeOf10And(21, {1, 2, 3, 4}, 3, .08)};
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, donors));
  EXPECT_TRUE(plane.inherited);
  EXPECT_NEAR(plane.closure, .07, 1e-15);
  EXPECT_NEAR(plane.offset, -.07, 1e-15);
}

TEST(Inheritance, tellsTheSameSurfaceFromAnotherBody)
{
  Plane plane = pairOf10And22();
  std::vector<Donor> other{planeOf10And(23, {7, 8, 9, 10}, 1, .04)};
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, other));
  EXPECT_FALSE(plane.slidesOn);
  std::vector<Donor> beside{planeOf10And(21, {1, 2, 3, 4}, 1, .04)};
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, beside));
  EXPECT_TRUE(plane.slidesOn);
  // It has to be a donor that counts: one that looks elsewhere does not.
  beside[0].normal = {1, 0, 0};
  other.push_back(beside[0]);
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, nodes, other));
  EXPECT_FALSE(plane.slidesOn);
}

TEST(Inheritance, doesNotDependOnWhichFaceHasTheLowerId)
{
  // Face 30 slides over faces 21, where it has the higher id, and 31, where it has the lower one:
  // their normals and tractions are opposite, and so is what they hand on.
  const auto handedOn = [](GlobalId lower, GlobalId higher, Real sign)
  {
    Donor donor;
    donor.faceId[0] = lower;
    donor.faceId[1] = higher;
    donor.normal = {0, 0, sign};
    donor.shearTraction = {sign * 5e6, 0, 0};
    donor.area = 1;
    donor.closure = .04;
    Plane plane;
    plane.faceId[0] = 30;
    plane.faceId[1] = 32;
    std::vector<Donor> donors{donor};
    EXPECT_TRUE(inherit(plane, {0, 0, 1}, {}, donors)) << lower << " " << higher;
    EXPECT_NEAR(plane.closure, .04, 1e-15);
    EXPECT_NEAR(norm(plane.history.shearTraction - Vec3{5e6, 0, 0}), 0, 1e-8);
  };
  handedOn(30, 31, 1);
  handedOn(21, 30, -1);
  // A neighbour that looks the other way counts for neither.
  Donor front;
  front.faceId[0] = 21;
  front.faceId[1] = 30;
  front.normal = {0, 0, 1};
  front.area = 1;
  Plane plane;
  plane.faceId[0] = 30;
  plane.faceId[1] = 32;
  std::vector<Donor> donors{front};
  EXPECT_FALSE(inherit(plane, {0, 0, 1}, {}, donors));
}

TEST(Inheritance, facesWithoutNodesAreOnNoSurface)
{
  Plane plane = pairOf10And22();
  std::vector<Donor> donors{planeOf10And(21, {0, 0, 0, 0}, 1, .04)};
  EXPECT_TRUE(inherit(plane, {0, 0, 1}, {{{101, 102, 0, 0}, {2, 5, 0, 0}}}, donors));
  EXPECT_FALSE(plane.slidesOn);
}
} // namespace coplane
