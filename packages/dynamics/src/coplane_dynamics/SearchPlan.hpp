#pragma once

#include <coplane_dynamics/Parts.hpp>

namespace coplane
{
/// Decides in which cycles contact searches: when the next positions might bring faces nearer than
/// the skin of the last search covers, and every so many cycles. Pairs learn what they take over
/// from others at searches; where a number of cycles is given, that is all. With `auto` they also
/// learn it anew every few cycles, among the pairs that there are, when surfaces of planes have
/// moved or bonds have broken since.
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
  /// Pairs know what they take over now.
  void renewed() { passedOnHasChanged_ = false; }

  /// Whether a search is needed before the forces of the next cycle. The same reduction tells all
  /// ranks whether one is in trouble, and so does what it returns. Collective.
  bool look(const Parts& parts, bool trouble);

  bool isDue() const { return isDue_; }
  /// Whether pairs should be told again what they take over, where no search comes.
  bool isRenewalDue() const { return isRenewalDue_; }
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
    number(self.isRenewalDue_);
    number(self.passedOnHasChanged_);
  }

private:
  static constexpr int automatic = -1;
  static constexpr int mostOften = 4; ///< cycles from one time that pairs are told to the next

  int every_;
  Real relativeSpeed_ = 0, skin_ = 0;
  bool isDue_ = false, isRenewalDue_ = false;
  bool passedOnHasChanged_ = false; ///< since the last search
};
} // namespace coplane
