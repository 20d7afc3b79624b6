#pragma once

#include <coplane_core/Lanes.hpp>
#include <coplane_core/Real.hpp>

namespace coplane
{
/// What an element of average nodal pressure resists that changes its volume while the volumes
/// around its nodes stay.
struct VolumeDrift
{
  Lanes pressure = Lanes(0.0);   ///< of the element's own volume, compression positive [Pa]
  Lanes tension = Lanes(0.0);    ///< of the volume that its nodes give it [Pa]
  Lanes stiffening = Lanes(0.0); ///< its bulk modulus over that of the material [-]
};

/// Nodal volumes do not see neighbours that trade volume; only the deviators resist, and those
/// flow. So the element has a pressure -K y^3 of its own, y = (r - 1/r) / 2: nothing while it
/// hardly differs from what its nodes give it, and as much as the strength of a metal from a tenth
/// on. Its energy per reference volume is a function of r, so it pulls as much on what the nodes
/// give it, and both pressures are over that ratio.
/// @param own volume over the first one; nodal: that ratio as the nodes give it; r = own / nodal
inline VolumeDrift volumeDrift(const Lanes& own, const Lanes& nodal, Real bulkModulus)
{
  const Lanes perNodal = Lanes(1.0) / nodal, r = own * perNodal;
  const Lanes inverse = Lanes(1.0) / r;
  const Lanes y = Lanes(0.5) * (r - inverse);
  const Lanes pressure = Lanes(-bulkModulus) * y * y * y * perNodal;
  // d(y^3) / d ln r = 3 y^2 (r + 1/r) / 2
  return {pressure, pressure * r, Lanes(1.5) * y * y * (r + inverse) * perNodal};
}
} // namespace coplane
