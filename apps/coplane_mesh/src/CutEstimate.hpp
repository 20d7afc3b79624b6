#pragma once

#include "JointSurfaces.hpp"

#include <string>
#include <vector>

namespace coplane
{
/// About how many parts the surfaces cut a box into: det(1 + L F), L the edge of the cube (square)
/// of its volume and F the sum of area times normal times normal over the volume. Exact for sets of
/// planes at right angles in a cube. Surfaces that end count with the area that they have in the
/// box; at least as many parts as surfaces.
Real estimatedParts(const std::vector<JointSurface>& surfaces, int dimension, const Vec3& low,
                    const Vec3& high);

/// Refuses joints that would cut for ever: more parts than elements.most_parts, or neighbours
/// nearer than what is a sliver. @param surfaces without those of Voronoi cells, which count by
/// themselves; thickness: of slivers [m]
void demandFewParts(const BlocksRecipe& recipe, const std::string& recipeFile,
                    const std::vector<JointSurface>& surfaces, const Vec3& low, const Vec3& high,
                    Real thickness);

/// Refuses openings in a wrong unit before anything is cut: wider or higher than twice the diagonal
/// of the domain's box, or with more sides together than elements.most_parts.
void demandFewSides(const BlocksRecipe& recipe, const std::string& recipeFile, const Vec3& low,
                    const Vec3& high);

/// Which openings take more than half of the domain. @param shares by opening [-]
std::vector<std::string> notesOfLargeOpenings(const BlocksRecipe& recipe,
                                              const std::vector<Real>& shares);

/// Which spacings are larger than the domain, and which regions of elements lie outside of it.
std::vector<std::string> notesOfSizes(const BlocksRecipe& recipe, const Vec3& low,
                                      const Vec3& high);

/// Which planes and fractures lie outside of the domain. @param outside by surface
std::vector<std::string> notesOfOutside(const BlocksRecipe& recipe,
                                        const std::vector<JointSurface>& surfaces,
                                        const std::vector<bool>& outside);
} // namespace coplane
