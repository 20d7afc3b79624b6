#pragma once

#include <coplane_dynamics/Parts.hpp>
#include <coplane_dynamics/RelaxationOptions.hpp>

#include <cstdint>

namespace coplane
{
/// State of dynamic relaxation, the same bits on all ranks.
struct RelaxationState
{
  bool ended = false;     ///< by a ratio: damping never comes back
  Real kineticBefore = 0; ///< sum m v^2 / 2 at n - 1/2, after a stop at n + 1/2 [J]
  Real work = 0;          ///< kinetic energy taken out by stops since the start [J]
  std::int64_t stops = 0; ///< peaks passed
  std::int64_t below = 0; ///< checks in a row at which the ratios were small enough
};

/// How far from rest a model is: both vanish there.
struct RestRatios
{
  Real energy = 0; ///< kinetic energy at n + 1/2 over internal, elements and contact [-]
  Real force = 0;  ///< sum of |force out of balance| over that of |loads and reactions| [-]
};
RestRatios restRatios(const Parts& parts); ///< Collective.

/// Decides when all motion stops, and when damping ends.
class Relaxation
{
public:
  explicit Relaxation(const RelaxationOptions& options) : wanted_(options) {}

  const RelaxationState& state() const { return state_; }
  /// For the dampings: a time at which none acts when relaxation has ended them.
  Real dampingTime(const Clock& clock) const { return state_.ended ? infinity : clock.time; }

  struct Verdict
  {
    bool stop = false; ///< a peak of the kinetic energy has been passed: all motion stops
    bool rest = false; ///< at rest within the ratios: damping ends
  };
  /// After a kick. Collective.
  /// @param stage index of the present one
  Verdict look(const Parts& parts, int stage);
  /// A stop has been made. @param lost kinetic energy [J]; left: at n + 1/2 after it [J]
  void bookStop(Real lost, Real left);
  void end(const Parts& parts);
  /// Another stage: looks for rest anew.
  void beginAnew()
  {
    state_.ended = false;
    state_.kineticBefore = 0;
    state_.below = 0;
  }

  /// Calls f(number) for all that a restart needs, in the order of checkpoints.
  template <class Self, class F>
  static void forEachNumber(Self& self, F&& number)
  {
    number(self.state_.ended);
    number(self.state_.kineticBefore);
    number(self.state_.work);
    number(self.state_.stops);
    number(self.state_.below);
  }

private:
  /// What ends at rest has to be at rest for good: with loads that do not change any more. Where
  /// only damping ends, loads may follow, such as the shaking of what has settled.
  bool mayEnd(const Parts& parts, int stage) const;
  bool isAtRest(const Parts& parts) const;
  void tellWhenTimeEndsDamping(const Parts& parts) const;

  RelaxationOptions wanted_;
  RelaxationState state_;
};
} // namespace coplane
