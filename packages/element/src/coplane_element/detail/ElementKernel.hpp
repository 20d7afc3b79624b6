#pragma once

#include <coplane_element/detail/HourglassControl.hpp>
#include <coplane_element/detail/OnePointStep.hpp>
#include <coplane_element/detail/PointStep.hpp>
#include <coplane_element/detail/RunWithLaw.hpp>
#include <coplane_element/detail/VolumeDrift.hpp>

namespace coplane
{
/// One batch of laneCount elements with one point: everything from positions to corner forces in
/// one pass.
/// Law: one of the laws itself, or LawFunction for any.
template <ElementType type, class Law, Geometry geometry = Geometry::PlaneStrain>
struct ElementKernel
{
  using Shape = ElementShape<type, geometry>;
  using M = Modes<type>;
  using Field = typename Shape::Field;
  using Gradient = typename Shape::Gradient;
  using Motion = MeanMotion<type, geometry>;
  using Hourglass = HourglassControl<type, geometry, Law>;
  using HourglassForces = typename Hourglass::Vectors;
  static constexpr int dim = M::dimension;
  static constexpr int nodes = M::nodes;
  static constexpr bool revolved = Shape::revolved;
  static constexpr bool hasHourglass = Shape::hasHourglass;
  static constexpr int gradients = Shape::gradients;

  ElementKernelData data;
  Law law;

  // Not inlined: both back ends call the same machine code. Its steps are inlined by force.
  [[gnu::noinline]] void operator()(const int batch) const
  {
    const int first = batch * laneCount;
    prefetchAhead(data, batch, nodes);
    Field x, v;
    Shape::gather(data, first, x, v);
    HourglassForces hourglass = Hourglass{data, law}.loadForces(first);
    SymTensorOf<Lanes> stress = loadTensor<dim>(data.stress, 0, first);
    const Gradient gradient = Shape::gradientAt(x);
    const Lanes inverseVolume = Lanes(1.0) / gradient.volume;
    const Lanes rho = load(&data.mass(first)) * inverseVolume;
    const Lanes length = Shape::lengthOf(data, gradient, first);
    VolumeDrift drift;
    if (hasNodalPressure())
      drift = driftOf(load(&data.volume(first)), first);
    Motion motion{};
    Lanes ownVolumeChange(0.0);
    MaterialPoint<Lanes> point;
    if (data.dt > 0)
    {
      motion.find(x, v, data.dt, point);
      ownVolumeChange = motion.volumeChange;
      if (hasNodalPressure())
        takeNodalDilatation(first, motion, point);
      const SymTensorOf<Lanes>& de = point.strainIncrement;
      storeCompressionRate(data, first, de.xx + de.yy + de.zz);
    }
    const ViscousPressure viscous = viscousPressure(data, first, rho, length);
    store(gradient.volume, &data.volume(first));
    if (data.dt > 0)
    {
      addTo(data, ElementEnergy::Viscous, first, viscous.workOver(motion.volumeChange));
      advance(first, v, motion, gradient.volume, length, point, stress, hourglass);
    }
    Lanes ownPressure = viscous.now;
    Lanes tension(0.0), share(1.0);
    if (hasNodalPressure())
    {
      drift = advanceDrift(first, drift, ownVolumeChange, motion.volumeChange);
      const Lanes own = load(&data.ownTension(0, first));
      if (data.dt > 0)
        addTo(data, ElementEnergy::Internal, first, own * (ownVolumeChange - motion.volumeChange));
      share =
          load(&data.referenceVolume(first)) * load(&data.volumeRatio(0, first)) * inverseVolume;
      tension =
          leaveToNodes(first, drift.tension - viscous.now - own, share * gradient.volume, stress);
      ownPressure = drift.pressure - own;
      scale(stress, share);
    }
    Hourglass{data, law}.addViscousForces(first, hourglass);
    const Lanes sum =
        storeCornerForces(first, x, gradient, stress, ownPressure, hourglass, inverseVolume) +
        tension;
    const Lanes stiffening =
        (load(&data.tangent(0, first)) + drift.stiffening) * branchFree::larger(share, Lanes(1.0));
    const Lanes step =
        OnePointStep<type, geometry>{data}.of(first, x, gradient, viscous.viscosity, stiffening);
    storeStep(data, first, step, gradient.volume > Lanes(0.0), sum);
  }

private:
  bool hasNodalPressure() const
  {
    return !hasHourglass && data.options.form == ElementForm::NodalPressure;
  }

