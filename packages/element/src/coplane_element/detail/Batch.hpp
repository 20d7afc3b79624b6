#pragma once

#include <coplane_core/Lanes.hpp>
#include <coplane_element/ElementEnergy.hpp>
#include <coplane_element/detail/ElementKernelData.hpp>

namespace coplane
{
// A kernel treats laneCount elements side by side, a batch: columns first, first + 1, ... of the
// arrays of a block.

/// @param nodes of an element: the more, the longer a batch takes
KOKKOS_FORCEINLINE_FUNCTION void prefetchAhead(const ElementKernelData& data, int batch, int nodes)
{
  const int ahead = batch + 16 / nodes;
  if (ahead < data.batches)
    data.prefetchBatch(std::size_t(ahead));
}

KOKKOS_FORCEINLINE_FUNCTION Lanes load(const Real* from)
{
  return Lanes(from, stdx::element_aligned);
}
KOKKOS_FORCEINLINE_FUNCTION void store(const Lanes& value, Real* to)
{
  value.copy_to(to, stdx::element_aligned);
}

/// Rows of a symmetric tensor: xx, yy, zz, xy, and in three dimensions yz, zx.
template <int dim>
constexpr int tensorRows = dim == 3 ? 6 : 4;

template <int dim>
KOKKOS_FORCEINLINE_FUNCTION SymTensorOf<Lanes> loadTensor(const ElementTable& table, int row,
                                                          int first)
{
  const auto at = [&](int k) { return load(&table(row + k, first)); };
  if constexpr (dim == 3)
    return {at(0), at(1), at(2), at(3), at(4), at(5)};
  else
    return {at(0), at(1), at(2), at(3), Lanes(0.0), Lanes(0.0)};
}

template <int dim>
KOKKOS_FORCEINLINE_FUNCTION void storeTensor(const SymTensorOf<Lanes>& s, const ElementTable& table,
                                             int row, int first)
{
  store(s.xx, &table(row + 0, first));
  store(s.yy, &table(row + 1, first));
  store(s.zz, &table(row + 2, first));
  store(s.xy, &table(row + 3, first));
  if constexpr (dim == 3)
  {
    store(s.yz, &table(row + 4, first));
    store(s.zx, &table(row + 5, first));
  }
}

/// Adds to an energy of the elements [J].
KOKKOS_FORCEINLINE_FUNCTION void addTo(const ElementKernelData& data, ElementEnergy kind, int first,
                                       const Lanes& amount)
{
  Real* const where = &data.energies(int(kind), first);
  store(load(where) + amount, where);
}

/// Forces in the order of corners, from rows of lanes; `adds`: to what is there [N].
template <class M, bool adds = false>
KOKKOS_FORCEINLINE_FUNCTION void storeForces(const ElementKernelData& data, int first,
                                             const Real (&force)[M::dimension][M::nodes][laneCount])
{
  for (int lane = 0; lane < laneCount; ++lane)
  {
    Real* const out = &data.cornerForce(first + lane, 0, 0);
    for (int c = 0; c < M::nodes; ++c)
      for (int i = 0; i < M::dimension; ++i)
        out[3 * c + i] = adds ? out[3 * c + i] + force[i][c][lane] : force[i][c][lane];
  }
}

/// The stable step [s], or 0 for elements that have turned inside out or whose forces are not
/// finite.
/// @param sum of the forces
KOKKOS_FORCEINLINE_FUNCTION void storeStep(const ElementKernelData& data, int first,
                                           const Lanes& step, const LaneMask& unfolded,
                                           const Lanes& sum)
{
  const LaneMask good = sum * Lanes(0.0) == Lanes(0.0) && unfolded && step > Lanes(0.0);
  store(choose(good, step, Lanes(0.0)), &data.stableStep(first));
}
} // namespace coplane
