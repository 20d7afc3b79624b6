#pragma once

#include <coplane_contact/ContactPotential.hpp>
#include <coplane_contact/PlaneBatch.hpp>

// Whether faces can meet, how a pair begins, and what it is when it carries nothing, for both ways
// of computing forces.

namespace coplane
{
/// No traction in this cycle; history stays. The work of the last force has been booked.
KOKKOS_INLINE_FUNCTION void carryNothing(Plane& plane)
{
  plane.dropForces();
  plane.lags = false;
  plane.normalDamping = 0;
  plane.area = 0;
  plane.stored = 0;
  plane.normalTraction = 0;
  plane.tooDeep = false;
  if (plane.isBorn())
  {
    plane.closure = 0;
    plane.history.shearTraction = {};
    plane.state = PlaneState::Open;
  }
}

/// Takes the couple off forces at the nodes of both faces, by forces that turn them about their
/// middle as a rigid body is turned.
template <int Dim>
KOKKOS_INLINE_FUNCTION void takeCoupleOff(Vec3 (&force)[2][4], const HalfStepFace& a,
                                          const HalfStepFace& b)
{
  Vec3 x[8], forces[8];
  int count = 0;
  for (int f = 0; f < 2; ++f)
  {
    const HalfStepFace& face = f == 0 ? a : b;
    for (int k = 0; k < face.count; ++k, ++count)
    {
      x[count] = face.x[k];
      forces[count] = force[f][k];
    }
  }
  const FaceInertia<Dim, Real, 8> inertia(x, count);
  const Vec3 spin = inertia.solve(inertia.momentOf(forces));
  int i = 0;
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < (f == 0 ? a.count : b.count); ++k, ++i)
      force[f][k] = force[f][k] - cross(spin, inertia.r[i]);
}

/// A plane that does not carry. Where it has, and what made up for its last steps has not done what
/// it should (detail/PathOfStep.hpp), it pushes on in the same way for what is left, cycle after
/// cycle, until little is. Its old force is booked.
template <int Dim>
KOKKOS_INLINE_FUNCTION void payRest(Plane& plane, const HalfStepFace& a, const HalfStepFace& b,
                                    Real dt)
{
  constexpr Real little = 0.02, hopeless = 20; // of what the push does [-]
  Vec3 push[2][4];
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 4; ++k)
      push[f][k] = plane.nodal[f][k];
  const Real done = plane.lags && plane.planned != 0 ? halfStepWork(push, a, b, dt) : 0;
  const Real due = plane.debt + plane.planned - done;
  if (plane.pushes())
  {
    plane.planned = 0;
    plane.debt = 0;
  }
  carryNothing(plane);
  const Real wanted = done != 0 ? due / (2 * done) : 0;
  if (!(std::fabs(wanted) > little && std::fabs(wanted) < hopeless))
    return;
  const Real part = wanted > 1 ? 1 : wanted < -1 ? -1 : wanted;
  for (auto& ofFace : push)
    for (Vec3& force : ofFace)
      force = part * force;
  takeCoupleOff<Dim>(push, a, b);
  plane.planned = halfStepWork(push, a, b, dt);
  plane.debt = float(due - 2 * plane.planned);
  plane.work -= plane.planned;
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 4; ++k)
      plane.nodal[f][k] = push[f][k];
  plane.lags = true;
}

/// Depth, as a fraction of the depth limit, beyond which a first overlap is not taken for a
/// contact.
constexpr Real deepestBirth = 0.25;
/// Shares of area below this fraction of the smaller face are round-off of edges on each other.
constexpr Real sliverOfFace = 1e-6;

