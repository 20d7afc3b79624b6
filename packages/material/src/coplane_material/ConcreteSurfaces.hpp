#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_core/Real.hpp>

namespace coplane
{
/// Strengths of concrete by Malvar et al. (1997), von Mises stresses over the pressure (positive in
/// compression), and their section over the Lode angle by Willam and Warnke (1975).
struct ConcreteSurfaces
{
  Real strength;            ///< fc, in uniaxial compression [Pa]
  Real tensileStrength;     ///< ft, in uniaxial tension [Pa]
  Real biaxialRatio = 1.15; ///< biaxial over uniaxial compressive strength [-]

  // On the compression meridian: intact a0 fc + p / (a1 + a2 p / fc), crushed p / (a1f + a2f p /
  // fc), and the ratio of the meridians over p / fc.
  static constexpr Real a0 = 0.2956, a1 = 0.4463, a2 = 0.0808, a1f = 0.4417, a2f = 0.1183;
  static constexpr Real farPressure = 3, farRatio = 0.753;
  static constexpr Real roundPressure = 8.45; ///< from here on the section is round

  /// Fracture surface of the intact material over p >= 0.
  template <class T>
  KOKKOS_INLINE_FUNCTION T intactStrength(const T& p) const
  {
    return T(a0 * strength) + p / (T(a1) + T(a2 / strength) * p);
  }

  /// What crushed material bears, over p >= 0.
  template <class T>
  KOKKOS_INLINE_FUNCTION T residualStrength(const T& p) const
  {
    return p / (T(a1f) + T(a2f / strength) * p);
  }

  /// The line through uniaxial tension and compression, which limits the strength at low pressure.
  /// @param left share of ft that is left
  template <class T>
  KOKKOS_INLINE_FUNCTION T tensionLine(const T& p, const T& left) const
  {
    return T(strength / (strength / 3 + tensileStrength)) * (p + left * T(tensileStrength));
  }

  /// psi: strength on the meridian of triaxial tension over that of compression.
  template <class T>
  KOKKOS_INLINE_FUNCTION T meridianRatio(const T& p) const
  {
    const Real knee = strength / 3, biaxial = 2 * biaxialRatio * strength / 3;
    const Real first = 0.5 + 1.5 * tensileStrength / strength;
    const Real second = biaxialRatio * strength / intactStrength(biaxial);
    const Real far = farPressure * strength, round = roundPressure * strength;
    const auto line = [&](Real p0, Real v0, Real p1, Real v1)
    { return T(v0) + (p - T(p0)) * T((v1 - v0) / (p1 - p0)); };
    T psi = branchFree::choose(p < T(round), line(far, farRatio, round, 1.0), T(1.0));
    psi = branchFree::choose(p < T(far), line(biaxial, second, far, farRatio), psi);
    psi = branchFree::choose(p < T(biaxial), line(knee, first, biaxial, second), psi);
    return branchFree::choose(p < T(knee), T(first), psi);
  }

  /// r(theta) of Willam and Warnke; c = cos(theta).
  template <class T>
  KOKKOS_INLINE_FUNCTION static T lodeFactor(const T& c, const T& psi)
  {
    const T one(1.0), two(2.0), four(4.0);
    const T a = four * (one - psi * psi) * c * c;
    const T root = branchFree::squareRoot(a + T(5.0) * psi * psi - four * psi);
    return (two * (one - psi * psi) * c + (two * psi - one) * root) /
           (a + (one - two * psi) * (one - two * psi));
  }
};
} // namespace coplane
