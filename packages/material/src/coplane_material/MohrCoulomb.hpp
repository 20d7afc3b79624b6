#pragma once

#include <coplane_core/ElementaryFunctions.hpp>
#include <coplane_material/Invariants.hpp>
#include <coplane_material/PrincipalReturn.hpp>

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
    return principalReturn::tensionAfter(tensileStrength, fractureEnergy, opening, size);
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose;
    T* const h = point.history;
    elastic.addElasticIncrement(point.strainIncrement, point.stress);
    Principal<T> principal = principalOf(point.stress);
    T(&s)[3] = principal.value;
    const Strengths<T> strengths = strengthsAfter(h[1], h[2], point.size);
    const T &slope = strengths.slope, &bond = strengths.bond, &cut = strengths.cut;

    const T tolerance(toleranceShare * (cohesion + tensileStrength));
    const auto yields = slope * s[0] - s[2] - bond > T(0.0) || s[0] > cut;
    const T q = vonMisesOf(s), bending = branchFree::squareRoot(point.bendingSquared);
    if (!branchFree::anyOf(yields))
    {
      point.bendingScale = scaleOf(bending, T(1.0), s, strengths);
      return;
    }
    const T trial[3] = {s[0], s[1], s[2]};
    const auto multipliersOf = [&](const principalReturn::Set& set, const auto&, T(&multiplier)[3])
    {
      principalReturn::solve(elastic, set, trial, slope, dilation, bond, cut, multiplier);
      return dilation;
    };
    const auto bears = [&](const principalReturn::Set&, const T(&stress)[3])
    { return slope * stress[0] - stress[2] - bond < tolerance && stress[0] - cut < tolerance; };
    const auto flow =
        principalReturn::returnTo(elastic, s, yields, tolerance, multipliersOf, bears);
    point.bendingScale =
        scaleOf(bending, choose(q > T(0.0), vonMisesOf(s) / q, T(1.0)), s, strengths);
    point.stress = chosen(yields, tensorOf(principal), point.stress);
    for (int i = 0; i < 3; ++i)
      point.dissipation += s[i] * flow.strain[i];
    h[0] += flow.equivalent();
    h[1] += flow.slip;
    h[2] += flow.opening;
  }

private:
  /// Of stresses over the strengths: the equations of the surfaces are linear.
  static constexpr Real toleranceShare = 1e-9;

  /// Criterion after some flow: slope s1 - s3 <= bond, s1 <= cut.
  template <class T>
  struct Strengths
  {
    T slope; ///< N [-]
    T bond;  ///< 2 c sqrt(N) [Pa]
    T cut;   ///< [Pa]
  };

  /// @param shear, opening plastic [-]; size of the element [m]
  template <class T>
  KOKKOS_INLINE_FUNCTION Strengths<T> strengthsAfter(const T& shear, const T& opening,
                                                     const T& size) const
  {
    Strengths<T> strengths{T(friction), T(0.0), tensionAfter(opening, size)};
    T &slope = strengths.slope, &bond = strengths.bond, &cut = strengths.cut;
    if (points > 0)
    {
      // N = (sqrt(1 + t^2) + t)^2 with t = tan(phi)
      const T tangent = fromTable(frictionTangents, shear);
      const T root = branchFree::squareRoot(T(1.0) + tangent * tangent) + tangent;
      slope = root * root;
      bond = T(2.0) * root * fromTable(cohesions, shear);
    }
    else
      bond = T(2 * std::sqrt(friction)) * cohesionAfter(shear, size);
    // The cut-off lies before the tip.
    cut =
        branchFree::choose(slope > T(1.0), branchFree::smaller(cut, bond / (slope - T(1.0))), cut);
    return strengths;
  }

  /// Bending falls by the factor of the return, and ends where fibres beside the mean stress shear
  /// in compression or reach the cut-off; along which axis it acts is not known here. It flows by
  /// itself: planes and edges know no other component.
  template <class T>
  KOKKOS_INLINE_FUNCTION static T scaleOf(const T& bending, const T& factor, const T (&s)[3],
                                          const Strengths<T>& strengths)
  {
    const T mean = T(1.0 / 3.0) * (s[0] + s[1] + s[2]);
    const T sheared =
        T(3.0) * (strengths.bond - (strengths.slope - T(1.0)) * mean) / (strengths.slope + T(2.0));
    const T most = branchFree::positivePart(branchFree::smaller(sheared, strengths.cut - mean));
    return principalReturn::bendingKept(branchFree::smaller(factor, T(1.0)), bending, most);
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
