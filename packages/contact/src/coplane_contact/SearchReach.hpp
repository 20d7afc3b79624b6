#pragma once

#include <coplane_contact/ContactRules.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/Search.hpp>

#include <algorithm>

namespace coplane
{
/// How far searches look: the rules by which pairs of faces become candidates.
class SearchReach
{
public:
  /// @param skin least distance up to which faces become candidates [m]; smallestFace: its size [m]
  SearchReach(const ContactOptions& options, Real skin, Real smallestFace);

  /// Largest gap of the pairs of the next search, and of the last one [m].
  Real skin() const { return rules_.skin; }
  Real leastSkin() const { return leastSkin_; }
  void setSkin(Real skin); ///< [m]
  /// Whether searches look for the faces across declared joints, which may be farther apart.
  void seekJoints(bool seek);
  /// For a search of bodies of which a step may carry faces by `motion` relative to each other [m].
  /// Where that is little, the search foresees many steps along the velocities that nodes have, as
  /// long as they bring no two faces together that are far from each other; the least skin covers
  /// what it does not foresee. Where it is much, or candidates are told by their present normals,
  /// the search foresees nothing, and the skin covers some steps.
  /// @param step [s]
  /// @returns for how long it looks ahead, at least one step [s]
  Real coverMotion(Real motion, Real step)
  {
    const Real steps = farthestAhead * smallestFace_ / motion;
    foresees_ = turns_ && steps >= skinOverMotion;
    setSkin(foresees_ ? leastSkin_ : std::max(leastSkin_, skinOverMotion * motion));
    return foresees_ ? std::min(mostSteps, steps) * step : step;
  }
  bool foresees() const { return foresees_; } ///< the last search
  /// By how much nodes may move relative to each other from a search to the next [m].
  Real movedBetween() const { return leastSkin_ + farthestAhead * smallestFace_; }
  /// By how much faces turn at most while nodes move by the least skin against each other [rad].
  Real turningWithinSkin() const { return 2 * leastSkin_ / smallestFace_; }

  /// A search begins. @param offset largest one of all planes [m]; motion: what it looks ahead for
  void begin(Real offset, const Motion& motion);
  /// Its second half, in which x and v hold the nodes of ghosts, too.
  void takeVelocities(const ConstNodeVectors& v) { rules_.motion.v = v; }
  void end() { rules_.motion = {}; }

  Real offset() const { return rules_.offset; } ///< of the last search [m]
  void setOffset(Real offset) { rules_.offset = offset; }

  /// What does not hang on groups of faces; and with what does, while `rules` live.
  const CandidateRules& rules() const { return rules_; }
  CandidateRules rulesWith(const ContactRules& rules) const;

private:
  /// A search is forced when the next step takes nodes farther than half a skin along an axis,
  /// which is less than 0.87 skins in space. The step to that search may add an eighth.
  static constexpr Real skinOverMotion = 8;
  /// With the potential, pairs are candidates up to this depth, as a fraction of the thinner
  /// element: its force has no end.
  static constexpr Real deepestOfPotential = 0.9;
  /// By which faces are taken to turn until the next search, at most [rad]: with large skins
  /// 2 skin / size bounds nothing.
  static constexpr Real mostTurning = 0.2;
  /// Steps that a search looks ahead at most, and relative motion in that time over the smallest
  /// face [-]: the boxes of faces that are on their way fill more bins.
  static constexpr Real mostSteps = 32, farthestAhead = 0.25;

  Real leastSkin_, smallestFace_;
  bool foresees_ = false;
  bool turns_; ///< candidates are told by normals that may have turned until the next search
  CandidateRules rules_;
};
} // namespace coplane
