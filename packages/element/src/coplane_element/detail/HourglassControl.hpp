#pragma once

#include <coplane_element/detail/AssumedStrain.hpp>
#include <coplane_element/detail/HourglassReturn.hpp>
#include <coplane_element/detail/MeanMotion.hpp>

namespace coplane
{
/// Forces on the hourglass modes of a batch: an elastic step, the return with the law, energies.
template <ElementType type, Geometry geometry, class Law>
struct HourglassControl
{
  using Shape = ElementShape<type, geometry>;
  using M = Modes<type>;
  using Field = typename Shape::Field;
  using Motion = MeanMotion<type, geometry>;
  static constexpr int dim = M::dimension;
  static constexpr int nodes = M::nodes;
  static constexpr int count = M::hourglass;
  /// Rings of assumed strain have forces on the two hoop slopes (AssumedStrain.hpp).
  static constexpr bool canHaveHoopSlopes = Shape::revolved && Shape::hasHourglass;

  /// Forces on modes [N] and on hoop slopes [N m], or increments of the amplitudes of the modes,
  /// q dt [m], and of the slopes [-]. Unused where the strain sees every deformation.
  struct Vectors
  {
    Lanes mode[count > 0 ? count : 1][dim];
    Lanes hoop[2] = {Lanes(0.0), Lanes(0.0)};
  };

  /// An elastic step on the way.
  struct Step
  {
    Vectors increment;
    Lanes stiffness = Lanes(1.0); ///< that the law had left at the start, over the elastic one
    Lanes floor = Lanes(0.0);     ///< what of the bending the law is not told [Pa]
  };

  const ElementKernelData& data;
  const Law& law;

  bool hasHoopSlopes() const
  {
    return canHaveHoopSlopes && data.options.form == ElementForm::AssumedStrain;
  }

  KOKKOS_FORCEINLINE_FUNCTION Vectors loadForces(int first) const
  {
    Vectors force;
    for (int a = 0; a < count; ++a)
      for (int i = 0; i < dim; ++i)
        force.mode[a][i] = load(&data.hourglassForce(a * dim + i, first));
    if (hasHoopSlopes())
      for (int k = 0; k < 2; ++k)
        force.hoop[k] = load(&data.hourglassForce(dim + k, first));
    return force;
  }

  /// Turns the forces on modes with the element; `old` are the forces before.
  static KOKKOS_FORCEINLINE_FUNCTION void turn(const Mat3Of<Lanes>& r, Vectors& force, Vectors& old)
  {
    for (int k = 0; k < 2; ++k)
      old.hoop[k] = force.hoop[k];
    for (int a = 0; a < count; ++a)
    {
      for (int i = 0; i < dim; ++i)
        old.mode[a][i] = force.mode[a][i];
      const Lanes(&q)[dim] = old.mode[a];
      if constexpr (dim == 3)
        for (int i = 0; i < 3; ++i)
          force.mode[a][i] = r(i, 0) * q[0] + r(i, 1) * q[1] + r(i, 2) * q[2];
      else
      {
        const Lanes cosine = r(0, 0), sine = r(1, 0);
        force.mode[a][0] = cosine * q[0] - sine * q[1];
        force.mode[a][1] = sine * q[0] + cosine * q[1];
      }
    }
  }

  /// Elastic step of forces that have turned with the element; tells the law the bending.
  KOKKOS_FORCEINLINE_FUNCTION void advance(int first, const Motion& motion, const Field& v,
                                           MaterialPoint<Lanes>& point, Vectors& force,
                                           Step& step) const
  {
    const Lanes before = law.hasStrength ? bendingOf(motion, force) : Lanes(0.0);
    if (law.changesTangent)
      step.stiffness = load(&data.tangent(1, first));
    // Hourglass rates q_ia = gamma_aI v_iI with gamma_aI = (h_aI - (h_a.x_j) b_jI) / n.
    for (int a = 0; a < count; ++a)
      for (int i = 0; i < dim; ++i)
      {
        Lanes sum = Lanes(data.dt) * v.modes[i][dim + a];
        for (int j = 0; j < dim; ++j)
          sum -= motion.middle.modes[j][dim + a] * point.displacementGradient(i, j);
        step.increment.mode[a][i] = sum;
      }
    const Vectors added = data.options.form == ElementForm::AssumedStrain
                              ? assumedStrain(motion, v, step)
                              : byStiffness(motion, step);
    for (int a = 0; a < count; ++a)
      addTurnedToEnd(point.rotation, added.mode[a], force.mode[a]);
    if (hasHoopSlopes())
      for (int k = 0; k < 2; ++k)
        force.hoop[k] += added.hoop[k];
    if (law.hasStrength)
      point.bendingSquared = aboveFloor(before, bendingOf(motion, force), step.floor);
  }

