#pragma once

#include <coplane_contact/ClassicCommonPlane.hpp>
#include <coplane_contact/FacePairKernel.hpp>

// The update of a plane by Cundall's common plane: the two elements behind the faces give normal,
// area and gap; steps F, G and H are those of the Simple Common Plane.

namespace coplane
{
/// Nodes of the element behind a face: x(n+1), v(n+1/2).
struct ElementNodes
{
  int count = 0;
  Vec3 x[ConvexBlock::maxNodes]; ///< [m]
  Vec3 v[ConvexBlock::maxNodes]; ///< [m/s]

  /// The block some time before the end of the step [s].
  template <int Dim>
  KOKKOS_INLINE_FUNCTION ConvexBlock blockBefore(Real time) const
  {
    Vec3 then[ConvexBlock::maxNodes];
    for (int i = 0; i < count; ++i)
      then[i] = x[i] - time * v[i];
    return blockOfElement<Dim>(then, count);
  }
};

inline ClassicOptions classicOptions(const ContactOptions& options)
{
  ClassicOptions classic;
  classic.search = options.planeSearch == ContactOptions::PlaneSearch::Rotations
                       ? ClassicOptions::Search::Rotations
                       : ClassicOptions::Search::Candidates;
  classic.area = options.area == ContactOptions::Area::Full ? ClassicOptions::Area::Shadow
                                                            : ClassicOptions::Area::Section;
  return classic;
}

KOKKOS_INLINE_FUNCTION TrialPlane trialPlaneOf(const ClassicPlane& classic)
{
  TrialPlane trial;
  trial.opposed = true;
  trial.normal = classic.normal;
  trial.point = classic.point;
  trial.e1 = classic.e1;
  trial.e2 = classic.e2;
  return trial;
}

/// Bound on the speed at which nodes of the elements approach each other along a normal [m/s].
KOKKOS_INLINE_FUNCTION Real approachSpeed(const Vec3& normal, const ElementNodes& a,
                                          const ElementNodes& b)
{
  Real speed = 0;
  for (int i = 0; i < a.count; ++i)
    for (int j = 0; j < b.count; ++j)
    {
      const Real pair = dot(normal, a.v[i] - b.v[j]);
      speed = pair > speed ? pair : speed;
    }
  return speed;
}

/// What updatePlane does, for the pair of faces that leads its two elements; the others carry
/// nothing.
template <int Dim>
KOKKOS_INLINE_FUNCTION void updateClassicPlane(Plane& plane, const HalfStepFace& a,
                                               const HalfStepFace& b, const ElementNodes& elementA,
                                               const ElementNodes& elementB, const JointLaw& law,
                                               const ContactOptions& options, Real dt)
{
  plane.overlap = 0;
  plane.nodeStiffness = 0;
  if (!plane.leads)
  {
    openUp(plane, a, b, dt);
    plane.sighting = Sighting::Known;
    return;
  }
  const ClassicPlane classic = classicCommonPlane<Dim>(
      elementA.blockBefore<Dim>(0.5 * dt), elementB.blockBefore<Dim>(0.5 * dt),
      classicOptions(options), plane.isBorn() ? plane.normal : Vec3{});
  const TrialPlane trial = trialPlaneOf(classic);
  const Shadow shadowA = stepC_projectOntoPlane<Dim>(trial, a, dt);
  const Shadow shadowB = stepC_projectOntoPlane<Dim>(trial, b, dt);

  // A plane that has turned since the search, so that one of the faces does not look across it, is
  // none of theirs any more: where elements share a narrow strip, the least way out is sideways.
  const bool ofTheseFaces = dot(classic.normal, a.normal) > options.cosOpposed &&
                            dot(classic.normal, b.normal) < -options.cosOpposed;

  // What the faces share bounds the stiffness before the elements overlap. Faces of a declared
  // joint lie on each other, also where a gap or an overlap of the mesh has been absorbed: there it
  // is the area.
  Patch patch;
  if (ofTheseFaces && !shadowsApart(shadowA, shadowB))
    patch = stepD_areaOfContact<Dim>(shadowA, shadowB, plane.offset,
                                     plane.history.bonded ? AreaInUse::Bonded : AreaInUse::Full,
                                     ContactOptions::Weights::Centroid);
  if (!plane.declared)
  {
    patch.area = ofTheseFaces && classic.gap < plane.offset ? classic.area : 0;
    patch.overlap = patch.area > patch.overlap ? patch.area : patch.overlap;
    classicWeights<Dim>(classic, a.x, a.count, patch.weights[0]);
    classicWeights<Dim>(classic, b.x, b.count, patch.weights[1]);
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < 4; ++i)
        patch.centroidWeights[f][i] = patch.weights[f][i];
  }
  patch.leastGap = classic.gap - plane.offset;
  plane.overlap = patch.overlap;

  const bool inContact = patch.area > options.areaMin * (a.area < b.area ? a.area : b.area);
  const bool late = wasFoundLate(plane, inContact);
  if (inContact)
  {
    const Real gap = classic::separationAlong(classic.normal, elementA.blockBefore<Dim>(0),
                                              elementB.blockBefore<Dim>(0))
                         .gap();
    if (!stepE_planeExists(plane))
      stepF_createPlane(plane, classic.normal, gap);
    bookOldForce(plane, a, b, dt);
    plane.pointOfContact = stepG_placePointOfContact(patch, a, b);
    PlaneBatch<Real> one;
    one.plane[0] = &plane;
    one.law[0] = &law;
    stepH_updatePlaneVariables<Dim, Real>(one, true, patch, gap, trial, a, b, shadowA, shadowB,
                                          options, dt);
  }
  else
  {
    openUp(plane, a, b, dt);
    plane.gap = classic.gap;
  }
  plane.sighting = late ? Sighting::FoundLate : Sighting::Known;
  const Real ahead = options.lookAhead * approachSpeed(classic.normal, elementA, elementB);
  const bool near = plane.area > 0 || patch.leastGap <= ahead + 1e-8 * std::sqrt(patch.overlap);
  plane.nodeStiffness =
      near ? float(plane.weightInStep() * law.stiffnessBound(plane.fit, plane.history) *
                   areaOfNode(patch, a.count, b.count))
           : 0;
}
} // namespace coplane
