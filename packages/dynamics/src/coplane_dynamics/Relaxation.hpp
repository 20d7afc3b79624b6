#pragma once

#include <coplane_core/Real.hpp>

#include <cstdint>

namespace coplane
{
/// When damping ends before its time, and whether all motion stops at peaks of the kinetic energy
/// (kinetic damping: Cundall 1976, Barnes 1988).
struct RelaxationOptions
{
  bool kinetic = false;
  /// Largest kinetic over internal energy (elements and contact) at which damping ends; 0: none [-]
  Real energyRatio = 0;
  /// Largest sum of |force out of balance| over sum of |loads and reactions|; 0: none [-]
  Real forceRatio = 0;
};

/// State of dynamic relaxation, the same bits on all ranks.
struct RelaxationState
{
  bool ended = false;     ///< by a ratio: damping never comes back
  Real kineticBefore = 0; ///< sum m v^2 / 2 at n - 1/2, after a stop at n + 1/2 [J]
  Real work = 0;          ///< kinetic energy taken out by stops since the start [J]
  std::int64_t stops = 0; ///< peaks passed
  std::int64_t below = 0; ///< checks in a row at which the ratios were small enough
};
} // namespace coplane
