#pragma once

#include <coplane_contact/detail/PotentialKernel.hpp>

// Steps E and F of PotentialCycle: whether a pair of faces in overlap carries, and where it begins
// (docs/theory/contact-potential.md, "Life").

namespace coplane::detail
{
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PotentialCycle<Dim, T>::rest(Plane& plane, int i) const
{
  const bool crushed = crushes_[i] && permanents_[i] > 0 && branchFree::lane(deepest_, i) > 0;
  const bool absorbed = plane.history.absorbed && plane.isInherited();
  if (!plane.isBorn() && (crushed || absorbed) && branchFree::lane(overlaps_, i))
    stepF_createPlane(plane, branchFree::lane(pair_.plane.normal, i), leastGaps_[i]);
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION bool PotentialCycle<Dim, T>::carries(Plane& plane, int i)
{
  const bool carried = plane.area > 0;
  if (!carried)
    plane.pairAs(plane.isShallow(), false);
  const Before before = late_[i]                       ? Before::Closed
                        : carried || plane.isRefused() ? Before::Open
                                                       : stepBefore(plane, i);
  const bool closedBefore = before == Before::Closed;
  if (!carried && !(plane.declared && plane.isNew()) && !plane.history.bonded)
  {
    refuse(plane, i, closedBefore);
    if (before == Before::SharedNoArea && isOpposedByWarp(plane, i))
      plane.refusal = Refusal::Deep;
  }
  if (plane.isRefused())
    return false;
  if (!(plane.birthArea[0] > 0))
  {
    for (int f = 0; f < 2; ++f)
      plane.birthArea[f] = branchFree::lane(pair_.faceArea(f), i);
  }
  if (stepE_planeExists(plane) && (carried || plane.sighting != Sighting::Woken))
    return true;
  const bool isLedge = before == Before::SharedNoArea && isHigherThanBeside(plane, i);
  const Real warped = before == Before::SharedNoArea && !isLedge ? closedByWarp(plane, i) : 0;
  stepF_createPlane(plane, branchFree::lane(pair_.plane.normal, i), leastGaps_[i]);
  if (closedBefore || isLedge)
    beginHere(plane, i);
  plane.offset -= warped;
  return !closedBefore && !isLedge && !(warped > 0) && plane.sighting != Sighting::Woken;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Real PotentialCycle<Dim, T>::unexplainedFromTheSide(const Plane& plane,
                                                                           int i) const
{
  constexpr Real farthestInAStep = 4; // of the motion of corners: slopes, and two steps
  if (Dim == 2 || plane.history.bonded || !plane.acrossJoint)
    return 0;
  const Real explained = plane.isBorn() || plane.isInherited() ? plane.closure : 0;
  const Real closed = branchFree::lane(deepest_, i) - permanents_[i] - explained;
  return closed > farthestInAStep * mostSliding(a_, b_, i, dt_) ? closed : 0;
}

template <int Dim, class T>
KOKKOS_FUNCTION bool PotentialCycle<Dim, T>::isOpposedByWarp(const Plane& plane, int i) const
{
  if (!(unexplainedFromTheSide(plane, i) > 0))
    return false;
  const HalfStepFace a = placeOf(a_, i), b = placeOf(b_, i);
  const Real turned = 2 * (beyondNodes(a) / std::sqrt(a.area) + beyondNodes(b) / std::sqrt(b.area));
  return -dot(a.normal, b.normal) < turned;
}

template <int Dim, class T>
KOKKOS_FUNCTION Real PotentialCycle<Dim, T>::closedByWarp(const Plane& plane, int i) const
{
  constexpr Real roundOff = 1e-6;
  const Real closed = unexplainedFromTheSide(plane, i);
  if (!(closed > 0))
    return 0;
  const HalfStepFace a = placeOf(a_, i), b = placeOf(b_, i);
  const Real beyond = (beyondNodes(a) + beyondNodes(b)) / branchFree::lane(pair_.kappa(), i);
  return closed < (1 + roundOff) * beyond ? closed : 0;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION typename PotentialCycle<Dim, T>::Before
PotentialCycle<Dim, T>::stepBefore(const Plane& plane, int i) const
{
  if (plane.isNew() || (plane.isBorn() && plane.sighting != Sighting::Woken))
    return Before::Open;
  const HalfStepFace a = placeBefore<Dim>(a_, i, dt_), b = placeBefore<Dim>(b_, i, dt_);
  PairPotential<Dim, Real> before(a, b, ContactPotentialScale(options_));
  if (!before.plane.opposed) // or their shadows are apart
    return -dot(a.normal, b.normal) > options_.cosOpposed ? Before::SharedNoArea : Before::Open;
  if (plane.history.absorbedUnevenly)
    before.lay(true, plane.laid);
  before.meet(plane.offset - permanents_[i], false, {});
  const Real sliver = sliverOfFace > options_.areaMin ? sliverOfFace : options_.areaMin;
  if (!(before.overlap > sliver * (a.area < b.area ? a.area : b.area)))
    return Before::SharedNoArea;
  // Faces that only lie on each other have not been closed: what they close by next is theirs.
  const Real roundOff = roundOffOfGap * lengthOfArea<Dim>(a.area < b.area ? a.area : b.area);
  return plane.history.bonded || before.mostClosure > roundOff ? Before::Closed : Before::Open;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION bool PotentialCycle<Dim, T>::isHigherThanBeside(const Plane& plane,
                                                                       int i) const
{
  if (!plane.isInherited() || !plane.history.absorbed)
    return false;
  const Real beside = 4 * plane.closure > permanents_[i] ? 4 * plane.closure : permanents_[i];
  return branchFree::lane(deepest_, i) > beside + dt_ * branchFree::lane(speed_, i);
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PotentialCycle<Dim, T>::beginHere(Plane& plane, int i) const
{
  const Real surface = leastGaps_[i] + permanents_[i];
  const Real mean =
      branchFree::lane(pair_.moments.volume, i) / branchFree::lane(pair_.moments.area, i);
  const Real uneven = branchFree::lane(pair_.mostClosure, i) - mean;
  plane.history.bonded =
      plane.history.bonded && slopes_[i] * uneven <= planes_.law[i]->bond.tensileStrength;
  if (plane.history.bonded)
    plane.offset -= mean;
  else if (surface < plane.offset)
  {
    plane.offset = surface;
    plane.forgetAbsorbedRoundOff();
  }
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PotentialCycle<Dim, T>::refuse(Plane& plane, int i,
                                                                bool closedBefore)
{
  if (!plane.isRefused() && branchFree::lane(pair_.hidden, i))
    plane.refusal = Refusal::Hidden;
  const Real start = smallestStart(plane, 2 * dt_ * branchFree::lane(speed_, i));
  // What slides on takes up where a neighbour leaves off, whose mean closure is no less than a
  // quarter of that at its border. What is found with area in common is no such border.
  const bool comesFromTheSide = !closedBefore && plane.sighting != Sighting::Woken;
  const Real carriedBeside = (plane.lineage == Lineage::SlidesOn && comesFromTheSide ? 4
                              : plane.isBorn() || plane.isInherited()                ? 1
                                                                                     : 0) *
                             plane.closure;
  // The surface of a joint that has closed for good lies as deep as that.
  Real permanent = permanents_[i];
  if constexpr (width == 1)
    if (plane.crushedUnevenly)
      permanent = deepest_ - pair_.mostBeyondCrushing();
  const Real explained = carriedBeside > permanent ? carriedBeside : permanent;
  Real depth = branchFree::lane(deepest_, i) - explained;
  // An offset that has only just been taken over does not say how deep faces lie in each other.
  if (closedBefore && !late_[i] && -leastGaps_[i] < depth)
    depth = -leastGaps_[i];
  if (!(depth > start))
    return;
  // What begins with little of its area, or hardly opposed, begins with little energy, however
  // deep it lies. Where the surface goes on it has come from beside, or rolled on.
  if constexpr (width == 1)
    if (comesFromTheSide && mayGrow(plane) && !crushes_[i] && deepest_ < plane.deepestToGrow() &&
        beginsLittle() && pair_.isWithinASurface())
    {
      plane.pairAs(plane.isShallow(), true);
      pair_.growIn();
      return;
    }
  plane.refusal = Refusal::Deep;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION bool PotentialCycle<Dim, T>::beginsLittle() const
{
  EnergyDensity<T> density;
  pair_.press(slope_, hardening_, density);
  return pair_.opposedness * overlap_ < largestBeginning * branchFree::smaller(a_.area, b_.area);
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PotentialCycle<Dim, T>::leaveDeep()
{
  const auto grows = planes_.each([](const Plane& p) { return p.carriesGrowing(); }) > 0.0;
  done_ = done_ && !grows;
  const T birth = planes_.each([](const Plane& p) { return deepestBirth * p.depthLimit; });
  const Mask deep = done_ && overlaps_ && deepest_ > birth;
  if (branchFree::anyOf(deep))
    done_ =
        done_ &&
        !(deep && planes_.each([](const Plane& p) { return !(p.area > 0) && mayGrow(p); }) > 0.0);
}
} // namespace coplane::detail
