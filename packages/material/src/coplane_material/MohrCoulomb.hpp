#pragma once

#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>
#include <coplane_material/Principal.hpp>

#include <vector>

namespace coplane
{
/// Mohr and Coulomb's planes with a tension cut-off: N s1 - s3 <= 2 c sqrt(N) and s1 <= ft, for
/// principal stresses s1 >= s2 >= s3, tension positive, N = (1 + sin phi) / (1 - sin phi). Plastic
/// flow with N_psi on the same planes, normal to the cut-off. Returns to planes, edges and corners
/// as of de Souza Neto et al. (2008), section 8.2. Cohesion falls with the slip that is smeared
/// over the element, tensile strength with the opening: the dissipated energies per area do not
/// depend on the size of the element. Or cohesion and friction follow a table of the plastic shear,
/// whatever the size. Strengths are those at the start of the step.
struct MohrCoulomb
{
  static constexpr int capacity = 8; ///< points of the table

  LinearElastic elastic;
  Real friction;                        ///< N [-]
  Real dilation;                        ///< N_psi [-]; 1 <= N_psi <= N
  Real cohesion;                        ///< c [Pa]
  Real residualCohesion;                ///< [Pa]
  Real tensileStrength;                 ///< ft [Pa]
  Real shearEnergy;                     ///< G_II, by which c falls [J/m^2]; 0: it does not fall
  Real fractureEnergy;                  ///< G_I, by which ft falls [J/m^2]; 0: it does not fall
  int points = 0;                       ///< of the table; 0: none
  Real shears[capacity] = {};           ///< plastic shears, rising from 0 [-]
  Real cohesions[capacity] = {};        ///< at these [Pa]
  Real frictionTangents[capacity] = {}; ///< tan(phi) at these [-]

  static constexpr int historyCount = 3;
  static constexpr const char* historyNames[] = {"equivalent_plastic_strain", "plastic_shear",
                                                 "crack_opening"};
  static constexpr bool usesVolume = true, changesTangent = false, hasStrength = true;

