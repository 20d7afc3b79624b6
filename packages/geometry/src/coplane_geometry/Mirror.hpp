#pragma once

#include <coplane_core/Vec3.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace coplane
{
/// A plane in which bodies are cut, and go on as their image: a plane of symmetry, or the axis of a
/// body of revolution.
struct Mirror
{
  Vec3 normal{};       ///< of length 1
  Real level = 0;      ///< normal . x of its points [m]
  int side = 1;        ///< bodies are where normal . x is larger, 1, or smaller, -1
  bool isAxis = false; ///< a point on it is whole

  /// Of an image, from a direction here.
  Vec3 reflected(const Vec3& direction) const
  {
    return direction - (2 * dot(normal, direction)) * normal;
  }
};

/// What there is of a point with its images, where these mirrors hold it: one over the order of the
/// group of reflections in them [-].
inline Real shareOf(const std::vector<Mirror>& mirrors)
{
  constexpr Real roundOff = 1e-6;
  std::vector<Vec3> normals;
  for (const Mirror& mirror : mirrors)
    if (!mirror.isAxis)
      normals.push_back(mirror.normal);
  // Planes at 180 degrees / n make 2n images; one at right angles to all doubles their number.
  Real images = 1;
  std::vector<char> counted(normals.size(), 0);
  for (std::size_t i = 0; i < normals.size(); ++i)
  {
    if (counted[i])
      continue;
    Real n = 1;
    for (std::size_t j = i + 1; j < normals.size(); ++j)
      if (const Real cosine = std::abs(dot(normals[i], normals[j])); cosine > roundOff)
      {
        counted[j] = 1;
        if (cosine < 1 - roundOff) // or it is the same once more
          n = std::max(n, std::round(pi / std::acos(cosine)));
      }
    images *= 2 * n;
  }
  return 1 / images;
}
} // namespace coplane
