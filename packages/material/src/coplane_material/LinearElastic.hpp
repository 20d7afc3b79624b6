#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// Isotropic linear elasticity in rate form: stress increment = (K - 2G/3) tr(de) I + 2 G de.
struct LinearElastic
{
  Real density;      ///< in the reference state [kg/m^3]
  Real bulkModulus;  ///< K [Pa]
  Real shearModulus; ///< G [Pa]

  /// Adds the answer to a strain increment to a stress that the caller has already rotated. T is
  /// Real or Lanes.
  /// @param strainIncrement D dt, tensor shear components (half the engineering shear) [-]
  /// @param stress tension positive [Pa]; in and out
  /// @return plastic dissipation of the increment per volume [J/m^3]: none
  template <class T>
  KOKKOS_INLINE_FUNCTION T operator()(const SymTensorOf<T>& strainIncrement, SymTensorOf<T>& stress,
                                      T& /*equivalentPlasticStrain*/) const
  {
    addElasticIncrement(strainIncrement, stress);
    return T(0.0);
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION void addElasticIncrement(const SymTensorOf<T>& de,
                                                  SymTensorOf<T>& stress) const
  {
    const T twoG = T(2.0 * shearModulus);
    const T dilatation = T(bulkModulus - 2.0 / 3.0 * shearModulus) * (de.xx + de.yy + de.zz);
    stress.xx += dilatation + twoG * de.xx;
    stress.yy += dilatation + twoG * de.yy;
    stress.zz += dilatation + twoG * de.zz;
    stress.xy += twoG * de.xy;
    stress.yz += twoG * de.yz;
    stress.zx += twoG * de.zx;
  }
};
} // namespace coplane
