#pragma once

#include <coplane_element/detail/Batch.hpp>
#include <coplane_element/detail/ObjectiveRate.hpp>

namespace coplane
{
/// Pressure of the bulk viscosity over a step.
struct ViscousPressure
{
  Lanes before, now; ///< at n and at n + 1 [Pa]
  Lanes viscosity;   ///< tangent of the pressure over the rate of compression, per density [m^2/s]

  /// Its work over a dilatation [-] or a change of volume [m^3], with the mean of both.
  Lanes workOver(const Lanes& dilatation) const
  {
    return Lanes(-0.5) * (before + now) * dilatation;
  }
};

/// @param dilatation tr(D) dt of the step
KOKKOS_FORCEINLINE_FUNCTION void storeCompressionRate(const ElementKernelData& data, int first,
                                                      const Lanes& dilatation)
{
  store(branchFree::positivePart(-dilatation / Lanes(data.dt)), &data.compression(0, first));
}

/// From the rate of compression in store; the pressure is stored beside it.
/// @param density [kg/m^3], length of the elements [m]
KOKKOS_FORCEINLINE_FUNCTION ViscousPressure viscousPressure(const ElementKernelData& data,
                                                            int first, const Lanes& density,
                                                            const Lanes& length)
{
  const Lanes lr = length * load(&data.compression(0, first));
  const Lanes b1c = Lanes(data.viscosity.linear * data.soundSpeed);
  const Lanes b2lr = Lanes(data.viscosity.quadratic) * lr;
  Real* const stored = &data.compression(1, first);
  const ViscousPressure pressure{load(stored), density * lr * (b1c + b2lr),
                                 length * (b1c + Lanes(2.0) * b2lr)};
  store(pressure.now, stored);
  return pressure;
}

/// The stress turned over the step, and the strain increment turned to its end.
KOKKOS_FORCEINLINE_FUNCTION void turnByHughesWinget(const SymTensorOf<Lanes>& stress,
                                                    MaterialPoint<Lanes>& point)
{
  point.stress = rotated(stress, point.rotation);
  point.strainIncrement = turnedToEnd(point.strainIncrement, point.rotation);
}

/// The same of point q for the other rates of the block. Green and Naghdi's rotation takes the
/// place of Hughes and Winget's; Jaumann's rate leaves the strain increment as it is.
template <int dim>
KOKKOS_FORCEINLINE_FUNCTION void turnByOtherRate(const ElementKernelData& data, int first, int q,
                                                 const SymTensorOf<Lanes>& stress,
                                                 MaterialPoint<Lanes>& point)
{
  if (data.options.rate == ObjectiveRate::Jaumann)
  {
    point.stress = turnedFirstOrder(stress, point.displacementGradient);
    return;
  }
  const auto row = [&](int i, int j) { return &data.deformation(dim * (dim * q + i) + j, first); };
  Mat3Of<Lanes> f;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      f(i, j) = i < dim && j < dim ? load(row(i, j)) : Lanes(i == j ? 1.0 : 0.0);
  greenNaghdi<dim>(point.displacementGradient, f, point.rotation, point.strainIncrement);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      store(f(i, j), row(i, j));
  point.stress = rotated(stress, point.rotation);
}

/// The law at point q, whose history and stress are rows of `history` and `stress`.
template <int dim, class Law>
KOKKOS_FORCEINLINE_FUNCTION void advancePoint(const Law& law, const ElementTable& history,
                                              const ElementTable& stress, int q, int first,
                                              MaterialPoint<Lanes>& point)
{
  const int firstRow = law.historyCount * q;
  for (int k = 0; k < law.historyCount; ++k)
    point.history[k] = load(&history(firstRow + k, first));
  law(point);
  for (int k = 0; k < law.historyCount; ++k)
    store(point.history[k], &history(firstRow + k, first));
  storeTensor<dim>(point.stress, stress, tensorRows<dim> * q, first);
}

/// Twice the work of the stresses over a strain increment, per volume: with the old stress as it
/// was before the rotation its mean with the new one belongs to n + 1/2 to second order.
KOKKOS_FORCEINLINE_FUNCTION Lanes twiceWork(const SymTensorOf<Lanes>& oldStress,
                                            const SymTensorOf<Lanes>& stress,
                                            const SymTensorOf<Lanes>& de)
{
  return (oldStress.xx + stress.xx) * de.xx + (oldStress.yy + stress.yy) * de.yy +
         (oldStress.zz + stress.zz) * de.zz +
         Lanes(2.0) * ((oldStress.xy + stress.xy) * de.xy + (oldStress.yz + stress.yz) * de.yz +
                       (oldStress.zx + stress.zx) * de.zx);
}
} // namespace coplane
