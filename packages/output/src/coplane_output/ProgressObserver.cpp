#include <coplane_core/Log.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_output/ProgressObserver.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
double secondsBetween(std::chrono::steady_clock::time_point a,
                      std::chrono::steady_clock::time_point b)
{
  return std::chrono::duration<double>(b - a).count();
}

} // namespace

std::string durationText(double seconds)
{
  if (!(seconds < 1e9))
    return "unknown";
  const long s = std::lround(seconds);
  if (s < 60)
    return fmt::format("{} s", s);
  if (s < 3600)
    return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

ProgressObserver::ProgressObserver(ProgressOptions options) : options_(options)
{
}

void ProgressObserver::start(const Solver& solver)
{
  std::int64_t owned = 0;
  for (const RankMesh::Block& block : solver.mesh().blocks)
    owned += std::count_if(block.owned.begin(), block.owned.end(), [](char c) { return c != 0; });
  elements_ = solver.comm().sum(owned);
  begin_ = line_ = WallClock::now();
  lineCycle_ = solver.clock().cycle;
  lineTime_ = solver.clock().time;
  nextLook_ = lineCycle_ + 1;
}

void ProgressObserver::endOfCycle(const Solver& solver)
{
  const std::int64_t cycle = solver.clock().cycle;
  if (cycle < nextLook_)
    return;
  // Rank 0 speaks: cycles until the next look (as many as fit into the rest of the interval, at
  // most ten times those since the last line, because the rate may change), and whether to print.
  const double elapsed = secondsBetween(line_, WallClock::now());
  const bool enough = elapsed >= 0.9 * options_.seconds;
  const double rate = double(cycle - lineCycle_) / std::max(elapsed, 1e-9);
  const double rest = enough ? options_.seconds : options_.seconds - elapsed;
  const double wait = std::min(rate * rest, 10.0 * double(cycle - lineCycle_));
  std::vector<std::int64_t> decision{std::max<std::int64_t>(1, std::int64_t(wait)), enough};
  if (!solver.comm().isRoot())
    decision = {0, 0};
  solver.comm().sum(decision);
  nextLook_ = cycle + decision[0];
  if (decision[1] == 0)
    return;
  print(solver, elapsed);
  line_ = WallClock::now();
  lineCycle_ = cycle;
  lineTime_ = solver.clock().time;
}

void ProgressObserver::print(const Solver& solver, double secondsSinceLine) const
{
  const Clock& clock = solver.clock();
  const EnergyBalance energy = solver.energy();
  const StepControl control = solver.stepControl();
  const std::int64_t planes = solver.hasContact() ? solver.contact().counts().planes : 0;
  const double rate = double(clock.cycle - lineCycle_) / secondsSinceLine;
  const double end = solver.model().time.end;
  const double left = secondsSinceLine * (end - clock.time) / (clock.time - lineTime_);
  logInfo("cycle {}, t = {:.5e} s ({:.1f} %), dt = {:.3e} s ({}), kinetic energy {:.4e} "
          "J, balance error {:.1e}, {} planes, {:.3g} cycles/s, {:.3g} element-cycles/s, {} left",
          clock.cycle, clock.time, 100 * clock.time / end, clock.nextStep, control.text(),
          energy.kinetic, energy.scale() > 0 ? energy.error() / energy.scale() : 0.0, planes, rate,
          rate * double(elements_), durationText(left));
}

void ProgressObserver::finish(const Solver& solver, const std::string& ending)
{
  const Clock& clock = solver.clock();
  const EnergyBalance energy = solver.energy();
  const double seconds = secondsBetween(begin_, WallClock::now());
  logInfo("{} at cycle {}, t = {:.5e} s, after {}: kinetic energy {:.4e} J, balance error {:.1e}",
          ending, clock.cycle, clock.time, durationText(seconds), energy.kinetic,
          energy.scale() > 0 ? energy.error() / energy.scale() : 0.0);
}
} // namespace coplane
