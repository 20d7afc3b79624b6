#pragma once

#include <coplane_core/Real.hpp>

#include <cstdint>
#include <vector>

namespace coplane
{
/// When output is due: at multiples of `every` (0: never) and at `times` [s].
struct OutputTimes
{
  Real every = 0;          ///< [s]
  std::vector<Real> times; ///< [s]
};

/// Steps that a run from `begin` to `end` [s] writes, the first and the last state among them, when
/// cycles are shorter than the times between outputs. A count, as Real: it may be huge.
Real outputSteps(const OutputTimes& when, Real begin, Real end);

/// Finds the first cycle at or after each due time. Multiples are counted, not summed, so they do
/// not drift; several due times within one cycle give one output. The same on every rank, because
/// it sees only the time.
class OutputSchedule
{
public:
  explicit OutputSchedule(OutputTimes times);

  /// Everything up to and with this time counts as done.
  void startAt(Real time);
  /// Whether output is due at the end of a cycle at `time`; what was due until then counts as done
  /// afterwards. A time that falls short of a due time by rounding only (1e-10 of it: it is a sum
  /// of many steps) is taken as reaching it.
  bool isDue(Real time);

private:
  Real multiplesUntil(Real time) const;

  OutputTimes times_;
  Real multiplesDone_ = 0;
  std::size_t timesDone_ = 0;
};
} // namespace coplane