/// Bound on the speed at which corners of the faces approach each other along the normal [m/s], the
/// same to the bit with the faces in the other order.
template <class T>
KOKKOS_INLINE_FUNCTION T approachSpeed(const Vec3Of<T>& normal, const HalfStepFaceOf<T>& a,
                                       const HalfStepFaceOf<T>& b)
{
  T fastest = dot(normal, a.v[0]), slowest = dot(normal, b.v[0]);
  for (int i = 1; i < a.count; ++i)
    fastest = branchFree::larger(dot(normal, a.v[i]), fastest);
  for (int i = 1; i < b.count; ++i)
    slowest = branchFree::smaller(dot(normal, b.v[i]), slowest);
  return branchFree::larger(fastest - slowest, T(0.0));
}

/// Faces carry force when minus the product of their normals is above this [-].
KOKKOS_INLINE_FUNCTION Real leastOpposed(const ContactOptions& options)
{
  return options.forces == ContactOptions::Forces::Potential
             ? ContactPotentialScale(options).opposedFrom
             : 0;
}

/// Area below which what a pair shares counts as none, over that of the smaller face [-].
KOKKOS_INLINE_FUNCTION Real leastShared(const ContactOptions& options)
{
  return options.forces == ContactOptions::Forces::Potential ? options.areaMin : 0;
}

/// Steps B and C, for the question whether the shadows of a pair can share area that counts.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T>
mayMeet(const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b, const ContactOptions& options)
{
  TrialPlaneOf<T> trial = stepB_trialPointOfContact<Dim>(a, b);
  trial.opposed = trial.opposed && -dot(a.normal, b.normal) > leastOpposed(options);
  if (!branchFree::anyOf(trial.opposed))
    return trial.opposed;
  const ShadowOf<T> shadowA = stepC_projectOntoPlane<Dim>(trial, a, 0),
                    shadowB = stepC_projectOntoPlane<Dim>(trial, b, 0);
  const auto near = trial.opposed && sharedByBoxes(shadowA, shadowB) >
                                         leastShared(options) * branchFree::smaller(a.area, b.area);
  if (Dim == 2 || !branchFree::anyOf(near))
    return near;
  return near && !edgesPart(shadowA, shadowB);
}

/// By how much the mean plane of a face may lie beyond its nodes [m].
KOKKOS_INLINE_FUNCTION Real beyondNodes(const HalfStepFace& face)
{
  const Vec3* const x = face.x;
  return face.count < 4 ? 0 : 0.25 * std::fabs(dot(face.normal, x[0] - x[1] + x[2] - x[3]));
}

/// Whether faces that oppose each other are apart along the normal of their plane, or along that of
/// one of them, and stay so for the time `ahead` [s].
/// @param reach gap from which they would act on each other [m]
KOKKOS_INLINE_FUNCTION bool areApart(const HalfStepFace& a, const HalfStepFace& b, Real reach,
                                     Real ahead)
{
  constexpr Real roundOff = 1e-7; // of the size of a face
  const Vec3 normal = normalised(a.normal - b.normal);
  // Mean planes lie beyond nodes by so much along the normal of the pair.
  const Real beyond = (beyondNodes(a) + beyondNodes(b)) / dot(normal, a.normal);
  // Which pairs may touch soon is asked along it, too (PotentialCycle::boundStep).
  const Real speed = approachSpeed(normal, a, b);
  const auto areApartAlong = [&](const Vec3& n)
  {
    Real lowest = infinity, highest = -infinity;
    for (int i = 0; i < a.count; ++i)
      highest = branchFree::larger(dot(n, a.x[i] - a.center), highest);
    for (int i = 0; i < b.count; ++i)
      lowest = branchFree::smaller(dot(n, b.x[i] - a.center), lowest);
    return lowest - highest > ahead * branchFree::larger(approachSpeed(n, a, b), speed) + reach +
                                  dot(n, normal) * beyond + roundOff * norm(a.x[1] - a.x[0]);
  };
  return areApartAlong(normal) || areApartAlong(a.normal) || areApartAlong(-1.0 * b.normal);
}

