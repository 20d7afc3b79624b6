#pragma once

#include <coplane_contact/FacePairSteps.hpp>

// What the energy of a pair of faces is made of (docs/theory/contact-potential.md). T is Real, or
// Lanes for several pairs side by side.

namespace coplane
{
/// Places of Gauss' rule with two points on -1..1, plus and minus, with weights of 1: exact for
/// cubics.
constexpr Real gaussPlace = 0.5773502691896258;

/// Polynomial 0 to 1 with two vanishing derivatives at both ends; constant outside 0..1.
template <class T>
struct SmoothStep
{
  T value, slope;

  KOKKOS_FORCEINLINE_FUNCTION explicit SmoothStep(const T& at)
  {
    const T z = branchFree::smaller(branchFree::positivePart(at), T(1.0));
    value = z * z * z * (10.0 + z * (6.0 * z - 15.0));
    const T rest = 1.0 - z;
    slope = 30.0 * z * z * rest * rest;
  }
};

/// Polynomial 0 to 1 with a vanishing derivative at both ends; constant outside 0..1. It begins as
/// z^2.
template <class T>
struct SoftStep
{
  T value, slope;
  T power; ///< z slope / value, at most 2

  KOKKOS_FORCEINLINE_FUNCTION explicit SoftStep(const T& at)
  {
    const T z = branchFree::smaller(branchFree::positivePart(at), T(1.0));
    value = z * z * (3.0 - 2.0 * z);
    slope = 6.0 * z * (1.0 - z);
    power = 6.0 * (1.0 - z) / (3.0 - 2.0 * z);
  }
};

/// Energy per area as a function of the closure c: square c^2 + linear c + constant.
template <class T>
struct EnergyDensity
{
  T square{}, linear{}, constant{};
};

/// Integrals over the area in contact; p is the place in the plane, c the closure there.
template <class T>
struct ContactMoments
{
  T area{};               ///< [m^2]
  T volume{};             ///< of c [m^3]
  T squares{};            ///< of c^2 [m^4]
  Vec2Of<T> areaMoment;   ///< of p [m^3]
  Vec2Of<T> volumeMoment; ///< of c p [m^4]

  KOKKOS_FORCEINLINE_FUNCTION void add(const ContactMoments& part)
  {
    area += part.area;
    volume += part.volume;
    squares += part.squares;
    areaMoment = areaMoment + part.areaMoment;
    volumeMoment = volumeMoment + part.volumeMoment;
  }
  /// The triangle between an apex and a side, with the closures of the three.
  KOKKOS_FORCEINLINE_FUNCTION void add(const Vec2Of<T>& apex, const Vec2Of<T>& from,
                                       const Vec2Of<T>& to, const T& c0, const T& ca, const T& cb)
  {
    const Vec2Of<T> a = from - apex, b = to - apex;
    const T part = 0.5 * cross(a, b), sum = c0 + ca + cb;
    const T closures = part * sum / 3.0;
    area += part;
    volume += closures;
    squares += part / 12.0 * (sum * sum + c0 * c0 + ca * ca + cb * cb);
    areaMoment = areaMoment + (part / 3.0) * (a + b) + part * apex;
    volumeMoment =
        volumeMoment + (part / 12.0) * ((sum + ca) * a + (sum + cb) * b) + closures * apex;
  }
};

/// What the energy of a pair is multiplied with beside the law.
struct ContactPotentialScale
{
  /// The energy falls to zero between these values of -n0.n1, so that pairs come and go smoothly.
  Real opposedFrom, opposedTo;
  /// The more a pair stores the wider the range: this many times the mean closure over the size of
  /// the smaller face, up to so much. So turning is no stiffer than closing, and a step follows it.
  Real widening = 2, widest = 0.5;
  /// Edges of both faces nearer than this fraction of a face across them count as one.
  Real oneEdge = 2e-4;
  /// The same for the borders of two bodies whose faces are pressed together all over: a block that
  /// is set a little off another one is not pushed off it.
  Real oneBorder = 0.01;
  /// Where the area in contact is narrower than this many closures between edges over which the
  /// bodies can leave each other, sideways is the shorter way out: between these nothing is left.
  Real wayOutFrom = 0.25, wayOutTo = 1;
  /// In two dimensions: areas are those of the whole turn about x = 0.
  bool axisymmetric;

  KOKKOS_INLINE_FUNCTION explicit ContactPotentialScale(const ContactOptions& options)
      : ContactPotentialScale(options.cosOpposed, options.axisymmetric)
  {
  }
  KOKKOS_INLINE_FUNCTION explicit ContactPotentialScale(Real cosOpposed,
                                                        bool isAxisymmetric = false)
      : opposedFrom(cosOpposed), opposedTo(3 * cosOpposed), axisymmetric(isAxisymmetric)
  {
    if (cosOpposed < 0.004)
      opposedTo = cosOpposed + 0.008;
    if (cosOpposed > 0.2)
      opposedTo = 0.5 * (1 + cosOpposed);
  }
};

/// A penalty has to carry what bodies can bear: its energy is (k/2) c^2 (1 + part z^4 / (1 + z^4))
/// with z = c / depth. At c = 0.1 of an element its pressure is 1 % above k c, at the depth 6
/// times.
struct PenaltyHardening
{
  static constexpr Real part = 5;
  /// z^4 / (1 + z^4) where the second derivative of the energy is largest, (15 - sqrt(45)) / 24: it
  /// is 12.3 k there.
  static constexpr Real steepest = 0.3455;
};

/// The factor of the energy, H.
template <class T>
struct HardenedPenalty
{
  T value;
  T slope; ///< z H'

  KOKKOS_FORCEINLINE_FUNCTION explicit HardenedPenalty(const T& z)
  {
    const T z4 = z * z * z * z, grown = z4 / (1.0 + z4);
    value = 1.0 + PenaltyHardening::part * grown;
    slope = 4.0 * PenaltyHardening::part * grown * (1.0 - grown);
  }
  /// Pressure of an even closure over k c.
  KOKKOS_INLINE_FUNCTION T pressure() const { return value + 0.5 * slope; }
};

/// Even closure of a penalty that bears what one which does not harden bears at a closure of 1: 0
/// to 1.
/// @param z that closure over the depth
inline Real hardenedClosure(Real z)
{
  Real low = 0, high = 1;
  for (int step = 0; step < 60; ++step)
  {
    const Real middle = 0.5 * (low + high);
    (middle * HardenedPenalty<Real>(middle * z).pressure() < 1 ? low : high) = middle;
  }
  return high;
}
} // namespace coplane
