#pragma once

#include <optional>
#include <string>

// By which program an Exodus file was written: what may be replaced without asking.

namespace coplane
{
/// In the last QA record of results and of meshes.
constexpr const char* programOfResults = "coplane";
constexpr const char* programOfMeshes = "coplane_mesh";

/// The first info line of results, which tells of which run they are.
std::string infoLineOf(const std::string& run);

/// The run of results that coplane wrote: their last QA record says so, and they have nodal
/// variables. Empty: they do not tell. Nothing: the file holds no such results. Not collective.
std::optional<std::string> runOfResults(const std::string& file);

/// Whether coplane_mesh was the last to write this mesh, and nobody has added variables.
bool isMeshOfCoplane(const std::string& file);
} // namespace coplane
