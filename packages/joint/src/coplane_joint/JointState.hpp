#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// What a plane keeps of its joint card once it is fitted to a pair of faces.
struct JointFit
{
  Real normalStiffness = 0;     ///< slope of the closure curve at zero closure [Pa/m]
  Real stiffnessCap = infinity; ///< largest slope of the closure curve [Pa/m]
  Real shearStiffness = 0;      ///< [Pa/m]
};

/// History of a plane.
struct JointState
{
  Real maximumClosure = 0;       ///< largest closure so far; of a joint that is crushed, that which
                                 ///< first loading without shear needs to crush it as much [m]
  Vec3 shearTraction{};          ///< on the face with the higher id [Pa]
  Real slip = 0;                 ///< length of the slip path [m]
  Real opening = 0;              ///< inelastic opening [m]
  Real shearing = 0;             ///< inelastic slip of the bond [m]
  bool absorbed = false;         ///< the gap at which it is closed has one of the mesh in it
  bool absorbedUnevenly = false; ///< and that changes along the faces
  bool bonded = false;           ///< carries tension and cohesion until broken
  float crushedAtCenter = 0; ///< of a plane that is crushed unevenly: its crushing at the centre of
                             ///< face 0; may be negative there [m]
};

/// How the closure is spread over the area of a plane: linearly, so that a bond is bent. Means over
/// the area; what is open has a closure below zero.
struct BondBending
{
  Real mean = 0;        ///< closure [m]
  Real opened = 0;      ///< opening where it is largest [m]
  Real openSquares = 0; ///< mean of the square of the closure where it is open, 0 elsewhere [m^2]
  Real closedMean = 0;  ///< mean of the closure where it is closed, 0 elsewhere [m]

  /// The same closure everywhere.
  static KOKKOS_INLINE_FUNCTION BondBending even(Real closure)
  {
    BondBending bending;
    bending.mean = closure;
    if (closure > 0)
      bending.closedMean = closure;
    else
    {
      bending.opened = -closure;
      bending.openSquares = closure * closure;
    }
    return bending;
  }
};

/// What a step gives, with the increments of dissipated work per area.
struct JointResponse
{
  Real normalTraction = 0;  ///< compression positive; negative: tension of a bonded joint [Pa]
  Real normalStiffness = 0; ///< slope of the branch in use [Pa/m]
  Real bondStiffness = 0;   ///< of a bond that resists bending: slope where it is open [Pa/m]
  bool slipping = false;
  Real frictionWork = 0; ///< [J/m^2]
  Real fractureWork = 0; ///< [J/m^2]
  Real curveWork = 0;    ///< hysteresis of a closure curve that stiffens [J/m^2]
  Real crushed = 0;      ///< by how much crushing closes the joint for good [m]
  Real softened = 0;     ///< by how much crushing makes it more compliant [m/Pa]
  Real dilation = 0;     ///< by which the plane's offset rises in this step [m]; the tractions are
                         ///< those at the raised offset
  Real lift = 0;         ///< what of that slip has lifted [m]
  Real liftWork = 0;     ///< what frictionWork is without, for the lift at this closure [J/m^2]
  bool crushedByShear = false; ///< and the maximum closure raised by it

  /// Work of closing that does not come back [J/m^2]: of crushing, what the mean of the
  /// compressions before and after the step does and does not store, to round-off.
  /// @param before normal traction before the step [Pa]
  KOKKOS_INLINE_FUNCTION Real hysteresisWork(Real before) const
  {
    const Real from = before > 0 ? before : 0, to = normalTraction > 0 ? normalTraction : 0;
    return curveWork + 0.5 * ((from + to) * crushed + from * to * softened);
  }

  /// Work of slip that does not come back: less what lifts the faces against the mean of the
  /// tractions before and after the step, for a lift that presses within it [J/m^2].
  /// @param before normal traction before the step [Pa]
  KOKKOS_INLINE_FUNCTION Real workOfSlip(Real before) const
  {
    return frictionWork + liftWork - 0.5 * (before + normalTraction) * lift;
  }
};
} // namespace coplane
