#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <limits>

namespace coplane
{
/// Where a model lies, by the coordinates of its mesh.
struct Extent
{
  Real size = 0;     ///< longest side of the box around it [m]
  Real farthest = 0; ///< largest coordinate [m]

  /// What its places are known to [m].
  Real digits() const { return farthest * std::numeric_limits<Real>::epsilon(); }
};

/// Collective.
Extent extentOf(const RankMesh& mesh, const Comm& comm);
} // namespace coplane
