#pragma once

#include <coplane_contact/FacePairSteps.hpp>
#include <coplane_contact/Plane.hpp>

// Planes that are updated side by side, and what both ways of computing forces do with them: how
// shear turns with a pair, the work of its forces, dashpots.

namespace coplane
{
/// Planes that are updated side by side, one for each lane of T; with Real just one. The lanes from
/// `count` on repeat others and are not written.
template <class T>
struct PlaneBatch
{
  static constexpr int width = branchFree::widthOf<T>;
  int count = width;
  Plane* plane[width];
  const JointLaw* law[width];

  /// get(plane) of all of them.
  template <class Get>
  KOKKOS_INLINE_FUNCTION T each(const Get& get) const
  {
    return branchFree::gathered<T>([&](int i) -> Real { return get(*plane[i]); });
  }
  template <class Get>
  KOKKOS_INLINE_FUNCTION Vec3Of<T> eachVector(const Get& get) const
  {
    return {each([&](const Plane& p) { return get(p).x; }),
            each([&](const Plane& p) { return get(p).y; }),
            each([&](const Plane& p) { return get(p).z; })};
  }
};

/// Carries a traction that lies in the plane with normal `from` into the plane with normal `to`:
/// least rotation, then the pair's spin about the new normal during dt, and no change of length.
template <class T>
KOKKOS_INLINE_FUNCTION Vec3Of<T> turnIntoPlane(const Vec3Of<T>& traction, const Vec3Of<T>& from,
                                               const Vec3Of<T>& to, const Vec3Of<T>& spin, Real dt)
{
  const T size = norm(traction);
  if (!branchFree::anyOf(size > 0.0))
    return traction;
  const Vec3Of<T> k = cross(from, to);
  const Vec3Of<T> kTau = cross(k, traction);
  Vec3Of<T> turned = traction + kTau + (1.0 / (1.0 + dot(from, to))) * cross(k, kTau);
  // The spin of a finite rotation between two positions is its Cayley vector: 2 tan(angle / 2) /
  // dt.
  const T t = 0.5 * dt * dot(to, spin);
  const T scale = 1.0 / (1.0 + t * t);
  turned = (scale * (1.0 - t * t)) * turned + (2.0 * scale * t) * cross(to, turned);
  turned = turned - dot(to, turned) * to;
  const T length = norm(turned);
  return branchFree::choose(length > 0.0, size / length, T(0.0)) * turned;
}

/// Work of forces of the nodes in half a step, by which the work of a step is their mean [J].
template <class T>
KOKKOS_INLINE_FUNCTION T halfStepWork(const Vec3Of<T> (&nodal)[2][4], const HalfStepFaceOf<T>& a,
                                      const HalfStepFaceOf<T>& b, Real dt)
{
  T power{};
  for (int i = 0; i < a.count; ++i)
    power += dot(nodal[0][i], a.v[i]);
  for (int i = 0; i < b.count; ++i)
    power += dot(nodal[1][i], b.v[i]);
  return (0.5 * dt) * power;
}

/// Work of the old force on the nodes in this step, by the trapezoid rule [J]; of the planes that
/// push, in the lanes of `mine`.
template <class T>
KOKKOS_INLINE_FUNCTION void
bookOldForce(const PlaneBatch<T>& planes, const branchFree::MaskOf<T>& mine,
             const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b, Real dt)
{
  const auto carried = mine && planes.each([](const Plane& p) { return Real(p.pushes()); }) > 0.0;
  if (!branchFree::anyOf(carried))
    return;
  Vec3Of<T> nodal[2][4];
  const int count[2] = {a.count, b.count};
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < count[f]; ++i)
      nodal[f][i] = planes.eachVector([&](const Plane& p) { return p.nodal[f][i]; });
  const T work = halfStepWork(nodal, a, b, dt);
  for (int i = 0; i < planes.count; ++i)
    if (branchFree::lane(carried, i))
      planes.plane[i]->work -= branchFree::lane(work, i);
}

KOKKOS_INLINE_FUNCTION void bookOldForce(Plane& plane, const HalfStepFace& a, const HalfStepFace& b,
                                         Real dt)
{
  PlaneBatch<Real> one;
  one.plane[0] = &plane;
  bookOldForce(one, true, a, b, dt);
}

/// Forces of the nodes, and their work in the second half of the step.
template <class T>
KOKKOS_INLINE_FUNCTION void putForces(const PlaneBatch<T>& planes,
                                      const branchFree::MaskOf<T>& touching,
                                      const Vec3Of<T> (&nodal)[2][4], const HalfStepFaceOf<T>& a,
                                      const HalfStepFaceOf<T>& b, Real dt)
{
  using branchFree::lane;
  const T work = halfStepWork(nodal, a, b, dt);
  for (int i = 0; i < planes.count; ++i)
  {
    if (!lane(touching, i))
      continue;
    Plane& plane = *planes.plane[i];
    for (int f = 0; f < 2; ++f)
      for (int k = 0; k < 4; ++k)
        plane.nodal[f][k] = lane(nodal[f][k], i);
    plane.work -= lane(work, i);
  }
}

/// A dashpot along planes, limited where they are not bonded to what friction at rest holds: in the
/// step in which faces meet, or on a joint that carries nothing, round-off decides whether they
/// stick.
/// @param normalForce compression [N]; damping [N]
template <class T>
KOKKOS_INLINE_FUNCTION Vec3Of<T> heldByFriction(const PlaneBatch<T>& planes, const T& normalForce,
                                                const Vec3Of<T>& damping)
{
  using branchFree::choose;
  const auto bonded = planes.each([](const Plane& p) { return p.history.bonded; }) > 0.0;
  const T friction = branchFree::gathered<T>(
      [&](int i) -> Real
      {
        const Plane& plane = *planes.plane[i];
        return plane.normalTraction > 0
                   ? planes.law[i]->frictionAt(plane.normalTraction, plane.history.slip, 0)
                   : 0.0;
      });
  const T most = friction * choose(normalForce > 0.0, normalForce, T(0.0)), size = norm(damping);
  return choose(!bonded && size > most, most / size, T(1.0)) * damping;
}

/// Of a dashpot per area, which takes the fraction zeta of critical damping from a surface that
/// moves on springs of so much stiffness per area [Pa s/m]. Per area, and by the mass behind faces,
/// not by that of nodes: so a face that is cut into parts, beside others or not, is damped as a
/// whole one.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T dashpotPerArea(Real zeta, const T& stiffness,
                                             const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b)
{
  return 2.0 * zeta *
         branchFree::squareRoot(stiffness / (1.0 / a.massPerArea + 1.0 / b.massPerArea));
}
} // namespace coplane
