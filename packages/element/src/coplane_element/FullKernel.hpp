#pragma once

#include <coplane_element/ElementKernel.hpp>
#include <coplane_element/Revolved.hpp>

namespace coplane
{
/// Gauss points of the fully integrated elements, two along each axis of the parent square or cube,
/// weight 1 each: exact for volumes and mean gradients. Fields are given by modes
/// (MeanGradient.hpp).
template <ElementType type>
struct GaussPoints;

template <>
struct GaussPoints<ElementType::Quad4>
{
  static constexpr int count = 4;

  /// Derivatives along xi, eta at a point.
  template <class T>
  static KOKKOS_INLINE_FUNCTION void slopes(const T (&u)[3], const Real (&p)[3], T (&slope)[3])
  {
    slope[0] = u[0] + T(p[1]) * u[2];
    slope[1] = u[1] + T(p[0]) * u[2];
  }
  /// The transpose: adds to the forces on the modes.
  template <class T>
  static KOKKOS_INLINE_FUNCTION void addForces(const T (&flux)[3], const Real (&p)[3], T (&f)[3])
  {
    f[0] += flux[0];
    f[1] += flux[1];
    f[2] += T(p[1]) * flux[0] + T(p[0]) * flux[1];
  }
};

template <>
struct GaussPoints<ElementType::Hex8>
{
  static constexpr int count = 8;

  template <class T>
  static KOKKOS_INLINE_FUNCTION void slopes(const T (&u)[7], const Real (&p)[3], T (&slope)[3])
  {
    slope[0] = u[0] + T(p[2]) * u[4] + T(p[1]) * u[5] + T(p[1] * p[2]) * u[6];
    slope[1] = u[1] + T(p[2]) * u[3] + T(p[0]) * u[5] + T(p[2] * p[0]) * u[6];
    slope[2] = u[2] + T(p[1]) * u[3] + T(p[0]) * u[4] + T(p[0] * p[1]) * u[6];
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION void addForces(const T (&flux)[3], const Real (&p)[3], T (&f)[7])
  {
    f[0] += flux[0];
    f[1] += flux[1];
    f[2] += flux[2];
    f[3] += T(p[2]) * flux[1] + T(p[1]) * flux[2];
    f[4] += T(p[2]) * flux[0] + T(p[0]) * flux[2];
    f[5] += T(p[1]) * flux[0] + T(p[0]) * flux[1];
    f[6] += T(p[1] * p[2]) * flux[0] + T(p[2] * p[0]) * flux[1] + T(p[0] * p[1]) * flux[2];
  }
};

/// Parent coordinates of Gauss point q: the signs of xi, eta, zeta are its bits.
inline void gaussPoint(int q, Real (&p)[3])
{
  constexpr Real a = 0.57735026918962576451; // 1 / sqrt(3)
  for (int k = 0; k < 3; ++k)
    p[k] = (q >> k) & 1 ? a : -a;
}

/// One batch of fully integrated elements. With B-bar the dilatation is the mean one everywhere, so
/// that only the mean of the mean stresses does work on it: forces are those of the deviators at
/// the points and of that mean on the mean gradient. Forces of an element are written on modes that
/// have no mean and no rotation of a symmetric stress: no resultant, no moment.
///
/// revolved: a body of revolution. Points have the weight 2 pi r, and the hoop strain u_r / r of
/// their own; the mean dilatation is that of the ring, and the mean of hoop forces is one of its
/// own.
template <ElementType type, class Law, bool revolved = false>
struct FullKernel
{
  using M = Modes<type>;
  using Points = GaussPoints<type>;
  using Shape = OnePointShape<type, revolved>;
  using Hoop = typename Shape::Hoop;
  static constexpr int gradients = Shape::gradients;
  static constexpr int dim = M::dimension;
  static constexpr int nodes = M::nodes;
  static constexpr int components = dim == 3 ? 6 : 4;

  ElementKernelData data;
  Law law;

