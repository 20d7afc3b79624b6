#pragma once

#include <coplane_element/StableStep.hpp>
#include <coplane_element/detail/Cofactors.hpp>
#include <coplane_element/detail/ElementShape.hpp>
#include <coplane_element/detail/GaussPoints.hpp>
#include <coplane_element/detail/PointStep.hpp>
#include <coplane_element/detail/RunWithLaw.hpp>

namespace coplane
{
/// One batch of fully integrated elements. With B-bar the dilatation is the mean one everywhere, so
/// that only the mean of the mean stresses does work on it: forces are those of the deviators at
/// the points and of that mean on the mean gradient. Forces of an element are written on modes that
/// have no mean and no rotation of a symmetric stress: no resultant, no moment.
///
/// Bodies of revolution: points have the weight 2 pi r, and the hoop strain u_r / r of their own;
/// the mean dilatation is that of the ring, and the mean of hoop forces is one of its own.
template <ElementType type, class Law, Geometry geometry = Geometry::PlaneStrain>
struct FullKernel
{
  using M = Modes<type>;
  using Points = GaussPoints<type>;
  using Shape = ElementShape<type, geometry>;
  using Field = typename Shape::Field;
  using Gradient = typename Shape::Gradient;
  static constexpr bool revolved = Shape::revolved;
  static constexpr int gradients = Shape::gradients;
  static constexpr int dim = M::dimension;
  static constexpr int nodes = M::nodes;

  ElementKernelData data;
  Law law;

  // Not inlined: both back ends call the same machine code.
  [[gnu::noinline]] void operator()(const int batch) const
  {
    const int first = batch * laneCount;
    prefetchAhead(data, batch, nodes);
    Field x, v;
    Shape::gather(data, first, x, v);
    const Gradient gradient = Shape::gradientAt(x);
    const Lanes inverseVolume = Lanes(1.0) / gradient.volume;
    const Lanes rho = load(&data.mass(first)) * inverseVolume;
    const Lanes length = Shape::lengthOf(data, gradient, first);
    Motion motion{};
    if (data.dt > 0)
    {
      findMotion(x, v, motion);
      storeCompressionRate(data, first, motion.dilatation);
    }
    const ViscousPressure viscous = viscousPressure(data, first, rho, length);
    store(gradient.volume, &data.volume(first));
    if (data.dt > 0)
    {
      const Lanes viscousWork = viscous.workOver(motion.dilatation) * motion.volume;
      addTo(data, ElementEnergy::Viscous, first, viscousWork);
      advance(first, motion, v, gradient.volume, length, viscousWork);
    }

    PointSums sums;
    sumPoints(first, x, sums);
    storeMeans(first, sums, inverseVolume);
    Lanes pressure = viscous.now;
    if (hasMeanDilatation())
      pressure -=
          Lanes(1.0 / 3.0) * inverseVolume * (sums.stress.xx + sums.stress.yy + sums.stress.zz);
    const Lanes sum = storeCornerForces(first, gradient, pressure, sums);
    const Lanes step = stepOf(first, gradient, inverseVolume, rho * viscous.viscosity, sums);
    storeStep(data, first, step, gradient.volume > Lanes(0.0) && sums.unfolded, sum);
  }

private:
  /// B-bar.
  bool hasMeanDilatation() const { return data.options.form == ElementForm::FullIntegration; }

  /// The motion from n to n + 1, seen from the positions in its middle.
  struct Motion
  {
    Field middle;                  ///< positions [m]
    Lanes volume = Lanes(0.0);     ///< there [m^3]
    Lanes dilatation = Lanes(0.0); ///< of the step, mean over the element [-]
  };

  void findMotion(const Field& x, const Field& v, Motion& motion) const
  {
    Shape::findMiddle(x, v, data.dt, motion.middle);
    const Gradient half = Shape::gradientAt(motion.middle);
    motion.volume = half.volume;
    Lanes dilatation(0.0);
    for (int i = 0; i < dim; ++i)
      for (int k = 0; k < gradients; ++k)
        dilatation += v.modes[i][k] * half.b[i][k];
    if constexpr (revolved)
    {
      dilatation += v.mean * half.hoop[gradients];
      for (int k = 0; k < gradients; ++k)
        dilatation += v.modes[0][k] * half.hoop[k];
    }
    motion.dilatation = dilatation * (Lanes(nodes * data.dt) / half.volume);
  }