  template <class T>
  KOKKOS_INLINE_FUNCTION T cohesionAfter(const T& slip, const T& size) const
  {
    if (shearEnergy <= 0)
      return T(cohesion);
    const Real fall = cohesion - residualCohesion;
    return T(residualCohesion) +
           T(fall) * branchFree::exponential(T(-fall / shearEnergy) * slip * size);
  }
  /// Between the points of the table straight lines, beyond them the last value.
  template <class T>
  KOKKOS_INLINE_FUNCTION T fromTable(const Real (&values)[capacity], const T& shear) const
  {
    T value(values[0]);
    for (int i = 1; i < points; ++i)
    {
      const T way = branchFree::smaller(shear, T(shears[i])) - T(shears[i - 1]);
      value += branchFree::positivePart(way) *
               T((values[i] - values[i - 1]) / (shears[i] - shears[i - 1]));
    }
    return value;
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
    // N = (sqrt(1 + t^2) + t)^2 with t = tan(phi)
    T slope(friction), bond;
    if (points > 0)
    {
      const T tangent = fromTable(frictionTangents, h[1]);
      const T root = branchFree::squareRoot(T(1.0) + tangent * tangent) + tangent;
      slope = root * root;
      bond = T(2.0) * root * fromTable(cohesions, h[1]);
    }
    else
      bond = T(2 * std::sqrt(friction)) * cohesionAfter(h[1], point.size);
    T cut = tensionAfter(h[2], point.size);
    // The cut-off lies before the tip.
    cut = choose(slope > T(1.0), branchFree::smaller(cut, bond / (slope - T(1.0))), cut);

    const T tolerance(1e-9 * (cohesion + tensileStrength));
    const auto yields = slope * s[0] - s[2] - bond > T(0.0) || s[0] > cut;
    const T q = vonMisesOf(s), bending = branchFree::squareRoot(point.bendingSquared);
    if (!branchFree::anyOf(yields))
    {
      point.bendingScale = scaleOf(bending, T(1.0), s, slope, bond, cut);
      return;
    }
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
      solve(sets[k], count, trial, slope, bond, cut, multiplier);
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
      auto good = open && slope * result[0] - result[2] - bond < tolerance &&
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
    point.bendingScale =
        scaleOf(bending, choose(q > zero, vonMisesOf(s) / q, T(1.0)), s, slope, bond, cut);
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
  template <class T>
  KOKKOS_INLINE_FUNCTION static T vonMisesOf(const T (&s)[3])
  {
    const T a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
    return branchFree::squareRoot(T(0.5) * (a * a + b * b + c * c));
  }
  /// Bending falls by the factor of the return, and ends where fibres beside the mean stress shear
  /// in compression or reach the cut-off; along which axis it acts is not known here. It flows by
  /// itself: planes and edges know no other component.
  template <class T>
  KOKKOS_INLINE_FUNCTION static T scaleOf(const T& bending, const T& factor, const T (&s)[3],
                                          const T& slope, const T& bond, const T& cut)
  {
    const T mean = T(1.0 / 3.0) * (s[0] + s[1] + s[2]);
    const T sheared = T(3.0) * (bond - (slope - T(1.0)) * mean) / (slope + T(2.0));
    const T most = branchFree::positivePart(branchFree::smaller(sheared, cut - mean));
    const T kept = branchFree::smaller(factor, T(1.0));
    return branchFree::choose(kept * bending > most, most / bending, kept);
  }
  /// Direction of plastic flow, and the stress that it takes away.
  KOKKOS_INLINE_FUNCTION void flowOf(int surface, Real (&g)[3], Real (&dg)[3]) const
  {
    direction<Real>(surface, dilation, g);
    const Real lambda = elastic.bulkModulus - 2.0 / 3.0 * elastic.shearModulus;
    for (int i = 0; i < 3; ++i)
      dg[i] = lambda * (g[0] + g[1] + g[2]) + 2 * elastic.shearModulus * g[i];
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION static void direction(int surface, const T& slope, T (&n)[3])
  {
    n[0] = n[1] = n[2] = T(0.0);
    if (surface >= Cut1)
      n[surface - Cut1] = T(1.0);
    else
    {
      n[surface == Plane23 ? 1 : 0] = slope;
      n[surface == Plane12 ? 1 : 2] = T(-1.0);
    }
  }

  /// Multipliers that bring the trial stress onto all surfaces of a set.
  template <class T>
  KOKKOS_INLINE_FUNCTION void solve(const int (&set)[3], int count, const T (&trial)[3],
                                    const T& slope, const T& bond, const T& cut,
                                    T (&multiplier)[3]) const
  {
    const T one(1.0), zero(0.0);
    Mat3Of<T> a{{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}};
    T over[3] = {T(0.0), T(0.0), T(0.0)};
    for (int i = 0; i < count; ++i)
    {
      T n[3]; // normal of the surface in principal stresses
      direction<T>(set[i], slope, n);
      over[i] = n[0] * trial[0] + n[1] * trial[1] + n[2] * trial[2] - (set[i] >= Cut1 ? cut : bond);
      for (int j = 0; j < count; ++j)
      {
        Real g[3], dg[3];
        flowOf(set[j], g, dg);
        a.a[i][j] = n[0] * T(dg[0]) + n[1] * T(dg[1]) + n[2] * T(dg[2]);
      }
    }
    const Mat3Of<T> b = inverse(a);
    for (int i = 0; i < count; ++i)
      multiplier[i] = b.a[i][0] * over[0] + b.a[i][1] * over[1] + b.a[i][2] * over[2];
  }
};

struct MohrCoulombParameters : ElasticParameters
{
  Real cohesion = 0;         ///< [Pa]
  Real friction = 0;         ///< tan(phi) [-]
  Real dilation = 0;         ///< tan(psi) [-]; at most the friction
  Real residualCohesion = 0; ///< [Pa]
  Real tensileStrength = 0;  ///< [Pa]; at most c cot(phi)
  Real shearEnergy = 0;      ///< G_II [J/m^2]; 0: no softening
  Real fractureEnergy = 0;   ///< G_I [J/m^2]; 0: no softening
  /// A table in place of cohesion, friction and residual cohesion; empty: none.
  std::vector<Real> plasticShears; ///< rising from 0 [-]
  std::vector<Real> cohesions;     ///< [Pa]
  std::vector<Real> frictions;     ///< tan(phi) [-]

  static MaterialModel model();
};
/// Throws Error(ExitCode::Deck) with what is wrong.
MohrCoulomb makeLaw(const MohrCoulombParameters& parameters);
} // namespace coplane
