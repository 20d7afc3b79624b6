#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <limits>

namespace coplane
{
/// Where a model lies, by the coordinates of its mesh.
struct ModelExtent
{
  Real size = 0;     ///< longest side of the box around it [m]
  Real farthest = 0; ///< largest coordinate [m]

  /// Sums of motions that are no longer than digits() would go astray.
  bool isFarFromOrigin() const { return farthest > 1e3 * size; }
  /// Contacts know too little of their closure there.
  bool hasFewDigits() const { return digits() > 1e-12 * size; }
  /// What its places are known to [m].
  Real digits() const { return farthest * std::numeric_limits<Real>::epsilon(); }
};

/// Collective.
ModelExtent extentOf(const RankMesh& mesh, const Comm& comm);
} // namespace coplane
