#pragma once

#include <coplane_core/Vec3.hpp>

#include <array>

namespace coplane
{
/// The point of a face that is nearest to another point.
struct NearestOnFace
{
  std::array<Real, 4> weights{}; ///< shape functions of the corners there; their sum is 1 [-]
  Vec3 way{};                    ///< from the other point to it [m]
};

/// Of a segment (two corners), a triangle, or the bilinear face of four corners, each with its
/// edges. On a face of four corners the first of several equally near points that the search from
/// its middle finds.
NearestOnFace nearestOnFace(int corners, const Vec3* c, const Vec3& x);
} // namespace coplane