  KOKKOS_FORCEINLINE_FUNCTION VolumeDrift driftOf(const Lanes& volume, int first) const
  {
    return volumeDrift(volume / load(&data.referenceVolume(first)),
                       load(&data.volumeRatio(0, first)),
                       data.lambda + 2.0 / 3.0 * data.shearModulus);
  }

  /// The drift at the end of the step, whose work is booked.
  /// @param own, nodal: change of the element's volume, and of that which its nodes give it [m^3]
  KOKKOS_FORCEINLINE_FUNCTION VolumeDrift advanceDrift(int first, const VolumeDrift& old,
                                                       const Lanes& own, const Lanes& nodal) const
  {
    const VolumeDrift now = driftOf(load(&data.volume(first)), first);
    if (data.dt > 0)
      addTo(data, ElementEnergy::Hourglass, first,
            Lanes(0.5) *
                ((old.tension + now.tension) * nodal - (old.pressure + now.pressure) * own));
    return now;
  }

  /// Takes the mean tension off the stress, which acts through the volumes that nodes give their
  /// elements: energies are functions of these (ElementBlock::addNodalTension). What an initial
  /// stress has of it stays with the element: that is in balance also where it changes with place.
  /// @param more of the tension; nodal: volume that the nodes give [m^3]
  /// @returns what is stored for the nodes [N m]
  KOKKOS_FORCEINLINE_FUNCTION Lanes leaveToNodes(int first, const Lanes& more, const Lanes& nodal,
                                                 SymTensorOf<Lanes>& stress) const
  {
    const Lanes mean = Lanes(1.0 / 3.0) * (stress.xx + stress.yy + stress.zz);
    for (Lanes* const along : {&stress.xx, &stress.yy, &stress.zz})
      *along -= mean;
    const Lanes tension = nodal * (mean + more);
    store(tension, &data.meanTension(0, first));
    return tension;
  }

  static KOKKOS_FORCEINLINE_FUNCTION void scale(SymTensorOf<Lanes>& tensor, const Lanes& by)
  {
    for (Lanes* const part :
         {&tensor.xx, &tensor.yy, &tensor.zz, &tensor.xy, &tensor.yz, &tensor.zx})
      *part *= by;
  }

  /// Replaces the dilatation of the step by the mean of those at the corners, and the volumes by
  /// those that the nodes give.
  KOKKOS_FORCEINLINE_FUNCTION void takeNodalDilatation(int first, Motion& motion,
                                                       MaterialPoint<Lanes>& point) const
  {
    const int* const node = &data.connectivity(first, 0);
    Lanes sum(0.0);
    for (int c = 0; c < nodes; ++c)
      sum += Lanes([&](auto lane) { return data.nodalDilatation(node[int(lane) * nodes + c]); });
    const Lanes mean = Lanes(1.0 / nodes) * sum;
    SymTensorOf<Lanes>& de = point.strainIncrement;
    const Lanes change = Lanes(1.0 / 3.0) * (mean - (de.xx + de.yy + de.zz));
    de.xx += change;
    de.yy += change;
    de.zz += change;
    for (Lanes* const own : {&motion.strain.xx, &motion.strain.yy, &motion.strain.zz})
      *own += change;
    for (int i = 0; i < 3; ++i)
      point.displacementGradient(i, i) += change;
    const Lanes start = load(&data.volumeRatio(0, first));
    point.halfVolumeRatio = start / (Lanes(1.0) - Lanes(0.5) * mean);
    point.volumeRatio = point.halfVolumeRatio * (Lanes(1.0) + Lanes(0.5) * mean);
    store(point.volumeRatio, &data.volumeRatio(0, first));
    const Lanes reference = load(&data.referenceVolume(first));
    motion.volume = reference * point.halfVolumeRatio;
    motion.volumeChange = motion.volume * mean; // no difference of ratios near 1
    store(mean, &data.volumeChanges(2, first));
  }

