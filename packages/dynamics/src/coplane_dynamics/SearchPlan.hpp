#pragma once

#include <coplane_dynamics/Parts.hpp>

namespace coplane
{
/// Decides in which cycles contact searches: when the next positions might bring faces nearer than
/// the skin of the last search covers beside the way that it foresaw, and every so many cycles, if
/// that is a number. With `auto` pairs learn between searches what they take over from others: when
/// bodies have moved by half a skin, and every few cycles in which a surface of a plane has moved
/// or a bond has broken. They learn how deep others lie in the cycle after that has changed,
/// whatever the number.
class SearchPlan
{
public:
  /// @param every cycles; 0: once, -1: auto
  explicit SearchPlan(int every) : every_(every) {}

  /// From the velocities at the start. Collective.
  void start(const Parts& parts);
  /// A search has been made at this time [s], with this skin [m], that looked ahead for so long
  /// [s].
  /// @param foresees the motion in that time needs no skin
  void booked(Real skin, Real time, Real ahead, bool foresees)
  {
    foresees_ = foresees;
    skin_ = skin;
    madeAt_ = time;
    ahead_ = ahead;
    passedOnHasChanged_ = false;
  }
  /// Pairs have learned what others pass on.
  void passedOn() { passedOnHasChanged_ = false; }

  /// Whether a search is needed before the forces of the next cycle. The same reduction tells all
  /// ranks whether one is in trouble, and so does what it returns. Collective.
  /// @param again for the same cycle: what was due before stays so
  bool look(const Parts& parts, bool trouble, bool again = false);

  bool isDue() const { return isDue_; }
  /// Whether pairs are to learn what others pass on, if there is no search.
  bool isPassingDue() const { return isPassingDue_; }
  Real skin() const { return skin_; }   ///< of the last search [m]
  Real ahead() const { return ahead_; } ///< of the last search [s]
  /// From the last search until then [s].
  Real timeSince(Real time) const { return time - madeAt_; }
  /// Bound on the speed of any two nodes relative to each other, at the last half step [m/s].
  Real relativeSpeed() const { return relativeSpeed_; }

  /// Calls f(number) for all that a restart needs, in the order of checkpoints.
  template <class Self, class F>
  static void forEachNumber(Self& self, F&& number)
  {
    number(self.relativeSpeed_);
    number(self.skin_);
    number(self.madeAt_);
    number(self.ahead_);
    number(self.foresees_);
    number(self.isDue_);
    number(self.isPassingDue_);
    number(self.passedOnHasChanged_);
  }

private:
  static constexpr int automatic = -1;
  static constexpr int mostOften = 4; ///< cycles after which pairs learn what is passed on

  int every_;
  Real relativeSpeed_ = 0, skin_ = 0;
  Real madeAt_ = 0, ahead_ = 0; ///< of the last search [s]
  bool foresees_ = false;
  bool isDue_ = false, isPassingDue_ = false;
  bool passedOnHasChanged_ = false; ///< since pairs last learned it
};
} // namespace coplane
