#pragma once

#include <coplane_core/Real.hpp>

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
} // namespace coplane
