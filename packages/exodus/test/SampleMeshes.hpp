#pragma once

#include <coplane_mesh/Mesh.hpp>

#include <mpi.h>

#include <filesystem>
#include <string>
#include <unistd.h>

namespace coplane
{
/// Two quadrilaterals side by side and one apart, with ids that are not the positions:
///
///   40---50---60      13---14
///   | 7  | 9  |       | 8  |
///   10---20---30      11---12
inline Mesh sampleMesh2d()
{
  Mesh mesh;
  mesh.title = "two blocks";
  mesh.dimension = 2;
  mesh.nodeIds = {10, 20, 30, 40, 50, 60, 11, 12, 13, 14};
  mesh.coordinates = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0},
                      {2, 1, 0}, {3, 0, 0}, {4, 0, 0}, {3, 1, 0}, {4, 1, 0}};
  mesh.blocks = {{5, "wall", ElementType::Quad4, {7, 9}, {0, 1, 4, 3, 1, 2, 5, 4}, {1, 1}},
                 {3, "shot", ElementType::Quad4, {8}, {6, 7, 9, 8}, {2}}};
  mesh.nodeSets = {{4, "base", {0, 1, 2}}};
  mesh.sideSets = {{6, "top", {0, 1, 2}, {2, 2, 2}}};
  mesh.qaRecords = {{"mesher", "1.0", "2020/01/01", "12:00:00"}};
  return mesh;
}

/// Three unit cubes in a row along x.
inline Mesh sampleMesh3d()
{
  Mesh mesh;
  mesh.title = "three cubes";
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 4; ++i)
      {
        mesh.nodeIds.push_back(100 + int(mesh.nodeIds.size()));
        mesh.coordinates.push_back({Real(i), Real(j), Real(k)});
      }
  Mesh::Block block{1, "row", ElementType::Hex8, {}, {}, {}};
  for (int i = 0; i < 3; ++i)
  {
    block.elementIds.push_back(31 + i);
    for (const int n : {i, i + 1, i + 5, i + 4, i + 8, i + 9, i + 13, i + 12})
      block.connectivity.push_back(n);
    block.bodyIds.push_back(1);
  }
  mesh.blocks = {block};
  mesh.nodeSets = {{1, "left", {0, 4, 8, 12}}, {2, "nobody", {}}};
  mesh.sideSets = {{1, "right", {2}, {1}}};
  return mesh;
}

/// A file name in the temporary folder that no other program of the tests uses; the same on all
/// ranks of this one.
inline std::string temporaryFile(const std::string& name)
{
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  std::int64_t id = ::getpid();
  MPI_Bcast(&id, 1, MPI_INT64_T, 0, MPI_COMM_WORLD);
  return (std::filesystem::temp_directory_path() /
          ("coplane_exodus_" + std::to_string(id) + "_" + name))
      .string();
}
} // namespace coplane
