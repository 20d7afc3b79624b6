#pragma once

#include <coplane_contact/FacePairSteps.hpp>

namespace coplane
{
/// Least-squares spin of a face and what the couple needs of it. r: corners relative to their mean.
template <int Dim>
struct FaceSpin
{
  Vec3 r[4];
  Mat3 inertia{}; ///< sum |r|^2 I - r (x) r; in two dimensions only the zz entry is used
  int count = 0;

  KOKKOS_INLINE_FUNCTION FaceSpin(const Vec3* x, int n) : count(n)
  {
    Vec3 mean{};
    for (int i = 0; i < n; ++i)
      mean += x[i];
    mean = (1.0 / n) * mean;
    for (int i = 0; i < n; ++i)
    {
      r[i] = x[i] - mean;
      const Real rr = dot(r[i], r[i]);
      if constexpr (Dim == 2)
        inertia(2, 2) += rr;
      else
        for (int p = 0; p < 3; ++p)
          for (int q = 0; q < 3; ++q)
            inertia(p, q) += (p == q ? rr : 0) - r[i][p] * r[i][q];
    }
  }

  /// inertia^-1 * moment; nothing for a face 3000 times longer than wide: the forces of a couple
  /// about its axis grow without bound, and round-off with them.
  KOKKOS_INLINE_FUNCTION Vec3 solve(const Vec3& moment) const
  {
    if constexpr (Dim == 2)
      return {0, 0, moment.z / inertia(2, 2)};
    else
    {
      const Real trace = inertia(0, 0) + inertia(1, 1) + inertia(2, 2);
      return determinant(inertia) > 1e-8 * trace * trace * trace ? inverse(inertia) * moment
                                                                 : Vec3{};
    }
  }

  /// Spin of the rigid motion nearest to the corner velocities [1/s].
  KOKKOS_INLINE_FUNCTION Vec3 spin(const Vec3* v) const
  {
    Vec3 moment{};
    for (int i = 0; i < count; ++i)
      moment += cross(r[i], v[i]);
    return solve(moment);
  }
};

/// Velocity of face 1 relative to face 0 at the point of contact, and the mean spin of the pair.
struct RelativeMotion
{
  Vec3 jump{}; ///< [m/s]
  Vec3 spin{}; ///< [1/s]
};

/// Objective: zero for any rigid motion of both faces together, also when they are apart by a gap.
template <int Dim>
KOKKOS_INLINE_FUNCTION RelativeMotion relativeMotion(const HalfStepFace& a, const HalfStepFace& b,
                                                     const FaceNodes& nodesA,
                                                     const FaceNodes& nodesB, const Patch& patch)
{
  RelativeMotion motion;
  motion.spin = 0.5 * (FaceSpin<Dim>(a.x, a.count).spin(nodesA.v) +
                       FaceSpin<Dim>(b.x, b.count).spin(nodesB.v));
  const Vec3 arm =
      weighted(patch.weights[1], b.x, b.count) - weighted(patch.weights[0], a.x, a.count);
  motion.jump = weighted(patch.weights[1], nodesB.v, b.count) -
                weighted(patch.weights[0], nodesA.v, a.count) - cross(motion.spin, arm);
  return motion;
}

/// Carries a vector that lies in the plane with normal `from` into the plane with normal `to`:
/// least rotation, then the pair's spin about the new normal during dt, and no change of length.
KOKKOS_INLINE_FUNCTION Vec3 turnIntoPlane(const Vec3& tau, const Vec3& from, const Vec3& to,
                                          const Vec3& spin, Real dt)
{
  const Real size = norm(tau);
  if (size == 0)
    return tau;
  const Vec3 k = cross(from, to);
  const Vec3 kTau = cross(k, tau);
  Vec3 turned = tau + kTau + (1 / (1 + dot(from, to))) * cross(k, kTau);
  const Real angle = dt * dot(to, spin);
  turned = std::cos(angle) * turned + std::sin(angle) * cross(to, turned) +
           ((1 - std::cos(angle)) * dot(to, turned)) * to;
  turned = turned - dot(to, turned) * to;
  const Real length = norm(turned);
  return length > 0 ? (size / length) * turned : Vec3{};
}

/// Forces of a plane on the corners of both faces, with the couple that makes their moment vanish
/// and their power equal to force . jump. Positions are those on which the forces act, x(n+1).
template <int Dim>
KOKKOS_INLINE_FUNCTION void cornerForces(const FaceNodes& a, const FaceNodes& b, const Patch& patch,
                                         const Vec3& force, bool couple, Vec3 (&forces)[2][4])
{
  const FaceNodes* faces[2] = {&a, &b};
  const Vec3 arm =
      weighted(patch.weights[1], b.x, b.count) - weighted(patch.weights[0], a.x, a.count);
  const Vec3 moment = cross(arm, force);
  for (int f = 0; f < 2; ++f)
  {
    const FaceSpin<Dim> spin(faces[f]->x, faces[f]->count);
    const Vec3 turn = couple ? -0.5 * spin.solve(moment) : Vec3{};
    for (int i = 0; i < faces[f]->count; ++i)
    {
      const Real sign = f == 0 ? -1.0 : 1.0;
      forces[f][i] = (sign * patch.weights[f][i]) * force + cross(turn, spin.r[i]);
    }
    for (int i = faces[f]->count; i < 4; ++i)
      forces[f][i] = {};
  }
}

/// Work that the nodes do on a plane during a step, by the trapezoid of old and new forces [J].
KOKKOS_INLINE_FUNCTION Real workOfNodes(const Plane& plane, const Vec3 (&newForces)[2][4],
                                        const FaceNodes& a, const FaceNodes& b, Real dt)
{
  const FaceNodes* faces[2] = {&a, &b};
  Real work = 0;
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < faces[f]->count; ++i)
      work -= (0.5 * dt) * dot(plane.cornerForce[f][i] + newForces[f][i], faces[f]->v[i]);
  return work;
}

