#pragma once

#include <coplane_core/Backend.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_dynamics/Conditions.hpp>

#include <functional>
#include <vector>

namespace coplane
{
/// The part of absorbing sides that depends on the velocity: a force -C v on each of their nodes, C
/// a symmetric matrix of 3 x 3 numbers.
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

  /// Sums C of the nodes from the sides that act at t, as they are at x [Pa s m].
  void find(int dimension, const Conditions& conditions, Real t, const ConstNodeVectors& x);

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

private:
  std::vector<int> nodes_;     // owned, sorted
  std::vector<int> positions_; // of owned nodes in nodes_; -1 elsewhere
  std::vector<SymTensor> matrices_;
};
} // namespace coplane
