#pragma once

#include <coplane_core/Error.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_mesh/Distribute.hpp>
#include <coplane_partition/Partition.hpp>

#include <TestFolder.hpp>
#include <memory>
#include <string>

namespace coplane
{
/// A cube of n^3 hexahedra of side 1 m with its lowest corner at `corner`, as a block of its own.
inline void addCube(Mesh& mesh, const std::string& name, int n, const Vec3& corner)
{
  const int firstNode = mesh.nodes();
  const GlobalId firstElement = mesh.elements() + 1;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
      {
        mesh.nodeIds.push_back(mesh.nodes() + 1);
        mesh.coordinates.push_back(corner + Vec3{Real(i) / n, Real(j) / n, Real(k) / n});
      }
  const auto node = [&](int i, int j, int k)
  { return firstNode + i + (n + 1) * (j + (n + 1) * k); };
  Mesh::Block block;
  block.id = GlobalId(mesh.blocks.size()) + 1;
  block.name = name;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
      {
        block.elementIds.push_back(firstElement + block.elements());
        block.bodyIds.push_back(int(block.id));
        for (const int corner : {node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k),
                                 node(i, j + 1, k), node(i, j, k + 1), node(i + 1, j, k + 1),
                                 node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)})
          block.connectivity.push_back(corner);
      }
  mesh.blocks.push_back(block);
}

/// Two cubes, the upper one shifted sideways so that every face meets several.
///
///      +-------+        z
///      | upper |        |
///    +-+-----+-+        +-- x
///    | lower |
///    +-------+
inline Mesh twoCubes()
{
  Mesh mesh;
  mesh.title = "two cubes";
  addCube(mesh, "lower", 2, {0, 0, 0});
  addCube(mesh, "upper", 2, {0.125, 0.0625, 1});
  Mesh::NodeSet top{1, "top", {}};
  for (int n = 0; n < mesh.nodes(); ++n)
    if (mesh.coordinates[n].z == 2)
      top.nodes.push_back(n);
  mesh.nodeSets.push_back(top);
  // The faces that meet, in an order that is neither that of the elements nor of the blocks; and a
  // side between two elements, which is no face.
  Mesh::SideSet seam{7, "seam", {11, 4, 10, 5, 9, 6, 8, 7}, {4, 5, 4, 5, 4, 5, 4, 5}};
  mesh.sideSets.push_back(seam);
  mesh.sideSets.push_back({8, "inside", {0}, {5}});
  return mesh;
}

/// The upper cube falls on the lower one and slides over it.
inline Model cubesInContact(const Mesh& mesh, const Comm& comm)
{
  Model model;
  const MeshSlice slice = sliceOf(mesh, comm.rank(), comm.size());
  model.mesh = distribute(slice, nodeOwners(partAtHome(slice, comm), comm, "multijagged"), comm);
  model.blocks.resize(2);
  for (int b = 0; b < 2; ++b)
  {
    model.blocks[b].name = mesh.blocks[b].name;
    model.blocks[b].materialName = "stone";
    model.blocks[b].material = makeLinearElastic(1e9, 0.25, 1000);
  }
  model.blocks[1].velocity = {0.5, 0, -1};
  JointRecipe joint;
  joint.name = "rough";
  joint.law.friction = 0.25;
  model.contactRules.joints = {joint};
  model.contactRules.tellApart(2);
  model.time.end = 5e-3;
  return model;
}
} // namespace coplane
