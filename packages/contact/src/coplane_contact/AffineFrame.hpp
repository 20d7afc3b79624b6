#pragma once

#include <coplane_contact/AreaOfContact.hpp>
#include <coplane_contact/Plane.hpp>

namespace coplane
{
/// A linear function of the place in a plane.
struct LinearOnPlane
{
  Real atOrigin = 0;
  Vec2 slope;

  KOKKOS_INLINE_FUNCTION Real at(const Vec2& p) const { return atOrigin + dot(slope, p); }
};

/// Affine coordinates of a face, which its nodes carry along: a place is the mean of the nodes plus
/// the coordinates times two axes. The weights of the nodes there are linear in the coordinates,
/// and reproduce the place; those of evenWeights() where a quadrilateral is convex. A quadrilateral
/// has coordinates of -1/2 to 1/2, and axes that span its area; a segment has one coordinate.
struct AffineFrame
{
  int count = 0;
  Vec2 center, axis[2];
  Vec2 dual[2]; ///< slopes of the coordinates [1/m]

  KOKKOS_INLINE_FUNCTION AffineFrame() {}
  KOKKOS_INLINE_FUNCTION explicit AffineFrame(const Shadow& shadow) : count(shadow.count)
  {
    for (int i = 0; i < count; ++i)
    {
      center = center + (1.0 / count) * shadow.p[i];
      for (int c = 0; c < 2; ++c)
        axis[c] = axis[c] + weightChange(i, c) * shadow.p[i];
    }
    if (count == 2)
    {
      dual[0] = {1 / axis[0].x, 0};
      return;
    }
    const Real area = cross(axis[0], axis[1]);
    if (!(area != 0))
      return; // folded; carries nothing
    dual[0] = (1 / area) * Vec2{axis[1].y, -axis[1].x};
    dual[1] = (1 / area) * Vec2{-axis[0].y, axis[0].x};
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
  KOKKOS_INLINE_FUNCTION Vec2 weightSlope(int node) const
  {
    return weightChange(node, 0) * dual[0] + weightChange(node, 1) * dual[1];
  }

  KOKKOS_INLINE_FUNCTION LinearOnPlane onPlane(const LinearOnFace& crushing) const
  {
    const Vec2 slope = crushing.along[0] * dual[0] + crushing.along[1] * dual[1];
    return {crushing.atCenter - dot(slope, center), slope};
  }
  KOKKOS_INLINE_FUNCTION LinearOnFace onFace(const LinearOnPlane& crushing) const
  {
    return {crushing.at(center), {dot(crushing.slope, axis[0]), dot(crushing.slope, axis[1])}};
  }
};
} // namespace coplane
