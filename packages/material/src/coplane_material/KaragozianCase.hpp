#pragma once

#include <coplane_core/ElementaryFunctions.hpp>
#include <coplane_material/ConcreteSurfaces.hpp>
#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>
#include <coplane_material/RateEffect.hpp>

namespace coplane
{
/// Concrete of Karagozian and Case, release III (Malvar et al. 1997): three strengths over the
/// pressure, of first yield, intact and crushed. The damage measure lambda grows with the plastic
/// strain, faster under tension; eta(lambda) leads the strength from the first to the second and
/// then to the third, and takes the tension that the mean stress may reach. Pressure over the
/// logarithmic compression follows a table, with a modulus of its own to unload.
///
/// Without dilation (omega = 0 of the source). In place of the source's scale by the width of a
/// localised band, lambda grows in softening with the size of the element, so that a crack takes
/// the fracture energy. Compression is positive in pressures and compressions here.
struct KaragozianCase
{
  static constexpr int tableSize = 10, softeningSize = 11;

  LinearElastic elastic;     ///< of the intact material: K, G
  ConcreteSurfaces surfaces; ///< fc, ft, intact and crushed strength
  Real tensileExponent;      ///< b2: damage grows by (1 + p / ft)^-b2 under tension [-]
  Real softeningGrowth;      ///< s: of lambda in softening, per size of the element [1/m]
  RateEffect rates;          ///< by which fast strain raises the strengths
  Real pressures[tableSize]; ///< at `compressions` [Pa]
  Real moduli[tableSize];    ///< of unloading from there [Pa]

  enum
  {
    Damage,
    PlasticStrain,
    Lambda,
    Compression,   // largest so far
    Opening,       // volume strain of open cracks
    Precompression // of the stress-free reference volume [-]
  };
  static constexpr int historyCount = 6;
  static constexpr const char* historyNames[] = {"damage",         "equivalent_plastic_strain",
                                                 "damage_measure", "largest_compression",
                                                 "crack_opening",  "precompression"};
  static constexpr bool usesVolume = true, changesTangent = true, hasStrength = true;

  /// Of first yield, a0y fc + p / (a1y + a2y p / fc).
  static constexpr Real a0y = 0.22325, a1y = 0.625, a2y = 0.2575;
  static constexpr Real compressiveExponent = 1.6; ///< b1: damage grows by (1 + p / ft)^-b1
  static constexpr Real volumeDamage = 1.15;       ///< b3: lambda per volume strain of cracks [-]
  static constexpr Real leastReach = 0.05;         ///< of 1 + p / ft, so that damage is finite
  Real compressions[tableSize] = {0,      0.0015, 0.0043, 0.0101, 0.0305,
                                  0.0513, 0.0726, 0.0943, 0.174,  0.208};
  static constexpr Real peakMeasure = 5.6e-5; ///< lambda_m, at which eta is 1
  Real measures[softeningSize] = {0, 8e-6, 2.4e-5, 4e-5, 5.6e-5, 7.2e-5, 1e-4, 1e-3, 3e-3, 5e-3, 1};
  Real shares[softeningSize] = {0, 0.85, 0.97, 0.99, 1, 0.99, 0.97, 0.5, 0.1, 0, 0};

  void startFrom(const SymTensor& stress, Real* history) const;

  /// eta.
  template <class T>
  KOKKOS_INLINE_FUNCTION T shareOf(const T& lambda) const
  {
    T sum(0.0);
    for (int i = 1; i < softeningSize; ++i)
      sum += T(shares[i] - shares[i - 1]) *
             branchFree::smaller(branchFree::positivePart(lambda - T(measures[i - 1])) *
                                     T(1 / (measures[i] - measures[i - 1])),
                                 T(1.0));
    return branchFree::positivePart(sum);
  }

  /// A row of the table over the compression, straight between its points and beyond the last.
  template <class T>
  KOKKOS_INLINE_FUNCTION T tableAt(const Real* row, const T& compression, bool beyond) const
  {
    T sum(row[0]);
    for (int i = 1; i < tableSize; ++i)
    {
      const T inside = branchFree::positivePart(compression - T(compressions[i - 1]));
      const Real width = compressions[i] - compressions[i - 1];
      sum += T((row[i] - row[i - 1]) / width) *
             (i + 1 == tableSize && beyond ? inside : branchFree::smaller(inside, T(width)));
    }
    return sum;
  }

  /// Pressure of first compression.
  template <class T>
  KOKKOS_INLINE_FUNCTION T pressureAt(const T& compression) const
  {
    return tableAt(pressures, compression, true);
  }
  /// Modulus to unload from a compression.
  template <class T>
  KOKKOS_INLINE_FUNCTION T modulusAt(const T& compression) const
  {
    return tableAt(moduli, compression, false);
  }
  /// Compression that is left without pressure.
  template <class T>
  KOKKOS_INLINE_FUNCTION T lostPores(const T& largest) const
  {
    return largest - pressureAt(largest) / modulusAt(largest);
  }

