#include <coplane_contact/Contact.hpp>
#include <coplane_contact/DeclaredJoints.hpp>
#include <coplane_contact/PotentialKernel.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
Vec3 traction(const SymTensor& s, const Vec3& n)
{
  return {s.xx * n.x + s.xy * n.y + s.zx * n.z, s.xy * n.x + s.yy * n.y + s.yz * n.z,
          s.zx * n.x + s.yz * n.y + s.zz * n.z};
}

/// The whole overlap of two faces as the potential sees it; returns the mean gap [m].
template <int Dim>
Real wholeOverlap(const HalfStepFace& a, const HalfStepFace& b, const ContactOptions& options,
                  Patch& patch)
{
  PairPotential<Dim, Real> pair(a, b, ContactPotentialScale(options.cosOpposed));
  if (!pair.plane.opposed)
    return 0;
  pair.meet(0, true, {});
  patch.overlap = pair.overlap;
  patch.area = pair.opposedness * pair.moments.area;
  if (!(patch.area > 0))
    return 0;
  patch.centroid = (1 / pair.moments.area) * pair.moments.areaMoment;
  pair.weightsAt(patch.centroid, patch.centroidWeights);
  return -pair.moments.volume / pair.moments.area;
}
} // namespace

void Contact::closeDeclaredJoints(const ConstNodeVectors& x, const StressOfBlock& stressOfBlock)
{
  const auto patchOf = [&](const TrialPlane& trial, const HalfStepFace& a, const HalfStepFace& b)
  {
    constexpr auto weights = ContactOptions::Weights::Centroid;
    return dimension_ == 2
               ? stepD_areaOfContact<2>(stepC_projectOntoPlane<2>(trial, a, 0),
                                        stepC_projectOntoPlane<2>(trial, b, 0), 0,
                                        AreaInUse::Bonded, weights, depthOf(trial, options_))
               : stepD_areaOfContact<3>(stepC_projectOntoPlane<3>(trial, a, 0),
                                        stepC_projectOntoPlane<3>(trial, b, 0), 0,
                                        AreaInUse::Bonded, weights);
  };
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
  {
    Plane& plane = planes_(p);
    if (plane.face[0] < 0)
      continue;
    const Face& faceA = faces_[plane.face[0]];
    const Face& faceB = faces_[plane.face[1]];
    if (!rules_.between(faceA.group, faceB.group).declared)
      continue;
    const FaceNodes nodesA = nodesOf(faceA, x), nodesB = nodesOf(faceB, x);
    const HalfStepFace a =
        dimension_ == 2 ? stepA_halfStepFace<2>(nodesA, 0) : stepA_halfStepFace<3>(nodesA, 0);
    const HalfStepFace b =
        dimension_ == 2 ? stepA_halfStepFace<2>(nodesB, 0) : stepA_halfStepFace<3>(nodesB, 0);
    const TrialPlane trial =
        dimension_ == 2 ? stepB_trialPointOfContact<2>(a, b) : stepB_trialPointOfContact<3>(a, b);
    if (!trial.opposed)
      continue;
    Patch patch;
    Real meanGap = 0;
    if (options_.forces == ContactOptions::Forces::Potential)
      meanGap = dimension_ == 2 ? wholeOverlap<2>(a, b, options_, patch)
                                : wholeOverlap<3>(a, b, options_, patch);
    else
      patch = patchOf(trial, a, b);
    if (!(patch.area > options_.areaMin * std::min(a.area, b.area) *
                           depthOf(trial, options_).at(patch.centroid.x)))
      continue;
    const Real gap = options_.forces == ContactOptions::Forces::Potential
                         ? meanGap
                         : dot(trial.normal, weighted(patch.centroidWeights[1], b.x, b.count) -
                                                 weighted(patch.centroidWeights[0], a.x, a.count));
    if (!lieOnEachOther(dot(a.normal, b.normal), gap,
                        faceSize(std::min(a.area, b.area), dimension_)))
      continue;
    plane.declared = true;
    plane.state = PlaneState::Open;
    plane.normal = trial.normal;
    plane.overlap = patch.overlap;
    plane.pointOfContact = stepG_placePointOfContact(patch, a, b);
    plane.gap = gap;
    // The joint is in equilibrium with the initial stress: closure and shear traction that carry
    // it. The traction on face 1 is minus that of the solid of face 0 across the plane.
    SymTensor stress = stressOfBlock(faceA.block, plane.pointOfContact);
    const SymTensor other = stressOfBlock(faceB.block, plane.pointOfContact);
    stress = {0.5 * (stress.xx + other.xx), 0.5 * (stress.yy + other.yy),
              0.5 * (stress.zz + other.zz), 0.5 * (stress.xy + other.xy),
              0.5 * (stress.yz + other.yz), 0.5 * (stress.zx + other.zx)};
    const Vec3 t = traction(stress, trial.normal);
    const Real compression = -dot(t, trial.normal);
    const JointLaw& law = lawOf(plane);
    plane.history.bonded = law.cohesive();
    const Real closure = compression > 0        ? law.closureUnder(plane.fit, compression)
                         : plane.history.bonded ? compression / plane.fit.normalStiffness
                                                : 0;
    plane.history.maximumClosure = plane.maximumBefore = std::max(closure, 0.0);
    plane.offset = plane.gap + closure;
    plane.closure = closure;
    if (compression > 0 || plane.history.bonded)
    {
      plane.history.shearTraction = Vec3{} - (t + compression * trial.normal);
      plane.area = patch.area;
    }
    // The energy that the initial stress has put into the joint.
    plane.hysteresisWork = plane.area * law.hysteresis(plane.fit, plane.history.maximumClosure);
    plane.stored = plane.area * law.stored(plane.fit, plane.limitedClosure(), plane.history);
    plane.work = plane.stored + plane.hysteresisWork;
  }
}
} // namespace coplane
