#pragma once

#include <coplane_core/ElementaryFunctions.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>

#include <vector>

namespace coplane
{
/// High explosive with programmed burn, whose products follow Jones, Wilkins and Lee. With V the
/// volume over the initial one and E the energy per initial volume, which starts with E0,
///
///     p_g = A (1 - omega/(R1 V)) exp(-R1 V) + B (1 - omega/(R2 V)) exp(-R2 V) + omega E / V
///
/// is the pressure of the products, K (1/V - 1) that of the unburnt explosive, and of an element
/// of which the fraction F has burnt (1 - F) p_u + F p_g, never tension; there is no shear. F is
/// the largest so far of
/// - programmed burn: D (t - t_b) / (1.5 h), t_b the time at which the front reaches the centre of
///   the element at the start, h its size: the front is one and a half elements wide;
/// - beta burn: (1 - V) / (1 - V_CJ), all burnt when as dense as behind a detonation; only from one
///   and a half elements before the front on: blows do not light it.
/// The energy of the point is only the work done on it (MaterialPoint); E0 is added here.
struct Jwl
{
  LinearElastic elastic; ///< shear modulus 0; the bulk modulus is that behind a detonation
  Real a, b;             ///< A, B [Pa]
  Real r1, r2;           ///< R1, R2 [-]
  Real omega;            ///< Grueneisen's Gamma of the products [-]
  Real energy;           ///< E0, per initial volume [J/m^3]
  Real speed;            ///< D [m/s]
  Real detonationVolume; ///< V_CJ = 1 - p_CJ / (rho0 D^2) [-]
  Real unburntModulus;   ///< K [Pa]
  static constexpr Real frontWidth = 1.5; ///< elements
  static constexpr int mostPoints = 16;
  int points = 0;         ///< none: all burns from the start
  Vec3 point[mostPoints]; ///< where the explosive is lit [m]
  Real delay[mostPoints]; ///< when [s]

  enum
  {
    TimeToBurn,   // until the front is there; negative: since then [s]
    BurnFraction, // F
    Offset        // pressure that belongs to the initial stress, of the unburnt part [Pa]
  };
  static constexpr int historyCount = 3;
  static constexpr const char* historyNames[] = {"time_to_burn", "burn_fraction",
                                                 "pressure_offset"};
  static constexpr bool usesVolume = true, changesTangent = true, hasStrength = false;

  void startFrom(const SymTensor& stress, Real* history) const
  {
    history[Offset] = -meanOf(stress);
  }
  /// @param place centre of the element when it comes [m]; time: of that [s]
  void startAt(const Vec3& place, Real time, Real* history) const
  {
    history[TimeToBurn] = timeToBurn(place, time);
  }

  /// How long it takes from a time on until the front that is first reaches a place: distance / D
  /// after its point is lit, least of all points. A charge that comes later than that is lit when
  /// it comes [s].
  Real timeToBurn(const Vec3& place, Real time = 0) const;

  /// p_g = a + b E.
  template <class T>
  struct Products
  {
    T first, second; ///< A exp(-R1 V), B exp(-R2 V) [Pa]
    T a, b;          ///< [Pa], [-]
  };
  template <class T>
  KOKKOS_INLINE_FUNCTION Products<T> productsAt(const T& volume) const
  {
    Products<T> p;
    p.b = T(omega) / volume;
    p.first = T(a) * branchFree::exponential(T(-r1) * volume);
    p.second = T(b) * branchFree::exponential(T(-r2) * volume);
    p.a = p.first * (T(1.0) - p.b * T(1 / r1)) + p.second * (T(1.0) - p.b * T(1 / r2));
    return p;
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::larger;
    using branchFree::smaller;
    T* const h = point.history;
    const T zero(0.0), one(1.0), volume = point.volumeRatio;
    const SymTensorOf<T>& de = point.strainIncrement;
    h[TimeToBurn] -= T(point.dt);
    const T programmed = -h[TimeToBurn] * T(speed / frontWidth) / point.size;
    const T beta = branchFree::choose(programmed > T(-1.0),
                                      (one - volume) * T(1 / (1 - detonationVolume)), zero);
    const T fraction = smaller(larger(h[BurnFraction], larger(programmed, beta)), one);
    h[BurnFraction] = fraction;

    // Half of the work of the step is done by the pressure at its end, on which p_g depends.
    const T share = T(0.5) * point.halfVolumeRatio * (de.xx + de.yy + de.zz);
    const T known = point.energy + T(energy) + share * meanOf(point.oldStress);
    const Products<T> gas = productsAt(volume);
    const T unburnt = T(unburntModulus) * (one / volume - one) + h[Offset];
    const T free = ((one - fraction) * unburnt + fraction * (gas.a + gas.b * known)) /
                   (one + fraction * gas.b * share);
    const T p = larger(free, zero);
    point.stress = {-p, -p, -p, zero, zero, zero};
    point.stiffening = stiffeningOf(volume, fraction, p, known - share * p, unburnt, gas);
  }

private:
  /// -V dp/dV without heat flow, over the modulus behind a detonation. What has not burnt has at
  /// least that, so that the front finds steps that are short enough, and what burns while it is
  /// compressed has the slope of beta burn besides.
  template <class T>
  KOKKOS_INLINE_FUNCTION T stiffeningOf(const T& volume, const T& fraction, const T& p,
                                        const T& total, const T& unburnt,
                                        const Products<T>& gas) const
  {
    const T one(1.0);
    const T ofGas = gas.first * (T(r1) * volume - T(omega) - gas.b * T(1 / r1)) +
                    gas.second * (T(r2) * volume - T(omega) - gas.b * T(1 / r2)) + gas.b * total +
                    T(omega) * p;
    const T burning = branchFree::positivePart(gas.a + gas.b * total - unburnt) * volume *
                      T(1 / (1 - detonationVolume));
    const T mixed = (one - fraction) * T(unburntModulus) / volume + fraction * ofGas + burning;
    const T scale(1 / elastic.bulkModulus);
    return branchFree::choose(fraction < one, branchFree::larger(mixed * scale, one),
                              branchFree::larger(ofGas * scale, T(1e-6)));
  }
};

/// The state behind a plane detonation of the products themselves, without programmed burn
/// (Chapman and Jouguet): where the line of Rayleigh touches the curve of Hugoniot.
struct DetonationState
{
  Real volume;   ///< over the initial one [-]
  Real pressure; ///< [Pa]
  Real speed;    ///< of the front [m/s]
};
DetonationState detonationState(const Jwl& law);

struct JwlParameters
{
  Real density = 0; ///< [kg/m^3]
  Real a = 0, b = 0;
  Real r1 = 0, r2 = 0;
  Real omega = 0;
  Real detonationEnergy = 0;   ///< [J/m^3]
  Real detonationSpeed = 0;    ///< [m/s]
  Real detonationPressure = 0; ///< p_CJ [Pa]
  Real bulkModulus = 0;        ///< of the unburnt explosive; 0: density (D/3)^2 [Pa]
  std::vector<std::vector<Real>> lightingPoints; ///< [m]
  std::vector<Real> lightingTimes;               ///< a time per point; empty: all 0 [s]

  static MaterialModel model();
};
/// Throws Error(ExitCode::Deck) with what is wrong.
Jwl makeLaw(const JwlParameters& parameters);
} // namespace coplane
