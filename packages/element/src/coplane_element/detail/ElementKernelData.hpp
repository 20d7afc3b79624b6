#pragma once

#include <coplane_core/NodeViews.hpp>
#include <coplane_element/ElementArrays.hpp>
#include <coplane_element/ElementOptions.hpp>
#include <coplane_material/Material.hpp>

namespace coplane
{
/// What one call of ElementBlock::update() reads and writes.
struct ElementKernelData : ElementArrays
{
  ConstNodeVectors x{}, v{};
  Real dt = 0;
  ElementOptions options{};
  HourglassOptions hourglass{};
  BulkViscosity viscosity{};
  Real lambda = 0, shearModulus = 0, pWaveModulus = 0; ///< [Pa]
  Real soundSpeed = 0;                                 ///< [m/s]
  int batches = 0;
  const Material* material = nullptr;
  ConstArray<Real> nodalDilatation{}; ///< per local node, of the step; NodalPressure only
  ConstArray<Real> nodalTension{};    ///< per local node; NodalPressure only [Pa]

  /// lambda for bounds of frequencies: 0 where it is negative [Pa].
  Real lambdaOfBound() const { return lambda > 0 ? lambda : 0; }
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
} // namespace coplane
