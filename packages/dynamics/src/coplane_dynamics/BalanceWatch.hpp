#pragma once

#include <coplane_checkpoint/StateTables.hpp>
#include <coplane_contact/LostContact.hpp>
#include <coplane_dynamics/Ledger.hpp>
#include <coplane_dynamics/Parts.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace coplane
{
/// Looks at the energy balance, and whether bodies go through each other, now and then: says when a
/// run cannot go on, and warns before. What contact makes out of nothing it looks at in every
/// cycle, by a bound that costs next to nothing.
///
/// A gain is news when it is beyond `least`, a fraction of the energy in play at the last look.
/// With G the gain of all ranks when it was last summed, one of R ranks has gained at least (least
/// - G) / R since then before it can be news. So the sum over all ranks is made in the cycle in
/// which one has. A rank that gains what another loses causes sums that tell nothing; what is told,
/// and when, does not depend on the ranks.
class BalanceWatch
{
public:
  /// At t = 0, when the first step is known: what is in play, and what of it is round-off.
  /// Collective.
  void open(const EnergyBalance& initial, const Parts& parts);
  /// Whether what contact has gained may be news in this cycle, as far as this rank knows.
  bool mayHaveGained(const Parts& parts);
  /// Whether it is. Sums of all ranks are known anew then.
  bool hasGained(const EnergyBalance& balance, const Parts& parts);
  /// The planes of this rank are others now.
  void forgetPlanes()
  {
    summed_.here = -infinity;
    ended_ = {};
  }

  /// Why the run cannot go on; empty: it can. Collective.
  std::string broken(const EnergyBalance& balance, const Parts& parts) const;
  /// Why the run cannot go on since bodies go through each other; empty: it can. Warns of bodies
  /// that do. Bodies that meet at the speed of waves may be deeper in each other than contact
  /// reaches, and come back, so that has to last for as long as waves take to cross many elements.
  /// Collective.
  /// @param stableStep in which they cross the smallest [s]
  std::string goesThrough(const Parts& parts, Real stableStep);
  /// Bodies of these blocks come in: whatever they lie in at the next look they may lie in.
  void acceptOverlapsOf(const std::vector<int>& blocks);
  void saveBodies(StateTables& out) const;
  void restoreBodies(const StateSource& in);

  /// The look itself: warns of errors, of what contact makes or loses, of planes that are capped or
  /// too deep; again when things are twice as bad as at the last warning of the kind. Collective.
  void warn(const EnergyBalance& balance, const Parts& parts);

  /// Calls f(number) for all that a restart needs, in the order of checkpoints.
  template <class Self, class F>
  static void forEachNumber(Self& self, F&& number)
  {
    number(self.warned_.error);
    number(self.warned_.remainder);
    number(self.warned_.tooDeep);
    number(self.warned_.lost);
    number(self.warned_.through);
    number(self.lostSince_);
    number(self.warned_.capped);
    number(self.warned_.debris);
    number(self.warned_.lines);
    number(self.inPlay_);
    number(self.roundOff_);
  }

private:
  /// Energy by which gains and errors are judged [J]: at rest what is in play is round-off.
  Real inPlayOf(const EnergyBalance& balance) const { return std::max(balance.scale(), roundOff_); }
  Real leastNews(Real inPlay, const Parts& parts) const; ///< of gains [J]
  Real gainHere(const Contact& contact);
  void warnOfBalance(const EnergyBalance& balance, const Parts& parts);
  void warnOfPlanes(const Parts& parts);

  /// What was warned of last.
  struct Warned
  {
    Real error = 0, remainder = 0, tooDeep = 0, lost = 0, through = 0, capped = 0, debris = 0,
         lines = 0;
  };
  Warned warned_;
  Real lostSince_ = -1; ///< time from which on looks have found too much of it; -1: not [s]
  /// That may lie in each other, as they did at the start or when they came; sorted.
  std::vector<BodyPair> accepted_;
  std::vector<int> coming_; ///< blocks that have come since the last look
  Real inPlay_ = 0;         ///< energy in play at the last look [J]
  /// Kinetic energy of velocities that come of the round-off of coordinates in one step [J].
  Real roundOff_ = 0;

  /// What contact had gained when that was summed last [J].
  struct Summed
  {
    Real all = 0, here = -infinity; ///< on all ranks; on this one, -infinity: not known
  };
  Summed summed_;

  /// What planes that have ended had gained on this rank. Planes end in searches, and in cycles
  /// that have one.
  struct Ended
  {
    std::int64_t atSearch = -1;
    Real gain = 0; ///< [J]
  };
  Ended ended_;
};
} // namespace coplane
