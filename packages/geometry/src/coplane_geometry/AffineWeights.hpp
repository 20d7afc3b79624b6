#pragma once

#include <coplane_geometry/Vec2.hpp>

namespace coplane
{
/// Node weights that reproduce a point from the corners of a face, affine and of least norm: for
/// any corners that are not collinear. Their sum is 1. T is Real, or Lanes for several faces side
/// by side.
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
  const T inverse = 1.0 / (xx * yy - xy * xy);
  const Vec2Of<T> d = at - mean;
  const Vec2Of<T> slope{inverse * (yy * d.x - xy * d.y), inverse * (xx * d.y - xy * d.x)};
  for (int i = 0; i < count; ++i)
    w[i] = 1.0 / count + dot(p[i] - mean, slope);
}
} // namespace coplane
