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

ProgressObserver::ProgressObserver(ProgressOptions options, RunRecord* record)
    : options_(options), record_(record)
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
  const std::string limit = solver.stepControl().text();
  if (record_)
    record_->noteLimit(limit);
  if (decision[1] == 0)
    return;
  print(solver, limit, elapsed);
  if (record_)
    record_->renew(secondsLeft(solver, elapsed));
  line_ = WallClock::now();
  lineCycle_ = cycle;
  lineTime_ = solver.clock().time;
}

double ProgressObserver::endOf(const Solver& solver) const
{
  return options_.end > 0 ? options_.end : solver.model().time.end;
}

double ProgressObserver::secondsLeft(const Solver& solver, double secondsSinceLine) const
{
  const Clock& clock = solver.clock();
  return secondsSinceLine * (endOf(solver) - clock.time) / (clock.time - lineTime_);
}

void ProgressObserver::print(const Solver& solver, const std::string& limit,
                             double secondsSinceLine) const
{
  const Clock& clock = solver.clock();
  const EnergyBalance energy = solver.energy();
  const std::int64_t planes = solver.hasContact() ? solver.contact().counts().planes : 0;
  const double rate = double(clock.cycle - lineCycle_) / secondsSinceLine;
  logInfo("cycle {}, t = {:.5e} s ({:.1f} %), dt = {:.3e} s ({}), kinetic energy {:.4e} "
          "J, balance error {:.1e}, {} planes, {:.3g} cycles/s, {:.3g} element-cycles/s, {} left",
          clock.cycle, clock.time, 100 * clock.time / endOf(solver), clock.nextStep, limit,
          energy.kinetic, energy.scale() > 0 ? energy.error() / energy.scale() : 0.0, planes, rate,
          rate * double(elements_), durationText(secondsLeft(solver, secondsSinceLine)));
}

void ProgressObserver::finish(const Solver& solver, const Ending& ending)
{
  const Clock& clock = solver.clock();
  const EnergyBalance energy = solver.energy();
  const double seconds = secondsBetween(begin_, WallClock::now());
  logInfo("{} at cycle {}, t = {:.5e} s, after {}: kinetic energy {:.4e} J, balance error {:.1e}",
          ending.how, clock.cycle, clock.time, durationText(seconds), energy.kinetic,
          energy.scale() > 0 ? energy.error() / energy.scale() : 0.0);
  if (!solver.hasContact())
    return;
  const ContactCounts counts = solver.contact().counts();
  if (counts.missed > 0)
    logWarning("contacts missed",
               fmt::format("{} pairs of faces lay in each other already when a search found "
                           "them, and were taken as they were: what they should have exchanged "
                           "is lost. Raise contact.skin, lower contact.search_every or "
                           "time.step_factor.",
                           counts.missed));
  if (counts.tooDeep > 0)
    logWarning("planes too deep at the end",
               fmt::format("{} planes are deeper than contact.depth_max: bodies lie in each "
                           "other. Raise the stiffness of the joint.",
                           counts.tooDeep));
}
} // namespace coplane
