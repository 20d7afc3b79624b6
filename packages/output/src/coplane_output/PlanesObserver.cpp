#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_output/PlanesObserver.hpp>
#include <coplane_output/detail/VtkHdfSeries.hpp>
#include <coplane_output/detail/VtpSeries.hpp>

#include <cstdlib>
#include <sstream>

namespace coplane
{
PlanesObserver::PlanesObserver(const Comm& comm, PlanesOptions options)
    : options_(std::move(options)), schedule_(options_.when)
{
  // The cycle of the last step, the name, then what the series has to say of its steps.
  std::istringstream position(options_.position);
  std::string line, steps;
  if (std::getline(position, line) && isSameName(line, nameInPosition()))
  {
    std::getline(position, line);
    lastCycle_ = std::strtoll(line.c_str(), nullptr, 10);
    while (std::getline(position, line))
      steps += line + '\n';
  }
  comm.together(
      [&]
      {
        if (!comm.isRoot())
          return;
        const bool continues = !options_.position.empty();
        if (options_.format == PlanesFormat::VtkHdf)
          series_ = std::make_unique<VtkHdfSeries>(options_.base, options_.run, continues, steps);
        else
          series_ = std::make_unique<VtpSeries>(options_.base, options_.run, continues, steps);
      });
}

PlanesObserver::~PlanesObserver() = default;

/// By which a restart knows that the position is that of its files: steps of the two formats do
/// not continue each other.
std::string PlanesObserver::nameInPosition() const
{
  return options_.format == PlanesFormat::VtkHdf ? options_.base + "_planes.vtkhdf" : options_.base;
}

void PlanesObserver::start(const Solver& solver)
{
  schedule_.startAt(solver.clock().time);
  const std::vector<std::string> joints = jointNames(solver);
  solver.comm().together(
      [&]
      {
        if (series_)
          series_->begin(joints);
      });
  if (options_.position.empty())
    write(solver);
}

void PlanesObserver::savePosition(std::map<std::string, std::string>& positions) const
{
  positions["planes"] =
      fmt::format("{}\n{}\n{}", nameInPosition(), lastCycle_, series_ ? series_->position() : "");
}

void PlanesObserver::endOfCycle(const Solver& solver)
{
  const bool due = schedule_.isDue(solver.clock().time);
  if (due || solver.resultsRequested())
    write(solver);
}

void PlanesObserver::finish(const Solver& solver, const Ending&)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
  solver.comm().together(
      [&]
      {
        if (series_)
          series_->finish();
      });
}

void PlanesObserver::write(const Solver& solver)
{
  TimedRegion region("coplane::output::planes");
  const PlanePoints points = planePointsOf(solver);
  solver.comm().together(
      [&]
      {
        if (series_)
          series_->add(solver.clock().time, points);
      });
  lastCycle_ = solver.clock().cycle;
}
} // namespace coplane
