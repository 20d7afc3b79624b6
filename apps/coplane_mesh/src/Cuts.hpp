#pragma once

#include "SplitMesh.hpp"

#include <string>
#include <vector>

namespace coplane
{
/// What a recipe of joints selects in a mesh, and one line about each joint for the user.
struct CutSelection
{
  std::vector<Cut> cuts;
  std::vector<std::string> notes;
};

/// Reads the joints of a recipe and finds their faces; errors are Error(ExitCode::Deck) with file,
/// line and column. A joint that finds no interior face is an error.
CutSelection selectCuts(const std::string& recipe, const std::string& name, const Mesh& mesh,
                        const std::vector<MeshFace>& faces);

/// The manual of such recipes.
const char* cutsHelp();
} // namespace coplane