  /// Stress, history, hourglass forces and energies from n to n + 1, with the rates at n + 1/2.
  /// @param volume at n + 1; `length` of the element
  KOKKOS_FORCEINLINE_FUNCTION void advance(int first, const Field& v, const Motion& motion,
                                           const Lanes& volume, const Lanes& length,
                                           MaterialPoint<Lanes>& point, SymTensorOf<Lanes>& stress,
                                           HourglassForces& hourglass) const
  {
    const Hourglass control{data, law};
    point.dt = data.dt;
    point.oldStress = stress;
    turnStress(first, stress, point);
    if (law.usesVolume)
      findState(first, motion, volume, length, point);
    HourglassForces oldHourglass;
    typename Hourglass::Step step;
    if constexpr (hasHourglass)
    {
      Hourglass::turn(point.rotation, hourglass, oldHourglass);
      control.advance(first, motion, v, point, hourglass, step);
    }
    advancePoint<dim>(law, data.history, data.stress, 0, first, point);
    stress = point.stress;
    const Lanes work = twiceWork(point.oldStress, stress, motion.strain);
    addTo(data, ElementEnergy::Internal, first, Lanes(0.5) * motion.volume * work);
    addTo(data, ElementEnergy::PlasticDissipation, first, motion.volume * point.dissipation);
    if constexpr (hasHourglass)
      control.settle(first, motion, point, step, oldHourglass, hourglass);
    if (law.changesTangent)
    {
      store(point.stiffening, &data.tangent(0, first));
      store(point.integrity, &data.tangent(1, first));
    }
  }

  /// Hughes and Winget's rotation is about z in two dimensions.
  KOKKOS_FORCEINLINE_FUNCTION void turnStress(int first, const SymTensorOf<Lanes>& stress,
                                              MaterialPoint<Lanes>& point) const
  {
    if (data.options.rate != ObjectiveRate::HughesWinget)
      turnByOtherRate<dim>(data, first, 0, stress, point);
    else if constexpr (dim == 3)
      turnByHughesWinget(stress, point);
    else
    {
      const Lanes cosine = point.rotation(0, 0), sine = point.rotation(1, 0);
      assign(rotatedInPlane(stress, cosine, sine), point.stress);
      assign(turnedToEndInPlane(point.strainIncrement, sine), point.strainIncrement);
    }
  }

  /// Volumes, energy and size of the point; volumes of nodal pressure are known.
  KOKKOS_FORCEINLINE_FUNCTION void findState(int first, const Motion& motion, const Lanes& volume,
                                             const Lanes& length, MaterialPoint<Lanes>& point) const
  {
    const Lanes inverseReference = Lanes(1.0) / load(&data.referenceVolume(first));
    if (!hasNodalPressure())
    {
      point.volumeRatio = volume * inverseReference;
      point.halfVolumeRatio = motion.volume * inverseReference;
    }
    point.energy = (load(&data.energies(int(ElementEnergy::Internal), first)) +
                    load(&data.energies(int(ElementEnergy::Viscous), first))) *
                   inverseReference;
    point.size = length;
  }

