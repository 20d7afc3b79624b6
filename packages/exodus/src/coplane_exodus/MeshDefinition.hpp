#pragma once

#include <coplane_mesh/Mesh.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// What of a file's definition does not come from the mesh.
struct FileExtras
{
  std::vector<std::string> nodalNames;   ///< variables; empty for a mesh file
  std::vector<std::string> elementNames; ///< on every block that has elements
  std::vector<std::string> globalNames;
  std::vector<std::string> sideNames; ///< on every side set that has sides
  std::vector<std::string> infoLines; ///< at most 80 characters each: see splitInfoLines
};

/// The flags of ex_create for this mesh: CDF-5, with 64-bit ids only when an id needs them.
int creationMode(const Mesh& mesh);

/// Defines everything in a new, serially opened Exodus file: sizes, blocks, sets, names,
/// attributes, QA and info records, id maps, variables. Afterwards the header is complete, so the
/// file needs no further redefinition.
void defineMesh(int exoid, const Mesh& mesh, const FileExtras& extras);

/// Writes this rank's contiguous ranges of coordinates, connectivity, attributes and sets.
void writeMeshRanges(int exoid, const Mesh& mesh, int rank, int ranks);

/// Info records of Exodus have 80 characters: longer lines continue on the next with a "> " in
/// front.
std::vector<std::string> splitInfoLines(const std::vector<std::string>& lines);
} // namespace coplane
