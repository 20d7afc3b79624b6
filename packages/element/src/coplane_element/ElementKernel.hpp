#pragma once

#include <coplane_element/AssumedStrain.hpp>
#include <coplane_element/ElementKernelData.hpp>
#include <coplane_element/HourglassReturn.hpp>
#include <coplane_element/ObjectiveRate.hpp>
#include <coplane_element/OnePointStep.hpp>
#include <coplane_element/VolumeDrift.hpp>

namespace coplane
{
/// One batch of laneCount elements with one point: everything from positions to corner forces in
/// one pass.
/// Law: one of the laws itself, or LawFunction for any. revolved: a body of revolution.
template <ElementType type, class Law, bool revolved = false>
struct ElementKernel
{
  using Shape = OnePointShape<type, revolved>;
  using M = Modes<type>;
  using Hoop = typename Shape::Hoop;
  static constexpr int dim = M::dimension;
  static constexpr int nodes = M::nodes;
  static constexpr bool hasHourglass = Shape::hasHourglass;
  static constexpr int gradients = Shape::gradients;
  /// One vector per hourglass mode; an unused one where the strain sees every deformation.
  using HourglassVectors = Lanes[hasHourglass ? M::hourglass : 1][dim];
  /// Rings of assumed strain have forces on the two hoop slopes (AssumedStrain.hpp).
  static constexpr bool hasHoopSlopes = revolved && hasHourglass;

  ElementKernelData data;
  Law law;

  // Not inlined: both back ends call the same machine code.
  [[gnu::noinline]] void operator()(const int batch) const
  {
    const int first = batch * laneCount;
    Lanes x[dim][M::count], v[dim][M::count];
    Radial radial;
    gatherModes<M>(data.connectivity, data.x, first, x, revolved ? &radial.position : nullptr);
    gatherModes<M>(data.connectivity, data.v, first, v, revolved ? &radial.velocity : nullptr);

    HourglassVectors hourglass;
    for (int a = 0; a < M::hourglass; ++a)
      for (int i = 0; i < dim; ++i)
        hourglass[a][i] = load(&data.hourglassForce(a * dim + i, first));

    Lanes hoopForce[2] = {Lanes(0.0), Lanes(0.0)};
    const bool onSlopes = hasHoopSlopes && data.options.form == ElementForm::AssumedStrain;
    if (onSlopes)
      for (int k = 0; k < 2; ++k)
        hoopForce[k] = load(&data.hourglassForce(dim + k, first));

    SymTensorOf<Lanes> stress = loadTensor<dim>(data.stress, 0, first);
    const Lanes oldViscousPressure = load(&data.compression(1, first));
    Lanes b[dim][gradients];
    Hoop hoop;
    const Lanes volume = Shape::volumeGradient(x, radial.position, b, hoop);
    const Lanes inverseVolume = Lanes(1.0) / volume;
    const Lanes mass = load(&data.mass(first));
    const Lanes rho = mass * inverseVolume;
    const Lanes length =
        characteristicLength<dim>(data, revolved ? Shape::areaOf(hoop) : volume, first);
    const bool nodal = !hasHourglass && data.options.form == ElementForm::NodalPressure;
    VolumeDrift drift;
    if (nodal)
      drift = driftOf(load(&data.volume(first)), first);
    Motion motion{};
    MaterialPoint<Lanes> point;
    if (data.dt > 0)
    {
      findMotion(x, v, radial, motion, point);
      if (nodal)
        takeNodalDilatation(first, point);
      const SymTensorOf<Lanes>& de = point.strainIncrement;
      store(branchFree::positivePart(-(de.xx + de.yy + de.zz) / Lanes(data.dt)),
            &data.compression(0, first));
    }
    const Lanes lr = length * load(&data.compression(0, first));
    const Lanes b1c = Lanes(data.viscosity.linear * data.soundSpeed);
    const Lanes b2lr = Lanes(data.viscosity.quadratic) * lr;
    const Lanes viscousPressure = rho * lr * (b1c + b2lr);
    store(viscousPressure, &data.compression(1, first));
    store(volume, &data.volume(first));
    if (data.dt > 0)
    {
      addTo(data.energies, ElementEnergy::Viscous, first,
            Lanes(-0.5) * (oldViscousPressure + viscousPressure) * motion.dilatation);
      advance(first, v, motion, volume, length, point, stress, hourglass, hoopForce);
    }
    Lanes ownPressure = viscousPressure;
    if (nodal)
    {
      const Lanes oldPressure = drift.pressure;
      drift = driftOf(volume, first);
      ownPressure += drift.pressure;
      if (data.dt > 0)
        addTo(data.energies, ElementEnergy::Hourglass, first,
              Lanes(-0.5) * (oldPressure + drift.pressure) * motion.dilatation);
    }

    if (data.hourglass.viscosity > 0)
      for (int a = 0; a < M::hourglass; ++a)
        for (int i = 0; i < dim; ++i)
          hourglass[a][i] += load(&data.hourglassViscousForce(a * dim + i, first));

    const LaneMask finite = storeCornerForces(first, x, radial.position, b, hoop, stress,
                                              ownPressure, hourglass, hoopForce, inverseVolume);

    // Tangent of the viscous pressure over the rate of compression, per density.
    const Lanes viscosity = length * (b1c + Lanes(2.0) * b2lr);
    const Lanes stiffening = load(&data.tangent(0, first)) + drift.stiffening;
    Lanes step;
    if constexpr (revolved)
      step = OnePointStep<type, revolved>{data}.ofRing(first, x, radial.position, b, hoop, volume,
                                                       viscosity, stiffening);
    else
      step = OnePointStep<type, revolved>{data}.of(x, b, inverseVolume, rho, viscosity, stiffening);
    const LaneMask good = finite && volume > Lanes(0.0) && step > Lanes(0.0);
    store(choose(good, step, Lanes(0.0)), &data.stableStep(first));
  }

private:
  void addTo(const Table<Real>& energies, ElementEnergy kind, int first, const Lanes& amount) const
  {
    Real* const where = &energies(int(kind), first);
    store(load(where) + amount, where);
  }

