#pragma once

#include <coplane_core/Backend.hpp>
#include <coplane_core/Lanes.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_element/ElementBlock.hpp>
#include <coplane_element/HughesWinget.hpp>
#include <coplane_element/MeanGradient.hpp>
#include <coplane_element/StableStep.hpp>

namespace coplane
{
/// What one call of ElementBlock::update() reads and writes.
struct ElementKernelData
{
  ConstNodeVectors x, v;
  Real dt;
  HourglassOptions hourglass;
  BulkViscosity viscosity;
  Real lambda, shearModulus, pWaveModulus, soundSpeed; // [Pa], [m/s]
  int batches;
  const Material* material;
  ConstTable<int> connectivity;
  ConstArray<Real> mass, referenceVolume, referenceLength;
  Table<Real> stress, history, tangent, hourglassForce, hourglassViscousForce, compression,
      energies;
  ElementBlock::CornerVectors cornerForce;
  Array<Real> stableStep, volume;
};

void updateTri3(const ElementKernelData& data);
void updateQuad4(const ElementKernelData& data);
void updateTet4(const ElementKernelData& data);
void updateHex8(const ElementKernelData& data);

inline Lanes load(const Real* from)
{
  return Lanes(from, stdx::element_aligned);
}
inline void store(const Lanes& value, Real* to)
{
  value.copy_to(to, stdx::element_aligned);
}

/// One batch of laneCount elements: everything from positions to corner forces in one pass.
/// Law: one of the laws itself, or LawFunction for any.
template <ElementType type, class Law>
struct ElementKernel
{
  using M = Modes<type>;
  static constexpr int dim = M::dimension;
  static constexpr int nodes = M::nodes;
  static constexpr bool hasHourglass = M::hourglass > 0;
  /// One vector per hourglass mode; an unused one where the strain sees every deformation.
  using HourglassVectors = Lanes[hasHourglass ? M::hourglass : 1][dim];

  ElementKernelData data;
  Law law;

  // Not inlined: both back ends call the same machine code.
  [[gnu::noinline]] void operator()(const int batch) const
  {
    const int first = batch * laneCount;
    Lanes x[dim][M::count], v[dim][M::count];
    gather(data.x, first, x);
    gather(data.v, first, v);

    HourglassVectors hourglass;
    for (int a = 0; a < M::hourglass; ++a)
      for (int i = 0; i < dim; ++i)
        hourglass[a][i] = load(&data.hourglassForce(a * dim + i, first));

    SymTensorOf<Lanes> stress = loadStress(first);
    const Lanes oldViscousPressure = load(&data.compression(1, first));
    Lanes b[dim][M::gradients];
    M::volumeGradient(x, b);
    const Lanes volume = M::volume(x, b);
    const Lanes inverseVolume = Lanes(1.0) / volume;
    const Lanes mass = load(&data.mass(first));
    const Lanes rho = mass * inverseVolume;
    const Lanes length = characteristicLength(volume, first);
    Motion motion;
    MaterialPoint<Lanes> point;
    if (data.dt > 0)
    {
      findMotion(x, v, motion, point);
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
      advance(first, v, motion, volume, length, point, stress, hourglass);
    }

    if (data.hourglass.viscosity > 0)
      for (int a = 0; a < M::hourglass; ++a)
        for (int i = 0; i < dim; ++i)
          hourglass[a][i] += load(&data.hourglassViscousForce(a * dim + i, first));

    const LaneMask finite =
        storeCornerForces(first, x, b, stress, viscousPressure, hourglass, inverseVolume);

    // Tangent of the viscous pressure over the rate of compression, per density.
    const Lanes viscosity = length * (b1c + Lanes(2.0) * b2lr);
    const Lanes step =
        stableStepOf(x, b, inverseVolume, rho, viscosity, load(&data.tangent(0, first)));
    const LaneMask good = finite && volume > Lanes(0.0) && step > Lanes(0.0);
    store(choose(good, step, Lanes(0.0)), &data.stableStep(first));
  }

private:
  void addTo(const Table<Real>& energies, ElementEnergy kind, int first, const Lanes& amount) const
  {
    Real* const where = &energies(int(kind), first);
    store(load(where) + amount, where);
  }

  /// Modes of a nodal field. Corner 0 is taken off first: a far origin or a common speed then costs
  /// no digits.
  void gather(const ConstNodeVectors& field, int first, Lanes (&modes)[dim][M::count]) const
  {
    const int* const node = &data.connectivity(first, 0);
    for (int i = 0; i < dim; ++i)
    {
      const auto corner = [&](int c)
      { return Lanes([&](auto lane) { return field(node[int(lane) * nodes + c], i); }); };
      const Lanes origin = corner(0);
      Lanes u[nodes];
      u[0] = Lanes(0.0);
#pragma GCC unroll 8
      for (int c = 1; c < nodes; ++c)
        u[c] = corner(c) - origin;
      M::fromCorners(u, modes[i]);
    }
  }

