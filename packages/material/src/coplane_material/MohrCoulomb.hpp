#pragma once

#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>
#include <coplane_material/Principal.hpp>

namespace coplane
{
/// Mohr and Coulomb's planes with a tension cut-off: N s1 - s3 <= 2 c sqrt(N) and s1 <= ft, for
/// principal stresses s1 >= s2 >= s3, tension positive, N = (1 + sin phi) / (1 - sin phi). Plastic
/// flow with N_psi on the same planes, normal to the cut-off. Returns to planes, edges and corners
/// as of de Souza Neto et al. (2008), section 8.2. Cohesion falls with the slip that is smeared
/// over the element, tensile strength with the opening: the dissipated energies per area do not
/// depend on the size of the element. Strengths are those at the start of the step.
struct MohrCoulomb
{
  LinearElastic elastic;
  Real friction;         ///< N [-]
  Real dilation;         ///< N_psi [-]; 1 <= N_psi <= N
  Real cohesion;         ///< c [Pa]
  Real residualCohesion; ///< [Pa]
  Real tensileStrength;  ///< ft [Pa]
  Real shearEnergy;      ///< G_II, by which c falls [J/m^2]; 0: it does not fall
  Real fractureEnergy;   ///< G_I, by which ft falls [J/m^2]; 0: it does not fall

  static constexpr int historyCount = 3;
  static constexpr const char* historyNames[] = {"equivalent_plastic_strain", "plastic_shear",
                                                 "crack_opening"};
  static constexpr bool usesVolume = true, changesTangent = false;

  template <class T>
  KOKKOS_INLINE_FUNCTION T cohesionAfter(const T& slip, const T& size) const
  {
    if (shearEnergy <= 0)
      return T(cohesion);
    const Real fall = cohesion - residualCohesion;
    return T(residualCohesion) +
           T(fall) * branchFree::exponential(T(-fall / shearEnergy) * slip * size);
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION T tensionAfter(const T& opening, const T& size) const
  {
    if (fractureEnergy <= 0)
      return T(tensileStrength);
    return T(tensileStrength) *
           branchFree::exponential(T(-tensileStrength / fractureEnergy) * opening * size);
  }

  enum Surface : int
  {
    Plane13, // N s1 - s3
    Plane12, // N s1 - s2, beside Plane13 where s2 = s3
    Plane23, // N s2 - s3, beside Plane13 where s1 = s2
    Cut1,
    Cut2,
    Cut3
  };

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose;
    const T zero(0.0);
    T* const h = point.history;
    elastic.addElasticIncrement(point.strainIncrement, point.stress);
    Principal<T> principal = principalOf(point.stress);
    T(&s)[3] = principal.value;
    const T bond = T(2 * std::sqrt(friction)) * cohesionAfter(h[1], point.size);
    T cut = tensionAfter(h[2], point.size);
    if (friction > 1) // the cut-off lies before the tip
      cut = branchFree::smaller(cut, bond * T(1 / (friction - 1)));

    const T tolerance(1e-9 * (cohesion + tensileStrength));
    const auto yields = T(friction) * s[0] - s[2] - bond > T(0.0) || s[0] > cut;
    if (!branchFree::anyOf(yields))
      return;
    const T trial[3] = {s[0], s[1], s[2]};
    T slips(0.0), openings(0.0), flow[3] = {zero, zero, zero};
    auto open = yields;
    // From the fewest surfaces to the most; the corner of pure tension is the last resort.
    constexpr int sets[10][3] = {{Plane13, -1, -1},        {Cut1, -1, -1},
                                 {Plane13, Plane23, -1},   {Plane13, Plane12, -1},
                                 {Plane13, Cut1, -1},      {Cut1, Cut2, -1},
                                 {Plane13, Plane12, Cut1}, {Plane13, Plane23, Cut1},
                                 {Plane13, Cut1, Cut2},    {Cut1, Cut2, Cut3}};
    for (int k = 0; k < 10 && branchFree::anyOf(open); ++k)
    {
      int count = 0;
      while (count < 3 && sets[k][count] >= 0)
        ++count;
      T multiplier[3] = {zero, zero, zero}, result[3];
      solve(sets[k], count, trial, bond, cut, multiplier);
      for (int i = 0; i < 3; ++i)
        result[i] = trial[i];
      T setFlow[3] = {zero, zero, zero};
      for (int m = 0; m < count; ++m)
      {
        Real g[3], dg[3];
        flowOf(sets[k][m], g, dg);
        for (int i = 0; i < 3; ++i)
        {
          result[i] -= T(dg[i]) * multiplier[m];
          setFlow[i] += T(g[i]) * multiplier[m];
        }
      }
      auto good = open && T(friction) * result[0] - result[2] - bond < tolerance &&
                  result[0] - cut < tolerance && result[0] - result[1] > -tolerance &&
                  result[1] - result[2] > -tolerance;
      for (int m = 0; m < count; ++m)
        good = good && multiplier[m] >= zero;
      if (k == 9)
        good = open;
      for (int i = 0; i < 3; ++i)
      {
        s[i] = choose(good, result[i], s[i]);
        flow[i] = choose(good, setFlow[i], flow[i]);
      }
      for (int m = 0; m < count; ++m)
      {
        const bool opens = sets[k][m] >= Cut1;
        slips += choose(good, opens ? zero : T(1 + dilation) * multiplier[m], zero);
        openings += choose(good, opens ? multiplier[m] : zero, zero);
      }
      open = open && !good;
    }
    const SymTensorOf<T> returned = tensorOf(principal);
    point.stress = {
        choose(yields, returned.xx, point.stress.xx), choose(yields, returned.yy, point.stress.yy),
        choose(yields, returned.zz, point.stress.zz), choose(yields, returned.xy, point.stress.xy),
        choose(yields, returned.yz, point.stress.yz), choose(yields, returned.zx, point.stress.zx)};
    const T mean = T(1.0 / 3.0) * (flow[0] + flow[1] + flow[2]);
    T squares = zero;
    for (int i = 0; i < 3; ++i)
    {
      squares += (flow[i] - mean) * (flow[i] - mean);
      point.dissipation += s[i] * flow[i];
    }
    h[0] += branchFree::squareRoot(T(2.0 / 3.0) * squares);
    h[1] += slips;
    h[2] += openings;
  }

private:
  /// Normal of a surface in principal stresses.
  KOKKOS_INLINE_FUNCTION void normalOf(int surface, Real (&n)[3]) const
  {
    direction(surface, friction, n);
  }
  /// Direction of plastic flow, and the stress that it takes away.
  KOKKOS_INLINE_FUNCTION void flowOf(int surface, Real (&g)[3], Real (&dg)[3]) const
  {
    direction(surface, dilation, g);
    const Real lambda = elastic.bulkModulus - 2.0 / 3.0 * elastic.shearModulus;
    for (int i = 0; i < 3; ++i)
      dg[i] = lambda * (g[0] + g[1] + g[2]) + 2 * elastic.shearModulus * g[i];
  }
  KOKKOS_INLINE_FUNCTION static void direction(int surface, Real slope, Real (&n)[3])
  {
    n[0] = n[1] = n[2] = 0;
    if (surface >= Cut1)
      n[surface - Cut1] = 1;
    else
    {
      n[surface == Plane23 ? 1 : 0] = slope;
      n[surface == Plane12 ? 1 : 2] = -1;
    }
  }