  /// The map from the parent square or cube at a point.
  struct PointMap
  {
    Real p[3];                 ///< parent coordinates
    Lanes toParent[dim][dim];  ///< [j][k]: dxi_k / dx_j [1/m]
    Lanes weight;              ///< volume of the point [m^3]
    Lanes radius = Lanes(0.0); ///< of rings [m]
  };

  static PointMap mapAt(const Field& x, int q)
  {
    PointMap map;
    gaussPoint(q, map.p);
    Lanes slope[dim][3], s[dim][dim];
    for (int i = 0; i < dim; ++i)
    {
      Points::slopes(x.modes[i], map.p, slope[i]);
      for (int k = 0; k < dim; ++k)
        s[i][k] = slope[i][k];
    }
    map.weight = inverseTransposed(s, map.toParent);
    if constexpr (revolved)
    {
      map.radius = radialAt(x, map.p);
      map.weight *= Lanes(2 * pi) * map.radius;
    }
    return map;
  }

  /// The component along r of a field at a point.
  static Lanes radialAt(const Field& field, const Real (&p)[3])
  {
    const Lanes(&u)[M::count] = field.modes[0];
    return field.mean + Lanes(p[0]) * u[0] + Lanes(p[1]) * u[1] + Lanes(p[0] * p[1]) * u[2];
  }

  /// Stresses, history and energies at all points from n to n + 1.
  /// @param volume at n + 1 [m^3]; viscousWork of the element [J]
  void advance(int first, const Motion& motion, const Field& v, const Lanes& volume,
               const Lanes& length, const Lanes& viscousWork) const
  {
    Lanes work(0.0), dissipation(0.0), stiffening(0.0);
    for (int q = 0; q < Points::count; ++q)
    {
      const PointMap map = mapAt(motion.middle, q);
      MaterialPoint<Lanes> point;
      findStrain(v, map, motion.dilatation, point);
      const SymTensorOf<Lanes> strain = point.strainIncrement;
      point.dt = data.dt;
      point.size = length;
      const SymTensorOf<Lanes> oldStress =
          loadTensor<dim>(data.pointStress, tensorRows<dim> * q, first);
      point.oldStress = oldStress;
      if (data.options.rate == ObjectiveRate::HughesWinget)
        turnByHughesWinget(oldStress, point);
      else
        turnByOtherRate<dim>(data, first, q, oldStress, point);
      const Lanes inverseReference =
          Lanes(density(*data.material)) / load(&data.pointMass(q, first));
      if (law.usesVolume)
      {
        findVolumes(first, motion, map.weight * inverseReference, strain, volume, point);
        point.energy = load(&data.pointEnergy(q, first));
      }
      advancePoint<dim>(law, data.pointHistory, data.pointStress, q, first, point);
      const Lanes pointWork = Lanes(0.5) * map.weight * twiceWork(oldStress, point.stress, strain);
      if (law.usesVolume)
        store(point.energy +
                  (pointWork + viscousWork * map.weight / motion.volume) * inverseReference,
              &data.pointEnergy(q, first));
      work += pointWork;
      dissipation += map.weight * point.dissipation;
      stiffening = lanesMax(stiffening, point.stiffening);
    }
    addTo(data, ElementEnergy::Internal, first, work);
    addTo(data, ElementEnergy::PlasticDissipation, first, dissipation);
    if (law.changesTangent)
      store(stiffening, &data.tangent(0, first));
  }

  /// Displacement gradient, strain increment and rotation of a point.
  void findStrain(const Field& v, const PointMap& map, const Lanes& dilatation,
                  MaterialPoint<Lanes>& point) const
  {
    const Lanes dt(data.dt);
    Mat3Of<Lanes>& l = point.displacementGradient;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        l(i, j) = Lanes(0.0);
    for (int i = 0; i < dim; ++i)
    {
      Lanes slope[3];
      Points::slopes(v.modes[i], map.p, slope);
      for (int j = 0; j < dim; ++j)
      {
        Lanes sum = slope[0] * map.toParent[j][0];
        for (int k = 1; k < dim; ++k)
          sum += slope[k] * map.toParent[j][k];
        l(i, j) = dt * sum;
      }
    }
    if constexpr (revolved)
      l(2, 2) = dt * (radialAt(v, map.p) / map.radius);
    if (hasMeanDilatation())
    {
      const Lanes change = Lanes(1.0 / 3.0) * (dilatation - (l(0, 0) + l(1, 1) + l(2, 2)));
      for (int i = 0; i < 3; ++i)
        l(i, i) += change;
    }
    findSymmetricPart(l, point.strainIncrement);
    point.rotation = hughesWinget(l);
  }

