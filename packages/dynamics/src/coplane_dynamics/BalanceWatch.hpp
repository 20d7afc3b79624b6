#pragma once

#include <coplane_dynamics/Ledger.hpp>
#include <coplane_dynamics/Parts.hpp>

#include <string>

namespace coplane
{
/// Looks at the energy balance now and then: says when a run cannot go on, and warns before.
class BalanceWatch
{
public:
  /// Why the run cannot go on; empty: it can. Collective.
  std::string broken(const EnergyBalance& balance, const Parts& parts) const;
  /// Warns of errors, of what contact makes or loses, of planes that are capped or too deep; again
  /// when things are twice as bad as at the last warning of the kind. Collective.
  void warn(const EnergyBalance& balance, const Parts& parts);

  /// Calls f(number) for all that a restart needs, in the order of checkpoints.
  template <class Self, class F>
  static void forEachNumber(Self& self, F&& number)
  {
    number(self.warned_.error);
    number(self.warned_.remainder);
    number(self.warned_.tooDeep);
    number(self.warned_.capped);
  }

private:
  void warnOfBalance(const EnergyBalance& balance, const Parts& parts);
  void warnOfPlanes(const Parts& parts);

  /// What was warned of last.
  struct Warned
  {
    Real error = 0, remainder = 0, tooDeep = 0, capped = 0;
  };
  Warned warned_;
};
} // namespace coplane
