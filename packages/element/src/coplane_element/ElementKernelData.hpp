#pragma once

#include <coplane_core/Backend.hpp>
#include <coplane_core/Lanes.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_element/ElementBlock.hpp>

namespace coplane
{
/// What one call of ElementBlock::update() reads and writes.
struct ElementKernelData
{
  ConstNodeVectors x, v;
  Real dt;
  ElementOptions options;
  HourglassOptions hourglass;
  BulkViscosity viscosity;
  Real lambda, shearModulus, pWaveModulus, soundSpeed; // [Pa], [m/s]
  int batches;
  const Material* material;
  ConstTable<int> connectivity;
  ConstArray<Real> nodalDilatation; // per local node, of the step; NodalPressure only
  ConstArray<Real> mass, referenceVolume, referenceLength;
  Table<Real> stress, history, tangent, hourglassForce, hourglassViscousForce, compression,
      energies;
  ElementBlock::CornerVectors cornerForce;
  Array<Real> stableStep, volume;
  Table<Real> cornerMass, deformation, volumeRatio;              // where the options need them
  Table<Real> pointMass, pointStress, pointHistory, pointEnergy; // FullIntegration
};

void updateTri3(const ElementKernelData& data);
void updateQuad4(const ElementKernelData& data);
void updateTet4(const ElementKernelData& data);
void updateHex8(const ElementKernelData& data);
void updateFullQuad4(const ElementKernelData& data);
void updateFullHex8(const ElementKernelData& data);
void updateFullRevolvedQuad4(const ElementKernelData& data);
void updateRevolvedTri3(const ElementKernelData& data);
void updateRevolvedQuad4(const ElementKernelData& data);

inline Lanes load(const Real* from)
{
  return Lanes(from, stdx::element_aligned);
}
inline void store(const Lanes& value, Real* to)
{
  value.copy_to(to, stdx::element_aligned);
}

/// Modes (MeanGradient.hpp) of a nodal field for a batch of elements. Corner 0 is taken off first:
/// a far origin or a common speed then costs no digits.
/// @param meanAlongX where given: mean over the corners of the first component
template <class M>
inline void gatherModes(const ConstTable<int>& connectivity, const ConstNodeVectors& field,
                        int first, Lanes (&modes)[M::dimension][M::count],
                        Lanes* meanAlongX = nullptr)
{
  const int* const node = &connectivity(first, 0);
  for (int i = 0; i < M::dimension; ++i)
  {
    const auto corner = [&](int c)
    { return Lanes([&](auto lane) { return field(node[int(lane) * M::nodes + c], i); }); };
    const Lanes origin = corner(0);
    Lanes u[M::nodes];
    u[0] = Lanes(0.0);
#pragma GCC unroll 8
    for (int c = 1; c < M::nodes; ++c)
      u[c] = corner(c) - origin;
    M::fromCorners(u, modes[i]);
    if (meanAlongX && i == 0)
    {
      Lanes sum = u[1];
      for (int c = 2; c < M::nodes; ++c)
        sum += u[c];
      *meanAlongX = origin + Lanes(1.0 / M::nodes) * sum;
    }
  }
}

template <int dim>
inline SymTensorOf<Lanes> loadTensor(const Table<Real>& table, int row, int first)
{
  const auto at = [&](int k) { return load(&table(row + k, first)); };
  if constexpr (dim == 3)
    return {at(0), at(1), at(2), at(3), at(4), at(5)};
  else
    return {at(0), at(1), at(2), at(3), Lanes(0.0), Lanes(0.0)};
}

template <int dim>
inline void storeTensor(const SymTensorOf<Lanes>& s, const Table<Real>& table, int row, int first)
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

/// V^(1/3), or A^(1/2) in two dimensions [m]. The cube root is one step of Halley's method from
/// the reference length: exact to 1 % while the volume stays between half and twice the first
/// one; the viscosity needs no more.
/// @param measure volume, or area in the plane
template <int dim>
inline Lanes characteristicLength(const ElementKernelData& data, const Lanes& measure, int first)
{
  if constexpr (dim == 2)
    return stdx::sqrt(branchFree::positivePart(measure));
  const Lanes reference = load(&data.referenceVolume(first));
  return load(&data.referenceLength(first)) * (reference + Lanes(2.0) * measure) /
         (Lanes(2.0) * reference + measure);
}

/// Twice the work of the stresses over a strain increment, per volume: with the old stress as it
/// was before the rotation its mean with the new one belongs to n + 1/2 to second order.
inline Lanes twiceWork(const SymTensorOf<Lanes>& oldStress, const SymTensorOf<Lanes>& stress,
                       const SymTensorOf<Lanes>& de)
{
  return (oldStress.xx + stress.xx) * de.xx + (oldStress.yy + stress.yy) * de.yy +
         (oldStress.zz + stress.zz) * de.zz +
         Lanes(2.0) * ((oldStress.xy + stress.xy) * de.xy + (oldStress.yz + stress.yz) * de.yz +
                       (oldStress.zx + stress.zx) * de.zx);
}

/// Forces in the order of corners, from rows of lanes.
template <class M>
inline void storeForces(const ElementKernelData& data, int first,
                        const Real (&force)[M::dimension][M::nodes][laneCount])
{
  for (int lane = 0; lane < laneCount; ++lane)
  {
    Real* const out = &data.cornerForce(first + lane, 0, 0);
    for (int c = 0; c < M::nodes; ++c)
      for (int i = 0; i < M::dimension; ++i)
        out[3 * c + i] = force[i][c][lane];
  }
}
} // namespace coplane