  /// What flow and damage leave of the forces, their work, and what of it is lost.
  /// @param old forces at the start of the step, not turned
  void settle(int first, const Motion& motion, const MaterialPoint<Lanes>& point, const Step& step,
              const Vectors& old, Vectors& force) const
  {
    const Lanes half(0.5);
    const Lanes before = half * workOf(old, step.increment);
    const Lanes after = half * workOf(force, step.increment);
    Lanes work = before + after;
    if (law.hasStrength || law.changesTangent)
      work = keepWhatLawLeaves(first, point, step, before, after, force);
    for (int a = 0; a < count; ++a)
      for (int i = 0; i < dim; ++i)
        store(force.mode[a][i], &data.hourglassForce(a * dim + i, first));
    if (hasHoopSlopes())
      for (int k = 0; k < 2; ++k)
        store(force.hoop[k], &data.hourglassForce(dim + k, first));
    if (data.hourglass.viscosity > 0)
      work += half * advanceViscosity(first, motion, step.increment);
    addTo(data, ElementEnergy::Hourglass, first, work);
  }

  /// Viscous forces of the last step besides.
  KOKKOS_FORCEINLINE_FUNCTION void addViscousForces(int first, Vectors& force) const
  {
    if (data.hourglass.viscosity > 0)
      for (int a = 0; a < count; ++a)
        for (int i = 0; i < dim; ++i)
          force.mode[a][i] += load(&data.hourglassViscousForce(a * dim + i, first));
  }

private:
  /// By HourglassOptions::stiffness.
  KOKKOS_FORCEINLINE_FUNCTION Vectors byStiffness(const Motion& motion, const Step& step) const
  {
    Vectors added;
    const Lanes stiffness = step.stiffness *
                            Lanes(nodes * data.hourglass.stiffness * data.pWaveModulus) *
                            motion.volume * motion.traceG;
    for (int a = 0; a < count; ++a)
      for (int i = 0; i < dim; ++i)
        added.mode[a][i] = stiffness * step.increment.mode[a][i];
    return added;
  }

  /// Forces that amplitudes measured at the middle of the step make, at its end: f + (R - R^T) f /
  /// 4, as strain increments are turned. Not turned they would lag by half of the turn, and the
  /// vibrations of a body that spins would grow by a fifth of the spin.
  static KOKKOS_FORCEINLINE_FUNCTION void
  addTurnedToEnd(const Mat3Of<Lanes>& r, const Lanes (&added)[dim], Lanes (&force)[dim])
  {
    if constexpr (dim == 3)
    {
      const Lanes quarter(0.25);
      const Lanes x = quarter * (r(2, 1) - r(1, 2)), y = quarter * (r(0, 2) - r(2, 0)),
                  z = quarter * (r(1, 0) - r(0, 1));
      force[0] += added[0] + (y * added[2] - z * added[1]);
      force[1] += added[1] + (z * added[0] - x * added[2]);
      force[2] += added[2] + (x * added[1] - y * added[0]);
    }
    else
    {
      const Lanes half = Lanes(0.5) * r(1, 0);
      force[0] += added[0] - half * added[1];
      force[1] += added[1] + half * added[0];
    }
  }

  KOKKOS_FORCEINLINE_FUNCTION Vectors assumedStrain(const Motion& motion, const Field& v,
                                                    Step& step) const
  {
    Vectors added;
    const AssumedStrainModuli moduli(data.lambda, data.shearModulus);
    const BrickFrame<Lanes> frame = brickFrame<dim>(motion.middle.modes);
    if constexpr (Shape::revolved)
    {
      Lanes(&slopes)[2] = step.increment.hoop;
      hoopSlopes(motion.middle.modes[0], motion.middle.mean, v.modes[0], v.mean, slopes);
      for (Lanes& slope : slopes)
        slope *= Lanes(data.dt);
      assumedStrainForcesOfRing(frame, moduli, motion.volume, motion.middle.mean,
                                step.increment.mode, slopes, added.mode, added.hoop);
      for (Lanes& hoop : added.hoop)
        hoop *= step.stiffness;
    }
    else
      assumedStrainForces(frame, moduli, motion.volume, step.increment.mode, added.mode);
    for (int a = 0; a < count; ++a)
      for (int i = 0; i < dim; ++i)
        added.mode[a][i] *= step.stiffness;
    return added;
  }

  static KOKKOS_FORCEINLINE_FUNCTION Lanes bendingOf(const Motion& motion, const Vectors& force)
  {
    if constexpr (Shape::revolved)
      return bendingSquaredOfRing(motion.middle.modes, motion.volume, force.mode, force.hoop);
    else
      return bendingSquared(motion.middle.modes, motion.volume, force.mode);
  }

