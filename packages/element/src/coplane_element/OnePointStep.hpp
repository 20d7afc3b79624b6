#pragma once

#include <coplane_element/AssumedStrain.hpp>
#include <coplane_element/ElementKernelData.hpp>
#include <coplane_element/Revolved.hpp>
#include <coplane_element/StableStep.hpp>

namespace coplane
{
/// Sizes and mean-gradient operators of the elements with one point.
template <ElementType type, bool revolved>
struct OnePointShape
{
  using M = Modes<type>;
  static constexpr int dim = M::dimension;
  static constexpr int nodes = M::nodes;
  static constexpr bool hasHourglass = M::hourglass > 0;
  static constexpr int gradients = []
  {
    if constexpr (revolved)
      return Revolved<type>::gradients;
    else
      return M::gradients;
  }();
  /// Modes of the hoop operator, the last its mean (Revolved.hpp).
  using Hoop = Lanes[revolved ? gradients + 1 : 1];

  static Lanes volumeGradient(const Lanes (&x)[dim][M::count], const Lanes& meanRadius,
                              Lanes (&b)[dim][gradients], Hoop& hoop)
  {
    if constexpr (revolved)
      return Revolved<type>::volumeGradient(x, meanRadius, b, hoop);
    else
    {
      M::volumeGradient(x, b);
      return M::volume(x, b);
    }
  }

  /// Area of the section [m^2].
  static Lanes areaOf(const Hoop& hoop)
  {
    return Lanes(nodes / (2 * pi)) * hoop[revolved ? gradients : 0];
  }
};

/// Stable steps of a batch of them, at n + 1.
template <ElementType type, bool revolved>
struct OnePointStep
{
  using Shape = OnePointShape<type, revolved>;
  using M = Modes<type>;
  using Hoop = typename Shape::Hoop;
  static constexpr int dim = M::dimension;
  static constexpr int nodes = M::nodes;
  static constexpr bool hasHourglass = Shape::hasHourglass;
  static constexpr int gradients = Shape::gradients;

  const ElementKernelData& data;