  /// Strength on the compression meridian, without the effect of rates.
  template <class T>
  KOKKOS_INLINE_FUNCTION T meridian(const T& p, const T& lambda) const
  {
    using branchFree::smaller, branchFree::positivePart;
    const T compression = positivePart(p), share = shareOf(lambda);
    const T line = surfaces.tensionLine(p, T(1.0));
    const T intact = positivePart(smaller(line, surfaces.intactStrength(compression)));
    const T yield = positivePart(
        smaller(line, T(a0y * surfaces.strength) +
                          compression / (T(a1y) + T(a2y / surfaces.strength) * compression)));
    const T base = branchFree::choose(
        lambda > T(peakMeasure), smaller(surfaces.residualStrength(compression), intact), yield);
    return base + share * (intact - base);
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose, branchFree::larger, branchFree::smaller, branchFree::positivePart;
    T* const h = point.history;
    const T zero(0.0), one(1.0), half(0.5);
    T faster = one, fasterTension = one;
    const T rate = rates.counts() ? largestPrincipal(point.strainIncrement) * T(1 / point.dt) : one;
    if (rates.counts())
      fasterTension = rates.tension(rate);

    Volume<T> volume = volumeOf(point);
    const T left = choose(h[Lambda] > T(peakMeasure), shareOf(h[Lambda]), one);
    const T least = left * fasterTension * T(surfaces.tensileStrength);
    const T cracked = positivePart(-least - volume.pressure) / volume.back;
    const T p = larger(volume.pressure, -least);
    const T torn = cracked * half * (least + meanOf(point.stress)),
            crushed = positivePart(workOfPores(volume, -meanOf(point.stress)));
    if (rates.counts())
      faster = fasterTension + smaller(positivePart(p) * T(3 / surfaces.strength), one) *
                                   (rates.compression(rate) - fasterTension);

    // The deviator returns along itself; lambda is that of the end of the step.
    const SymTensorOf<T> trial =
        deviatorOf(sumOf(point.stress, T(2 * elastic.shearModulus), point.strainIncrement));
    const T q = vonMisesOf(trial, point.bendingSquared);
    const Growth<T> growth = growthAt(p, faster, point.size);
    const T start = grown(h[Lambda], T(volumeDamage) * cracked / fasterTension, growth);
    const T factor = faster * lodeFactorOf(trial, p / faster);
    const T threeG(3 * elastic.shearModulus);
    const auto over = [&](const T& plastic)
    {
      return q - threeG * plastic -
             factor * meridian(p / faster, grown(start, growth.perStrain * plastic, growth));
    };
    const T overStart = over(zero * q);
    const auto yields = overStart > zero;
    T plastic = zero;
    if (branchFree::anyOf(yields))
    {
      const T most = q / threeG;
      const T root = branchFree::fallingRoot(over, zero * q, most, overStart, over(most),
                                             T(1e-11 * surfaces.strength), yields);
      plastic = choose(yields, root, zero);
    }
    const T scale = choose(yields, one - threeG * plastic / q, one);
    const T former = choose(yields, T(1.5) * contract(point.stress, trial) / q, zero);
    const T ofShear = plastic * half * (former + scale * q * partOfMean(q, point.bendingSquared));

    const T lambda = grown(start, growth.perStrain * plastic, growth);
    h[Damage] = choose(lambda > T(peakMeasure), one - shareOf(lambda), zero);
    h[PlasticStrain] += plastic;
    h[Lambda] = lambda;
    h[Compression] = volume.largest;
    h[Opening] = volume.opening + cracked;
    point.stress = stressOf(trial, scale, -p);
    point.bendingScale = scale;
    point.dissipation = crushed + positivePart(ofShear + torn);
    point.integrity = larger(one - h[Damage], T(leastStiffness));
    point.stiffening = elastic.stiffeningOf(tangentOf(volume));
  }

private:
  /// The volume over a step.
  template <class T>
  struct Volume
  {
    T solid;   ///< logarithmic compression without cracks, at the end
    T opening; ///< volume strain of cracks, those closed that are pressed
    T before;  ///< largest compression before the step
    T largest; ///< at its end
    T back;    ///< modulus to unload [Pa]
    T pressure;
  };

  /// Of lambda, with the plastic strain.
  template <class T>
  struct Growth
  {
    T perStrain; ///< h
    T hardening; ///< factor before the peak: 1, with tension that of softening
    T softening; ///< factor beyond it
  };

