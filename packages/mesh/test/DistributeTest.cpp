#include "BoxMesh.hpp"

#include <coplane_mesh/Distribute.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace coplane
{
namespace
{
/// Two blocks, ids against the order of the file, a node set over both and a side set on one.
Mesh twoBlocks()
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

/// Calls check(part, owners, rank) for every rank of 1 to 5, of parts cut out of the whole mesh:
/// this program can play all ranks.
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

TEST(PartOfWholeMesh, aRankHoldsTheElementsThatTouchItsNodesAndNoOthers)
{
  const Mesh mesh = twoBlocks();
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

TEST(PartOfWholeMesh, everyElementIsOwnedByTheOwnerOfItsLowestNodeId)
{
  const Mesh mesh = twoBlocks();
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

TEST(PartOfWholeMesh, ownedNodesComeFirstInTheOrderOfTheFile)
{
  const Mesh mesh = twoBlocks();
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

TEST(PartOfWholeMesh, elementsKeepTheirNodesPositionsAndBodies)
{
  const Mesh mesh = twoBlocks();
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

TEST(PartOfWholeMesh, nodeSetsCoverEachNodeOnceOverAllRanks)
{
  const Mesh mesh = twoBlocks();
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

TEST(PartOfWholeMesh, sideSetsListTheSidesOfAllHeldElements)
{
  const Mesh mesh = twoBlocks();
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

TEST(PartOfWholeMesh, aRankWithoutNodesHasAllBlocksAndSetsButNothingInThem)
{
  const Mesh mesh = twoBlocks();
  const RankMesh part = distribute(mesh, std::vector<int>(mesh.nodes(), 0), 1);
  EXPECT_EQ(part.nodes(), 0);
  ASSERT_EQ(part.blocks.size(), 2u);
  EXPECT_EQ(part.blocks[0].elements() + part.blocks[1].elements(), 0);
  ASSERT_EQ(part.nodeSets.size(), 1u);
  EXPECT_TRUE(part.nodeSets[0].empty());
  ASSERT_EQ(part.sideSets.size(), 1u);
  EXPECT_TRUE(part.sideSets[0].empty());
}

namespace
{
void expectSame(const RankMesh& a, const RankMesh& b)
{
  EXPECT_EQ(a.dimension, b.dimension);
  EXPECT_EQ(a.ownedNodes, b.ownedNodes);
  EXPECT_EQ(a.nodeIds, b.nodeIds);
  EXPECT_EQ(a.nodePositions, b.nodePositions);
  EXPECT_EQ(a.ownersOfOthers, b.ownersOfOthers);
  ASSERT_EQ(a.coordinates.size(), b.coordinates.size());
  for (std::size_t n = 0; n < a.coordinates.size(); ++n)
    EXPECT_EQ(norm(a.coordinates[n] - b.coordinates[n]), 0);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t k = 0; k < a.blocks.size(); ++k)
  {
    EXPECT_EQ(a.blocks[k].meshBlock, b.blocks[k].meshBlock);
    EXPECT_EQ(a.blocks[k].id, b.blocks[k].id);
    EXPECT_EQ(a.blocks[k].type, b.blocks[k].type);
    EXPECT_EQ(a.blocks[k].elementIds, b.blocks[k].elementIds);
    EXPECT_EQ(a.blocks[k].positions, b.blocks[k].positions);
    EXPECT_EQ(a.blocks[k].connectivity, b.blocks[k].connectivity);
    EXPECT_EQ(a.blocks[k].bodyIds, b.blocks[k].bodyIds);
    EXPECT_EQ(a.blocks[k].owned, b.blocks[k].owned);
  }
  EXPECT_EQ(a.nodeSets, b.nodeSets);
  ASSERT_EQ(a.sideSets.size(), b.sideSets.size());
  for (std::size_t s = 0; s < a.sideSets.size(); ++s)
  {
    ASSERT_EQ(a.sideSets[s].size(), b.sideSets[s].size());
    for (std::size_t i = 0; i < a.sideSets[s].size(); ++i)
    {
      EXPECT_EQ(a.sideSets[s][i].block, b.sideSets[s][i].block);
      EXPECT_EQ(a.sideSets[s][i].element, b.sideSets[s][i].element);
      EXPECT_EQ(a.sideSets[s][i].side, b.sideSets[s][i].side);
      EXPECT_EQ(a.sideSets[s][i].position, b.sideSets[s][i].position);
    }
  }
}

/// A set whose entries stand in no order, over both blocks.
Mesh shuffledSample()
{
  Mesh mesh = twoBlocks();
  Mesh::SideSet mixed{2, "mixed", {}, {}};
  for (int i = 0; i < mesh.elements(); ++i)
  {
    mixed.elements.push_back(i * 5 % mesh.elements()); // 16 elements: each once
    mixed.sides.push_back(i % 6);
  }
  mesh.sideSets.push_back(mixed);
  std::reverse(mesh.nodeSets[0].nodes.begin(), mesh.nodeSets[0].nodes.end());
  return mesh;
}
} // namespace

TEST(Distribute, bringsFromSlicesWhatIsCutOutOfTheWholeMesh)
{
  const Comm comm;
  const Mesh mesh = shuffledSample();
  ASSERT_EQ(mesh.elements(), 16);
  const MeshSlice slice = sliceOf(mesh, comm);
  const std::vector<int> last(mesh.nodes(), comm.size() - 1); // the others have nothing
  std::vector<int> inOrder(mesh.nodes());
  for (int n = 0; n < mesh.nodes(); ++n)
    inOrder[n] = n * comm.size() / mesh.nodes();
  for (const std::vector<int>& owners :
       {scatteredOwners(mesh, comm.size()), last, inOrder, nodeOwners(mesh, comm, "rcb")})
  {
    const auto first = owners.begin() + slice.nodeRange().first;
    const std::vector<int> ofSlice(first, first + slice.nodeRange().count);
    expectSame(distribute(slice, ofSlice, comm), distribute(mesh, owners, comm.rank()));
  }
}

TEST(Distribute, atHomeARankOwnsItsSlice)
{
  const Comm comm;
  const Mesh mesh = shuffledSample();
  std::vector<int> owners(mesh.nodes());
  for (int n = 0; n < mesh.nodes(); ++n)
    owners[n] = rankOfItem(n, mesh.nodes(), comm.size());
  expectSame(partAtHome(sliceOf(mesh, comm), comm), distribute(mesh, owners, comm.rank()));
}

TEST(Distribute, ofAMeshWithoutAnythingIsNothing)
{
  const Comm comm;
  EXPECT_EQ(partAtHome(sliceOf(Mesh{}, comm), comm).nodes(), 0);
}
} // namespace coplane
