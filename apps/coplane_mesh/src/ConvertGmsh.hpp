#pragma once

#include "GmshFile.hpp"

#include <coplane_mesh/Mesh.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// A mesh from a file of Gmsh, and what the user should know about the conversion, a line each.
struct ConvertedMesh
{
  Mesh mesh;
  std::vector<std::string> notes;
};

/// Physical groups of the highest dimension become blocks, those of one dimension less side sets
/// and node sets, the others node sets. Elements that are inside out are turned. `name` stands for
/// the file in messages; errors are Error(ExitCode::Mesh).
ConvertedMesh convertGmsh(const GmshFile& file, const std::string& name);
} // namespace coplane
