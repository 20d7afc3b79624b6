#pragma once

#include "JointSurfaces.hpp"

#include <vector>

namespace coplane
{
/// The borders between Voronoi cells of random points in the box [low, high], each once: polygons,
/// in two dimensions edges.
std::vector<JointSurface> voronoiSurfaces(const VoronoiCard& card, int joint, int seed,
                                          int dimension, const Vec3& low, const Vec3& high);
} // namespace coplane
