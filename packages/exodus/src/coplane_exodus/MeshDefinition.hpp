#pragma once

#include <coplane_mesh/MeshSlice.hpp>

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

/// Largest id of what is in this rank's slice.
GlobalId largestId(const MeshSlice& slice);

/// The flags of ex_create: CDF-5, with 64-bit ids only when the largest id of the mesh needs them.
int creationMode(GlobalId largestId);

/// Defines everything in a new, serially opened Exodus file: sizes, blocks, sets, names,
/// attributes, QA and info records, id maps, variables; and writes the ids of this slice, which
/// must be that of the first rank. Afterwards the header is complete, so the file needs no further
/// redefinition.
void defineMesh(int exoid, const MeshSlice& slice, const FileExtras& extras);

/// Writes this rank's ranges of coordinates, connectivity, attributes and sets, and ids but on the
/// first rank.
void writeMeshRanges(int exoid, const MeshSlice& slice);

/// Info records of Exodus have 80 characters: longer lines continue on the next with a "> " in
/// front.
std::vector<std::string> splitInfoLines(const std::vector<std::string>& lines);
} // namespace coplane
