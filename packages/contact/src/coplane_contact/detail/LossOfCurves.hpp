#pragma once

#include <coplane_joint/JointLaw.hpp>

// What the history of a closure curve loses, of a pair whose forces come from one potential.

namespace coplane::detail
{
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

/// What the closure curve's history loses when its maximum closure rises from `before` to now, with
/// the area in contact as it is [J]. The moments are those of closures beyond the permanent closure
/// of now.
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