/// No traction in this cycle; history stays.
template <int Dim>
KOKKOS_INLINE_FUNCTION void openUp(Plane& plane, const FaceNodes& a, const FaceNodes& b, Real dt)
{
  const Vec3 none[2][4] = {};
  plane.work += workOfNodes(plane, none, a, b, dt);
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < 4; ++i)
      plane.cornerForce[f][i] = {};
  plane.force = {};
  plane.area = 0;
  plane.normalTraction = 0;
  plane.stored = 0;
  plane.tooDeep = false;
  if (plane.born)
  {
    plane.closure = 0;
    plane.history.shearTraction = {};
    plane.state = PlaneState::Open;
  }
}

/// Bound on the stiffness that each corner feels, for the stable step: 2 k A |w| by Gershgorin's
/// circles. The overlap counts as soon as the faces could touch within the next two steps, so that
/// the step does not drop suddenly.
KOKKOS_INLINE_FUNCTION void boundCornerStiffness(Plane& plane, const Patch& patch,
                                                 const HalfStepFace& a, const HalfStepFace& b,
                                                 Real approach)
{
  const bool near = plane.area > 0 || patch.leastGap <= approach + 1e-8 * std::sqrt(patch.overlap);
  const Real k = near ? std::fmax(plane.law.loadingStiffness(plane.history.maximumClosure),
                                  plane.law.shearStiffness)
                      : 0;
  const HalfStepFace* faces[2] = {&a, &b};
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < 4; ++i)
    {
      // The overlap's part of a node is at most all of it; 1.5/n covers uniform and mildly uneven
      // patches, and the weights of the area in contact cover the uneven ones.
      const Real whole = patch.overlap * (1.5 / faces[f]->count < 1 ? 1.5 / faces[f]->count : 1.0);
      const Real part = patch.area * std::abs(patch.weights[f][i]);
      plane.cornerStiffness[f][i] = i < faces[f]->count ? 2 * k * std::fmax(whole, part) : 0;
    }
}