  /// Means over the corners of the radius and of the radial velocity.
  struct Radial
  {
    Lanes position, velocity;
  };
  /// The motion from n to n + 1, seen from the positions in its middle.
  struct Motion
  {
    Lanes middle[dim][M::count]; ///< modes of the positions
    Lanes volume = Lanes(0.0);
    Lanes radius = Lanes(0.0), radialVelocity = Lanes(0.0); ///< of rings: means over the corners
    Lanes dilatation = Lanes(0.0);                          ///< tr(D) dt V at n + 1/2
    Lanes traceG = Lanes(0.0); ///< sum of b_jI^2 over nodes and axes [1/m^2]
    SymTensorOf<Lanes> strain; ///< D dt of the element's own motion, on which its forces work
  };

  void findMotion(const Lanes (&x)[dim][M::count], const Lanes (&v)[dim][M::count],
                  const Radial& radial, Motion& motion, MaterialPoint<Lanes>& point) const
  {
    const Lanes dt(data.dt), half(0.5), quarter(0.25);
    Lanes b[dim][gradients];
    Hoop hoop;
    for (int i = 0; i < dim; ++i)
      for (int k = 0; k < M::count; ++k)
        motion.middle[i][k] = x[i][k] - half * dt * v[i][k];
    if constexpr (revolved)
    {
      motion.radius = radial.position - half * dt * radial.velocity;
      motion.radialVelocity = radial.velocity;
    }
    motion.volume = Shape::volumeGradient(motion.middle, motion.radius, b, hoop);
    const Lanes inverseVolume = Lanes(1.0) / motion.volume;

    // L_ij dt = dt sum_I v_iI b_jI
    const Lanes factor = Lanes(nodes) * inverseVolume * dt;
    Mat3Of<Lanes>& l = point.displacementGradient;
    if constexpr (dim == 2)
      for (int i = 0; i < 3; ++i)
        l(i, 2) = l(2, i) = Lanes(0.0);
    Lanes squares(0.0);
    for (int j = 0; j < dim; ++j)
    {
      for (int i = 0; i < dim; ++i)
      {
        Lanes sum = v[i][0] * b[j][0];
#pragma GCC unroll 8
        for (int k = 1; k < gradients; ++k)
          sum += v[i][k] * b[j][k];
        l(i, j) = sum * factor;
      }
#pragma GCC unroll 8
      for (int k = 0; k < gradients; ++k)
        squares += b[j][k] * b[j][k];
    }
    if constexpr (revolved)
    {
      Lanes sum = radial.velocity * hoop[gradients];
      for (int k = 0; k < gradients; ++k)
        sum += v[0][k] * hoop[k];
      l(2, 2) = sum * factor;
    }
    motion.traceG = Lanes(nodes) * squares * inverseVolume * inverseVolume;

    SymTensorOf<Lanes>& de = point.strainIncrement;
    de.xx = l(0, 0);
    de.yy = l(1, 1);
    de.xy = half * (l(0, 1) + l(1, 0));
    de.zz = revolved ? l(2, 2) : Lanes(0.0);
    de.yz = de.zx = Lanes(0.0);
    Mat3Of<Lanes>& r = point.rotation;
    if constexpr (dim == 3)
    {
      de.zz = l(2, 2);
      de.yz = half * (l(1, 2) + l(2, 1));
      de.zx = half * (l(2, 0) + l(0, 2));
      r = hughesWinget(Vec3Of<Lanes>{quarter * (l(2, 1) - l(1, 2)), quarter * (l(0, 2) - l(2, 0)),
                                     quarter * (l(1, 0) - l(0, 1))});
    }
    else
    {
      const Lanes a = quarter * (l(1, 0) - l(0, 1));
      const Lanes f = Lanes(2.0) / (Lanes(1.0) + a * a);
      const Lanes cosine = Lanes(1.0) - f * a * a, sine = f * a, zero(0.0);
      r = {{{cosine, -sine, zero}, {sine, cosine, zero}, {zero, zero, Lanes(1.0)}}};
    }
    motion.dilatation = (de.xx + de.yy + de.zz) * motion.volume;
    motion.strain = de;
  }

