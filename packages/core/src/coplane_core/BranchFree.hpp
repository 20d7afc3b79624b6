#pragma once

#include <coplane_core/Lanes.hpp>
#include <coplane_core/Real.hpp>

#include <cmath>

// The few operations that a law or a kernel needs in the same spelling for one number
// (Real) and for several elements or pairs of faces side by side (Lanes). Each is one IEEE
// operation or one call of the mathematics library per lane, so a lane has the bits of the scalar.
namespace coplane::branchFree
{
template <class T>
using MaskOf = decltype(T() > T());

KOKKOS_FORCEINLINE_FUNCTION Real choose(bool mask, Real a, Real b)
{
  return mask ? a : b;
}
using coplane::choose; // of lanes

KOKKOS_FORCEINLINE_FUNCTION bool anyOf(bool mask)
{
  return mask;
}
KOKKOS_FORCEINLINE_FUNCTION bool anyOf(const LaneMask& mask)
{
  return stdx::any_of(mask);
}

KOKKOS_FORCEINLINE_FUNCTION bool allOf(bool mask)
{
  return mask;
}
KOKKOS_FORCEINLINE_FUNCTION bool allOf(const LaneMask& mask)
{
  return stdx::all_of(mask);
}

/// How many numbers a T holds.
template <class T>
constexpr int widthOf = 1;
template <>
inline constexpr int widthOf<Lanes> = laneCount;

/// The number or the answer in one lane.
KOKKOS_FORCEINLINE_FUNCTION Real lane(Real a, int)
{
  return a;
}
KOKKOS_FORCEINLINE_FUNCTION Real lane(const Lanes& a, int i)
{
  return a[i];
}
KOKKOS_FORCEINLINE_FUNCTION bool lane(bool a, int)
{
  return a;
}
KOKKOS_FORCEINLINE_FUNCTION bool lane(const LaneMask& a, int i)
{
  return a[i];
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION Vec3 lane(const Vec3Of<T>& a, int i)
{
  return {lane(a.x, i), lane(a.y, i), lane(a.z, i)};
}

KOKKOS_FORCEINLINE_FUNCTION void addInLane(Vec3& a, int, const Vec3& b)
{
  a += b;
}
KOKKOS_FORCEINLINE_FUNCTION void addInLane(Vec3Of<Lanes>& a, int i, const Vec3& b)
{
  a.x[i] = a.x[i] + b.x;
  a.y[i] = a.y[i] + b.y;
  a.z[i] = a.z[i] + b.z;
}

/// get(0), get(1), ... side by side.
template <class T, class Get>
KOKKOS_FORCEINLINE_FUNCTION T gathered(const Get& get)
{
  if constexpr (widthOf<T> == 1)
    return get(0);
  else
    return T([&](auto i) { return Real(get(int(i))); });
}

KOKKOS_FORCEINLINE_FUNCTION Real squareRoot(Real a)
{
  return std::sqrt(a);
}
KOKKOS_FORCEINLINE_FUNCTION Lanes squareRoot(const Lanes& a)
{
  return stdx::sqrt(a);
}

KOKKOS_FORCEINLINE_FUNCTION Real absolute(Real a)
{
  return std::fabs(a);
}
KOKKOS_FORCEINLINE_FUNCTION Lanes absolute(const Lanes& a)
{
  return stdx::fabs(a);
}

KOKKOS_FORCEINLINE_FUNCTION Real power(Real a, Real b)
{
  return std::pow(a, b);
}
inline Lanes power(const Lanes& a, Real b)
{
  return Lanes([&](auto lane) { return std::pow(Real(a[lane]), b); });
}

KOKKOS_FORCEINLINE_FUNCTION Real cubeRoot(Real a)
{
  return std::cbrt(a);
}
inline Lanes cubeRoot(const Lanes& a)
{
  return Lanes([&](auto lane) { return std::cbrt(Real(a[lane])); });
}

/// max(a, 0). A value that is not a number gives 0.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T positivePart(const T& a)
{
  return branchFree::choose(a > T(0.0), a, T(0.0));
}

/// The larger of a and b; b when a is not a number.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T larger(const T& a, const T& b)
{
  return branchFree::choose(a > b, a, b);
}

/// The smaller of a and b; b when a is not a number.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T smaller(const T& a, const T& b)
{
  return branchFree::choose(a < b, a, b);
}

/// Where a falling function f meets zero, in the lanes of `active`; `upper` in the others.
/// Regula falsi with halved ends (Illinois), with a bisection every fourth time, which no shape of
/// f can hold up. A lane that has converged is frozen, so it has the bits of the scalar.
/// @param fLower, fUpper f at the ends; where fUpper is positive the answer is `upper`, where
///        fLower is not, `lower`
/// @param tolerance of f
template <class T, class F>
KOKKOS_INLINE_FUNCTION T fallingRoot(const F& f, T lower, T upper, T fLower, T fUpper,
                                     const T& tolerance, MaskOf<T> active)
{
  const T zero(0.0), half(0.5);
  T root = branchFree::choose(active && !(fLower > zero), lower, upper);
  active = active && fLower > zero && fUpper < zero;
  T side(0.0); // 1: the lower end moved last, -1: the upper one
  for (int i = 0; i < 200 && anyOf(active); ++i)
  {
    T x = half * (lower + upper);
    if (i % 4 != 3)
    {
      const T secant = upper - fUpper * (upper - lower) / (fUpper - fLower);
      x = branchFree::choose(secant > lower && secant < upper, secant, x);
    }
    const T fx = f(x);
    root = branchFree::choose(active, x, root);
    const auto below = fx > zero; // x is below the root
    const auto inside = x > lower && x < upper;
    fUpper = branchFree::choose(below, branchFree::choose(side > zero, half * fUpper, fUpper), fx);
    fLower = branchFree::choose(below, fx, branchFree::choose(side < zero, half * fLower, fLower));
    lower = branchFree::choose(below, x, lower);
    upper = branchFree::choose(below, upper, x);
    side = branchFree::choose(below, T(1.0), T(-1.0));
    active = active && inside && absolute(fx) > tolerance;
  }
  return root;
}
} // namespace coplane::branchFree