/// Step H: plane variables. Cundall's update in tractions: closure, shear increment, joint law,
/// force, energies.
template <int Dim>
KOKKOS_INLINE_FUNCTION void
stepH_updatePlaneVariables(Plane& plane, const Patch& patch, const TrialPlane& trial,
                           const FaceNodes& a, const FaceNodes& b, const RelativeMotion& motion,
                           const ContactOptions& options, Real dt)
{
  const Vec3& n = trial.normal;
  const Real opening = dt * dot(n, motion.jump);
  const Vec3 sliding = dt * (motion.jump - dot(n, motion.jump) * n);

  plane.gap = dot(n, weighted(patch.centroidWeights[1], b.x, b.count) -
                         weighted(patch.centroidWeights[0], a.x, a.count));
  if (options.closure == ContactOptions::Closure::Total)
    plane.closure = plane.offset - plane.gap;
  else
    plane.closure -= opening;
  const Real closure = plane.closure < plane.depthLimit ? plane.closure : plane.depthLimit;
  plane.tooDeep = plane.closure > plane.depthLimit;

  Vec3 tau = turnIntoPlane(plane.history.shearTraction, plane.normal, n, motion.spin, dt);
  if (options.areaRule && plane.area > 0 && patch.area > plane.area)
    tau = (plane.area / patch.area) * tau;
  plane.history.shearTraction = tau;
  const Real hysteresisBefore = plane.law.hysteresisWork(plane.history.maximumClosure);
  const auto response = plane.law(closure, sliding, plane.history);

  plane.normal = n;
  plane.area = patch.area;
  plane.normalTraction = response.normalTraction;
  plane.state = response.normalTraction <= 0 ? PlaneState::Open
                : response.slipping          ? PlaneState::Slip
                                             : PlaneState::Stick;
  Vec3 force =
      (plane.area * response.normalTraction) * n + plane.area * plane.history.shearTraction;

  if (options.dampNormal > 0 || options.dampShear > 0)
  {
    Real inverseMass = 0;
    for (int i = 0; i < a.count; ++i)
      inverseMass += patch.weights[0][i] * patch.weights[0][i] / a.mass[i];
    for (int i = 0; i < b.count; ++i)
      inverseMass += patch.weights[1][i] * patch.weights[1][i] / b.mass[i];
    const Real normalSpeed = dot(n, motion.jump);
    Real normalForce = -2 * options.dampNormal *
                       std::sqrt(plane.area * response.normalStiffness / inverseMass) * normalSpeed;
    const Real elastic = plane.area * response.normalTraction;
    normalForce = normalForce < -elastic ? -elastic : normalForce; // no tension
    Vec3 damping = normalForce * n;
    if (plane.state == PlaneState::Stick)
      damping += (-2 * options.dampShear *
                  std::sqrt(plane.area * plane.law.shearStiffness / inverseMass)) *
                 (motion.jump - normalSpeed * n);
    plane.dampingWork -= dt * dot(damping, motion.jump);
    force += damping;
  }
  plane.force = force;

  Vec3 forces[2][4];
  cornerForces<Dim>(a, b, patch, force, options.couple, forces);
  plane.work += workOfNodes(plane, forces, a, b, dt);
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < 4; ++i)
      plane.cornerForce[f][i] = forces[f][i];

  const Real shear = dot(plane.history.shearTraction, plane.history.shearTraction);
  plane.stored = plane.area * 0.5 * response.normalTraction * response.normalTraction /
                 response.normalStiffness;
  if (plane.law.shearStiffness > 0)
    plane.stored += plane.area * 0.5 * shear / plane.law.shearStiffness;
  plane.frictionWork += plane.area * response.frictionWork;
  plane.hysteresisWork +=
      plane.area * (plane.law.hysteresisWork(plane.history.maximumClosure) - hysteresisBefore);
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
      low[f] = {std::fmin(low[f].x, p.x), std::fmin(low[f].y, p.y)};
      high[f] = {std::fmax(high[f].x, p.x), std::fmax(high[f].y, p.y)};
    }
  }
  return low[0].x >= high[1].x || low[1].x >= high[0].x ||
         (a.count > 2 && (low[0].y >= high[1].y || low[1].y >= high[0].y));
}

