#pragma once

#include "CutBlocks.hpp"

namespace coplane
{
/// cutDomain in a process of its own, because Gmsh crashes or hangs with some geometries. Where it
/// fails to mesh, other ways are tried in turn, and a note says so.
CutDomain cutDomainApart(const BlocksRecipe& recipe, const std::string& recipeFile);
} // namespace coplane
