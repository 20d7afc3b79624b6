#include <coplane_core/Vec3.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <gtest/gtest.h>

#include <set>

namespace coplane
{
namespace
{
// Corners of the element [-1, 1]^d in the node order of Exodus II.
const Vec3 hexCorners[] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                           {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
const Vec3 quadCorners[] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
} // namespace

TEST(Hex8, everySideHasItsOutwardNormalByTheRightHandRule)
{
  // Sides 1 to 6 of the Exodus manual look to -y, +x, +y, -x, -z, +z.
  const Vec3 outward[] = {{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, -1}, {0, 0, 1}};
  const ElementTopology& hex = topology(ElementType::Hex8);
  for (int s = 0; s < hex.sides; ++s)
  {
    const auto& k = hex.sideNodes[s];
    // Half the cross product of the diagonals is the vector area: 2 x 2 = 4 times the normal.
    const Vec3 area =
        0.5 * cross(hexCorners[k[2]] - hexCorners[k[0]], hexCorners[k[3]] - hexCorners[k[1]]);
    for (int c = 0; c < 3; ++c)
    {
      EXPECT_EQ(area[c], 4 * outward[s][c]) << "side " << s + 1;
      Real center = 0;
      for (int i = 0; i < 4; ++i)
        center += 0.25 * hexCorners[k[i]][c];
      EXPECT_EQ(center, outward[s][c]) << "side " << s + 1;
    }
  }
}

TEST(Quad4, everySideHasItsOutwardNormalToTheRightOfItsDirection)
{
  const Vec3 outward[] = {{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  const ElementTopology& quad = topology(ElementType::Quad4);
  for (int s = 0; s < quad.sides; ++s)
  {
    const Vec3 a = quadCorners[quad.sideNodes[s][0]], b = quadCorners[quad.sideNodes[s][1]];
    // (dx, dy) turned clockwise by a right angle is (dy, -dx), of length 2.
    EXPECT_EQ(b.y - a.y, 2 * outward[s].x) << "side " << s + 1;
    EXPECT_EQ(a.x - b.x, 2 * outward[s].y) << "side " << s + 1;
    EXPECT_EQ(0.5 * (a.x + b.x), outward[s].x) << "side " << s + 1;
    EXPECT_EQ(0.5 * (a.y + b.y), outward[s].y) << "side " << s + 1;
  }
}

TEST(Tri3, everySideHasItsOutwardNormalToTheRightOfItsDirection)
{
  // Sides 1 to 3 of the Exodus manual join nodes 1-2, 2-3, 3-1.
  const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Vec3 outward[] = {{0, -1, 0}, {1, 1, 0}, {-1, 0, 0}}; // times the length
  const ElementTopology& triangle = topology(ElementType::Tri3);
  ASSERT_EQ(triangle.sides, 3);
  for (int s = 0; s < triangle.sides; ++s)
  {
    EXPECT_EQ(triangle.sideNodes[s][0], s);
    const Vec3 a = corners[triangle.sideNodes[s][0]], b = corners[triangle.sideNodes[s][1]];
    EXPECT_EQ(b.y - a.y, outward[s].x) << "side " << s + 1;
    EXPECT_EQ(a.x - b.x, outward[s].y) << "side " << s + 1;
  }
}

TEST(Tet4, everySideHasItsOutwardNormalByTheRightHandRule)
{
  // Sides 1 to 4 of the Exodus manual: nodes 1-2-4, 2-3-4, 1-4-3, 1-3-2.
  const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::set<int> nodes[] = {{0, 1, 3}, {1, 2, 3}, {0, 2, 3}, {0, 1, 2}};
  const Vec3 outward[] = {{0, -1, 0}, {1, 1, 1}, {-1, 0, 0}, {0, 0, -1}}; // times twice the area
  const ElementTopology& tet = topology(ElementType::Tet4);
  ASSERT_EQ(tet.sides, 4);
  for (int s = 0; s < tet.sides; ++s)
  {
    const auto& k = tet.sideNodes[s];
    EXPECT_EQ(std::set<int>({k[0], k[1], k[2]}), nodes[s]) << "side " << s + 1;
    const Vec3 area = cross(corners[k[1]] - corners[k[0]], corners[k[2]] - corners[k[0]]);
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(area[c], outward[s][c]) << "side " << s + 1;
  }
}

TEST(FaceId, tellsElementAndSide)
{
  std::set<GlobalId> seen;
  for (GlobalId element = 1; element <= 5; ++element)
    for (int side = 0; side < 6; ++side)
    {
      const GlobalId id = faceId(element, side);
      EXPECT_EQ(elementOfFace(id), element);
      EXPECT_EQ(sideOfFace(id), side);
      EXPECT_TRUE(seen.insert(id).second);
    }
}
} // namespace coplane