  /// Volume ratios of a point: with B-bar those of the element, else the one at the end from the
  /// dilatation of the step.
  /// @param ownRatio of the point at the half step; volume of the element at n + 1 [m^3]
  void findVolumes(int first, const Motion& motion, const Lanes& ownRatio,
                   const SymTensorOf<Lanes>& strain, const Lanes& volume,
                   MaterialPoint<Lanes>& point) const
  {
    if (hasMeanDilatation())
    {
      const Lanes inverseReference = Lanes(1.0) / load(&data.referenceVolume(first));
      point.halfVolumeRatio = motion.volume * inverseReference;
      point.volumeRatio = volume * inverseReference;
    }
    else
    {
      point.halfVolumeRatio = ownRatio;
      const Lanes half = Lanes(0.5) * (strain.xx + strain.yy + strain.zz);
      point.volumeRatio = point.halfVolumeRatio * (Lanes(1.0) + half);
    }
  }

  /// The squared frequencies that hoop strains alone would give, over 2 mu: the matrix
  /// sum_q w_q N_I N_J / r_q^2 over the masses of the corners has no eigenvalue above its largest
  /// sum of a row. A corner on the axis does not move along r.
  struct HoopRates
  {
    Lanes row[nodes] = {Lanes(0.0), Lanes(0.0), Lanes(0.0), Lanes(0.0)};

    static Real shape(int corner, const Real (&p)[3])
    {
      const Real xi = corner == 1 || corner == 2 ? p[0] : -p[0], eta = corner > 1 ? p[1] : -p[1];
      return 0.25 * (1 + xi) * (1 + eta);
    }
    void add(const Real (&p)[3], const Lanes& weight)
    {
      for (int corner = 0; corner < 4; ++corner)
        row[corner] += Lanes(shape(corner, p)) * weight;
    }
    Lanes largest(const ElementKernelData& data, int first, const Field& x) const
    {
      Lanes corners[nodes], most(0.0);
      M::toCorners(x.modes[0], corners);
      for (int corner = 0; corner < nodes; ++corner)
      {
        // rounding of the modes leaves a rest of the radius on the axis
        const LaneMask moves = x.mean + corners[corner] > Lanes(1e-9) * x.mean;
        const Lanes rate = row[corner] / load(&data.cornerMass(corner, first));
        most = lanesMax(most, choose(moves, rate, Lanes(0.0)));
      }
      return most;
    }
  };

  /// Sums over the points, and what is the largest of them, at n + 1.
  struct PointSums
  {
    Lanes force[dim][M::count]; ///< on the modes, turned round [N]
    Lanes around = Lanes(0.0);  ///< hoop forces over the corners [N]
    SymTensorOf<Lanes> stress{Lanes(0.0), Lanes(0.0), Lanes(0.0),
                              Lanes(0.0), Lanes(0.0), Lanes(0.0)}; ///< times volume [J]
    Lanes history[maximumHistory];                                 ///< times volume
    Lanes fastest = Lanes(0.0); ///< squared frequency over 2 mu [m/kg]
    Lanes inPlane = Lanes(0.0); ///< the same without hoop strains, of rings with B-bar
    HoopRates hoopRates;
    LaneMask unfolded = LaneMask(true); ///< all weights are positive
  };

