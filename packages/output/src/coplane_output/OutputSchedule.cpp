#include <coplane_output/OutputSchedule.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
/// The latest due time that counts as reached: a little ahead, for the rounding of summed steps.
Real reached(Real time)
{
  return time + 1e-10 * std::abs(time);
}
} // namespace

Real outputSteps(const OutputTimes& when, Real begin, Real end)
{
  const auto isBetween = [&](Real time) { return time > reached(begin) && reached(time) < end; };
  Real steps = 2 + Real(std::count_if(when.times.begin(), when.times.end(),
                                      [&](Real time)
                                      {
                                        const Real off = std::remainder(time, when.every);
                                        return isBetween(time) && !(std::abs(off) <= 1e-10 * time);
                                      }));
  if (when.every > 0)
    steps += std::max(0.0, std::ceil(end * (1 - 1e-10) / when.every) - 1 -
                               std::floor(reached(begin) / when.every));
  return steps;
}

OutputSchedule::OutputSchedule(OutputTimes times) : times_(std::move(times))
{
  std::sort(times_.times.begin(), times_.times.end());
}

Real OutputSchedule::multiplesUntil(Real time) const
{
  return times_.every > 0 ? std::floor(reached(time) / times_.every) : 0;
}

void OutputSchedule::startAt(Real time)
{
  isDue(time);
}

bool OutputSchedule::isDue(Real time)
{
  const Real multiples = multiplesUntil(time);
  const auto& times = times_.times;
  const std::size_t single =
      std::upper_bound(times.begin(), times.end(), reached(time)) - times.begin();
  const bool due = multiples > multiplesDone_ || std::isinf(multiples) || single > timesDone_;
  multiplesDone_ = std::max(multiples, multiplesDone_);
  timesDone_ = std::max(single, timesDone_);
  return due;
}
} // namespace coplane
