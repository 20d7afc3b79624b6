#pragma once

#include <coplane_checkpoint/StateTables.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/ExactSum.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_dynamics/NodalState.hpp>
#include <coplane_element/ElementBlock.hpp>
#include <coplane_mesh/NodeLayout.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <functional>
#include <vector>

namespace coplane
{
/// A turn, as a unit quaternion.
struct Turn
{
  Real w = 1;
  Vec3 v{};

  Vec3 operator()(const Vec3& r) const
  {
    const Vec3 t = 2.0 * cross(v, r);
    return r + w * t + cross(v, t);
  }
  Turn back() const { return {w, {-v.x, -v.y, -v.z}}; }
  /// First the other, then this one.
  Turn after(const Turn& other) const
  {
    return Turn{w * other.w - dot(v, other.v), w * other.v + other.w * v + cross(v, other.v)}
        .normalised();
  }
  Turn normalised() const
  {
    const Real scale = 1 / std::sqrt(w * w + dot(v, v));
    return {scale * w, scale * v};
  }
  /// Half of it.
  Turn half() const { return Turn{w + 1, v}.normalised(); }
};

/// Number of the rigid body of every node of a rank's part; -1: none. Elements of rigid blocks that
/// share nodes belong to one body. Bodies are counted in the order of their first node in the file.
/// Collective.
/// @param rigidBlocks by block of the mesh
std::vector<int> rigidBodiesOf(const RankMesh& part, const std::vector<char>& rigidBlocks,
                               const Comm& comm);

/// The rigid bodies of a run. Every rank has all of them with the same bits: forces of nodes come
/// together by exact sums. Their nodes follow, and get forces from loads, contact and neighbouring
/// elements like any others.
///
/// At the end of a cycle a body has its centre and turn at n, and momenta at n - 1/2 and n + 1/2:
///
///     P(n+1/2) = P(n-1/2) + dt F(n),   L(n+1/2) = L(n-1/2) + dt T(n),   T about the centre
///     centre(n+1) = centre(n) + dt P / M
///     turn(n+1) = cayley(dt w) turn(n),   w = J(n+1/2)^-1 L(n+1/2) with the turn half way
///
/// so that both momenta change by the given forces alone, to round-off. Velocities of nodes are
/// what brings them to their places at n + 1 in one step.
class RigidBodies
{
public:
  /// Collective.
  /// @param bodyOfNode of all nodes of the mesh part; empty: no bodies
  /// @param rigidBlocks by block
  RigidBodies(const RankMesh& mesh, const std::vector<int>& bodyOfNode,
              const std::vector<char>& rigidBlocks, const std::vector<ElementBlock>& blocks,
              const NodalState& state, const Comm& comm);

  bool empty() const { return bodies_.empty(); }
  int count() const { return int(bodies_.size()); }
  bool holds(int ownedNode) const { return !empty() && bodyOfNode_[ownedNode] >= 0; }

  /// Takes their nodes out of the conditions on velocities and keeps these for the bodies, with
  /// their given motions. A condition has to be on all nodes of a body or on none, and a body has
  /// conditions on nodes or a given motion: throws on all ranks otherwise. Collective.
  void takeConditions(Conditions& conditions);
  /// Throws as takeConditions() of bodies without conditions would. Collective.
  void demandPossible(Conditions conditions) const;
  /// Momenta from the velocities of the nodes at the start, and their velocities from the momenta.
  /// Collective.
  void start(NodalState& state);

  /// Sums forces, torques and what limits the step, from forces and loads of nodes at n.
  /// Collective.
  void sumForces(const NodalState& state, const Array<Real>& contactStiffness,
                 const std::function<Real(int)>& elementStep);
  /// Largest stable step of the bodies, from the last sums [s]; 0 when a force is not finite.
  Real stableStep() const;
  /// Least mass that contact may feel: of the body, or, where the motion of its centre is given, of
  /// what turns at its farthest node; infinity where that is given, too [kg].
  Real massThatYields(int body) const;
  /// Distance of the farthest node from the centre [m].
  Real reach(int body) const { return bodies_[std::size_t(body)].reach; }
  /// Lowest id of a node of the body with the least stable step. Collective.
  GlobalId nodeThatLimits(const NodeLayout& layout) const;

  /// Momenta to n + 1/2, and the velocities of the nodes.
  void kick(const KickTimes& times, Real massDamping, Real localDamping, const NodalState& state);
  void mirrorVelocities(); ///< v(-1/2) mirrors v(1/2) about the given velocities
  /// Work of the forces at n in the half step before them; drift() books the half after them.
  void bookSecondHalf(Real dt);
  void drift(Real dt); ///< to n + 1
  /// Takes out all motion that is not prescribed, at n after a kick, and books it as an impulse;
  /// velocities of the nodes follow. A kick from here comes next.
  void stop(const KickTimes& times, const NodalState& state);

  // The bodies' part of a checkpoint. Collective.
  void save(StateTables& out) const;
  void restore(const StateSource& in);
  /// Displacements count from the present places of the centres.
  void zeroDisplacements();
  void saveZero(StateTables& out) const;
  void restoreZero(const StateSource& in);

