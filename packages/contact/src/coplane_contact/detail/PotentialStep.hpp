#pragma once

#include <coplane_contact/detail/PotentialKernel.hpp>

// What the pairs of PotentialCycle add to the stiffness of their nodes, which bounds the step
// (docs/theory/contact-potential.md, "Stable step").

namespace coplane::detail
{
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PotentialCycle<Dim, T>::boundStep(const Mask& touching)
{
  const T ahead = options_.lookAhead * speed_;
  // Bonds that are open carry, too.
  const auto near =
      overlaps_ &&
      (touching || -pair_.mostClosure <= ahead + roundOffOfGap * lengthOfArea<Dim>(overlap_)) &&
      !(planes_.each([](const Plane& p) { return p.isRefused(); }) > 0.0);
  const T nodeArea = branchFree::anyOf(near) ? stiffArea(ahead) : T{};
  for (int i = 0; i < planes_.count; ++i)
  {
    if (!branchFree::lane(done_, i))
      continue;
    Plane& plane = *planes_.plane[i];
    if (!branchFree::lane(touching, i))
    {
      if (plane.area > 0)
        plane.frictionWork += endedShear(plane, i);
      if (planes_.law[i]->curve.crushing.loss > 0)
        plane.bookHysteresisDue();
      if (options_.followsPath && dt_ > 0)
        partOnPath(plane, i);
      else
        carryNothing(plane);
      if (plane.overlap > 0)
        plane.gap = leastGaps_[i];
    }
    plane.sighting = late_[i] ? Sighting::FoundLate : Sighting::Known;
    plane.nodeStiffness =
        branchFree::lane(near, i)
            ? float(plane.weightInStep() *
                    planes_.law[i]->stiffnessBound(plane.fit, plane.history,
                                                   foreseen(i) + branchFree::lane(ahead, i)) *
                    branchFree::lane(nodeArea, i))
            : 0;
  }
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION Real PotentialCycle<Dim, T>::foreseen(int i) const
{
  const Real volume = branchFree::lane(pair_.moments.volume, i),
             deepest = branchFree::lane(deepest_, i);
  if (!(volume > 0))
    return deepest;
  const Real mean = permanents_[i] + branchFree::lane(pair_.moments.squares, i) / volume;
  return mean < deepest ? mean : deepest;
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T PotentialCycle<Dim, T>::stiffArea(const T& ahead) const
{
  using branchFree::positivePart;
  const T deep = positivePart(deepest_ / shortestEdge(a_, b_) - rimsCountFrom);
  const T z = hardening_ * positivePart(deepest_ + ahead), z2 = z * z;
  // Beyond the steepest place the largest slope stays.
  const T grown = branchFree::smaller(z2 * z2 / (1.0 + z2 * z2), T(PenaltyHardening::steepest));
  const T hardened =
      1.0 + PenaltyHardening::part * grown * (1.0 + (1.0 - grown) * (14.0 - 16.0 * grown));
  T share = (1.0 + rimStiffening * deep) * shareOfOverlap(a_.count, b_.count);
  share = branchFree::choose(pair_.isStrip() && share < shareOfStrip, T(shareOfStrip), share);
  // Faces that have shrunk since they met have more of the material on their area.
  growFromBirth();
  const T shrunk = branchFree::larger(pair_.materialArea, T(1.0));
  T area = overlap_ * share;
  if constexpr (width == 1)
    area += pair_.growthStiffness(deepest_);
  return area * pair_.depthOfStep(deepest_) * shrunk * hardened * rowSum;
}
} // namespace coplane::detail
