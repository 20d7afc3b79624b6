#pragma once

#include <coplane_contact/detail/PotentialKernel.hpp>

// Closure curves of PotentialCycle, and joints that are crushed: tangents at the closure that is
// reached (docs/theory/contact-potential.md, "Laws").

namespace coplane::detail
{
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION Real PotentialCycle<Dim, T>::reach(int i) const
{
  const JointLaw& law = *planes_.law[i];
  const JointState& history = planes_.plane[i]->history;
  const Real volume = branchFree::lane(pair_.moments.volume, i);
  if (law.curve.straight() || crushes_[i] || history.bonded || !(volume > 0))
    return 0;
  const Real known = reached_[i] > history.maximumClosure ? reached_[i] : history.maximumClosure;
  const Real closure = permanents_[i] + branchFree::lane(pair_.moments.squares, i) / volume;
  return closure > (1 + roundOffOfReach) * known ? closure : 0;
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PotentialCycle<Dim, T>::loadCurves(const Mask& loading)
{
  if (!branchFree::anyOf(loading))
    return;
  for (int pass = 0; pass < mostTangents; ++pass)
  {
    bool any = false;
    for (int i = 0; i < width; ++i)
      if (branchFree::lane(loading, i))
        if (const Real closure = reach(i); closure > 0)
        {
          reached_[i] = closure;
          layTangent(i, closure);
          any = true;
        }
    if (!any)
      return;
    slope_ = all(slopes_);
    findClosure();
  }
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PotentialCycle<Dim, T>::leaveNewOnCurves(const Mask& touching)
{
  if (branchFree::anyOf(touching))
    done_ = done_ && !(touching && branchFree::gathered<T>(
                                       [&](int i) -> Real {
                                         return !planes_.plane[i]->isRefused() && reach(i) > 0;
                                       }) > 0.0);
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PotentialCycle<Dim, T>::leaveCrushed(const Mask& opposed)
{
  bool any = false;
  for (const bool crushes : crushes_)
    any = any || crushes;
  if (!any)
    return;
  const Mask here =
      branchFree::gathered<T>([&](int i) -> Real { return crushes_[i]; }) > 0.0 && opposed;
  done_ = done_ && !(branchFree::gathered<T>(
                         [&](int i) -> Real
                         {
                           return planes_.plane[i]->crushedUnevenly ||
                                  branchFree::lane(pair_.mostClosure, i) + permanents_[i] >
                                      mostWithoutCrushing(i);
                         }) > 0.0 &&
                     here);
  const ContactMoments<T>& m = pair_.moments;
  const auto byShear = [&](const T& shear)
  {
    return here && branchFree::gathered<T>(
                       [&](int i) -> Real
                       {
                         const Real volume = branchFree::lane(m.volume, i);
                         return volume > 0 && planes_.law[i]->mayBeCrushed(
                                                  permanents_[i],
                                                  slopes_[i] * volume / branchFree::lane(m.area, i),
                                                  branchFree::lane(shear, i));
                       }) > 0.0;
  };
  if (!branchFree::anyOf(byShear(T(infinity))))
    return;
  EnergyDensity<T> density;
  pair_.press(slope_, branchFree::choose(bonded_, T(0.0), hardening_), density);
  Vec3Of<T> increment;
  growFromBirth();
  const Vec3Of<T> tau =
      shearAfter(pair_.materialArea * pair_.opposedness * m.area, stepG_motion(), increment);
  const T stiffness = planes_.each([](const Plane& p) { return p.fit.shearStiffness; });
  const Vec3Of<T> trial = tau - stiffness * increment;
  done_ = done_ && !byShear(branchFree::squareRoot(dot(trial, trial)));
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION Real PotentialCycle<Dim, T>::mostWithoutCrushing(int i) const
{
  return planes_.law[i]->curve.crushing.closureOf(permanents_[i], slopes_[i]);
}
} // namespace coplane::detail
