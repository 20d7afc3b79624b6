#pragma once

#include <coplane_core/Rotate.hpp>
#include <coplane_material/Invariants.hpp>
#include <coplane_material/LawFunction.hpp>
#include <coplane_material/LinearElastic.hpp>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace coplane
{
struct HeldMaterial;

/// Maxwell elements in parallel to a body of modulus 1: a spring `share` and a dashpot each, which
/// relax in `time`.
struct MaxwellElements
{
  static constexpr int most = 4;
  int count = 0;
  std::array<Real, most> share{}; ///< modulus over that of the body [-]
  std::array<Real, most> time{};  ///< [s]

  Real added() const; ///< sum of the shares: what fast strains feel beside 1 [-]
  /// Of 1 + sum of share i w t / (1 + i w t), at w = 2 pi frequency.
  Real storage(Real frequency) const;
  Real loss(Real frequency) const;
  /// Ratio of critical damping, loss / (2 storage) [-].
  Real ratio(Real frequency) const { return 0.5 * loss(frequency) / storage(frequency); }
};

/// The elements whose ratio of critical damping is nearest to a constant between two frequencies:
/// relaxation frequencies in even steps of their logarithm, shares by least squares, steps by
/// trial.
/// @param ratio [-]; low, high [Hz]
struct MaxwellFit
{
  MaxwellElements elements;
  Real least = 0, largest = 0; ///< ratio between the frequencies [-]
};
MaxwellFit fitMaxwell(Real ratio, Real low, Real high, int count);

/// A law with Maxwell elements beside it, by its elastic shear modulus on the deviator of strain
/// and, if asked, by its bulk modulus on the dilatation:
///
///     stress = stress of the law + sum q_k,   q_k' + q_k / t_k = share_k (2 G dev D + 3 K mean D)
///
/// integrated exactly for a constant rate over the step. The law sees its own stress. What the
/// dashpots take is part of the dissipation.
struct MaxwellDamped
{
  std::shared_ptr<const HeldMaterial> held;
  LawFunction inner; ///< of the law that is held
  LinearElastic elastic{};
  MaxwellElements elements;
  bool volumetric = false;

  static constexpr int rows = 6; ///< of each element, behind the history of the law
  /// The last number is what the dashpots have taken [J/m^3].
  int historyCount() const { return inner.historyCount + rows * elements.count + 1; }
  std::vector<std::string> historyNames() const;

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    T* const q = point.history + inner.historyCount;
    const SymTensorOf<T> before = point.oldStress;
    SymTensorOf<T> own[MaxwellElements::most];
    for (int k = 0; k < elements.count; ++k)
    {
      T* const h = q + rows * k;
      const SymTensorOf<T> old{h[0], h[1], h[2], h[3], h[4], h[5]};
      own[k] = rotated(old, point.rotation);
      point.oldStress = sumOf(point.oldStress, T(-1.0), old);
      point.stress = sumOf(point.stress, T(-1.0), own[k]);
    }
    const SymTensorOf<T> de = point.strainIncrement; // laws may change theirs
    inner(point);

    const T mean = meanOf(de);
    const SymTensorOf<T> deviator = sumOf(de, T(-1.0), SymTensorOf<T>{mean, mean, mean});
    T taken(0.0);
    for (int k = 0; k < elements.count; ++k)
    {
      const Real x = point.dt / elements.time[std::size_t(k)];
      const Real kept = std::exp(-x);
      const Real part = x > 0 ? -std::expm1(-x) / x : 1; // of the elastic answer
      const Real twoG = 2 * elastic.shearModulus * elements.share[std::size_t(k)];
      const Real threeK = volumetric ? 3 * elastic.bulkModulus * elements.share[std::size_t(k)] : 0;
      const T pressure = T(part * threeK) * mean;
      const SymTensorOf<T> answer = stressOf(deviator, T(part * twoG), pressure);
      const SymTensorOf<T> now = sumOf(answer, T(kept), own[k]);
      taken += T(0.5) * (contract(own[k], de) + contract(now, de)) -
               (storedTwice(now, twoG, threeK) - storedTwice(own[k], twoG, threeK)) * T(0.5);
      T* const h = q + rows * k;
      h[0] = now.xx;
      h[1] = now.yy;
      h[2] = now.zz;
      h[3] = now.xy;
      h[4] = now.yz;
      h[5] = now.zx;
      point.stress = sumOf(point.stress, T(1.0), now);
    }
    point.oldStress = before;
    q[rows * elements.count] += taken;
    point.dissipation += taken;
    point.stiffening += T(elements.added());
  }

private:
  /// q:q of the deviator over 2 G and tr(q)^2 over 9 K [J/m^3].
  template <class T>
  static KOKKOS_INLINE_FUNCTION T storedTwice(const SymTensorOf<T>& q, Real twoG, Real threeK)
  {
    const SymTensorOf<T> deviator = deviatorOf(q);
    T stored = T(1 / twoG) * contract(deviator, deviator);
    if (threeK > 0)
      stored += T(3 / threeK) * meanOf(q) * meanOf(q);
    return stored;
  }
};
} // namespace coplane
