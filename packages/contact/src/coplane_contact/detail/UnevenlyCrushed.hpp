#pragma once

#include <coplane_contact/ContactPotential.hpp>
#include <coplane_contact/HalfStepFace.hpp>

// A joint without bond that is crushed as its faces are tilted (docs/theory/joints.md, "Uneven
// crushing").

namespace coplane::detail
{
/// What a cycle has done to such a joint.
struct CrushedFrom
{
  bool further = false;
  bool carried = false; ///< before the step
  LinearOnFace from;    ///< how it was crushed then
  Real offset = 0;      ///< of its plane then [m]
  Real parted = 0; ///< of what shear has crushed: what did not close it, but is in the offset [m]
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
    CrushedFrom result;
    result.carried = plane.area > 0;
    result.from = crushing(permanent);
    result.offset = plane.offset;
    const Real least =
        plane.crushedUnevenly ? law.onset(stiffness) : law.closureOf(permanent, stiffness);
    LinearOnFace to;
    if (pair.mostClosure + permanent > least && pair.crushFurther(law, stiffness, permanent, to))
    {
      result.further = crushTo(to);
      if (!result.further)
        beAsBefore(permanent);
    }
    if (plane.crushedUnevenly)
      permanent = pair.meanCrushing();
    return result;
  }

  /// The same for what shear crushes, all over, after the law: the force is that of the tractions
  /// that the law has brought back.
  /// @param permanent as crush() leaves it [m]
  /// @param more crushing [m]
  /// @param parted what of it does not close the joint and is in the offset of the plane [m]
  KOKKOS_INLINE_FUNCTION void crushByShear(CrushedFrom& crushed, Real permanent, Real more,
                                           Real parted) const
  {
    LinearOnFace to = crushing(permanent);
    to.atCenter += more;
    if (crushTo(to.asKept()))
    {
      crushed.further = true;
      crushed.parted = parted;
    }
    else
    {
      plane.offset -= parted;
      beAsBefore(permanent);
    }
  }

  /// What it costs to crush the joint further [J]: by the trapezoid rule over the step, and no more
  /// than the energy falls by where the faces are now. That is less where the crushing rises by
  /// more than what is closed elastically, so that the tractions fall on the way.
  /// @param density, pressed of the pair now
  KOKKOS_INLINE_FUNCTION Real lost(const CrushedFrom& crushed, const EnergyDensity<Real>& density,
                                   Real pressed) const
  {
    const Real after = lostBy(pair, crushed, density);
    EnergyDensity<Real> other;
    Real before = 0;
    if (crushed.carried)
    {
      const HalfStepFace faces[2] = {placeBefore<Dim>(a, 0, dt), placeBefore<Dim>(b, 0, dt)};
      PairPotential<Dim, Real> then(faces[0], faces[1], ContactPotentialScale(options));
      press(then, crushed.from, crushed.offset, other);
      before = then.moments.volume > 0 ? lostBy(then, crushed, other) : 0;
    }
    PairPotential<Dim, Real> now(a, b, ContactPotentialScale(options));
    const Real most = press(now, crushed.from, plane.offset - crushed.parted, other) -
                      pair.materialArea * pair.opposedness * pressed;
    const Real byTractions = 0.5 * (before + after);
    return byTractions < most ? byTractions : most;
  }

private:
  /// @param even where it is not crushed unevenly yet [m]
  KOKKOS_INLINE_FUNCTION LinearOnFace crushing(Real even) const
  {
    return plane.crushedUnevenly ? plane.crushing() : LinearOnFace{even, {0, 0}};
  }

  /// @returns whether the joint carries then; else its plane stays as it is, but its pair does not
  KOKKOS_INLINE_FUNCTION bool crushTo(const LinearOnFace& to) const
  {
    pair.beCrushed(to);
    pair.meet(plane.offset, false, edges);
    const bool carries = pair.moments.volume > 0;
    if (carries)
      plane.crush(to);
    return carries;
  }

  /// @param even where it is not crushed unevenly yet [m]
  KOKKOS_INLINE_FUNCTION void beAsBefore(Real even) const
  {
    if (plane.crushedUnevenly)
      pair.beCrushed(plane.crushing());
    else
      pair.notCrushed();
    pair.meet(plane.crushedUnevenly ? plane.offset : plane.offset - even, false, edges);
  }

  /// What it costs with the tractions of a pair [J]. What has parted the faces of what shear has
  /// crushed gives back its work; where the joint is not crushed, that lifts it.
  KOKKOS_INLINE_FUNCTION Real lostBy(const PairPotential<Dim, Real>& other,
                                     const CrushedFrom& crushed,
                                     const EnergyDensity<Real>& density) const
  {
    const ContactMoments<Real>& m = other.moments;
    const Real force = 2 * density.square * m.volume + density.linear * m.area;
    return other.lostBy(crushed.from, plane.crushing(), density) -
           other.materialArea * other.opposedness * force * crushed.parted;
  }

  /// @param offset of the plane [m]
  /// @returns the energy of a pair [J]; none where the faces are apart
  KOKKOS_INLINE_FUNCTION Real press(PairPotential<Dim, Real>& other, const LinearOnFace& crushing,
                                    Real offset, EnergyDensity<Real>& density) const
  {
    if (!other.plane.opposed)
      return 0;
    if (plane.history.absorbedUnevenly)
      other.lay(true, plane.laid);
    other.beCrushed(crushing);
    other.meet(offset, false, edges);
    if (!(other.moments.volume > 0))
      return 0;
    const Real stored = other.press(stiffness, 0, density);
    other.growFrom(plane.birthArea[0], plane.birthArea[1]);
    return other.materialArea * other.opposedness * stored;
  }
};
} // namespace coplane::detail