  SymTensorOf<Lanes> loadStress(int first) const
  {
    const auto row = [&](int k) { return load(&data.stress(k, first)); };
    if constexpr (dim == 3)
      return {row(0), row(1), row(2), row(3), row(4), row(5)};
    else
      return {row(0), row(1), row(2), row(3), Lanes(0.0), Lanes(0.0)};
  }

  void storeStress(const SymTensorOf<Lanes>& s, int first) const
  {
    store(s.xx, &data.stress(0, first));
    store(s.yy, &data.stress(1, first));
    store(s.zz, &data.stress(2, first));
    store(s.xy, &data.stress(3, first));
    if constexpr (dim == 3)
    {
      store(s.yz, &data.stress(4, first));
      store(s.zx, &data.stress(5, first));
    }
  }

  /// V^(1/3), or A^(1/2) in two dimensions [m]. The cube root is one step of Halley's method from
  /// the reference length: exact to 1 % while the volume stays between half and twice the first
  /// one; the viscosity needs no more.
  Lanes characteristicLength(const Lanes& volume, int first) const
  {
    if constexpr (dim == 2)
      return stdx::sqrt(branchFree::positivePart(volume));
    const Lanes reference = load(&data.referenceVolume(first));
    return load(&data.referenceLength(first)) * (reference + Lanes(2.0) * volume) /
           (Lanes(2.0) * reference + volume);
  }

  /// The motion from n to n + 1, seen from the positions in its middle.
  struct Motion
  {
    Lanes middle[dim][M::count]; ///< modes of the positions
    Lanes volume;
    Lanes dilatation; ///< tr(D) dt V at n + 1/2
    Lanes traceG;     ///< sum of b_jI^2 over nodes and axes [1/m^2]
  };

  void findMotion(const Lanes (&x)[dim][M::count], const Lanes (&v)[dim][M::count], Motion& motion,
                  MaterialPoint<Lanes>& point) const
  {
    const Lanes dt(data.dt), half(0.5), quarter(0.25);
    Lanes b[dim][M::gradients];
    for (int i = 0; i < dim; ++i)
      for (int k = 0; k < M::count; ++k)
        motion.middle[i][k] = x[i][k] - half * dt * v[i][k];
    M::volumeGradient(motion.middle, b);
    motion.volume = M::volume(motion.middle, b);
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
        for (int k = 1; k < M::gradients; ++k)
          sum += v[i][k] * b[j][k];
        l(i, j) = sum * factor;
      }
#pragma GCC unroll 8
      for (int k = 0; k < M::gradients; ++k)
        squares += b[j][k] * b[j][k];
    }
    motion.traceG = Lanes(nodes) * squares * inverseVolume * inverseVolume;

