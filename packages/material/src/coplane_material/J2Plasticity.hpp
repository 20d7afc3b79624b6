#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>

namespace coplane
{
/// Von Mises plasticity with linear isotropic hardening: yield where q = sqrt(3/2 s:s) reaches
/// Y(ep) = yieldStress + H ep. Radial return (Wilkins 1964; Simo and Hughes, Computational
/// Inelasticity, box 3.1).
struct J2Plasticity
{
  LinearElastic elastic;
  Real yieldStress;      ///< at no plastic strain [Pa]; positive
  Real hardeningModulus; ///< H, slope of the yield stress over equivalent plastic strain [Pa]; not
                         ///< negative

  static constexpr int historyCount = 1;
  static constexpr const char* historyNames[] = {"equivalent_plastic_strain"};
  static constexpr bool usesVolume = false, changesTangent = false, hasStrength = true;

  /// Dissipation: Y at the end of the step times the increment of plastic strain.
  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    SymTensorOf<T>& stress = point.stress;
    T& equivalentPlasticStrain = point.history[0];
    elastic.addElasticIncrement(point.strainIncrement, stress);

    const T mean = T(1.0 / 3.0) * (stress.xx + stress.yy + stress.zz);
    const T sxx = stress.xx - mean, syy = stress.yy - mean, szz = stress.zz - mean;
    const T q = branchFree::squareRoot(
        T(1.5) *
            (sxx * sxx + syy * syy + szz * szz +
             T(2.0) * (stress.xy * stress.xy + stress.yz * stress.yz + stress.zx * stress.zx)) +
        point.bendingSquared);
    const T yield = T(yieldStress) + T(hardeningModulus) * equivalentPlasticStrain;
    const Real threeG = 3.0 * elastic.shearModulus;

    const auto yields = q > yield;
    const T plasticStrain =
        branchFree::choose(yields, (q - yield) * T(1.0 / (threeG + hardeningModulus)), T(0.0));
    // Where nothing yields the deviator is left alone (scale 1, reduction 0): the bits of the
    // elastic answer stay.
    const T reduction = branchFree::choose(yields, T(threeG) * plasticStrain / q, T(0.0));
    stress.xx -= reduction * sxx;
    stress.yy -= reduction * syy;
    stress.zz -= reduction * szz;
    stress.xy -= reduction * stress.xy;
    stress.yz -= reduction * stress.yz;
    stress.zx -= reduction * stress.zx;
    equivalentPlasticStrain += plasticStrain;
    point.bendingScale = T(1.0) - reduction;
    point.dissipation = (yield + T(hardeningModulus) * plasticStrain) * plasticStrain *
                        partOfMean(q, point.bendingSquared);
  }
};

/// @param yieldStress [Pa], positive
/// @param hardeningModulus [Pa], not negative
J2Plasticity makeJ2Plasticity(const LinearElastic& elastic, Real yieldStress,
                              Real hardeningModulus);
} // namespace coplane
