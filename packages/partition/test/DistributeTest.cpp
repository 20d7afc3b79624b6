#include <coplane_partition/Partition.hpp>

#include <gtest/gtest.h>

#include <BoxMesh.hpp>
#include <algorithm>
#include <map>
#include <set>

namespace coplane
{
namespace
{
/// Two blocks, ids against the order of the file, a node set over both and a side set on one.
Mesh sample()
{
  Mesh mesh;
  addBox(mesh, "a", {3, 2, 2}, {0, 0, 0}, {3, 2, 2});
  addBox(mesh, "b", {2, 2, 1}, {0, 0, 2}, {2, 2, 1});
  std::reverse(mesh.nodeIds.begin(), mesh.nodeIds.end());
  Mesh::NodeSet low{1, "low", {}};
  for (int n = 0; n < mesh.nodes(); ++n)
    if (mesh.coordinates[n].x == 0)
      low.nodes.push_back(n);
  mesh.nodeSets.push_back(low);
  Mesh::SideSet top{1, "top", {}, {}};
  for (int e = 12; e < mesh.elements(); ++e) // elements of b
  {
    top.elements.push_back(e);
    top.sides.push_back(5);
  }
  mesh.sideSets.push_back(top);
  return mesh;
}

/// Calls check(part, owners, rank) for every rank of 1 to 5. distribute() is a pure function, so
/// this program can play them all.
template <class Check>
void forEachRank(const Mesh& mesh, const Check& check)
{
  for (int ranks = 1; ranks <= 5; ++ranks)
  {
    const std::vector<int> owners = scatteredOwners(mesh, ranks);
    for (int rank = 0; rank < ranks; ++rank)
      check(distribute(mesh, owners, rank), owners, rank);
  }
}
} // namespace

TEST(Distribute, aRankHoldsTheElementsThatTouchItsNodesAndNoOthers)
{
  const Mesh mesh = sample();
  forEachRank(mesh,
              [&](const RankMesh& part, const std::vector<int>& owners, int rank)
              {
                for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
                {
                  const Mesh::Block& block = mesh.blocks[b];
                  std::vector<GlobalId> expected;
                  for (int e = 0; e < block.elements(); ++e)
                    if (std::any_of(&block.connectivity[8 * e], &block.connectivity[8 * e] + 8,
                                    [&](int n) { return owners[n] == rank; }))
                      expected.push_back(block.elementIds[e]);
                  EXPECT_EQ(part.blocks[b].elementIds, expected);
                }
              });
}

TEST(Distribute, everyElementIsOwnedByTheOwnerOfItsLowestNodeId)
{
  const Mesh mesh = sample();
  for (int ranks = 1; ranks <= 5; ++ranks)
  {
    const std::vector<int> owners = scatteredOwners(mesh, ranks);
    std::map<GlobalId, int> times;
    for (int rank = 0; rank < ranks; ++rank)
    {
      const RankMesh part = distribute(mesh, owners, rank);
      for (const RankMesh::Block& block : part.blocks)
        for (int e = 0; e < block.elements(); ++e)
        {
          times[block.elementIds[e]] += block.owned[e];
          if (!block.owned[e])
            continue;
          const int* corners = &block.connectivity[8 * e];
          const int lowest =
              *std::min_element(corners, corners + 8,
                                [&](int a, int c) { return part.nodeIds[a] < part.nodeIds[c]; });
          EXPECT_LT(lowest, part.ownedNodes);
        }
    }
    EXPECT_EQ(int(times.size()), mesh.elements());
    for (const auto& [id, n] : times)
      EXPECT_EQ(n, 1) << "element " << id << " on " << ranks << " ranks";
  }
}

TEST(Distribute, ownedNodesComeFirstInTheOrderOfTheFile)
{
  const Mesh mesh = sample();
  forEachRank(
      mesh,
      [&](const RankMesh& part, const std::vector<int>& owners, int rank)
      {
        std::vector<int> expected;
        for (int n = 0; n < mesh.nodes(); ++n)
          if (owners[n] == rank)
            expected.push_back(n);
        ASSERT_EQ(part.ownedNodes, int(expected.size()));
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), part.nodePositions.begin()));
        EXPECT_EQ(std::set<int>(part.nodePositions.begin(), part.nodePositions.end()).size(),
                  part.nodePositions.size());
      });
}

TEST(Distribute, elementsKeepTheirNodesPositionsAndBodies)
{
  const Mesh mesh = sample();
  forEachRank(mesh,
              [&](const RankMesh& part, const std::vector<int>&, int)
              {
                for (int n = 0; n < part.nodes(); ++n)
                {
                  const int position = part.nodePositions[n];
                  EXPECT_EQ(part.nodeIds[n], mesh.nodeIds[position]);
                  EXPECT_EQ(norm(part.coordinates[n] - mesh.coordinates[position]), 0);
                }
                for (const RankMesh::Block& block : part.blocks)
                  for (int e = 0; e < block.elements(); ++e)
                  {
                    const Mesh::Block& file = mesh.blocks[block.meshBlock];
                    const int position = block.positions[e];
                    EXPECT_EQ(block.elementIds[e], file.elementIds[position]);
                    EXPECT_EQ(block.bodyIds[e], file.bodyIds[position]);
                    for (int k = 0; k < 8; ++k)
                      EXPECT_EQ(part.nodePositions[block.connectivity[8 * e + k]],
                                file.connectivity[8 * position + k]);
                  }
              });
}

TEST(Distribute, nodeSetsCoverEachNodeOnceOverAllRanks)
{
  const Mesh mesh = sample();
  for (int ranks = 1; ranks <= 5; ++ranks)
  {
    const std::vector<int> owners = scatteredOwners(mesh, ranks);
    std::vector<int> united;
    for (int rank = 0; rank < ranks; ++rank)
    {
      const RankMesh part = distribute(mesh, owners, rank);
      ASSERT_EQ(part.nodeSets.size(), 1u);
      for (const int n : part.nodeSets[0])
      {
        EXPECT_LT(n, part.ownedNodes);
        united.push_back(part.nodePositions[n]);
      }
    }
    std::sort(united.begin(), united.end());
    EXPECT_EQ(united, mesh.nodeSets[0].nodes);
  }
}

TEST(Distribute, sideSetsListTheSidesOfAllHeldElements)
{
  const Mesh mesh = sample();
  forEachRank(mesh,
              [&](const RankMesh& part, const std::vector<int>&, int)
              {
                ASSERT_EQ(part.sideSets.size(), 1u);
                std::vector<GlobalId> listed;
                for (const RankMesh::Side& side : part.sideSets[0])
                {
                  EXPECT_EQ(side.block, 1);
                  EXPECT_EQ(side.side, 5);
                  listed.push_back(part.blocks[side.block].elementIds[side.element]);
                }
                EXPECT_EQ(listed, part.blocks[1].elementIds); // the set is the top of all of b
              });
}

TEST(Distribute, aRankWithoutNodesHasAllBlocksAndSetsButNothingInThem)
{
  const Mesh mesh = sample();
  const RankMesh part = distribute(mesh, std::vector<int>(mesh.nodes(), 0), 1);
  EXPECT_EQ(part.nodes(), 0);
  ASSERT_EQ(part.blocks.size(), 2u);
  EXPECT_EQ(part.blocks[0].elements() + part.blocks[1].elements(), 0);
  ASSERT_EQ(part.nodeSets.size(), 1u);
  EXPECT_TRUE(part.nodeSets[0].empty());
  ASSERT_EQ(part.sideSets.size(), 1u);
  EXPECT_TRUE(part.sideSets[0].empty());
}
} // namespace coplane