  VolumeDrift driftOf(const Lanes& volume, int first) const
  {
    const Lanes own = volume / load(&data.referenceVolume(first));
    return volumeDrift(own / load(&data.volumeRatio(0, first)),
                       data.lambda + 2.0 / 3.0 * data.shearModulus);
  }

  /// Replaces the dilatation of the step by the mean of those at the corners.
  void takeNodalDilatation(int first, MaterialPoint<Lanes>& point) const
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
    for (int i = 0; i < 3; ++i)
      point.displacementGradient(i, i) += change;
    const Lanes start = load(&data.volumeRatio(0, first));
    point.halfVolumeRatio = start / (Lanes(1.0) - Lanes(0.5) * mean);
    point.volumeRatio = point.halfVolumeRatio * (Lanes(1.0) + Lanes(0.5) * mean);
    store(point.volumeRatio, &data.volumeRatio(0, first));
  }

  /// The rotation of the step, where it is not that of Hughes and Winget, and the stress turned.
  void turn(int first, const SymTensorOf<Lanes>& stress, MaterialPoint<Lanes>& point) const
  {
    if (data.options.rate == ObjectiveRate::Jaumann)
    {
      point.stress = turnedFirstOrder(stress, point.displacementGradient);
      return;
    }
    Mat3Of<Lanes> f;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        f(i, j) = i < dim && j < dim ? load(&data.deformation(dim * i + j, first))
                                     : Lanes(i == j ? 1.0 : 0.0);
    greenNaghdi<dim>(point.displacementGradient, f, point.rotation, point.strainIncrement);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        store(f(i, j), &data.deformation(dim * i + j, first));
    point.stress = rotated(stress, point.rotation);
  }

