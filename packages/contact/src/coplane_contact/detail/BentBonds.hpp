#pragma once

#include <coplane_contact/ContactPotential.hpp>
#include <coplane_contact/PairLife.hpp>

#include <cmath>

// Bonds that resist bending (docs/theory/contact-potential.md, "Laws"): the traction follows the
// closure at each point, k c where it is closed, less where it is open and has worn.

namespace coplane::detail
{
/// How the bonds of a batch are bent.
template <class T>
struct BentBonds
{
  BondBending lanes[PlaneBatch<T>::width];
  bool partly = false; ///< a bond that may wear is in part closed; T = Real only
};

/// Bound on how far two faces slide past each other in a step, but for the turning of their plane
/// [m].
template <class T>
KOKKOS_INLINE_FUNCTION Real mostSliding(const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b,
                                        int i, Real dt)
{
  Real square = 0;
  for (int j = 0; j < a.count; ++j)
    for (int k = 0; k < b.count; ++k)
    {
      const Vec3 drift = branchFree::lane(b.v[k], i) - branchFree::lane(a.v[j], i);
      square = std::fmax(square, dot(drift, drift));
    }
  return dt * std::sqrt(square);
}

/// Fills `bent`. What is closed of a bond that is partly open, and may wear, has to be cut off:
/// that is left to T = Real.
/// @param of the lanes with bonds that resist bending
/// @returns the lanes that are left
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T>
findBending(const PlaneBatch<T>& planes, const branchFree::MaskOf<T>& of,
            const PairPotential<Dim, T>& pair, const HalfStepFaceOf<T>& a,
            const HalfStepFaceOf<T>& b, Real dt, BentBonds<T>& bent)
{
  const ContactMoments<T>& m = pair.moments;
  const T least = pair.leastClosure(), mean = m.volume / m.area, squares = m.squares / m.area;
  Real left[PlaneBatch<T>::width] = {};
  for (int i = 0; i < planes.count; ++i)
  {
    if (!branchFree::lane(of, i))
      continue;
    const Plane& plane = *planes.plane[i];
    BondBending& bending = bent.lanes[i];
    bending.mean = branchFree::lane(mean, i);
    bending.opened = -branchFree::lane(least, i);
    if (!(bending.opened > 0))
      bending.closedMean = bending.mean;
    else if (!(branchFree::lane(pair.mostClosure, i) > 0))
      bending.openSquares = branchFree::lane(squares, i);
    else if (planes.law[i]->mayWear(plane.fit, plane.history, bending.opened,
                                    mostSliding(a, b, i, dt)))
    {
      if constexpr (PlaneBatch<T>::width == 1)
      {
        const PairPotential<Dim, Real> closed = pair.closedPart(plane.offset);
        bending.closedMean = closed.moments.volume / m.area;
        bending.openSquares = branchFree::positivePart(m.squares - closed.moments.squares) / m.area;
        bent.partly = true;
      }
      else
        left[i] = 1;
    }
  }
  return branchFree::gathered<T>([&](int i) { return left[i]; }) > 0.0;
}

/// What is closed of a bond that is bent is as stiff as ever: adds that to the gradient.
/// @param more stiffness than where it is open [Pa/m]
/// @param force along the normals [N] and energy [J], to which it adds
template <int Dim>
KOKKOS_INLINE_FUNCTION void addClosedPart(PairPotential<Dim, Real>& pair, const Plane& plane,
                                          Real more, Real& force, Real& energy)
{
  if (!(more > 0))
    return;
  PairPotential<Dim, Real> closed = pair.closedPart(plane.offset);
  if (!(closed.moments.volume > 0))
    return;
  EnergyDensity<Real> density;
  const Real stored = closed.press(more, 0, density);
  closed.growFrom(plane.birthArea[0], plane.birthArea[1]);
  force += closed.differentiate(stored, density);
  energy += closed.materialArea * closed.opposedness * stored;
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < 4; ++i)
      pair.gradient[f][i] += closed.gradient[f][i];
}
} // namespace coplane::detail
