#pragma once

#include <coplane_contact/AreaOfContact.hpp>

namespace coplane
{
namespace detail
{
/// A polygon whose sides know whose edge they are: 0..3 an edge of the outline of face 0, 4..7 of
/// face 1, closureLine: where the closure is zero, crushedLine: where a joint ceases to be crushed,
/// noEdge: none of these.
template <class T>
struct OwnedSides
{
  static constexpr int noEdge = -1, closureLine = -2, crushedLine = -3;
  bool crushed = false; ///< the closure there counts from where the joint is crushed to
  PolygonSides<T> sides;
  int owner[PolygonSides<T>::capacity];
};

/// Cuts where the values are negative; the new side belongs to `owner`.
template <class T>
KOKKOS_INLINE_FUNCTION void cutOwned(OwnedSides<T>& polygon, T* atFrom, T* atTo, int owner)
{
  const int before = polygon.sides.size;
  cutWhereNegative(polygon.sides, atFrom, atTo);
  if (polygon.sides.size > before)
    polygon.owner[before] = owner;
}

/// The same for sides in order, however often the border is crossed; they remain in order.
KOKKOS_INLINE_FUNCTION void cutOwnedInOrder(OwnedSides<Real>& polygon, const Real* at, int owner)
{
  const OwnedSides<Real> old = polygon;
  int size = 0;
  const auto add = [&](const Vec2& p, int its)
  {
    if (size == PolygonSides<Real>::capacity)
      return;
    polygon.sides.from[size] = p;
    polygon.owner[size++] = its;
  };
  for (int i = 0; i < old.sides.size; ++i)
  {
    const int j = i + 1 == old.sides.size ? 0 : i + 1;
    const Vec2 p = old.sides.from[i], q = old.sides.from[j];
    const Vec2 cut = p + (at[i] / (at[i] - at[j])) * (q - p);
    if (at[i] >= 0)
      add(p, old.owner[i]);
    if (at[i] >= 0 && at[j] < 0)
      add(cut, owner);
    if (at[i] < 0 && at[j] > 0)
      add(cut, old.owner[i]);
  }
  polygon.sides.size = size;
  for (int i = 0; i < size; ++i)
    polygon.sides.to[i] = polygon.sides.from[i + 1 == size ? 0 : i + 1];
}
} // namespace detail
} // namespace coplane
