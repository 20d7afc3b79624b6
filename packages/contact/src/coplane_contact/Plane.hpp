#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_joint/JointLaw.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

namespace coplane
{
/// How contact is computed; the manual says when to change each (docs/user/contact.md).
struct ContactOptions
{
  enum class Area : std::uint8_t
  {
    Penetrating, ///< only the part of the overlap where the faces penetrate
    Full         ///< the whole overlap of the projections, as the paper says
  };
  enum class Weights : std::uint8_t
  {
    Pressure, ///< forces act at the centre of pressure
    Average,  ///< mean of the shape functions over the area
    Centroid  ///< shape functions at the centre of gravity, as the paper says
  };
  enum class Closure : std::uint8_t
  {
    Total,      ///< from the geometry at the end of the step
    Incremental ///< sum of its increments (Cundall 1988)
  };
  enum class Forces : std::uint8_t
  {
    Potential,   ///< minus the gradient of one energy per pair
    CommonNormal ///< along the normal of the common plane, as in the paper
  };
  /// What `cosOpposed` usually is. With the potential, pairs come and go smoothly by turning, so
  /// needles and edges that cross at 10 degrees may meet; along the common normal each does so with
  /// a jump [-].
  KOKKOS_INLINE_FUNCTION static constexpr Real usualCosOpposed(Forces forces)
  {
    return forces == Forces::Potential ? 0.004 : 0.1;
  }
  /// The usual options, by either way of computing forces.
  static ContactOptions with(Forces forces)
  {
    ContactOptions options;
    options.forces = forces;
    options.cosOpposed = usualCosOpposed(forces);
    return options;
  }
  /// Two dimensions: areas are those of the whole turn about x = 0.
  bool axisymmetric = false;
  Forces forces = Forces::Potential;
  Area area = Area::Penetrating;
  Weights weights = Weights::Pressure;
  Closure closure = Closure::Total;
  bool couple = true;       ///< couple that makes the angular momentum exact
  bool areaRule = true;     ///< new area carries no shear traction
  bool sharedNodes = false; ///< faces that share a node may touch as well
  bool inherit = true;      ///< history passes to the next face pair while sliding
  Real cosOpposed = usualCosOpposed(Forces::Potential); ///< faces push if n1.n2 < minus this
  Real depthMax =
      0.6; ///< deepest penetration, as a fraction of the thinner element behind the faces
  Real areaMin = 1e-8; ///< smallest area of a new plane, as a fraction of the smaller face
  /// Impulses of a step are those along its path, also where forces bend (potential only).
  bool followsPath = false;
  Real dampNormal = 0; ///< fraction of critical damping
  Real dampShear = 0;
  /// Of this cycle: faces that may come together within this time count for the stable step [s].
  Real lookAhead = 0;
};

/// Life of a plane: a pair of faces that has not touched yet is none.
enum class PlaneState : std::uint8_t
{
  Slot, ///< candidate pair that has not touched yet
  Open, ///< has touched, carries nothing now
  Stick,
  Slip
};

/// What searches have done with a pair of faces. Each evaluation leaves Known, or FoundLate.
enum class Sighting : std::uint8_t
{
  New,       ///< not evaluated since its slot was made
  FoundLate, ///< was penetrated already when it was evaluated for the first time
  Known,
  Missed, ///< is a plane, but was no candidate in the last search: has no faces, carries nothing
  Woken   ///< was missed before the last search, and has not been evaluated since
};

/// Why a pair carries nothing until its faces part.
enum class Refusal : std::uint8_t
{
  None,
  Deep,  ///< came into overlap deep inside: did not meet at the surface
  Hidden ///< came into overlap behind a face on which another body lies
};

/// Where the history of a plane comes from.
enum class Lineage : std::uint8_t
{
  Own,
  Inherited, ///< from living neighbours
  SlidesOn   ///< from neighbours of which one touches the same surface: the face beside
};

/// What two faces are to each other.
enum class Pairing : std::uint8_t
{
  Usual,
  Growing, ///< from when it began deep within a surface until it begins anew (potential only)
  Shallow, ///< all nodes of the element behind one of them are at the surface: a back may be near
  ShallowGrowing,
  Stiff ///< the joint by far stiffer than what is behind, or rigid bodies: see weightInStep()
};

/// A length that is linear over a face, in its affine coordinates (AffineFrame).
struct LinearOnFace
{
  Real atCenter = 0;      ///< [m]
  Real along[2] = {0, 0}; ///< for each coordinate [m]

