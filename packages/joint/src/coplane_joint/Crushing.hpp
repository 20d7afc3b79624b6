#pragma once

#include <coplane_core/Real.hpp>

#include <Kokkos_Core.hpp>

#include <cmath>

namespace coplane
{
/// Compressive strength of a joint over its crushing k, the inelastic relative displacement
/// (Lourenco and Rots 1997): from a third of the strength along a parabola to the strength at
/// `peak`, along a parabola to half of it, and from there exponentially to what is left of it.
///
/// As a loading curve over the closure C = k + f(k) / k_n it unloads with the secant stiffness f /
/// (f / k_n + loss k): a part `loss` of k is given back as the joint unloads, the rest is permanent
/// (simpler than the curves of Oliveira and Lourenço 2004). Under shear tau the strength is an
/// ellipse, sigma^2 + shearWeight tau^2 = f(k)^2.
struct Crushing
{
  static constexpr Real initial = 1.0 / 3, middle = 0.5; ///< of the strength [-]

  Real strength = 0;    ///< f_m [Pa]; 0: the joint is not crushed
  Real peak = 0;        ///< k_p [m]
  Real length = 1;      ///< of the parabola after the peak, k_m - k_p [m]
  Real residual = 0.1;  ///< of the strength that is left in the end [-]
  Real shearWeight = 9; ///< C_ss [-]
  Real loss = 0;        ///< of stiffness: 0 plastic, 1 damage only [-]

  KOKKOS_INLINE_FUNCTION bool acts() const { return strength > 0; }

  /// Of the parabola, from the energy G_fc after the peak and above the residual strength: G_fc =
  /// f_m L (5/6 - r + (1/2 - r)^2), L 67/75 f_m for a tenth.
  static Real lengthFrom(Real strength, Real energy, Real residual)
  {
    const Real tail = middle - residual;
    return energy /
           (strength * (1 - (1 - middle) / 3 - residual + tail * tail / (2 * (1 - middle))));
  }

  /// Largest fall of the strength over the crushing [Pa/m].
  KOKKOS_INLINE_FUNCTION Real steepest() const { return 2 * (1 - middle) * strength / length; }

  /// f(k) [Pa].
  KOKKOS_INLINE_FUNCTION Real strengthAt(Real k) const
  {
    if (k < peak)
    {
      const Real x = k / peak;
      return strength * (initial + (1 - initial) * std::sqrt(x * (2 - x)));
    }
    const Real y = (k - peak) / length;
    if (y < 1)
      return strength * (1 - (1 - middle) * (y * y));
    return strength * (residual + (middle - residual) * std::exp(-(k - peak - length) / decay()));
  }

  /// Integral of f from 0 to k [J/m^2].
  KOKKOS_INLINE_FUNCTION Real workTo(Real k) const
  {
    const Real before = k < peak ? k : peak;
    // Of sqrt(x (2 - x)): (acos(1 - x) - (1 - x) sqrt(x (2 - x))) / 2.
    const Real x = before / peak;
    Real work =
        strength * (initial * before + (1 - initial) * peak * 0.5 *
                                           (std::acos(1 - x) - (1 - x) * std::sqrt(x * (2 - x))));
    if (!(k > peak))
      return work;
    const Real after = k - peak < length ? k - peak : length, y = after / length;
    work += strength * after * (1 - (1 - middle) / 3 * (y * y));
    const Real rest = k - peak - length;
    if (rest > 0)
      work += strength *
              (residual * rest + (middle - residual) * decay() * -std::expm1(-rest / decay()));
    return work;
  }

  /// k of first loading to a closure C = k + f(k) / stiffness [m].
  KOKKOS_INLINE_FUNCTION Real crushedAt(Real closure, Real stiffness) const
  {
    const Real beyond = stiffness * closure - initial * strength;
    if (!(beyond > 0))
      return 0;
    const Real rise = (1 - initial) * strength, b = stiffness * peak;
    if (beyond < rise + b)
    {
      const Real root = rise * rise + beyond * (2 * b - beyond);
      return peak *
             (beyond * beyond / (rise * rise + beyond * b + rise * std::sqrt(root > 0 ? root : 0)));
    }
    const Real fall = (1 - middle) * strength, whole = stiffness * length;
    const Real past = beyond - rise - b;
    if (past < whole - fall)
      return peak + length * (2 * past / (whole + std::sqrt(whole * whole - 4 * fall * past)));
    // The residual is convex and rises at its root: Newton's method from the right is monotone.
    const Real height = (middle - residual) * strength;
    const Real target = past - whole + fall + height;
    Real z = target / stiffness;
    const Real scale = z + peak + length;
    for (int i = 0; i < 50; ++i)
    {
      const Real left = height * std::exp(-z / decay());
      const Real step = (target - stiffness * z - left) / (stiffness - left / decay());
      z += step;
      if (!(-step > 1e-16 * scale))
        break;
    }
    return peak + length + (z > 0 ? z : 0);
  }

  /// Closure from which on a joint is crushed that has never been [m].
  KOKKOS_INLINE_FUNCTION Real onset(Real stiffness) const { return initial * strength / stiffness; }
  /// Closure of first loading that crushes it so much [m].
  KOKKOS_INLINE_FUNCTION Real closureOf(Real k, Real stiffness) const
  {
    return k + strengthAt(k) / stiffness;
  }

  /// The most crushing of up to so much that bears a compression; the peak where none does [m].
  KOKKOS_INLINE_FUNCTION Real crushedUpTo(Real compression, Real most) const
  {
    if (most <= peak || strengthAt(most) >= compression)
      return most;
    // The strength falls from the peak on.
    Real low = peak, high = most;
    for (int i = 0; i < 60 && high - low > 1e-15 * most; ++i)
    {
      const Real middle = 0.5 * (low + high);
      (strengthAt(middle) >= compression ? low : high) = middle;
    }
    return low;
  }

  /// Slope of unloading [Pa/m].
  KOKKOS_INLINE_FUNCTION Real unloading(Real k, Real stiffness) const
  {
    if (!(loss > 0))
      return stiffness;
    const Real f = strengthAt(k);
    return f / (f / stiffness + loss * k);
  }

  /// By how much a joint is more compliant that is crushed further [m/Pa].
  KOKKOS_INLINE_FUNCTION Real softened(Real from, Real to, Real stiffness) const
  {
    return loss > 0 ? 1 / unloading(to, stiffness) - 1 / unloading(from, stiffness) : 0;
  }

  /// Closure under a compression that rises to it [m]; beyond the strength that of the strength.
  KOKKOS_INLINE_FUNCTION Real closureUnder(Real compression, Real stiffness) const
  {
    const Real sigma = compression < strength ? compression : strength;
    const Real s = (sigma / strength - initial) / (1 - initial);
    // s = sqrt(x (2 - x)).
    const Real x = s > 0 ? s * s / (1 + std::sqrt((1 - s) * (1 + s))) : 0;
    return sigma / stiffness + peak * x;
  }

private:
  /// Over which the exponential part falls to 1/e, so that the slope has no corner [m].
  KOKKOS_INLINE_FUNCTION Real decay() const
  {
    return (middle - residual) * length / (2 * (1 - middle));
  }
};
} // namespace coplane
