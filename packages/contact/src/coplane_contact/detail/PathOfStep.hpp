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
/// What makes up for a step is at most so many times what its path says, to pay what those before
/// it have left over [-].
constexpr Real mostPaid = 2;

/// Takes the couple off forces at the nodes of both faces, by forces that turn them about their
/// middle as a rigid body is turned.
template <int Dim>
KOKKOS_INLINE_FUNCTION void takeCoupleOff(Vec3 (&force)[2][4], const HalfStepFace& a,
                                          const HalfStepFace& b)
{
  Vec3 x[8], forces[8];
  int count = 0;
  for (int f = 0; f < 2; ++f)
  {
    const HalfStepFace& face = f == 0 ? a : b;
    for (int k = 0; k < face.count; ++k, ++count)
    {
      x[count] = face.x[k];
      forces[count] = force[f][k];
    }
  }
  const FaceInertia<Dim, Real, 8> inertia(x, count);
  const Vec3 spin = inertia.solve(inertia.momentOf(forces));
  int i = 0;
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < (f == 0 ? a.count : b.count); ++k, ++i)
      force[f][k] = force[f][k] - cross(spin, inertia.r[i]);
}

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
  if (!carried)
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
  const Real most = std::fabs(plane.planned), less = lost - lacks;
  if (carried && (known || !bends))
    plane.debt += float(less > most ? most : less < -most ? -most : less);
  plane.planned = 0;
  if (!known)
    return false;
  for (int parts = 1; !sumOverParts(plane, i, parts, first, last, missed) && parts < mostParts;)
    parts *= 2;
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
KOKKOS_FUNCTION bool
PotentialCycle<Dim, T>::sumOverParts(const Plane& plane, int i, int parts, const NormalPush& first,
                                     const NormalPush& last, Vec3 (&mean)[2][4]) const
{
  const HalfStepFace a = movingFace(a_, i), b = movingFace(b_, i);
  const Real share = 1.0 / parts;
  bool fits = true;
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
    fits = fits && std::fabs(lacks - got * all) <= smoothEnough * most;
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < 4; ++k)
        mean[f][k] += share * (ends[f][k] + got * bend[f][k]);
    before = after;
  }
  return fits;
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
  const Real lost =
      plane.remainder() + plane.stored + plane.planned - branchFree::lane(before_.remainder, i);
  Vec3 missed[2][4];
  const bool pays =
      plane.area > 0 && !plane.history.bonded &&
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
