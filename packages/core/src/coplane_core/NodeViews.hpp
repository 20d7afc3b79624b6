#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

#include <Kokkos_Core.hpp>

namespace coplane
{
/// One vector per node: positions [m], velocities [m/s], forces [N]. Three components also in two
/// dimensions (z = 0).
using NodeVectors = Kokkos::View<Real* [3], Kokkos::LayoutRight, Kokkos::HostSpace>;
using ConstNodeVectors = Kokkos::View<const Real* [3], Kokkos::LayoutRight, Kokkos::HostSpace>;

KOKKOS_INLINE_FUNCTION Vec3 at(const ConstNodeVectors& vectors, int node)
{
  return {vectors(node, 0), vectors(node, 1), vectors(node, 2)};
}

/// Making a view of constants out of one of variables counts references, which costs far more than
/// to look.
KOKKOS_INLINE_FUNCTION Vec3 at(const NodeVectors& vectors, int node)
{
  return {vectors(node, 0), vectors(node, 1), vectors(node, 2)};
}

KOKKOS_INLINE_FUNCTION void set(const NodeVectors& vectors, int node, const Vec3& value)
{
  vectors(node, 0) = value.x;
  vectors(node, 1) = value.y;
  vectors(node, 2) = value.z;
}
} // namespace coplane