  /// As a plane keeps a crushing, for which it has a number of single precision: nowhere less.
  KOKKOS_INLINE_FUNCTION LinearOnFace asKept() const
  {
    float center = float(atCenter);
    if (Real(center) < atCenter)
      center = std::nextafter(center, infinityOfFloat);
    return {center, {along[0], along[1]}};
  }

private:
  static constexpr float infinityOfFloat = std::numeric_limits<float>::infinity();
};

/// One slot per candidate pair of faces; it becomes a common plane in the cycle in which the faces
/// first touch (steps E and F). Face 0 is the one with the lower id. The normal points from face 0
/// to face 1; force and shear traction act on face 1. Millions of these are read and written in
/// every cycle: nothing is kept that the law or the faces can tell. A new member goes into the list
/// of PlaneState.hpp, and so into all that is made of planes.
struct alignas(64) Plane
{
  GlobalId faceId[2] = {0, 0};
  int face[2] = {
      -1, -1}; ///< positions in this rank's table of faces; -1 while the pair is not a candidate
  float nodeStiffness = 0;         ///< bound on what a node of its faces feels [N/m]
  std::uint16_t joint = 0;         ///< index of the joint card
  std::uint16_t block[2] = {0, 0}; ///< element blocks behind the faces, in the order of the mesh
  PlaneState state = PlaneState::Slot;
  Sighting sighting = Sighting::New;
  Refusal refusal = Refusal::None;
  /// Carries nothing any more, but pushes on for what its last steps have missed.
  bool lags = false;
  bool countedHere = false; ///< this rank books the plane's energy: it owns face 0
  bool declared = false;    ///< a joint that was closed at the start
  bool tooDeep = false;     ///< deeper than the limit
  Pairing pairing = Pairing::Usual;
  bool unseen = false; ///< while its faces are apart nobody looks whether they share area
  // Bit 4 f + e: of edge e of the outline of face f.
  std::uint8_t exits = 0;   ///< bodies can part over it
  std::uint8_t turns = 0;   ///< the surface turns outwards there
  std::uint8_t covered = 0; ///< another body lies on the face there, flush at this edge
  std::uint8_t seams = 0;   ///< the surface goes on there, on another body
  bool crushedUnevenly = false;

  // So much lies in the first line of the cache, the forces of either face in the next ones
  // (FaceLoad).
  /// That carries traction; with the potential as it was when the faces met: tractions and
  /// stiffnesses are per this area (planeNow() shows those of now) [m^2].
  Real area = 0;
  Real overlap = 0; ///< whole overlap of the projections [m^2]

  Vec3 nodal[2][4] = {}; ///< forces on the nodes of the faces [N]
  JointFit fit;          ///< stiffnesses of the law for this pair

  Vec3 normal{};         ///< at the half step
  Vec3 pointOfContact{}; ///< [m]
  Real gap = 0;    ///< at the centre of gravity, positive when open, offset not subtracted [m]
  Real offset = 0; ///< gap at which the joint is just closed [m]
  JointState history;
  Real closure = 0;            ///< [m]
  Real normalTraction = 0;     ///< compression positive [Pa]
  float depthLimit = infinity; ///< [m]
  float normalDamping = 0;     ///< force of the dashpot that pushes the faces apart [N]

  Real birthArea[2] = {0, 0}; ///< of the faces when the plane was born [m^2]; potential only
  Real stored = 0;            ///< recoverable energy now [J]
  /// Potential only. Of a curve: what of the cost of crushing by shear is booked in the next cycle
  /// [J], and the area of the last cycle by which its hysteresis counts [m^2]. Of a joint that is
  /// crushed unevenly: how its crushing changes with the affine coordinates of face 0 [m].
  Real closureMemory[2] = {0, 0};