  /// Stress, history, hourglass forces and energies from n to n + 1, with the rates at n + 1/2.
  /// @param volume at n + 1; `length` of the element
  void advance(int first, const Lanes (&v)[dim][M::count], const Motion& motion,
               const Lanes& volume, const Lanes& length, MaterialPoint<Lanes>& point,
               SymTensorOf<Lanes>& stress, HourglassVectors& hourglass, Lanes (&hoopForce)[2]) const
  {
    const Mat3Of<Lanes>& r = point.rotation;
    const bool byDefault = data.options.rate == ObjectiveRate::HughesWinget;
    if (!byDefault)
      turn(first, stress, point);
    HourglassVectors oldHourglass;
    for (int a = 0; a < M::hourglass; ++a)
      for (int i = 0; i < dim; ++i)
        oldHourglass[a][i] = hourglass[a][i];

    point.dt = data.dt;
    if (law.usesVolume)
    {
      const Lanes inverseReference = Lanes(1.0) / load(&data.referenceVolume(first));
      if (hasHourglass || data.options.form != ElementForm::NodalPressure)
      {
        point.volumeRatio = volume * inverseReference;
        point.halfVolumeRatio = motion.volume * inverseReference;
      }
      point.energy = (load(&data.energies(int(ElementEnergy::Internal), first)) +
                      load(&data.energies(int(ElementEnergy::Viscous), first))) *
                     inverseReference;
      point.size = length;
    }
    point.oldStress = stress;
    if constexpr (dim == 3)
    {
      if (byDefault)
      {
        point.stress = rotated(stress, r);
        point.strainIncrement = turnedToEnd(point.strainIncrement, r);
      }
      for (int a = 0; a < M::hourglass; ++a)
        for (int i = 0; i < 3; ++i)
          hourglass[a][i] = r.a[i][0] * oldHourglass[a][0] + r.a[i][1] * oldHourglass[a][1] +
                            r.a[i][2] * oldHourglass[a][2];
    }
    else
    {
      const Lanes cosine = r(0, 0), sine = r(1, 0);
      if (byDefault)
      {
        point.stress = rotatedInPlane(stress, cosine, sine);
        point.strainIncrement = turnedToEndInPlane(point.strainIncrement, sine);
      }
      for (int h = 0; h < M::hourglass; ++h)
      {
        hourglass[h][0] = cosine * oldHourglass[h][0] - sine * oldHourglass[h][1];
        hourglass[h][1] = sine * oldHourglass[h][0] + cosine * oldHourglass[h][1];
      }
    }
    for (int k = 0; k < law.historyCount; ++k)
      point.history[k] = load(&data.history(k, first));
    HourglassStep step;
    if constexpr (hasHourglass)
    {
      const Lanes before = law.hasStrength ? bendingOf(motion, hourglass, hoopForce) : Lanes(0.0);
      step = tryHourglass(first, motion, point, v, hourglass, hoopForce);
      if (law.hasStrength)
        point.bendingSquared =
            aboveFloor(before, bendingOf(motion, hourglass, hoopForce), step.floor);
    }
    law(point);
    for (int k = 0; k < law.historyCount; ++k)
      store(point.history[k], &data.history(k, first));
    storeTensor<dim>(point.stress, data.stress, 0, first);

    stress = point.stress;
    const Lanes work = twiceWork(point.oldStress, stress, motion.strain);
    addTo(data.energies, ElementEnergy::Internal, first, Lanes(0.5) * motion.volume * work);
    addTo(data.energies, ElementEnergy::PlasticDissipation, first,
          motion.volume * point.dissipation);

    if constexpr (hasHourglass)
      settleHourglass(first, motion, point, step, oldHourglass, hourglass, hoopForce);
    if (law.changesTangent)
    {
      store(point.stiffening, &data.tangent(0, first));
      store(point.integrity, &data.tangent(1, first));
    }
  }

  /// Increments of the amplitudes of the modes, q dt [m], and of the hoop slopes of a ring.
  struct HourglassStep
  {
    HourglassVectors increment;
    Lanes slopes[2] = {Lanes(0.0), Lanes(0.0)};
    Lanes stiffness = Lanes(1.0); ///< that the law had left at the start, over the elastic one
    Lanes floor = Lanes(0.0);     ///< what of the bending the law is not told [Pa]
  };

  /// Elastic step of hourglass forces that have turned with the element.
  HourglassStep tryHourglass(int first, const Motion& motion, const MaterialPoint<Lanes>& point,
                             const Lanes (&v)[dim][M::count], HourglassVectors& hourglass,
                             Lanes (&hoopForce)[2]) const
  {
    const Lanes dt(data.dt);
    const bool assumedStrain = data.options.form == ElementForm::AssumedStrain;
    HourglassStep step;
    if (law.changesTangent)
      step.stiffness = load(&data.tangent(1, first));
    // Hourglass rates q_ia = gamma_aI v_iI with gamma_aI = (h_aI - (h_a.x_j) b_jI) / n.
    const Lanes stiffness = step.stiffness *
                            Lanes(nodes * data.hourglass.stiffness * data.pWaveModulus) *
                            motion.volume * motion.traceG;
    for (int a = 0; a < M::hourglass; ++a)
      for (int i = 0; i < dim; ++i)
      {
        Lanes sum = dt * v[i][dim + a];
        for (int j = 0; j < dim; ++j)
          sum -= motion.middle[j][dim + a] * point.displacementGradient(i, j);
        step.increment[a][i] = sum;
        if (!assumedStrain)
          hourglass[a][i] += stiffness * sum;
      }
    if (assumedStrain)
    {
      HourglassVectors forces;
      const AssumedStrainModuli moduli(data.lambda, data.shearModulus);
      const BrickFrame<Lanes> frame = brickFrame<dim>(motion.middle);
      if constexpr (revolved)
      {
        Lanes onSlopes[2];
        hoopSlopes(motion.middle[0], motion.radius, v[0], motion.radialVelocity, step.slopes);
        for (Lanes& slope : step.slopes)
          slope *= dt;
        assumedStrainForcesOfRing(frame, moduli, motion.volume, motion.radius, step.increment,
                                  step.slopes, forces, onSlopes);
        for (int k = 0; k < 2; ++k)
          hoopForce[k] += step.stiffness * onSlopes[k];
      }
      else
        assumedStrainForces(frame, moduli, motion.volume, step.increment, forces);
      for (int a = 0; a < M::hourglass; ++a)
        for (int i = 0; i < dim; ++i)
          hourglass[a][i] += step.stiffness * forces[a][i];
    }
    return step;
  }

