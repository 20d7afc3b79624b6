#include "Estimate.hpp"

#include "Observers.hpp"

#include <coplane_core/Log.hpp>
#include <coplane_core/Memory.hpp>
#include <coplane_dynamics/Signals.hpp>
#include <coplane_output/OutputSchedule.hpp>
#include <coplane_output/ProgressObserver.hpp>
#include <coplane_output/ResultsObserver.hpp>

#include <algorithm>
#include <chrono>

namespace coplane
{
namespace
{
/// Ends a run after some cycles, or seconds when they are slow.
class Trial : public Observer
{
public:
  void start(const Solver&) override { begin_ = WallClock::now(); }
  void endOfCycle(const Solver&) override
  {
    ++cycles_;
    seconds_ = std::chrono::duration<double>(WallClock::now() - begin_).count();
    if (cycles_ >= enoughCycles || seconds_ > enoughSeconds)
      request({false, false, true}); // one more cycle goes by until all ranks know
  }
  void finish(const Solver&, const Ending&) override {}

  std::int64_t cycles() const { return cycles_; }
  double secondsOfCycle() const { return seconds_ / double(std::max<std::int64_t>(1, cycles_)); }

private:
  using WallClock = std::chrono::steady_clock;
  static constexpr std::int64_t enoughCycles = 50;
  static constexpr double enoughSeconds = 1;

  WallClock::time_point begin_;
  std::int64_t cycles_ = 0;
  double seconds_ = 0;
};

std::string bytesText(double bytes)
{
  constexpr double mega = 1e6, giga = 1e9;
  return bytes < giga ? fmt::format("{:.3g} MB", bytes / mega)
                      : fmt::format("{:.3g} GB", bytes / giga);
}
} // namespace

void reportEstimate(Solver& solver, const MeshSlice& mesh, const Deck& deck)
{
  const Real begin = solver.clock().time;
  Trial trial;
  solver.run(trial);
  if (trial.cycles() == 0)
    return;

  const Clock& clock = solver.clock();
  const double cycles =
      double(trial.cycles()) + std::max(0.0, deck.time.end - clock.time) / clock.nextStep;
  const double seconds = solver.comm().max(trial.secondsOfCycle());
  const double total = cycles * seconds;
  logInfo(
      "estimate by a trial of {} cycles: {:.3g} cycles of {:.3g} s each, {} in all on this machine "
      "without its outputs, if the step stays {:.3e} s and no more comes into contact",
      trial.cycles(), cycles, seconds,
      total < 10 ? fmt::format("{:.2g} s", total) : durationText(total), clock.nextStep);
  std::string results = "no results";
  if (!deck.output.results.empty())
  {
    const Real steps = outputSteps({deck.output.every, deck.output.times}, begin, deck.time.end);
    const std::int64_t bytes = bytesOfResultsStep(mesh, historyVariables(deck, mesh),
                                                  deck.output.fragments, deck.output.variables);
    results = fmt::format("{:.6g} steps of results, {} in all, and contact planes besides", steps,
                          bytesText(steps * Real(bytes)));
  }
  logInfo("  memory {} on the largest rank so far; {}",
          bytesText(double(solver.comm().max(Real(peakMemory())))), results);
}
} // namespace coplane
