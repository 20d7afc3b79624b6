#pragma once

#include <coplane_contact/Plane.hpp>
#include <coplane_core/Prefetch.hpp>

#include <cstddef>

namespace coplane
{
/// What all planes of a face add to its nodes.
struct FaceLoad
{
  Vec3 force[4] = {}; ///< [N]
  Real stiffness = 0; ///< bound on the stiffness that a node feels [N/m]

  /// Adds a plane of which this face is number `side`, 0 or 1.
  KOKKOS_FORCEINLINE_FUNCTION void add(const Plane& plane, int side)
  {
    for (int k = 0; k < 4; ++k)
      force[k] += plane.nodal[side][k];
    stiffness += plane.nodeStiffness;
  }
  /// Brings what add() reads into the cache.
  static KOKKOS_FORCEINLINE_FUNCTION void prefetchFrom(const Plane& plane, int side)
  {
    static_assert(offsetof(Plane, nodal) == 64 && sizeof(Plane::nodal) == 3 * 64);
    prefetch(&plane.nodal[side]);
    prefetch(&plane.nodeStiffness);
  }
};
} // namespace coplane
