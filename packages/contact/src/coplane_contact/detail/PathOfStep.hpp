#pragma once

#include <coplane_contact/detail/PotentialKernel.hpp>

// What PotentialCycle does where the forces of a pair bend within a step
// (docs/theory/contact-potential.md, "Forces that bend within a step").

namespace coplane::detail
{
/// A step whose forces work by less than this fraction of what a pair stores otherwise than its
/// energy changes does not bend them [-]. Pairs that hand a border on to each other miss opposite
/// forces, and one of them may be below it.
constexpr Real smoothEnough = 1e-6;
/// Where one force in the middle does not make up for what a step misses it is cut, into no more
/// parts than this.
constexpr int mostParts = 8;
/// And only as long as parts half as long leave less than this of what cannot be made up [-]:
/// borders that pairs share have no energy whose gradient they are, however short the path.
constexpr Real worthCutting = 0.5;
/// What makes up for a step is at most so many times what its path says, to pay what those before
/// it have left over [-].
constexpr Real mostPaid = 2;

template <int Dim, class T>
KOKKOS_FUNCTION bool PotentialCycle<Dim, T>::pushAt(const Plane& plane, int i, Real ago,
                                                    NormalPush& push) const
{
  const HalfStepFace a = placeBefore<Dim>(a_, i, ago), b = placeBefore<Dim>(b_, i, ago);
  PairPotential<Dim, Real> pair(a, b, ContactPotentialScale(options_));
  if (!pair.plane.opposed)
    return false;
  if (plane.history.absorbedUnevenly)
    pair.lay(true, plane.laid);
  if (plane.crushedUnevenly)
    pair.beCrushed(plane.crushing());
  if (plane.isGrowing())
    pair.growIn();
  // What is crushed unevenly is not in the offset.
  pair.meet(plane.offset - (plane.crushedUnevenly ? 0 : permanents_[i]), false, edgesOf(plane));
  if (!(pair.overlap > options_.areaMin * (a.area < b.area ? a.area : b.area)) ||
      !(pair.moments.area > 0 && pair.moments.volume > 0))
    return false;
  EnergyDensity<Real> density;
  const Real energy = pair.press(slopes_[i], branchFree::lane(hardening_, i), density);
  if (pair.hasNothing())
    return false;
  const auto birth = [&](int f)
  { return plane.birthArea[f] > 0 ? plane.birthArea[f] : pair.faceArea(f); };
  pair.growFrom(birth(0), birth(1));
  pair.differentiate(energy, density);
  push.energy = pair.materialArea * pair.opposedness * energy;
  const int count[2] = {a.count, b.count};
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < count[f]; ++k)
      push.forces[f][k] = -pair.gradient[f][k];
  return true;
}

template <int Dim, class T>
KOKKOS_FUNCTION bool PotentialCycle<Dim, T>::makeUp(Plane& plane, int i, bool carried, bool carries,
                                                    bool bends, Real lost,
                                                    Vec3 (&missed)[2][4]) const
{
  const bool pushed = carried || plane.lags;
  if (!pushed)
    plane.debt = 0;
  // A joint that closes as never before, or is crushed, had another energy a step ago.
  if (plane.hysteresisWork != branchFree::lane(before_.hysteresis, i) ||
      slopes_[i] != branchFree::lane(before_.slope, i))
  {
    plane.planned = 0;
    return false;
  }
  NormalPush first, last; // where it is no contact it has no forces
  // Where rules for the life of a plane have made it begin or end there is nothing to compare with.
  const bool known =
      bends && pushAt(plane, i, dt_, first) == carried && pushAt(plane, i, 0, last) == carries;
  Vec3 ends[2][4];
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 4; ++k)
      ends[f][k] = 0.5 * (first.forces[f][k] + last.forces[f][k]);
  const Real lacks = known ? first.energy - last.energy - work(ends, i) : 0;
  // What made up for the last step works with the mean of two velocities, and was found from one.
  if (pushed && (known || !bends))
    plane.debt += float(lost - lacks);
  plane.planned = 0;
  if (!known)
    return false;
  Real unpaid = sumOverParts(plane, i, 1, first, last, missed);
  for (int parts = 2; unpaid > 0 && parts <= mostParts; parts *= 2)
  {
    Vec3 finer[2][4];
    const Real left = sumOverParts(plane, i, parts, first, last, finer);
    if (left > worthCutting * unpaid)
      break;
    unpaid = left;
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < 4; ++k)
        missed[f][k] = finer[f][k];
  }
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 4; ++k)
      missed[f][k] = missed[f][k] - ends[f][k];
  if (!options_.axisymmetric)
    takeCoupleOff<Dim>(missed, placeOf(a_, i), placeOf(b_, i));
  const Real due = lacks + plane.debt, all = work(missed, i);
  const Real wanted = due * all > 0 ? due / all : 0;
  const Real part = wanted < mostPaid ? wanted : mostPaid;
  plane.debt = float(due - part * all);
  plane.planned = 0.5 * part * all;
  for (auto& ofFace : missed)
    for (Vec3& force : ofFace)
      force = part * force;
  return part > 0;
}