  static Lanes bendingOf(const Motion& motion, const HourglassVectors& hourglass,
                         const Lanes (&hoopForce)[2])
  {
    if constexpr (revolved)
      return bendingSquaredOfRing(motion.middle, motion.volume, hourglass, hoopForce);
    else
      return bendingSquared(motion.middle, motion.volume, hourglass);
  }

  /// What flow and damage leave of the forces, their work, and what of it is lost.
  void settleHourglass(int first, const Motion& motion, const MaterialPoint<Lanes>& point,
                       const HourglassStep& step, const HourglassVectors& oldHourglass,
                       HourglassVectors& hourglass, Lanes (&hoopForce)[2]) const
  {
    const Lanes half(0.5);
    const bool onSlopes = hasHoopSlopes && data.options.form == ElementForm::AssumedStrain;
    Lanes oldHoopForce[2] = {Lanes(0.0), Lanes(0.0)};
    if (onSlopes)
      for (int k = 0; k < 2; ++k)
        oldHoopForce[k] = load(&data.hourglassForce(dim + k, first));
    const Lanes before = half * workOf(oldHourglass, step.increment, oldHoopForce, step.slopes);
    const Lanes after = half * workOf(hourglass, step.increment, hoopForce, step.slopes);
    Lanes work = before + after;
    if (law.hasStrength || law.changesTangent)
    {
      // Forces store their square, whatever their stiffness; damage takes stiffness with them.
      Lanes flow(1.0), damage(1.0);
      if (law.hasStrength)
        flow = keptAtLeast(point.bendingScale, point.bendingSquared, step.floor);
      if (law.changesTangent)
        damage = point.integrity / step.stiffness;
      const Lanes kept = flow * damage;
      for (int a = 0; a < M::hourglass; ++a)
        for (int i = 0; i < dim; ++i)
          hourglass[a][i] *= kept;
      if (hasHoopSlopes)
        for (Lanes& force : hoopForce)
          force *= kept;
      Real* const stored = &data.energies(int(ElementEnergy::HourglassElastic), first);
      const Lanes old = load(stored);
      const Lanes left = branchFree::positivePart((old + work) * flow * kept);
      work = before + kept * after;
      const Lanes lost = branchFree::choose(kept < Lanes(1.0), work - (left - old), Lanes(0.0));
      store(left, stored);
      for (const ElementEnergy kind : {ElementEnergy::Internal, ElementEnergy::PlasticDissipation,
                                       ElementEnergy::PlasticBending})
        addTo(data.energies, kind, first, lost);
      addTo(data.energies, ElementEnergy::Hourglass, first, -lost);
    }
    for (int a = 0; a < M::hourglass; ++a)
      for (int i = 0; i < dim; ++i)
        store(hourglass[a][i], &data.hourglassForce(a * dim + i, first));
    if (onSlopes)
      for (int k = 0; k < 2; ++k)
        store(hoopForce[k], &data.hourglassForce(dim + k, first));
    if (data.hourglass.viscosity > 0)
      work += half * advanceHourglassViscosity(first, motion.traceG, motion.volume, step.increment);
    addTo(data.energies, ElementEnergy::Hourglass, first, work);
  }

  // Material that bears nothing still resists bending a little, so that modes do not run free.
  // Where an element has no more than twice that, the law is told of what comes to it alone:
  // bending at the floor would flow again in every step, at rest too.

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

  /// Least strength of bending over the shear modulus.
  static constexpr Real leastStrength = 1e-5;

  static Lanes workOf(const HourglassVectors& hourglass, const HourglassVectors& increment,
                      const Lanes (&hoopForce)[2], const Lanes (&slopes)[2])
  {
    Lanes work(0.0);
    for (int a = 0; a < M::hourglass; ++a)
      for (int i = 0; i < dim; ++i)
        work += hourglass[a][i] * increment[a][i];
    if (hasHoopSlopes)
      work += hoopForce[0] * slopes[0] + hoopForce[1] * slopes[1];
    return work;
  }