  [[gnu::noinline]] void operator()(const int batch) const
  {
    const int first = batch * laneCount;
    const bool bbar = data.options.form == ElementForm::FullIntegration;
    Lanes x[dim][M::count], v[dim][M::count];
    Lanes radius(0.0), radialVelocity(0.0); // means over the corners
    gatherModes<M>(data.connectivity, data.x, first, x, revolved ? &radius : nullptr);
    gatherModes<M>(data.connectivity, data.v, first, v, revolved ? &radialVelocity : nullptr);

    Lanes b[dim][gradients];
    Hoop hoop;
    const Lanes volume = Shape::volumeGradient(x, radius, b, hoop);
    const Lanes inverseVolume = Lanes(1.0) / volume;
    const Lanes mass = load(&data.mass(first));
    const Lanes rho = mass * inverseVolume;
    const Lanes length =
        characteristicLength<dim>(data, revolved ? Shape::areaOf(hoop) : volume, first);
    const Lanes oldViscousPressure = load(&data.compression(1, first));

    Lanes middle[dim][M::count], middleRadius(0.0);
    Lanes dilatation(0.0), middleVolume(0.0); // of the step, mean over the element
    if (data.dt > 0)
    {
      for (int i = 0; i < dim; ++i)
        for (int k = 0; k < M::count; ++k)
          middle[i][k] = x[i][k] - Lanes(0.5 * data.dt) * v[i][k];
      middleRadius = radius - Lanes(0.5 * data.dt) * radialVelocity;
      Lanes half[dim][gradients];
      Hoop halfHoop;
      middleVolume = Shape::volumeGradient(middle, middleRadius, half, halfHoop);
      for (int i = 0; i < dim; ++i)
        for (int k = 0; k < gradients; ++k)
          dilatation += v[i][k] * half[i][k];
      if constexpr (revolved)
      {
        dilatation += radialVelocity * halfHoop[gradients];
        for (int k = 0; k < gradients; ++k)
          dilatation += v[0][k] * halfHoop[k];
      }
      dilatation *= Lanes(nodes * data.dt) / middleVolume;
      store(branchFree::positivePart(-dilatation / Lanes(data.dt)), &data.compression(0, first));
    }
    const Lanes lr = length * load(&data.compression(0, first));
    const Lanes b1c = Lanes(data.viscosity.linear * data.soundSpeed);
    const Lanes b2lr = Lanes(data.viscosity.quadratic) * lr;
    const Lanes viscousPressure = rho * lr * (b1c + b2lr);
    store(viscousPressure, &data.compression(1, first));
    store(volume, &data.volume(first));
    if (data.dt > 0)
    {
      const Lanes viscousWork =
          Lanes(-0.5) * (oldViscousPressure + viscousPressure) * dilatation * middleVolume;
      addTo(ElementEnergy::Viscous, first, viscousWork);
      advance(first, middle, v, {middleRadius, radialVelocity}, dilatation, middleVolume, volume,
              length, viscousWork);
    }
    const Lanes viscosity = length * (b1c + Lanes(2.0) * b2lr);
    finish(first, x, radius, b, hoop, volume, inverseVolume, viscousPressure, viscosity, bbar);
  }

private:
  /// Means over the corners, of bodies of revolution.
  struct Radial
  {
    Lanes position, velocity;
  };

  void addTo(ElementEnergy kind, int first, const Lanes& amount) const
  {
    Real* const where = &data.energies(int(kind), first);
    store(load(where) + amount, where);
  }

  /// A field along x at a point, from its modes and its mean.
  static Lanes valueAt(const Lanes& mean, const Lanes (&u)[M::count], const Real (&p)[3])
  {
    return mean + Lanes(p[0]) * u[0] + Lanes(p[1]) * u[1] + Lanes(p[0] * p[1]) * u[2];
  }

