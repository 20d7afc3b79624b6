#pragma once

#include <coplane_dynamics/Parts.hpp>

#include <cstdint>
#include <string>

namespace coplane
{
// Which planes and elements are to be looked at when the balance degrades: a line for each of the
// worst, the same on all ranks. Collective.
std::string worstByRemainder(const Parts& parts); ///< planes with the largest unexplained work
std::string deepestPlanes(const Parts& parts);
/// Both, and the elements whose volume has changed most.
std::string worstEntities(const Parts& parts);

/// Planes that are closed beyond the point at which joints.stiffness_cap makes them softer.
struct CappedPlanes
{
  std::int64_t count = 0; ///< over all ranks
  std::string first;      ///< a line for each of the farthest closed
};
CappedPlanes cappedPlanes(const Parts& parts); ///< collective; with contact only
} // namespace coplane
