#pragma once

#include <coplane_core/ElementaryFunctions.hpp>
#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>
#include <coplane_material/TensionLimit.hpp>

namespace coplane
{
/// Ceramics and rock of Johnson and Holmquist (1994), JH-2. With p* = p / PHEL, T* = T / PHEL and
/// sigmaHEL = 3/2 (HEL - PHEL): intact strength A (p* + T*)^N, fractured strength B p*^M <= SFmax,
/// both over sigmaHEL and times 1 + C ln max(rate / reference, 1); the strength is (1-D) of the
/// first and D of the second. Damage by plastic strain, dD = dep / max(D1 (p* + T*)^D2, least).
/// Pressure K1 mu + K2 mu^2 + K3 mu^3 over mu = density / reference density - 1, K1 mu in tension,
/// down to -(1-D) T. What damage takes of the elastic energy of shear goes into pressure, by the
/// fraction beta: bulking. What it takes of the elastic energy of mean tension is lost.
///
/// Strength and ductility are those of the damage at the start of the step; at its end the deviator
/// is on the surface of the damage then (Gazonas 2002). Pressures are positive in compression.
struct JohnsonHolmquist
{
  LinearElastic elastic;  ///< K1, G
  Real secondModulus;     ///< K2 [Pa]
  Real thirdModulus;      ///< K3 [Pa]
  Real strengthAtLimit;   ///< sigmaHEL [Pa]
  Real pressureAtLimit;   ///< PHEL [Pa]
  Real tension;           ///< T [Pa]
  Real intactFactor;      ///< A [-]
  Real intactExponent;    ///< N [-]
  Real fracturedFactor;   ///< B [-]
  Real fracturedExponent; ///< M [-]
  Real mostFractured;     ///< SFmax [-]
  Real rateFactor;        ///< C [-]
  Real referenceRate;     ///< [1/s]
  Real damageFactor;      ///< D1 [-]
  Real damageExponent;    ///< D2 [-]
  Real leastFracture;     ///< of the plastic strain to fracture [-]
  Real bulking;           ///< beta [-]

  enum
  {
    Damage,
    PlasticStrain,
    BulkingPressure, // [Pa]
    Offset           // pressure that belongs to the initial stress [Pa]
  };
  static constexpr int historyCount = 4;
  static constexpr const char* historyNames[] = {"damage", "equivalent_plastic_strain",
                                                 "bulking_pressure", "pressure_offset"};
  static constexpr bool usesVolume = true, changesTangent = true, hasStrength = true;

  void startFrom(const SymTensor& stress, Real* history) const
  {
    history[Offset] = -meanOf(stress);
  }

  /// Without bulking and the limit of tension [Pa].
  template <class T>
  KOKKOS_INLINE_FUNCTION T polynomial(const T& mu) const
  {
    const T pressed = branchFree::positivePart(mu);
    return T(elastic.bulkModulus) * mu +
           pressed * pressed * (T(secondModulus) + pressed * T(thirdModulus));
  }

  /// Von Mises stress that intact material bears. @param faster what the rate makes of it
  template <class T>
  KOKKOS_INLINE_FUNCTION T intactStrength(const T& p, const T& faster) const
  {
    const T relative = branchFree::positivePart(p + T(tension)) * T(1 / pressureAtLimit);
    return T(strengthAtLimit * intactFactor) * faster * branchFree::power(relative, intactExponent);
  }

  /// The same of fractured material.
  template <class T>
  KOKKOS_INLINE_FUNCTION T fracturedStrength(const T& p, const T& faster) const
  {
    const T relative = branchFree::positivePart(p) * T(1 / pressureAtLimit);
    return T(strengthAtLimit) *
           branchFree::smaller(T(fracturedFactor) * faster *
                                   branchFree::power(relative, fracturedExponent),
                               T(mostFractured));
  }

