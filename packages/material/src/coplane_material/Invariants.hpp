#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// tr(s) / 3.
template <class T>
KOKKOS_INLINE_FUNCTION T meanOf(const SymTensorOf<T>& s)
{
  return T(1.0 / 3.0) * (s.xx + s.yy + s.zz);
}

template <class T>
KOKKOS_INLINE_FUNCTION SymTensorOf<T> deviatorOf(const SymTensorOf<T>& s)
{
  const T mean = meanOf(s);
  return {s.xx - mean, s.yy - mean, s.zz - mean, s.xy, s.yz, s.zx};
}

/// a:b.
template <class T>
KOKKOS_INLINE_FUNCTION T contract(const SymTensorOf<T>& a, const SymTensorOf<T>& b)
{
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz +
         T(2.0) * (a.xy * b.xy + a.yz * b.yz + a.zx * b.zx);
}

/// a + factor b.
template <class T>
KOKKOS_INLINE_FUNCTION SymTensorOf<T> sumOf(const SymTensorOf<T>& a, const T& factor,
                                            const SymTensorOf<T>& b)
{
  return {a.xx + factor * b.xx, a.yy + factor * b.yy, a.zz + factor * b.zz,
          a.xy + factor * b.xy, a.yz + factor * b.yz, a.zx + factor * b.zx};
}

/// scale s + mean I.
template <class T>
KOKKOS_INLINE_FUNCTION SymTensorOf<T> stressOf(const SymTensorOf<T>& s, const T& scale,
                                               const T& mean)
{
  return {scale * s.xx + mean, scale * s.yy + mean, scale * s.zz + mean,
          scale * s.xy,        scale * s.yz,        scale * s.zx};
}

/// a where the mask holds, else b.
template <class T>
KOKKOS_INLINE_FUNCTION SymTensorOf<T> chosen(const branchFree::MaskOf<T>& mask,
                                             const SymTensorOf<T>& a, const SymTensorOf<T>& b)
{
  using branchFree::choose;
  return {choose(mask, a.xx, b.xx), choose(mask, a.yy, b.yy), choose(mask, a.zz, b.zz),
          choose(mask, a.xy, b.xy), choose(mask, a.yz, b.yz), choose(mask, a.zx, b.zx)};
}

/// q = sqrt(3/2 s:s) of a deviator.
template <class T>
KOKKOS_INLINE_FUNCTION T vonMisesOf(const SymTensorOf<T>& deviator)
{
  return branchFree::squareRoot(T(1.5) * contract(deviator, deviator));
}

/// The same with bending within the element, MaterialPoint::bendingSquared.
template <class T>
KOKKOS_INLINE_FUNCTION T vonMisesOf(const SymTensorOf<T>& deviator, const T& bendingSquared)
{
  return branchFree::squareRoot(T(1.5) * contract(deviator, deviator) + bendingSquared);
}

/// Part of the plastic work that is not of bending.
/// @param q of both [Pa]
template <class T>
KOKKOS_INLINE_FUNCTION T partOfMean(const T& q, const T& bendingSquared)
{
  return branchFree::choose(bendingSquared > T(0.0),
                            branchFree::positivePart(T(1.0) - bendingSquared / (q * q)), T(1.0));
}

/// Third invariant of a symmetric tensor.
template <class T>
KOKKOS_INLINE_FUNCTION T determinantOf(const SymTensorOf<T>& s)
{
  return s.xx * (s.yy * s.zz - s.yz * s.yz) - s.xy * (s.xy * s.zz - s.yz * s.zx) +
         s.zx * (s.xy * s.yz - s.yy * s.zx);
}

/// cos(3 theta) of a deviator with von Mises stress q: 1 on the meridian of triaxial tension, -1 on
/// that of compression; 1 where q is 0.
template <class T>
KOKKOS_INLINE_FUNCTION T cosineOfLode(const SymTensorOf<T>& deviator, const T& q)
{
  // (3 sqrt3 / 2) J3 / J2^1.5 with J2 = q^2 / 3
  const T value = T(13.5) * determinantOf(deviator) / (q * q * q);
  const T below = branchFree::choose(value < T(1.0), value, T(1.0)); // also for 0 / 0
  return branchFree::choose(below > T(-1.0), below, T(-1.0));
}
} // namespace coplane
