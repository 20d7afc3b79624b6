#pragma once

#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>

namespace coplane
{
/// Drucker and Prager's cone, perfectly plastic: q = q0 + p tan(beta), plastic volume strain
/// tan(psi) per plastic shear strain (expansion). Stresses beyond the tip return to it.
struct DruckerPrager
{
  LinearElastic elastic;
  Real strength;      ///< q0, von Mises stress at no pressure [Pa]
  Real frictionSlope; ///< tan(beta) [-]
  Real dilationSlope; ///< tan(psi) [-], between 0 and tan(beta)

  static constexpr int historyCount = 2;
  static constexpr const char* historyNames[] = {"equivalent_plastic_strain",
                                                 "plastic_volume_strain"};
  static constexpr bool usesVolume = false, changesTangent = false, hasStrength = true;

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose;
    const T zero(0.0), one(1.0);
    const Real threeG = 3 * elastic.shearModulus, bulk = elastic.bulkModulus;
    elastic.addElasticIncrement(point.strainIncrement, point.stress);
    const SymTensorOf<T> s = deviatorOf(point.stress);
    const T p = -meanOf(point.stress), q = vonMisesOf(s, point.bendingSquared);
    const T over = q - T(strength) - T(frictionSlope) * p;
    const auto yields = over > zero;
    const T onCone = over * T(1 / (threeG + bulk * frictionSlope * dilationSlope));
    // Beyond the tip the shear stress is used up before the cone is reached.
    const auto tip = yields && T(threeG) * onCone > q;
    const T plastic = choose(tip, q * T(1 / threeG), onCone);
    const T tipPressure(frictionSlope > 0 ? -strength / frictionSlope : 0);
    const T pressure = choose(tip, tipPressure, p + T(bulk * dilationSlope) * plastic);
    const T expansion = (pressure - p) * T(1 / bulk);
    const T shear = choose(tip, zero, q - T(threeG) * plastic);
    const T scale = choose(yields, shear / q, one);
    const SymTensorOf<T> returned = stressOf(s, choose(q > zero, scale, one), -pressure);
    point.stress = chosen(yields, returned, point.stress);
    point.bendingScale = choose(q > zero, scale, one);
    point.history[0] += choose(yields, plastic, zero);
    point.history[1] += choose(yields, expansion, zero);
    point.dissipation = choose(
        yields, shear * plastic * partOfMean(q, point.bendingSquared) - pressure * expansion, zero);
  }
};

/// How the cone is fitted to Mohr and Coulomb's angles.
enum class DruckerPragerFit : int
{
  Compression, ///< touches the edges of triaxial compression
  PlaneStrain  ///< the same limit load in plane strain, for equal friction and dilation
};

struct DruckerPragerParameters : ElasticParameters
{
  Real cohesion = 0; ///< [Pa]
  Real friction = 0; ///< tan(phi) [-]
  Real dilation = 0; ///< tan(psi) [-]; at most the friction
  DruckerPragerFit fit = DruckerPragerFit::Compression;

  static MaterialModel model();
};
/// Throws Error(ExitCode::Deck) with what is wrong.
DruckerPrager makeLaw(const DruckerPragerParameters& parameters);
} // namespace coplane
