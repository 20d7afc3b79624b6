#pragma once

#include <coplane_geometry/Vec2.hpp>

namespace coplane
{
/// Convex polygon, counter-clockwise, in a fixed array: nothing is allocated in kernels. Two
/// quadrilaterals share at most an octagon; one more cut adds one vertex.
struct ConvexPolygon
{
  static constexpr int capacity = 12;
  int size;
  union // vertices beyond the size are not set: the kernel makes millions of polygons
  {
    Vec2 vertex[capacity];
  };

  KOKKOS_INLINE_FUNCTION ConvexPolygon() : size(0) {}

  KOKKOS_INLINE_FUNCTION void add(const Vec2& p)
  {
    if (size < capacity)
      vertex[size++] = p;
  }
};

/// Part of the polygon where the function with values `d` at its vertices, linear between them, is
/// not negative; `d` becomes the values at the vertices that are left. Sutherland and Hodgman 1974.
KOKKOS_INLINE_FUNCTION void cutWhereNegative(ConvexPolygon& polygon, Real* d)
{
  Real least = infinity;
  for (int i = 0; i < polygon.size; ++i)
    least = d[i] < least ? d[i] : least;
  if (!(least < 0))
    return;
  ConvexPolygon kept;
  Real keptValues[ConvexPolygon::capacity];
  const auto keep = [&](const Vec2& p, Real value)
  {
    if (kept.size == ConvexPolygon::capacity)
      return;
    keptValues[kept.size] = value;
    kept.vertex[kept.size++] = p;
  };
  for (int i = 0; i < polygon.size; ++i)
  {
    const int j = i + 1 == polygon.size ? 0 : i + 1;
    if (d[i] >= 0)
      keep(polygon.vertex[i], d[i]);
    if ((d[i] > 0 && d[j] < 0) || (d[i] < 0 && d[j] > 0))
    {
      const Real t = d[i] / (d[i] - d[j]);
      keep(polygon.vertex[i] + t * (polygon.vertex[j] - polygon.vertex[i]), 0);
    }
  }
  polygon.size = kept.size;
  for (int i = 0; i < kept.size; ++i)
  {
    polygon.vertex[i] = kept.vertex[i];
    d[i] = keptValues[i];
  }
}

/// Part of `subject` inside the convex counter-clockwise polygon `clip`. Polygons that only share
/// an edge or a vertex give something of zero area. No snapping: coincident vertices only add
/// triangles without area.
KOKKOS_INLINE_FUNCTION ConvexPolygon intersection(const ConvexPolygon& subject,
                                                  const ConvexPolygon& clip)
{
  ConvexPolygon result;
  result.size = subject.size;
  for (int i = 0; i < subject.size; ++i)
    result.vertex[i] = subject.vertex[i];
  for (int e = 0; e < clip.size && result.size > 0; ++e)
  {
    const Vec2 a = clip.vertex[e];
    const Vec2 edge = clip.vertex[e + 1 == clip.size ? 0 : e + 1] - a;
    Real d[ConvexPolygon::capacity];
    for (int i = 0; i < result.size; ++i)
      d[i] = cross(edge, result.vertex[i] - a);
    cutWhereNegative(result, d);
  }
  return result;
}

/// Area [m^2] and centre of gravity of a polygon.
template <class T>
struct AreaAndCentroidOf
{
  T area{};
  Vec2Of<T> centroid;
};
using AreaAndCentroid = AreaAndCentroidOf<Real>;

/// By a fan about vertex 0 in relative coordinates, so that a polygon far from the origin loses no
/// digits.
KOKKOS_INLINE_FUNCTION AreaAndCentroid areaAndCentroid(const ConvexPolygon& polygon)
{
  AreaAndCentroid result;
  if (polygon.size == 0)
    return result;
  const Vec2 origin = polygon.vertex[0];
  Vec2 moment;
  for (int i = 1; i + 1 < polygon.size; ++i)
  {
    const Vec2 a = polygon.vertex[i] - origin;
    const Vec2 b = polygon.vertex[i + 1] - origin;
    const Real area = 0.5 * cross(a, b);
    result.area += area;
    moment = moment + (area / 3) * (a + b);
  }
  result.centroid = result.area > 0 ? origin + (1 / result.area) * moment : origin;
  return result;
}
} // namespace coplane
