#pragma once

#include <coplane_contact/CommonNormalKernel.hpp>
#include <coplane_contact/ContactPotential.hpp>
#include <coplane_contact/detail/BentBonds.hpp>
#include <coplane_contact/detail/LostEnergies.hpp>
#include <coplane_contact/detail/UnevenlyCrushed.hpp>

// Steps B to H of a pair of faces whose forces come from one potential
// (docs/theory/contact-potential.md). Faces are those of the end of the step.

namespace coplane
{
namespace detail
{
/// Spin of a face about an axis along its normal or nearly so [1/s].
template <class T>
KOKKOS_INLINE_FUNCTION T spinAbout(const Vec3Of<T>& axis, const HalfStepFaceOf<T>& face)
{
  T moment{}, inertia{};
  for (int i = 0; i < face.count; ++i)
  {
    const Vec3Of<T> r = face.x[i] - face.center;
    moment += dot(axis, cross(r, face.v[i]));
    inertia += dot(r, r);
  }
  return moment / inertia;
}

KOKKOS_INLINE_FUNCTION EdgesOf<Real> edgesOf(const Plane& plane)
{
  EdgesOf<Real> edges;
  for (int e = 0; e < 8; ++e)
  {
    edges.exits[e] = plane.exits >> e & 1;
    edges.turns[e] = plane.turns >> e & 1;
    edges.covered[e] = plane.covered >> e & 1;
    edges.seams[e] = plane.seams >> e & 1;
  }
  return edges;
}

template <class T>
KOKKOS_INLINE_FUNCTION EdgesOf<T> edgesOf(const PlaneBatch<T>& planes)
{
  EdgesOf<T> edges;
  unsigned any = 0;
  for (int i = 0; i < planes.count; ++i)
    any |= planes.plane[i]->turns | planes.plane[i]->covered | planes.plane[i]->seams; // exits turn
  for (int e = 0; e < 8 && any != 0; ++e)
  {
    edges.exits[e] = planes.each([&](const Plane& p) { return Real(p.exits >> e & 1); });
    edges.turns[e] = planes.each([&](const Plane& p) { return Real(p.turns >> e & 1); });
    edges.covered[e] = planes.each([&](const Plane& p) { return Real(p.covered >> e & 1); });
    edges.seams[e] = planes.each([&](const Plane& p) { return Real(p.seams >> e & 1); });
  }
  return edges;
}

/// Depth beyond which a first overlap is not taken for a contact; approach: of the faces in two
/// steps [m].
KOKKOS_INLINE_FUNCTION Real smallestStart(const Plane& plane, Real approach)
{
  if (plane.isNew() || plane.sighting == Sighting::Woken)
    return plane.depthLimit;
  const Real start = deepestBirth * plane.depthLimit;
  return approach > start ? approach : start;
}

/// Length of the shortest edge of both faces [m].
template <class T>
KOKKOS_INLINE_FUNCTION T shortestEdge(const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b)
{
  T shortest(infinity);
  for (const HalfStepFaceOf<T>* face : {&a, &b})
    for (int i = 0; i < face->count; ++i)
    {
      const Vec3Of<T> edge = face->x[i + 1 == face->count ? 0 : i + 1] - face->x[i];
      shortest = branchFree::smaller(dot(edge, edge), shortest);
    }
  return branchFree::squareRoot(shortest);
}

/// Steps B to H of a batch of pairs in one cycle, in the order of the functions.
template <int Dim, class T>
class PotentialCycle
{
  using Mask = branchFree::MaskOf<T>;

public:
  KOKKOS_FORCEINLINE_FUNCTION PotentialCycle(const PlaneBatch<T>& planes,
                                             const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b,
                                             const ContactOptions& options, Real dt,
                                             PairPotential<Dim, T>& pair)
      : planes_(planes), a_(a), b_(b), options_(options), dt_(dt), pair_(pair)
  {
  }