/// Depth, as a fraction of the depth limit, beyond which a first overlap is not taken for a
/// contact.
constexpr Real deepestBirth = 0.25;

/// Bound on the speed at which corners of the faces approach each other along the normal [m/s].
KOKKOS_INLINE_FUNCTION Real approachSpeed(const Vec3& normal, const FaceNodes& a,
                                          const FaceNodes& b)
{
  Real towards = 0, away = 0;
  for (int i = 0; i < a.count; ++i)
    towards = std::fmax(towards, dot(normal, a.v[i] - b.v[0]));
  for (int i = 0; i < b.count; ++i)
    away = std::fmax(away, dot(normal, b.v[0] - b.v[i]));
  return towards + away;
}

/// Steps A to H of one candidate pair in one cycle.
template <int Dim>
KOKKOS_INLINE_FUNCTION void updatePlane(Plane& plane, const FaceNodes& a, const FaceNodes& b,
                                        const ContactOptions& options, Real dt)
{
  const HalfStepFace faceA = stepA_halfStepFace<Dim>(a, dt);
  const HalfStepFace faceB = stepA_halfStepFace<Dim>(b, dt);
  const TrialPlane trial = stepB_trialPointOfContact<Dim>(faceA, faceB);
  Patch patch;
  if (trial.opposed)
  {
    const Shadow shadowA = stepC_projectOntoPlane<Dim>(trial, faceA);
    const Shadow shadowB = stepC_projectOntoPlane<Dim>(trial, faceB);
    if (!shadowsApart(shadowA, shadowB))
      patch = stepD_areaOfContact<Dim>(shadowA, shadowB, plane.offset, options);
  }
  plane.overlap = patch.overlap;
  const Real smallest = options.areaMin * (faceA.area < faceB.area ? faceA.area : faceB.area);
  plane.foundLate = plane.fresh && !plane.declared && !plane.born && patch.area > smallest;
  // Slivers carry nothing: their force is below areaMin k c, and their centroid has no digits.
  bool inContact = patch.area > smallest;
  if (inContact && !stepE_planeExists(plane) && !plane.fresh && !plane.declared && !plane.inherited)
  {
    // A new contact begins at the surface. Faces that share area for the first time while one lies
    // deep behind the other did not meet: they are ends of bricks one above the other, say, whose
    // horizontal joint closed by a hair.
    const Real depth =
        -dot(trial.normal, weighted(patch.centroidWeights[1], faceB.x, faceB.count) -
                               weighted(patch.centroidWeights[0], faceA.x, faceA.count));
    const Real approach = 2 * dt * approachSpeed(trial.normal, a, b);
    plane.released = plane.released || depth > std::fmax(approach, deepestBirth * plane.depthLimit);
  }
  if (!(patch.area > 0))
    plane.released = false;
  inContact = inContact && !plane.released;
  if (!inContact)
  {
    patch.area = 0;
    openUp<Dim>(plane, a, b, dt);
    if (patch.overlap > 0)
      plane.gap = patch.leastGap + plane.offset;
  }
  else
  {
    plane.pointOfContact = stepG_placePointOfContact(patch, faceA, faceB);
    if (!stepE_planeExists(plane))
    {
      const Real gap = dot(trial.normal, weighted(patch.centroidWeights[1], b.x, b.count) -
                                             weighted(patch.centroidWeights[0], a.x, a.count));
      stepF_createPlane(plane, trial.normal, gap);
    }
    const RelativeMotion motion = relativeMotion<Dim>(faceA, faceB, a, b, patch);
    stepH_updatePlaneVariables<Dim>(plane, patch, trial, a, b, motion, options, dt);
  }
  plane.fresh = false;
  const Real speed = trial.opposed ? approachSpeed(trial.normal, a, b) : 0;
  boundCornerStiffness(plane, patch, faceA, faceB, 2 * dt * speed);
}
} // namespace coplane