  // Sums that every rank has. What loads on nodes do is booked with the nodes.
  Real kinetic() const; ///< at n [J]
  Real kinetic(int body) const;
  Real kineticAtHalfStep() const; ///< at n + 1/2 [J]
  /// Sums over bodies of |force| + |torque| / radius of gyration of what is out of balance, and of
  /// the reactions [N].
  Real unbalancedForce() const;
  Real reactionForce() const;
  Real reactionWork() const;
  Real dampingWork() const;
  Real localDampingWork() const;
  struct BodyMomenta
  {
    Vec3 linear{}, angular{};         ///< at n + 1/2, about the origin
    Vec3 impulse{}, angularImpulse{}; ///< of reactions and dampings since the start
    Real magnitude = 0;
  };
  BodyMomenta momenta(int body) const;

  // For tests and reports.
  Real mass(int body) const { return bodies_[body].mass; }
  Vec3 center(int body) const { return bodies_[body].center; }
  struct BodyMotion
  {
    Vec3 displacement{}, velocity{}, spin{}; ///< of the centre; at n [m], [m/s], [rad/s]
    Vec3 force{},
        moment{}; ///< reactions of what prescribes the motion, about the centre [N], [N m]
  };
  BodyMotion motion(int body) const;
  /// Whether elements of a block belong to the body.
  bool hasBlock(int body, int block) const { return bodies_[body].blocks[block] != 0; }
  int bodyOf(int ownedNode) const { return empty() ? -1 : bodyOfNode_[ownedNode]; }
  Vec3 spin(int body) const { return bodies_[body].spin; }
  /// Whether conditions keep every point of the body in its plane with this normal.
  bool staysInPlanes(int body, const Vec3& normal) const;
  /// About the centre, at the start [kg m^2].
  const Mat3& inertia(int body) const { return bodies_[body].inertia; }

private:
  struct Constraint
  {
    Vec3 direction{}; ///< unit
    /// v(n+1/2) along it, `before` is v(n-1/2); empty: none [m/s]
    std::function<Real(const KickTimes&, Real before)> speed;
    OfTime acceleration{}; ///< where that is given [m/s^2]
  };
  struct Wrench
  {
    Vec3 force{}, torque{}; ///< torque about the centre
  };
  struct Body
  {
    std::vector<int> nodes; ///< owned by this rank
    std::vector<Vec3> arms; ///< from the centre, at the start
    std::int64_t allNodes = 0;
    std::vector<char> blocks; ///< by block of the mesh: whether elements of it are in the body
    Real mass = 0;
    Mat3 inertia, inverseInertia; ///< at the start; in two dimensions only zz counts
    std::vector<Constraint> constraints;
    enum class Turning
    {
      Free,
      AboutAxis,
      None,
      Given
    } turning = Turning::Free;
    Vec3 axis{};
    VectorOfTime spinOfTime; ///< Given [rad/s]
    Vec3 givenSpin{};        ///< of the present step [rad/s]
    bool isHeld() const { return !constraints.empty() || turning == Turning::Given; }
    Real gyration() const; ///< radius [m]
    Real reach = 0;        ///< of its farthest node from the centre, at the start [m]

    Vec3 start{}; ///< the centre at first
    Vec3 center{}, nextCenter{};
    Vec3 centerRest{}, nextCenterRest{}; ///< what the sums of motions have more [m]
    Turn turn, nextTurn;
    Vec3 velocity{}, previousVelocity{};
    Vec3 angularMomentum{}, previousAngularMomentum{};
    Vec3 spin{}, previousSpin{};

    Wrench given, reaction, damping, localDamping; ///< at n
    Real frequencySquared = 0;                     ///< bound for the stable step [1/s^2]
    Real reactionWork = 0, dampingWork = 0, localDampingWork = 0;
    Vec3 impulse{}, angularImpulse{};
  };

  /// Calls f(value&) for every number that changes while the body moves.
  template <class F>
  static void forEachNumber(Body& body, F&& f);
  // Collective.
  void findInertia(const RankMesh& mesh, const std::vector<char>& rigidBlocks,
                   const std::vector<ElementBlock>& blocks, const NodalState& state);
  void findCentres(const NodalState& state);

  Real frequencyBound(const Body& body, const Real* spring) const;
  void takeMotions(const std::vector<RigidMotion>& motions);
  void constrain(Body& body, const Constraint& constraint);
  /// @param before velocity at n - 1/2
  void applyConstraints(Body& body, const KickTimes& times, const Vec3& before) const;
  Vec3 spinOf(const Body& body, Real dt) const;
  void moveNodes(Body& body, Real dt, const NodalState& state) const;
  static void bookWork(Body& body, Real dt, const Vec3& velocity, const Vec3& spin);

  const Comm* comm_;
  int dimension_;
  std::vector<int> bodyOfNode_; ///< of owned nodes
  std::vector<Body> bodies_;
};
} // namespace coplane
