#pragma once

#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// A plane in which bodies are cut: a plane of symmetry, or the axis of a body of revolution.
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
};
} // namespace coplane
