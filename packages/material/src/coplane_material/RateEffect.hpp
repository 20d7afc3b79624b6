#pragma once

#include <coplane_core/ElementaryFunctions.hpp>
#include <coplane_material/Invariants.hpp>

namespace coplane
{
/// Strength of concrete at a strain rate over that of slow tests, in tension by Malvar and Ross
/// (1998), in compression by the CEB (1990). With x the logarithm of the rate over the slow one
/// both are exp(d x) up to x = ln 10^6, and grow with the third root of the rate from there:
/// tension from 1e-6/s, d = 1 / (1 + 0.8 fc/MPa), knee at 1/s; compression from 3e-5/s, d = 1.026 /
/// (5 + 0.9 fc/MPa), knee at 30/s. The branches meet at the knee. Rates are positive [1/s].
/// Beyond the knees specimens resist by the inertia of what is beside the crack, or of the sides
/// that bulge; elements have that by themselves, so a law should end there.
struct RateEffect
{
  // Rates from which strength grows no more [1/s]; 0: no effect.
  Real largestTension = 0;
  Real largestCompression = 0;
  Real tensileExponent = 0;     ///< d [-]
  Real compressiveExponent = 0; ///< d [-]

  static constexpr Real slowTension = 1e-6, slowCompression = 3e-5;    // [1/s]
  static constexpr Real kneeOfTension = 1.0, kneeOfCompression = 30.0; // [1/s]

  KOKKOS_INLINE_FUNCTION bool counts() const { return largestTension > 0; }

  template <class T>
  KOKKOS_INLINE_FUNCTION T tension(const T& rate) const
  {
    return factor(rate, largestTension, slowTension, tensileExponent);
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION T compression(const T& rate) const
  {
    return factor(rate, largestCompression, slowCompression, compressiveExponent);
  }

private:
  template <class T>
  KOKKOS_INLINE_FUNCTION T factor(const T& rate, Real largest, Real slow, Real exponent) const
  {
    const Real knee = 6 * std::log(10.0);
    const T capped = branchFree::smaller(rate, T(largest));
    const T x = branchFree::logarithm(branchFree::larger(capped * T(1 / slow), T(1.0)));
    return branchFree::exponential(T(exponent) * branchFree::smaller(x, T(knee)) +
                                   T(1.0 / 3.0) * branchFree::positivePart(x - T(knee)));
  }
};

/// For a compressive strength [Pa], up to a rate [1/s]; 0: up to the knees.
inline RateEffect rateEffectOf(Real strength, Real largest)
{
  return {largest > 0 ? largest : RateEffect::kneeOfTension,
          largest > 0 ? largest : RateEffect::kneeOfCompression, 1 / (1 + 0.8e-6 * strength),
          1.026 / (5 + 0.9e-6 * strength)};
}

/// Largest principal value by its size: of a strain rate, that along the axis of a uniaxial test.
template <class T>
KOKKOS_INLINE_FUNCTION T largestPrincipal(const SymTensorOf<T>& d)
{
  const SymTensorOf<T> deviator = deviatorOf(d);
  const T mean = meanOf(d), q = vonMisesOf(deviator);
  const T one(1.0), half(0.5), halfRootOf3(0.86602540378443864676);
  // Of an angle between 0 and 60 degrees, and of that and 120 degrees.
  const T cosine = branchFree::cosineOfThird(cosineOfLode(deviator, q));
  const T sine = branchFree::squareRoot((one - cosine) * (one + cosine));
  const T most = mean + T(2.0 / 3.0) * q * cosine;
  const T least = mean - T(2.0 / 3.0) * q * (half * cosine + halfRootOf3 * sine);
  return branchFree::larger(branchFree::absolute(most), branchFree::absolute(least));
}
} // namespace coplane
