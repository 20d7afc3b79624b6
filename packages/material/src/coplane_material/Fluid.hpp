#pragma once

#include <coplane_material/EquationOfState.hpp>
#include <coplane_material/LinearElastic.hpp>

namespace coplane
{
/// What only has pressure, such as a gas, or a solid under pressures far above its strength.
struct Fluid
{
  LinearElastic elastic; ///< shear modulus 0; the bulk modulus is that of the sound speed
  EquationOfState eos;

  static constexpr int historyCount = EquationOfState::rows;
  static constexpr const char* historyNames[] = {"pressure_offset", "distension"};
  static constexpr bool usesVolume = true, changesTangent = true, hasStrength = false;

  void startFrom(const SymTensor& stress, Real* history) const { eos.startFrom(stress, history); }

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    T bulk;
    const T p = eos.advance(point, SymTensorOf<T>{T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)},
                            point.history, elastic.bulkModulus, bulk);
    point.stress = {-p, -p, -p, T(0.0), T(0.0), T(0.0)};
    point.stiffening = branchFree::larger(bulk * T(1 / elastic.bulkModulus), T(1e-6));
  }
};

struct IdealGasParameters
{
  Real density = 0;   ///< [kg/m^3]
  Real heatRatio = 0; ///< gamma, ratio of specific heats [-]
  Real pressure = 0;  ///< of the initial stress of its blocks, for the first sound speed [Pa]

  static MaterialModel model();
};
/// Throws Error(ExitCode::Deck) with what is wrong.
Fluid makeLaw(const IdealGasParameters& parameters);

struct FluidParameters : EosParameters
{
  Real density = 0; ///< [kg/m^3]

  static MaterialModel model();
};
Fluid makeLaw(const FluidParameters& parameters);

/// @param eos any but None and IdealGas
Fluid makeFluid(Real density, const EquationOfState& eos);
} // namespace coplane
