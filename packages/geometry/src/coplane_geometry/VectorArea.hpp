#pragma once

#include <coplane_core/Vec3.hpp>

#include <cmath>

namespace coplane
{
/// Vector area of a face from its corners: its area along its outward normal [m^2]; exact for the
/// bilinear patch of a warped quadrilateral. In two dimensions a face is a segment of unit
/// thickness, with the body on its left. T is Real, or Lanes for several faces side by side.
/// @param x corners [m]; count: 2 in two dimensions, 3 or 4 in three
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Vec3Of<T> vectorArea(const Vec3Of<T>* x, int count)
{
  if constexpr (Dim == 2)
    return {x[1].y - x[0].y, x[0].x - x[1].x, T(0.0)};
  else
    return count == 3 ? 0.5 * cross(x[1] - x[0], x[2] - x[0])
                      : 0.5 * cross(x[2] - x[0], x[3] - x[1]);
}

/// The same where the dimension is known only when the program runs.
inline Vec3 vectorArea(const Vec3* x, int count, int dimension)
{
  return dimension == 2 ? vectorArea<2>(x, count) : vectorArea<3>(x, count);
}

/// Size of a face of this area: its length in two dimensions [m].
inline Real faceSize(Real area, int dimension)
{
  return dimension == 2 ? area : std::sqrt(area);
}
} // namespace coplane
