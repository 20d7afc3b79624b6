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

/// Reads the joints of a recipe and finds their faces. Throws Error(ExitCode::Deck) with every
/// problem that was found; a joint that finds no interior face is one.
CutSelection selectCuts(const std::string& recipe, const std::string& name, const Mesh& mesh,
                        const std::vector<MeshFace>& faces,
                        const std::vector<std::string>& overrides = {});
} // namespace coplane
