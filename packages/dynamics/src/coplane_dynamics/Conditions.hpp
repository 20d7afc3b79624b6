#pragma once

#include <coplane_core/NodeViews.hpp>
#include <coplane_dynamics/AirBlast.hpp>
#include <coplane_dynamics/NodalState.hpp>
#include <coplane_dynamics/RelaxationOptions.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace coplane
{
/// A number that varies in time [s].
using OfTime = std::function<Real(Real)>;
/// The same, different from place to place [m].
using OfTimeAndPlace = std::function<Real(Real, const Vec3&)>;

/// A vector that varies in time; constant zero when nothing is given.
class VectorOfTime
{
public:
  VectorOfTime() = default;
  VectorOfTime(Real x, Real y, Real z) : constant_{x, y, z} {}
  /// Components with a function, and the others.
  VectorOfTime(const Vec3& constant, std::array<OfTime, 3> functions)
      : constant_(constant), functions_(std::move(functions))
  {
  }
  explicit VectorOfTime(std::array<OfTime, 3> functions) : functions_(std::move(functions)) {}

  Vec3 operator()(Real t) const
  {
    Vec3 value = constant_;
    for (int c = 0; c < 3; ++c)
      if (functions_[c])
        value[c] += functions_[c](t);
    return value;
  }
  /// Whether it can have a part along a unit vector: what varies may.
  bool actsAlong(const Vec3& direction) const
  {
    constexpr Real roundOff = 1e-6; // decks have six digits at least
    bool acts = std::abs(dot(constant_, direction)) > roundOff * norm(constant_);
    for (int c = 0; c < 3; ++c)
      acts = acts || (functions_[std::size_t(c)] && std::abs(direction[c]) > roundOff);
    return acts;
  }

private:
  Vec3 constant_{};
  std::array<OfTime, 3> functions_;
};

/// When a condition acts: from <= t < until [s]. Loads are asked at the ends of steps, motions and
/// absorbing sides in their middles, so that one follows the other without a gap.
struct Window
{
  Real from = 0, until = infinity;

  /// A time that falls short by the rounding of summed steps only counts as reached, as for the
  /// end.
  static bool isReached(Real mark, Real t) { return t + 1e-10 * std::abs(t) >= mark; }
  bool holds(Real t) const { return isReached(from, t) && !isReached(until, t); }
  bool isAlways() const { return from <= 0 && until == infinity; }
  bool overlaps(const Window& other) const { return from < other.until && other.from < until; }
};

/// A kick and the step that follows it.
struct KickTimes
{
  Real t;    ///< at n, when it happens [s]
  Real kick; ///< from n - 1/2 to n + 1/2 [s]
  Real step; ///< dt(n+1/2), from n to n + 1; 0: the start, where velocities are given [s]
  Real middle() const { return t + 0.5 * step; }
};

/// Given velocity of some components, or given displacement or acceleration; zero fixes them.
struct PrescribedVelocity
{
  enum class Of
  {
    Velocity,     ///< [m/s], at n + 1/2
    Displacement, ///< [m], at n and n + 1
    Acceleration  ///< [m/s^2], at n: v(n+1/2) = v(n-1/2) + kick a(t_n), as of a force
  };
  Of of = Of::Velocity;   ///< what the functions are
  std::vector<int> nodes; ///< owned local nodes
  std::array<bool, 3> components{true, true, true};
  std::array<OfTime, 3> velocity;      ///< of time; only those of the chosen components are called
  std::array<OfTimeAndPlace, 3> field; ///< instead of `velocity` where it varies with the place
  std::vector<Vec3> places;            ///< of the nodes at the start, where there is a field [m]
  Window when{};
  std::string where = "conditions"; ///< in the deck

  bool hasField() const { return field[0] || field[1] || field[2]; }
  /// Value of component c for the i-th node at t; zero without a function.
  Real at(int c, std::size_t i, Real t) const
  {
    return field[c] ? field[c](t, places[i]) : velocity[c] ? velocity[c](t) : 0;
  }
  /// v(n+1/2) of a component [m/s].
  /// @param before v(n-1/2); at a start the velocity that is given there [m/s]
  template <class F>
  Real speed(const F& function, const KickTimes& times, Real before) const
  {
    if (of == Of::Velocity)
      return function(times.middle());
    if (!(times.step > 0))
      return before;
    if (of == Of::Acceleration)
      return before + times.kick * function(times.t);
    const Real middle = times.middle(), half = 0.5 * times.step;
    return (function(middle + half) - function(middle - half)) / times.step;
  }
};

/// No motion along a normal.
struct SymmetryPlane
{
  std::vector<int> nodes;
  Vec3 normal{}; ///< unit
  Window when{};
  std::string where = "conditions"; ///< in the deck
};

/// Given velocity of the centre and given spin of the bodies of a rigid block.
struct RigidMotion
{
  int block = -1;                   ///< position in the mesh
  std::array<bool, 3> components{}; ///< axes along which the velocity is given
  std::array<OfTime, 3> velocity;   ///< of these; empty: none [m/s]
  std::optional<VectorOfTime> spin; ///< [rad/s]; not given: free
  std::string where = "conditions"; ///< in the deck
};

/// A face of a held element that is loaded; outward normal by the right-hand rule. Each rank adds
/// to the nodes it owns; lists of sides are sorted by id, so that sums have the same order on every
/// rank.
struct LoadedSide
{
  GlobalId id;
  int count;
  std::array<int, 4> nodes;
  Vec3 place{}; ///< middle at the start [m]
};

/// Pressure on faces that follows their motion; positive pushes into the body.
struct FacePressure
{
  using Side = LoadedSide;
  std::vector<LoadedSide> sides;
  OfTime pressure;        ///< [Pa]
  OfTimeAndPlace field{}; ///< instead, where it varies with the place
  Window when{};

  Real at(Real t, const Vec3& place) const
  {
    return field ? field(t, place) : pressure(t);
  } ///< [Pa]
};

/// Force per present area on faces, in fixed axes: its direction does not follow the faces.
struct FaceTraction
{
  std::vector<LoadedSide> sides;
  VectorOfTime traction;                 ///< [Pa]
  std::array<OfTimeAndPlace, 3> field{}; ///< instead, where one of them varies with the place: all
  Window when{};
};

/// The blast wave of a charge on faces: its pressure and arrival are those of the face at the
/// start; area and direction follow the motion.
struct BlastSide
{
  LoadedSide side;
  BlastWave wave;
};
struct AirBlast
{
  std::vector<BlastSide> sides;
  Window when{};
};

/// A face behind which the body is thought to go on without end (Lysmer and Kuhlemeyer 1969):
///
///     t = sigma0 n - z_n (v - 2 v_in)_normal - z_s (v - 2 v_in)_tangential
///
/// Plane waves that arrive along the normal leave without reflection. What another condition has
/// held until then goes on with that reaction in place of sigma0 (Dashpots).
struct AbsorbingSide
{
  LoadedSide side;
  Real normalImpedance = 0; ///< rho c_d of the element behind [Pa s/m]
  Real shearImpedance = 0;  ///< rho c_s [Pa s/m]
  /// sigma0, the initial stress of the element behind, for each corner [Pa]
  std::array<SymTensor, 4> stress{};
};

struct AbsorbingBoundary
{
  std::vector<AbsorbingSide> sides;
  VectorOfTime incident; ///< v_in, particle velocity of the wave that enters here [m/s]
  Window when{};
};

/// A face of a side beyond which the ground goes on level without end (FreeFieldColumn):
///
///     t = sigma_ff n - z_n (v - v_ff)_normal - z_s (v - v_ff)_tangential
///
/// with the stress and the velocity of a column of the side's layers that the model does not move.
/// What another condition has held until then goes on beside it, as at absorbing sides.
struct FreeFieldSide
{
  LoadedSide side;
  int block = 0, element = 0; ///< of this rank, behind the face
  Real normalImpedance = 0;   ///< rho c_d of that element [Pa s/m]
  Real shearImpedance = 0;    ///< rho c_s [Pa s/m]
};

struct FreeFieldBoundary
{
  std::string name;  ///< of the side set
  std::string where; ///< in the deck
  std::vector<FreeFieldSide> sides;
  Window when{};
};

/// s n: with a stress and a unit normal, the traction on the side that the normal leaves.
inline Vec3 dot(const SymTensor& s, const Vec3& n)
{
  return {s.xx * n.x + s.xy * n.y + s.zx * n.z, s.xy * n.x + s.yy * n.y + s.yz * n.z,
          s.zx * n.x + s.yz * n.y + s.zz * n.z};
}

/// Vector areas of a face's corners: integrals of their shape functions times the normal, so that a
/// uniform stress is in balance with its traction whatever the shape of the face. Their sum is the
/// face's vector area. Bodies of revolution: over the whole turn. [m^2]
std::array<Vec3, 4> cornerAreas(int dimension, const Vec3* corners, int count,
                                bool axisymmetric = false);

/// Outward normal of a face from the areas of its corners; none where it has no area, as on the
/// axis of a body of revolution.
inline Vec3 normalOf(const std::array<Vec3, 4>& areas)
{
  const Vec3 sum = areas[0] + areas[1] + areas[2] + areas[3];
  return norm(sum) > 0 ? normalised(sum) : Vec3{};
}

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
  std::vector<RigidMotion> rigidMotions;
  std::vector<FacePressure> pressures;
  std::vector<FaceTraction> tractions;
  std::vector<AirBlast> airBlasts;
  std::vector<AbsorbingBoundary> absorbing;
  std::vector<FreeFieldBoundary> freeFields;
  bool axisymmetric = false; ///< faces are those of a body of revolution about x = 0
  VectorOfTime gravity;      ///< [m/s^2]
  OfTime massDamping;        ///< alpha of the force -alpha m v [1/s]; empty: none
  Real localDamping = 0;     ///< force -alpha |f_c| sign(v_c) on each component c [-]
  Real dampingFrom = 0, dampingUntil = infinity; ///< when dampings act [s]
  RelaxationOptions relaxation;

  /// Loads at time t into state.external (owned nodes, overwritten): gravity, pressures, tractions,
  /// air blasts. Those of absorbing and free-field sides: Dashpots.
  /// @param dt of the step that ends at t: air blasts push with their mean over that time around t
  void applyLoads(int dimension, int ownedNodes, Real t, Real dt, NodalState& state) const;

  bool hasDamping() const { return massDamping || localDamping > 0 || relaxation.kinetic; }
  bool dampsAt(Real t) const { return Window{dampingFrom, dampingUntil}.holds(t); }
  Real massDampingAt(Real t) const { return massDamping && dampsAt(t) ? massDamping(t) : 0; }
  Real localDampingAt(Real t) const { return dampsAt(t) ? localDamping : 0; }

  /// Takes out of forces what the conditions on velocities will take up at t in any case.
  void clearConstrained(Real t, const std::vector<Projection>& fromSymmetry,
                        const NodeVectors& forces) const;

  /// Overwrites prescribed velocities; where symmetry planes and prescribed components meet, the
  /// latter win.
  void prescribeVelocities(Real t, const NodeVectors& v) const;
  /// The same with the projections of the middle of the step at hand, for a call in every cycle.
  /// @param before velocities at n - 1/2
  void prescribeVelocities(const KickTimes& times, const ConstNodeVectors& before,
                           const NodeVectors& v, const std::vector<Projection>& fromSymmetry) const;

  /// Loads end with the elements that carried them.
  /// @param deadElements ids, sorted
  void endLoadsOn(const std::vector<GlobalId>& deadElements);

  /// The loads on faces of other conditions, on all faces that those have.
  void takeFaceLoads(const Conditions& from);

  /// Copies the components of velocities that are prescribed; those of an acceleration are taken
  /// back to n, from where a start with half a step goes on.
  void keepPrescribed(const KickTimes& times, const ConstNodeVectors& from,
                      const NodeVectors& to) const;

  /// What the symmetry planes that act at t forbid, node by node: the normals of planes that meet
  /// at a node are made orthogonal (Gram and Schmidt), so that taking them out one after the other
  /// satisfies all; a normal that depends on earlier ones is left out.
  std::vector<Projection> projections(Real t) const;
  /// Which of the symmetry planes act at t.
  std::vector<char> activeSymmetries(Real t) const;

  /// Owned nodes that some condition on velocities touches, sorted.
  std::vector<int> constrainedNodes() const;
};
} // namespace coplane
