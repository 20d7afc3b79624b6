#include <coplane_core/Comm.hpp>
#include <coplane_partition/Partition.hpp>

#include <gtest/gtest.h>

#include <BoxMesh.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace coplane
{
namespace
{
struct NodeOwners : testing::TestWithParam<const char*>
{
};

void expectValidAndAgreed(const std::vector<int>& owners, const Mesh& mesh, const Comm& comm)
{
  ASSERT_EQ(int(owners.size()), mesh.nodes());
  for (const int owner : owners)
  {
    EXPECT_GE(owner, 0);
    EXPECT_LT(owner, comm.size());
  }
  const std::vector<int> all = comm.allGather(owners);
  for (int r = 0; r < comm.size(); ++r)
    EXPECT_TRUE(std::equal(owners.begin(), owners.end(), all.begin() + r * mesh.nodes()))
        << "rank " << r << " has another answer";
}
} // namespace

TEST_P(NodeOwners, areTheSameOnAllRanks)
{
  const Comm comm;
  const Mesh mesh = unitBox(9, 9, 9);
  expectValidAndAgreed(nodeOwners(mesh, comm, GetParam()), mesh, comm);
}

TEST_P(NodeOwners, haveSharesOfABoxWithin20PercentOfTheMean)
{
  const Comm comm;
  const Mesh mesh = unitBox(9, 9, 9); // 1000 nodes
  const std::vector<int> owners = nodeOwners(mesh, comm, GetParam());
  const Real mean = Real(mesh.nodes()) / comm.size();
  for (int r = 0; r < comm.size(); ++r)
    EXPECT_NEAR(Real(std::count(owners.begin(), owners.end(), r)), mean, 0.2 * mean)
        << "rank " << r;
}

TEST_P(NodeOwners, sharesAreCompact)
{
  // Halving a cube twice leaves boxes of 10 x 5 x 5 nodes: few elements (at most 2 of the 9 layers
  // in each of two directions, 9^3 - 8 * 8 * 9 = 153) have nodes of two ranks. Dealt like cards,
  // all of them would.
  const Comm comm;
  const Mesh mesh = unitBox(9, 9, 9);
  const std::vector<int> owners = nodeOwners(mesh, comm, GetParam());
  int shared = 0;
  const std::vector<int>& corners = mesh.blocks[0].connectivity;
  for (int e = 0; e < mesh.elements(); ++e)
    shared += std::any_of(&corners[8 * e], &corners[8 * e] + 8,
                          [&](int n) { return owners[n] != owners[corners[8 * e]]; });
  EXPECT_LE(shared, comm.size() == 1 ? 0 : 3 * 81);
}

TEST_P(NodeOwners, treatFlatMeshesAndCoincidentNodes)
{
  // Two sheets of quadrilaterals in the same place: every node exists twice.
  const Comm comm;
  Mesh mesh;
  addRectangle(mesh, "a", {9, 9}, {0, 0, 0}, {1, 1, 0});
  addRectangle(mesh, "b", {9, 9}, {0, 0, 0}, {1, 1, 0});
  const std::vector<int> owners = nodeOwners(mesh, comm, GetParam());
  expectValidAndAgreed(owners, mesh, comm);
  const Real mean = Real(mesh.nodes()) / comm.size();
  for (int r = 0; r < comm.size(); ++r)
    EXPECT_NEAR(Real(std::count(owners.begin(), owners.end(), r)), mean, 0.2 * mean);
}

TEST_P(NodeOwners, ofTwoElementsAreValid)
{
  const Comm comm;
  const Mesh mesh = unitBox(2, 1, 1);
  expectValidAndAgreed(nodeOwners(mesh, comm, GetParam()), mesh, comm);
}

TEST_P(NodeOwners, ofMeshesJustAboveTheSmallestAreValid)
{
  // 36 nodes: with 4 ranks a few more than the 8 per rank below which nodes are dealt in order.
  const Comm comm;
  const Mesh mesh = unitBox(3, 2, 2);
  ASSERT_EQ(mesh.nodes(), 36);
  expectValidAndAgreed(nodeOwners(mesh, comm, GetParam()), mesh, comm);
}

TEST_P(NodeOwners, ofFewerNodesThanRanksLeaveRanksEmpty)
{
  const Comm comm;
  Mesh mesh;
  mesh.nodeIds = {1, 2};
  mesh.coordinates = {{0, 0, 0}, {1, 0, 0}};
  const std::vector<int> owners = nodeOwners(mesh, comm, GetParam());
  expectValidAndAgreed(owners, mesh, comm);
  EXPECT_EQ(owners[0] == owners[1], comm.size() == 1);
}

TEST_P(NodeOwners, ofNoNodesAreNone)
{
  const Comm comm;
  EXPECT_TRUE(nodeOwners(Mesh{}, comm, GetParam()).empty());
}

TEST_P(NodeOwners, balanceCostsRatherThanNodes)
{
  // A quarter of the box costs nine times as much per element: 9 / 4 + 3 / 4 = 3 times as much as
  // all would, three quarters of it there.
  const Comm comm;
  Mesh mesh = unitBox(12, 12, 12);
  Mesh::Block& all = mesh.blocks[0];
  Mesh::Block dear{2, "dear", all.type, {}, {}, {}}, cheap{1, "cheap", all.type, {}, {}, {}};
  for (int e = 0; e < all.elements(); ++e)
  {
    const Vec3 corner = mesh.coordinates[all.connectivity[8 * e]];
    Mesh::Block& block = corner.x < 3 ? dear : cheap;
    block.elementIds.push_back(all.elementIds[e]);
    block.connectivity.insert(block.connectivity.end(), &all.connectivity[8 * e],
                              &all.connectivity[8 * e] + 8);
  }
  ASSERT_EQ(3 * dear.elements(), cheap.elements());
  mesh.blocks = {cheap, dear};
  // Costs of all nodes, from what every rank knows of its own.
  const RankMesh home = partAtHome(sliceOf(mesh, comm), comm);
  const PartitionCosts prices{{1, 9}, 0};
  const std::vector<Real> costs = comm.allGather(nodeCosts(home, prices));
  const Real total = std::accumulate(costs.begin(), costs.end(), Real(0));
  EXPECT_NEAR(total, 12 * 12 * (9 + 3 * 9), 1e-9 * total);
  const auto quality = [&](const std::vector<int>& owners)
  {
    const RankMesh part = distribute(mesh, owners, comm.rank());
    return std::pair(qualityOf(part, nodeCosts(part, prices), comm), part.ownedNodes);
  };
  const auto [even, owned] = quality(nodeOwners(mesh, comm, GetParam(), costs));
  EXPECT_LT(even.imbalance, 1.2);
  EXPECT_LE(even.fewest, owned);
  EXPECT_GE(even.most, owned);
  if (comm.size() > 1)
  {
    EXPECT_GT(quality(nodeOwners(mesh, comm, GetParam())).first.imbalance, even.imbalance);
  }
}

TEST(PartitionCosts, countExteriorFacesOnce)
{
  // A box of 2 x 2 x 2 cells has 24 faces outside.
  const Comm comm;
  const Mesh mesh = unitBox(2, 2, 2);
  const RankMesh part = distribute(mesh, scatteredOwners(mesh, comm.size()), comm.rank());
  const std::vector<Real> costs = nodeCosts(part, {{0}, 4});
  const std::vector<Real> all = comm.allGather(costs);
  EXPECT_EQ(std::accumulate(all.begin(), all.end(), Real(0)), 24 * 4);
  ASSERT_EQ(int(costs.size()), part.ownedNodes);
  for (int n = 0; n < part.ownedNodes; ++n)
  {
    const Vec3& x = part.coordinates[n];
    const bool inside = x.x == 1 && x.y == 1 && x.z == 1;
    EXPECT_EQ(costs[n] == 0, inside) << "node " << part.nodeIds[n];
  }
}

TEST(PartitionQuality, countsWhatRanksNeedOfEachOther)
{
  // Two cells side by side; the nodes of one end belong to the last rank, the others to the first.
  const Comm comm;
  const bool several = comm.size() > 1;
  const Mesh mesh = unitBox(2, 1, 1);
  std::vector<int> owners(mesh.nodes());
  for (int n = 0; n < mesh.nodes(); ++n)
    owners[n] = mesh.coordinates[n].x > 1.5 ? comm.size() - 1 : 0;
  const PartitionQuality quality = qualityOf(distribute(mesh, owners, comm.rank()), {}, comm);
  EXPECT_EQ(quality.cutElements, several ? 1 : 0);
  EXPECT_EQ(quality.fewest, !several ? 12 : comm.size() == 2 ? 4 : 0);
  EXPECT_EQ(quality.most, several ? 8 : 12);
  EXPECT_EQ(quality.mostOfOthers, several ? 4 : 0);
  EXPECT_NEAR(quality.imbalance, several ? 8.0 * comm.size() / 12 : 1, 1e-15);
}

TEST(LargestAndMean, ofOneNumberPerRank)
{
  const Comm comm;
  const auto [largest, mean] = largestAndMean(comm.rank() + 1, comm);
  EXPECT_EQ(largest, comm.size());
  EXPECT_EQ(mean, 0.5 * (comm.size() + 1));
}

INSTANTIATE_TEST_SUITE_P(Methods, NodeOwners,
                         testing::Values("multijagged", "rcb", "rib", "hsfc", "hypergraph"),
                         [](const auto& info) { return std::string(info.param); });
} // namespace coplane
