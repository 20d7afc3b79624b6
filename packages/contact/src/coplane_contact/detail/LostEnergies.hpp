#pragma once

#include <coplane_contact/ContactPotential.hpp>
#include <coplane_contact/PairLife.hpp>

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
                                       int i, const ContactOptions& options, Real energy)
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
    PairPotential<Dim, Real> pair(faces[0], faces[1], ContactPotentialScale(options));
    if (!pair.plane.opposed)
      return 0;
    if (plane.history.absorbedUnevenly)
      pair.lay(true, plane.laid);
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

/// A pair in contact, as the history of its joint sees it.
struct ClosedPair
{
  Real area, volume, squares; ///< integrals of closures beyond the permanent one [m^2, m^3, m^4]
  Real rising;                ///< PairPotential::rising() [-]
  Real share;                 ///< energy of the pair over what its closures store [-]
  Real permanent;             ///< closure without traction [m]
  Real stiffness;             ///< of the tangent [Pa/m]
};

/// The highest closure of a curve so far, and what it costs to raise it: that of an even closure,
/// times the area, the mean of those before and after the step, that gives the work which the line
/// of unloading does not store while it turns. With k' the change of its slope, e = t / k, and the
/// integrals V of c - p and S of its square, k' (eV - S/2) is k' e^2 / 2 per area. Where the curve
/// is not as steep as that line, as where crushing takes stiffness, e V for each of what lacks of
/// the slope is lost besides. A cycle lays the line at e = S / V, where both areas are V^2 / S but
/// for the range of the opposition (docs/theory/contact-potential.md, "Laws").
/// @param pair about the line of unloading at `reached`; @param reached 0: no higher than before
/// [m]
KOKKOS_FORCEINLINE_FUNCTION void loadCurve(Plane& plane, const JointLaw& law,
                                           const ClosedPair& pair, const JointResponse& response,
                                           Real reached, JointState& state)
{
  const Real before = plane.history.maximumClosure;
  const Real now = reached > before ? reached : before;
  if (!response.crushedByShear) // what dilation lifts has not closed it
    state.maximumClosure = now;
  if (!(pair.squares > 0))
    return;
  const bool crushes = law.curve.crushing.acts();
  const Real ofSlope = 2 * pair.rising - 1;
  const Real even = pair.share * (pair.volume / pair.squares) * pair.volume;
  const Real area = crushes ? even : ofSlope * even;
  Real& areaBefore = plane.loadedArea();
  if (now > before)
  {
    const Real first = plane.area > 0 && areaBefore != 0 ? areaBefore : area;
    Real lost = std::fmax(0.0, law.curve.hysteresis(plane.fit, now) -
                                   law.curve.hysteresis(plane.fit, before));
    if (crushes)
    {
      const ClosureCurve::Point old = law.curve.at(plane.fit, before);
      const Real elastic = now - pair.permanent, elasticBefore = old.traction / old.stiffness;
      const Real turned = 0.25 * (pair.stiffness - old.stiffness) *
                          (elastic * elastic + elasticBefore * elasticBefore);
      lost = ofSlope * turned + pair.rising * (lost - turned);
    }
    plane.hysteresisWork += 0.5 * (first + area) * lost;
  }
  areaBefore = area;
}

/// What shear crushes of a joint whose crushing takes stiffness. Part of it is in the offset. Half
/// of the work is that of the closures of this cycle, half of those of the next, when the faces
/// have closed on at the same rate; it is booked there.
/// @param closesOn by how much the faces close in a step as now [m]
KOKKOS_FORCEINLINE_FUNCTION void crushByShear(Plane& plane, const ClosedPair& pair,
                                              const JointResponse& response, Real closesOn)
{
  plane.bookHysteresisDue();
  if (!response.crushedByShear)
    return;
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
}
} // namespace coplane::detail
