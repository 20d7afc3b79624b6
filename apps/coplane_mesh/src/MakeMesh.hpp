#pragma once

#include <coplane_mesh/Mesh.hpp>

#include <array>
#include <string>

namespace coplane
{
/// The mesh that a recipe describes; errors of the recipe are Error(ExitCode::Deck) with file, line
/// and column.
Mesh makeMesh(const std::string& recipeFile);

/// The same from text; `name` stands for the file in messages.
Mesh makeMeshFromText(const std::string& recipe, const std::string& name);

/// Program, version, date and time, for the file.
std::array<std::string, 4> qaRecord();

/// The manual of recipes.
const char* recipeHelp();
} // namespace coplane