  /// Force on node I: -(sigma_ij - q delta_ij) B_jI - sum_a Q_ia gamma_aI V^0, the second part with
  /// gamma at x^(n+1). Returns a sum of all forces, to see whether they are finite.
  KOKKOS_FORCEINLINE_FUNCTION Lanes storeCornerForces(int first, const Field& x, const Gradient& g,
                                                      const SymTensorOf<Lanes>& stress,
                                                      const Lanes& ownPressure,
                                                      const HourglassForces& hourglass,
                                                      const Lanes& inverseVolume) const
  {
    Lanes s[dim][dim];
    s[0][0] = stress.xx - ownPressure;
    s[1][1] = stress.yy - ownPressure;
    s[0][1] = s[1][0] = stress.xy;
    if constexpr (dim == 3)
    {
      s[2][2] = stress.zz - ownPressure;
      s[1][2] = s[2][1] = stress.yz;
      s[2][0] = s[0][2] = stress.zx;
    }
    if constexpr (hasHourglass)
      addHourglassAlongGradients(x, hourglass, inverseVolume, s);
    const Lanes around = stress.zz - ownPressure;
    Real force[dim][nodes][laneCount];
    Lanes all = revolved ? around : Lanes(0.0);
    for (int i = 0; i < dim; ++i)
    {
      Lanes modes[M::count];
      forceModes(i, g, s, around, hourglass, modes);
      for (int k = 0; k < M::count; ++k)
        all += modes[k];
      Lanes mean(0.0);
      if constexpr (revolved)
        if (i == 0)
        {
          mean = addHoopSlopes(x, hourglass, modes) - around * g.hoop[gradients];
          all += mean;
        }
      Lanes corners[nodes];
      M::toCorners(modes, corners);
      if (revolved && i == 0)
        for (int c = 0; c < nodes; ++c)
          corners[c] += mean;
#pragma GCC unroll 8
      for (int c = 0; c < nodes; ++c)
        store(corners[c], force[i][c]);
    }
    storeForces<M>(data, first, force);
    return all;
  }

  /// The part of gamma along b joins the stress, the part along h adds to its own mode.
  static KOKKOS_FORCEINLINE_FUNCTION void
  addHourglassAlongGradients(const Field& x, const HourglassForces& hourglass,
                             const Lanes& inverseVolume, Lanes (&s)[dim][dim])
  {
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
      {
        Lanes sum = hourglass.mode[0][i] * x.modes[j][dim];
#pragma GCC unroll 4
        for (int a = 1; a < M::hourglass; ++a)
          sum += hourglass.mode[a][i] * x.modes[j][dim + a];
        s[i][j] -= sum * inverseVolume;
      }
  }

  /// Modes of the forces along axis i.
  static KOKKOS_FORCEINLINE_FUNCTION void
  forceModes(int i, const Gradient& g, const Lanes (&s)[dim][dim], const Lanes& around,
             const HourglassForces& hourglass, Lanes (&modes)[M::count])
  {
#pragma GCC unroll 8
    for (int k = 0; k < M::count; ++k)
    {
      modes[k] = Lanes(0.0);
      if (k < gradients)
        for (int j = 0; j < dim; ++j)
          modes[k] -= s[i][j] * g.b[j][k];
      if (hasHourglass && k >= dim)
        modes[k] -= Lanes(1.0 / nodes) * hourglass.mode[k - dim][i];
      if (revolved && i == 0 && k < gradients)
        modes[k] -= around * g.hoop[revolved ? k : 0];
    }
  }

  /// Of rings: adds the forces on the hoop slopes to the modes along r, and returns the mean that
  /// belongs to them.
  KOKKOS_FORCEINLINE_FUNCTION Lanes addHoopSlopes(const Field& x, const HourglassForces& hourglass,
                                                  Lanes (&modes)[M::count]) const
  {
    Lanes mean(0.0);
    if (!Hourglass{data, law}.hasHoopSlopes())
      return mean;
    const Lanes part = Lanes(1.0 / nodes) / x.mean;
    for (int k = 0; k < 2; ++k)
    {
      modes[k] -= part * hourglass.hoop[k];
      mean += part * hourglass.hoop[k] * x.modes[0][k] / x.mean;
    }
    return mean;
  }
};
} // namespace coplane
