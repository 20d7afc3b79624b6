#pragma once

#include <coplane_contact/FaceLoad.hpp>
#include <coplane_contact/PairLife.hpp>

// Steps B to H of a pair of faces whose forces act along the normal of their common plane, as the
// paper has them.

namespace coplane
{
/// Velocity of face 1 relative to face 0 at the point of contact, and the mean spin of the pair.
template <class T>
struct RelativeMotionOf
{
  Vec3Of<T> drift{}; ///< difference of the weighted velocities of the faces [m/s]
  Vec3Of<T> jump{};  ///< the same less what the pair does as a rigid body [m/s]
  Vec3Of<T> spin{};  ///< [1/s]
};
using RelativeMotion = RelativeMotionOf<Real>;

/// Position of the point of face 1 relative to that of face 0 by the weights, at the time of the
/// shadows' heights: along the normal but for round-off, since both project to one point [m].
template <class T>
KOKKOS_INLINE_FUNCTION Vec3Of<T> armBetween(const TrialPlaneOf<T>& plane, const ShadowOf<T>& a,
                                            const ShadowOf<T>& b, const PatchOf<T>& patch)
{
  Vec2Of<T> inPlane;
  T height{};
  for (int i = 0; i < b.count; ++i)
  {
    inPlane = inPlane + patch.weights[1][i] * b.p[i];
    height += patch.weights[1][i] * b.height[i];
  }
  for (int i = 0; i < a.count; ++i)
  {
    inPlane = inPlane - patch.weights[0][i] * a.p[i];
    height -= patch.weights[0][i] * a.height[i];
  }
  return inPlane.x * plane.e1 + inPlane.y * plane.e2 + height * plane.normal;
}

/// Objective: the jump is zero for any rigid motion of both faces together, also when they are
/// apart by a gap.
template <class T>
KOKKOS_INLINE_FUNCTION RelativeMotionOf<T>
relativeMotion(const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b, const PatchOf<T>& patch,
               const Vec3Of<T>& arm)
{
  RelativeMotionOf<T> motion;
  motion.spin = 0.5 * (a.spin + b.spin);
  motion.drift =
      weighted(patch.weights[1], b.v, b.count) - weighted(patch.weights[0], a.v, a.count);
  motion.jump = motion.drift - cross(motion.spin, arm);
  return motion;
}

/// The forces on a face's corners at the end of the step that balance half of a moment.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void addCouple(const HalfStepFaceOf<T>& face, const Vec3Of<T>& moment,
                                      Real dt, Vec3Of<T> (&nodal)[4])
{
  Vec3Of<T> x[4];
  for (int i = 0; i < face.count; ++i)
    x[i] = face.x[i] + (0.5 * dt) * face.v[i];
  const FaceInertia<Dim, T> inertia(x, face.count);
  const Vec3Of<T> turn = -0.5 * inertia.solve(moment);
  for (int i = 0; i < face.count; ++i)
    nodal[i] += cross(turn, inertia.r[i]);
}

/// Gap at the time of the heights at the centre of gravity [m].
template <class T>
KOKKOS_INLINE_FUNCTION T gapOf(const PatchOf<T>& patch, const ShadowOf<T>& a, const ShadowOf<T>& b)
{
  T gap{};
  for (int i = 0; i < b.count; ++i)
    gap += patch.centroidWeights[1][i] * b.height[i];
  for (int i = 0; i < a.count; ++i)
    gap -= patch.centroidWeights[0][i] * a.height[i];
  return gap;
}

/// Motion of pairs at their points of contact, with the arm between these at the half step.
template <class T>
struct PointMotionOf
{
  Vec3Of<T> arm;
  RelativeMotionOf<T> relative;
  T speed;              ///< of opening [m/s]
  Vec3Of<T> tangential; ///< [m/s]
};

/// Heights are those of the end of the step, the rates belong to the half step.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION PointMotionOf<T>
stepH_motion(const PatchOf<T>& patch, const TrialPlaneOf<T>& trial, const HalfStepFaceOf<T>& a,
             const HalfStepFaceOf<T>& b, const ShadowOf<T>& shadowA, const ShadowOf<T>& shadowB,
             Real dt)
{
  const Vec3Of<T>& n = trial.normal;
  const Vec3Of<T> drift =
      weighted(patch.weights[1], b.v, b.count) - weighted(patch.weights[0], a.v, a.count);
  PointMotionOf<T> at;
  at.arm = armBetween(trial, shadowA, shadowB, patch) - (0.5 * dt * dot(n, drift)) * n;
  at.relative = relativeMotion(a, b, patch, at.arm);
  at.speed = dot(n, at.relative.jump);
  at.tangential = at.relative.jump - at.speed * n;
  return at;
}

