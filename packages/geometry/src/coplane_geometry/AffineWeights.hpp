#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_geometry/PolygonSides.hpp>

namespace coplane
{
/// Node weights that reproduce a point from the corners of a face, affine and of least norm: for
/// any corners; where these lie on a line, the point is moved onto it. Their sum is 1. T is Real,
/// or Lanes for several faces side by side.
/// @param p corners; at: the point [m]; w: weights of the corners
template <class T>
KOKKOS_INLINE_FUNCTION void affineWeights(const Vec2Of<T>* p, int count, const Vec2Of<T>& at, T* w)
{
  Vec2Of<T> mean;
  for (int i = 0; i < count; ++i)
    mean = mean + p[i];
  mean = (1.0 / count) * mean;
  T xx{}, xy{}, yy{};
  for (int i = 0; i < count; ++i)
  {
    const Vec2Of<T> r = p[i] - mean;
    xx += r.x * r.x;
    xy += r.x * r.y;
    yy += r.y * r.y;
  }
  const T determinant = xx * yy - xy * xy, trace = xx + yy;
  const T inverse = 1.0 / determinant;
  const Vec2Of<T> d = at - mean;
  Vec2Of<T> slope{inverse * (yy * d.x - xy * d.y), inverse * (xx * d.y - xy * d.x)};
  // A face a million times as long as it is wide is a line: round-off eats the determinant.
  if (const auto wide = determinant > 1e-12 * trace * trace; !branchFree::allOf(wide))
  {
    const T along = 1.0 / (trace * trace);
    slope = coplane::choose(
        wide, slope, Vec2Of<T>{along * (xx * d.x + xy * d.y), along * (xy * d.x + yy * d.y)});
  }
  for (int i = 0; i < count; ++i)
    w[i] = 1.0 / count + dot(p[i] - mean, slope);
}
} // namespace coplane
