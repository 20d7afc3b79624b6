#pragma once

#include <coplane_material/Material.hpp>

namespace coplane::testing
{
/// One step of a law with at most one history variable; returns the dissipation.
template <class Law, class T>
T advance(const Law& law, const SymTensorOf<T>& strainIncrement, SymTensorOf<T>& stress, T& history)
{
  MaterialPoint<T> point;
  point.strainIncrement = strainIncrement;
  point.oldStress = point.stress = stress;
  point.history[0] = history;
  law(point);
  stress = point.stress;
  history = point.history[0];
  return point.dissipation;
}
} // namespace coplane::testing