  /// @returns the lanes that are done, see updatePotentialPlanes
  KOKKOS_FORCEINLINE_FUNCTION Mask run()
  {
    linearise();
    const T slope = all(slopes_);
    meet();
    if (options_.followsPath)
      before_ = {planes_.each([](const Plane& p) { return p.remainder(); }),
                 planes_.each([](const Plane& p) { return p.stored; }),
                 planes_.each([](const Plane& p) { return p.area; }),
                 planes_.each([](const Plane& p) { return p.hysteresisWork; }), slope};
    bookOldForce(planes_, done_, a_, b_, dt_);
    const Mask touching = stepEF_findOrCreate();
    if (branchFree::anyOf(touching))
      stepGH_update(touching);
    boundStep(touching);
    return done_;
  }

private:
  static constexpr int width = PlaneBatch<T>::width;
  using PerLane = Real[width];

  /// How the faces move against each other at the centre of pressure.
  struct Relative
  {
    T weights[2][4];   ///< of the corners of a and b there
    T apart;           ///< of the faces along the normal [m]
    T gap;             ///< the same, which the offset less the closure is where layers lie [m]
    T closing;         ///< rate at which they close [m/s]
    Vec3Of<T> sliding; ///< velocity of b past a, in the middle of the step [m/s]
    Vec3Of<T> gained;  ///< of that from its beginning to its end, as the place moves [m/s]
  };
  /// What the law of a joint gives.
  struct Response
  {
    PerLane tractions = {}; ///< normal, of bonds; compression positive [Pa]
    PerLane stored = {};    ///< energy of bonds per area [J/m^2]
    PerLane slopes = {};    ///< of bonds that resist bending, where they are open [Pa/m]
    PerLane sheared = {};   ///< what shear has crushed of a joint that may be so unevenly [m]
    PerLane parted = {};    ///< what of that did not close it [m]
    PerLane lifts = {};     ///< by which slip lifts the faces in this cycle [m]
    PerLane liftWork = {};  ///< what the law has taken for that of the work of slip [J]
    PerLane before = {};    ///< normal forces before the step [N]
  };

  /// The kernel is linear: a closure curve is its tangent at the largest closure so far, at which
  /// it unloads, from the permanent closure on.
  KOKKOS_FORCEINLINE_FUNCTION void linearise()
  {
    bonded_ = planes_.each([](const Plane& p) { return p.history.bonded; }) > 0.0;
    bends_ = branchFree::gathered<T>(
                 [&](int i) -> Real
                 {
                   return i < planes_.count && planes_.plane[i]->history.bonded &&
                          planes_.law[i]->bond.resistsBending;
                 }) > 0.0;
    for (int i = 0; i < width; ++i)
    {
      const Plane& plane = *planes_.plane[i];
      const JointLaw& law = *planes_.law[i];
      slopes_[i] = plane.fit.normalStiffness;
      permanents_[i] = 0;
      crushes_[i] = law.crushesUnevenly() && !plane.history.bonded;
      if (crushes_[i])
      {
        if (!plane.crushedUnevenly)
          permanents_[i] = law.curve.crushing.crushedAt(plane.history.maximumClosure, slopes_[i]);
      }
      else if (!law.curve.straight() && !plane.history.bonded)
        layTangent(i, plane.history.maximumClosure);
    }
    slope_ = all(slopes_);
    hardening_ = branchFree::gathered<T>(
        [&](int i) -> Real
        {
          return i < planes_.count && planes_.law[i]->penalty
                     ? 1 / Real(planes_.plane[i]->depthLimit)
                     : 0;
        });
  }

  KOKKOS_FORCEINLINE_FUNCTION void layTangent(int i, Real closure)
  {
    const ClosureCurve::Point top = planes_.law[i]->curve.at(planes_.plane[i]->fit, closure);
    slopes_[i] = top.stiffness;
    permanents_[i] = closure - top.traction / top.stiffness;
  }

