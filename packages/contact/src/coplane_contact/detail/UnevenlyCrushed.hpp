#pragma once

#include <coplane_contact/ContactPotential.hpp>
#include <coplane_contact/HalfStepFace.hpp>

// A joint without bond that is crushed as its faces are tilted (docs/theory/joints.md, "Uneven
// crushing").

namespace coplane::detail
{
/// How a joint was crushed before a cycle that crushes it further.
struct CrushedFrom
{
  bool further = false;
  UnevenCrushing from;
  Real lostBefore = 0; ///< by the tractions before the step, of what it costs [J]
  Real energy = 0;     ///< that the pair would have where the faces are now [J]
};

/// The plane of such a joint in a cycle, with its pair, which has met.
template <int Dim>
struct UnevenlyCrushed
{
  Plane& plane;
  const Crushing& law;
  Real stiffness; ///< [Pa/m]
  const ContactOptions& options;
  Real dt; ///< of the step [s]
  const HalfStepFace &a, &b;
  EdgesOf<Real> edges;
  PairPotential<Dim, Real>& pair;

  /// Crushes the joint as far as the closures of now do, before the force.
  /// @param permanent closure that the offset of the pair leaves out, of a joint that has been
  ///        crushed evenly; gets the mean crushing of one that is crushed unevenly [m]
  KOKKOS_INLINE_FUNCTION CrushedFrom crush(Real& permanent) const
  {
    const Real even = permanent, offset = plane.offset;
    const bool was = plane.crushedUnevenly;
    const Real least = was ? law.onset(stiffness) : law.closureOf(even, stiffness);
    CrushedFrom result;
    UnevenCrushing to;
    if (pair.mostClosure + even > least && pair.crushFurther(law, stiffness, even, to))
    {
      result.from = was ? plane.crushing() : UnevenCrushing{even, {0, 0}};
      pair.beCrushed(to);
      pair.meet(offset, false, edges);
      result.further = pair.moments.volume > 0;
      if (result.further)
      {
        if (plane.area > 0)
          result.lostBefore = lostBefore(result.from, to);
        result.energy = energyNow(result.from);
        plane.crush(to);
      }
      else
      {
        if (was)
          pair.beCrushed(plane.crushing());
        else
          pair.notCrushed();
        pair.meet(was ? offset : offset - even, false, edges);
      }
    }
    if (plane.crushedUnevenly)
      permanent = pair.meanCrushing();
    return result;
  }

  /// What it costs to crush the joint further [J]: by the trapezoid rule over the step, and no more
  /// than the energy falls by where the faces are now. That is less where the crushing rises by
  /// more than what is closed elastically, so that the tractions fall on the way.
  /// @param density, pressed of the pair now
  KOKKOS_INLINE_FUNCTION Real lost(const CrushedFrom& crushed, const EnergyDensity<Real>& density,
                                   Real pressed) const
  {
    const Real byTractions =
        0.5 * (crushed.lostBefore + pair.lostBy(crushed.from, plane.crushing(), density));
    const Real most = crushed.energy - pair.materialArea * pair.opposedness * pressed;
    return byTractions < most ? byTractions : most;
  }

  /// The law takes what shear crushes for crushed all over. Where the joint is not, the dilation
  /// lifts it and nothing gives way: the energy that it has more then [J].
  /// @param sheared what shear has crushed [m]; loaded: force [N] over opposedness
  KOKKOS_INLINE_FUNCTION Real lifted(Real sheared, const EnergyDensity<Real>& density,
                                     Real loaded) const
  {
    UnevenCrushing before = plane.crushing();
    before.atCenter -= sheared;
    return pair.materialArea * pair.opposedness * loaded * sheared -
           pair.lostBy(before, plane.crushing(), density);
  }

private:
  /// What it costs to crush the joint further with the tractions that it had before the step [J].
  KOKKOS_INLINE_FUNCTION Real lostBefore(const UnevenCrushing& from, const UnevenCrushing& to) const
  {
    const HalfStepFace faces[2] = {faceBefore(a), faceBefore(b)};
    PairPotential<Dim, Real> before(faces[0], faces[1], ContactPotentialScale(options.cosOpposed));
    EnergyDensity<Real> density;
    press(before, from, density);
    return before.moments.volume > 0 ? before.lostBy(from, to, density) : 0;
  }

  /// Energy of the pair where the faces are now [J].
  KOKKOS_INLINE_FUNCTION Real energyNow(const UnevenCrushing& crushing) const
  {
    PairPotential<Dim, Real> now(a, b, ContactPotentialScale(options.cosOpposed));
    EnergyDensity<Real> density;
    const Real stored = press(now, crushing, density);
    return now.materialArea * now.opposedness * stored;
  }

  /// @returns the energy without gamma and phi [J]; none where the faces are apart
  KOKKOS_INLINE_FUNCTION Real press(PairPotential<Dim, Real>& other, const UnevenCrushing& crushing,
                                    EnergyDensity<Real>& density) const
  {
    if (!other.plane.opposed)
      return 0;
    other.beCrushed(crushing);
    other.meet(plane.offset, false, edges);
    if (!(other.moments.volume > 0))
      return 0;
    other.growFrom(plane.birthArea[0], plane.birthArea[1]);
    return other.press(stiffness, 0, density);
  }

  KOKKOS_INLINE_FUNCTION HalfStepFace faceBefore(const HalfStepFace& face) const
  {
    FaceNodes nodes;
    nodes.count = face.count;
    for (int i = 0; i < face.count; ++i)
      nodes.x[i] = face.x[i] - dt * face.v[i];
    return stepA_faceAtEnd<Dim>(nodes);
  }
};
} // namespace coplane::detail
