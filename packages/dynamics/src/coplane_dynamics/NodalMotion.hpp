#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Clock.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_dynamics/Dashpots.hpp>
#include <coplane_dynamics/ElementForces.hpp>
#include <coplane_dynamics/FreeField.hpp>
#include <coplane_dynamics/Model.hpp>
#include <coplane_dynamics/NodalState.hpp>
#include <coplane_dynamics/RigidBodies.hpp>

#include <vector>

namespace coplane
{
/// How the nodes of a rank and the rigid bodies move under given forces: drift, kick, what
/// conditions prescribe, dampings, and the books of works and impulses.
class NodalMotion
{
public:
  /// Takes conditions on nodes of rigid bodies out of those of the model.
  NodalMotion(Model& model, const ElementForces& elements, const NodalState& state,
              const Comm& comm);

  const RigidBodies& bodies() const { return bodies_; }
  bool followsBody(int node) const { return followsBody_(node); } ///< an owned node
  /// Bodies of revolution: these owned nodes, and no others, go through the axis.
  void letThroughAxis(const std::vector<int>& nodes);

  /// Momenta of bodies from the velocities of their nodes.
  void start(NodalState& state) { bodies_.start(state); }
  /// x(n) to x(n+1) with v(n+1/2), owned nodes.
  void drift(Real dt, const NodalState& state);
  /// Forces of conditions at t into state.external [N].
  void applyLoads(const Conditions& conditions, Real t, Real dt, NodalState& state) const;
  /// Forces on bodies, and their steps. Collective.
  void sumForcesOnBodies(const NodalState& state, const ElementForces& elements);

  /// When a kick happens.
  struct Times
  {
    Real t;       ///< at n [s]
    Real before;  ///< dt(n-1/2); 0 at a start [s]
    Real after;   ///< dt(n+1/2) [s]
    Real damping; ///< for the dampings; infinity: none acts any more [s]
  };
  /// From n - 1/2 to n + 1/2 [s].
  static Real kickOf(const Times& times) { return 0.5 * (times.before + times.after); }
  /// Free fields that begin to act with the next kick. Collective.
  void startFreeFields(const Times& times, const Conditions& conditions, const RankMesh& mesh,
                       const NodalState& state, const ElementForces& elements, const Comm& comm);
  /// v(n-1/2) to v(n+1/2) under all forces at n, dampings, dashpots and conditions; books them.
  void kick(const Times& times, const Conditions& conditions, NodalState& state);
  /// At n, after a kick that has been booked: velocities that nothing prescribes are zero, and the
  /// first half step from there follows. What the motion had is booked as work and as an impulse.
  /// Collective. Returns the kinetic energy that this took [J].
  Real stop(const Times& times, const Conditions& conditions, NodalState& state, const Comm& comm);
  /// v(n-1/2) of a start: mirrors v(n+1/2) about v(n).
  void mirrorVelocities(NodalState& state);

  // Collective.
  Real kineticAtHalfStep(const NodalState& state,
                         const Comm& comm) const; ///< sum m v(n+1/2)^2/2 [J]
  Real kineticAtFullStep(const NodalState& state,
                         const Comm& comm) const; ///< sum m v(n-1/2).v(n+1/2)/2 [J]

  /// Force of fixed, velocity, displacement, acceleration and symmetry on an owned node at n; zero
  /// on nodes of rigid bodies, which have reactions of their own (RigidBodies::motion) [N].
  Vec3 reaction(int node) const;
  /// What symmetry forbids in the middle of a step [s]; a kick asks for that of the next one.
  void findProjections(const Conditions& conditions, Real middle);
  const std::vector<Conditions::Projection>& projections() const { return projections_; }
  const std::vector<int>& nodesOfDashpots() const { return dashpots_.nodes(); }
  const FreeFields& freeFields() const { return freeFields_; }

  /// Reactions, and the bodies' part of a checkpoint. Collective.
  /// @param ids of all nodes here
  void save(const std::vector<GlobalId>& ids, StateTables& out) const;
  void restore(const std::vector<GlobalId>& ids, const StateSource& in);
  /// Throws on all ranks where rigid bodies cannot have the conditions. Collective.
  void demandPossible(const Conditions& conditions) const { bodies_.demandPossible(conditions); }
  // Displacements of bodies that are told from now on; and their part of a checkpoint.
  void zeroDisplacements() { bodies_.zeroDisplacements(); }
  void saveZero(StateTables& out) const { bodies_.saveZero(out); }
  void restoreZero(const StateSource& in) { bodies_.restoreZero(in); }
  /// Calls f(number) for all else that a restart needs, in the order of checkpoints.
  template <class Self, class F>
  static void forEachNumber(Self& self, F&& number)
  {
    number(self.massDampingActs_);
    number(self.localDampingActs_);
  }

private:
  void applyLocalDamping(Real fraction, const Conditions& conditions, Real middle,
                         const NodalState& state);
  void kickNodes(const Times& times, const Conditions& conditions, NodalState& state);
  std::vector<Vec3> releasedReactions(const Conditions& conditions, Real middle,
                                      const NodalState& state);
  void prescribe(const Times& times, const Conditions& conditions, NodalState& state);
  void stopAtAxis(const Times& times, const Conditions& conditions, NodalState& state) const;
  void bookForces(const Times& times, Real massDamping, const NodalState& state);
  void takeBackWorkAhead(Real step, const NodalState& state) const;

  int dimension_;
  RigidBodies bodies_;
  Array<bool> followsBody_;   ///< owned nodes of rigid bodies
  Array<bool> passesTheAxis_; ///< owned nodes
  FreeFields freeFields_;
  Dashpots dashpots_;
  /// Owned nodes with conditions on velocities, and those of dashpots; sorted.
  std::vector<int> constrained_;
  std::vector<Conditions::Projection> projections_;
  std::vector<char> activeSymmetries_; ///< those that projections_ are of
  NodeVectors beforeConstraint_;
  NodeVectors reactions_;                                   ///< of the constrained nodes at n [N]
  bool massDampingActs_ = false, localDampingActs_ = false; ///< their forces are not all zero
};
} // namespace coplane
