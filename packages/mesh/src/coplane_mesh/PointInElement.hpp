#pragma once

#include <coplane_core/Vec3.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <array>

namespace coplane
{
/// Where a point lies in an element.
struct PointInElement
{
  /// Shape functions of the corners there, linear in each natural coordinate; their sum is 1 [-].
  std::array<Real, 8> weights{};
  /// How far it lies beyond the nearest side, in natural coordinates, in which an element has the
  /// size 1 (triangles, tetrahedra) or 2; not above 0 inside. Infinity where the map has no
  /// inverse.
  Real outside = 0;
};

/// Inverts the map of an element: sum of weights times corners is `x`. Triangles and tetrahedra by
/// their areas and volumes, quadrilaterals and hexahedra by Newton's method to round-off.
/// @param corners as many as topology(type).nodes, in its order [m]
PointInElement pointInElement(ElementType type, const Vec3* corners, const Vec3& x);
} // namespace coplane