  void sumPoints(int first, const Field& x, PointSums& sums) const
  {
    for (auto& row : sums.force)
      for (Lanes& value : row)
        value = Lanes(0.0);
    for (int k = 0; k < law.historyCount; ++k)
      sums.history[k] = Lanes(0.0);
    for (int q = 0; q < Points::count; ++q)
    {
      const PointMap map = mapAt(x, q);
      const SymTensorOf<Lanes> s = loadTensor<dim>(data.pointStress, tensorRows<dim> * q, first);
      sums.unfolded = sums.unfolded && map.weight > Lanes(0.0);
      sums.stress.xx += map.weight * s.xx;
      sums.stress.yy += map.weight * s.yy;
      sums.stress.zz += map.weight * s.zz;
      sums.stress.xy += map.weight * s.xy;
      sums.stress.yz += map.weight * s.yz;
      sums.stress.zx += map.weight * s.zx;
      for (int k = 0; k < law.historyCount; ++k)
        sums.history[k] += map.weight * load(&data.pointHistory(law.historyCount * q + k, first));
      addForces(map, s, sums);
      addFrequency(map, map.weight / load(&data.pointMass(q, first)), sums);
    }
    if constexpr (revolved)
      if (hasMeanDilatation()) // a second bound, the better one at the axis
        sums.fastest =
            lanesMin(sums.fastest, sums.inPlane + sums.hoopRates.largest(data, first, x));
  }

  /// Forces of the stress of a point, with B-bar of its deviator.
  void addForces(const PointMap& map, const SymTensorOf<Lanes>& s, PointSums& sums) const
  {
    const Lanes shift = hasMeanDilatation() ? Lanes(1.0 / 3.0) * (s.xx + s.yy + s.zz) : Lanes(0.0);
    const Lanes full[3][3] = {
        {s.xx - shift, s.xy, s.zx}, {s.xy, s.yy - shift, s.yz}, {s.zx, s.yz, s.zz - shift}};
    for (int i = 0; i < dim; ++i)
    {
      Lanes flux[3];
      for (int k = 0; k < dim; ++k)
      {
        Lanes sum = full[i][0] * map.toParent[0][k];
        for (int j = 1; j < dim; ++j)
          sum += full[i][j] * map.toParent[j][k];
        flux[k] = map.weight * sum;
      }
      Points::addForces(flux, map.p, sums.force[i]);
    }
    if constexpr (revolved)
    {
      const Real(&p)[3] = map.p;
      const Lanes force = map.weight * (Lanes(1.0) / map.radius) * full[2][2];
      sums.around += force;
      sums.force[0][0] += Lanes(p[0]) * force;
      sums.force[0][1] += Lanes(p[1]) * force;
      sums.force[0][2] += Lanes(p[0] * p[1]) * force;
    }
  }

  /// @param perDensity weight over mass of the point [m^3/kg]
  void addFrequency(const PointMap& map, const Lanes& perDensity, PointSums& sums) const
  {
    const Real c = hasMeanDilatation() ? 0 : data.lambdaOfBound() / (2 * data.shearModulus);
    if constexpr (revolved)
    {
      const Lanes perRadius = Lanes(1.0) / map.radius;
      sums.hoopRates.add(map.p, map.weight * perRadius * perRadius);
      sums.fastest = lanesMax(sums.fastest, perDensity * fastestAtRing(map.toParent, perRadius, c));
      if (hasMeanDilatation())
        sums.inPlane = lanesMax(sums.inPlane, perDensity * fastestAtPoint(map.toParent, c));
    }
    else
      sums.fastest = lanesMax(sums.fastest, perDensity * fastestAtPoint(map.toParent, c));
  }

  /// Means of stress and history over the points.
  void storeMeans(int first, const PointSums& sums, const Lanes& inverseVolume) const
  {
    const SymTensorOf<Lanes>& s = sums.stress;
    storeTensor<dim>(SymTensorOf<Lanes>{s.xx * inverseVolume, s.yy * inverseVolume,
                                        s.zz * inverseVolume, s.xy * inverseVolume,
                                        s.yz * inverseVolume, s.zx * inverseVolume},
                     data.stress, 0, first);
    for (int k = 0; k < law.historyCount; ++k)
      store(sums.history[k] * inverseVolume, &data.history(k, first));
  }