  /// Masses of the corners differ: StableStep.hpp, on the corners themselves.
  Lanes ofRing(int first, const Lanes (&x)[dim][M::count], const Lanes& radius,
               const Lanes (&b)[dim][gradients], const Hoop& hoop, const Lanes& volume,
               const Lanes& viscosity, const Lanes& stiffening) const
  {
    const Lanes inverseVolume = Lanes(1.0) / volume;
    Lanes corner[2][nodes], around[nodes];
    for (int j = 0; j < 2; ++j)
    {
      Lanes modes[M::count];
      for (int k = 0; k < M::count; ++k)
        modes[k] = k < gradients ? b[j][k < gradients ? k : 0] * inverseVolume : Lanes(0.0);
      M::toCorners(modes, corner[j]);
    }
    Lanes modes[M::count];
    for (int k = 0; k < M::count; ++k)
      modes[k] = k < gradients ? hoop[k < gradients ? k : 0] * inverseVolume : Lanes(0.0);
    M::toCorners(modes, around);
    Lanes weight[nodes]; // V / m_I [m^3/kg]
    Lanes traceG(0.0), volumetric(0.0), hourglass(0.0);
    for (int c = 0; c < nodes; ++c)
    {
      around[c] += hoop[revolved ? gradients : 0] * inverseVolume;
      weight[c] = volume / load(&data.cornerMass(c, first));
      traceG += corner[0][c] * corner[0][c] + corner[1][c] * corner[1][c];
      const Lanes radial = corner[0][c] + around[c];
      volumetric += weight[c] * (radial * radial + corner[1][c] * corner[1][c]);
    }
    const Real lambda = data.lambda > 0 ? data.lambda : 0;
    const Lanes strain =
        stiffening * fastestRevolvedMode(corner, around, weight, lambda, data.shearModulus);
    const Lanes rho = load(&data.mass(first)) * inverseVolume;
    Lanes damping = rho * viscosity * volumetric;
    if constexpr (hasHourglass)
    {
      // gamma_I = h_I / n - (h.x_j / n) b_jI
      for (int c = 0; c < nodes; ++c)
      {
        const Lanes gamma = Lanes((c % 2 == 0 ? 1.0 : -1.0) / nodes) -
                            (x[0][dim] * corner[0][c] + x[1][dim] * corner[1][c]);
        hourglass += weight[c] * gamma * gamma;
      }
      const Lanes stiffness = Lanes(nodes * data.hourglass.stiffness * data.pWaveModulus) * traceG;
      if (data.hourglass.viscosity > 0)
        damping += Lanes(2.0 * data.hourglass.viscosity) * rho *
                   stdx::sqrt(Lanes(nodes * data.pWaveModulus) * traceG / rho) * hourglass;
      if (data.options.form == ElementForm::AssumedStrain)
      {
        const AssumedStrainModuli moduli(data.lambda, data.shearModulus);
        const Lanes perRadius = Lanes(1.0) / radius;
        const Lanes largest(moduli.largestOfRing() / 3);
        hourglass *= largest / shortestSquared(x) + Lanes(moduli.young / 9) * perRadius * perRadius;
        Lanes slopes(0.0);
        for (int k = 0; k < 2; ++k)
        {
          // e_kI = (the mode k of corner I) / (n r) - x_k / (n r^2)
          Lanes one[M::count], shape[nodes];
          for (int m = 0; m < M::count; ++m)
            one[m] = Lanes(m == k ? 1.0 / nodes : 0.0);
          M::toCorners(one, shape);
          for (int c = 0; c < nodes; ++c)
          {
            const Lanes e = perRadius * (shape[c] - Lanes(1.0 / nodes) * perRadius * x[0][k]);
            slopes += weight[c] * e * e;
          }
        }
        hourglass += largest * slopes;
      }
      else
        hourglass *= stiffness;
    }
    return stableStep(strain + hourglass, damping);
  }

  Lanes of(const Lanes (&x)[dim][M::count], const Lanes (&b)[dim][gradients],
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
        for (int m = 1; m < gradients; ++m)
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
        if (dim + a < gradients)
          shape = b[j][dim + a < gradients ? dim + a : 0] * inverseVolume;
        const Lanes product = shape - along;
        length -= x[j][dim + a] * (shape + product);
        products += product * product;
      }
      lengths += length;
    }
    Lanes perGamma = Lanes(nodes * data.hourglass.stiffness * data.pWaveModulus) * trace * perMass;
    if constexpr (hasHourglass)
      if (data.options.form == ElementForm::AssumedStrain)
        perGamma = assumedStrainBound(x) * perMass;
    const Lanes coupling =
        stiffening * perMass * Lanes(dim * lambda + 2 * data.shearModulus) * perGamma * products;
    if (data.hourglass.viscosity > 0)
      damping += Lanes(2.0 * nodes * data.hourglass.viscosity) *
                 stdx::sqrt(perMass * Lanes(data.pWaveModulus) * trace) * lengths;
    return stableStep(largestOfSum(strain, perGamma * lengths, coupling), damping);
  }

  /// Bound of the stiffness of the hourglass modes over the volume [Pa/m^2].
  Lanes assumedStrainBound(const Lanes (&x)[dim][M::count]) const
  {
    const AssumedStrainModuli moduli(data.lambda, data.shearModulus);
    return Lanes(moduli.template largest<dim>() / 3) / shortestSquared(x);
  }

  /// Of the half edges [m^2].
  static Lanes shortestSquared(const Lanes (&x)[dim][M::count])
  {
    Lanes shortest;
    for (int k = 0; k < dim; ++k)
    {
      Lanes squared = x[0][k] * x[0][k];
      for (int i = 1; i < dim; ++i)
        squared += x[i][k] * x[i][k];
      shortest = k == 0 ? squared : lanesMin(shortest, squared);
    }
    return shortest;
  }
};
} // namespace coplane
