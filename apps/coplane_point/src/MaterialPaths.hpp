#pragma once

#include <coplane_input/Deck.hpp>
#include <coplane_material/MaterialProbe.hpp>
#include <coplane_schema/Schema.hpp>

#include <functional>
#include <string>
#include <vector>

namespace coplane
{
/// A path on which a material is led. Strains are sums of increments, so logarithmic along the
/// axes; tension is positive.
struct MaterialPathCard
{
  std::string name, where;
  std::string material;
  std::string type; ///< uniaxial_stress | uniaxial_strain | biaxial | hydrostatic | shear | mixed
  int steps = 200;  ///< from one point to the next
  Real size = 0.01; ///< of the element that the point stands for [m]
  Real rate = 1e-3; ///< of strain [1/s]
  Real confinement = 0;                      ///< pressure before and during the path [Pa]
  std::vector<Real> strains;                 ///< visited in turn from 0 [-]
  std::vector<Real> values[6];               ///< mixed: xx, yy, zz, xy, yz, zx; [-] or [Pa]
  std::vector<std::string> stressComponents; ///< mixed: those of which `values` are stresses
  std::vector<Real> times;                   ///< mixed [s]
  std::string output;
};

/// Keys of a card in `material_paths`; their target is a MaterialPathCard.
std::vector<Key> materialPathKeys();

/// Leads a material along the path of a card; `record` sees the point at the start and after every
/// step. Throws Error(ExitCode::Computation) where the material cannot bear what is asked.
void followPath(const MaterialPathCard& card, MaterialProbe probe,
                const std::function<void(const MaterialProbe&)>& record);

/// Runs the path of a card, writes its CSV file and returns a summary for the screen.
std::string runMaterialPath(const MaterialPathCard& card, const Material& material);
} // namespace coplane