  /// Closure, area and moments of the pairs.
  KOKKOS_FORCEINLINE_FUNCTION void meet()
  {
    const auto& opposed = pair_.plane.opposed;
    if (branchFree::anyOf(opposed))
      lay();
    if constexpr (width == 1)
    {
      const Plane& plane = *planes_.plane[0];
      if (opposed && plane.crushedUnevenly)
        pair_.beCrushed(plane.crushing());
      if (plane.carriesGrowing())
        pair_.growIn();
    }
    if (branchFree::anyOf(opposed))
      findClosure();
    const Mask carried =
        planes_.each([](const Plane& p) { return p.area > 0 && p.isBorn(); }) > 0.0;
    loadCurves(opposed && carried && (pair_.regular || Mask(width == 1)));
    done_ = pair_.regular || !opposed || Mask(width == 1);
    if constexpr (width != 1)
    {
      leaveCrushed(opposed);
      leaveNewOnCurves(opposed && !carried);
    }
    overlap_ = branchFree::choose(opposed, pair_.overlap, T(0.0));
    overlaps_ = overlap_ > options_.areaMin * branchFree::smaller(a_.area, b_.area);
    deepest_ = pair_.mostClosure + all(permanents_);
    if constexpr (width != 1)
      leaveDeep();
    speed_ = branchFree::choose(overlaps_, approachSpeed(pair_.plane.normal, a_, b_), T(0.0));
    if (branchFree::anyOf(bends_ && overlaps_))
      done_ = done_ && !findBending(planes_, bends_ && overlaps_, pair_, a_, b_, dt_, bent_);
  }

  /// What joints have absorbed unevenly.
  KOKKOS_FORCEINLINE_FUNCTION void lay()
  {
    bool any = false;
    for (int i = 0; i < planes_.count; ++i)
      any = any || planes_.plane[i]->history.absorbedUnevenly;
    if (!any)
      return;
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < 3; ++k)
        laid_[f][k] = planes_.each([&](const Plane& p) { return p.laid[f][k]; });
    pair_.lay(planes_.each([](const Plane& p) { return p.history.absorbedUnevenly; }) > 0.0, laid_);
  }
  KOKKOS_FORCEINLINE_FUNCTION void findClosure()
  {
    offset_ = planes_.each([](const Plane& p) { return p.offset; }) - all(permanents_);
    pair_.meet(offset_, bonded_, edgesOf(planes_));
  }

  /// Closure of a curve, or of a joint that is crushed evenly, where it is more than ever [m]; else
  /// 0. The mean over the pressure: even closures lie on the curve.
  KOKKOS_FORCEINLINE_FUNCTION Real reach(int i) const;
  static constexpr Real roundOffOfReach = 1e-9;
  /// By uneven closures a curve reaches further with each tangent, from below; even ones take one.
  static constexpr int mostTangents = 8;
  /// Curves that close as never before bear what they do at the closure of this cycle: with the
  /// tangent at that of the last one a fast closure, which passes the curve in one step, would find
  /// the energy of a stiffer tangent in the next.
  KOKKOS_FORCEINLINE_FUNCTION void loadCurves(const Mask& loading);
  /// What begins to touch on a curve is left to T = Real, which knows whether it carries.
  KOKKOS_FORCEINLINE_FUNCTION void leaveNewOnCurves(const Mask& touching);
  /// What has begun deep within a surface, or may do so, is left to T = Real.
  KOKKOS_FORCEINLINE_FUNCTION void leaveDeep();
  /// What is crushed unevenly, or will be in this cycle, is left to T = Real.
  KOKKOS_FORCEINLINE_FUNCTION void leaveCrushed(const Mask& opposed);
  /// Closure up to which a joint that has been crushed evenly is crushed no further [m].
  KOKKOS_FORCEINLINE_FUNCTION Real mostWithoutCrushing(int i) const;

