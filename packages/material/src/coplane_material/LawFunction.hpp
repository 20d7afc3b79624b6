#pragma once

#include <coplane_material/MaterialPoint.hpp>

namespace coplane
{
/// A law as kernels call it: one function per law, whatever the element.
struct LawFunction
{
  const void* law = nullptr;
  void (*advanceLanes)(const void*, MaterialPoint<Lanes>&) = nullptr;
  void (*advanceOne)(const void*, MaterialPoint<Real>&) = nullptr;
  int historyCount = 0;
  bool usesVolume = false;     ///< reads volume ratios, energy and size of the point
  bool changesTangent = false; ///< writes stiffening and integrity
  bool hasStrength = false;    ///< lets bending flow

  void operator()(MaterialPoint<Lanes>& point) const { advanceLanes(law, point); }
  void operator()(MaterialPoint<Real>& point) const { advanceOne(law, point); }
};
} // namespace coplane
