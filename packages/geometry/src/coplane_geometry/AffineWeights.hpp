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

/// The same for triangles. Of a quadrilateral w0 - w1 + w2 - w3 = 0 besides: at its centroid these
/// are the means of the bilinear shape functions, so that a uniform traction has the nodal forces
/// that a uniform stress has in a hexahedron. One that is folded beyond a reentrant corner, whose
/// area goes to zero, gets those of least norm; between are weights between, which reproduce the
/// point as well.
template <class T>
KOKKOS_INLINE_FUNCTION void evenWeights(const Vec2Of<T>* p, int count, const Vec2Of<T>& at, T* w)
{
  affineWeights(p, count, at, w);
  if (count != 4)
    return;
  using branchFree::choose;
  // What changes neither the sum nor the point: the minors of (1, x, y), twice the corners'
  // triangles, with alternating signs.
  const T minors[4] = {cross(p[2] - p[1], p[3] - p[1]), cross(p[3] - p[2], p[0] - p[2]),
                       cross(p[0] - p[3], p[1] - p[3]), cross(p[1] - p[0], p[2] - p[0])};
  T sum{}, largest{};
  for (const T& minor : minors)
  {
    sum += minor;
    largest = branchFree::larger(branchFree::absolute(minor), largest);
  }
  // The area over the largest triangle: 1 at least where the quadrilateral is convex.
  const auto has = branchFree::absolute(sum) > 0.5 * largest;
  const T share = choose(has, branchFree::absolute(sum) / (2.0 * largest), T(0.25));
  const T z = branchFree::smaller(2.0 * (share - 0.25), T(1.0));
  const T change = choose(has, z * z * (3.0 - 2.0 * z) * (w[0] - w[1] + w[2] - w[3]) / sum, T(0.0));
  for (int i = 0; i < 4; ++i)
    w[i] += (i % 2 == 0 ? -1.0 : 1.0) * change * minors[i];
}
} // namespace coplane
