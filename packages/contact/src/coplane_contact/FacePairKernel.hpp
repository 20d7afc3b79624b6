#pragma once

#include <coplane_contact/FacePairSteps.hpp>

namespace coplane
{
/// Velocity of face 1 relative to face 0 at the point of contact, and the mean spin of the pair.
struct RelativeMotion
{
  Vec3 drift{}; ///< difference of the weighted velocities of the faces [m/s]
  Vec3 jump{};  ///< the same less what the pair does as a rigid body [m/s]
  Vec3 spin{};  ///< [1/s]
};

/// Position of the point of face 1 relative to that of face 0 by the weights, at the time of the
/// shadows' heights: along the normal but for round-off, since both project to one point [m].
KOKKOS_INLINE_FUNCTION Vec3 armBetween(const TrialPlane& plane, const Shadow& a, const Shadow& b,
                                       const Patch& patch)
{
  Vec2 inPlane;
  Real height = 0;
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
KOKKOS_INLINE_FUNCTION RelativeMotion relativeMotion(const HalfStepFace& a, const HalfStepFace& b,
                                                     const Patch& patch, const Vec3& arm)
{
  RelativeMotion motion;
  motion.spin = 0.5 * (a.spin + b.spin);
  motion.drift =
      weighted(patch.weights[1], b.v, b.count) - weighted(patch.weights[0], a.v, a.count);
  motion.jump = motion.drift - cross(motion.spin, arm);
  return motion;
}

/// Carries a traction that lies in the plane with normal `from` into the plane with normal `to`:
/// least rotation, then the pair's spin about the new normal during dt, and no change of length.
KOKKOS_INLINE_FUNCTION Vec3 turnIntoPlane(const Vec3& traction, const Vec3& from, const Vec3& to,
                                          const Vec3& spin, Real dt)
{
  const Real size = norm(traction);
  if (size == 0)
    return traction;
  const Vec3 k = cross(from, to);
  const Vec3 kTau = cross(k, traction);
  Vec3 turned = traction + kTau + (1 / (1 + dot(from, to))) * cross(k, kTau);
  // The spin of a finite rotation between two positions is its Cayley vector: 2 tan(angle / 2) /
  // dt.
  const Real t = 0.5 * dt * dot(to, spin);
  const Real scale = 1 / (1 + t * t);
  turned = (scale * (1 - t * t)) * turned + (2 * scale * t) * cross(to, turned);
  turned = turned - dot(to, turned) * to;
  const Real length = norm(turned);
  return length > 0 ? (size / length) * turned : Vec3{};
}

/// Power of the plane's forces on the nodes with the velocities at hand; `spins` is the sum of the
/// spins of both faces at the time of the force [W].
KOKKOS_INLINE_FUNCTION Real powerOf(const Vec3& force, const Vec3& moment, const Vec3& drift,
                                    const Vec3& spins)
{
  return dot(force, drift) - 0.5 * dot(moment, spins);
}

/// Work of the old force on the nodes in this step, by the trapezoid rule [J].
KOKKOS_INLINE_FUNCTION void bookOldForce(Plane& plane, const HalfStepFace& a, const HalfStepFace& b,
                                         Real dt)
{
  const Vec3 drift =
      weighted(plane.weights[1], b.v, b.count) - weighted(plane.weights[0], a.v, a.count);
  plane.work -=
      (0.5 * dt) * powerOf(plane.force, plane.moment, drift, a.spinAtStart + b.spinAtStart);
}

/// What the forces of all planes of a face add to its nodes.
struct FaceLoad
{
  Vec3 force[4];     ///< [N]
  Real stiffness[4]; ///< bound on the stiffness that a node feels [N/m]
  Vec3 moment{};     ///< to be balanced by the couples of both faces [N m]

  KOKKOS_INLINE_FUNCTION FaceLoad()
  {
    for (int i = 0; i < 4; ++i)
    {
      force[i] = {};
      stiffness[i] = 0;
    }
  }

  /// Adds a plane of which this face is number `side`, 0 or 1. Stiffness: 2 k A |w| by Gershgorin's
  /// circles. The overlap's part of a node is at most all of it; 1.5/n covers uniform and mildly
  /// uneven patches, and the weights of the area in contact cover the uneven ones.
  KOKKOS_INLINE_FUNCTION void add(const Plane& plane, int side, int count)
  {
    const Real sign = side == 0 ? -1.0 : 1.0;
    const Real whole = plane.overlap * (1.5 / count < 1 ? 1.5 / count : 1.0);
    for (int i = 0; i < count; ++i)
    {
      force[i] += (sign * plane.weights[side][i]) * plane.force;
      const Real part = plane.area * std::abs(plane.weights[side][i]);
      stiffness[i] += 2 * Real(plane.stiffness) * (whole > part ? whole : part);
    }
    moment += plane.moment;
  }

  /// The couples: they make the moment of a plane's forces vanish and their power equal to force .
  /// jump. x: positions on which the forces act, x(n+1).
  template <int Dim>
  KOKKOS_INLINE_FUNCTION void balanceMoment(const Vec3* x, int count)
  {
    if (dot(moment, moment) == 0)
      return;
    const FaceInertia<Dim> inertia(x, count);
    const Vec3 turn = -0.5 * inertia.solve(moment);
    for (int i = 0; i < count; ++i)
      force[i] += cross(turn, inertia.r[i]);
  }
};

/// No traction in this cycle; history stays.
KOKKOS_INLINE_FUNCTION void openUp(Plane& plane, const HalfStepFace& a, const HalfStepFace& b,
                                   Real dt)
{
  if (plane.area > 0)
    bookOldForce(plane, a, b, dt);
  plane.force = plane.moment = {};
  plane.area = 0;
  plane.normalTraction = 0;
  plane.tooDeep = false;
  if (plane.born)
  {
    plane.closure = 0;
    plane.history.shearTraction = {};
    plane.state = PlaneState::Open;
  }
}

/// Gap at the time of the heights at the centre of gravity [m].
KOKKOS_INLINE_FUNCTION Real gapOf(const Patch& patch, const Shadow& a, const Shadow& b)
{
  Real gap = 0;
  for (int i = 0; i < b.count; ++i)
    gap += patch.centroidWeights[1][i] * b.height[i];
  for (int i = 0; i < a.count; ++i)
    gap -= patch.centroidWeights[0][i] * a.height[i];
  return gap;
}

/// Step H: plane variables. Cundall's update in tractions: closure, shear increment, joint law,
/// force, energies. `gap`: at the end of the step [m].
KOKKOS_INLINE_FUNCTION void stepH_updatePlaneVariables(Plane& plane, const Patch& patch, Real gap,
                                                       const TrialPlane& trial,
                                                       const HalfStepFace& a, const HalfStepFace& b,
                                                       const Shadow& shadowA, const Shadow& shadowB,
                                                       const JointLaw& law,
                                                       const ContactOptions& options, Real dt)
{
  const Vec3& n = trial.normal;
  // Heights are those of the end of the step, the rates belong to the half step.
  const Real opening =
      dot(n, weighted(patch.weights[1], b.v, b.count) - weighted(patch.weights[0], a.v, a.count));
  const Vec3 arm = armBetween(trial, shadowA, shadowB, patch) - (0.5 * dt * opening) * n;
  const RelativeMotion motion = relativeMotion(a, b, patch, arm);
  const Real speed = dot(n, motion.jump);
  const Vec3 sliding = dt * (motion.jump - speed * n);

  if (plane.area > 0)
    bookOldForce(plane, a, b, dt);

  plane.gap = gap;
  if (options.closure == ContactOptions::Closure::Total)
    plane.closure = plane.offset - plane.gap;
  else
    plane.closure -= dt * speed;
  plane.tooDeep = plane.closure > plane.depthLimit;

  Vec3 tau = turnIntoPlane(plane.history.shearTraction, plane.normal, n, motion.spin, dt);
  if (options.areaRule && plane.area > 0 && patch.area > plane.area)
    tau = (plane.area / patch.area) * tau;
  plane.history.shearTraction = tau;
  const JointResponse response = law(plane.fit, plane.limitedClosure(), sliding, dt, plane.history);

  plane.normal = n;
  plane.area = patch.area;
  plane.normalTraction = response.normalTraction;
  plane.state = !plane.history.bonded && response.normalTraction <= 0 ? PlaneState::Open
                : response.slipping                                   ? PlaneState::Slip
                                                                      : PlaneState::Stick;
  plane.offset += response.dilation;
  plane.closure += response.dilation;
  plane.frictionWork += plane.area * response.frictionWork;
  plane.hysteresisWork += plane.area * response.hysteresisWork;
  plane.fractureWork += plane.area * response.fractureWork;
  Vec3 force = plane.area * (response.normalTraction * n + plane.history.shearTraction);

  if (options.dampNormal > 0 || options.dampShear > 0)
  {
    Real inverseMass = 0;
    for (int i = 0; i < a.count; ++i)
      inverseMass += patch.weights[0][i] * patch.weights[0][i] * a.inverseMass[i];
    for (int i = 0; i < b.count; ++i)
      inverseMass += patch.weights[1][i] * patch.weights[1][i] * b.inverseMass[i];
    Real normalForce = -2 * options.dampNormal *
                       std::sqrt(plane.area * response.normalStiffness / inverseMass) * speed;
    const Real elastic = plane.area * response.normalTraction;
    if (!plane.history.bonded && normalForce < -elastic)
      normalForce = -elastic; // no tension
    Vec3 damping = normalForce * n;
    if (plane.state == PlaneState::Stick)
      damping += (-2 * options.dampShear *
                  std::sqrt(plane.area * plane.fit.shearStiffness / inverseMass)) *
                 (motion.jump - speed * n);
    plane.dampingWork -= dt * dot(damping, motion.jump);
    force += damping;
  }

  plane.force = force;
  plane.moment = options.couple ? cross(arm + (0.5 * dt) * motion.drift, force) : Vec3{};
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < 4; ++i)
      plane.weights[f][i] = patch.weights[f][i];
  plane.work -= (0.5 * dt) * powerOf(force, plane.moment, motion.drift, a.spinAtEnd + b.spinAtEnd);
}

/// Whether the bounding boxes of two shadows share no area: most candidates are neighbours that
/// only touch along an edge.
KOKKOS_INLINE_FUNCTION bool shadowsApart(const Shadow& a, const Shadow& b)
{
  Vec2 low[2], high[2];
  const Shadow* shadows[2] = {&a, &b};
  for (int f = 0; f < 2; ++f)
  {
    low[f] = high[f] = shadows[f]->p[0];
    for (int i = 1; i < shadows[f]->count; ++i)
    {
      const Vec2& p = shadows[f]->p[i];
      low[f] = {p.x < low[f].x ? p.x : low[f].x, p.y < low[f].y ? p.y : low[f].y};
      high[f] = {p.x > high[f].x ? p.x : high[f].x, p.y > high[f].y ? p.y : high[f].y};
    }
  }
  return low[0].x >= high[1].x || low[1].x >= high[0].x ||
         (a.count > 2 && (low[0].y >= high[1].y || low[1].y >= high[0].y));
}

/// Depth, as a fraction of the depth limit, beyond which a first overlap is not taken for a
/// contact.
constexpr Real deepestBirth = 0.25;

/// Bound on the speed at which corners of the faces approach each other along the normal [m/s].
KOKKOS_INLINE_FUNCTION Real approachSpeed(const Vec3& normal, const HalfStepFace& a,
                                          const HalfStepFace& b)
{
  Real towards = 0, away = 0;
  for (int i = 0; i < a.count; ++i)
  {
    const Real speed = dot(normal, a.v[i] - b.v[0]);
    towards = speed > towards ? speed : towards;
  }
  for (int i = 0; i < b.count; ++i)
  {
    const Real speed = dot(normal, b.v[0] - b.v[i]);
    away = speed > away ? speed : away;
  }
  return towards + away;
}

/// Steps B to H of one candidate pair in one cycle; step A has been done for its faces.
template <int Dim>
KOKKOS_INLINE_FUNCTION void updatePlane(Plane& plane, const HalfStepFace& a, const HalfStepFace& b,
                                        const JointLaw& law, const ContactOptions& options, Real dt)
{
  const TrialPlane trial = stepB_trialPointOfContact<Dim>(a, b);
  const Shadow shadowA = stepC_projectOntoPlane<Dim>(trial, a, dt);
  const Shadow shadowB = stepC_projectOntoPlane<Dim>(trial, b, dt);
  const AreaInUse use = plane.history.bonded                         ? AreaInUse::Bonded
                        : options.area == ContactOptions::Area::Full ? AreaInUse::Full
                                                                     : AreaInUse::Penetrating;
  const Depth depth = depthOf(trial, options);
  const Patch patch =
      trial.opposed && !shadowsApart(shadowA, shadowB)
          ? stepD_areaOfContact<Dim>(shadowA, shadowB, plane.offset, use, options.weights, depth)
          : Patch{};
  plane.overlap = patch.overlap;
  const Real smallest =
      options.areaMin * (a.area < b.area ? a.area : b.area) * depth.at(patch.centroid.x);
  plane.foundLate = plane.fresh && !plane.declared && !plane.born && patch.area > smallest;
  // Slivers carry nothing: their force is below areaMin k c, and their centroid has no digits.
  bool inContact = patch.area > smallest;
  const Real approach =
      trial.opposed && patch.overlap > 0 ? 2 * dt * approachSpeed(trial.normal, a, b) : 0;
  if (inContact && !(plane.area > 0))
  {
    const Real gap = gapOf(patch, shadowA, shadowB);
    // From the half step to the end of the step.
    const Real motion =
        (0.5 * dt) * dot(trial.normal, weighted(patch.centroidWeights[1], b.v, b.count) -
                                           weighted(patch.centroidWeights[0], a.v, a.count));
    // A contact begins at the surface, and begins there anew after its faces had no area in common.
    // Faces that share area for the first time, or again, while one lies deep behind the other did
    // not meet: they are ends of bricks one above the other, say, whose horizontal joint closed by
    // a hair. So are faces that a search finds deeper in each other than a contact can be.
    const Real start =
        approach > deepestBirth * plane.depthLimit ? approach : deepestBirth * plane.depthLimit;
    const Real deepest = plane.fresh ? plane.depthLimit : start;
    // Where faces slide on, a pair may be born as deep as its neighbours are, and they passed on
    // their closure. Neighbours of the front and of the back of a thin body explain nothing. An
    // open plane has no closure: its surface is where its offset says.
    const bool exists = stepE_planeExists(plane);
    const Real explained = exists || plane.inherited ? plane.offset - plane.closure : 0;
    if (!plane.declared && motion + explained - gap > deepest)
      plane.released = true;
    if (!plane.released && !exists)
      stepF_createPlane(plane, trial.normal, gap);
  }
  if (!(patch.area > 0))
    plane.released = false;
  inContact = inContact && !plane.released;
  if (inContact)
  {
    plane.pointOfContact = stepG_placePointOfContact(patch, a, b);
    const Real gap = gapOf(patch, shadowA, shadowB);
    stepH_updatePlaneVariables(plane, patch, gap, trial, a, b, shadowA, shadowB, law, options, dt);
  }
  else
  {
    openUp(plane, a, b, dt);
    if (patch.overlap > 0)
      plane.gap = patch.leastGap + plane.offset;
  }
  plane.fresh = false;
  // The overlap counts for the stable step as soon as the faces could touch within the next two
  // steps, so that the step does not drop suddenly.
  const bool near = plane.area > 0 || patch.leastGap <= approach + 1e-8 * std::sqrt(patch.overlap);
  plane.stiffness = near ? float(law.stiffnessBound(plane.fit, plane.history) * 1.000001) : 0;
}
} // namespace coplane
