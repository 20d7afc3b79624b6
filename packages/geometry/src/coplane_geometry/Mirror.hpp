#pragma once

#include <coplane_core/Vec3.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace coplane
{
/// A plane in which bodies go on as their own image: a plane of symmetry, or the axis of a body of
/// revolution.
struct Mirror
{
  Vec3 normal{};       ///< of length 1
  Real level = 0;      ///< normal . x of its points [m]
  int side = 0;        ///< bodies are where normal . x is larger, 1, or smaller, -1; 0: no images
  bool isAxis = false; ///< a point on it is whole

  /// Of an image, from a direction here.
  Vec3 reflected(const Vec3& direction) const
  {
    return direction - (2 * dot(normal, direction)) * normal;
  }
  /// @param near largest distance from it [m]
  bool contains(const Vec3& x, Real near) const { return std::abs(dot(normal, x) - level) <= near; }
};

/// Distance from a mirror up to which corners of a face lie in it, as round-off leaves them [m].
inline Real roundOffOfFace(const Vec3* corners, int count)
{
  Real size = 0;
  for (int k = 1; k < count; ++k)
    size = std::max(size, norm(corners[k] - corners[0]));
  return 1e-6 * size;
}

/// Whether a face lies in one of the mirrors. Bodies go on beyond such a face: it is no surface.
inline bool isCut(const Vec3* corners, int count, const std::vector<Mirror>& mirrors)
{
  const Real near = mirrors.empty() ? 0 : roundOffOfFace(corners, count);
  return std::any_of(mirrors.begin(), mirrors.end(),
                     [&](const Mirror& mirror)
                     {
                       return std::all_of(corners, corners + count,
                                          [&](const Vec3& corner)
                                          { return mirror.contains(corner, near); });
                     });
}
} // namespace coplane
