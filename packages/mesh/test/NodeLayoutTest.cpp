#include "BoxMesh.hpp"

#include <coplane_mesh/NodeLayout.hpp>
#include <coplane_partition/Partition.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
/// The nodes of a mesh dealt to the ranks in order, which makes slabs along z; `working` ranks take
/// part.
RankMesh slab(const Mesh& mesh, const Comm& comm, int working)
{
  std::vector<int> owners(mesh.nodes());
  for (int n = 0; n < mesh.nodes(); ++n)
    owners[n] = n * working / mesh.nodes();
  return distribute(mesh, owners, comm.rank());
}

/// A number with all bits in use that belongs to a node.
Real valueOf(GlobalId id, int component)
{
  return std::sin(Real(id) + 0.1 * component) / 3;
}

/// Fills owned rows, spoils the copies, refreshes, and expects the owners' bits in all rows.
void expectRefreshBringsOwnersBits(const NodeLayout& layout)
{
  NodeVectors x("x", layout.size()), v("v", layout.size());
  Array<Real> mass("mass", layout.size());
  for (int n = 0; n < layout.size(); ++n)
    for (int c = 0; c < 3; ++c)
    {
      const bool owned = n < layout.owned();
      x(n, c) = owned ? valueOf(layout.ids()[n], c) : -1;
      v(n, c) = owned ? valueOf(layout.ids()[n], 3 + c) : -1;
      mass(n) = owned ? valueOf(layout.ids()[n], 6) : -1;
    }
  layout.refresh(x, v);
  layout.refresh(mass);
  for (int n = 0; n < layout.size(); ++n)
  {
    for (int c = 0; c < 3; ++c)
    {
      EXPECT_EQ(x(n, c), valueOf(layout.ids()[n], c));
      EXPECT_EQ(v(n, c), valueOf(layout.ids()[n], 3 + c));
    }
    EXPECT_EQ(mass(n), valueOf(layout.ids()[n], 6));
  }
}
} // namespace

TEST(NodeLayout, startsWithTheNodesOfHeldElementsOwnedOnesFirst)
{
  const Comm comm;
  const RankMesh part = slab(unitBox(2, 2, 4), comm, comm.size());
  const NodeLayout layout(comm, part);
  EXPECT_EQ(layout.owned(), part.ownedNodes);
  EXPECT_EQ(layout.ofElements(), part.nodes());
  EXPECT_EQ(layout.ids(), part.nodeIds);
  for (int n = 0; n < layout.size(); ++n)
    EXPECT_EQ(layout.localNode(layout.ids()[n]), n);
  EXPECT_EQ(layout.localNode(4711), -1);
}

TEST(NodeLayout, refreshBringsTheOwnersBits)
{
  const Comm comm;
  const RankMesh part = slab(unitBox(2, 2, 4), comm, comm.size());
  expectRefreshBringsOwnersBits(NodeLayout(comm, part));
}

TEST(NodeLayout, ghostNodesAreAppendedAndRefreshed)
{
  const Comm comm;
  const Mesh mesh = unitBox(1, 1, 8);
  const RankMesh part = slab(mesh, comm, comm.size());
  NodeLayout layout(comm, part);
  const int before = layout.size();
  // Everybody asks for all nodes, twice over: known ones keep their numbers and none is doubled.
  std::vector<GlobalId> wanted = mesh.nodeIds;
  wanted.insert(wanted.end(), mesh.nodeIds.begin(), mesh.nodeIds.end());
  EXPECT_EQ(layout.setGhostNodes(wanted), comm.size() > 1);
  EXPECT_EQ(layout.size(), mesh.nodes());
  for (int n = 0; n < before; ++n)
    EXPECT_EQ(layout.localNode(part.nodeIds[n]), n);
  for (const GlobalId id : mesh.nodeIds)
  {
    ASSERT_GE(layout.localNode(id), 0);
    EXPECT_EQ(layout.ids()[layout.localNode(id)], id);
  }
  expectRefreshBringsOwnersBits(layout);
}

TEST(NodeLayout, isRebuiltOnlyWhenAListChangedButThenOnAllRanks)
{
  const Comm comm;
  const Mesh mesh = unitBox(1, 1, 8);
  NodeLayout layout(comm, slab(mesh, comm, comm.size()));
  EXPECT_FALSE(layout.setGhostNodes({}));
  // Only rank 0 wants one more node: the last, which another rank owns if there is one.
  const std::vector<GlobalId> wanted =
      comm.isRoot() ? std::vector<GlobalId>{mesh.nodeIds.back()} : std::vector<GlobalId>{};
  EXPECT_EQ(layout.setGhostNodes(wanted), comm.size() > 1);
  EXPECT_FALSE(layout.setGhostNodes(wanted));
  expectRefreshBringsOwnersBits(layout);
}

TEST(NodeLayout, forgetsGhostNodesThatAreNoLongerWanted)
{
  const Comm comm;
  const Mesh mesh = unitBox(1, 1, 8);
  const RankMesh part = slab(mesh, comm, comm.size());
  NodeLayout layout(comm, part);
  layout.setGhostNodes(mesh.nodeIds);
  EXPECT_EQ(layout.setGhostNodes({}), comm.size() > 1);
  EXPECT_EQ(layout.ids(), part.nodeIds);
  for (const GlobalId id : mesh.nodeIds)
  {
    const bool held = std::find(part.nodeIds.begin(), part.nodeIds.end(), id) != part.nodeIds.end();
    EXPECT_EQ(layout.localNode(id) >= 0, held);
  }
  expectRefreshBringsOwnersBits(layout);
}

TEST(NodeLayout, aRankWithoutNodesTakesPartAndMayHaveGhosts)
{
  const Comm comm;
  const Mesh mesh = unitBox(2, 2, 4);
  const int working = std::max(1, comm.size() - 1); // nothing for the last of several ranks
  const RankMesh part = slab(mesh, comm, working);
  NodeLayout layout(comm, part);
  EXPECT_EQ(layout.size() == 0, comm.rank() >= working);
  expectRefreshBringsOwnersBits(layout);
  EXPECT_EQ(layout.setGhostNodes(mesh.nodeIds), comm.size() > 1);
  EXPECT_EQ(layout.size(), mesh.nodes());
  expectRefreshBringsOwnersBits(layout);
}
} // namespace coplane
