#pragma once

#include <coplane_checkpoint/StateTables.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_dynamics/FreeField.hpp>

#include <functional>
#include <vector>

namespace coplane
{
/// Forces of absorbing and free-field sides on their nodes: initial stress or that of the ground
/// beyond, waves that enter, and -C v or C (v_ff - v), C a symmetric matrix of 3 x 3 numbers.
///
/// C v is taken at n, as the mean of v(n-1/2) and v(n+1/2), and solved for v(n+1/2) node by node.
/// That keeps central differences second order, and the stable step as if the dashpots were not
/// there: the kick then only multiplies velocities by a matrix with eigenvalues between -1 and 1. A
/// force from v(n-1/2) alone would be unstable for dt C / m > 2 already on a free node.
class Dashpots
{
public:
  Dashpots(const Conditions& conditions, int ownedNodes);

  bool empty() const { return nodes_.empty(); }
  const std::vector<int>& nodes() const { return nodes_; } ///< owned, sorted

  /// Of the sides that act in the middle of the step, as they are at x: sums C of the nodes
  /// [Pa s m], and adds what does not depend on the velocity to the external forces. A node that
  /// other conditions have held until now keeps the force of that support, for as long as sides
  /// act on it: it was in balance with what acted then, and is so with what acts now.
  /// @param released the part of the last reactions that no condition takes up any more, for each
  /// of nodes() [N]
  void act(int dimension, const Conditions& conditions, const FreeFields& freeFields, Real t,
           Real middle, const std::vector<Vec3>& released, const ConstNodeVectors& x,
           const NodeVectors& external);
  /// Adds what free fields drive their sides with, C v_ff, to the external forces: like the
  /// dashpots themselves no force out of balance.
  void drive(const NodeVectors& external) const;

  /// Replaces the velocities of the nodes by the solution of
  ///
  ///     m (v - vOld) / dt = force - (C + alpha m) (v + vOld) / 2
  ///
  /// @param force all other forces of an owned node but mass damping [N]
  void kick(Real dt, Real massDamping, const ConstArray<Real>& mass,
            const std::function<Vec3(int)>& force, const ConstNodeVectors& vOld,
            const NodeVectors& v) const;

  /// Adds -C (v + vOld)/2 to the external forces: once velocities are final.
  void book(const ConstNodeVectors& vOld, const ConstNodeVectors& v,
            const NodeVectors& external) const;

  /// C v of an owned node; zero where it has no dashpot [N].
  Vec3 drag(int node, const Vec3& v) const;

  /// Forces of former supports. Collective.
  /// @param ids of all nodes here
  void save(const std::vector<GlobalId>& ids, StateTables& out) const;
  void restore(const std::vector<GlobalId>& ids, const StateSource& in);

private:
  void addFreeFields(int dimension, const Conditions& conditions, const FreeFields& freeFields,
                     Real middle, const ConstNodeVectors& x, const NodeVectors& external);

  std::vector<int> nodes_;     // owned, sorted
  std::vector<int> positions_; // of owned nodes in nodes_; -1 elsewhere
  std::vector<SymTensor> matrices_;
  std::vector<char> acts_;     // some side acts on the node
  std::vector<Vec3> initial_;  // force of the stress beyond the sides that act [N]
  std::vector<Vec3> drive_;    // of free fields [N]
  std::vector<Vec3> supports_; // beside it, so that both are the force of a former support [N]
};
} // namespace coplane
