#pragma once

#include <coplane_contact/ContactPotential.hpp>

// Steps of PairPotential for bodies of revolution about x = 0 (docs/theory/contact-potential.md,
// "Bodies of revolution"). What one metre of depth has in plane strain counts here by the
// circumference: at each place along the plane the mean of those of both faces, where the normal of
// the plane meets them. It is never negative where faces share anything, however they lie.

namespace coplane
{
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::revolve()
{
  for (int f = 0; f < 2; ++f)
  {
    const Vec3* const x = face_[f]->x;
    const Real s0 = shadow[f].p[0].x, s1 = shadow[f].p[1].x;
    const Real slope = pi * (x[1].x - x[0].x) / (s1 - s0);
    radius_[f] = {pi * x[0].x - slope * s0, slope};
    around_[f] = pi * (x[0].x + x[1].x);
    // On the axis there is no surface.
    plane.opposed = plane.opposed && around_[f] > 0;
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION ContactMoments<T> PairPotential<Dim, T>::momentsOfRing(const Owned& q) const
{
  ContactMoments<T> sum;
  alongSegment(q.sides.from[0].x, q.sides.from[1].x,
               [&](Real s, Real part)
               {
                 const Real c = closureIn(q, {s, 0}), area = part * around(s);
                 sum.area += area;
                 sum.volume += area * c;
                 sum.squares += area * (c * c);
                 sum.areaMoment.x += area * s;
                 sum.volumeMoment.x += area * (c * s);
               });
  return sum;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::addHoop(Real s, Real perDepth)
{
  for (int f = 0; f < 2; ++f)
  {
    const Real s0 = shadow[f].p[0].x, weight = (s - s0) / (shadow[f].p[1].x - s0);
    hoop_[f][0] += pi * (1 - weight) * perDepth;
    hoop_[f][1] += pi * weight * perDepth;
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::addRadii(const Real& energy,
                                                            const EnergyDensity<T>& density,
                                                            const Real& scale, Vec2 (&rim)[2][4])
{
  for (int i = 0; i < pieces_; ++i)
    if (const Owned& q = piece_[i]; q.sides.size > 0)
      alongSegment(q.sides.from[0].x, q.sides.from[1].x,
                   [&](Real s, Real part)
                   {
                     const Real c = closureIn(q, {s, 0});
                     addHoop(s,
                             part * (density.constant + c * (density.linear + c * density.square)));
                   });
  for (int f = 0; f < 2; ++f)
  {
    // Through the area of the face, by its own circumference: that of its birth, and the range of
    // the opposition, which counts it once beside three lengths.
    const Real ofFace =
        -pi * opposedness * energy / around_[f] *
        (0.5 * birth_[f] / face_[f]->area + materialArea * falling_ * sizes_[f] / 3);
    for (int i = 0; i < 2; ++i)
    {
      gradient[f][i].x += scale * hoop_[f][i] + ofFace;
      // The radius at a fixed place falls as the node moves along the plane with the radius it has.
      rim[f][i].x -= radius_[f].slope / pi * hoop_[f][i];
      hoop_[f][i] = 0;
    }
  }
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T PairPotential<Dim, T>::depthOfStep(const T& deepest) const
{
  if constexpr (canRevolve)
    if (scale_.axisymmetric)
    {
      const Real atAxis = 1.05;
      const Real narrower = branchFree::smaller(around_[0], around_[1]);
      const Real deep = 1 + pi * branchFree::positivePart(deepest) / narrower;
      return atAxis * deep * deep * depth;
    }
  return T(1.0);
}
} // namespace coplane