  /// Steps E and F. @returns the lanes that carry
  KOKKOS_FORCEINLINE_FUNCTION Mask stepEF_findOrCreate()
  {
    const Mask inContact =
        done_ && overlaps_ && pair_.moments.area > 0.0 && (bonded_ || pair_.moments.volume > 0.0);
    return branchFree::gathered<T>(
               [&](int i) -> Real
               {
                 if (i >= planes_.count || !branchFree::lane(done_, i))
                   return 0;
                 Plane& plane = *planes_.plane[i];
                 const bool inside = branchFree::lane(inContact, i);
                 plane.overlap = branchFree::lane(overlap_ * pair_.depth, i);
                 plane.unseen = false;
                 leastGaps_[i] = plane.offset - branchFree::lane(deepest_, i);
                 late_[i] = wasFoundLate(plane, inside);
                 if (!inside)
                 {
                   plane.refusal = Refusal::None;
                   rest(plane, i);
                 }
                 return inside && carries(plane, i);
               }) > 0.0;
  }

  /// A pair that has taken over a joint which is crushed deeper than its faces lie in each other,
  /// or which has absorbed a gap or an overlap of the mesh, is a plane from there on and remembers
  /// that, whatever becomes of those that passed it on.
  KOKKOS_FORCEINLINE_FUNCTION void rest(Plane& plane, int i) const;
  /// Of a plane in contact.
  KOKKOS_FORCEINLINE_FUNCTION bool carries(Plane& plane, int i);
  /// What a pair was a step ago.
  enum class Before
  {
    Open,
    SharedNoArea,
    Closed ///< over area that it shared
  };
  /// The same of a pair that has carried nothing. It was closed by an offset that it had not then:
  /// a joint that comes to bear again may lie higher than the faces beside it, which take that over
  /// and which nothing has met yet; and what a pair has taken over it may lose again.
  KOKKOS_INLINE_FUNCTION Before stepBefore(const Plane& plane, int i) const;
  /// Whether a pair that comes in from the side stands higher, by a gap that a joint beside it has
  /// absorbed, than that joint does: deeper closed than it, and by more than the step.
  KOKKOS_INLINE_FUNCTION bool isHigherThanBeside(const Plane& plane, int i) const;
  // Rare, and not inlined: in steps E and F they cost all planes some hundredths of their time.
  /// Whether warped faces oppose each other by less than their normals change along them: near a
  /// right angle. What comes in from the side so does not meet the other one.
  [[gnu::noinline]] KOKKOS_FUNCTION bool isOpposedByWarp(const Plane& plane, int i) const;
  /// Closure of a pair beside a declared joint that comes in from the side which neither a
  /// neighbour nor its motion in a step explains, in space [m].
  KOKKOS_INLINE_FUNCTION Real unexplainedFromTheSide(const Plane& plane, int i) const;
  /// What the mean planes of warped faces lie beyond their nodes closes a pair that comes in from
  /// the side before its faces touch: that is no closure. @returns its closure, if that explains
  /// all of what no neighbour and no motion does; else 0 [m]
  [[gnu::noinline]] KOKKOS_FUNCTION Real closedByWarp(const Plane& plane, int i) const;
  /// What was closed before it carries has no energy, whatever its neighbours passed on: its
  /// surface lies where the faces are deepest in each other, on top of what the joint has closed
  /// for good. A bond, which carries by its mean closure, is stress-free where it is, unless its
  /// faces are tilted by more than it could hold: such faces were never bonded.
  KOKKOS_INLINE_FUNCTION void beginHere(Plane& plane, int i) const;
  /// A contact begins at the surface, and begins there anew after its faces had no area in common.
  /// Faces that come to share area while one lies deep behind the other did not meet: they carry
  /// nothing until they share none. They have no energy yet, so this costs none.
  KOKKOS_FORCEINLINE_FUNCTION void refuse(Plane& plane, int i, bool closedBefore);
  /// With which a pair begins that comes from the side or by turning: the share of the smaller face
  /// that it covers, times how opposed it is [-].
  static constexpr Real largestBeginning = 0.1;
  /// Whether a pair has little of its energy yet, as it covers little of its faces or is hardly
  /// opposed.
  KOKKOS_INLINE_FUNCTION bool beginsLittle() const;
  /// Whether a pair may begin deep within a surface, if it has little of its energy.
  static KOKKOS_INLINE_FUNCTION bool mayGrow(const Plane& plane)
  {
    return plane.pairing != Pairing::Stiff && !plane.isRefused();
  }