  /// Forces store their square, whatever their stiffness; damage takes stiffness with them.
  /// @param before, after work of the old forces and of those after the elastic step [J]
  /// @return work of the step [J]
  Lanes keepWhatLawLeaves(int first, const MaterialPoint<Lanes>& point, const Step& step,
                          const Lanes& before, const Lanes& after, Vectors& force) const
  {
    Lanes flow(1.0), damage(1.0);
    if (law.hasStrength)
      flow = keptAtLeast(point.bendingScale, point.bendingSquared, step.floor);
    if (law.changesTangent)
      damage = point.integrity / step.stiffness;
    const Lanes kept = flow * damage;
    for (int a = 0; a < count; ++a)
      for (int i = 0; i < dim; ++i)
        force.mode[a][i] *= kept;
    if constexpr (canHaveHoopSlopes)
      for (Lanes& hoop : force.hoop)
        hoop *= kept;
    Real* const stored = &data.energies(int(ElementEnergy::HourglassElastic), first);
    const Lanes old = load(stored);
    const Lanes left = branchFree::positivePart((old + (before + after)) * flow * kept);
    const Lanes work = before + kept * after;
    const Lanes lost = branchFree::choose(kept < Lanes(1.0), work - (left - old), Lanes(0.0));
    store(left, stored);
    for (const ElementEnergy kind : {ElementEnergy::Internal, ElementEnergy::PlasticDissipation,
                                     ElementEnergy::PlasticBending})
      addTo(data, kind, first, lost);
    addTo(data, ElementEnergy::Hourglass, first, -lost);
    return work;
  }

  // Material that bears nothing still resists bending a little, so that modes do not run free.
  // Where an element has no more than twice that, the law is told of what comes to it alone:
  // bending at the floor would flow again in every step, at rest too.

  /// Least strength of bending over the shear modulus.
  static constexpr Real leastStrength = 1e-5;

  /// The square of the bending that the law returns [Pa^2].
  /// @param before, trial squares of the bending before and after the elastic step [Pa^2]
  Lanes aboveFloor(const Lanes& before, const Lanes& trial, Lanes& floor) const
  {
    const Lanes least(leastStrength * data.shearModulus), zero(0.0);
    const auto atFloor = before < Lanes(4.0) * least * least;
    if (!branchFree::anyOf(atFloor))
      return trial;
    floor = branchFree::choose(atFloor, least, zero);
    const Lanes over = branchFree::positivePart(branchFree::squareRoot(trial) - least);
    return branchFree::choose(atFloor, over * over, trial);
  }

  /// The share of the bending that stays.
  Lanes keptAtLeast(const Lanes& kept, const Lanes& bendingSquared, const Lanes& floor) const
  {
    const Lanes least(leastStrength * data.shearModulus), one(1.0);
    const auto told = floor > Lanes(0.0);
    const auto falls = kept < one && (told || kept * kept * bendingSquared < least * least);
    if (!branchFree::anyOf(falls))
      return kept;
    const Lanes s = branchFree::squareRoot(branchFree::larger(bendingSquared, Lanes(0.0)));
    const Lanes ofAll = branchFree::larger(kept, least / branchFree::larger(s, least));
    return branchFree::choose(
        falls, branchFree::choose(told, (least + kept * s) / (least + s), ofAll), kept);
  }

  static KOKKOS_FORCEINLINE_FUNCTION Lanes workOf(const Vectors& force, const Vectors& increment)
  {
    Lanes work(0.0);
    for (int a = 0; a < count; ++a)
      for (int i = 0; i < dim; ++i)
        work += force.mode[a][i] * increment.mode[a][i];
    if (canHaveHoopSlopes)
      work += force.hoop[0] * increment.hoop[0] + force.hoop[1] * increment.hoop[1];
    return work;
  }

  /// Viscous forces of the step, and twice their work [J].
  Lanes advanceViscosity(int first, const Motion& motion, const Vectors& increment) const
  {
    const Lanes mass = load(&data.mass(first));
    const Lanes omega =
        stdx::sqrt(Lanes(nodes * data.pWaveModulus) * motion.volume / mass * motion.traceG);
    const Lanes coefficient =
        Lanes(2.0 * data.hourglass.viscosity / data.dt) * mass * omega; // per q dt
    Lanes work(0.0);
    for (int a = 0; a < count; ++a)
      for (int i = 0; i < dim; ++i)
      {
        Real* const where = &data.hourglassViscousForce(a * dim + i, first);
        const Lanes now = coefficient * increment.mode[a][i];
        work += (load(where) + now) * increment.mode[a][i];
        store(now, where);
      }
    return work;
  }
};
} // namespace coplane
