#pragma once

#include <coplane_dynamics/Parts.hpp>

namespace coplane
{
/// Decides in which cycles contact searches: when the next positions might bring faces nearer than
/// the skin of the last search covers, and every so many cycles. Pairs learn what they take over
/// from others at searches: of those that come every few cycles, `auto` leaves out those before
/// which no surface of a plane has moved and no bond has broken.
class SearchPlan
{
public:
  /// @param every cycles; 0: once, -1: auto
  explicit SearchPlan(int every) : every_(every) {}

  /// From the velocities at the start. Collective.
  void start(const Parts& parts);
  /// A search has been made with this skin [m].
  void booked(Real skin)
  {
    skin_ = skin;
    passedOnHasChanged_ = false;
  }

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
    number(self.passedOnHasChanged_);
  }

private:
  static constexpr int automatic = -1;
  static constexpr int mostOften = 4; ///< cycles between searches for the sake of what is passed on

  int every_;
  Real relativeSpeed_ = 0, skin_ = 0;
  bool isDue_ = false;
  bool passedOnHasChanged_ = false; ///< since the last search
};
} // namespace coplane
