#pragma once

#include <coplane_geometry/ConvexPolygon.hpp>
#include <coplane_geometry/FaceCorners.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
/// The common plane as seen by an observer who looks against its normal.
class View
{
public:
  View(const Vec3& normal, const Vec3& origin, int dimension)
      : normal_(normal), origin_(origin), dimension_(dimension)
  {
    const Vec3 any = dimension == 2             ? Vec3{0, 0, 1}
                     : std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0}
                                                : Vec3{0, 1, 0};
    e1_ = normalised(cross(any, normal));
    e2_ = cross(normal, e1_);
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
    const Vec3 foot = origin_ + p.x * e1_ + (dimension_ == 2 ? 0 : p.y) * e2_;
    return dot(centerOf(corners, count) - foot, area) / dot(normal_, area);
  }

private:
  Vec2 at(const Vec3& x) const
  {
    const Vec3 r = x - origin_;
    return {dot(e1_, r), dimension_ == 2 ? 0 : dot(e2_, r)};
  }

  Vec3 normal_, origin_, e1_, e2_;
  int dimension_;
};
} // namespace coplane
