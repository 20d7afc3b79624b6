#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_material/DruckerPrager.hpp>
#include <coplane_material/Fluid.hpp>
#include <coplane_material/HoekBrown.hpp>
#include <coplane_material/HolmquistJohnsonCook.hpp>
#include <coplane_material/J2.hpp>
#include <coplane_material/JohnsonCook.hpp>
#include <coplane_material/JohnsonHolmquist.hpp>
#include <coplane_material/Jwl.hpp>
#include <coplane_material/KaragozianCase.hpp>
#include <coplane_material/LawFunction.hpp>
#include <coplane_material/LinearElastic.hpp>
#include <coplane_material/MaxwellDamping.hpp>
#include <coplane_material/MohrCoulomb.hpp>
#include <coplane_material/NeoHookean.hpp>
#include <coplane_material/PseudoCap.hpp>
#include <coplane_material/UbiquitousJoints.hpp>

#include <array>
#include <string>
#include <variant>
#include <vector>

namespace coplane
{
/// Every law of the continuum. A law has its parameters, an elastic part, historyCount variables
/// with historyNames, and advances a MaterialPoint<T> by operator(), for T = Real and T = Lanes
/// with the same bits in every lane.
using Material =
    std::variant<LinearElastic, J2Plasticity, HardeningPlasticity, NeoHookean, DruckerPrager,
                 MohrCoulomb, JohnsonCook, PseudoCap, HolmquistJohnsonCook, Fluid, HoekBrown,
                 UbiquitousJoints, Jwl, JohnsonHolmquist, KaragozianCase, MaxwellDamped>;
struct HeldMaterial
{
  Material law;
};

/// @param youngsModulus E [Pa], positive
/// @param poissonRatio nu, between -1 and 0.5, both excluded
/// @param density [kg/m^3], positive
LinearElastic makeLinearElastic(Real youngsModulus, Real poissonRatio, Real density);

/// Throws Error(ExitCode::Deck) with what is wrong.
Material makeLaw(const J2Parameters& parameters);

/// A law with Maxwell elements beside it (MaxwellDamped). Throws Error(ExitCode::Deck) where it has
/// no shear modulus, or too many variables.
Material withMaxwell(const Material& law, const MaxwellElements& elements, bool volumetric);

/// Names of the law's history variables, in their order.
std::vector<std::string> historyNames(const Material& material);

/// The law's history of an element that comes, under the initial stress [Pa].
/// @param place centre of the element [m]; time: 0, or when a stage adds it [s]
std::array<Real, maximumHistory> initialHistory(const Material& material,
                                                const SymTensor& stress = {},
                                                const Vec3& place = {}, Real time = 0);

/// The function refers to the material, which has to stay where it is.
LawFunction lawFunction(const Material& material);

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
