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

  /// Places have few digits left for how the model moves.
  bool isFarFromOrigin() const { return farthest > 1e4 * size; }
  /// What its places are known to [m].
  Real digits() const { return farthest * std::numeric_limits<Real>::epsilon(); }
};

/// Collective.
ModelExtent extentOf(const RankMesh& mesh, const Comm& comm);
} // namespace coplane
