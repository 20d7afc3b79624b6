#pragma once

#include <coplane_contact/ContactPotential.hpp>
#include <coplane_contact/FacePairKernel.hpp>

// What the history of a joint takes from the energy of a pair of faces.

namespace coplane::detail
{
/// A bond carries by the mean closure, what is left of it where it is closed: half of a tilted
/// pair. The offset by which the joint settles when the bond breaks, so that this makes no energy
/// [m].
/// @param energy that is left at the mean closure [J]
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Real settlement(const Plane& plane, const JointLaw& law,
                                       const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b,
                                       int i, Real cosOpposed, Real energy)
{
  const HalfStepFace faces[2] = {placeOf(a, i), placeOf(b, i)};
  const ClosureCurve::Point top = law.curve.at(plane.fit, plane.history.maximumClosure);
  const Real permanent =
      law.curve.straight() ? 0 : plane.history.maximumClosure - top.traction / top.stiffness;
  const Real stiffness = law.curve.straight() ? plane.fit.normalStiffness : top.stiffness;
  Real low = 0, high = 0;
  for (int step = 0; step < 60; ++step)
  {
    const Real middle = 0.5 * (low + high);
    PairPotential<Dim, Real> pair(faces[0], faces[1], ContactPotentialScale(cosOpposed));
    if (!pair.plane.opposed)
      return 0;
    pair.meet(plane.offset - permanent - middle, false, {});
    if (step == 0)
      high = pair.mostClosure > 0 ? pair.mostClosure : 0;
    else
      (0.5 * stiffness * pair.moments.squares > energy ? low : high) = middle;
  }
  return low > 1e-12 * high ? high : 0;
}

/// What the closure curve's history loses when its maximum closure rises from `before` to now, with
/// the area in contact as it is [J]: the energy before less that after. The moments are those of
/// closures beyond the permanent closure of now.
KOKKOS_INLINE_FUNCTION Real lostByLoading(const JointLaw& law, const JointFit& fit, Real before,
                                          Real now, Real area, Real volume, Real squares)
{
  const ClosureCurve::Point old = law.curve.at(fit, before), point = law.curve.at(fit, now);
  const Real shift =
      (now - point.traction / point.stiffness) - (before - old.traction / old.stiffness);
  return 0.5 * (old.stiffness * (squares + 2 * shift * volume + shift * shift * area) -
                point.stiffness * squares);
}
} // namespace coplane::detail
