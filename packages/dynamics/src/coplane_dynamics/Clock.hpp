#pragma once

#include <coplane_core/Real.hpp>

#include <cstdint>

namespace coplane
{
struct Clock
{
  std::int64_t cycle = 0;
  Real time = 0;     ///< t(n) [s]
  Real step = 0;     ///< dt(n-1/2), of the cycle that ended; 0 at the start [s]
  Real nextStep = 0; ///< dt(n+1/2) [s]

  /// Calls f(number) for all that a restart needs, in the order of checkpoints.
  template <class Self, class F>
  static void forEachNumber(Self& self, F&& number)
  {
    number(self.cycle);
    number(self.time);
    number(self.step);
    number(self.nextStep);
  }
};
} // namespace coplane