template <int Dim, class T>
KOKKOS_FUNCTION Real PotentialCycle<Dim, T>::sumOverParts(const Plane& plane, int i, int parts,
                                                          const NormalPush& first,
                                                          const NormalPush& last,
                                                          Vec3 (&mean)[2][4]) const
{
  const HalfStepFace a = movingFace(a_, i), b = movingFace(b_, i);
  const Real share = 1.0 / parts;
  Real unpaid = 0;
  for (auto& ofFace : mean)
    for (Vec3& force : ofFace)
      force = {};
  NormalPush before = first;
  for (int part = 0; part < parts; ++part)
  {
    NormalPush middle, after;
    pushAt(plane, i, (1 - (part + 0.5) * share) * dt_, middle);
    if (part + 1 < parts)
      pushAt(plane, i, (1 - (part + 1) * share) * dt_, after);
    else
      after = last;
    Vec3 ends[2][4], bend[2][4];
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < 4; ++k)
      {
        ends[f][k] = 0.5 * (before.forces[f][k] + after.forces[f][k]);
        bend[f][k] = middle.forces[f][k] - ends[f][k];
      }
    const Real released = before.energy - after.energy;
    const Real lacks = released - 2 * share * halfStepWork(ends, a, b, dt_);
    const Real all = 2 * share * halfStepWork(bend, a, b, dt_);
    const Real wanted = lacks * all > 0 ? lacks / all : 0;
    const Real got = wanted < 1 ? wanted : 1;
    const Real most = before.energy > after.energy ? before.energy : after.energy;
    const Real left = std::fabs(lacks - got * all);
    unpaid += left > smoothEnough * most ? left : 0;
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < 4; ++k)
        mean[f][k] += share * (ends[f][k] + got * bend[f][k]);
    before = after;
  }
  return unpaid;
}

template <int Dim, class T>
KOKKOS_FUNCTION void PotentialCycle<Dim, T>::followPath(const Mask& touching, const T& normalEnergy,
                                                        Vec3Of<T> (&nodal)[2][4]) const
{
  using namespace branchFree;
  const T stored = normalEnergy + planes_.each([](const Plane& p) { return p.shearEnergy(); });
  const T lost = planes_.each([](const Plane& p) { return p.remainder() + p.stored + p.planned; }) -
                 halfStepWork(nodal, a_, b_, dt_) - stored - before_.remainder;
  const Mask bends =
      touching && !bonded_ && absolute(lost) > smoothEnough * larger(stored, before_.stored);
  for (int i = 0; i < planes_.count; ++i)
  {
    if (!lane(touching, i))
      continue;
    Plane& plane = *planes_.plane[i];
    Vec3 missed[2][4];
    const bool pushes = plane.area > 0; // a strip that is left sideways does not
    const bool pays =
        makeUp(plane, i, lane(before_.area, i) > 0, pushes, lane(bends, i), lane(lost, i), missed);
    plane.lags = pays && !pushes;
    if (!pays)
      continue;
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < (f == 0 ? a_.count : b_.count); ++k)
        addInLane(nodal[f][k], i, missed[f][k]);
  }
}

template <int Dim, class T>
KOKKOS_FUNCTION void PotentialCycle<Dim, T>::partOnPath(Plane& plane, int i) const
{
  if (!(plane.area > 0))
  {
    payRest<Dim>(plane, movingFace(a_, i), movingFace(b_, i), dt_);
    return;
  }
  const Real lost =
      plane.remainder() + plane.stored + plane.planned - branchFree::lane(before_.remainder, i);
  Vec3 missed[2][4];
  const bool pays =
      !plane.history.bonded &&
      makeUp(plane, i, true, false, std::fabs(lost) > smoothEnough * plane.stored, lost, missed);
  carryNothing(plane);
  if (!pays)
  {
    plane.planned = 0;
    return;
  }
  plane.work -= plane.planned;
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 4; ++k)
      plane.nodal[f][k] = missed[f][k];
  plane.lags = true;
}
} // namespace coplane::detail
