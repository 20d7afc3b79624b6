#pragma once

#include <coplane_geometry/ConvexPolygon.hpp>
#include <coplane_geometry/FaceCorners.hpp>
#include <coplane_geometry/PlaneAxes.hpp>

#include <algorithm>

namespace coplane
{
/// The common plane as seen by an observer who looks against its normal.
class View
{
public:
  View(const Vec3& normal, const Vec3& origin, int dimension)
      : normal_(normal), origin_(origin), axes_(planeAxes(normal, dimension)), dimension_(dimension)
  {
  }

  /// Shadow of a face, counter-clockwise; a segment of two dimensions has a width of 1 m.
  ConvexPolygon shadow(const Vec3* corners, int count) const
  {
    ConvexPolygon polygon;
    if (dimension_ == 2)
    {
      const Real a = at(corners[0]).x, b = at(corners[1]).x;
      for (const Vec2& p : {Vec2{std::min(a, b), 0}, Vec2{std::max(a, b), 0},
                            Vec2{std::max(a, b), 1}, Vec2{std::min(a, b), 1}})
        polygon.add(p);
      return polygon;
    }
    for (int k = 0; k < count; ++k)
      polygon.add(at(corners[k]));
    Real twice = 0;
    for (int k = 0; k < count; ++k)
      twice += cross(polygon.vertex[k], polygon.vertex[(k + 1) % count]);
    if (twice < 0)
      std::reverse(polygon.vertex, polygon.vertex + count);
    return polygon;
  }

  /// Height of a face over the plane at a point of it: that of the flat face through its middle.
  Real height(const Vec3* corners, int count, const Vec2& p) const
  {
    const Vec3 area = vectorArea(corners, count, dimension_);
    const Vec3 foot = origin_ + p.x * axes_.e1 + p.y * axes_.e2;
    return dot(centerOf(corners, count) - foot, area) / dot(normal_, area);
  }

private:
  Vec2 at(const Vec3& x) const
  {
    const Vec3 r = x - origin_;
    return {dot(axes_.e1, r), dot(axes_.e2, r)};
  }

  Vec3 normal_, origin_;
  PlaneAxes axes_; ///< in two dimensions the second one is zero
  int dimension_;
};
} // namespace coplane
