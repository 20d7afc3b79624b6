#pragma once

#include <coplane_core/Real.hpp>

namespace coplane
{
/// Of mass points that faces stop, sums over all ranks [J].
struct DebrisEnergy
{
  Real work = 0;   ///< taken from nodes
  Real stored = 0; ///< in points that are in contact
  /// What a step cannot resolve, and what a point leaves behind where its face ends or another
  /// one with another stiffness becomes the nearest.
  Real remainder() const { return work - stored; }
};
} // namespace coplane
