#pragma once

#include <coplane_core/Real.hpp>

#include <Kokkos_Core.hpp>

namespace coplane
{
/// Point of a plane, in coordinates along two axes of that plane [m]. T is Real, or Lanes for
/// several planes side by side.
template <class T>
struct Vec2Of
{
  T x{}, y{};
};
using Vec2 = Vec2Of<Real>;

template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr Vec2Of<T> operator+(const Vec2Of<T>& a, const Vec2Of<T>& b)
{
  return {a.x + b.x, a.y + b.y};
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr Vec2Of<T> operator-(const Vec2Of<T>& a, const Vec2Of<T>& b)
{
  return {a.x - b.x, a.y - b.y};
}
template <class T, class S>
KOKKOS_FORCEINLINE_FUNCTION constexpr Vec2Of<T> operator*(const S& s, const Vec2Of<T>& a)
{
  return {s * a.x, s * a.y};
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr T dot(const Vec2Of<T>& a, const Vec2Of<T>& b)
{
  return a.x * b.x + a.y * b.y;
}
/// z component of the cross product: twice the signed area of the triangle (0, a, b).
template <class T>
KOKKOS_FORCEINLINE_FUNCTION constexpr T cross(const Vec2Of<T>& a, const Vec2Of<T>& b)
{
  return a.x * b.y - a.y * b.x;
}
} // namespace coplane
