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

/// What the stiffness k and the integral S of squares, both of the tangent at the largest closure,
/// lose together while the pair stands still: k S / 2 before less after. The range of the
/// opposition knows the closure and not the stiffness, so that the energy falls with S by less.
/// @param rising PairPotential::rising() [-]
KOKKOS_INLINE_FUNCTION Real lostOfTangent(Real oldStiffness, Real oldSquares, Real stiffness,
                                          Real squares, Real rising)
{
  return 0.25 * ((oldStiffness - stiffness) * (oldSquares + squares) +
                 rising * (oldStiffness + stiffness) * (oldSquares - squares));
}

/// What crushing that takes stiffness loses when its maximum closure rises from `before` to now,
/// with the area in contact as it is [J]. The moments are those of closures beyond the permanent
/// closure of now.
KOKKOS_INLINE_FUNCTION Real lostByLoading(const JointLaw& law, const JointFit& fit, Real before,
                                          Real now, Real area, Real volume, Real squares,
                                          Real rising)
{
  const ClosureCurve::Point old = law.curve.at(fit, before), point = law.curve.at(fit, now);
  const Real shift =
      (now - point.traction / point.stiffness) - (before - old.traction / old.stiffness);
  return lostOfTangent(old.stiffness, squares + 2 * shift * volume + shift * shift * area,
                       point.stiffness, squares, rising);
}
} // namespace coplane::detail
