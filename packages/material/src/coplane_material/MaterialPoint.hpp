#pragma once

#include <coplane_core/Lanes.hpp>
#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// Most numbers that a law may remember of a point.
constexpr int maximumHistory = 40;

/// What destroyed material keeps of its stiffness, so that hourglass modes do not run free and
/// steps stay bounded: least values of MaterialPoint::integrity and MaterialPoint::stiffening.
constexpr Real leastStiffness = 0.02;

/// A material point over one step, or laneCount of them side by side: T is Real or Lanes. The
/// interface of every law.
template <class T>
struct MaterialPoint
{
  // Given.
  Real dt = 0;                    ///< [s]
  SymTensorOf<T> strainIncrement; ///< D dt at the half step, tensor shear components [-]
  Mat3Of<T> displacementGradient; ///< L dt at the half step: increments of displacement over the
                                  ///< positions in the middle of the step [-]
  Mat3Of<T> rotation;             ///< of the step; tensors in the history turn with it
  T volumeRatio = T(1.0);         ///< volume at the end of the step over the reference volume
  T halfVolumeRatio = T(1.0);     ///< the same at the half step
  T energy = T(0.0);              ///< internal energy at the start of the step, with the work of
                                  ///< the bulk viscosity in it, per reference volume [J/m^3]
  T size = T(1.0);                ///< of the element: V^(1/3), in two dimensions A^(1/2) [m]

  // In and out.
  SymTensorOf<T> oldStress;  ///< at the start, not rotated: only given [Pa]
  SymTensorOf<T> stress;     ///< in: rotated with the step; out: at its end [Pa]
  T history[maximumHistory]; ///< the law's own variables, as many as it has

  // Out.
  T dissipation = T(0.0); ///< of the step, per volume now [J/m^3]
  T stiffening = T(1.0);  ///< tangent modulus over the elastic one, for the stable step
  T integrity = T(1.0);   ///< 1 intact, 0 destroyed: by which hourglass stiffness falls

  // Of laws with Law::hasStrength: bending within the element is one more component of the
  // deviator, which flows with the others.
  T bendingSquared = T(0.0); ///< in: its part in the squared von Mises stress before flow [Pa^2]
  T bendingScale = T(1.0);   ///< out: by which it falls; its work is not in `dissipation`
};
} // namespace coplane
