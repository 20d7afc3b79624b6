#pragma once

#include "WholeMesh.hpp"

#include <coplane_mesh/Mesh.hpp>

#include <array>
#include <string>
#include <vector>

namespace coplane
{
/// Adds a box of n[0] x n[1] x n[2] hexahedra with nodes of its own, as a block of its own. Node
/// and element ids count on from 1.
inline void addBox(Mesh& mesh, const std::string& name, const std::array<int, 3>& n,
                   const Vec3& corner, const Vec3& size)
{
  const int firstNode = mesh.nodes();
  const GlobalId firstElement = mesh.elements() + 1;
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i)
      {
        mesh.nodeIds.push_back(mesh.nodes() + 1);
        mesh.coordinates.push_back(corner +
                                   Vec3{size.x * i / n[0], size.y * j / n[1], size.z * k / n[2]});
      }
  const auto node = [&](int i, int j, int k)
  { return firstNode + i + (n[0] + 1) * (j + (n[1] + 1) * k); };
  Mesh::Block block;
  block.id = GlobalId(mesh.blocks.size()) + 1;
  block.name = name;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
      {
        block.elementIds.push_back(firstElement + block.elements());
        block.bodyIds.push_back(int(block.id));
        for (const int c : {node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k),
                            node(i, j + 1, k), node(i, j, k + 1), node(i + 1, j, k + 1),
                            node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)})
          block.connectivity.push_back(c);
      }
  mesh.blocks.push_back(block);
}

/// A box of unit hexahedra with its lowest corner at the origin.
inline Mesh unitBox(int nx, int ny, int nz)
{
  Mesh mesh;
  addBox(mesh, "box", {nx, ny, nz}, {0, 0, 0}, {Real(nx), Real(ny), Real(nz)});
  return mesh;
}

/// Adds a rectangle of n[0] x n[1] quadrilaterals with nodes of its own, as a block of its own, and
/// makes the mesh two-dimensional.
inline void addRectangle(Mesh& mesh, const std::string& name, const std::array<int, 2>& n,
                         const Vec3& corner, const Vec3& size)
{
  mesh.dimension = 2;
  const int firstNode = mesh.nodes();
  const GlobalId firstElement = mesh.elements() + 1;
  for (int j = 0; j <= n[1]; ++j)
    for (int i = 0; i <= n[0]; ++i)
    {
      mesh.nodeIds.push_back(mesh.nodes() + 1);
      mesh.coordinates.push_back(corner + Vec3{size.x * i / n[0], size.y * j / n[1], 0});
    }
  const auto node = [&](int i, int j) { return firstNode + i + (n[0] + 1) * j; };
  Mesh::Block block;
  block.id = GlobalId(mesh.blocks.size()) + 1;
  block.name = name;
  block.type = ElementType::Quad4;
  for (int j = 0; j < n[1]; ++j)
    for (int i = 0; i < n[0]; ++i)
    {
      block.elementIds.push_back(firstElement + block.elements());
      block.bodyIds.push_back(int(block.id));
      for (const int c : {node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)})
        block.connectivity.push_back(c);
    }
  mesh.blocks.push_back(block);
}

/// Owners that scatter neighbouring nodes over the ranks: the hardest split for everything that
/// looks at shared elements.
inline std::vector<int> scatteredOwners(const Mesh& mesh, int ranks)
{
  std::vector<int> owners(mesh.nodes());
  for (int n = 0; n < mesh.nodes(); ++n)
    owners[n] = (7 * n + n / 3) % ranks;
  return owners;
}
} // namespace coplane