  // Energies since the plane was made [J].
  Real work = 0; ///< done on the plane by the nodes
  Real frictionWork = 0;
  Real hysteresisWork = 0;
  Real fractureWork = 0;
  Real dampingWork = 0;

  /// Of a joint that has absorbed a gap which changes along its faces: the gap at which it is just
  /// closed at a place is `offset` less these, each carried along by one face. In this line of the
  /// cache lies only what few planes need.
  Real laid[2][3] = {};
  /// Of what makes up for forces that bend within a step (ContactOptions::followsPath): what it is
  /// to do on the nodes in the coming half step [J].
  Real planned = 0;
  float debt = 0; ///< and what it has done less than that, in all [J]
  Lineage lineage = Lineage::Own;
  bool acrossJoint = false; ///< between faces of a declared joint, or beside one

  KOKKOS_INLINE_FUNCTION Real& hysteresisDue() { return closureMemory[0]; }
  KOKKOS_INLINE_FUNCTION void bookHysteresisDue()
  {
    hysteresisWork += hysteresisDue();
    hysteresisDue() = 0;
  }
  KOKKOS_INLINE_FUNCTION Real& loadedArea() { return closureMemory[1]; }
  KOKKOS_INLINE_FUNCTION void layOn(int f, const LinearOnFace& part)
  {
    history.absorbedUnevenly = true;
    laid[f][0] = part.atCenter;
    laid[f][1] = part.along[0];
    laid[f][2] = part.along[1];
  }
  /// By how much the gap that it has absorbed changes over a face [m].
  KOKKOS_INLINE_FUNCTION Real changeOfGap() const
  {
    Real most = 0;
    for (int f = 0; f < 2 && history.absorbedUnevenly; ++f)
      for (int c = 1; c < 3; ++c)
        most = 2 * std::fabs(laid[f][c]) > most ? 2 * std::fabs(laid[f][c]) : most;
    return most;
  }
  /// How it is crushed, if unevenly: by that where it is positive, over face 0.
  KOKKOS_INLINE_FUNCTION LinearOnFace crushing() const
  {
    return {history.crushedAtCenter, {closureMemory[0], closureMemory[1]}};
  }
  KOKKOS_INLINE_FUNCTION void crush(const LinearOnFace& crushing)
  {
    crushedUnevenly = true;
    history.crushedAtCenter = float(crushing.atCenter);
    for (int i = 0; i < 2; ++i)
      closureMemory[i] = crushing.along[i];
  }

  /// Steps E and F: whether it is a plane.
  KOKKOS_INLINE_FUNCTION bool isBorn() const { return state != PlaneState::Slot; }
  KOKKOS_INLINE_FUNCTION bool isNew() const { return sighting == Sighting::New; }
  KOKKOS_INLINE_FUNCTION bool isRefused() const { return refusal != Refusal::None; }
  /// Came into overlap deep, and carries nothing until its faces part.
  KOKKOS_INLINE_FUNCTION bool isReleased() const { return refusal == Refusal::Deep; }
  /// A gap of the mesh, or an overlap, negative, becomes that at which the joint is just closed
  /// [m].
  KOKKOS_INLINE_FUNCTION void absorb(Real gapOfMesh)
  {
    offset = gapOfMesh;
    history.absorbed = true;
    forgetAbsorbedRoundOff();
  }
  KOKKOS_INLINE_FUNCTION void forgetAbsorbedRoundOff()
  {
    const Real roundOff = 1e-6 * depthLimit;
    history.absorbed = history.absorbed && (offset > roundOff || offset < -roundOff);
  }
  KOKKOS_INLINE_FUNCTION bool isInherited() const
  {
    return lineage == Lineage::Inherited || lineage == Lineage::SlidesOn;
  }

  /// Whether its nodes have forces of it.
  KOKKOS_INLINE_FUNCTION bool pushes() const { return area > 0 || lags; }

  /// Whether it carries by how much its faces share: it began deep (PairPotential::growIn).
  KOKKOS_INLINE_FUNCTION bool carriesGrowing() const
  {
    return isGrowing() && area > 0 && !history.bonded;
  }