/// Shear traction before the step, in the plane as it is now [Pa].
template <class T>
KOKKOS_FORCEINLINE_FUNCTION Vec3Of<T>
stepH_carriedShear(const PlaneBatch<T>& planes, const PatchOf<T>& patch, const Vec3Of<T>& n,
                   const Vec3Of<T>& spin, const ContactOptions& options, Real dt)
{
  Vec3Of<T> tau =
      turnIntoPlane(planes.eachVector([](const Plane& p) { return p.history.shearTraction; }),
                    planes.eachVector([](const Plane& p) { return p.normal; }), n, spin, dt);
  if (options.areaRule)
  {
    const T before = planes.each([](const Plane& p) { return p.area; });
    tau =
        branchFree::choose(before > 0.0 && patch.area > before, before / patch.area, T(1.0)) * tau;
  }
  return tau;
}

/// The law of one plane and its history, with its gap, area, normal and shear traction as they are
/// now.
/// @param opening of the pair in this step [m]; sliding: too [m]
KOKKOS_FORCEINLINE_FUNCTION JointResponse stepH_law(Plane& plane, const JointLaw& law, Real opening,
                                                    const Vec3& sliding,
                                                    const ContactOptions& options, Real dt)
{
  if (options.closure == ContactOptions::Closure::Total)
    plane.closure = plane.offset - plane.gap;
  else
    plane.closure -= opening;
  plane.tooDeep = plane.isTooDeep();
  const JointResponse response = law(plane.fit, plane.limitedClosure(), sliding, dt, plane.history);
  plane.hysteresisWork += plane.area * response.hysteresisWork(plane.normalTraction);
  plane.frictionWork += plane.area * response.workOfSlip(plane.normalTraction);
  plane.normalTraction = response.normalTraction;
  plane.state = !plane.history.bonded && response.normalTraction <= 0 ? PlaneState::Open
                : response.slipping                                   ? PlaneState::Slip
                                                                      : PlaneState::Stick;
  plane.offset += response.dilation;
  plane.closure += response.dilation;
  plane.stored = plane.area * law.stored(plane.fit, plane.limitedClosure(), plane.history);
  plane.fractureWork += plane.area * response.fractureWork;
  return response;
}

/// Dashpots at the point of contact [N].
/// @param elastic force along the normal [N]; normalStiffness: of the law [Pa/m]
/// @param alongNormal gets the part along the normal [N]
template <class T>
KOKKOS_FORCEINLINE_FUNCTION Vec3Of<T>
stepH_damping(const PlaneBatch<T>& planes, const PatchOf<T>& patch, const T& elastic,
              const T& normalStiffness, const Vec3Of<T>& n, const PointMotionOf<T>& motion,
              const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b, const ContactOptions& options,
              T& alongNormal)
{
  using namespace branchFree;
  T normalForce =
      -patch.area * dashpotPerArea(options.dampNormal, normalStiffness, a, b) * motion.speed;
  const auto bonded = planes.each([](const Plane& p) { return p.history.bonded; }) > 0.0;
  normalForce = choose(!bonded && normalForce < -elastic, -elastic, normalForce); // no tension
  alongNormal = normalForce;
  const auto sticks =
      planes.each([](const Plane& p) { return p.state == PlaneState::Stick; }) > 0.0;
  const T shearStiffness = planes.each([](const Plane& p) { return p.fit.shearStiffness; });
  const Vec3Of<T> shearing =
      choose(sticks, -patch.area * dashpotPerArea(options.dampShear, shearStiffness, a, b),
             T(0.0)) *
      motion.tangential;
  return normalForce * n + heldByFriction(planes, elastic, shearing);
}

/// The force at the corners of both faces; half of the moment of both forces, at the end of the
/// step, where they act, is balanced by each face.
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void
stepH_nodalForces(const PatchOf<T>& patch, const Vec3Of<T>& force, const PointMotionOf<T>& motion,
                  const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b, bool couple, Real dt,
                  Vec3Of<T> (&nodal)[2][4])
{
  for (int i = 0; i < a.count; ++i)
    nodal[0][i] = -patch.weights[0][i] * force;
  for (int i = 0; i < b.count; ++i)
    nodal[1][i] = patch.weights[1][i] * force;
  if (!couple)
    return;
  const Vec3Of<T> moment = cross(motion.arm + (0.5 * dt) * motion.relative.drift, force);
  addCouple<Dim>(a, moment, dt, nodal[0]);
  addCouple<Dim>(b, moment, dt, nodal[1]);
}