  /// Motion, law and forces of the planes that carry.
  KOKKOS_FORCEINLINE_FUNCTION void stepGH_update(const Mask& touching)
  {
    using branchFree::choose;
    CrushedFrom crushed;
    if constexpr (width == 1)
    {
      if (touching && crushes_[0])
        crushed = unevenly().crush(permanents_[0]);
      loadCurves(touching && !(planes_.plane[0]->area > 0)); // what has just begun to touch
    }
    const ContactMoments<T>& m = pair_.moments;
    EnergyDensity<T> density;
    T pressed = pair_.press(slope_, choose(bonded_, T(0.0), hardening_), density);
    const T share = choose(bonded_, T(1.0), pair_.wayOut);
    growFromBirth();
    const T area =
        choose(touching, pair_.materialArea * pair_.opposedness * share * m.area, T(0.0));
    const Relative relative = stepG_motion();
    Vec3Of<T> increment;
    const Vec3Of<T> tau = shearAfter(area, relative, increment);
    const T loaded =
        pair_.materialArea * (2.0 * density.square * m.volume + density.linear * m.area);
    const T energyShare = pair_.materialArea * pair_.opposedness * share;
    Response response;
    for (int i = 0; i < planes_.count; ++i)
      if (branchFree::lane(touching, i))
      {
        Plane& plane = *planes_.plane[i];
        plane.gap = branchFree::lane(relative.gap, i);
        stepH_law(plane, i, branchFree::lane(area, i), branchFree::lane(energyShare, i),
                  branchFree::lane(loaded, i), branchFree::lane(tau, i),
                  branchFree::lane(increment, i), relative, response);
        // What can leave sideways is not deep.
        plane.tooDeep =
            plane.tooDeep && (branchFree::lane(share, i) > alongThePlane || plane.isGrowing());
      }

    if constexpr (width == 1)
    {
      if (response.sheared[0] > 0)
      {
        unevenly().crushByShear(crushed, permanents_[0], response.sheared[0], response.parted[0]);
        pressed = pair_.press(slope_, T(0.0), density);
        growFromBirth();
      }
      if (crushed.further)
        planes_.plane[0]->hysteresisWork += unevenly().lost(crushed, density, pressed);
    }

    lift(response.lifts, pressed, density);

    // A bond pulls evenly, by the mean closure, or by the closure at each point.
    const T mean = m.volume / m.area;
    const T sigma = all(response.tractions), perArea = all(response.stored);
    const T bent = 0.5 * all(response.slopes);
    const Mask even = bonded_ && !bends_;
    density.square = choose(bonded_, choose(bends_, bent, T(0.0)), density.square);
    density.constant = choose(even, perArea - sigma * mean, density.constant);
    density.linear = choose(bonded_, choose(bends_, T(0.0), sigma), density.linear);
    const T energy = choose(bonded_, choose(bends_, bent * m.squares, perArea * m.area), pressed);
    T normalForce(0.0);
    if (branchFree::anyOf(touching && !pair_.hasNothing()))
      normalForce = pair_.differentiate(energy, density);
    T normalEnergy = pair_.materialArea * pair_.opposedness * energy;
    if constexpr (width == 1)
      if (bent_.partly && touching)
        addClosedPart(pair_, *planes_.plane[0], slope_ - response.slopes[0], normalForce,
                      normalEnergy);
    payLifts(response, area, normalForce);
    stepH_forces(touching, area, normalForce, relative, normalEnergy);

    const Vec3Of<T> point = 0.5 * (weighted(relative.weights[0], a_.x, a_.count) +
                                   weighted(relative.weights[1], b_.x, b_.count));
    for (int i = 0; i < planes_.count; ++i)
      if (branchFree::lane(touching, i))
      {
        Plane& plane = *planes_.plane[i];
        plane.pointOfContact = branchFree::lane(point, i);
        plane.stored = branchFree::lane(normalEnergy, i) + plane.shearEnergy();
      }
  }

