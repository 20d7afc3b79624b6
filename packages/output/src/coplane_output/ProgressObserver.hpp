#pragma once

#include <coplane_dynamics/Observer.hpp>
#include <coplane_output/RunRecord.hpp>

#include <chrono>
#include <cstdint>
#include <string>

namespace coplane
{
/// "42 s", "3 min 20 s", "5 h 12 min"
std::string durationText(double seconds);

struct ProgressOptions
{
  double seconds = 5; ///< wall-clock time between lines
  double end = 0;     ///< of the whole run, where the model is that of a stage [s]; 0: of the model
};

/// Prints a line about every few seconds: cycle, time, step and what limits it, energy and its
/// balance, planes, rate, estimated time left. Rank 0's clock decides: when a line was printed it
/// tells all ranks after how many cycles to look at the clock again, so that nobody asks in every
/// cycle. With each line the record of the run is renewed; each look tells it what limits the step.
/// At the end it warns of contacts that were missed and of planes that are too deep.
class ProgressObserver : public Observer
{
public:
  /// @param record of this run, which must outlive the observer; nullptr: none is renewed
  explicit ProgressObserver(ProgressOptions options = {}, RunRecord* record = nullptr);

  void start(const Solver& solver) override;
  void endOfCycle(const Solver& solver) override;
  void finish(const Solver& solver, const Ending& ending) override;

private:
  using WallClock = std::chrono::steady_clock;
  /// Of the wall's clock, by what was done since the last line; not finite when time stood still.
  double secondsLeft(const Solver& solver, double secondsSinceLine) const;
  double endOf(const Solver& solver) const; ///< [s]
  void print(const Solver& solver, const std::string& limit, double secondsSinceLine) const;

  ProgressOptions options_;
  RunRecord* record_;
  std::int64_t elements_ = 0;
  std::int64_t nextLook_ = 1;  ///< cycle
  std::int64_t lineCycle_ = 0; ///< of the last line
  double lineTime_ = 0;        ///< of the last line [s]
  WallClock::time_point begin_, line_;
};
} // namespace coplane
