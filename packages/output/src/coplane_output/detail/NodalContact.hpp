#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

#include <vector>

namespace coplane
{
class Solver;

/// What the owned nodes see of the planes on the faces around them. The owner of a node holds all
/// planes of its faces, and they are visited in the order of their keys, so the values have the
/// same bits on any number of ranks. All are zero for a node whose faces carry no plane.
struct NodalContact
{
  /// Mean of the normal tractions of the planes, weighted with their areas [Pa].
  std::vector<Real> pressure;
  /// Force of the planes on the node's side over their area: pressure and shear [Pa].
  std::vector<Vec3> traction;
  /// Mean closure of the planes that are not open, weighted with their areas [m].
  std::vector<Real> closure;
  /// The smallest gap, the offset of declared joints taken off: negative where faces overlap [m].
  std::vector<Real> gap;
  /// The longest slip path [m].
  std::vector<Real> slip;
  /// 0 no plane, 1 open, 2 stick, 3 slip: the highest of the planes' states.
  std::vector<Real> state;
};

NodalContact nodalContact(const Solver& solver);
} // namespace coplane
