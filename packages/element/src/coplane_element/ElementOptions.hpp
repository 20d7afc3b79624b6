#pragma once

#include <coplane_core/Real.hpp>

namespace coplane
{
/// What a mesh in two dimensions is a section of.
enum class Geometry
{
  PlaneStrain, ///< a body without motion across the plane; per metre of depth
  Axisymmetric ///< a body of revolution: x is the distance from the axis, y runs along it; masses,
               ///< forces and energies of the whole turn
};

/// How strain and stress vary in an element. docs/theory/elements.md says what each is good for.
enum class ElementForm
{
  OnePoint,             ///< mean gradient; hourglass control by HourglassOptions
  AssumedStrain,        ///< mean gradient; hourglass modes as stiff as in exact bending
  FullIntegration,      ///< 2 x 2 or 2 x 2 x 2 points, one dilatation (B-bar)
  FullIntegrationPlain, ///< the same without B-bar: locks where the volume is kept
  NodalPressure         ///< triangles and tetrahedra: dilatation averaged at the nodes
};

/// How stress turns with the material.
enum class ObjectiveRate
{
  HughesWinget, ///< rotation of the step by the spin: second order
  Jaumann,      ///< the same spin, first order
  GreenNaghdi   ///< rotation of the polar decomposition
};

struct ElementOptions
{
  ElementForm form = ElementForm::OnePoint;
  ObjectiveRate rate = ObjectiveRate::HughesWinget;
  Geometry geometry = Geometry::PlaneStrain;
};

inline bool isFullyIntegrated(ElementForm form)
{
  return form == ElementForm::FullIntegration || form == ElementForm::FullIntegrationPlain;
}

/// Resistance against the deformations that the one-point strain does not see (Flanagan and
/// Belytschko 1981).
struct HourglassOptions
{
  Real stiffness = 0.05; ///< fraction of the stiffness of the element's fastest mode [-]
  Real viscosity = 0;    ///< fraction of critical damping of the hourglass modes [-]
};

/// Pressure q = rho l r (linear c_d + quadratic l r) against compression at the rate r = <-tr D>
/// (von Neumann and Richtmyer).
struct BulkViscosity
{
  Real linear = 0.06;
  Real quadratic = 1.5;
};
} // namespace coplane
