#pragma once

namespace coplane
{
/// Energies of an element since the start of the run [J]; rows of ElementBlock::energies().
enum class ElementEnergy : int
{
  Internal,           ///< work of the stress, recoverable and plastic part together
  PlasticDissipation, ///< part of Internal that is lost for good
  Hourglass,          ///< work of the hourglass forces, or of VolumeDrift, but for PlasticBending
  Viscous,            ///< work of the bulk viscosity
  PlasticBending,     ///< part of PlasticDissipation: by hourglass forces that flow or break
  HourglassElastic    ///< part of Hourglass that comes back, of the modes
};
constexpr int elementEnergies = 6;
} // namespace coplane
