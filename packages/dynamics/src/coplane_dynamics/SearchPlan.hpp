#pragma once

#include <coplane_dynamics/Parts.hpp>

namespace coplane
{
/// Decides in which cycles contact searches: when the next positions might bring faces nearer than
/// the skin of the last search covers, and every so many cycles.
class SearchPlan
{
public:
  /// @param every cycles; 0: once, -1: only when a search is needed
  explicit SearchPlan(int every) : every_(every) {}

  /// From the velocities at the start. Collective.
  void start(const Parts& parts);
  /// A search has been made with this skin [m].
  void booked(Real skin) { skin_ = skin; }

  /// Whether a search is needed before the forces of the next cycle. The same reduction tells all
  /// ranks whether one is in trouble, and so does what it returns. Collective.
  bool look(const Parts& parts, bool trouble);

  bool isDue() const { return isDue_; }
  Real skin() const { return skin_; } ///< of the last search [m]
  /// Bound on the speed of any two nodes relative to each other, at the last half step [m/s].
  Real relativeSpeed() const { return relativeSpeed_; }

  /// Calls f(number) for all that a restart needs, in the order of checkpoints.
  template <class Self, class F>
  static void forEachNumber(Self& self, F&& number)
  {
    number(self.relativeSpeed_);
    number(self.skin_);
    number(self.isDue_);
  }

private:
  int every_;
  Real relativeSpeed_ = 0, skin_ = 0;
  bool isDue_ = false;
};
} // namespace coplane
