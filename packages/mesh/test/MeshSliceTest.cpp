#include "BoxMesh.hpp"

#include <coplane_mesh/MeshSlice.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
Mesh sliceSample()
{
  Mesh mesh;
  addBox(mesh, "a", {3, 2, 1}, {0, 0, 0}, {3, 2, 1});
  addBox(mesh, "b", {1, 1, 2}, {0, 0, 2}, {1, 1, 2});
  mesh.title = "two";
  mesh.nodeSets = {{4, "some", {9, 3, 30, 2, 1}}, {5, "nobody", {}}};
  mesh.sideSets = {{6, "faces", {7, 0, 3}, {1, 5, 2}}};
  return mesh;
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more)
{
  all.insert(all.end(), more.begin(), more.end());
}
} // namespace

TEST(MeshSlice, allRanksTogetherHaveTheMesh)
{
  const Mesh mesh = sliceSample();
  for (int ranks = 1; ranks <= 40; ++ranks) // more than there are nodes in the end
  {
    Mesh all;
    all.blocks.resize(2);
    all.nodeSets.resize(2);
    all.sideSets.resize(1);
    for (int rank = 0; rank < ranks; ++rank)
    {
      const MeshSlice slice = sliceOf(mesh, rank, ranks);
      EXPECT_EQ(slice.nodes, mesh.nodes());
      EXPECT_EQ(slice.elements(), mesh.elements());
      EXPECT_EQ(slice.mine.title, "two");
      EXPECT_EQ(slice.mine.blocks[1].name, "b");
      EXPECT_EQ(slice.mine.nodes(), slice.nodeRange().count);
      append(all.nodeIds, slice.mine.nodeIds);
      append(all.coordinates, slice.mine.coordinates);
      for (int b = 0; b < 2; ++b)
      {
        EXPECT_EQ(slice.elementsOf(b), mesh.blocks[b].elements());
        append(all.blocks[b].elementIds, slice.mine.blocks[b].elementIds);
        append(all.blocks[b].connectivity, slice.mine.blocks[b].connectivity);
        append(all.blocks[b].bodyIds, slice.mine.blocks[b].bodyIds);
        append(all.nodeSets[b].nodes, slice.mine.nodeSets[b].nodes);
        EXPECT_EQ(slice.nodeSetSizes[b], int(mesh.nodeSets[b].nodes.size()));
      }
      append(all.sideSets[0].elements, slice.mine.sideSets[0].elements);
      append(all.sideSets[0].sides, slice.mine.sideSets[0].sides);
    }
    EXPECT_EQ(all.nodeIds, mesh.nodeIds);
    for (int n = 0; n < mesh.nodes(); ++n)
      EXPECT_EQ(norm(all.coordinates[n] - mesh.coordinates[n]), 0);
    for (int b = 0; b < 2; ++b)
    {
      EXPECT_EQ(all.blocks[b].elementIds, mesh.blocks[b].elementIds);
      EXPECT_EQ(all.blocks[b].connectivity, mesh.blocks[b].connectivity);
      EXPECT_EQ(all.blocks[b].bodyIds, mesh.blocks[b].bodyIds);
      EXPECT_EQ(all.nodeSets[b].nodes, mesh.nodeSets[b].nodes);
    }
    EXPECT_EQ(all.sideSets[0].elements, mesh.sideSets[0].elements);
    EXPECT_EQ(all.sideSets[0].sides, mesh.sideSets[0].sides);
  }
}

TEST(MeshSlice, knowsTheHomesOfNodesAndElements)
{
  const Mesh mesh = sliceSample();
  for (int ranks = 1; ranks <= 12; ++ranks)
    for (int rank = 0; rank < ranks; ++rank)
    {
      const MeshSlice slice = sliceOf(mesh, rank, ranks);
      const IndexRange nodes = slice.nodeRange();
      for (int n = 0; n < mesh.nodes(); ++n)
        EXPECT_EQ(slice.homeOfNode(n) == rank, n >= nodes.first && n < nodes.first + nodes.count);
      for (int e = 0; e < mesh.elements(); ++e)
      {
        const auto [block, position] = slice.placeOf(e);
        EXPECT_EQ(block, e < 6 ? 0 : 1);
        EXPECT_EQ(position, e < 6 ? e : e - 6);
        const IndexRange elements = slice.elementRange(block);
        EXPECT_EQ(slice.homeOfElement(block, position) == rank,
                  position >= elements.first && position < elements.first + elements.count);
      }
    }
}

TEST(NodesFromHome, bringsValuesInTheOrderOfTheWish)
{
  const Comm comm;
  const Mesh mesh = sliceSample();
  const MeshSlice slice = sliceOf(mesh, comm);
  std::vector<int> wanted; // every third, beginning with the rank
  for (int n = comm.rank() % 3; n < mesh.nodes(); n += 3)
    wanted.push_back(n);
  const NodesFromHome nodes(slice, comm, wanted);
  const std::vector<GlobalId> ids = nodes.values(slice.mine.nodeIds);
  ASSERT_EQ(ids.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_EQ(ids[i], mesh.nodeIds[wanted[i]]);
  std::size_t asked = 0;
  for (const auto& nodesOfRank : nodes.asked())
    asked += nodesOfRank.size();
  EXPECT_EQ(comm.sum(std::int64_t(asked)), comm.sum(std::int64_t(wanted.size())));
}
} // namespace coplane
