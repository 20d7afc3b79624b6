#pragma once

#include <coplane_core/Real.hpp>

#include <algorithm>
#include <cstdint>

namespace coplane
{
/// How the time step follows the step that is safe.
///
/// A change of the step from h to h' at forces f costs (h^2 - h'^2) |f|^2 / (8 m) of energy at
/// every node: it falls when it should fall before the forces grow, and rises after they have gone.
/// So the step falls at once, rises by little in a cycle, and only when it could have risen for
/// long: planes that chatter, open for some cycles and closed for some, see one constant step.
struct StepGrowth
{
  static constexpr Real perCycle = 1.02;        ///< largest rise
  static constexpr std::int64_t patience = 200; ///< cycles before the step rises

  std::int64_t calm = 0; ///< cycles in a row in which the step could have risen

  /// The next step. last: the present one; 0 at the start [s]
  Real next(Real safe, Real last)
  {
    if (last > 0 && safe > perCycle * last)
      return ++calm > patience ? perCycle * last : last;
    calm = 0;
    return last > 0 ? std::min(safe, last) : safe;
  }
};
} // namespace coplane
