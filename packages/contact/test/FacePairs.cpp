#include "FacePairs.hpp"

#include "MovingPairs.hpp"

#include <algorithm>

namespace coplane
{
namespace facepairs
{
template <int Dim>
void updatePlane(PairPlane& plane, const FaceNodes& a, const FaceNodes& b, const ContactOptions& o,
                 Real dt)
{
  const auto stepA = [&](const FaceNodes& face)
  {
    return o.forces == ContactOptions::Forces::Potential ? stepA_faceAtEnd<Dim>(face)
                                                         : stepA_halfStepFace<Dim>(face, dt);
  };
  updateByForces<Dim>(plane, stepA(a), stepA(b), plane.law, o, dt);
  std::copy(&plane.nodal[0][0], &plane.nodal[0][0] + 8, &plane.cornerForce[0][0]);
}
template void updatePlane<2>(PairPlane&, const FaceNodes&, const FaceNodes&, const ContactOptions&,
                             Real);
template void updatePlane<3>(PairPlane&, const FaceNodes&, const FaceNodes&, const ContactOptions&,
                             Real);

template <int Dim>
PairContact contactOf(const FaceNodes& a, const FaceNodes& b, const ContactOptions& o, Real dt)
{
  PairContact c;
  c.a = stepA_halfStepFace<Dim>(a, dt);
  c.b = stepA_halfStepFace<Dim>(b, dt);
  c.trial = stepB_trialPointOfContact<Dim>(c.a, c.b);
  if (!c.trial.opposed)
    return c;
  c.shadowA = stepC_projectOntoPlane<Dim>(c.trial, c.a, 0);
  c.shadowB = stepC_projectOntoPlane<Dim>(c.trial, c.b, 0);
  const AreaInUse use =
      o.area == ContactOptions::Area::Full ? AreaInUse::Full : AreaInUse::Penetrating;
  c.patch = stepD_areaOfContact<Dim>(c.shadowA, c.shadowB, 0, use, o.weights);
  return c;
}
template PairContact contactOf<2>(const FaceNodes&, const FaceNodes&, const ContactOptions&, Real);
template PairContact contactOf<3>(const FaceNodes&, const FaceNodes&, const ContactOptions&, Real);
} // namespace facepairs

namespace movingpairs
{
namespace
{
template <int Dim>
Plane lookedIn(const HalfStepFace& a, const HalfStepFace& b, PlaneState state)
{
  PairPlane plane = touchingPlane();
  plane.state = state;
  plane.depthLimit = 1;
  ContactOptions options;
  options.lookAhead = lookAhead;
  if (mayMeet<Dim>(a, b, options))
    updateByForces<Dim>(plane, a, b, plane.law, options, dt);
  else
    passBy<Dim>(plane, a, b, dt);
  return plane;
}
} // namespace

Plane looked(const HalfStepFace& a, const HalfStepFace& b, int dimension, PlaneState state)
{
  return dimension == 2 ? lookedIn<2>(a, b, state) : lookedIn<3>(a, b, state);
}
} // namespace movingpairs
} // namespace coplane
