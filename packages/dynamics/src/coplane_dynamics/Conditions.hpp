#pragma once

#include <coplane_core/NodeViews.hpp>
#include <coplane_dynamics/NodalState.hpp>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace coplane
{
/// A number that varies in time [s].
using OfTime = std::function<Real(Real)>;

/// Given velocity of some components; zero fixes them.
struct PrescribedVelocity
{
  std::vector<int> nodes; ///< owned local nodes
  std::array<bool, 3> components{true, true, true};
  std::array<OfTime, 3> velocity; ///< [m/s]; only those of the chosen components are called
};

/// No motion along a normal.
struct SymmetryPlane
{
  std::vector<int> nodes;
  Vec3 normal{}; ///< unit
};

/// Pressure on faces that follows their motion; positive pushes into the body.
struct FacePressure
{
  struct Side
  {
    GlobalId id;
    int count;
    std::array<int, 4> nodes;
  };
  std::vector<Side> sides; ///< of held elements, sorted by id; each rank adds to the nodes it owns
  OfTime pressure;         ///< [Pa]
};

struct Conditions
{
  /// A direction along which a node does not move; several of one node are orthogonal to each
  /// other.
  struct Projection
  {
    int node;
    Vec3 normal; ///< unit
  };

  std::vector<PrescribedVelocity> velocities;
  std::vector<SymmetryPlane> symmetries;
  std::vector<FacePressure> pressures;
  Vec3 gravity{};                   ///< [m/s^2]
  Real massDamping = 0;             ///< force -alpha m v [1/s]
  Real massDampingUntil = infinity; ///< [s]

  /// Loads at time t: gravity and pressures into state.external, damping into state.damping (owned
  /// nodes, overwritten).
  void applyLoads(int dimension, int ownedNodes, Real t, NodalState& state) const;

  /// Overwrites prescribed velocities; where symmetry planes and prescribed components meet, the
  /// latter win.
  void prescribeVelocities(Real t, const NodeVectors& v) const;
  /// The same with projections() at hand, for a call in every cycle.
  void prescribeVelocities(Real t, const NodeVectors& v,
                           const std::vector<Projection>& fromSymmetry) const;

  /// What the symmetry planes forbid, node by node: the normals of planes that meet at a node are
  /// made orthogonal (Gram and Schmidt), so that taking them out one after the other satisfies all;
  /// a normal that depends on earlier ones is left out.
  std::vector<Projection> projections() const;

  /// Owned nodes that some condition on velocities touches, sorted.
  std::vector<int> constrainedNodes() const;
};
} // namespace coplane
