#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// How a charge stands: on the ground, which reflects what goes down (a hemisphere), or in free air
/// (a sphere).
enum class Burst : int
{
  Surface,
  Air
};

/// A charge of TNT.
struct BlastCharge
{
  Burst burst = Burst::Surface;
  Real mass = 0;       ///< equivalent of TNT [kg]
  Vec3 place{};        ///< [m]
  Real detonation = 0; ///< time [s]
};

/// What Kingery and Bulmash (1984) measured and computed of the blast wave of TNT in air of sea
/// level, pressures over the ambient one.
struct BlastValues
{
  Real incidentPressure = 0, reflectedPressure = 0; ///< peaks [Pa]
  Real incidentImpulse = 0, reflectedImpulse = 0;   ///< of the positive phase [Pa s]
  Real arrival = 0;                                 ///< after the detonation [s]
  Real duration = 0;                                ///< of the positive phase [s]
};
BlastValues blastValuesAt(Burst burst, Real mass, Real distance);

/// Scaled distances for which there are fits, distance / mass^(1/3) [m/kg^(1/3)].
struct ScaledDistances
{
  Real least, largest;
};
ScaledDistances blastRange(Burst burst);

/// p(t) = peak (1 - t/T) exp(-b t/T) over the positive phase, 0 before and after it.
struct Friedlander
{
  Real peak = 0;     ///< [Pa]
  Real duration = 0; ///< T [s]
  Real decay = 0;    ///< b, not negative [-]

  Real pressure(Real sinceArrival) const;
  Real impulseUntil(Real sinceArrival) const; ///< integral of p [Pa s]
  Real impulse() const { return impulseUntil(duration); }
};
/// The curve with that impulse. A straight decay, b = 0, gives peak T / 2; when more is asked for,
/// the phase becomes longer instead, T = 2 impulse / peak, so that the impulse is always met.
Friedlander friedlanderOf(Real peak, Real impulse, Real duration);

/// The pressure on a face. With the angle a between the normal and the direction to the charge,
///
///     p = p_r cos^2 a + p_i (1 + cos a - 2 cos^2 a)
///
/// (Randers-Pehrson and Bannister 1997) from reflected and incident pressure; a face that is turned
/// away from the charge has the incident pressure alone.
struct BlastWave
{
  Real arrival = 0; ///< time [s]
  Friedlander incident, reflected;
  Real reflection = 0; ///< share of the reflected pressure, cos^2 a
  Real incidence = 1;  ///< share of the incident pressure

  Real pressure(Real t) const; ///< [Pa]
  /// Mean over the time dt around t [Pa]: steps that follow each other give the whole impulse,
  /// however short the wave is.
  Real meanPressure(Real t, Real dt) const;
};
/// @param normal unit, out of the body
BlastWave blastWaveOn(const BlastCharge& charge, const Vec3& place, const Vec3& normal);
} // namespace coplane
