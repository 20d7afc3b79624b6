#pragma once

#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>

namespace coplane
{
/// Concrete of Holmquist, Johnson and Cook (1993). Strength over fc: sigma* = (A (1-D) + B p*^N)
/// (1 + C ln max(rate, 1)) <= Smax, for tension A (1-D) (1 + p / (T (1-D))), which is 0 at the
/// tensile limit. Damage by plastic strain and lost pores: dD = (dep + dmu_p) / max(D1 (p* +
/// T*)^D2, EFmin). Pressure over mu = density / reference density - 1: elastic, a straight
/// transition while pores close, and the locked curve K1 m + K2 m^2 + K3 m^3, m = (mu - mulock) /
/// (1 + mulock); unloading with a modulus in between. The strength uses the pressure at the end of
/// the step and the rate of the whole deviatoric strain.
struct HolmquistJohnsonCook
{
  LinearElastic elastic;    ///< bulk modulus pcrush / mucrush
  Real strength;            ///< fc [Pa]
  Real cohesion;            ///< A [-]
  Real pressureFactor;      ///< B [-]
  Real pressureExponent;    ///< N [-]
  Real rateFactor;          ///< C [-]
  Real mostStrength;        ///< Smax [-]
  Real tension;             ///< T [Pa]
  Real leastFracture;       ///< EFmin [-]
  Real damage1, damage2;    ///< D1, D2 [-]
  Real crushPressure;       ///< pcrush [Pa]
  Real crushCompression;    ///< mucrush [-]
  Real lockPressure;        ///< plock [Pa]
  Real lockCompression;     ///< mulock, of the locked material at no pressure [-]
  Real locked[3];           ///< K1, K2, K3 [Pa]
  Real fullCompression = 0; ///< mu where the locked curve reaches plock; found by make...

  enum
  {
    Damage,
    PlasticStrain,
    Compression, // largest so far
    Offset       // pressure that belongs to the initial stress [Pa]
  };
  static constexpr int historyCount = 4;
  static constexpr const char* historyNames[] = {"damage", "equivalent_plastic_strain",
                                                 "largest_compression", "pressure_offset"};
  static constexpr bool usesVolume = true, changesTangent = true, hasStrength = true;

