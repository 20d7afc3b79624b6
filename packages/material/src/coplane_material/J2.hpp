#pragma once

#include <coplane_material/HardeningPlasticity.hpp>
#include <coplane_material/J2Plasticity.hpp>

#include <vector>

namespace coplane
{
/// What a user says of a metal. J2Plasticity is its law where that is enough, HardeningPlasticity
/// otherwise.
struct J2Parameters : ElasticParameters, EosParameters
{
  Real yieldStress = 0;             ///< uniaxial [Pa]
  Real hardeningModulus = 0;        ///< slope of the yield stress over plastic strain [Pa]
  std::vector<Real> plasticStrains; ///< of a table, rising from 0 [-]; empty: none
  std::vector<Real> yieldStresses;  ///< [Pa]
  Real kinematicModulus = 0;        ///< uniaxial back stress over plastic strain [Pa]

  static MaterialModel model();
};
} // namespace coplane