  /// Faces that slip lifts press as they lie then, so that friction and pressure are of one time.
  /// @param lifts gets 0 for those that would be strips, which are lifted after the cycle
  KOKKOS_FORCEINLINE_FUNCTION void lift(PerLane& lifts, T& pressed, EnergyDensity<T>& density);
  /// What lifts the faces against the mean of the normal forces before and after is no friction.
  KOKKOS_FORCEINLINE_FUNCTION void payLifts(const Response& response, const T& area,
                                            const T& normalForce) const;

  /// Of what has not been born yet the faces have not grown.
  KOKKOS_FORCEINLINE_FUNCTION void growFromBirth() const
  {
    const auto ofFace = [&](int f)
    {
      const T birth = planes_.each([f](const Plane& p) { return p.birthArea[f]; });
      return branchFree::choose(birth > 0.0, birth, pair_.faceArea(f));
    };
    pair_.growFrom(ofFace(0), ofFace(1));
  }

  /// What a joint that may be crushed unevenly has to do with its pair; T = Real.
  KOKKOS_INLINE_FUNCTION UnevenlyCrushed<Dim> unevenly() const
  {
    return {*planes_.plane[0],
            planes_.law[0]->curve.crushing,
            slopes_[0],
            options_,
            dt_,
            a_,
            b_,
            edgesOf(planes_),
            pair_};
  }

  KOKKOS_FORCEINLINE_FUNCTION Relative stepG_motion() const;

  /// Distance of the faces along the normal between places with these weights [m].
  KOKKOS_FORCEINLINE_FUNCTION T apartAt(const T (&weights)[2][4]) const;
  /// How the faces slide in the middle of the step, whose velocities these are. What has carried
  /// shear before did so a step ago less near, in a plane that was less turned, which counts alike,
  /// and at the centre of pressure of then.
  /// @param at centre of pressure now; drift: velocity of b against a there [m/s]
  /// @param relative gets how they slide, and what they gain
  KOKKOS_FORCEINLINE_FUNCTION void slideInStep(const Vec2Of<T>& at, const Vec3Of<T>& drift,
                                               Relative& relative) const;

  /// The shear state is traction times the root of the area, so that its energy does not hang on
  /// the area.
  /// @param increment gets how far the faces slide past each other in this step [m]
  /// @returns the shear traction before it, with the plane as it is now [Pa]
  KOKKOS_FORCEINLINE_FUNCTION Vec3Of<T> shearAfter(const T& newArea, const Relative& relative,
                                                   Vec3Of<T>& increment) const;

  /// The law of one plane: shear, bonds, dilation; history of the closure curve.
  /// @param area in contact; energyShare: energy of the pair over what its closure stores [-];
  ///        loaded: force [N] over opposedness
  /// @param tau shear traction before the step [Pa]; increment: of sliding [m]
  KOKKOS_FORCEINLINE_FUNCTION void stepH_law(Plane& plane, int i, Real area, Real energyShare,
                                             Real loaded, const Vec3& tau, const Vec3& increment,
                                             const Relative& relative, Response& out) const;

  /// What a joint that slips takes besides what its law has booked [J]: the mean of the work of its
  /// shear forces at both ends of the step, at places that move, over areas that change, is not
  /// that of the mean traction.
  /// @param tau, increment as in stepH_law; shrunk: root of the area before over that now [-]
  KOKKOS_FORCEINLINE_FUNCTION Real takenBesides(const Plane& plane, int i, const Vec3& tau,
                                                const Vec3& increment, Real shrunk,
                                                const Relative& relative) const;
  /// What the shear of a plane takes that carries no longer [J]: what it has stored, and what its
  /// forces work in the step in which they end.
  KOKKOS_FUNCTION Real endedShear(const Plane& plane, int i) const;

  /// What a pair that begins to carry can hold of the shear traction that it has taken over, which
  /// a neighbour may have raised while its area shrank [Pa]. The rest was never its own: it is no
  /// slip, and no energy.
  static KOKKOS_INLINE_FUNCTION Vec3 heldAt(const JointLaw& law, const JointFit& fit, Real closed,
                                            JointState state);