  template <class T>
  KOKKOS_INLINE_FUNCTION Volume<T> volumeOf(const MaterialPoint<T>& point) const
  {
    using branchFree::choose, branchFree::smaller, branchFree::positivePart;
    const T* const h = point.history;
    Volume<T> v;
    v.before = h[Compression];
    const T total = h[Precompression] - branchFree::logarithm(point.volumeRatio);
    const T rest = lostPores(v.before);
    // Cracks close at zero pressure before anything else is compressed.
    v.opening = h[Opening] - smaller(h[Opening], positivePart(total + h[Opening] - rest));
    v.solid = total + v.opening;
    v.largest = branchFree::larger(v.solid, v.before);
    v.back = modulusAt(v.largest);
    v.pressure = choose(v.solid < v.before, v.back * (v.solid - rest), pressureAt(v.solid));
    return v;
  }

  /// What pores that close lose: the work of the step at the mean of the pressures at its ends,
  /// less what p^2 / 2K stores more.
  /// @param before pressure at its start [Pa]
  template <class T>
  KOKKOS_INLINE_FUNCTION T workOfPores(const Volume<T>& v, const T& before) const
  {
    const T half(0.5), former = modulusAt(v.before), first = branchFree::positivePart(before),
                       last = branchFree::positivePart(v.pressure);
    return half * (first + last) * (lostPores(v.largest) - lostPores(v.before)) -
           half * first * last * (v.back - former) / (v.back * former);
  }

  /// -V dp/dV [Pa].
  template <class T>
  KOKKOS_INLINE_FUNCTION T tangentOf(const Volume<T>& v) const
  {
    T slope = v.back;
    for (int i = 1; i < tableSize; ++i)
      slope =
          branchFree::choose(v.solid > branchFree::larger(T(compressions[i - 1]), v.before),
                             branchFree::larger(v.back, T((pressures[i] - pressures[i - 1]) /
                                                          (compressions[i] - compressions[i - 1]))),
                             slope);
    return slope;
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION Growth<T> growthAt(const T& p, const T& faster, const T& size) const
  {
    using branchFree::choose;
    const T one(1.0), zero(0.0);
    const T relative = p / (faster * T(surfaces.tensileStrength));
    const T reach = branchFree::larger(one + relative, T(leastReach));
    Growth<T> growth;
    growth.perStrain = choose(relative < zero, branchFree::power(reach, -tensileExponent),
                              branchFree::power(reach, -compressiveExponent)) /
                       faster;
    // Stress is r_f times the slow one; so is the energy of a crack, as in pseudo_cap.
    growth.softening = T(softeningGrowth) * size * faster;
    const T tension =
        branchFree::smaller(branchFree::positivePart(-relative) * T(3.0), one); // 1: uniaxial
    growth.hardening = one + tension * (growth.softening - one);
    return growth;
  }

  /// lambda after a plain increment.
  template <class T>
  KOKKOS_INLINE_FUNCTION T grown(const T& lambda, const T& increment, const Growth<T>& by) const
  {
    using branchFree::positivePart, branchFree::smaller;
    const T room = positivePart(T(peakMeasure) - lambda) / by.hardening;
    return lambda + by.hardening * smaller(increment, room) +
           by.softening * positivePart(increment - room);
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T lodeFactorOf(const SymTensorOf<T>& deviator, const T& p) const
  {
    const T cosTheta = branchFree::cosineOfThird(cosineOfLode(deviator, vonMisesOf(deviator)));
    return ConcreteSurfaces::lodeFactor(cosTheta, surfaces.meridianRatio(p));
  }
};

/// What a user says of a concrete; what is 0 follows from the compressive strength.
struct KaragozianCaseParameters
{
  Real density = 0;             ///< [kg/m^3]
  Real compressiveStrength = 0; ///< fc [Pa]
  Real youngsModulus = 0;       ///< E [Pa]
  Real poissonRatio = 0.16;     ///< [-]
  Real tensileStrength = 0;     ///< ft [Pa]
  Real fractureEnergy = 0;      ///< G_F [J/m^2]
  bool rateEffects = false;
  Real largestRate = 0; ///< of rate effects [1/s]; 0: where inertia begins

  static MaterialModel model();
};

/// With the values that follow from the strength: E = 57000 sqrt(fc) and ft = 6.7 sqrt(fc) in
/// psi, G_F = 73 (fc / MPa)^0.18 (fib Model Code 2010).
KaragozianCaseParameters completed(KaragozianCaseParameters parameters);

/// Throws Error(ExitCode::Deck) with what is wrong.
KaragozianCase makeLaw(const KaragozianCaseParameters& parameters);
} // namespace coplane
