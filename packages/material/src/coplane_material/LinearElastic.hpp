#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_material/MaterialPoint.hpp>

namespace coplane
{
struct MaterialModel;

/// Isotropic linear elasticity in rate form: stress increment = (K - 2G/3) tr(de) I + 2 G de.
struct LinearElastic
{
  Real density;      ///< in the reference state [kg/m^3]
  Real bulkModulus;  ///< K [Pa]
  Real shearModulus; ///< G [Pa]

  static constexpr int historyCount = 0;
  static constexpr bool usesVolume = false, changesTangent = false, hasStrength = false;

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    addElasticIncrement(point.strainIncrement, point.stress);
  }

  /// Adds the answer to a strain increment (tensor shear components) to a stress that has been
  /// rotated already.
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

  /// MaterialPoint::stiffening of a material whose pressure has another tangent.
  /// @param bulk -V dp/dV [Pa]
  template <class T>
  KOKKOS_INLINE_FUNCTION T stiffeningOf(const T& bulk) const
  {
    const Real shear = 4.0 / 3.0 * shearModulus;
    return branchFree::larger((bulk + T(shear)) * T(1 / (bulkModulus + shear)), T(leastStiffness));
  }
};

struct ElasticParameters
{
  Real density = 0;       ///< [kg/m^3]
  Real youngsModulus = 0; ///< [Pa]
  Real poissonRatio = 0;  ///< [-]
};
/// Throws Error(ExitCode::Deck) with what is wrong.
LinearElastic makeLaw(const ElasticParameters& parameters);

struct LinearElasticParameters : ElasticParameters
{
  static MaterialModel model();
};
} // namespace coplane
