#pragma once

#include <coplane_element/StableStep.hpp>
#include <coplane_element/detail/AssumedStrain.hpp>
#include <coplane_element/detail/ElementShape.hpp>

namespace coplane
{
/// Stable steps of a batch of elements with one point, at n + 1.
template <ElementType type, Geometry geometry>
struct OnePointStep
{
  using Shape = ElementShape<type, geometry>;
  using M = Modes<type>;
  using Field = typename Shape::Field;
  using Gradient = typename Shape::Gradient;
  static constexpr int dim = M::dimension;
  static constexpr int nodes = M::nodes;
  static constexpr bool hasHourglass = Shape::hasHourglass;
  static constexpr int gradients = Shape::gradients;

  const ElementKernelData& data;

  /// @param viscosity of the bulk viscosity (ViscousPressure) [m^2/s]
  /// @param stiffening tangent of the material over the elastic one [-]
  /// @return [s]
  KOKKOS_FORCEINLINE_FUNCTION Lanes of(int first, const Field& x, const Gradient& g,
                                       const Lanes& viscosity, const Lanes& stiffening) const
  {
    if constexpr (Shape::revolved)
      return ofRing(first, x, g, viscosity, stiffening);
    else
      return ofBrick(first, x, g, viscosity, stiffening);
  }

private:
  /// Operators of the corners of a ring over its volume.
  struct RingCorners
  {
    Lanes b[2][nodes];   ///< [1/m]
    Lanes hoop[nodes];   ///< [1/m]
    Lanes weight[nodes]; ///< V / m_I [m^3/kg]
  };

  /// Masses of the corners differ: StableStep.hpp, on the corners themselves.
  KOKKOS_FORCEINLINE_FUNCTION Lanes ofRing(int first, const Field& x, const Gradient& g,
                                           const Lanes& viscosity, const Lanes& stiffening) const
  {
    const Lanes inverseVolume = Lanes(1.0) / g.volume;
    const RingCorners corners = cornersOf(first, g, inverseVolume);
    Lanes traceG(0.0), volumetric(0.0);
    for (int c = 0; c < nodes; ++c)
    {
      const Lanes &br = corners.b[0][c], &by = corners.b[1][c];
      traceG += br * br + by * by;
      const Lanes radial = br + corners.hoop[c];
      volumetric += corners.weight[c] * (radial * radial + by * by);
    }
    const Lanes strain = stiffening * fastestRevolvedMode(corners.b, corners.hoop, corners.weight,
                                                          data.lambdaOfBound(), data.shearModulus);
    const Lanes rho = load(&data.mass(first)) * inverseVolume;
    Lanes damping = rho * viscosity * volumetric;
    Lanes hourglass(0.0);
    if constexpr (hasHourglass)
      hourglass = hourglassOfRing(x, corners, traceG, rho, damping);
    return stableStep(strain + hourglass, damping);
  }

  KOKKOS_FORCEINLINE_FUNCTION RingCorners cornersOf(int first, const Gradient& g,
                                                    const Lanes& inverseVolume) const
  {
    RingCorners corners;
    Lanes modes[M::count];
    for (int j = 0; j < 2; ++j)
    {
      for (int k = 0; k < M::count; ++k)
        modes[k] = k < gradients ? Shape::modeOf(g.b[j], k) * inverseVolume : Lanes(0.0);
      M::toCorners(modes, corners.b[j]);
    }
    for (int k = 0; k < M::count; ++k)
      modes[k] = k < gradients ? g.hoop[k < gradients ? k : 0] * inverseVolume : Lanes(0.0);
    M::toCorners(modes, corners.hoop);
    for (int c = 0; c < nodes; ++c)
    {
      corners.hoop[c] += g.hoop[gradients] * inverseVolume;
      corners.weight[c] = g.volume / load(&data.cornerMass(c, first));
    }
    return corners;
  }

  /// Squared frequency of the hourglass mode [1/s^2]; adds what its viscosity damps.
  KOKKOS_FORCEINLINE_FUNCTION Lanes hourglassOfRing(const Field& x, const RingCorners& corners,
                                                    const Lanes& traceG, const Lanes& rho,
                                                    Lanes& damping) const
  {
    // gamma_I = h_I / n - (h.x_j / n) b_jI
    Lanes hourglass(0.0);
    for (int c = 0; c < nodes; ++c)
    {
      const Lanes gamma = Lanes((c % 2 == 0 ? 1.0 : -1.0) / nodes) -
                          (x.modes[0][dim] * corners.b[0][c] + x.modes[1][dim] * corners.b[1][c]);
      hourglass += corners.weight[c] * gamma * gamma;
    }
    if (data.hourglass.viscosity > 0)
      damping += Lanes(2.0 * data.hourglass.viscosity) * rho *
                 stdx::sqrt(Lanes(nodes * data.pWaveModulus) * traceG / rho) * hourglass;
    if (data.options.form != ElementForm::AssumedStrain)
      return hourglass * (Lanes(nodes * data.hourglass.stiffness * data.pWaveModulus) * traceG);
    const AssumedStrainModuli moduli(data.lambda, data.shearModulus);
    const Lanes perRadius = Lanes(1.0) / x.mean;
    const Lanes largest(moduli.largestOfRing() / 3);
    hourglass *= largest / shortestSquared(x) + Lanes(moduli.young / 9) * perRadius * perRadius;
    return hourglass + largest * hoopSlopesOf(x, corners, perRadius);
  }