/// Step H: plane variables. Cundall's update in tractions: closure, shear increment, joint law,
/// force, energies; for the lanes of `touching`. The work of the old force has been booked.
/// @param gap at the end of the step [m]
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void
stepH_updatePlaneVariables(const PlaneBatch<T>& planes, const branchFree::MaskOf<T>& touching,
                           const PatchOf<T>& patch, const T& gap, const TrialPlaneOf<T>& trial,
                           const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b,
                           const ShadowOf<T>& shadowA, const ShadowOf<T>& shadowB,
                           const ContactOptions& options, Real dt)
{
  using namespace branchFree;
  const Vec3Of<T>& n = trial.normal;
  const PointMotionOf<T> motion = stepH_motion(patch, trial, a, b, shadowA, shadowB, dt);
  const Vec3Of<T> sliding = dt * motion.tangential;
  const Vec3Of<T> tau = stepH_carriedShear(planes, patch, n, motion.relative.spin, options, dt);

  Real tractions[widthOf<T>] = {}, stiffnesses[widthOf<T>] = {};
  for (int i = 0; i < planes.count; ++i)
  {
    if (!lane(touching, i))
      continue;
    Plane& plane = *planes.plane[i];
    plane.gap = lane(gap, i);
    plane.history.shearTraction = lane(tau, i);
    plane.normal = lane(n, i);
    plane.area = lane(patch.area, i);
    const JointResponse response =
        stepH_law(plane, *planes.law[i], dt * lane(motion.speed, i), lane(sliding, i), options, dt);
    tractions[i] = response.normalTraction;
    stiffnesses[i] = response.normalStiffness;
  }
  const auto each = [&](const Real* values)
  { return gathered<T>([&](int i) { return values[i]; }); };
  const T sigma = each(tractions);
  Vec3Of<T> force =
      patch.area *
      (sigma * n + planes.eachVector([](const Plane& p) { return p.history.shearTraction; }));
  T dampingWork{}, alongNormal{};
  if (options.dampNormal > 0 || options.dampShear > 0)
  {
    const Vec3Of<T> damping = stepH_damping(planes, patch, patch.area * sigma, each(stiffnesses), n,
                                            motion, a, b, options, alongNormal);
    // Along the normal, which bodies strike, by the trapezoid rule, as all work of nodes.
    const T before = planes.each([](const Plane& p) { return p.normalDamping; });
    dampingWork =
        dt * (dot(damping, motion.relative.jump) + 0.5 * (before - alongNormal) * motion.speed);
    force += damping;
  }
  for (int i = 0; i < planes.count; ++i)
    if (lane(touching, i))
    {
      planes.plane[i]->dampingWork -= lane(dampingWork, i);
      planes.plane[i]->normalDamping = float(lane(alongNormal, i));
    }

  Vec3Of<T> nodal[2][4];
  stepH_nodalForces<Dim>(patch, force, motion, a, b, options.couple, dt, nodal);
  putForces(planes, touching, nodal, a, b, dt);
}

/// Steps E and F: whether a pair that shares enough area touches, for which it becomes a plane if
/// it is none yet.
/// @param gap at the end of the step, deepest: where the faces are deepest in each other, motion:
///        change of the gap since the half step, approach: of the faces in two steps [m]
KOKKOS_INLINE_FUNCTION bool touches(Plane& plane, const Vec3& normal, Real gap, Real deepest,
                                    Real motion, Real approach)
{
  if (!(plane.area > 0))
  {
    // A contact begins at the surface, and begins there anew after its faces had no area in common.
    // Faces that share area for the first time, or again, while one lies deep behind the other did
    // not meet: they are ends of bricks one above the other, say, whose horizontal joint closed by
    // a hair. So are faces that a search finds deeper in each other than a contact can be.
    const bool exists = stepE_planeExists(plane);
    const Real start =
        approach > deepestBirth * plane.depthLimit ? approach : deepestBirth * plane.depthLimit;
    const Real limit = plane.isNew() ? plane.depthLimit : start;
    // Where faces slide from one body to the next, a pair may be born as deep as its neighbours
    // are, and they passed on their closure. Neighbours of the front and of the back of a thin body
    // explain nothing. An open plane has no closure: its surface is where its offset says.
    const Real explained = exists || plane.isInherited() ? plane.offset - plane.closure : 0;
    // A face that slides on over the same surface meets the next face of it as deep as it lies
    // there, also where the surface is rough; what is found with area in common does not slide on.
    const bool slidesOn = plane.lineage == Lineage::SlidesOn && !plane.isNew();
    if (!plane.declared && !slidesOn && motion + explained - gap > limit)
      plane.refusal = Refusal::Deep;
    if (!plane.isRefused() && !exists)
      stepF_createPlane(plane, normal, deepest);
  }
  return !plane.isRefused();
}

