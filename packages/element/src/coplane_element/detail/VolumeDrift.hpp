#pragma once

#include <coplane_core/Lanes.hpp>
#include <coplane_core/Real.hpp>

namespace coplane
{
/// What an element of average nodal pressure resists that changes its volume while the volumes
/// around its nodes stay.
struct VolumeDrift
{
  Lanes pressure = Lanes(0.0);   ///< compression positive [Pa]
  Lanes stiffening = Lanes(0.0); ///< its bulk modulus over that of the material [-]
};

/// Nodal volumes do not see neighbours that trade volume; only the deviators resist, and those
/// flow. So the element has a pressure -K y^3 of its own, y = (r - 1/r) / 2: nothing while it
/// hardly differs from what its nodes give it, and as much as the strength of a metal from a tenth
/// on.
/// @param r volume over the first one, over that ratio as the nodes give it
inline VolumeDrift volumeDrift(const Lanes& r, Real bulkModulus)
{
  const Lanes inverse = Lanes(1.0) / r;
  const Lanes y = Lanes(0.5) * (r - inverse);
  // d(y^3) / d ln r = 3 y^2 (r + 1/r) / 2
  return {Lanes(-bulkModulus) * y * y * y, Lanes(1.5) * y * y * (r + inverse)};
}
} // namespace coplane