    SymTensorOf<Lanes>& de = point.strainIncrement;
    de.xx = l(0, 0);
    de.yy = l(1, 1);
    de.xy = half * (l(0, 1) + l(1, 0));
    de.zz = de.yz = de.zx = Lanes(0.0);
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
  }

  /// Stress, history, hourglass forces and energies from n to n + 1, with the rates at n + 1/2.
  /// @param volume at n + 1; `length` of the element
  void advance(int first, const Lanes (&v)[dim][M::count], const Motion& motion,
               const Lanes& volume, const Lanes& length, MaterialPoint<Lanes>& point,
               SymTensorOf<Lanes>& stress, HourglassVectors& hourglass) const
  {
    const SymTensorOf<Lanes>& de = point.strainIncrement;
    const Mat3Of<Lanes>& r = point.rotation;
    HourglassVectors oldHourglass;
    for (int a = 0; a < M::hourglass; ++a)
      for (int i = 0; i < dim; ++i)
        oldHourglass[a][i] = hourglass[a][i];

    point.dt = data.dt;
    if (law.usesVolume)
    {
      const Lanes inverseReference = Lanes(1.0) / load(&data.referenceVolume(first));
      point.volumeRatio = volume * inverseReference;
      point.halfVolumeRatio = motion.volume * inverseReference;
      point.energy = (load(&data.energies(int(ElementEnergy::Internal), first)) +
                      load(&data.energies(int(ElementEnergy::Viscous), first))) *
                     inverseReference;
      point.size = length;
    }
    point.oldStress = stress;
    if constexpr (dim == 3)
    {
      point.stress = rotated(stress, r);
      for (int a = 0; a < M::hourglass; ++a)
        for (int i = 0; i < 3; ++i)
          hourglass[a][i] = r.a[i][0] * oldHourglass[a][0] + r.a[i][1] * oldHourglass[a][1] +
                            r.a[i][2] * oldHourglass[a][2];
    }
    else
    {
      const Lanes cosine = r(0, 0), sine = r(1, 0);
      point.stress = rotatedInPlane(stress, cosine, sine);
      for (int h = 0; h < M::hourglass; ++h)
      {
        hourglass[h][0] = cosine * oldHourglass[h][0] - sine * oldHourglass[h][1];
        hourglass[h][1] = sine * oldHourglass[h][0] + cosine * oldHourglass[h][1];
      }
    }
    for (int k = 0; k < law.historyCount; ++k)
      point.history[k] = load(&data.history(k, first));
    law(point);
    for (int k = 0; k < law.historyCount; ++k)
      store(point.history[k], &data.history(k, first));
    storeStress(point.stress, first);

    // The old stress as it was before the rotation: its mean with the new one belongs to n + 1/2 to
    // second order.
    const SymTensorOf<Lanes>& oldStress = point.oldStress;
    stress = point.stress;
    const Lanes work =
        (oldStress.xx + stress.xx) * de.xx + (oldStress.yy + stress.yy) * de.yy +
        (oldStress.zz + stress.zz) * de.zz +
        Lanes(2.0) * ((oldStress.xy + stress.xy) * de.xy + (oldStress.yz + stress.yz) * de.yz +
                      (oldStress.zx + stress.zx) * de.zx);
    addTo(data.energies, ElementEnergy::Internal, first, Lanes(0.5) * motion.volume * work);
    addTo(data.energies, ElementEnergy::PlasticDissipation, first,
          motion.volume * point.dissipation);

    if constexpr (hasHourglass)
    {
      // What a damaged element loses of its hourglass stiffness goes with the forces in it.
      if (law.changesTangent)
      {
        const Lanes kept = point.integrity / load(&data.tangent(1, first));
        for (int a = 0; a < M::hourglass; ++a)
          for (int i = 0; i < dim; ++i)
            hourglass[a][i] *= kept;
      }
      advanceHourglass(first, motion, point, v, oldHourglass, hourglass);
    }
    if (law.changesTangent)
    {
      store(point.stiffening, &data.tangent(0, first));
      store(point.integrity, &data.tangent(1, first));
    }
  }

  /// Hourglass forces, already turned with the element, from n to n + 1, and their work.
  void advanceHourglass(int first, const Motion& motion, const MaterialPoint<Lanes>& point,
                        const Lanes (&v)[dim][M::count], const HourglassVectors& oldHourglass,
                        HourglassVectors& hourglass) const
  {
    const Lanes dt(data.dt), half(0.5);
    const Lanes &volume = motion.volume, &traceG = motion.traceG;
    // Hourglass rates q_ia = gamma_aI v_iI with gamma_aI = (h_aI - (h_a.x_j) b_jI) / n.
    const Lanes stiffness = point.integrity *
                            Lanes(nodes * data.hourglass.stiffness * data.pWaveModulus) * volume *
                            traceG;
    HourglassVectors increment; // q dt [m]
    Lanes hourglassWork(0.0);
    for (int a = 0; a < M::hourglass; ++a)
      for (int i = 0; i < dim; ++i)
      {
        Lanes sum = dt * v[i][dim + a];
        for (int j = 0; j < dim; ++j)
          sum -= motion.middle[j][dim + a] * point.displacementGradient(i, j);
        increment[a][i] = sum;
        hourglass[a][i] += stiffness * sum;
        store(hourglass[a][i], &data.hourglassForce(a * dim + i, first));
        hourglassWork += (oldHourglass[a][i] + hourglass[a][i]) * sum;
      }
    if (data.hourglass.viscosity > 0)
      hourglassWork += advanceHourglassViscosity(first, traceG, volume, increment);
    addTo(data.energies, ElementEnergy::Hourglass, first, half * hourglassWork);
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
  LaneMask storeCornerForces(int first, const Lanes (&x)[dim][M::count],
                             const Lanes (&b)[dim][M::gradients], const SymTensorOf<Lanes>& stress,
                             const Lanes& viscousPressure, const HourglassVectors& hourglass,
                             const Lanes& inverseVolume) const
  {
    Lanes s[dim][dim];
    s[0][0] = stress.xx - viscousPressure;
    s[1][1] = stress.yy - viscousPressure;
    s[0][1] = s[1][0] = stress.xy;
    if constexpr (dim == 3)
    {
      s[2][2] = stress.zz - viscousPressure;
      s[1][2] = s[2][1] = stress.yz;
      s[2][0] = s[0][2] = stress.zx;
    }
    Real force[dim][nodes][laneCount];
    Lanes all(0.0);
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
        if (k < M::gradients)
          for (int j = 0; j < dim; ++j)
            modes[k] -= s[i][j] * b[j][k];
        if (hasHourglass && k >= dim)
          modes[k] -= Lanes(1.0 / nodes) * hourglass[k - dim][i];
        all += modes[k];
      }
      Lanes corners[nodes];
      M::toCorners(modes, corners);
#pragma GCC unroll 8
      for (int c = 0; c < nodes; ++c)
        store(corners[c], force[i][c]);
    }
    for (int lane = 0; lane < laneCount; ++lane)
    {
      Real* const out = &data.cornerForce(first + lane, 0, 0);
      for (int c = 0; c < nodes; ++c)
        for (int i = 0; i < dim; ++i)
          out[3 * c + i] = force[i][c][lane];
    }
    return all * Lanes(0.0) == Lanes(0.0);
  }

  Lanes stableStepOf(const Lanes (&x)[dim][M::count], const Lanes (&b)[dim][M::gradients],
                     const Lanes& inverseVolume, const Lanes& rho, const Lanes& viscosity,
                     const Lanes& stiffening) const
  {
    // g_jk = sum_I b_jI b_kI
    const Lanes scale = Lanes(nodes) * inverseVolume * inverseVolume;
    Lanes g[dim][dim];
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k <= j; ++k)
      {
        Lanes sum = b[j][0] * b[k][0];
#pragma GCC unroll 8
        for (int m = 1; m < M::gradients; ++m)
          sum += b[j][m] * b[k][m];
        g[j][k] = g[k][j] = sum * scale;
      }
    const Real lambda = data.lambda > 0 ? data.lambda : 0;
    const Real c = lambda / (2 * data.shearModulus);
    Lanes trace, fastest;
    if constexpr (dim == 3)
    {
      const Lanes m0 = g[1][1] * g[2][2] - g[1][2] * g[1][2];
      const Lanes m1 = g[0][0] * g[2][2] - g[0][2] * g[0][2];
      const Lanes m2 = g[0][0] * g[1][1] - g[0][1] * g[0][1];
      trace = g[0][0] + g[1][1] + g[2][2];
      const Lanes det = g[0][0] * m0 - g[0][1] * (g[0][1] * g[2][2] - g[1][2] * g[0][2]) +
                        g[0][2] * (g[0][1] * g[1][2] - g[1][1] * g[0][2]);
      fastest = fastestStrainMode(trace, m0 + m1 + m2, det, c);
    }
    else
    {
      trace = g[0][0] + g[1][1];
      fastest = fastestStrainMode(trace, g[0][0] * g[1][1] - g[0][1] * g[0][1], c);
    }
    const Lanes perMass = Lanes(nodes) / rho;
    const Lanes strain = stiffening * perMass * Lanes(2 * data.shearModulus) * fastest;
    Lanes damping = perMass * rho * viscosity * trace;

    // Hourglass: squared lengths of gamma_a, and b_j.gamma_a, which vanishes for parallelepipeds.
    Lanes lengths(0.0), products(0.0);
    for (int a = 0; a < M::hourglass; ++a)
    {
      Lanes length(1.0 / nodes);
      for (int j = 0; j < dim; ++j)
      {
        Lanes along = x[0][dim + a] * g[0][j];
        for (int k = 1; k < dim; ++k)
          along += x[k][dim + a] * g[k][j];
        Lanes shape(0.0);
        if (dim + a < M::gradients)
          shape = b[j][dim + a < M::gradients ? dim + a : 0] * inverseVolume;
        const Lanes product = shape - along;
        length -= x[j][dim + a] * (shape + product);
        products += product * product;
      }
      lengths += length;
    }
    const Lanes perGamma =
        Lanes(nodes * data.hourglass.stiffness * data.pWaveModulus) * trace * perMass;
    const Lanes coupling =
        stiffening * perMass * Lanes(dim * lambda + 2 * data.shearModulus) * perGamma * products;
    if (data.hourglass.viscosity > 0)
      damping += Lanes(2.0 * nodes * data.hourglass.viscosity) *
                 stdx::sqrt(perMass * Lanes(data.pWaveModulus) * trace) * lengths;
    return stableStep(largestOfSum(strain, perGamma * lengths, coupling), damping);
  }
};

/// The commonest laws become part of the kernel; the others are called once per batch.
template <ElementType type>
void updateElements(const ElementKernelData& data)
{
  const auto run = [&](const auto& law)
  {
    using Law = std::decay_t<decltype(law)>;
    parallelFor("coplane::element::update", data.batches, ElementKernel<type, Law>{data, law});
  };
  if (const auto* elastic = std::get_if<LinearElastic>(data.material))
    run(*elastic);
  else if (const auto* j2 = std::get_if<J2Plasticity>(data.material))
    run(*j2);
  else
    run(lawFunction(*data.material));
}
} // namespace coplane