  /// How much the plane counts for the stable step [-]. Inside the step in which a node meets a
  /// spring k, or leaves it, up to k (v dt)^2 / 8 of energy is made or lost. Nodes meet a soft
  /// spring once; on a stiff one they bounce many times, so it has to be resolved: omega dt is
  /// halved, also while it carries, since a step that rises under load costs energy as well. So it
  /// is between rigid bodies, where nothing but the plane takes up energy. A declared joint is
  /// closed from the start.
  KOKKOS_INLINE_FUNCTION Real weightInStep() const
  {
    return pairing == Pairing::Stiff && !declared ? 4 : 1;
  }

  KOKKOS_INLINE_FUNCTION bool isShallow() const
  {
    return pairing == Pairing::Shallow || pairing == Pairing::ShallowGrowing;
  }
  KOKKOS_INLINE_FUNCTION bool isGrowing() const
  {
    return pairing == Pairing::Growing || pairing == Pairing::ShallowGrowing;
  }
  /// What they are to each other but for stiff joints.
  KOKKOS_INLINE_FUNCTION void pairAs(bool shallow, bool growing)
  {
    if (pairing != Pairing::Stiff)
      pairing = shallow ? (growing ? Pairing::ShallowGrowing : Pairing::Shallow)
                        : (growing ? Pairing::Growing : Pairing::Usual);
  }
  /// Depth at which no contact begins any more, over the depth limit: with the usual limit, well
  /// within the depth down to which searches know pairs [-].
  static constexpr Real deepestStart = 1.25;
  /// Less deep than this a pair may begin with little energy, and grow [m].
  KOKKOS_INLINE_FUNCTION Real deepestToGrow() const
  {
    return isShallow() ? depthLimit : deepestStart * depthLimit;
  }

  /// What of the closure faces that lay on each other had already: a joint that was closed by an
  /// initial stress, or lifted, is not deep [m].
  KOKKOS_INLINE_FUNCTION Real closureOnSurface() const { return offset > 0 ? offset : 0; }
  /// Faces lie deeper in each other than the limit.
  KOKKOS_INLINE_FUNCTION bool isTooDeep() const
  {
    return closure - closureOnSurface() > depthLimit;
  }
  /// Closure that the law of forces along the common normal sees, which grow no further in depths
  /// beyond the limit [m].
  KOKKOS_INLINE_FUNCTION Real limitedClosure() const
  {
    return isTooDeep() ? closureOnSurface() + depthLimit : closure;
  }
  /// Of all nodes of a face [N].
  KOKKOS_INLINE_FUNCTION Vec3 forceOn(int side) const
  {
    return nodal[side][0] + nodal[side][1] + (nodal[side][2] + nodal[side][3]);
  }
  KOKKOS_INLINE_FUNCTION void dropForces()
  {
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < 4; ++k)
        nodal[side][k] = {};
  }
  /// Recoverable energy of the shear traction [J].
  KOKKOS_INLINE_FUNCTION Real shearEnergy() const
  {
    const Vec3& t = history.shearTraction;
    return fit.shearStiffness > 0 ? 0.5 * area * dot(t, t) / fit.shearStiffness : 0;
  }
  /// What the work is not accounted for by the other terms [J].
  KOKKOS_INLINE_FUNCTION Real remainder() const
  {
    return work - stored - frictionWork - hysteresisWork - fractureWork - dampingWork;
  }
};
static_assert(sizeof(Plane) == 9 * 64, "planes fill the memory bandwidth: whole cache lines");

/// What a cycle has to do with a slot; a table of these is looked through in every cycle.
enum class Activity : std::uint8_t
{
  Awake,  ///< looked at in full
  Asleep, ///< only its faces are looked at until their shadows meet
  Apart,  ///< its faces are apart: looked at while they are near each other
  Loaded  ///< awake, and adds to nodes
};

/// Positions of the faces of a slot, as in its plane; a table of these is looked through in every
/// cycle.
struct SlotFaces
{
  std::int32_t face[2] = {-1, -1};
};

/// Key of a plane, or of a pair without one: permanent, independent of the partition.
template <class A, class B>
bool keyLess(const A& a, const B& b)
{
  return a.faceId[0] != b.faceId[0] ? a.faceId[0] < b.faceId[0] : a.faceId[1] < b.faceId[1];
}
} // namespace coplane