/// By which a stiffness per area bounds what a node of the pair feels: 2 A |w|. The overlap's part
/// of a node covers patches that are not very uneven, and the weights of the area in contact cover
/// the others [m^2].
template <class T>
KOKKOS_INLINE_FUNCTION T areaOfNode(const PatchOf<T>& patch, int countA, int countB)
{
  T most{};
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < (f == 0 ? countA : countB); ++i)
      most = branchFree::larger(branchFree::absolute(patch.weights[f][i]), most);
  return rowSum *
         branchFree::larger(patch.overlap * shareOfOverlap(countA, countB), patch.area * most);
}

/// The energy of a pair, whose way out is asked for, needs a bound from which its faces oppose each
/// other [-]. Forces along the common normal have none: one that leaves out faces at right angles
/// only.
constexpr Real opposedForWayOut = 1e-3;

/// PairPotential::wayOut where all ways out are as long: cubes that meet corner on corner share a
/// square as deep as it is wide, two strips, rho = 2^(-5/4) = 0.4204. From here on the way along
/// the normal is no longer than the others, so one of the pairs of a corner always holds [-].
KOKKOS_INLINE_FUNCTION Real wayOutOfCorners(const ContactPotentialScale& scale)
{
  return SmoothStep<Real>((0.42 - scale.wayOutFrom) / (scale.wayOutTo - scale.wayOutFrom)).value;
}

/// Whether what the faces in lane i share is so narrow between edges over which their bodies can
/// part that the least way out leads along the plane: the front of a slider behind the hidden side
/// of the next block. Then it is no contact.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION bool leavesSideways(const Plane& plane, const HalfStepFaceOf<T>& a,
                                           const HalfStepFaceOf<T>& b, int i)
{
  if (plane.exits == 0)
    return false;
  const HalfStepFace faces[2] = {placeOf(a, i), placeOf(b, i)};
  const ContactPotentialScale scale(opposedForWayOut);
  PairPotential<Dim, Real> pair(faces[0], faces[1], scale);
  if (!pair.plane.opposed)
    return false;
  EdgesOf<Real> edges;
  for (int e = 0; e < 8; ++e)
    edges.exits[e] = plane.exits >> e & 1;
  pair.meet(plane.offset, false, edges);
  EnergyDensity<Real> density;
  pair.press(1, 0, density);
  return pair.wayOut < wayOutOfCorners(scale);
}