  /// Plastic strain to fracture at a pressure.
  template <class T>
  KOKKOS_INLINE_FUNCTION T ductility(const T& p) const
  {
    const T relative = branchFree::positivePart(p + T(tension)) * T(1 / pressureAtLimit);
    return branchFree::larger(T(damageFactor) * branchFree::power(relative, damageExponent),
                              T(leastFracture));
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose, branchFree::larger, branchFree::smaller, branchFree::positivePart;
    T* const h = point.history;
    const T zero(0.0), one(1.0), threeG(3 * elastic.shearModulus), limit(tension);
    const T mu = one / point.volumeRatio - one, before = h[Damage];
    const T ofVolume = polynomial(mu) + h[Offset];
    const T confining = positivePart(T(elastic.bulkModulus) * mu + h[Offset]);
    const T p = larger(ofVolume + h[BulkingPressure], (before - one) * limit);

    const SymTensorOf<T> trial =
        deviatorOf(sumOf(point.stress, T(2 * elastic.shearModulus), point.strainIncrement));
    const T q = vonMisesOf(trial, point.bendingSquared);
    const T part = partOfMean(q, point.bendingSquared);
    const T faster = ofRate(point.strainIncrement, point.dt);
    const T intact = intactStrength(p, faster), fractured = fracturedStrength(p, faster);
    const T strength = intact + before * (fractured - intact);
    const auto yields = q > strength;
    const T flow = choose(yields, (q - strength) / threeG, zero);
    const T damage = damageFactor > 0 ? smaller(before + flow / ductility(p), one)
                                      : choose(yields, one, before); // broken by its first flow

    // Damage takes strength, and with it elastic energy of shear.
    const T borne = smaller(strength, intact + damage * (fractured - intact));
    const T released = (strength * strength - borne * borne) * part / (T(2.0) * threeG);
    const T kept = T(bulking) * confinement(confining) * released;
    const T bulk(elastic.bulkModulus), unlimited = -ofVolume - h[BulkingPressure];
    const T torn =
        lostToTension(meanOf(point.stress),
                      unlimited - bulk * (one + mu) * T(3.0) * meanOf(point.strainIncrement),
                      unlimited, (one - damage) * limit, bulk);
    h[BulkingPressure] += gained(confining + h[BulkingPressure], kept);
    h[Damage] = damage;
    const T plastic = choose(yields, (q - borne) / threeG, zero);
    h[PlasticStrain] += plastic;
    // The mean of the stresses before and after; kept is of those that damage took.
    const T former = choose(yields, T(1.5) * contract(point.stress, trial) / q, zero);
    const T ofShear = plastic * T(0.5) * (former + borne * part) - kept;

    const T scale = choose(yields, borne / q, one);
    point.stress =
        stressOf(trial, scale, -larger(ofVolume + h[BulkingPressure], (damage - one) * limit));
    point.bendingScale = scale;
    point.dissipation = positivePart(ofShear + torn);
    point.integrity = larger(one - damage, T(leastStiffness));
    const T pressed = positivePart(mu);
    point.stiffening = elastic.stiffeningOf(
        larger(T(elastic.bulkModulus) +
                   pressed * (T(2 * secondModulus) + pressed * T(3 * thirdModulus)),
               T(leastStiffness * elastic.bulkModulus)) *
        (one + mu));
  }

private:
  /// What the rate of the deviatoric strain makes of strengths.
  template <class T>
  KOKKOS_INLINE_FUNCTION T ofRate(const SymTensorOf<T>& strainIncrement, Real dt) const
  {
    const SymTensorOf<T> shear = deviatorOf(strainIncrement);
    const T rate =
        branchFree::squareRoot(T(2.0 / 3.0) * contract(shear, shear)) * T(1 / (dt * referenceRate));
    return T(1.0) + T(rateFactor) * branchFree::logarithm(branchFree::larger(rate, T(1.0)));
  }

  /// Share of bulking that meets a pressure: 0 without one, 1 from T on, with a slope of 0 at 0.
  /// The source has all or nothing, by the sign of mu.
  /// @param p of compression and the initial stress
  template <class T>
  KOKKOS_INLINE_FUNCTION T confinement(const T& p) const
  {
    const T share = branchFree::smaller(p * T(1 / tension), T(1.0));
    return share * share;
  }

  /// Pressure that an energy adds to another one: p^2 / 2K1 grows by it.
  template <class T>
  KOKKOS_INLINE_FUNCTION T gained(const T& p, const T& energy) const
  {
    const T more = T(2 * elastic.bulkModulus) * energy;
    return branchFree::choose(more > T(0.0), more / (branchFree::squareRoot(p * p + more) + p),
                              T(0.0));
  }
};

struct JohnsonHolmquistParameters
{
  Real density = 0;                ///< [kg/m^3]
  Real shearModulus = 0;           ///< G [Pa]
  std::vector<Real> bulkModuli;    ///< K1, K2, K3 [Pa]
  Real elasticLimit = 0;           ///< HEL [Pa]
  Real elasticLimitPressure = 0;   ///< PHEL [Pa]
  Real tensileStrength = 0;        ///< T [Pa]
  Real intactFactor = 0;           ///< A [-]
  Real intactExponent = 0;         ///< N [-]
  Real fracturedFactor = 0;        ///< B [-]
  Real fracturedExponent = 1;      ///< M [-]
  Real largestFractured = 1e20;    ///< SFmax [-]
  Real rateFactor = 0;             ///< C [-]
  Real referenceRate = 1;          ///< [1/s]
  Real damageFactor = 0;           ///< D1 [-]
  Real damageExponent = 1;         ///< D2 [-]
  Real leastFractureStrain = 1e-6; ///< [-]
  Real bulkingFraction = 1;        ///< beta [-]

  static MaterialModel model();
};
/// Throws Error(ExitCode::Deck) with what is wrong.
JohnsonHolmquist makeLaw(const JohnsonHolmquistParameters& parameters);
} // namespace coplane
