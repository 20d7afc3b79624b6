#pragma once

#include <coplane_element/detail/MeanGradient.hpp>

namespace coplane
{
/// Gauss points of the fully integrated elements, two along each axis of the parent square or cube,
/// weight 1 each: exact for volumes and mean gradients. Fields are given by modes
/// (MeanGradient.hpp).
template <ElementType type>
struct GaussPoints;

template <>
struct GaussPoints<ElementType::Quad4>
{
  static constexpr int count = 4;

  /// Derivatives along xi, eta at a point.
  template <class T>
  static KOKKOS_INLINE_FUNCTION void slopes(const T (&u)[3], const Real (&p)[3], T (&slope)[3])
  {
    slope[0] = u[0] + T(p[1]) * u[2];
    slope[1] = u[1] + T(p[0]) * u[2];
  }
  /// The transpose: adds to the forces on the modes.
  template <class T>
  static KOKKOS_INLINE_FUNCTION void addForces(const T (&flux)[3], const Real (&p)[3], T (&f)[3])
  {
    f[0] += flux[0];
    f[1] += flux[1];
    f[2] += T(p[1]) * flux[0] + T(p[0]) * flux[1];
  }
};

template <>
struct GaussPoints<ElementType::Hex8>
{
  static constexpr int count = 8;

  template <class T>
  static KOKKOS_INLINE_FUNCTION void slopes(const T (&u)[7], const Real (&p)[3], T (&slope)[3])
  {
    slope[0] = u[0] + T(p[2]) * u[4] + T(p[1]) * u[5] + T(p[1] * p[2]) * u[6];
    slope[1] = u[1] + T(p[2]) * u[3] + T(p[0]) * u[5] + T(p[2] * p[0]) * u[6];
    slope[2] = u[2] + T(p[1]) * u[3] + T(p[0]) * u[4] + T(p[0] * p[1]) * u[6];
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION void addForces(const T (&flux)[3], const Real (&p)[3], T (&f)[7])
  {
    f[0] += flux[0];
    f[1] += flux[1];
    f[2] += flux[2];
    f[3] += T(p[2]) * flux[1] + T(p[1]) * flux[2];
    f[4] += T(p[2]) * flux[0] + T(p[0]) * flux[2];
    f[5] += T(p[1]) * flux[0] + T(p[0]) * flux[1];
    f[6] += T(p[1] * p[2]) * flux[0] + T(p[2] * p[0]) * flux[1] + T(p[0] * p[1]) * flux[2];
  }
};

/// Parent coordinates of Gauss point q: the signs of xi, eta, zeta are its bits.
inline void gaussPoint(int q, Real (&p)[3])
{
  constexpr Real a = 0.57735026918962576451; // 1 / sqrt(3)
  for (int k = 0; k < 3; ++k)
    p[k] = (q >> k) & 1 ? a : -a;
}
} // namespace coplane
