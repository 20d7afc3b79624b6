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

/// Joints that have taken more energy to be crushed than their law says. A cycle resists with the
/// strength of the cycle before, so that those do which close far in a step. With forces from a
/// potential; of joints whose faces share half of their area or more, and judged as if it were all.
struct CrushedJoints
{
  Real taken = 0;    ///< by those that have taken at least a tenth more, over all ranks [J]
  Real lawful = 0;   ///< what their law takes for as much crushing, at most [J]
  std::string worst; ///< a line for each of those that took most beyond that
};
CrushedJoints crushedJoints(const Parts& parts); ///< collective; with contact only
} // namespace coplane
