#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_geometry/Vec2.hpp>

namespace coplane
{
/// Inverse isoparametric map of a triangle or quadrilateral in a plane. Triangle: xi, eta are
/// barycentric. Quadrilateral: p(xi, eta) = origin + xi a + eta b + xi eta c, xi, eta in [-1, 1].
///
/// With c = alpha a + beta b the straight coordinates (those of the parallelogram spanned by a and
/// b) of a point are xi + alpha s and eta + beta s, where s = xi eta. They are linear in the point,
/// and s follows from them by a quadratic equation: nothing is iterated.
/// T is Real, or Lanes for several faces side by side.
template <class T>
struct FaceMapOf
{
  int nodes = 4;
  branchFree::MaskOf<T> affine{true}; ///< triangle, or parallelogram to round-off
  /// Set when the face is flat, or when a point had no coordinates.
  mutable branchFree::MaskOf<T> lost{false};
  Vec2Of<T> origin, gradXi, gradEta; ///< of the straight coordinates
  T alpha{}, beta{};

  KOKKOS_INLINE_FUNCTION FaceMapOf() = default;

  KOKKOS_INLINE_FUNCTION FaceMapOf(const Vec2Of<T>* p, int count) : nodes(count)
  {
    using namespace branchFree;
    Vec2Of<T> a, b, c;
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
    const T determinant = cross(a, b);
    lost = !(absolute(determinant) > 1e-14 * (dot(a, a) + dot(b, b)));
    if (allOf(lost))
      return;
    const T inverse = 1.0 / determinant;
    gradXi = {inverse * b.y, -inverse * b.x};
    gradEta = {-inverse * a.y, inverse * a.x};
    const T along = dot(gradXi, c), across = dot(gradEta, c);
    affine = absolute(along) + absolute(across) <= 1e-14;
    alpha = choose(affine, T(0.0), along);
    beta = choose(affine, T(0.0), across);
  }

  KOKKOS_FORCEINLINE_FUNCTION Vec2Of<T> straight(const Vec2Of<T>& p) const
  {
    const Vec2Of<T> r = p - origin;
    return {dot(gradXi, r), dot(gradEta, r)};
  }

  /// s = xi eta of a point from its straight coordinates: the root of alpha beta s^2 - b s + q = 0
  /// that is q / b for small alpha and beta.
  /// @param wanted where nobody wants the product, a point without coordinates does no harm
  KOKKOS_FORCEINLINE_FUNCTION T
  product(const Vec2Of<T>& straight,
          const branchFree::MaskOf<T>& wanted = branchFree::MaskOf<T>(true)) const
  {
    using namespace branchFree;
    const T q = straight.x * straight.y;
    if (allOf(affine || !wanted))
      return q;
    const T b = 1.0 + alpha * straight.y + beta * straight.x;
    const T discriminant = b * b - 4.0 * (alpha * beta) * q;
    const T denominator = b + squareRoot(positivePart(discriminant));
    const branchFree::MaskOf<T> found = denominator > 1e-14;
    lost = lost || (wanted && !affine && !found);
    return choose(affine, q, choose(found, 2.0 * q / denominator, T(0.0)));
  }

  /// (xi, eta) of a point.
  KOKKOS_INLINE_FUNCTION Vec2Of<T> coordinates(const Vec2Of<T>& p) const
  {
    const Vec2Of<T> s = straight(p);
    const T xiEta = product(s);
    return {s.x - alpha * xiEta, s.y - beta * xiEta};
  }

  /// Node weights from the means of xi, eta and xi eta; their sum is 1 whatever the means are.
  KOKKOS_INLINE_FUNCTION void weights(const T& xi, const T& eta, const T& xiEta, T* w) const
  {
    if (nodes == 3)
    {
      w[0] = 1.0 - xi - eta;
      w[1] = xi;
      w[2] = eta;
      w[3] = 0.0;
      return;
    }
    w[0] = 0.25 * (1.0 - xi - eta + xiEta);
    w[1] = 0.25 * (1.0 + xi - eta - xiEta);
    w[2] = 0.25 * (1.0 + xi + eta + xiEta);
    w[3] = 0.25 * (1.0 - xi + eta - xiEta);
  }

  /// Node weights from the mean of a set of points and their mean s = xi eta: they reproduce the
  /// mean point to round-off, whatever s is.
  KOKKOS_INLINE_FUNCTION void weightsAt(const Vec2Of<T>& mean, const T& xiEta, T* w) const
  {
    const Vec2Of<T> c = straight(mean);
    weights(c.x - alpha * xiEta, c.y - beta * xiEta, xiEta, w);
  }

  /// A nodal quantity at (xi, eta).
  KOKKOS_INLINE_FUNCTION T interpolate(const T* values, const Vec2Of<T>& at) const
  {
    T w[4];
    weights(at.x, at.y, at.x * at.y, w);
    T sum(0.0);
    for (int i = 0; i < nodes; ++i)
      sum += w[i] * values[i];
    return sum;
  }
};
using FaceMap = FaceMapOf<Real>;

/// A nodal quantity (height) over a face: mean + xi X + eta Y + warp s in its straight coordinates
/// X, Y and s = xi eta. A face whose heights are linear in the plane has no warp, whatever its
/// shape.
template <class T>
struct FaceHeightsOf
{
  T mean{}, xi{}, eta{}, warp{};

  KOKKOS_INLINE_FUNCTION FaceHeightsOf(const FaceMapOf<T>& map, const T* h)
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
using FaceHeights = FaceHeightsOf<Real>;

/// Whether a quadrilateral or triangle is convex and counter-clockwise.
template <class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T> isConvex(const Vec2Of<T>* p, int count)
{
  branchFree::MaskOf<T> convex(true);
  for (int i = 0; i < count; ++i)
  {
    const Vec2Of<T>&before = p[i == 0 ? count - 1 : i - 1], &here = p[i],
          &after = p[i + 1 == count ? 0 : i + 1];
    convex = convex && cross(here - before, after - here) > 0.0;
  }
  return convex;
}
} // namespace coplane