  /// What others learn of a joint that may be crushed unevenly: the closure of first loading that
  /// crushes it as much as it is in the mean.
  /// @param crushing that the law saw [m]
  KOKKOS_FORCEINLINE_FUNCTION void keepCrushing(const Plane& plane, int i, Real crushing,
                                                const JointResponse& response, JointState& state,
                                                Response& out) const;

  /// Lane i as the history of its joint sees it.
  KOKKOS_FORCEINLINE_FUNCTION ClosedPair closedPair(int i, Real energyShare) const;

  /// Forces at the corners: of the potential, of shear, whose moment is carried by the turning of
  /// the plane, of damping, and what the last step has missed.
  /// @param normalEnergy that is stored along the normal [J]
  KOKKOS_FORCEINLINE_FUNCTION void stepH_forces(const Mask& touching, const T& area,
                                                const T& normalForce, const Relative& relative,
                                                const T& normalEnergy);
  // What makes up for forces that bend within a step (PathOfStep.hpp); rare, and not inlined.
  /// Adds to the forces of pairs that carry what the mean of those at both ends of the step lacks
  /// of their mean along its path, where they bend.
  [[gnu::noinline]] KOKKOS_FUNCTION void followPath(const Mask& touching, const T& normalEnergy,
                                                    Vec3Of<T> (&nodal)[2][4]) const;
  /// The plane of lane i carries no longer: what remains is what its last step has missed.
  [[gnu::noinline]] KOKKOS_FUNCTION void partOnPath(Plane& plane, int i) const;
  /// The energy of a pair along the normal [J], and minus its gradient [N].
  struct NormalPush
  {
    Real energy = 0;
    Vec3 forces[2][4] = {};
  };
  /// That of lane i at a time `ago` before the end of the step [s]. @returns whether it pushed
  /// then
  [[gnu::noinline]] KOKKOS_FUNCTION bool pushAt(const Plane& plane, int i, Real ago,
                                                NormalPush& push) const;
  /// The mean of the forces along the path of the step, cut into parts [N]: in each that of both
  /// ends, and so much towards that in the middle as makes their work the change of the energy.
  /// @returns what could not be made so, by all of the middle or less [J]
  [[gnu::noinline]] KOKKOS_FUNCTION Real sumOverParts(const Plane& plane, int i, int parts,
                                                      const NormalPush& first,
                                                      const NormalPush& last,
                                                      Vec3 (&mean)[2][4]) const;
  /// What the forces at both ends of a step lack of that, times what pays for all that has been
  /// lost [N].
  /// @param carried, carries whether it does so at the beginning and at the end of the step
  /// @param bends whether the step bends them; lost: in it, but for what was planned [J]
  /// @returns whether there is anything
  KOKKOS_FUNCTION bool makeUp(Plane& plane, int i, bool carried, bool carries, bool bends,
                              Real lost, Vec3 (&missed)[2][4]) const;
  /// Work of forces at the nodes in a step that moves as the last one [J].
  KOKKOS_INLINE_FUNCTION Real work(const Vec3 (&forces)[2][4], int i) const
  {
    return 2 * halfStepWork(forces, movingFace(a_, i), movingFace(b_, i), dt_);
  }

  /// Dashpots, whose work is booked.
  /// @param normalDamping gets the force along the normal [N]
  /// @returns the force along the plane [N]
  KOKKOS_FORCEINLINE_FUNCTION Vec3Of<T> damp(const Mask& touching, const T& area,
                                             const T& normalForce, const Relative& relative,
                                             T& normalDamping) const;

  /// What the planes add to the stiffness of their nodes. The overlap counts as soon as the faces
  /// could touch within the look-ahead.
  KOKKOS_FORCEINLINE_FUNCTION void boundStep(const Mask& touching);

  /// Closure at which a curve bears now [m]; before faces touch that of the point that is nearest.
  /// Moved evenly the mean over the pressure rises by no more than the motion.
  KOKKOS_FORCEINLINE_FUNCTION Real foreseen(int i) const;

