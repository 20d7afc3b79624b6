#pragma once

#include "BlocksRecipe.hpp"

#include <map>
#include <string>
#include <vector>

namespace coplane
{
/// Tags of what has element sizes of its own, in the geometry that is open in Gmsh.
struct SizedParts
{
  std::map<int, std::vector<int>> walls; ///< faces of openings, by their place in the recipe
  std::map<std::string, std::vector<int>> blocks; ///< volumes (2D: surfaces) of element blocks
};

/// Tells Gmsh the sizes of elements: those of the recipe, near openings and in regions their own,
/// growing with the distance.
/// @param factor on all of them [-]
/// @throws Error(ExitCode::Deck) if a region names a block that is not there
void setElementSizes(const BlocksRecipe& recipe, const std::string& recipeFile,
                     const SizedParts& parts, Real factor);
} // namespace coplane
