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

/// A pair in contact, as the history of its joint sees it.
struct ClosedPair
{
  Real area, volume, squares; ///< integrals of closures beyond the permanent one [m^2, m^3, m^4]
  Real rising;                ///< PairPotential::rising() [-]
  Real share;                 ///< energy of the pair over what its closures store [-]
  Real permanent;             ///< closure without traction [m]
  Real stiffness;             ///< of the tangent [Pa/m]
};

/// The highest closure of a stiffening curve so far, and what it costs to raise it: that of an even
/// closure, times the area, the mean of those before and after the step, that gives the work which
/// the tangent does not store while it turns. With k' the change of the slope, e = t / k, and the
/// integrals V of c - p and S of its square, that is k' (eV - S/2) for k' e^2 / 2 per area
/// (docs/theory/contact-potential.md, "Laws").
/// @param pair about the tangent at `reached`; @param reached 0: no higher than before [m]
KOKKOS_FORCEINLINE_FUNCTION void loadCurve(Plane& plane, const JointLaw& law,
                                           const ClosedPair& pair, Real reached, JointState& state)
{
  const Real before = plane.history.maximumClosure;
  const Real now = reached > before ? reached : before;
  state.maximumClosure = now;
  const Real elastic = now - pair.permanent;
  if (!(elastic > 0))
    return;
  const Real volume = pair.volume / elastic, squares = pair.squares / (elastic * elastic);
  const Real area = pair.share * (2 * pair.rising * volume - squares);
  Real& areaBefore = plane.loadedArea();
  if (now > before)
  {
    const Real first = plane.area > 0 && areaBefore != 0 ? areaBefore : area;
    plane.hysteresisWork += 0.5 * (first + area) *
                            std::fmax(0.0, law.curve.hysteresis(plane.fit, now) -
                                               law.curve.hysteresis(plane.fit, before));
  }
  areaBefore = area;
}

/// The maximum closure of the next cycle of a joint whose crushing takes stiffness; what it costs
/// is booked there, half with the area of this cycle and half with that of the next.
/// @param closesOn by how much the faces close in a step as now [m]
KOKKOS_FORCEINLINE_FUNCTION void crushWithLoss(Plane& plane, const JointLaw& law,
                                               const ClosedPair& pair,
                                               const JointResponse& response, Real closesOn,
                                               JointState& state)
{
  const Real before = plane.history.maximumClosure;
  plane.hysteresisWork += plane.hysteresisDue();
  plane.hysteresisDue() = 0;
  if (plane.maximumBefore() < before)
    plane.hysteresisWork += 0.5 * pair.share *
                            lostByLoading(law, plane.fit, plane.maximumBefore(), before, pair.area,
                                          pair.volume, pair.squares, pair.rising);
  plane.maximumBefore() = before;
  if (response.crushedByShear)
  {
    // Part of what shear has crushed is in the offset. Half of the work is that of the closures of
    // this cycle, half of those of the next, when the faces have closed on at the same rate.
    const Real closed = response.crushed;
    for (const Real ahead : {0.0, closesOn})
    {
      const Real thenVolume = pair.volume + ahead * pair.area,
                 thenSquares = pair.squares + ahead * (pair.volume + thenVolume);
      plane.hysteresisDue() +=
          0.5 * pair.share *
          lostOfTangent(pair.stiffness, thenSquares, response.normalStiffness,
                        thenSquares - closed * (2 * thenVolume - closed * pair.area), pair.rising);
    }
    plane.maximumBefore() = state.maximumClosure;
    return;
  }
  state.maximumClosure = before;
  const Real reached = pair.permanent + pair.squares / pair.volume;
  if (!(reached > before))
    return;
  const ClosureCurve::Point next = law.curve.at(plane.fit, reached);
  const Real shift = reached - next.traction / next.stiffness - pair.permanent;
  state.maximumClosure = reached;
  plane.hysteresisDue() =
      0.5 * pair.share *
      lostOfTangent(pair.stiffness, pair.squares, next.stiffness,
                    pair.squares - 2 * shift * pair.volume + shift * shift * pair.area,
                    pair.rising);
}
} // namespace coplane::detail
