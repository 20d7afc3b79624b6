#pragma once

#include <coplane_core/Rotate.hpp>
#include <coplane_material/EquationOfState.hpp>
#include <coplane_material/LinearElastic.hpp>

#include <vector>

namespace coplane
{
/// Von Mises plasticity with a table of the yield stress (isotropic), a linear back stress
/// (kinematic, Prager), and an equation of state on demand. J2Plasticity is the faster law for the
/// common case. Return along the radius of the moved surface: exact for every piece of the table.
struct HardeningPlasticity
{
  static constexpr int capacity = 16; ///< points of the table

  LinearElastic elastic;
  EquationOfState eos;
  Real kinematicModulus = 0;    ///< uniaxial back stress over plastic strain [Pa]
  int points = 0;               ///< of the table; at least one
  Real plasticStrain[capacity]; ///< rising from 0 [-]
  Real yieldStress[capacity];   ///< [Pa]
  Real slope[capacity];         ///< from each point on [Pa]; not negative

  enum
  {
    PlasticStrain,
    BackStress, // xx, yy, zz, xy, yz, zx
    State = BackStress + 6
  };
  static constexpr int historyCount = State + EquationOfState::rows;
  static constexpr const char* historyNames[] = {"equivalent_plastic_strain",
                                                 "back_stress_xx",
                                                 "back_stress_yy",
                                                 "back_stress_zz",
                                                 "back_stress_xy",
                                                 "back_stress_yz",
                                                 "back_stress_zx",
                                                 "pressure_offset",
                                                 "distension"};
  static constexpr bool usesVolume = true, changesTangent = true, hasStrength = true;

  void startFrom(const SymTensor& stress, Real* history) const
  {
    eos.startFrom(stress, history + State);
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose;
    T* const h = point.history;
    const T zero(0.0), one(1.0);
    const Real threeG = 3 * elastic.shearModulus;
    const SymTensorOf<T> trial =
        deviatorOf(sumOf(point.stress, T(2 * elastic.shearModulus), point.strainIncrement));
    T* const b = h + BackStress;
    const SymTensorOf<T> back = rotated({b[0], b[1], b[2], b[3], b[4], b[5]}, point.rotation);
    const SymTensorOf<T> shifted = sumOf(trial, T(-1.0), back);
    const T q = vonMisesOf(shifted, point.bendingSquared), strain = h[PlasticStrain];

    // The yield stress before the step, and the root on the last piece that it reaches.
    const auto onPiece = [&](int i)
    { return T(yieldStress[i]) + T(slope[i]) * (strain - T(plasticStrain[i])); };
    T yield = onPiece(0), plastic = (q - yield) * T(1 / (threeG + kinematicModulus + slope[0]));
    T hardening(slope[0]), base = yield;
    for (int i = 1; i < points; ++i)
    {
      const T from(plasticStrain[i]), line = onPiece(i);
      yield = choose(strain > from, line, yield);
      const auto reached = strain + plastic > from || strain > from;
      plastic =
          choose(reached, (q - line) * T(1 / (threeG + kinematicModulus + slope[i])), plastic);
      hardening = choose(reached, T(slope[i]), hardening);
      base = choose(reached, line, base);
    }
    const auto yields = q > yield;
    plastic = choose(yields, plastic, zero);
    const T perStress = choose(yields, plastic / q, zero);
    const SymTensorOf<T> deviator = sumOf(trial, T(-threeG) * perStress, shifted);
    const SymTensorOf<T> moved = sumOf(back, T(kinematicModulus) * perStress, shifted);
    b[0] = moved.xx;
    b[1] = moved.yy;
    b[2] = moved.zz;
    b[3] = moved.xy;
    b[4] = moved.yz;
    b[5] = moved.zx;
    h[PlasticStrain] = strain + plastic;
    point.bendingScale = one - T(threeG + kinematicModulus) * perStress; // it has no back stress
    point.dissipation =
        (base + hardening * plastic) * plastic * partOfMean(q, point.bendingSquared);

    T bulk;
    const T p = eos.advance(point, deviator, h + State, elastic.bulkModulus, bulk);
    point.stress = stressOf(deviator, one, -p);
    point.stiffening = elastic.stiffeningOf(bulk);
  }
};

/// @param plasticStrains, yieldStresses [Pa] the table; the yield stress stays beyond its end
/// @param kinematicModulus [Pa]
HardeningPlasticity makeHardeningPlasticity(const LinearElastic& elastic,
                                            const EquationOfState& eos,
                                            const std::vector<Real>& plasticStrains,
                                            const std::vector<Real>& yieldStresses,
                                            Real kinematicModulus);
} // namespace coplane
