#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_mesh/ElementTopology.hpp>
#include <coplane_output/PlanesObserver.hpp>
#include <coplane_output/TextFile.hpp>
#include <coplane_output/VtpFile.hpp>

#include <algorithm>
#include <filesystem>

namespace coplane
{
namespace
{
/// What of a plane goes to the file.
struct Record
{
  GlobalId faceId[2];
  std::int64_t state, joint;
  Vec3 point, normal, force, shearTraction;
  Real area, overlap, gap, closure, normalTraction, slip;
};

/// This rank's planes, sent to rank 0 and sorted by key there.
std::vector<Record> gatherRecords(const Solver& solver)
{
  std::vector<std::vector<Record>> toRank(solver.comm().size());
  if (solver.hasContact())
  {
    const Contact& contact = solver.contact();
    for (std::size_t p = 0; p < contact.planes().extent(0); ++p)
    {
      const Plane& plane = contact.planes()(p);
      if (!contact.isWrittenHere(plane) || !(plane.overlap > 0))
        continue;
      toRank[0].push_back({{plane.faceId[0], plane.faceId[1]},
                           int(plane.state),
                           plane.joint,
                           plane.pointOfContact,
                           plane.normal,
                           plane.force,
                           plane.history.shearTraction,
                           plane.area,
                           plane.overlap,
                           plane.gap - plane.offset,
                           plane.closure,
                           plane.normalTraction,
                           plane.history.slip});
    }
  }
  std::vector<Record> records = solver.comm().exchange(toRank);
  std::sort(records.begin(), records.end(),
            [](const Record& a, const Record& b)
            { return std::tie(a.faceId[0], a.faceId[1]) < std::tie(b.faceId[0], b.faceId[1]); });
  return records;
}

std::vector<Real> column(const std::vector<Record>& records, Real Record::*member)
{
  std::vector<Real> values;
  for (const Record& record : records)
    values.push_back(record.*member);
  return values;
}

std::vector<Real> column(const std::vector<Record>& records, Vec3 Record::*member)
{
  std::vector<Real> values;
  for (const Record& record : records)
    for (int c = 0; c < 3; ++c)
      values.push_back((record.*member)[c]);
  return values;
}

template <class F>
std::vector<std::int64_t> integers(const std::vector<Record>& records, const F& of)
{
  std::vector<std::int64_t> values;
  for (const Record& record : records)
    values.push_back(of(record));
  return values;
}

std::string pointsOf(const std::vector<Record>& records)
{
  VtpPoints points(column(records, &Record::point));
  points.addVector("normal", column(records, &Record::normal));
  points.addVector("force", column(records, &Record::force));
  points.addScalar("normal_traction", column(records, &Record::normalTraction));
  points.addVector("shear_traction", column(records, &Record::shearTraction));
  points.addScalar("area", column(records, &Record::area));
  points.addScalar("overlap", column(records, &Record::overlap));
  points.addScalar("closure", column(records, &Record::closure));
  points.addScalar("gap", column(records, &Record::gap));
  points.addScalar("slip", column(records, &Record::slip));
  points.addIntegers("state", integers(records, [](const Record& r) { return r.state; }));
  points.addIntegers("joint", integers(records, [](const Record& r) { return r.joint; }));
  for (int f = 0; f < 2; ++f)
  {
    const std::string which = f == 0 ? "lower" : "higher";
    points.addIntegers(which + "_element", integers(records, [f](const Record& r)
                                                    { return elementOfFace(r.faceId[f]); }));
    points.addIntegers(which + "_side", integers(records, [f](const Record& r)
                                                 { return sideOfFace(r.faceId[f]) + 1; }));
  }
  return points.text();
}
} // namespace

PlanesObserver::PlanesObserver(const Comm& comm, PlanesOptions options)
    : base_(std::move(options.base)), schedule_(std::move(options.when))
{
  comm.together(
      [&]
      {
        if (comm.isRoot())
          writeSeries();
      });
}

void PlanesObserver::start(const Solver& solver)
{
  schedule_.startAt(solver.clock().time);
  write(solver);
}

void PlanesObserver::endOfCycle(const Solver& solver)
{
  const bool due = schedule_.isDue(solver.clock().time);
  if (due || solver.resultsRequested())
    write(solver);
}

void PlanesObserver::finish(const Solver& solver, const std::string&)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
}

void PlanesObserver::write(const Solver& solver)
{
  TimedRegion region("coplane::output::planes");
  const std::vector<Record> records = gatherRecords(solver);
  const std::string file = fmt::format("{}_planes_{:04}.vtp", base_, steps_.size());
  steps_.emplace_back(solver.clock().time, std::filesystem::path(file).filename().string());
  solver.comm().together(
      [&]
      {
        if (!solver.comm().isRoot())
          return;
        replaceFile(file, pointsOf(records));
        writeSeries();
      });
  lastCycle_ = solver.clock().cycle;
}

void PlanesObserver::writeSeries() const
{
  std::string text = "<?xml version=\"1.0\"?>\n"
                     "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
                     "  <Collection>\n";
  for (const auto& [time, name] : steps_)
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time, name);
  text += "  </Collection>\n</VTKFile>\n";
  replaceFile(file(), text);
}
} // namespace coplane
