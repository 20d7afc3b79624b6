#pragma once

#include <coplane_core/Vec3.hpp>
#include <coplane_dynamics/Solver.hpp>

#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// Where a plane is looked for now, and of which joint card; empty: of any.
struct WantedPlane
{
  Vec3 place{}; ///< [m]
  std::string joint;
};

/// Names with units and values of what history has of a plane.
using PlaneValues = std::vector<std::pair<std::string, Real>>;

/// Of the planes of all ranks that have touched and whose faces overlap, those whose points of
/// contact are nearest; of equals the one of the lower key. Values count on rank 0; without any
/// plane they are 0, and the distance is not a number. Collective.
std::vector<PlaneValues> nearestPlanes(const Solver& solver,
                                       const std::vector<WantedPlane>& wanted);
} // namespace coplane