  /// Inverse of the map's gradient and its determinant at a point: out[k][j] = dxi_k/dx_j.
  static Lanes inverseMap(const Lanes (&x)[dim][M::count], const Real (&p)[3],
                          Lanes (&out)[dim][dim])
  {
    Lanes s[dim][3];
    for (int i = 0; i < dim; ++i)
      Points::slopes(x[i], p, s[i]);
    if constexpr (dim == 2)
    {
      const Lanes det = s[0][0] * s[1][1] - s[0][1] * s[1][0];
      const Lanes inverse = Lanes(1.0) / det;
      out[0][0] = inverse * s[1][1];
      out[0][1] = -inverse * s[0][1];
      out[1][0] = -inverse * s[1][0];
      out[1][1] = inverse * s[0][0];
      return det;
    }
    else
    {
      // out = adj(s) / det; cofactors of s[j][k] stand at out[k][j]
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
        {
          const int j1 = (j + 1) % 3, j2 = (j + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
          out[k][j] = s[j1][k1] * s[j2][k2] - s[j1][k2] * s[j2][k1];
        }
      const Lanes det = s[0][0] * out[0][0] + s[0][1] * out[1][0] + s[0][2] * out[2][0];
      const Lanes inverse = Lanes(1.0) / det;
      for (auto& row : out)
        for (Lanes& value : row)
          value *= inverse;
      return det;
    }
  }

  /// Stresses, history and energies at all points from n to n + 1.
  void advance(int first, const Lanes (&middle)[dim][M::count], const Lanes (&v)[dim][M::count],
               const Radial& radial, const Lanes& dilatation, const Lanes& middleVolume,
               const Lanes& volume, const Lanes& length, const Lanes& viscousWork) const
  {
    const bool bbar = data.options.form == ElementForm::FullIntegration;
    Lanes work(0.0), dissipation(0.0), stiffening(0.0);
    for (int q = 0; q < Points::count; ++q)
    {
      Real p[3];
      gaussPoint(q, p);
      Lanes inverse[dim][dim];
      Lanes weight = inverseMap(middle, p, inverse);
      Lanes hoopRate(0.0); // v_r / r
      if constexpr (revolved)
      {
        const Lanes radius = valueAt(radial.position, middle[0], p);
        hoopRate = valueAt(radial.velocity, v[0], p) / radius;
        weight *= Lanes(2 * pi) * radius;
      }
      MaterialPoint<Lanes> point;
      findStrain(v, p, inverse, hoopRate, dilatation, bbar, point);
      const SymTensorOf<Lanes> strain = point.strainIncrement;
      const SymTensorOf<Lanes> oldStress = loadTensor<dim>(data.pointStress, components * q, first);
      point.dt = data.dt;
      point.size = length;
      point.oldStress = oldStress;
      turn(first, q, oldStress, point);
      const Lanes inverseReference =
          Lanes(density(*data.material)) / load(&data.pointMass(q, first));
      if (law.usesVolume)
      {
        const Lanes wholeReference = Lanes(1.0) / load(&data.referenceVolume(first));
        point.halfVolumeRatio = bbar ? middleVolume * wholeReference : weight * inverseReference;
        // at the end, from the dilatation of the step
        const Lanes half = Lanes(0.5) * (strain.xx + strain.yy + strain.zz);
        point.volumeRatio =
            bbar ? volume * wholeReference : point.halfVolumeRatio * (Lanes(1.0) + half);
        point.energy = load(&data.pointEnergy(q, first));
      }
      for (int k = 0; k < law.historyCount; ++k)
        point.history[k] = load(&data.pointHistory(law.historyCount * q + k, first));
      law(point);
      for (int k = 0; k < law.historyCount; ++k)
        store(point.history[k], &data.pointHistory(law.historyCount * q + k, first));
      storeTensor<dim>(point.stress, data.pointStress, components * q, first);
      const Lanes pointWork = Lanes(0.5) * weight * twiceWork(oldStress, point.stress, strain);
      if (law.usesVolume)
        store(point.energy + (pointWork + viscousWork * weight / middleVolume) * inverseReference,
              &data.pointEnergy(q, first));
      work += pointWork;
      dissipation += weight * point.dissipation;
      stiffening = lanesMax(stiffening, point.stiffening);
    }
    addTo(ElementEnergy::Internal, first, work);
    addTo(ElementEnergy::PlasticDissipation, first, dissipation);
    if (law.changesTangent)
      store(stiffening, &data.tangent(0, first));
  }

  void findStrain(const Lanes (&v)[dim][M::count], const Real (&p)[3],
                  const Lanes (&inverse)[dim][dim], const Lanes& hoopRate, const Lanes& dilatation,
                  bool bbar, MaterialPoint<Lanes>& point) const
  {
    const Lanes dt(data.dt), half(0.5), quarter(0.25);
    Mat3Of<Lanes>& l = point.displacementGradient;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        l(i, j) = Lanes(0.0);
    for (int i = 0; i < dim; ++i)
    {
      Lanes slope[3];
      Points::slopes(v[i], p, slope);
      for (int j = 0; j < dim; ++j)
      {
        Lanes sum = slope[0] * inverse[0][j];
        for (int k = 1; k < dim; ++k)
          sum += slope[k] * inverse[k][j];
        l(i, j) = dt * sum;
      }
    }
    if constexpr (revolved)
      l(2, 2) = dt * hoopRate;
    if (bbar)
    {
      const Lanes change = Lanes(1.0 / 3.0) * (dilatation - (l(0, 0) + l(1, 1) + l(2, 2)));
      for (int i = 0; i < 3; ++i)
        l(i, i) += change;
    }
    point.strainIncrement = {l(0, 0),
                             l(1, 1),
                             l(2, 2),
                             half * (l(0, 1) + l(1, 0)),
                             half * (l(1, 2) + l(2, 1)),
                             half * (l(2, 0) + l(0, 2))};
    point.rotation =
        hughesWinget(Vec3Of<Lanes>{quarter * (l(2, 1) - l(1, 2)), quarter * (l(0, 2) - l(2, 0)),
                                   quarter * (l(1, 0) - l(0, 1))});
  }

  void turn(int first, int q, const SymTensorOf<Lanes>& stress, MaterialPoint<Lanes>& point) const
  {
    if (data.options.rate == ObjectiveRate::Jaumann)
    {
      point.stress = turnedFirstOrder(stress, point.displacementGradient);
      return;
    }
    if (data.options.rate == ObjectiveRate::GreenNaghdi)
    {
      const auto row = [&](int i, int j)
      { return &data.deformation(dim * (dim * q + i) + j, first); };
      Mat3Of<Lanes> f;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          f(i, j) = i < dim && j < dim ? load(row(i, j)) : Lanes(i == j ? 1.0 : 0.0);
      greenNaghdi<dim>(point.displacementGradient, f, point.rotation, point.strainIncrement);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          store(f(i, j), row(i, j));
    }
    else
      point.strainIncrement = turnedToEnd(point.strainIncrement, point.rotation);
    point.stress = rotated(stress, point.rotation);
  }

  /// Forces, means over the points and stable step at n + 1.
  void finish(int first, const Lanes (&x)[dim][M::count], const Lanes& meanRadius,
              const Lanes (&b)[dim][gradients], const Hoop& hoop, const Lanes& volume,
              const Lanes& inverseVolume, const Lanes& viscousPressure, const Lanes& viscosity,
              bool bbar) const
  {
    Lanes f[dim][M::count];
    for (auto& row : f)
      for (Lanes& value : row)
        value = Lanes(0.0);
    SymTensorOf<Lanes> mean{Lanes(0.0), Lanes(0.0), Lanes(0.0), Lanes(0.0), Lanes(0.0), Lanes(0.0)};
    Lanes history[maximumHistory];
    for (int k = 0; k < law.historyCount; ++k)
      history[k] = Lanes(0.0);
    const Real lambda = data.lambda > 0 ? data.lambda : 0;
    const Real c = bbar ? 0 : lambda / (2 * data.shearModulus);
    Lanes fastest(0.0);
    Lanes inPlane(0.0);
    Lanes around(0.0); // sum of the hoop forces of the points over the corners
    HoopRates hoopRates;
    LaneMask unfolded = volume > Lanes(0.0);
    for (int q = 0; q < Points::count; ++q)
    {
      Real p[3];
      gaussPoint(q, p);
      Lanes inverse[dim][dim];
      Lanes weight = inverseMap(x, p, inverse), perRadius(0.0);
      if constexpr (revolved)
      {
        const Lanes radius = valueAt(meanRadius, x[0], p);
        weight *= Lanes(2 * pi) * radius;
        perRadius = Lanes(1.0) / radius;
      }
      unfolded = unfolded && weight > Lanes(0.0);
      const SymTensorOf<Lanes> s = loadTensor<dim>(data.pointStress, components * q, first);
      mean.xx += weight * s.xx;
      mean.yy += weight * s.yy;
      mean.zz += weight * s.zz;
      mean.xy += weight * s.xy;
      mean.yz += weight * s.yz;
      mean.zx += weight * s.zx;
      for (int k = 0; k < law.historyCount; ++k)
        history[k] += weight * load(&data.pointHistory(law.historyCount * q + k, first));
      const Lanes shift = bbar ? Lanes(1.0 / 3.0) * (s.xx + s.yy + s.zz) : Lanes(0.0);
      const Lanes full[3][3] = {
          {s.xx - shift, s.xy, s.zx}, {s.xy, s.yy - shift, s.yz}, {s.zx, s.yz, s.zz - shift}};
      for (int i = 0; i < dim; ++i)
      {
        Lanes flux[3];
        for (int k = 0; k < dim; ++k)
        {
          Lanes sum = full[i][0] * inverse[k][0];
          for (int j = 1; j < dim; ++j)
            sum += full[i][j] * inverse[k][j];
          flux[k] = weight * sum;
        }
        Points::addForces(flux, p, f[i]);
      }
      const Lanes pointMass = load(&data.pointMass(q, first));
      const Lanes density = weight / pointMass;
      if constexpr (revolved)
      {
        const Lanes force = weight * perRadius * full[2][2];
        around += force;
        f[0][0] += Lanes(p[0]) * force;
        f[0][1] += Lanes(p[1]) * force;
        f[0][2] += Lanes(p[0] * p[1]) * force;
        hoopRates.add(p, weight * perRadius * perRadius);
        const Lanes withHoop = fastestAtRing(inverse, perRadius, c);
        fastest = lanesMax(fastest, density * withHoop);
        if (bbar)
          inPlane = lanesMax(inPlane, density * fastestAtPoint(inverse, c));
      }
      else
        fastest = lanesMax(fastest, density * fastestAtPoint(inverse, c));
    }
    if constexpr (revolved)
      if (bbar) // a second bound, the better one at the axis
        fastest = lanesMin(fastest, inPlane + hoopRates.largest(data, first, x[0], meanRadius));
    storeTensor<dim>(SymTensorOf<Lanes>{mean.xx * inverseVolume, mean.yy * inverseVolume,
                                        mean.zz * inverseVolume, mean.xy * inverseVolume,
                                        mean.yz * inverseVolume, mean.zx * inverseVolume},
                     data.stress, 0, first);
    for (int k = 0; k < law.historyCount; ++k)
      store(history[k] * inverseVolume, &data.history(k, first));

    const Lanes pressure =
        viscousPressure -
        (bbar ? Lanes(1.0 / 3.0) * inverseVolume * (mean.xx + mean.yy + mean.zz) : Lanes(0.0));
    Real force[dim][nodes][laneCount];
    Lanes all(0.0);
    for (int i = 0; i < dim; ++i)
    {
      Lanes modes[M::count];
      for (int k = 0; k < M::count; ++k)
      {
        modes[k] = Lanes(-1.0 / nodes) * f[i][k];
        if (k < gradients)
        {
          modes[k] += pressure * b[i][k < gradients ? k : 0];
          if (revolved && i == 0)
            modes[k] += pressure * hoop[revolved ? k : 0];
        }
        all += modes[k];
      }
      Lanes corners[nodes];
      M::toCorners(modes, corners);
      if (revolved && i == 0)
      {
        const Lanes mean = pressure * hoop[revolved ? gradients : 0] - Lanes(1.0 / nodes) * around;
        all += mean;
        for (Lanes& corner : corners)
          corner += mean;
      }
      for (int corner = 0; corner < nodes; ++corner)
        store(corners[corner], force[i][corner]);
    }
    storeForces<M>(data, first, force);

    // sum over the corners of V b.b / m_I: what a uniform pressure feels
    Lanes volumetric(0.0);
    Lanes squares[nodes];
    for (int corner = 0; corner < nodes; ++corner)
      squares[corner] = Lanes(0.0);
    for (int i = 0; i < dim; ++i)
    {
      Lanes modes[M::count], corners[nodes];
      for (int k = 0; k < M::count; ++k)
      {
        modes[k] = k < gradients ? b[i][k < gradients ? k : 0] : Lanes(0.0);
        if (revolved && i == 0 && k < gradients)
          modes[k] += hoop[revolved ? k : 0];
      }
      M::toCorners(modes, corners);
      if (revolved && i == 0)
        for (Lanes& corner : corners)
          corner += hoop[revolved ? gradients : 0];
      for (int corner = 0; corner < nodes; ++corner)
        squares[corner] += corners[corner] * corners[corner];
    }
    for (int corner = 0; corner < nodes; ++corner)
      volumetric += squares[corner] / load(&data.cornerMass(corner, first));
    volumetric *= inverseVolume;
    Lanes omegaSquared = Lanes(2 * data.shearModulus) * fastest;
    if (bbar)
      omegaSquared += Lanes(lambda + 2.0 / 3.0 * data.shearModulus) * volumetric;
    omegaSquared *= load(&data.tangent(0, first));
    const Lanes rho = load(&data.mass(first)) * inverseVolume;
    const Lanes step = stableStep(omegaSquared, rho * viscosity * volumetric);
    const LaneMask good = all * Lanes(0.0) == Lanes(0.0) && unfolded && step > Lanes(0.0);
    store(choose(good, step, Lanes(0.0)), &data.stableStep(first));
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
    Lanes largest(const ElementKernelData& data, int first, const Lanes (&x)[M::count],
                  const Lanes& meanRadius) const
    {
      Lanes corners[nodes], most(0.0);
      M::toCorners(x, corners);
      for (int corner = 0; corner < nodes; ++corner)
      {
        // rounding of the modes leaves a rest of the radius on the axis
        const LaneMask moves = meanRadius + corners[corner] > Lanes(1e-9) * meanRadius;
        const Lanes rate = row[corner] / load(&data.cornerMass(corner, first));
        most = lanesMax(most, choose(moves, rate, Lanes(0.0)));
      }
      return most;
    }
  };

  /// fastestAtPoint() of a ring: with masses N_I the hoop strain N_I / r is a third one beside the
  /// others, because sum_I (dN_I/dxi_k) N_I / (r N_I) = 0 and sum_I N_I^2 / (r^2 N_I) = 1 / r^2.
  static Lanes fastestAtRing(const Lanes (&inverse)[dim][dim], const Lanes& perRadius, Real c)
  {
    Lanes g[2][2];
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k <= j; ++k)
        g[j][k] = g[k][j] =
            Lanes(1.5) * (inverse[0][j] * inverse[0][k] + inverse[1][j] * inverse[1][k]);
    const Lanes trace = g[0][0] + g[1][1], det = g[0][0] * g[1][1] - g[0][1] * g[0][1];
    const Lanes around = perRadius * perRadius;
    return fastestStrainMode(trace + around, det + trace * around, det * around, c);
  }