  void startFrom(const SymTensor& stress, Real* history) const
  {
    history[Compression] = crushCompression;
    history[Offset] = -meanOf(stress);
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T lockedPressure(const T& mu) const
  {
    const T m = (mu - T(lockCompression)) * T(1 / (1 + lockCompression));
    return m * (T(locked[0]) + branchFree::positivePart(m) *
                                   (T(locked[1]) + branchFree::positivePart(m) * T(locked[2])));
  }

  /// Slope of pressure over mu when unloading from the largest compression.
  template <class T>
  KOKKOS_INLINE_FUNCTION T unloadingSlope(const T& largest) const
  {
    const T share = branchFree::smaller(
        (largest - T(crushCompression)) * T(1 / (fullCompression - crushCompression)), T(1.0));
    return T(elastic.bulkModulus) +
           share * T(lockPressure / (fullCompression - lockCompression) - elastic.bulkModulus);
  }

  /// On the curve of first compression, beyond mucrush.
  template <class T>
  KOKKOS_INLINE_FUNCTION T compactionPressure(const T& mu) const
  {
    const Real slope = (lockPressure - crushPressure) / (fullCompression - crushCompression);
    return branchFree::choose(mu > T(fullCompression), lockedPressure(mu),
                              T(crushPressure) + T(slope) * (mu - T(crushCompression)));
  }

  /// Compression that is left without pressure.
  template <class T>
  KOKKOS_INLINE_FUNCTION T lostPores(const T& largest) const
  {
    return branchFree::choose(largest > T(fullCompression), T(lockCompression),
                              largest - compactionPressure(largest) / unloadingSlope(largest));
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose;
    T* const h = point.history;
    const T zero(0.0), one(1.0), intact = one - h[Damage];
    const T mu = one / point.volumeRatio - one;
    const T before = h[Compression], largest = branchFree::larger(mu, before);
    const T back = unloadingSlope(largest);
    const T lost = lostPores(largest);
    const T compaction = branchFree::positivePart(lost - lostPores(before));
    const auto isLocked = largest > T(fullCompression);
    const T least = -intact * T(tension);
    T p = choose(isLocked, lockedPressure(mu), back * (mu - lost)) + h[Offset];
    p = branchFree::larger(p, least);
    h[Compression] = largest;

    const SymTensorOf<T> trial =
        deviatorOf(sumOf(point.stress, T(2 * elastic.shearModulus), point.strainIncrement));
    const T q = vonMisesOf(trial, point.bendingSquared);
    const SymTensorOf<T> shear = deviatorOf(point.strainIncrement);
    const T rate = branchFree::squareRoot(T(2.0 / 3.0) * contract(shear, shear)) * T(1 / point.dt);
    const T relative = branchFree::positivePart(p) * T(1 / strength);
    const T pulled = intact + branchFree::smaller(p, zero) * T(1 / tension); // (1-D) (1 + p/...)
    const T pressed =
        T(cohesion) * intact + T(pressureFactor) * branchFree::power(relative, pressureExponent);
    const T fast = one + T(rateFactor) * branchFree::logarithm(branchFree::larger(rate, one));
    const T normalised =
        choose(p < zero, T(cohesion) * branchFree::positivePart(pulled), pressed) * fast;
    const T yield = T(strength) * branchFree::smaller(normalised, T(mostStrength));

    const auto yields = q > yield;
    const T plastic = choose(yields, (q - yield) * T(1 / (3 * elastic.shearModulus)), zero);
    point.stress = stressOf(trial, choose(yields, yield / q, one), -p);
    point.bendingScale = choose(yields, yield / q, one);
    h[PlasticStrain] += plastic;
    const T reach = branchFree::positivePart(p + T(tension)) * T(1 / strength);
    const T ductility =
        branchFree::larger(T(damage1) * branchFree::power(reach, damage2), T(leastFracture));
    h[Damage] = branchFree::smaller(h[Damage] + (plastic + compaction) / ductility, one);
    // Pores that close take p dmu_p, less what the changed modulus stores, p^2 / 2K. Volume per
    // present volume is dmu (1 + mu)^-1.
    const T compression = branchFree::positivePart(p), former = unloadingSlope(before);
    const T ofPores = compression * compaction -
                      T(0.5) * compression * compression * (back - former) / (back * former);
    point.dissipation = yield * plastic * partOfMean(q, point.bendingSquared) +
                        branchFree::positivePart(ofPores) * point.volumeRatio;
    point.integrity = branchFree::larger(one - h[Damage], T(0.02));
    const T m = branchFree::positivePart((mu - T(lockCompression)) * T(1 / (1 + lockCompression)));
    const T ofLocked = (T(locked[0]) + m * (T(2 * locked[1]) + m * T(3 * locked[2]))) *
                       T(1 / (1 + lockCompression));
    const T bulk = choose(isLocked, branchFree::larger(ofLocked, back), back) * (one + mu);
    const Real stiff = 4.0 / 3.0 * elastic.shearModulus;
    point.stiffening =
        branchFree::larger((bulk + T(stiff)) * T(1 / (elastic.bulkModulus + stiff)), T(0.02));
  }
};

/// Finds what follows from the parameters and checks them: Error(ExitCode::Deck).
HolmquistJohnsonCook completed(HolmquistJohnsonCook law);

struct HolmquistJohnsonCookParameters
{
  Real density = 0;             ///< [kg/m^3]
  Real shearModulus = 0;        ///< [Pa]
  Real compressiveStrength = 0; ///< fc [Pa]
  Real tensileStrength = 0;     ///< T [Pa]
  Real cohesiveFactor = 0;      ///< A [-]
  Real pressureFactor = 0;      ///< B [-]
  Real pressureExponent = 0;    ///< N [-]
  Real rateFactor = 0;          ///< C [-]
  Real largestStrength = 0;     ///< Smax [-]
  Real leastFractureStrain = 0; ///< EFmin [-]
  Real damageFactor = 0;        ///< D1 [-]
  Real damageExponent = 1;      ///< D2 [-]
  Real crushPressure = 0;       ///< [Pa]
  Real crushCompression = 0;    ///< mucrush [-]
  Real lockPressure = 0;        ///< plock [Pa]
  Real lockCompression = 0;     ///< mulock [-]
  std::vector<Real> lockModuli; ///< K1, K2, K3 [Pa]

  static MaterialModel model();
};
/// Throws Error(ExitCode::Deck) with what is wrong.
HolmquistJohnsonCook makeLaw(const HolmquistJohnsonCookParameters& parameters);
} // namespace coplane
