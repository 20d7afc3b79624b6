#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_output/LinesObserver.hpp>
#include <coplane_output/detail/VtpFile.hpp>
#include <coplane_output/detail/VtpSteps.hpp>

#include <cstdlib>
#include <sstream>

namespace coplane
{
namespace
{
/// Points with a host, and between them the segments; of lines that are installed. In two
/// dimensions forces are those of one metre.
std::string textOf(const Solver& solver, const std::string& comment)
{
  std::vector<Real> coordinates, slips, bonds, moments;
  std::vector<Real> forces, stresses, strains, plasticStrains, broken;
  std::vector<std::int64_t> ends, lines, segments;
  std::vector<std::string> names;
  for (const Line& line : solver.lines().lines())
  {
    names.push_back(line.name());
    if (!line.installed() || line.removed())
      continue;
    const auto first = std::int64_t(coordinates.size() / 3);
    for (const Line::Point& point : line.points())
    {
      const Vec3 place = line.place(point.index);
      coordinates.insert(coordinates.end(), {place.x, place.y, place.z});
      slips.push_back(point.slip);
      bonds.push_back(point.bondForce);
      moments.push_back(norm(point.moment));
    }
    for (std::size_t s = 0; s < line.segments().size(); ++s)
    {
      const Line::Segment& segment = line.segments()[s];
      ends.insert(ends.end(), {first + std::int64_t(s), first + std::int64_t(s) + 1});
      lines.push_back(std::int64_t(names.size()) - 1);
      segments.push_back(line.points()[s].index + 1);
      forces.push_back(segment.force);
      stresses.push_back(segment.force / line.section().area);
      strains.push_back(segment.strain);
      plasticStrains.push_back(segment.plasticStrain);
      broken.push_back(segment.broken);
    }
  }
  VtpPoints points(coordinates, ends);
  points.addNames("line_names", names);
  points.addScalar("slip", slips);
  points.addScalar("bond", bonds);
  points.addScalar("moment", moments);
  points.addScalarOfCells("force", forces);
  points.addScalarOfCells("stress", stresses);
  points.addScalarOfCells("strain", strains);
  points.addScalarOfCells("plastic_strain", plasticStrains);
  points.addScalarOfCells("broken", broken);
  points.addIntegersOfCells("line", lines);
  points.addIntegersOfCells("segment", segments);
  return points.text(comment);
}
} // namespace

LinesObserver::LinesObserver(const Comm& comm, LinesOptions options)
    : options_(std::move(options)), schedule_(options_.when)
{
  // The cycle of the last step, the name, then what the series has to say of its steps.
  std::istringstream position(options_.position);
  std::string line, steps;
  if (std::getline(position, line) && isSameName(line, base()))
  {
    std::getline(position, line);
    lastCycle_ = std::strtoll(line.c_str(), nullptr, 10);
    while (std::getline(position, line))
      steps += line + '\n';
  }
  comm.together(
      [&]
      {
        if (comm.isRoot())
          steps_ =
              std::make_unique<VtpSteps>(base(), options_.run, !options_.position.empty(), steps);
      });
}

LinesObserver::~LinesObserver() = default;

std::string LinesObserver::base() const
{
  return options_.base + "_lines";
}

void LinesObserver::start(const Solver& solver)
{
  schedule_.startAt(solver.clock().time);
  if (options_.position.empty())
    write(solver);
}

void LinesObserver::savePosition(std::map<std::string, std::string>& positions) const
{
  positions["drawn_lines"] =
      fmt::format("{}\n{}\n{}", base(), lastCycle_, steps_ ? steps_->position() : "");
}

void LinesObserver::endOfCycle(const Solver& solver)
{
  const bool due = schedule_.isDue(solver.clock().time);
  if (due || solver.resultsRequested())
    write(solver);
}

void LinesObserver::endOfStage(const Solver& solver)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
}

void LinesObserver::finish(const Solver& solver, const Ending&)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
}

void LinesObserver::write(const Solver& solver)
{
  TimedRegion region("coplane::output::lines");
  solver.comm().together(
      [&]
      {
        if (steps_)
          steps_->add(solver.clock().time, textOf(solver, steps_->comment()));
      });
  lastCycle_ = solver.clock().cycle;
}
} // namespace coplane
