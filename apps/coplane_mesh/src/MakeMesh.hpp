#pragma once

#include <coplane_mesh/Mesh.hpp>

#include <array>
#include <string>
#include <vector>

namespace coplane
{
/// The mesh that a recipe describes. Throws Error(ExitCode::Deck) with every problem that was
/// found, one per line.
/// @param overrides the values of --set, such as "define.h=0.1"
Mesh makeMesh(const std::string& recipeFile, const std::vector<std::string>& overrides = {});

/// The same from text; `name` stands for the file in messages.
Mesh makeMeshFromText(const std::string& recipe, const std::string& name,
                      const std::vector<std::string>& overrides = {});

/// The files of meshes that a recipe puts among its parts; errors as above.
std::vector<std::string> meshFilesOf(const std::string& recipeFile,
                                     const std::vector<std::string>& overrides = {});

/// Program, version, date and time, for the file.
std::array<std::string, 4> qaRecord();
} // namespace coplane
