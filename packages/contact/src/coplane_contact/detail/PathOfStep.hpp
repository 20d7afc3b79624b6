#pragma once

#include <coplane_contact/detail/PotentialKernel.hpp>

// What PotentialCycle does where the forces of a pair bend within a step
// (docs/theory/contact-potential.md, "Kinks within a step").

namespace coplane::detail
{
/// A step whose forces work by less than this fraction of what a pair stores otherwise than its
/// energy changes has no kink [-]. Pairs that hand a border on to each other miss opposite forces:
/// either both make up for them or none, up to so much of their energy.
constexpr Real smoothEnough = 1e-6;
/// Where one force in the middle does not make up for what a step misses it is cut, into no more
/// parts than this.
constexpr int mostParts = 8;

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
  pair.meet(plane.offset - permanents_[i], false, edgesOf(plane));
  if (!(pair.overlap > options_.areaMin * (a.area < b.area ? a.area : b.area)) ||
      !(pair.moments.area > 0 && pair.moments.volume > 0))
    return false;
  EnergyDensity<Real> density;
  const Real energy = pair.press(slopes_[i], branchFree::lane(hardening_, i), density);
  if (pair.hasNothing())
    return true;
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
KOKKOS_FUNCTION bool PotentialCycle<Dim, T>::missedOnPath(const Plane& plane, int i, bool carried,
                                                          bool carries, Vec3 (&missed)[2][4]) const
{
  NormalPush first, last; // where it is no contact it has no forces
  const bool pushed = pushAt(plane, i, dt_, first), pushes = pushAt(plane, i, 0, last);
  if (pushed != carried || pushes != carries)
    return false;
  for (int parts = 1; !sumOverParts(plane, i, parts, first, last, missed) && parts < mostParts;)
    parts *= 2;
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 4; ++k)
      missed[f][k] = missed[f][k] - 0.5 * (first.forces[f][k] + last.forces[f][k]);
  if (!options_.axisymmetric)
    takeCoupleOff<Dim>(missed, placeOf(a_, i), placeOf(b_, i));
  return true;
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
  const T lost = planes_.each([](const Plane& p) { return p.remainder() + p.stored + p.owed; }) -
                 halfStepWork(nodal, a_, b_, dt_) - stored - before_.remainder;
  const Mask bends =
      touching && !bonded_ && absolute(lost) > smoothEnough * larger(stored, before_.stored);
  for (int i = 0; i < planes_.count; ++i)
  {
    if (!lane(touching, i))
      continue;
    Plane& plane = *planes_.plane[i];
    plane.owed = 0;
    plane.settles = false;
    Vec3 missed[2][4];
    if (!lane(bends, i) || !missedOnPath(plane, i, lane(before_.area, i) > 0, true, missed))
      continue;
    plane.owed = halfStepWork(missed, movingFace(a_, i), movingFace(b_, i), dt_);
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < (f == 0 ? a_.count : b_.count); ++k)
        addInLane(nodal[f][k], i, missed[f][k]);
  }
}

template <int Dim, class T>
KOKKOS_FUNCTION void PotentialCycle<Dim, T>::partOnPath(Plane& plane, int i) const
{
  const Real lost =
      plane.remainder() + plane.stored + plane.owed - branchFree::lane(before_.remainder, i);
  Vec3 missed[2][4];
  const bool bends = plane.area > 0 && !plane.isRefused() && !plane.history.bonded &&
                     std::fabs(lost) > smoothEnough * plane.stored &&
                     missedOnPath(plane, i, true, false, missed);
  carryNothing(plane);
  if (!bends)
    return;
  plane.owed = halfStepWork(missed, movingFace(a_, i), movingFace(b_, i), dt_);
  plane.work -= plane.owed;
  for (int f = 0; f < 2; ++f)
    for (int k = 0; k < 4; ++k)
      plane.nodal[f][k] = missed[f][k];
  plane.settles = true;
}
} // namespace coplane::detail
