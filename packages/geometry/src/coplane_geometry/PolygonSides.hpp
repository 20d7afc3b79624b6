#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_geometry/ConvexPolygon.hpp>

namespace coplane
{
/// A convex polygon as its directed sides, counter-clockwise around it but listed in no order: a
/// form that is cut without branches, so that T may be Lanes. A side that has been cut off stays in
/// the list with both ends in one place, where it adds nothing to an integral.
template <class T>
struct PolygonSides
{
  static constexpr int capacity = ConvexPolygon::capacity;
  int size = 0;
  /// A cut crossed the border more than twice (round-off, or a function that is not linear), and
  /// only the order of the sides tells what remains: take ConvexPolygon.
  branchFree::MaskOf<T> crossed{false};
  union // sides beyond the size are not set
  {
    Vec2Of<T> from[capacity];
  };
  union
  {
    Vec2Of<T> to[capacity];
  };

  KOKKOS_INLINE_FUNCTION PolygonSides() {}

  /// Whether a side has a length.
  KOKKOS_FORCEINLINE_FUNCTION branchFree::MaskOf<T> isThere(int side) const
  {
    return from[side].x != to[side].x || from[side].y != to[side].y;
  }
};

template <class T>
KOKKOS_FORCEINLINE_FUNCTION Vec2Of<T> choose(const branchFree::MaskOf<T>& mask, const Vec2Of<T>& a,
                                             const Vec2Of<T>& b)
{
  return {branchFree::choose(mask, a.x, b.x), branchFree::choose(mask, a.y, b.y)};
}

/// Part of the polygon where a function with the values `atFrom`, `atTo` at the ends of the sides,
/// linear along them, is not negative. The values become those at the new ends. The vertices that
/// are left are those of cutWhereNegative(ConvexPolygon).
template <class T>
KOKKOS_INLINE_FUNCTION void cutWhereNegative(PolygonSides<T>& sides, T* atFrom, T* atTo)
{
  using namespace branchFree;
  using Mask = MaskOf<T>;
  Mask left(false), entered(false);
  Vec2Of<T> exit, entry;
  for (int k = 0; k < sides.size; ++k)
  {
    const Vec2Of<T> p = sides.from[k], q = sides.to[k];
    const T a = atFrom[k], b = atTo[k];
    const Mask insideA = a >= 0.0, insideB = b >= 0.0;
    const Mask leaves = insideA && !insideB, enters = insideB && !insideA;
    const Vec2Of<T> cut = p + (a / (a - b)) * (q - p);
    sides.from[k] = coplane::choose(enters, cut, p);
    sides.to[k] = coplane::choose(insideB, q, coplane::choose(insideA, cut, p));
    atFrom[k] = choose(enters, T(0.0), a);
    atTo[k] = choose(leaves, T(0.0), b);
    exit = coplane::choose(leaves, cut, exit);
    entry = coplane::choose(enters, cut, entry);
    sides.crossed = sides.crossed || (left && leaves) || (entered && enters);
    left = left || leaves;
    entered = entered || enters;
  }
  if (!anyOf(left))
    return;
  sides.from[sides.size] = exit;
  sides.to[sides.size] = entry;
  atFrom[sides.size] = atTo[sides.size] = T(0.0);
  ++sides.size;
}

/// What two convex counter-clockwise polygons share; as intersection() of ConvexPolygons.
template <class T>
KOKKOS_INLINE_FUNCTION void intersect(const Vec2Of<T>* subject, int subjectSize,
                                      const Vec2Of<T>* clip, int clipSize, PolygonSides<T>& sides)
{
  sides.size = subjectSize;
  for (int i = 0; i < subjectSize; ++i)
  {
    sides.from[i] = subject[i];
    sides.to[i] = subject[i + 1 == subjectSize ? 0 : i + 1];
  }
  for (int e = 0; e < clipSize; ++e)
  {
    const Vec2Of<T> a = clip[e];
    const Vec2Of<T> edge = clip[e + 1 == clipSize ? 0 : e + 1] - a;
    T atFrom[PolygonSides<T>::capacity], atTo[PolygonSides<T>::capacity];
    for (int k = 0; k < sides.size; ++k)
    {
      atFrom[k] = cross(edge, sides.from[k] - a);
      atTo[k] = cross(edge, sides.to[k] - a);
    }
    cutWhereNegative(sides, atFrom, atTo);
  }
}

/// The sides of a polygon, in order.
KOKKOS_INLINE_FUNCTION PolygonSides<Real> sidesOf(const ConvexPolygon& polygon)
{
  PolygonSides<Real> sides;
  sides.size = polygon.size;
  for (int i = 0; i < polygon.size; ++i)
  {
    sides.from[i] = polygon.vertex[i];
    sides.to[i] = polygon.vertex[i + 1 == polygon.size ? 0 : i + 1];
  }
  return sides;
}

/// The same cut for sides in order, however often it crosses the border; they remain in order.
KOKKOS_INLINE_FUNCTION void cutInOrder(PolygonSides<Real>& sides, Real* atFrom, Real* atTo)
{
  ConvexPolygon polygon;
  for (int i = 0; i < sides.size; ++i)
    polygon.add(sides.from[i]);
  cutWhereNegative(polygon, atFrom);
  sides = sidesOf(polygon);
  for (int i = 0; i < sides.size; ++i)
    atTo[i] = atFrom[i + 1 == sides.size ? 0 : i + 1];
}

/// Area and centroid, by triangles from a vertex to the sides: a polygon far from the origin loses
/// no digits. The centroid is that vertex where there is no area.
template <class T>
KOKKOS_INLINE_FUNCTION AreaAndCentroidOf<T> areaAndCentroid(const PolygonSides<T>& sides)
{
  using namespace branchFree;
  AreaAndCentroidOf<T> result;
  Vec2Of<T> origin, moment;
  for (int k = 0; k < sides.size; ++k)
    origin = coplane::choose(sides.isThere(k), sides.from[k], origin);
  for (int k = 0; k < sides.size; ++k)
  {
    const Vec2Of<T> a = sides.from[k] - origin, b = sides.to[k] - origin;
    const T area = 0.5 * cross(a, b);
    result.area += area;
    moment = moment + (area / 3.0) * (a + b);
  }
  const Vec2Of<T> centroid = origin + (1.0 / result.area) * moment;
  result.centroid = coplane::choose(result.area > 0.0, centroid, origin);
  return result;
}
} // namespace coplane