  /// Multipliers that bring the trial stress onto all surfaces of a set.
  template <class T>
  KOKKOS_INLINE_FUNCTION void solve(const int (&set)[3], int count, const T (&trial)[3],
                                    const T& bond, const T& cut, T (&multiplier)[3]) const
  {
    Mat3 a{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    T over[3] = {T(0.0), T(0.0), T(0.0)};
    for (int i = 0; i < count; ++i)
    {
      Real n[3];
      normalOf(set[i], n);
      over[i] = T(n[0]) * trial[0] + T(n[1]) * trial[1] + T(n[2]) * trial[2] -
                (set[i] >= Cut1 ? cut : bond);
      for (int j = 0; j < count; ++j)
      {
        Real g[3], dg[3];
        flowOf(set[j], g, dg);
        a(i, j) = n[0] * dg[0] + n[1] * dg[1] + n[2] * dg[2];
      }
    }
    const Mat3 b = inverse(a);
    for (int i = 0; i < count; ++i)
      multiplier[i] = T(b(i, 0)) * over[0] + T(b(i, 1)) * over[1] + T(b(i, 2)) * over[2];
  }
};

struct MohrCoulombParameters
{
  Real frictionAngle, dilationAngle;        // [rad]
  Real cohesion, residualCohesion;          // [Pa]
  Real tensileStrength;                     // [Pa]; at most c cot(phi)
  Real shearEnergy = 0, fractureEnergy = 0; // [J/m^2]; 0: no softening
};
/// Throws Error(ExitCode::Deck) with what is wrong.
MohrCoulomb makeMohrCoulomb(const LinearElastic& elastic, const MohrCoulombParameters& parameters);
} // namespace coplane