/// Steps B to H of candidate pairs in one cycle; step A has been done for their faces. In one
/// piece: in steps of their own that hand on a struct they took 4 % longer (coplane_bench_contact,
/// flat and sheared interfaces, GCC 12).
/// @returns the lanes that are done. With Lanes, planes whose patch is not regular are left
///          untouched; updatePlanes<Real> does them.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T>
updatePlanes(const PlaneBatch<T>& planes, const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b,
             const ContactOptions& options, Real dt)
{
  using namespace branchFree;
  constexpr bool single = widthOf<T> == 1;
  const TrialPlaneOf<T> trial = stepB_trialPointOfContact<Dim>(a, b);
  const ShadowOf<T> shadowA = stepC_projectOntoPlane<Dim>(trial, a, dt);
  const ShadowOf<T> shadowB = stepC_projectOntoPlane<Dim>(trial, b, dt);
  const auto meet = trial.opposed && !shadowsApart(shadowA, shadowB);
  PatchOf<T> patch;
  T smallest = options.areaMin * smaller(a.area, b.area);
  if constexpr (single)
  {
    const Plane& plane = *planes.plane[0];
    const AreaInUse use = plane.history.bonded                         ? AreaInUse::Bonded
                          : options.area == ContactOptions::Area::Full ? AreaInUse::Full
                                                                       : AreaInUse::Penetrating;
    const Depth depth = depthOf(trial, options);
    if (meet)
      patch = stepD_areaOfContact<Dim>(shadowA, shadowB, plane.offset, use, options.weights, depth);
    smallest *= depth.at(patch.centroid.x);
  }
  else
    patch =
        stepD_areaOfContact(shadowA, shadowB, planes.each([](const Plane& p) { return p.offset; }),
                            planes.each([](const Plane& p) { return p.history.bonded; }) > 0.0,
                            options.area, options.weights);
  const auto done = patch.regular && (meet || MaskOf<T>(single));
  bookOldForce(planes, done, a, b, dt);

  // Slivers carry nothing: their force is below areaMin k c, and their centroid has no digits.
  const auto large = patch.area > smallest;
  const T gap = gapOf(patch, shadowA, shadowB);
  const auto carries = planes.each([](const Plane& p) { return p.area; }) > 0.0;
  const T speed = choose(patch.overlap > 0.0, approachSpeed(trial.normal, a, b), T(0.0));
  const T ahead = options.lookAhead * speed;
  T deepest{}, motion{}, approach{};
  if (!allOf(large && carries))
  {
    deepest = options.area == ContactOptions::Area::Full
                  ? gap
                  : patch.leastGap + planes.each([](const Plane& p) { return p.offset; });
    approach = 2.0 * dt * speed;
    // From the half step to the end of the step.
    motion = (0.5 * dt) * dot(trial.normal, weighted(patch.centroidWeights[1], b.v, b.count) -
                                                weighted(patch.centroidWeights[0], a.v, a.count));
  }
  bool late[widthOf<T>] = {};
  const auto touching = gathered<T>(
                            [&](int i) -> Real
                            {
                              if (i >= planes.count || !lane(done, i))
                                return 0;
                              Plane& plane = *planes.plane[i];
                              plane.overlap = lane(patch.overlap, i);
                              plane.unseen = false;
                              const bool isLarge = lane(large, i);
                              late[i] = wasFoundLate(plane, isLarge);
                              const bool inContact =
                                  isLarge &&
                                  (plane.history.bonded || !leavesSideways<Dim>(plane, a, b, i)) &&
                                  touches(plane, lane(trial.normal, i), lane(gap, i),
                                          lane(deepest, i), lane(motion, i), lane(approach, i));
                              if (!(lane(patch.area, i) > 0))
                                plane.refusal = Refusal::None;
                              return inContact;
                            }) > 0.0;
  if (anyOf(touching))
  {
    const Vec3Of<T> point = stepG_placePointOfContact(patch, a, b);
    for (int i = 0; i < planes.count; ++i)
      if (lane(touching, i))
        planes.plane[i]->pointOfContact = lane(point, i);
    stepH_updatePlaneVariables<Dim>(planes, touching, patch, gap, trial, a, b, shadowA, shadowB,
                                    options, dt);
  }
  // The overlap counts for the stable step as soon as the faces could touch within the look-ahead:
  // the step has to be short enough before it takes them into each other.
  const T size =
      options.axisymmetric ? squareRoot(patch.overlap) : lengthOfArea<Dim>(patch.overlap);
  const auto near = patch.leastGap <= ahead + roundOffOfGap * size;
  const T share = areaOfNode(patch, a.count, b.count);
  for (int i = 0; i < planes.count; ++i)
  {
    if (!lane(done, i))
      continue;
    Plane& plane = *planes.plane[i];
    if (!lane(touching, i))
    {
      carryNothing(plane);
      if (plane.overlap > 0)
        plane.gap = lane(patch.leastGap, i) + plane.offset;
    }
    plane.sighting = late[i] ? Sighting::FoundLate : Sighting::Known;
    const Real closure = plane.area > 0 ? plane.closure : -lane(patch.leastGap, i);
    plane.nodeStiffness = plane.area > 0 || lane(near, i)
                              ? float(plane.weightInStep() * lane(share, i) *
                                      planes.law[i]->stiffnessBound(plane.fit, plane.history,
                                                                    closure + lane(ahead, i)))
                              : 0;
  }
  return done;
}

/// Steps B to H of one candidate pair in one cycle.
template <int Dim>
KOKKOS_INLINE_FUNCTION void updatePlane(Plane& plane, const HalfStepFace& a, const HalfStepFace& b,
                                        const JointLaw& law, const ContactOptions& options, Real dt)
{
  PlaneBatch<Real> one;
  one.plane[0] = &plane;
  one.law[0] = &law;
  updatePlanes<Dim, Real>(one, a, b, options, dt);
}
} // namespace coplane
