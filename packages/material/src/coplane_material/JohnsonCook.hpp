#pragma once

#include <coplane_core/ElementaryFunctions.hpp>
#include <coplane_material/EquationOfState.hpp>
#include <coplane_material/LinearElastic.hpp>

namespace coplane
{
/// Johnson and Cook's strength (1983) and damage (1985) of metals, heated by their plastic work:
/// Y = (A + B ep^n) (1 + C ln max(rate, 1)) (1 - T*^m), T* = (T - Tr) / (Tm - Tr); the strain at
/// fracture ep_f = (D1 + D2 exp(D3 sigma*)) (1 + D4 ln max(rate, 1)) (1 + D5 T*), sigma* = mean
/// stress over von Mises stress. rate = dep/dt over 1/s. The rate is that of the step, the
/// temperature that at its start. At damage 1 the material bears only pressure.
struct JohnsonCook
{
  LinearElastic elastic;
  EquationOfState eos;
  Real strength;                    ///< A [Pa]
  Real hardening;                   ///< B [Pa]
  Real exponent;                    ///< n [-]
  Real rateFactor;                  ///< C [-]
  Real thermalExponent;             ///< m [-]
  Real meltingTemperature;          ///< Tm [K]; 0: no thermal softening
  Real roomTemperature = 293;       ///< Tr, at the start [K]
  Real heatCapacity;                ///< cp [J/(kg K)]
  Real heatFraction = 0.9;          ///< of plastic work that heats [-]
  Real damage[5] = {0, 0, 0, 0, 0}; ///< D1...D5 [-]; all 0: no fracture

  enum
  {
    PlasticStrain,
    Temperature,
    Damage,
    State
  };
  static constexpr int historyCount = State + EquationOfState::rows;
  static constexpr const char* historyNames[] = {"equivalent_plastic_strain", "temperature",
                                                 "damage", "pressure_offset", "distension"};
  static constexpr bool usesVolume = true, changesTangent = true, hasStrength = true;

  /// Beyond it the strain at fracture stays (Johnson and Cook 1985).
  static constexpr Real mostTriaxiality = 1.5;
  /// The strain at fracture is positive in any case.
  static constexpr Real leastDuctility = 1e-3;
  /// Of stresses over A.
  static constexpr Real toleranceShare = 1e-11;

  KOKKOS_INLINE_FUNCTION bool fractures() const { return damage[0] != 0 || damage[1] != 0; }

  void startFrom(const SymTensor& stress, Real* history) const
  {
    history[Temperature] = roomTemperature;
    eos.startFrom(stress, history + State);
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T homologous(const T& temperature) const
  {
    if (meltingTemperature <= 0)
      return T(0.0);
    const T share = branchFree::positivePart((temperature - T(roomTemperature)) *
                                             T(1 / (meltingTemperature - roomTemperature)));
    return branchFree::smaller(share, T(1.0));
  }

  /// ln(max(rate, 1)) of an increment of plastic strain.
  template <class T>
  KOKKOS_INLINE_FUNCTION T logRate(const T& plastic, Real dt) const
  {
    return branchFree::logarithm(branchFree::larger(plastic * T(1 / dt), T(1.0)));
  }

  /// Y at a plastic strain, a logarithm of the rate and a thermal factor 1 - T*^m.
  template <class T>
  KOKKOS_INLINE_FUNCTION T yield(const T& strain, const T& log, const T& thermal) const
  {
    return (T(strength) + T(hardening) * branchFree::power(strain, exponent)) *
           (T(1.0) + T(rateFactor) * log) * thermal;
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose;
    T* const h = point.history;
    const T zero(0.0), one(1.0), threeG(3 * elastic.shearModulus);
    const SymTensorOf<T> trial =
        deviatorOf(sumOf(point.stress, T(2 * elastic.shearModulus), point.strainIncrement));
    const T q = vonMisesOf(trial, point.bendingSquared), strain = h[PlasticStrain];
    const T hot = homologous(h[Temperature]);
    const T thermal = one - branchFree::power(hot, thermalExponent);
    const auto failed = h[Damage] >= one;
    const T bears = choose(failed, zero, thermal);

    const auto excess = [&](const T& d)
    { return q - threeG * d - yield(strain + d, logRate(d, point.dt), bears); };
    const T over = q - yield(strain, zero, bears);
    T plastic(0.0), stress = q;
    if (const auto yields = over > zero; branchFree::anyOf(yields))
    {
      const T most = q / threeG;
      const T root = branchFree::fallingRoot(excess, zero * q, most, over, excess(most),
                                             T(toleranceShare * strength), yields);
      plastic = choose(yields, root, zero);
      stress = q - threeG * plastic;
    }
    const T scale = choose(q > zero, stress / q, one);
    const SymTensorOf<T> deviator = stressOf(trial, scale, zero);
    h[PlasticStrain] = strain + plastic;
    point.bendingScale = scale;
    point.dissipation = stress * plastic * partOfMean(q, point.bendingSquared);
    h[Temperature] +=
        T(heatFraction / (elastic.density * heatCapacity)) * (stress * plastic) * point.volumeRatio;

    T bulk;
    T p = eos.advance(point, deviator, h + State, elastic.bulkModulus, bulk);
    p = choose(failed, branchFree::positivePart(p), p);
    point.stress = stressOf(deviator, one, -p);
    if (fractures())
    {
      const T triaxiality = choose(stress > zero, -p / stress, zero);
      const T capped = branchFree::smaller(triaxiality, T(mostTriaxiality));
      const T ductility =
          (T(damage[0]) + T(damage[1]) * branchFree::exponential(T(damage[2]) * capped)) *
          (one + T(damage[3]) * logRate(plastic, point.dt)) * (one + T(damage[4]) * hot);
      h[Damage] = branchFree::smaller(
          h[Damage] + plastic / branchFree::larger(ductility, T(leastDuctility)), one);
    }
    point.integrity = choose(failed, T(leastStiffness), one);
    point.stiffening = elastic.stiffeningOf(bulk);
  }
};

/// The law itself, or Error(ExitCode::Deck) with what is wrong.
JohnsonCook checked(const JohnsonCook& law);

struct JohnsonCookParameters : ElasticParameters, EosParameters
{
  Real yieldStress = 0;        ///< A [Pa]
  Real hardeningModulus = 0;   ///< B [Pa]
  Real hardeningExponent = 1;  ///< n [-]
  Real rateFactor = 0;         ///< C [-]
  Real thermalExponent = 1;    ///< m [-]
  Real meltingTemperature = 0; ///< [K]; 0: no thermal softening
  Real roomTemperature = 293;  ///< [K]
  Real heatCapacity = 0;       ///< [J/(kg K)]
  Real heatFraction = 0.9;     ///< of plastic work [-]
  std::vector<Real> fracture;  ///< D1...D5 [-]; empty: none

  static MaterialModel model();
};
/// Throws Error(ExitCode::Deck) with what is wrong.
JohnsonCook makeLaw(const JohnsonCookParameters& parameters);
} // namespace coplane
