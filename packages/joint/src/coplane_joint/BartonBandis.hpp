#pragma once

#include <coplane_core/Real.hpp>

#include <Kokkos_Core.hpp>

#include <cmath>

namespace coplane
{
/// Shear strength of a rough joint (Barton and Choubey 1977; mobilisation by Barton 1982): friction
/// angle phi_r + JRC_mob log10(JCS / sigma), at most 70 degrees, where JRC_mob rises with the slip
/// path to JRC at `peakSlip` and then falls; the joint dilates by half of the part above phi_r.
struct BartonBandis
{
  Real roughness = 0;     ///< JRC [-]
  Real wallStrength = 0;  ///< JCS [Pa]
  Real residualAngle = 0; ///< phi_r [rad]
  Real peakSlip = 1;      ///< slip at which all of the roughness is mobilised [m]

  static constexpr Real degree = pi / 180;
  static constexpr Real largestAngle = 70 * degree;

  /// JRC_mob / JRC over slip / peakSlip from 0.3 on; before that friction alone is mobilised.
  KOKKOS_INLINE_FUNCTION static Real mobilised(Real ratio)
  {
    constexpr int count = 7;
    const Real at[count] = {.3, .6, 1, 2, 4, 10, 100};
    const Real share[count] = {0, .75, 1, .85, .7, .5, 0};
    if (ratio <= at[0])
      return 0;
    for (int i = 1; i < count; ++i)
      if (ratio < at[i])
      {
        const Real t = (ratio - at[i - 1]) / (at[i] - at[i - 1]);
        return share[i - 1] + t * (share[i] - share[i - 1]);
      }
    return 0;
  }

  /// Angle that mobilised roughness adds to phi_r [rad].
  KOKKOS_INLINE_FUNCTION Real roughnessAngle(Real sigma, Real slip) const
  {
    if (!(sigma < wallStrength))
      return 0;
    const Real share = mobilised(slip / peakSlip);
    if (share <= 0)
      return 0;
    const Real angle = share * roughness * std::log10(wallStrength / sigma) * degree;
    return angle < largestAngle - residualAngle ? angle : largestAngle - residualAngle;
  }

  /// tau / sigma.
  KOKKOS_INLINE_FUNCTION Real friction(Real sigma, Real slip) const
  {
    const Real ratio = slip / peakSlip;
    if (ratio < .3)
      return std::tan(residualAngle * ratio / .3);
    return std::tan(residualAngle + roughnessAngle(sigma, slip));
  }

  /// Opening per slip.
  KOKKOS_INLINE_FUNCTION Real dilation(Real sigma, Real slip) const
  {
    return std::tan(0.5 * roughnessAngle(sigma, slip));
  }
};

/// Closure curve of a fresh rough joint at its first loading, by the estimates of Bandis, Lumsden
/// and Barton (1983): in MPa and mm, aperture a = JRC/5 (0.2 sigma_c/JCS - 0.1), k_ni = -7.15 +
/// 1.75 JRC + 0.02 JCS/a, c_m = -0.296 - 0.0056 JRC + 2.241 (JCS/a)^-0.245. Outside of the range of
/// the measured joints the numbers may not be positive: the caller checks.
struct BandisEstimate
{
  Real aperture = 0;         ///< [m]
  Real initialStiffness = 0; ///< k_ni [Pa/m]
  Real maximumClosure = 0;   ///< c_m [m]
};

inline BandisEstimate bandisEstimate(Real roughness, Real wallStrength, Real rockStrength)
{
  const Real aperture = roughness / 5 * (0.2 * rockStrength / wallStrength - 0.1); // [mm]
  const Real ratio = wallStrength / 1e6 / aperture;                                // [MPa/mm]
  BandisEstimate estimate;
  estimate.aperture = 1e-3 * aperture;
  estimate.initialStiffness = 1e9 * (-7.15 + 1.75 * roughness + 0.02 * ratio);
  estimate.maximumClosure = 1e-3 * (-0.296 - 0.0056 * roughness + 2.241 * std::pow(ratio, -0.245));
  return estimate;
}
} // namespace coplane