  // Rims make a contact stiffer that is deep for its width: from this fraction of the shortest edge
  // on, by so many times the fraction beyond (docs/theory/contact-potential.md, "Stable step").
  static constexpr Real rimsCountFrom = 0.02, rimStiffening = 3;
  /// The same of a strip, by its closure, width and length: its chi makes it up to 2.51 times as
  /// stiff as its area, and at a tip one node has all of that.
  static constexpr Real shareOfStrip = 2.51;

  /// Area that, times the stiffness of the law, bounds the stiffness at a node [m^2].
  KOKKOS_FORCEINLINE_FUNCTION T stiffArea(const T& ahead) const;

  static KOKKOS_FORCEINLINE_FUNCTION T all(const PerLane& values)
  {
    return branchFree::gathered<T>([&](int i) { return values[i]; });
  }

  const PlaneBatch<T>& planes_;
  const HalfStepFaceOf<T>&a_, &b_;
  const ContactOptions& options_;
  Real dt_;
  PairPotential<Dim, T>& pair_; ///< apart from this, for what is here to stay in registers
  PerLane slopes_, permanents_; ///< of the linear kernel [Pa/m], [m]
  PerLane reached_ = {};        ///< closure of a curve, higher than ever; 0: is not [m]
  bool crushes_[width] = {};    ///< may be crushed unevenly
  T slope_, hardening_;         ///< the same; one over the depth from which a penalty hardens [1/m]
  Mask bonded_, done_;
  /// Of the planes, when the cycle begins, if they follow the path.
  struct
  {
    T remainder, stored, area, hysteresis, slope; ///< slope: of the closure curve [Pa/m]
  } before_;
  Mask bends_;                             ///< bonds that resist bending
  BentBonds<T> bent_;                      ///< how these are bent
  T offset_;                               ///< beyond what is closed for good [m]
  T laid_[2][3];                           ///< as Plane::laid, where some have it [m]
  T overlap_;                              ///< of the shadows, per depth [m^2]
  Mask overlaps_;                          ///< whether that is enough to count
  T deepest_;                              ///< closure; negative: least distance [m]
  PerLane leastGaps_ = {};                 ///< where the faces are deepest in each other [m]
  T speed_;                                ///< of approach [m/s]
  bool late_[branchFree::widthOf<T>] = {}; ///< found later than they should have been
};
} // namespace detail

/// Steps B to H of candidate pairs in one cycle. a and b: the faces at the end of the step.
/// @returns the lanes that are done. With Lanes, planes whose shadows are not regular are left
///          untouched; updatePotentialPlanes<Real> does them.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T>
updatePotentialPlanes(const PlaneBatch<T>& planes, const HalfStepFaceOf<T>& a,
                      const HalfStepFaceOf<T>& b, const ContactOptions& options, Real dt)
{
  PairPotential<Dim, T> pair(a, b, ContactPotentialScale(options));
  return detail::PotentialCycle<Dim, T>(planes, a, b, options, dt, pair).run();
}

/// Steps B to H by the forces that the options ask for.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T>
updateByForces(const PlaneBatch<T>& planes, const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b,
               const ContactOptions& options, Real dt)
{
  return options.forces == ContactOptions::Forces::Potential
             ? updatePotentialPlanes<Dim, T>(planes, a, b, options, dt)
             : updatePlanes<Dim, T>(planes, a, b, options, dt);
}
template <int Dim>
KOKKOS_INLINE_FUNCTION void updateByForces(Plane& plane, const HalfStepFace& a,
                                           const HalfStepFace& b, const JointLaw& law,
                                           const ContactOptions& options, Real dt)
{
  PlaneBatch<Real> one;
  one.plane[0] = &plane;
  one.law[0] = &law;
  updateByForces<Dim, Real>(one, a, b, options, dt);
}
} // namespace coplane

#include <coplane_contact/detail/PathOfStep.hpp>
#include <coplane_contact/detail/PotentialBirths.hpp>
#include <coplane_contact/detail/PotentialCurves.hpp>
#include <coplane_contact/detail/PotentialForces.hpp>
#include <coplane_contact/detail/PotentialStep.hpp>
