#pragma once

#include <coplane_core/Backend.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_mesh/NodeLayout.hpp>
#include <coplane_mesh/RankMesh.hpp>

namespace coplane
{
/// What every node knows. x and v exist for all nodes of the layout (owned first), reference
/// for those of the rank's mesh; the rest for owned nodes only.
struct NodalState
{
  NodeVectors x;                ///< position at n [m]
  NodeVectors xRest;            ///< what the sum of all motions has more than x can hold [m]
  NodeVectors v;                ///< velocity at n + 1/2: the kick closes a cycle [m/s]
  Array<Real> mass;             ///< lumped, of inertia [kg]
  NodeVectors reference;        ///< from which displacements count [m]
  NodeVectors vPrevious;        ///< velocity at n - 1/2 [m/s]
  NodeVectors force;            ///< of elements, contact and lines at n [N]
  NodeVectors contactForce;     ///< part of it [N]
  NodeVectors external;         ///< loads and reactions at n [N]
  NodeVectors damping;          ///< mass-proportional damping force at n [N]
  NodeVectors localDamping;     ///< local damping force at n [N]
  NodeVectors impulse;          ///< of external and damping forces since the start [N s]
  NodeVectors angularImpulse;   ///< about the origin [N m s]
  NodeVectors atSearch;         ///< position at the last search [m]
  NodeVectors velocityAtSearch; ///< [m/s]
  NodeVectors atPassing;        ///< position when pairs last learned what planes pass on [m]
  // Works are booked to n + 1/2 with the forces at n: what lies after n, half a step of v, is taken
  // off where they are told (Solver::energy).
  Array<Real> externalWork;     ///< since the start [J]
  Array<Real> dampingWork;      ///< taken out by mass-proportional damping [J]
  Array<Real> localDampingWork; ///< by local damping [J]
  Array<Real> totalWork;        ///< of all forces [J]
  /// What planes and lines add to the stiffness of the node, a bound [N/m].
  Array<Real> contactStiffness;
  /// Part of the mass of owned nodes that mass scaling has added: inertia without weight [kg].
  Array<Real> addedMass;

  /// That elements and planes at a node make in a cycle: 1, or more with time.subcycling; all nodes
  /// of the layout [-].
  Array<Real> substeps;
  /// What acts on substepped nodes once in a cycle, smoothed in time once and twice: they have the
  /// latter in all of their substeps [N].
  NodeVectors steadyMean, steadyForce;
  /// Part of the momentum that it gives to them until the middle of the cycle, but comes later [N
  /// s].
  NodeVectors underWay;
  /// What `force` and `external` have less than all forces at n, because they are means over the
  /// kick, and impulses of substeps come at other times [N].
  NodeVectors takenOff;
  /// What m/2 v(n-1/2).v(n+1/2) of them lacks of the kinetic energy at n, because forces that are
  /// in balance act at different times in a cycle [J].
  Array<Real> swing;

  /// Whether xRest is kept: far from the origin. Near it what a place cannot hold is nothing, and
  /// what lies flush stays flush to the last bit.
  bool keepsRests = false;

  explicit NodalState(const RankMesh& mesh);
  int owned() const { return int(force.extent(0)); }
  /// Follows a layout whose ghost nodes have changed; the values of ghosts come with the next
  /// refresh.
  void resize(const NodeLayout& layout);
};
} // namespace coplane
