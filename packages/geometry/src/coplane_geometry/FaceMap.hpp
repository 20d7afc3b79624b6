#pragma once

#include <coplane_geometry/ConvexPolygon.hpp>

#include <cmath>

namespace coplane
{
/// Inverse isoparametric map of a triangle or quadrilateral in a plane. Triangle: xi, eta are
/// barycentric. Quadrilateral: p(xi, eta) = origin + xi a + eta b + xi eta c, xi, eta in [-1, 1].
///
/// With c = alpha a + beta b the straight coordinates (those of the parallelogram spanned by a and
/// b) of a point are xi + alpha s and eta + beta s, where s = xi eta. They are linear in the point,
/// and s follows from them by a quadratic equation: nothing is iterated.
struct FaceMap
{
  int nodes = 4;
  bool affine = true; ///< triangle, or parallelogram to round-off
  /// Set when the face is flat, or when a point had no coordinates.
  mutable bool lost = false;
  Vec2 origin, gradXi, gradEta; ///< of the straight coordinates
  Real alpha = 0, beta = 0;

  KOKKOS_INLINE_FUNCTION FaceMap() = default;

  KOKKOS_INLINE_FUNCTION FaceMap(const Vec2* p, int count) : nodes(count)
  {
    Vec2 a, b, c;
    if (count == 3)
    {
      origin = p[0];
      a = p[1] - p[0];
      b = p[2] - p[0];
    }
    else
    {
      origin = 0.25 * ((p[0] + p[1]) + (p[2] + p[3]));
      a = 0.25 * ((p[1] - p[0]) + (p[2] - p[3]));
      b = 0.25 * ((p[3] - p[0]) + (p[2] - p[1]));
      c = 0.25 * ((p[0] - p[1]) + (p[2] - p[3]));
    }
    const Real determinant = cross(a, b);
    if (!(std::abs(determinant) > 1e-14 * (dot(a, a) + dot(b, b))))
    {
      lost = true;
      return;
    }
    const Real inverse = 1 / determinant;
    gradXi = {inverse * b.y, -inverse * b.x};
    gradEta = {-inverse * a.y, inverse * a.x};
    const Real along = dot(gradXi, c), across = dot(gradEta, c);
    affine = std::abs(along) + std::abs(across) <= 1e-14;
    alpha = affine ? 0 : along;
    beta = affine ? 0 : across;
  }

  KOKKOS_INLINE_FUNCTION Vec2 straight(const Vec2& p) const
  {
    const Vec2 r = p - origin;
    return {dot(gradXi, r), dot(gradEta, r)};
  }

  /// s = xi eta of a point from its straight coordinates: the root of alpha beta s^2 - b s + q = 0
  /// that is q / b for small alpha and beta.
  KOKKOS_INLINE_FUNCTION Real product(const Vec2& straight) const
  {
    const Real q = straight.x * straight.y;
    if (affine)
      return q;
    const Real b = 1 + alpha * straight.y + beta * straight.x;
    const Real discriminant = b * b - 4 * (alpha * beta) * q;
    const Real denominator = b + std::sqrt(discriminant > 0 ? discriminant : 0);
    if (!(denominator > 1e-14))
    {
      lost = true;
      return 0;
    }
    return 2 * q / denominator;
  }

  /// (xi, eta) of a point.
  KOKKOS_INLINE_FUNCTION Vec2 coordinates(const Vec2& p) const
  {
    const Vec2 s = straight(p);
    const Real xiEta = product(s);
    return {s.x - alpha * xiEta, s.y - beta * xiEta};
  }

  /// Node weights from the means of xi, eta and xi eta; their sum is 1 whatever the means are.
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

  /// Node weights from the mean of a set of points and their mean s = xi eta: they reproduce the
  /// mean point to round-off, whatever s is.
  KOKKOS_INLINE_FUNCTION void weightsAt(const Vec2& mean, Real xiEta, Real* w) const
  {
    const Vec2 c = straight(mean);
    weights(c.x - alpha * xiEta, c.y - beta * xiEta, xiEta, w);
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

/// A nodal quantity (height) over a face: mean + xi X + eta Y + warp s in its straight coordinates
/// X, Y and s = xi eta. A face whose heights are linear in the plane has no warp, whatever its
/// shape.
struct FaceHeights
{
  Real mean = 0, xi = 0, eta = 0, warp = 0;

  KOKKOS_INLINE_FUNCTION FaceHeights(const FaceMap& map, const Real* h)
  {
    if (map.nodes == 3)
    {
      mean = h[0];
      xi = h[1] - h[0];
      eta = h[2] - h[0];
      return;
    }
    mean = 0.25 * ((h[0] + h[1]) + (h[2] + h[3]));
    xi = 0.25 * ((h[1] - h[0]) + (h[2] - h[3]));
    eta = 0.25 * ((h[3] - h[0]) + (h[2] - h[1]));
    warp = 0.25 * ((h[0] - h[1]) + (h[2] - h[3])) - map.alpha * xi - map.beta * eta;
  }
};

/// Whether a quadrilateral or triangle is convex and counter-clockwise.
KOKKOS_INLINE_FUNCTION bool isConvex(const Vec2* p, int count)
{
  for (int i = 0; i < count; ++i)
  {
    const Vec2 before = p[i == 0 ? count - 1 : i - 1], here = p[i],
               after = p[i + 1 == count ? 0 : i + 1];
    if (!(cross(here - before, after - here) > 0))
      return false;
  }
  return true;
}
} // namespace coplane
