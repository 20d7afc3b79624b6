#pragma once

#include <coplane_exodus/SharedFile.hpp>
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

/// Makes a new Exodus file with everything defined: sizes, blocks, sets, names, attributes, QA and
/// info records, id maps, variables. The slice must be that of the first rank, or of the only one.
/// On one rank. Throws ExodusFailure.
void defineFile(const std::string& file, const MeshSlice& slice, const FileExtras& extras,
                int mode);

/// Writes this rank's ranges of ids, coordinates, connectivity, attributes and sets.
void writeMeshRanges(SharedFile& file, const MeshSlice& slice);

/// Info records of Exodus have 80 characters: longer lines continue on the next with a "> " in
/// front.
std::vector<std::string> splitInfoLines(const std::vector<std::string>& lines);
} // namespace coplane
