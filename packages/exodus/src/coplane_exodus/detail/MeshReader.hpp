#pragma once

#include <coplane_mesh/MeshSlice.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// What one rank reads of one Exodus II file (any netCDF kind). Not collective; throws
/// Error(ExitCode::Mesh).
struct ReadSlice
{
  MeshSlice slice;
  std::vector<GlobalId> blockIds; ///< of all blocks, those that are skipped as empty too
};

/// The file is one that demandMeshFile() takes.
/// @param isPart of a split mesh: it may be empty
ReadSlice readSliceOfFile(const std::string& file, bool isPart, int rank, int ranks);
} // namespace coplane
