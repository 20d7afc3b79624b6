#pragma once

#include <coplane_contact/AreaOfContact.hpp>
#include <coplane_contact/Plane.hpp>

namespace coplane
{
/// A linear function of the place in a plane.
template <class T>
struct LinearOnPlaneOf
{
  T atOrigin{};
  Vec2Of<T> slope{};

  KOKKOS_INLINE_FUNCTION T at(const Vec2Of<T>& p) const { return atOrigin + dot(slope, p); }
};
using LinearOnPlane = LinearOnPlaneOf<Real>;

/// Affine coordinates of a face, which its nodes carry along: a place is the mean of the nodes plus
/// the coordinates times two axes. The weights of the nodes there are linear in the coordinates,
/// and reproduce the place; those of evenWeights() where a quadrilateral is convex. A quadrilateral
/// has coordinates of -1/2 to 1/2, and axes that span its area; a segment has one coordinate.
template <class T>
struct AffineFrameOf
{
  int count = 0;
  Vec2Of<T> center{}, axis[2]{};
  Vec2Of<T> dual[2]{}; ///< slopes of the coordinates [1/m]; 0 where the face has no area

  KOKKOS_INLINE_FUNCTION AffineFrameOf() {}
  KOKKOS_INLINE_FUNCTION explicit AffineFrameOf(const ShadowOf<T>& shadow) : count(shadow.count)
  {
    for (int i = 0; i < count; ++i)
    {
      center = center + (1.0 / count) * shadow.p[i];
      for (int c = 0; c < 2; ++c)
        axis[c] = axis[c] + weightChange(i, c) * shadow.p[i];
    }
    if (count == 2)
    {
      dual[0] = {1.0 / axis[0].x, T(0.0)};
      return;
    }
    const T area = cross(axis[0], axis[1]);
    const T inverse = branchFree::choose(area != 0.0, 1.0 / area, T(0.0));
    dual[0] = inverse * Vec2Of<T>{axis[1].y, -axis[1].x};
    dual[1] = inverse * Vec2Of<T>{-axis[0].y, axis[0].x};
  }

  /// Of the weight of a node with a coordinate.
  KOKKOS_INLINE_FUNCTION Real weightChange(int node, int coordinate) const
  {
    if (count == 2)
      return coordinate == 1 ? 0 : node == 0 ? -1 : 1;
    if (count == 3)
      return node == 0 ? -1 : node == coordinate + 1 ? 1 : 0;
    const bool positive = coordinate == 0 ? node == 1 || node == 2 : node >= 2;
    return positive ? 0.5 : -0.5;
  }
  /// Slope of the weight of a node [1/m].
  KOKKOS_INLINE_FUNCTION Vec2Of<T> weightSlope(int node) const
  {
    return weightChange(node, 0) * dual[0] + weightChange(node, 1) * dual[1];
  }

  /// @param atCenter, along as of LinearOnFace
  KOKKOS_INLINE_FUNCTION LinearOnPlaneOf<T> onPlane(const T& atCenter, const T& along0,
                                                    const T& along1) const
  {
    const Vec2Of<T> slope = along0 * dual[0] + along1 * dual[1];
    return {atCenter - dot(slope, center), slope};
  }
  KOKKOS_INLINE_FUNCTION LinearOnPlane onPlane(const LinearOnFace& length) const
  {
    return onPlane(length.atCenter, length.along[0], length.along[1]);
  }
  KOKKOS_INLINE_FUNCTION LinearOnFace onFace(const LinearOnPlane& length) const
  {
    return {length.at(center), {dot(length.slope, axis[0]), dot(length.slope, axis[1])}};
  }
};
using AffineFrame = AffineFrameOf<Real>;
} // namespace coplane
