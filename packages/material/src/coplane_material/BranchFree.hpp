#pragma once

#include <coplane_core/Lanes.hpp>
#include <coplane_core/Real.hpp>

#include <cmath>

// The few operations that a law or an element kernel needs in the same spelling for one number
// (Real) and for several elements side by side (Lanes). Each is one IEEE operation, so a lane has
// the bits of the scalar.
namespace coplane::branchFree
{
KOKKOS_INLINE_FUNCTION Real choose(bool mask, Real a, Real b)
{
  return mask ? a : b;
}
inline Lanes choose(const LaneMask& mask, const Lanes& a, const Lanes& b)
{
  return coplane::choose(mask, a, b);
}

KOKKOS_INLINE_FUNCTION Real squareRoot(Real a)
{
  return std::sqrt(a);
}
inline Lanes squareRoot(const Lanes& a)
{
  return stdx::sqrt(a);
}

/// max(a, 0). A value that is not a number gives 0.
template <class T>
KOKKOS_INLINE_FUNCTION T positivePart(const T& a)
{
  return branchFree::choose(a > T(0.0), a, T(0.0));
}

/// The larger of a and b; b when a is not a number.
template <class T>
KOKKOS_INLINE_FUNCTION T larger(const T& a, const T& b)
{
  return branchFree::choose(a > b, a, b);
}
} // namespace coplane::branchFree
