#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

#include <experimental/simd>

namespace coplane
{
/// Number of elements that a kernel treats side by side (CMake's COPLANE_LANES). Four doubles
/// measured best on AVX2, eight on AVX-512 where contact in 3D sets the pace. Every lane does the
/// IEEE operations of a scalar: no result depends on an element's lane or batch, nor on this.
constexpr int laneCount = COPLANE_LANES;
namespace stdx = std::experimental;
using Lanes = stdx::simd<Real, stdx::simd_abi::deduce_t<Real, laneCount>>;
using LaneMask = Lanes::mask_type;

KOKKOS_FORCEINLINE_FUNCTION Lanes lanesMin(const Lanes& a, const Lanes& b)
{
  return stdx::min(a, b);
}
KOKKOS_FORCEINLINE_FUNCTION Lanes lanesMax(const Lanes& a, const Lanes& b)
{
  return stdx::max(a, b);
}

/// Value of `a` where the mask holds, else `b`.
KOKKOS_FORCEINLINE_FUNCTION Lanes choose(const LaneMask& mask, const Lanes& a, const Lanes& b)
{
  Lanes r = b;
  stdx::where(mask, r) = a;
  return r;
}

/// Of lanes; those of Vec3 are no templates.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T norm(const Vec3Of<T>& a)
{
  return stdx::sqrt(dot(a, a));
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION Vec3Of<T> normalised(const Vec3Of<T>& a)
{
  return (1.0 / norm(a)) * a;
}
} // namespace coplane
