#include "BoxMesh.hpp"

#include <coplane_mesh/Bodies.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
/// Three boxes, the first two glued at an edge, and a node of no element.
Mesh threeBodies()
{
  Mesh mesh;
  addBox(mesh, "long", {12, 1, 1}, {0, 0, 0}, {12, 1, 1}); // 52 nodes
  addBox(mesh, "glued", {1, 1, 1}, {0, 0, 1}, {1, 1, 1});  // nodes 52 to 59
  addBox(mesh, "free", {2, 2, 2}, {5, 5, 5}, {1, 1, 1});   // nodes 60 to 86
  for (int& node : mesh.blocks[1].connectivity)
    if (node == 52)
      node = 51; // the last of the first box: 52 is of no element now
  return mesh;
}
} // namespace

TEST(BodyLabels, areTheFirstNodesOfConnectedPartsHoweverTheMeshIsDealtOut)
{
  const Comm comm;
  const Mesh mesh = threeBodies();
  const std::vector<int> last(mesh.nodes(), comm.size() - 1);
  for (const std::vector<int>& owners :
       {scatteredOwners(mesh, comm.size()), last, nodeOwners(mesh, comm, "rcb")})
  {
    const RankMesh part = distribute(mesh, owners, comm.rank());
    const std::vector<int> labels = bodyLabels(part, {1, 1, 1}, comm);
    for (int i = 0; i < part.nodes(); ++i)
    {
      const int n = part.nodePositions[i];
      EXPECT_EQ(labels[i], n == 52 ? -1 : n < 60 ? 0 : 60) << "node " << n;
    }
  }
}

TEST(BodyLabels, lookAtTheChosenBlocksOnly)
{
  // Node 51 is of both blocks; a rank that has it from the other block only must know its body too.
  const Comm comm;
  const Mesh mesh = threeBodies();
  const RankMesh part = distribute(mesh, scatteredOwners(mesh, comm.size()), comm.rank());
  const std::vector<int> labels = bodyLabels(part, {0, 1, 0}, comm);
  for (int i = 0; i < part.nodes(); ++i)
  {
    const int n = part.nodePositions[i];
    EXPECT_EQ(labels[i], n == 51 || (n > 52 && n < 60) ? 51 : -1) << "node " << n;
  }
}
} // namespace coplane
