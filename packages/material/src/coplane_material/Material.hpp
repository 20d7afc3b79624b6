#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_material/J2Plasticity.hpp>
#include <coplane_material/LinearElastic.hpp>

#include <variant>

namespace coplane
{
/// Every law of the continuum. Chosen once, on the host; kernels are templates on the law.
using Material = std::variant<LinearElastic, J2Plasticity>;

/// @param youngsModulus E [Pa], positive
/// @param poissonRatio nu, between -1 and 0.5, both excluded
/// @param density [kg/m^3], positive
LinearElastic makeLinearElastic(Real youngsModulus, Real poissonRatio, Real density);

/// @param yieldStress [Pa], positive
/// @param hardeningModulus [Pa], not negative
J2Plasticity makeJ2Plasticity(Real youngsModulus, Real poissonRatio, Real density, Real yieldStress,
                              Real hardeningModulus);

/// The elastic part, which every law has.
const LinearElastic& elasticity(const Material& material);

/// First constant of Lame, lambda = K - 2G/3 [Pa].
inline Real lameLambda(const LinearElastic& law)
{
  return law.bulkModulus - 2.0 / 3.0 * law.shearModulus;
}
/// M = K + 4G/3, stress per strain when the material can only move along one axis [Pa].
inline Real pWaveModulus(const LinearElastic& law)
{
  return law.bulkModulus + 4.0 / 3.0 * law.shearModulus;
}
inline Real pWaveModulus(const Material& material)
{
  return pWaveModulus(elasticity(material));
}
inline Real density(const Material& material)
{
  return elasticity(material).density;
}
/// Speed of compression waves, sqrt(M / density) [m/s].
Real soundSpeed(const Material& material);
} // namespace coplane
