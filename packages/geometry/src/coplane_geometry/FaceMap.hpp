#pragma once

#include <coplane_geometry/ConvexPolygon.hpp>

#include <cmath>

namespace coplane
{
/// Inverse isoparametric map of a triangle or quadrilateral in a plane: p(xi, eta) = origin + xi a
/// + eta b + xi eta c. Triangle: xi, eta are barycentric, c = 0. Quadrilateral: xi, eta in [-1, 1].
struct FaceMap
{
  int nodes = 4;
  bool affine = true;
  Vec2 origin, a, b, c;
  /// Set when a point had no coordinates: the quadrilateral is flat, or nearly so at that point.
  mutable bool lost = false;

  KOKKOS_INLINE_FUNCTION FaceMap() = default;

  KOKKOS_INLINE_FUNCTION FaceMap(const Vec2* p, int count) : nodes(count)
  {
    if (count == 3)
    {
      origin = p[0];
      a = p[1] - p[0];
      b = p[2] - p[0];
      return;
    }
    origin = 0.25 * ((p[0] + p[1]) + (p[2] + p[3]));
    a = 0.25 * ((p[1] - p[0]) + (p[2] - p[3]));
    b = 0.25 * ((p[3] - p[0]) + (p[2] - p[1]));
    c = 0.25 * ((p[0] - p[1]) + (p[2] - p[3]));
    const Real twist = dot(c, c);
    affine = twist <= 1e-28 * (dot(a, a) + dot(b, b)); // parallelogram to round-off
  }

  /// (xi, eta) of a point: Newton from (0, 0). The first iteration is exact for a parallelogram;
  /// otherwise four or five do, because the error after a step is the square of the step. Near a
  /// corner that is almost straight an iteration only halves the error, hence the large bound.
  KOKKOS_INLINE_FUNCTION Vec2 coordinates(const Vec2& p) const
  {
    const Vec2 r = p - origin;
    Real xi = 0, eta = 0;
    const int iterations = affine ? 1 : 30;
    for (int i = 0; i < iterations; ++i)
    {
      const Vec2 da = a + eta * c;
      const Vec2 db = b + xi * c;
      const Vec2 residual = r - xi * a - eta * b - (xi * eta) * c;
      const Real determinant = cross(da, db);
      if (!(std::abs(determinant) > 1e-14 * (dot(a, a) + dot(b, b))))
      {
        lost = true;
        return {0, 0};
      }
      const Real dxi = cross(residual, db) / determinant;
      const Real deta = cross(da, residual) / determinant;
      xi += dxi;
      eta += deta;
      if (std::abs(dxi) + std::abs(deta) < 1e-12)
        break;
    }
    return {xi, eta};
  }

  /// Node weights from the means of 1, xi, eta and xi eta; their sum is 1 whatever the means are.
  KOKKOS_INLINE_FUNCTION void weights(Real xi, Real eta, Real xiEta, Real* w) const
  {
    if (nodes == 3)
    {
      w[0] = 1 - xi - eta;
      w[1] = xi;
      w[2] = eta;
      w[3] = 0;
      return;
    }
    w[0] = 0.25 * (1 - xi - eta + xiEta);
    w[1] = 0.25 * (1 + xi - eta - xiEta);
    w[2] = 0.25 * (1 + xi + eta + xiEta);
    w[3] = 0.25 * (1 - xi + eta - xiEta);
  }

  /// A nodal quantity at (xi, eta).
  KOKKOS_INLINE_FUNCTION Real interpolate(const Real* values, const Vec2& at) const
  {
    Real w[4];
    weights(at.x, at.y, at.x * at.y, w);
    Real sum = 0;
    for (int i = 0; i < nodes; ++i)
      sum += w[i] * values[i];
    return sum;
  }
};

/// Whether a quadrilateral or triangle is convex and counter-clockwise.
KOKKOS_INLINE_FUNCTION bool isConvex(const Vec2* p, int count)
{
  for (int i = 0; i < count; ++i)
  {
    const Vec2 before = p[(i + count - 1) % count], here = p[i], after = p[(i + 1) % count];
    if (!(cross(here - before, after - here) > 0))
      return false;
  }
  return true;
}
} // namespace coplane
