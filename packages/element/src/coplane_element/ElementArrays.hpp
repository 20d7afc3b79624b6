#pragma once

#include <coplane_core/Backend.hpp>
#include <coplane_core/Prefetch.hpp>
#include <coplane_core/Real.hpp>
#include <coplane_element/ElementTable.hpp>

namespace coplane
{
/// The arrays of a block: a column per element, padded to a multiple of laneCount, and in tables a
/// row per component. Arrays that the options of the block do not need are empty.
struct ElementArrays
{
  /// [element][corner][component], three components also in two dimensions
  using CornerVectors = Kokkos::View<Real** [3], Kokkos::LayoutRight, Kokkos::HostSpace>;

  Table<int> connectivity; ///< [element][corner] -> local node

  // of the reference state
  Array<Real> mass;            ///< [kg]
  Array<Real> referenceVolume; ///< [m^3]
  Array<Real> referenceLength; ///< V^(1/3), in two dimensions the root of the area [m]
  ElementTable cornerMass;     ///< a row per corner, where masses of corners differ [kg]
  ElementTable pointMass;      ///< a row per point, full integration [kg]

  // history
  ElementTable stress;                ///< xx, yy, zz, xy, yz, zx: means over the points [Pa]
  ElementTable history;               ///< of the law: means over the points
  ElementTable tangent;               ///< rows: stiffening, integrity of the law (MaterialPoint)
  ElementTable hourglassForce;        ///< on modes [N], and on the hoop slopes of rings [N m]
  ElementTable hourglassViscousForce; ///< on modes [N]
  ElementTable compression; ///< rows: rate <-tr D> of the last half step [1/s], pressure q [Pa]
  ElementTable energies;    ///< ElementEnergy [J]
  ElementTable deformation; ///< GreenNaghdi: deformation gradient of each point
  ElementTable volumeRatio; ///< NodalPressure: geometric mean over the corners
  ElementTable ownTension;  ///< NodalPressure: mean of the initial stress [Pa]
  // full integration: rows of all points one after another
  ElementTable pointStress, pointHistory;
  ElementTable pointEnergy; ///< internal and viscous, per reference volume [J/m^3]

  // of the last update
  CornerVectors cornerForce;  ///< [N]
  Array<Real> stableStep;     ///< [s]
  Array<Real> volume;         ///< [m^3]
  ElementTable volumeChanges; ///< see ElementBlock::volumeChanges()
  ElementTable meanTension;   ///< see ElementBlock::addNodalTension() [N m]

  /// Brings what a kernel reads and writes of a batch into the cache. These are more stretches of
  /// memory than processors follow by themselves.
  KOKKOS_FORCEINLINE_FUNCTION void prefetchBatch(std::size_t batch) const
  {
    const std::size_t first = batch * laneCount;
    prefetch(&connectivity(first, 0), connectivity.extent(1) * laneCount);
    for (const Array<Real>* const numbers :
         {&mass, &referenceVolume, &referenceLength, &stableStep, &volume})
      prefetchToWrite(&(*numbers)(first), laneCount);
    for (const ElementTable* const table :
         {&cornerMass, &pointMass, &stress, &history, &tangent, &hourglassForce,
          &hourglassViscousForce, &compression, &energies, &deformation, &volumeRatio, &ownTension,
          &pointStress, &pointHistory, &pointEnergy})
      prefetchToWrite(table->batch(batch), table->extent(0) * laneCount);
    prefetchToWrite(&cornerForce(first, 0, 0), 3 * cornerForce.extent(1) * laneCount);
  }

  /// Calls f(of a, of b) for all arrays of two blocks of the same kind but the connectivity.
  template <class F>
  static void forEachOfBoth(const ElementArrays& a, const ElementArrays& b, F&& f)
  {
    using A = ElementArrays;
    for (const auto table :
         {&A::cornerMass, &A::pointMass, &A::stress, &A::history, &A::tangent, &A::hourglassForce,
          &A::hourglassViscousForce, &A::compression, &A::energies, &A::deformation,
          &A::volumeRatio, &A::ownTension, &A::pointStress, &A::pointHistory, &A::pointEnergy,
          &A::volumeChanges, &A::meanTension})
      f(a.*table, b.*table);
    for (const auto numbers :
         {&A::mass, &A::referenceVolume, &A::referenceLength, &A::stableStep, &A::volume})
      f(a.*numbers, b.*numbers);
    f(a.cornerForce, b.cornerForce);
  }
};
} // namespace coplane
