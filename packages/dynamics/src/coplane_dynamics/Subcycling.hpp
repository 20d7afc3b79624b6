#pragma once

#include <coplane_contact/Contact.hpp>
#include <coplane_core/Lists.hpp>
#include <coplane_dynamics/ElementForces.hpp>
#include <coplane_dynamics/NodalState.hpp>
#include <coplane_dynamics/Parts.hpp>
#include <coplane_dynamics/TimeStep.hpp>
#include <coplane_dynamics/WorkTimes.hpp>

#include <functional>
#include <vector>

namespace coplane
{
/// Several steps in a cycle for what allows only small ones, such as elements that have been
/// crushed (docs/theory/time-integration.md, "Subcycling").
///
/// Nodes whose stable step is below that of the cycle are *substepped*; so are the elements around
/// them and the planes of their faces, with the nodes of all of those. In a cycle these take 2^k
/// steps, in which every force acts as an impulse at its own instants: that of an element or plane
/// that is substepped, and a load on a node that is, at the end of each of its steps, any other at
/// the end of cycles. So momentum is exact. A force counts in the kick between two cycles by the
/// steps before and after it, half of each.
///
/// Nodes that are held in balance by forces of both kinds would swing within each cycle. So what is
/// steady of the others is taken over by all substeps, and only the rest acts at the end of cycles.
class Subcycling
{
public:
  explicit Subcycling(const TimeOptions& options) : options_(options) {}

  bool acts() const { return options_.subcyclingLevels > 1; }
  int substeps() const { return count_; } ///< in a cycle, 1: nothing is substepped
  /// Elements of this rank that are substepped.
  std::int64_t elementsHere(const Parts& parts) const;

  /// Puts the loads of conditions at a time, as means over so long, into state.external (times in
  /// s).
  using Loads = std::function<void(Real time, Real over)>;
  struct Cycle
  {
    Real dt;                     ///< [s]
    Real sinceSearch, lookAhead; ///< when it begins, and that of contact [s]
  };
  // Of a cycle, in this order:

  /// All steps of a cycle but the last. Then substepped nodes are at n still, and have the velocity
  /// that brings them to n + 1 in state.v. Collective.
  void begin(const Cycle& cycle, const Loads& applyLoads, const Parts& parts, NodalState& state,
             ElementForces& elements, Contact* contact, WorkTimes& work);
  /// The last step of their elements, at n + 1. Collective.
  void endElements(Real dt, const NodeLayout& layout, const NodalState& state,
                   ElementForces& elements, WorkTimes& work);
  /// Pairs are others after a search, or elements have died. Collective.
  void relist(const Parts& parts, Contact* contact);
  /// The last step, for pairs.
  Substep lastStep(Real dt) const { return {last_, dt / count_}; }
  /// Before the kick: velocities at its beginning into state.v.
  void endMotion(NodalState& state);

  /// The stable step of a cycle that has the most done in the least work, from the stable steps of
  /// nodes now [s]. Collective.
  Real plan(const Parts& parts, const TimeStep& step);
  Real planned() const { return planned_; } ///< by the last plan [s]
  Real leastStep() const { return least_; } ///< stable, of all nodes at the last plan [s]
  /// Substeps what a cycle of that length needs, by the stable steps that plan() has found.
  /// Collective.
  void regroup(Real step, const Parts& parts, NodalState& state, Contact* contact);
  /// Takes from the forces of nodes and loads on them, for the kick between two cycles of these
  /// lengths [s], what comes in other substeps.
  void weigh(Real before, Real after, NodalState& state, const Contact* contact);
  /// After it, when the next step is known.
  void endKick(const Parts& parts, NodalState& state);

  /// What conditions have held an owned node with in the substeps of the last cycle, as part of the
  /// mean over a cycle [N].
  Vec3 reaction(int node) const;

  /// From state.substeps of owned nodes. Collective.
  void restore(const Parts& parts, NodalState& state, Contact* contact);
  /// Calls f(number) for all else that a restart needs, in the order of checkpoints.
  template <class Self, class F>
  static void forEachNumber(Self& self, F&& number)
  {
    number(self.planned_);
    number(self.least_);
  }

private:
  /// Elements of a block that are substepped, and which of their corners are at which node.
  struct Group
  {
    std::size_t block;
    std::vector<int> elements; ///< in the order of ids
    ElementBlock part;
    Lists<int> corners; ///< element * corners + corner, by place in nodes_
  };
  void list(const Parts& parts, Contact* contact);
  void listGroups(const Parts& parts);
  /// By owned node: the least of all nodes of the elements around it. @param ofNodes of the layout
  static Array<Real> leastAround(const Parts& parts, const Array<Real>& ofNodes);
  void findEligible(const Parts& parts);
  void updateGroups(const NodalState& state, Real dt, WorkTimes& work);
  void findHolds(const Parts& parts);
  /// The part of a force at nodes_[place] that conditions do not hold.
  Vec3 withoutHeld(std::size_t place, Vec3 force) const;
  void kick(Real dt, bool axisymmetric, NodalState& state);
  /// Of substepped elements and planes at substepped nodes, into forces.
  void sumForces(const Contact* contact, const NodeVectors& forces) const;

  TimeOptions options_;
  int count_ = 1;
  Real planned_ = 0, least_ = 0; ///< [s]
  std::vector<Group> groups_;
  std::vector<int> nodes_;      ///< owned, ascending: all corners of substepped elements and pairs
  std::vector<int> placeOf_;    ///< in nodes_, by owned node; -1: none
  std::vector<int> moved_;      ///< those that have been moved in this cycle
  Lists<Vec3> holds_;           ///< directions in which conditions hold them, by place in nodes_
  NodeVectors last_;            ///< velocity in the last substep, all nodes of the layout [m/s]
  NodeVectors forces_;          ///< owned nodes [N]
  NodeVectors reactionImpulse_; ///< owned nodes, of the substeps of the last cycle [N s]
  std::vector<int> reacting_;   ///< which of them may have some
  std::vector<int> weighed_;    ///< those of which the last kick has not had all
  Real kick_ = 0;               ///< that the last cycle ended with [s]
  Real substepOfKick_ = 1;      ///< of substeps, the same over that [-]
  // Of plan() and regroup(), until the kick.
  Array<Real> steps_;          ///< stable, by node; infinity: has no say [s]
  std::vector<char> eligible_; ///< by owned node: may be substepped
  Real leastEligible_ = infinity;
  bool isRegrouped_ = false;
  bool isStart_ = false; ///< the last kick was the first half of one
  int countBefore_ = 1;
  std::vector<int> nodesBefore_;
  NodeVectors forcesBefore_; ///< owned nodes [N]
};
} // namespace coplane
