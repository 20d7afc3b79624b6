#include "BoxMesh.hpp"

#include <coplane_mesh/RankMesh.hpp>
#include <coplane_partition/Partition.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace coplane
{
namespace
{
std::vector<ExteriorFace> serialFaces(const Mesh& mesh)
{
  return exteriorFaces(distribute(mesh, std::vector<int>(mesh.nodes(), 0), 0));
}

std::vector<GlobalId> idsOf(const std::vector<ExteriorFace>& faces)
{
  std::vector<GlobalId> ids;
  for (const ExteriorFace& face : faces)
    ids.push_back(face.id);
  return ids;
}
} // namespace

TEST(ExteriorFaces, twoHexahedraShareOneOfTheirTwelveSides)
{
  // Sides counted from 0: +x of element 1 is side 1, -x of element 2 is side 3; both are interior.
  const std::vector<ExteriorFace> faces = serialFaces(unitBox(2, 1, 1));
  const std::vector<GlobalId> expected{faceId(1, 0), faceId(1, 2), faceId(1, 3), faceId(1, 4),
                                       faceId(1, 5), faceId(2, 0), faceId(2, 1), faceId(2, 2),
                                       faceId(2, 4), faceId(2, 5)};
  EXPECT_EQ(idsOf(faces), expected);
}

TEST(ExteriorFaces, bodiesWithNodesOfTheirOwnKeepTheFacesWithWhichTheyTouch)
{
  Mesh mesh;
  addBox(mesh, "left", {1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "right", {1, 1, 1}, {1, 0, 0}, {1, 1, 1});
  EXPECT_EQ(serialFaces(mesh).size(), 12u);
}

TEST(ExteriorFaces, twoQuadrilateralsShareOneOfTheirEightSides)
{
  Mesh mesh;
  addRectangle(mesh, "pair", {2, 1}, {0, 0, 0}, {2, 1, 0});
  const std::vector<GlobalId> expected{faceId(1, 0), faceId(1, 2), faceId(1, 3),
                                       faceId(2, 0), faceId(2, 1), faceId(2, 2)};
  EXPECT_EQ(idsOf(serialFaces(mesh)), expected);
}

TEST(ExteriorFaces, blocksThatShareNodesHaveNoFaceBetweenThem)
{
  Mesh mesh = unitBox(2, 1, 1);
  Mesh::Block second = mesh.blocks[0];
  mesh.blocks[0].elementIds.resize(1);
  mesh.blocks[0].bodyIds.resize(1);
  mesh.blocks[0].connectivity.resize(8);
  second.elementIds = {2};
  second.bodyIds = {2};
  second.connectivity.erase(second.connectivity.begin(), second.connectivity.begin() + 8);
  mesh.blocks.push_back(second);
  EXPECT_EQ(serialFaces(mesh).size(), 10u);
}

TEST(ExteriorFaces, normalsOfAConvexBodyPointAwayFromItsCenterAndCloseItsSurface)
{
  const Mesh mesh = unitBox(2, 3, 2);
  const Vec3 center{1, 1.5, 1};
  Vec3 sum{};
  Real area = 0;
  for (const ExteriorFace& face : serialFaces(mesh))
  {
    ASSERT_EQ(face.nodeCount, 4);
    Vec3 corners[4], middle{};
    for (int k = 0; k < 4; ++k)
    {
      corners[k] = mesh.coordinates[face.nodes[k]];
      middle += 0.25 * corners[k];
    }
    const Vec3 normal = 0.5 * cross(corners[2] - corners[0], corners[3] - corners[1]);
    EXPECT_GT(dot(normal, middle - center), 0) << "face " << face.id;
    sum += normal;
    area += norm(normal);
  }
  EXPECT_EQ(norm(sum), 0);          // small integers and halves: exact
  EXPECT_EQ(area, 2 * (6 + 4 + 6)); // surface of a 2 x 3 x 2 box
}

TEST(ExteriorFaces, localFacesAreThoseWithANodeOwnedHere)
{
  // distribute() is a pure function, so this program can play any rank of any number.
  const Mesh mesh = unitBox(3, 2, 2);
  const std::vector<ExteriorFace> all = serialFaces(mesh);
  for (int ranks = 2; ranks <= 5; ++ranks)
  {
    const std::vector<int> owners = scatteredOwners(mesh, ranks);
    for (int rank = 0; rank < ranks; ++rank)
    {
      std::vector<GlobalId> expected;
      for (const ExteriorFace& face : all) // serial local numbers are positions in the file
        if (std::any_of(face.nodes.begin(), face.nodes.end(),
                        [&](int n) { return owners[n] == rank; }))
          expected.push_back(face.id);
      EXPECT_EQ(idsOf(exteriorFaces(distribute(mesh, owners, rank))), expected);
    }
  }
}

TEST(ExteriorFaces, ownedOnesOfAllRanksTogetherAreTheSerialList)
{
  Mesh mesh = unitBox(3, 2, 2);
  addBox(mesh, "other", {2, 2, 2}, {3, 0, 0}, {2, 2, 2});
  // Ids against the order of the file, so that "lowest id" is not "first in the file".
  std::reverse(mesh.nodeIds.begin(), mesh.nodeIds.end());
  const std::vector<GlobalId> serial = idsOf(serialFaces(mesh));
  for (int ranks = 1; ranks <= 5; ++ranks)
  {
    const std::vector<int> owners = scatteredOwners(mesh, ranks);
    std::vector<GlobalId> united;
    for (int rank = 0; rank < ranks; ++rank)
      for (const ExteriorFace& face : exteriorFaces(distribute(mesh, owners, rank)))
        if (face.ownedHere)
          united.push_back(face.id);
    std::sort(united.begin(), united.end());
    EXPECT_EQ(united, serial) << ranks << " ranks"; // a face that two ranks own would be doubled
  }
}

TEST(ExteriorFaces, cornersHaveTheSameOrderOnEveryRankThatHoldsTheFace)
{
  const Mesh mesh = unitBox(3, 2, 2);
  const std::vector<int> owners = scatteredOwners(mesh, 3);
  std::map<GlobalId, std::array<GlobalId, 4>> seen;
  for (int rank = 0; rank < 3; ++rank)
  {
    const RankMesh part = distribute(mesh, owners, rank);
    for (const ExteriorFace& face : exteriorFaces(part))
    {
      std::array<GlobalId, 4> ids{};
      for (int k = 0; k < 4; ++k)
        ids[k] = part.nodeIds[face.nodes[k]];
      EXPECT_EQ(seen.emplace(face.id, ids).first->second, ids);
      EXPECT_EQ(part.blocks[face.block].elementIds[face.element], elementOfFace(face.id));
      EXPECT_EQ(face.side, sideOfFace(face.id));
    }
  }
}
} // namespace coplane