/// Before steps E and F of a pair: whether it penetrates when it is looked at for the first time.
KOKKOS_INLINE_FUNCTION bool wasFoundLate(const Plane& plane, bool inContact)
{
  return plane.isNew() && !plane.declared && !plane.isBorn() && inContact;
}

/// Round-off of a gap, as a fraction of the size of a face or an overlap [-]: faces that lie on
/// each other to the last digit count as near, and not as closed.
constexpr Real roundOffOfGap = 1e-8;

/// Length of an area: in two dimensions it is one, times a metre [m].
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T lengthOfArea(const T& area)
{
  if constexpr (Dim == 2)
    return area;
  else
    return branchFree::squareRoot(area);
}

/// Gershgorin's circles bound the stiffness at a node by the sum along its row, which is at most
/// twice its own part, as the weights of either face sum to 1; a millionth more than round-off.
constexpr Real rowSum = 2.000002;
/// A node's part of a patch that is uniform or mildly uneven, times the number of nodes [-]: it is
/// 1 for one that is uniform.
constexpr Real unevenShare = 1.5;

/// The most that a node of faces with so many corners has of an overlap [-].
KOKKOS_FORCEINLINE_FUNCTION Real shareOfOverlap(int countA, int countB)
{
  const int fewer = countA < countB ? countA : countB;
  return unevenShare / fewer < 1 ? unevenShare / fewer : 1.0;
}

/// Where the face in lane i is, without its motion.
template <class T>
KOKKOS_INLINE_FUNCTION HalfStepFace placeOf(const HalfStepFaceOf<T>& from, int i)
{
  HalfStepFace face;
  face.count = from.count;
  for (int k = 0; k < from.count; ++k)
    face.x[k] = branchFree::lane(from.x[k], i);
  face.center = branchFree::lane(from.center, i);
  face.normal = branchFree::lane(from.normal, i);
  face.area = branchFree::lane(from.area, i);
  return face;
}

/// The same with the velocities of its nodes.
template <class T>
KOKKOS_INLINE_FUNCTION HalfStepFace movingFace(const HalfStepFaceOf<T>& from, int i)
{
  HalfStepFace face = placeOf(from, i);
  for (int k = 0; k < face.count; ++k)
    face.v[k] = branchFree::lane(from.v[k], i);
  return face;
}

/// The face in lane i as it was a step ago, with the velocities of the step; face: at its end.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION HalfStepFace placeBefore(const HalfStepFaceOf<T>& face, int i, Real dt)
{
  FaceNodes nodes;
  nodes.count = face.count;
  for (int k = 0; k < face.count; ++k)
  {
    nodes.v[k] = branchFree::lane(face.v[k], i);
    nodes.x[k] = branchFree::lane(face.x[k], i) - dt * nodes.v[k];
  }
  return stepA_faceAtEnd<Dim>(nodes);
}

/// PairPotential::wayOut falls from 1, where the least way out leads along the normal, to 0, where
/// it leads along the plane: below the middle it is the one along the plane [-].
constexpr Real alongThePlane = 0.5;

/// A pair whose shadows share nothing in this cycle.
template <int Dim>
KOKKOS_INLINE_FUNCTION void passBy(Plane& plane, const HalfStepFace& a, const HalfStepFace& b,
                                   Real dt)
{
  bookOldForce(plane, a, b, dt);
  payRest<Dim>(plane, a, b, dt);
  plane.overlap = 0;
  plane.unseen = false;
  plane.nodeStiffness = 0;
  plane.sighting = Sighting::Known;
  plane.refusal = Refusal::None;
}

/// Pairs sleep when passing by changes nothing more of them.
KOKKOS_INLINE_FUNCTION Activity activityOf(const Plane& plane)
{
  if (plane.pushes() || plane.nodeStiffness > 0)
    return Activity::Loaded;
  if (plane.sighting != Sighting::Known || plane.isRefused())
    return Activity::Awake;
  return plane.overlap > 0 || plane.unseen ? Activity::Apart : Activity::Asleep;
}
} // namespace coplane
