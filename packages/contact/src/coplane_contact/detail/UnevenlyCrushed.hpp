#pragma once

#include <coplane_contact/ContactPotential.hpp>
#include <coplane_contact/FacePairKernel.hpp>

// What it costs to crush a joint further.

namespace coplane::detail
{
/// A face before the step at whose end it is now.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION HalfStepFace faceBefore(const HalfStepFaceOf<T>& face, Real dt)
{
  const HalfStepFace now = placeOf(face, 0);
  FaceNodes nodes;
  nodes.count = now.count;
  for (int i = 0; i < now.count; ++i)
  {
    nodes.x[i] = now.x[i] - dt * branchFree::lane(face.v[i], 0);
    nodes.v[i] = {};
  }
  return stepA_faceAtEnd<Dim>(nodes);
}

/// The energy of a pair in one position, however it is crushed.
template <int Dim>
class UnevenlyCrushed
{
public:
  KOKKOS_INLINE_FUNCTION UnevenlyCrushed(const Plane& plane, const ContactOptions& options,
                                         const EdgesOf<Real>& edges, const HalfStepFace& a,
                                         const HalfStepFace& b)
      : plane_(plane), scale_(options.cosOpposed), edges_(edges), a_(a), b_(b)
  {
  }

  KOKKOS_INLINE_FUNCTION Real energyOf(const UnevenCrushing& crushing) const
  {
    return energyOf(&crushing, 0);
  }
  KOKKOS_INLINE_FUNCTION Real energyOf(Real even) const { return energyOf(nullptr, even); }

private:
  KOKKOS_INLINE_FUNCTION Real energyOf(const UnevenCrushing* crushing, Real even) const
  {
    PairPotential<Dim, Real> pair(a_, b_, scale_);
    if (!pair.plane.opposed)
      return 0;
    if (crushing != nullptr)
      pair.beCrushed(*crushing);
    pair.meet(plane_.offset - even, false, edges_);
    if (!(pair.moments.volume > 0))
      return 0;
    EnergyDensity<Real> density;
    const Real energy = pair.press(plane_.fit.normalStiffness, 0, density);
    pair.growFrom(plane_.birthArea[0], plane_.birthArea[1]);
    return pair.materialArea * pair.opposedness * energy;
  }

  const Plane& plane_;
  const ContactPotentialScale scale_;
  const EdgesOf<Real>& edges_;
  const HalfStepFace a_, b_;
};
} // namespace coplane::detail
