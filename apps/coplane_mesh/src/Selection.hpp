#pragma once

#include "Recipe.hpp"

#include <coplane_mesh/Mesh.hpp>

#include <vector>

namespace coplane
{
/// Adds the recipe's node_sets and side_sets to a mesh. `ownCoordinates` are those of each node's
/// part before it was rotated and shifted. An empty selection is an error: it is a mistake in all
/// cases that were seen.
void addSets(Mesh& mesh, const std::vector<Vec3>& ownCoordinates, const Recipe& recipe,
             Problems& problems);
} // namespace coplane