  /// Viscous hourglass forces of the step, and twice their work.
  Lanes advanceHourglassViscosity(int first, const Lanes& traceG, const Lanes& volume,
                                  const HourglassVectors& increment) const
  {
    const Lanes mass = load(&data.mass(first));
    const Lanes omega = stdx::sqrt(Lanes(nodes * data.pWaveModulus) * volume / mass * traceG);
    const Lanes coefficient =
        Lanes(2.0 * data.hourglass.viscosity / data.dt) * mass * omega; // per q dt
    Lanes work(0.0);
    for (int a = 0; a < M::hourglass; ++a)
      for (int i = 0; i < dim; ++i)
      {
        Real* const where = &data.hourglassViscousForce(a * dim + i, first);
        const Lanes now = coefficient * increment[a][i];
        work += (load(where) + now) * increment[a][i];
        store(now, where);
      }
    return work;
  }

  /// Force on node I: -(sigma_ij - q delta_ij) B_jI - sum_a Q_ia gamma_aI V^0, the second part with
  /// gamma at x^(n+1).
  LaneMask storeCornerForces(int first, const Lanes (&x)[dim][M::count], const Lanes& radius,
                             const Lanes (&b)[dim][gradients], const Hoop& hoop,
                             const SymTensorOf<Lanes>& stress, const Lanes& ownPressure,
                             const HourglassVectors& hourglass, const Lanes (&hoopForce)[2],
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
    const Lanes around = stress.zz - ownPressure;
    Real force[dim][nodes][laneCount];
    Lanes all = revolved ? around : Lanes(0.0);
    for (int i = 0; i < dim; ++i)
    {
      // The part of gamma along b joins the stress, the part along h adds to its own mode.
      if constexpr (hasHourglass)
        for (int j = 0; j < dim; ++j)
        {
          Lanes sum = hourglass[0][i] * x[j][dim];
#pragma GCC unroll 4
          for (int a = 1; a < M::hourglass; ++a)
            sum += hourglass[a][i] * x[j][dim + a];
          s[i][j] -= sum * inverseVolume;
        }
      Lanes modes[M::count];
#pragma GCC unroll 8
      for (int k = 0; k < M::count; ++k)
      {
        modes[k] = Lanes(0.0);
        if (k < gradients)
          for (int j = 0; j < dim; ++j)
            modes[k] -= s[i][j] * b[j][k];
        if (hasHourglass && k >= dim)
          modes[k] -= Lanes(1.0 / nodes) * hourglass[k - dim][i];
        if (revolved && i == 0 && k < gradients)
          modes[k] -= around * hoop[revolved ? k : 0];
        all += modes[k];
      }
      Lanes mean(0.0);
      if constexpr (hasHoopSlopes)
        if (i == 0 && data.options.form == ElementForm::AssumedStrain)
        {
          const Lanes part = Lanes(1.0 / nodes) / radius;
          for (int k = 0; k < 2; ++k)
          {
            modes[k] -= part * hoopForce[k];
            mean += part * hoopForce[k] * x[0][k] / radius;
          }
          all += mean;
        }
      Lanes corners[nodes];
      M::toCorners(modes, corners);
      if (revolved && i == 0)
      {
        mean -= around * hoop[revolved ? gradients : 0];
        for (int c = 0; c < nodes; ++c)
          corners[c] += mean;
      }
#pragma GCC unroll 8
      for (int c = 0; c < nodes; ++c)
        store(corners[c], force[i][c]);
    }
    storeForces<M>(data, first, force);
    return all * Lanes(0.0) == Lanes(0.0);
  }
};

/// Runs a kernel over all batches: the commonest laws become part of it; the others are called
/// once per batch.
template <template <class> class Kernel>
void runWithLaw(const ElementKernelData& data)
{
  const auto run = [&](const auto& law)
  {
    using Law = std::decay_t<decltype(law)>;
    parallelFor("coplane::element::update", data.batches, Kernel<Law>{data, law});
  };
  if (const auto* elastic = std::get_if<LinearElastic>(data.material))
    run(*elastic);
  else if (const auto* j2 = std::get_if<J2Plasticity>(data.material))
    run(*j2);
  else
    run(lawFunction(*data.material));
}
} // namespace coplane
