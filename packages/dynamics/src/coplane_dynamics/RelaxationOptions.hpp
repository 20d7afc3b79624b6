#pragma once

#include <coplane_core/Real.hpp>

#include <string>

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
  /// When loads and prescribed motions change for the last time before the end, by their functions
  /// and times [s], and which one that is.
  Real lastChange = 0;
  std::string changing{};

  bool looksForRest() const { return energyRatio > 0 || forceRatio > 0; }
};
} // namespace coplane
