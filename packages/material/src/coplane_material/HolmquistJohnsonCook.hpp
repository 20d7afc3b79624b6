#pragma once

#include <coplane_core/ElementaryFunctions.hpp>
#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>
#include <coplane_material/TensionLimit.hpp>

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
    const Compressed<T> c = compressed(one / point.volumeRatio - one, h[Compression]);
    const T p = branchFree::larger(c.pressure + h[Offset], -intact * T(tension));
    h[Compression] = c.largest;

    const SymTensorOf<T> trial =
        deviatorOf(sumOf(point.stress, T(2 * elastic.shearModulus), point.strainIncrement));
    const T q = vonMisesOf(trial, point.bendingSquared);
    const T yield = yieldStress(p, intact, point.strainIncrement, point.dt);
    const auto yields = q > yield;
    const T plastic = choose(yields, (q - yield) * T(1 / (3 * elastic.shearModulus)), zero);
    const T former = choose(yields, T(1.5) * contract(point.stress, trial) / q, zero);
    const T ofShear = plastic * T(0.5) * (former + yield * partOfMean(q, point.bendingSquared));
    const T mean = meanOf(point.stress), unlimited = -c.pressure - h[Offset];
    const T torn = lostToTension(
        mean, unlimited - c.back * (one + c.mu) * T(3.0) * meanOf(point.strainIncrement), unlimited,
        intact * T(tension), c.back);
    const T crushed = branchFree::positivePart(workOfPores(c, -mean, p, h[Offset]));
    point.stress = stressOf(trial, choose(yields, yield / q, one), -p);
    point.bendingScale = choose(yields, yield / q, one);
    h[PlasticStrain] += plastic;
    const T reach = branchFree::positivePart(p + T(tension)) * T(1 / strength);
    const T ductility =
        branchFree::larger(T(damage1) * branchFree::power(reach, damage2), T(leastFracture));
    h[Damage] = branchFree::smaller(h[Damage] + (plastic + c.compaction) / ductility, one);
    // Volume per present volume is dmu (1 + mu)^-1.
    point.dissipation = branchFree::positivePart(ofShear + torn) + crushed * point.volumeRatio;
    point.integrity = branchFree::larger(one - h[Damage], T(leastStiffness));
    point.stiffening = elastic.stiffeningOf(tangentOf(c));
  }

private:
  /// The volume over a step.
  template <class T>
  struct Compressed
  {
    T mu;           ///< at its end
    T largest;      ///< mu so far
    T former, back; ///< slopes of unloading before the step and at its end [Pa]
    T compaction;   ///< lost pores of the step
    T pressure;     ///< without that of the initial stress and without limit [Pa]
    branchFree::MaskOf<T> isLocked;
  };

  template <class T>
  KOKKOS_INLINE_FUNCTION Compressed<T> compressed(const T& mu, const T& before) const
  {
    Compressed<T> c;
    c.mu = mu;
    c.largest = branchFree::larger(mu, before);
    c.former = unloadingSlope(before);
    c.back = unloadingSlope(c.largest);
    const T lost = lostPores(c.largest);
    c.compaction = branchFree::positivePart(lost - lostPores(before));
    c.isLocked = c.largest > T(fullCompression);
    c.pressure = branchFree::choose(c.isLocked, lockedPressure(mu), c.back * (mu - lost));
    return c;
  }

  /// At the pressure and the rate of the deviatoric strain [Pa].
  template <class T>
  KOKKOS_INLINE_FUNCTION T yieldStress(const T& p, const T& intact,
                                       const SymTensorOf<T>& strainIncrement, Real dt) const
  {
    const T zero(0.0), one(1.0);
    const SymTensorOf<T> shear = deviatorOf(strainIncrement);
    const T rate = branchFree::squareRoot(T(2.0 / 3.0) * contract(shear, shear)) * T(1 / dt);
    const T relative = branchFree::positivePart(p) * T(1 / strength);
    const T pulled = intact + branchFree::smaller(p, zero) * T(1 / tension); // (1-D) (1 + p/...)
    const T pressed =
        T(cohesion) * intact + T(pressureFactor) * branchFree::power(relative, pressureExponent);
    const T fast = one + T(rateFactor) * branchFree::logarithm(branchFree::larger(rate, one));
    const T slow =
        branchFree::choose(p < zero, T(cohesion) * branchFree::positivePart(pulled), pressed);
    return T(strength) * branchFree::smaller(slow * fast, T(mostStrength));
  }

  /// What pores that close lose, as an integral over mu: the work of the step at the mean of the
  /// pressures at its ends, less what p^2 / 2K stores more.
  /// @param before, now pressures at the ends; initial: that of the initial stress [Pa]
  template <class T>
  KOKKOS_INLINE_FUNCTION T workOfPores(const Compressed<T>& c, const T& before, const T& now,
                                       const T& initial) const
  {
    const T half(0.5), first = branchFree::positivePart(before),
                       last = branchFree::positivePart(now),
                       both = first * last - (first + last) * initial;
    return half * (first + last) * c.compaction -
           half * both * (c.back - c.former) / (c.back * c.former);
  }

  /// -V dp/dV [Pa].
  template <class T>
  KOKKOS_INLINE_FUNCTION T tangentOf(const Compressed<T>& c) const
  {
    const T m =
        branchFree::positivePart((c.mu - T(lockCompression)) * T(1 / (1 + lockCompression)));
    const T ofLocked = (T(locked[0]) + m * (T(2 * locked[1]) + m * T(3 * locked[2]))) *
                       T(1 / (1 + lockCompression));
    return branchFree::choose(c.isLocked, branchFree::larger(ofLocked, c.back), c.back) *
           (T(1.0) + c.mu);
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
