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

namespace
{
/// Marks of the living elements of a rank's part; `dead`: ids.
std::vector<std::vector<char>> aliveWithout(const RankMesh& part, const std::vector<GlobalId>& dead)
{
  std::vector<std::vector<char>> alive;
  for (const RankMesh::Block& block : part.blocks)
  {
    alive.emplace_back();
    for (const GlobalId id : block.elementIds)
      alive.back().push_back(std::find(dead.begin(), dead.end(), id) == dead.end());
  }
  return alive;
}
} // namespace

TEST(ElementSides, aCubeOf27ThatLosesItsMiddleGetsSixFacesAroundTheHole)
{
  // Elements count along x, then y, then z: 14 is the middle, its neighbours are 13, 15 (x), 11, 17
  // (y) and 5, 23 (z). Sides of a hexahedron: 0 is -y, 1 +x, 2 +y, 3 -x, 4 -z, 5 +z.
  const RankMesh part = distribute(unitBox(3, 3, 3), std::vector<int>(64, 0), 0);
  const std::vector<ExteriorFace> before = exteriorFaces(part);
  const std::vector<ExteriorFace> after = ElementSides(part).exterior(aliveWithout(part, {14}));
  std::vector<GlobalId> expected = idsOf(before);
  ASSERT_EQ(expected.size(), 54u);
  for (const GlobalId id :
       {faceId(13, 1), faceId(15, 3), faceId(11, 2), faceId(17, 0), faceId(5, 5), faceId(23, 4)})
    expected.push_back(id);
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(idsOf(after), expected);
  // Normals of the new faces point into the hole, whose middle is (1.5, 1.5, 1.5).
  for (const ExteriorFace& face : after)
    if (std::none_of(before.begin(), before.end(), [&](const auto& f) { return f.id == face.id; }))
    {
      Vec3 x[4], middle{};
      for (int k = 0; k < 4; ++k)
      {
        x[k] = part.coordinates[face.nodes[k]];
        middle += 0.25 * x[k];
      }
      const Vec3 normal = 0.5 * cross(x[2] - x[0], x[3] - x[1]);
      EXPECT_EQ(norm(normal - 2.0 * (Vec3{1.5, 1.5, 1.5} - middle)), 0) << "face " << face.id;
    }
}

TEST(ElementSides, facesKeepTheirIdsAsMoreElementsDieAndGoWithTheirElement)
{
  const RankMesh part = distribute(unitBox(3, 3, 3), std::vector<int>(64, 0), 0);
  const ElementSides sides(part);
  // A tunnel from the middle to +x: 13 more faces than sides that go: 4 around each of the two, the
  // bottom at element 13, less the outer face of 15.
  const std::vector<GlobalId> ids = idsOf(sides.exterior(aliveWithout(part, {14, 15})));
  EXPECT_EQ(ids.size(), 54u + 9 - 1);
  for (const GlobalId id : ids)
    EXPECT_TRUE(elementOfFace(id) != 14 && elementOfFace(id) != 15);
  EXPECT_EQ(sides.exterior(aliveWithout(part, {})).size(), 54u);
}

TEST(ElementSides, everyRankFindsItsOwnPartOfTheNewFaces)
{
  const Mesh mesh = unitBox(3, 3, 3);
  const std::vector<GlobalId> dead{5, 14, 15, 27};
  const RankMesh whole = distribute(mesh, std::vector<int>(mesh.nodes(), 0), 0);
  const std::vector<ExteriorFace> all = ElementSides(whole).exterior(aliveWithout(whole, dead));
  for (int ranks = 2; ranks <= 5; ++ranks)
  {
    const std::vector<int> owners = scatteredOwners(mesh, ranks);
    std::vector<GlobalId> united;
    for (int rank = 0; rank < ranks; ++rank)
    {
      std::vector<GlobalId> expected;
      for (const ExteriorFace& face : all)
        if (std::any_of(face.nodes.begin(), face.nodes.end(),
                        [&](int n) { return owners[n] == rank; }))
          expected.push_back(face.id);
      const RankMesh part = distribute(mesh, owners, rank);
      const auto found = ElementSides(part).exterior(aliveWithout(part, dead));
      EXPECT_EQ(idsOf(found), expected);
      for (const ExteriorFace& face : found)
        if (face.ownedHere)
          united.push_back(face.id);
    }
    std::sort(united.begin(), united.end());
    EXPECT_EQ(united, idsOf(all));
  }
}
} // namespace coplane