  /// Returns a sum of all forces, to see whether they are finite.
  /// @param pressure on the mean gradient, compression positive [Pa]
  Lanes storeCornerForces(int first, const Gradient& g, const Lanes& pressure,
                          const PointSums& sums) const
  {
    Real force[dim][nodes][laneCount];
    Lanes all(0.0);
    for (int i = 0; i < dim; ++i)
    {
      Lanes modes[M::count];
      for (int k = 0; k < M::count; ++k)
      {
        modes[k] = Lanes(-1.0 / nodes) * sums.force[i][k];
        if (k < gradients)
        {
          modes[k] += pressure * Shape::modeOf(g.b[i], k);
          if (revolved && i == 0)
            modes[k] += pressure * g.hoop[revolved ? k : 0];
        }
        all += modes[k];
      }
      Lanes corners[nodes];
      M::toCorners(modes, corners);
      if (revolved && i == 0)
      {
        const Lanes mean =
            pressure * g.hoop[revolved ? gradients : 0] - Lanes(1.0 / nodes) * sums.around;
        all += mean;
        for (Lanes& corner : corners)
          corner += mean;
      }
      for (int corner = 0; corner < nodes; ++corner)
        store(corners[corner], force[i][corner]);
    }
    storeForces<M>(data, first, force);
    return all;
  }

  /// @param damping density times viscosity [Pa s]
  Lanes stepOf(int first, const Gradient& g, const Lanes& inverseVolume, const Lanes& damping,
               const PointSums& sums) const
  {
    const Lanes volumetric = volumetricOf(first, g, inverseVolume);
    Lanes omegaSquared = Lanes(2 * data.shearModulus) * sums.fastest;
    if (hasMeanDilatation())
      omegaSquared += Lanes(data.lambdaOfBound() + 2.0 / 3.0 * data.shearModulus) * volumetric;
    omegaSquared *= load(&data.tangent(0, first));
    return stableStep(omegaSquared, damping * volumetric);
  }

  /// Sum over the corners of V b.b / m_I: what a uniform pressure feels [m/kg].
  Lanes volumetricOf(int first, const Gradient& g, const Lanes& inverseVolume) const
  {
    Lanes squares[nodes];
    for (int corner = 0; corner < nodes; ++corner)
      squares[corner] = Lanes(0.0);
    for (int i = 0; i < dim; ++i)
    {
      Lanes modes[M::count], corners[nodes];
      for (int k = 0; k < M::count; ++k)
      {
        modes[k] = Shape::modeOf(g.b[i], k);
        if (revolved && i == 0 && k < gradients)
          modes[k] += g.hoop[revolved ? k : 0];
      }
      M::toCorners(modes, corners);
      if (revolved && i == 0)
        for (Lanes& corner : corners)
          corner += g.hoop[revolved ? gradients : 0];
      for (int corner = 0; corner < nodes; ++corner)
        squares[corner] += corners[corner] * corners[corner];
    }
    Lanes volumetric(0.0);
    for (int corner = 0; corner < nodes; ++corner)
      volumetric += squares[corner] / load(&data.cornerMass(corner, first));
    return volumetric * inverseVolume;
  }

  /// fastestAtPoint() of a ring: with masses N_I the hoop strain N_I / r is a third one beside the
  /// others, because sum_I (dN_I/dxi_k) N_I / (r N_I) = 0 and sum_I N_I^2 / (r^2 N_I) = 1 / r^2.
  static Lanes fastestAtRing(const Lanes (&toParent)[dim][dim], const Lanes& perRadius, Real c)
  {
    Lanes g[dim][dim];
    squaredGradients(toParent, g);
    const Lanes trace = traceOf(g), det = g[0][0] * g[1][1] - g[0][1] * g[0][1];
    const Lanes around = perRadius * perRadius;
    return fastestStrainMode(trace + around, det + trace * around, det * around, c);
  }

  /// Largest root y of StableStep.hpp for the point alone, with the part of the mass that the point
  /// gives to each corner, N_I: sum_I dN_I/dxi_k dN_I/dxi_l / N_I is 3/2 for k = l, else 0. The
  /// frequency of the element is not above that of its fastest point.
  static Lanes fastestAtPoint(const Lanes (&toParent)[dim][dim], Real c)
  {
    Lanes g[dim][dim];
    squaredGradients(toParent, g);
    return fastestStrainMode(g, c);
  }

  /// g_jk = 3/2 sum_m dxi_m/dx_j dxi_m/dx_k.
  static void squaredGradients(const Lanes (&toParent)[dim][dim], Lanes (&g)[dim][dim])
  {
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k <= j; ++k)
      {
        Lanes sum = toParent[j][0] * toParent[k][0];
        for (int m = 1; m < dim; ++m)
          sum += toParent[j][m] * toParent[k][m];
        g[j][k] = g[k][j] = Lanes(1.5) * sum;
      }
  }
};
} // namespace coplane