  /// Largest root y of StableStep.hpp for the point alone, with the part of the mass that the point
  /// gives to each corner, N_I: sum_I dN_I/dxi_k dN_I/dxi_l / N_I is 3/2 for k = l, else 0. The
  /// frequency of the element is not above that of its fastest point.
  static Lanes fastestAtPoint(const Lanes (&inverse)[dim][dim], Real c)
  {
    Lanes g[dim][dim];
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k <= j; ++k)
      {
        Lanes sum = inverse[0][j] * inverse[0][k];
        for (int m = 1; m < dim; ++m)
          sum += inverse[m][j] * inverse[m][k];
        g[j][k] = g[k][j] = Lanes(1.5) * sum;
      }
    if constexpr (dim == 3)
    {
      const Lanes m0 = g[1][1] * g[2][2] - g[1][2] * g[1][2];
      const Lanes m1 = g[0][0] * g[2][2] - g[0][2] * g[0][2];
      const Lanes m2 = g[0][0] * g[1][1] - g[0][1] * g[0][1];
      const Lanes det = g[0][0] * m0 - g[0][1] * (g[0][1] * g[2][2] - g[1][2] * g[0][2]) +
                        g[0][2] * (g[0][1] * g[1][2] - g[1][1] * g[0][2]);
      return fastestStrainMode(g[0][0] + g[1][1] + g[2][2], m0 + m1 + m2, det, c);
    }
    else
      return fastestStrainMode(g[0][0] + g[1][1], g[0][0] * g[1][1] - g[0][1] * g[0][1], c);
  }
};
} // namespace coplane