  /// sum_I e_I^2 V / m_I of the two hoop slopes [m/kg].
  static KOKKOS_FORCEINLINE_FUNCTION Lanes hoopSlopesOf(const Field& x, const RingCorners& corners,
                                                        const Lanes& perRadius)
  {
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
        const Lanes e = perRadius * (shape[c] - Lanes(1.0 / nodes) * perRadius * x.modes[0][k]);
        slopes += corners.weight[c] * e * e;
      }
    }
    return slopes;
  }

  /// Equal masses in all corners.
  KOKKOS_FORCEINLINE_FUNCTION Lanes ofBrick(int first, const Field& x, const Gradient& gradient,
                                            const Lanes& viscosity, const Lanes& stiffening) const
  {
    const Lanes inverseVolume = Lanes(1.0) / gradient.volume;
    const Lanes rho = load(&data.mass(first)) * inverseVolume;
    // g_jk = sum_I b_jI b_kI
    const Lanes scale = Lanes(nodes) * inverseVolume * inverseVolume;
    const auto& b = gradient.b;
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
    const Real lambda = data.lambdaOfBound();
    const Lanes trace = traceOf(g);
    const Lanes fastest = fastestStrainMode(g, lambda / (2 * data.shearModulus));
    const Lanes perMass = Lanes(nodes) / rho;
    const Lanes strain = stiffening * perMass * Lanes(2 * data.shearModulus) * fastest;
    Lanes damping = perMass * rho * viscosity * trace;

    const Gammas gammas = gammasOf(x, b, g, inverseVolume);
    Lanes perGamma = Lanes(nodes * data.hourglass.stiffness * data.pWaveModulus) * trace * perMass;
    if constexpr (hasHourglass)
      if (data.options.form == ElementForm::AssumedStrain)
        perGamma = assumedStrainBound(x) * perMass;
    const Lanes coupling = stiffening * perMass * Lanes(dim * lambda + 2 * data.shearModulus) *
                           perGamma * gammas.products;
    if (data.hourglass.viscosity > 0)
      damping += Lanes(2.0 * nodes * data.hourglass.viscosity) *
                 stdx::sqrt(perMass * Lanes(data.pWaveModulus) * trace) * gammas.lengths;
    return stableStep(largestOfSum(strain, perGamma * gammas.lengths, coupling), damping);
  }

  /// Sums over the hourglass shapes gamma_a: of their squared lengths, and of the squares of
  /// b_j.gamma_a, which vanish for parallelepipeds.
  struct Gammas
  {
    Lanes lengths = Lanes(0.0), products = Lanes(0.0);
  };
  static KOKKOS_FORCEINLINE_FUNCTION Gammas gammasOf(const Field& x,
                                                     const Lanes (&b)[dim][gradients],
                                                     const Lanes (&g)[dim][dim],
                                                     const Lanes& inverseVolume)
  {
    Gammas sums;
    for (int a = 0; a < M::hourglass; ++a)
    {
      Lanes length(1.0 / nodes);
      for (int j = 0; j < dim; ++j)
      {
        Lanes along = x.modes[0][dim + a] * g[0][j];
        for (int k = 1; k < dim; ++k)
          along += x.modes[k][dim + a] * g[k][j];
        Lanes shape(0.0);
        if (dim + a < gradients)
          shape = Shape::modeOf(b[j], dim + a) * inverseVolume;
        const Lanes product = shape - along;
        length -= x.modes[j][dim + a] * (shape + product);
        sums.products += product * product;
      }
      sums.lengths += length;
    }
    return sums;
  }

  /// Bound of the stiffness of the hourglass modes over the volume [Pa/m^2].
  KOKKOS_FORCEINLINE_FUNCTION Lanes assumedStrainBound(const Field& x) const
  {
    const AssumedStrainModuli moduli(data.lambda, data.shearModulus);
    return Lanes(moduli.template largest<dim>() / 3) / shortestSquared(x);
  }

  /// Of the half edges [m^2].
  static KOKKOS_FORCEINLINE_FUNCTION Lanes shortestSquared(const Field& x)
  {
    Lanes shortest;
    for (int k = 0; k < dim; ++k)
    {
      Lanes squared = x.modes[0][k] * x.modes[0][k];
      for (int i = 1; i < dim; ++i)
        squared += x.modes[i][k] * x.modes[i][k];
      shortest = k == 0 ? squared : lanesMin(shortest, squared);
    }
    return shortest;
  }
};
} // namespace coplane
