#pragma once

#include <coplane_material/MaterialProbe.hpp>

#include <functional>

// The paths on which laws are tested: xx is the axis, compression is negative.
namespace coplane::testing
{
using Record = std::function<void(const MaterialProbe&)>;

/// Axial strain to `strain` in equal steps; the stresses on the other axes are held at `lateral`.
inline void uniaxialStress(MaterialProbe& probe, Real strain, int steps, const Record& record,
                           Real lateral = 0)
{
  ProbeStep step;
  step.stressGiven = {false, true, true, false, false, false};
  step.value = {(strain - probe.strain().xx) / steps, lateral, lateral, 0, 0, 0};
  for (int i = 0; i < steps; ++i)
  {
    probe.advance(step);
    record(probe);
  }
}

/// The same strain increment over and over, until `strain` is reached.
inline void strainPath(MaterialProbe& probe, const SymTensor& strain, int steps,
                       const Record& record)
{
  ProbeStep step;
  const SymTensor& s = probe.strain();
  step.value = {(strain.xx - s.xx) / steps, (strain.yy - s.yy) / steps, (strain.zz - s.zz) / steps,
                (strain.xy - s.xy) / steps, (strain.yz - s.yz) / steps, (strain.zx - s.zx) / steps};
  for (int i = 0; i < steps; ++i)
  {
    probe.advance(step);
    record(probe);
  }
}
} // namespace coplane::testing
