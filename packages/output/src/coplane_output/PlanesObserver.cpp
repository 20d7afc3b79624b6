#include <coplane_contact/PlaneState.hpp>
#include <coplane_core/Text.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_mesh/ElementTopology.hpp>
#include <coplane_output/PlanesObserver.hpp>
#include <coplane_output/detail/VtpFile.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace coplane
{
namespace
{
/// What of a plane goes to the file.
struct Record
{
  Plane plane;
  GlobalId block[2];
  Real damage;
};

/// This rank's planes, sent to rank 0 and sorted by key there.
std::vector<Record> gatherRecords(const Solver& solver)
{
  std::vector<std::vector<Record>> toRank(solver.comm().size());
  if (solver.hasContact())
  {
    const Contact& contact = solver.contact();
    const auto& blocks = solver.mesh().blocks;
    for (std::size_t p = 0; p < contact.planes().extent(0); ++p)
    {
      const Plane& plane = contact.planes()(p);
      if (!contact.isWrittenHere(plane) || !(plane.overlap > 0))
        continue;
      const JointLaw& law = contact.lawOf(plane);
      toRank[0].push_back({plane,
                           {blocks[plane.block[0]].id, blocks[plane.block[1]].id},
                           law.damage(plane.history)});
    }
  }
  std::vector<Record> records = solver.comm().exchange(toRank);
  std::sort(records.begin(), records.end(),
            [](const Record& a, const Record& b) { return keyLess(a.plane, b.plane); });
  return records;
}

/// The columns of a file, each from what `of` takes from a record.
class Columns
{
public:
  Columns(VtpPoints& points, const std::vector<Record>& records)
      : points_(points), records_(records)
  {
  }
  template <class F>
  void vector(const std::string& name, const F& of)
  {
    std::vector<Real> values;
    for (const Record& record : records_)
      for (int c = 0; c < 3; ++c)
        values.push_back(of(record)[c]);
    points_.addVector(name, values);
  }
  template <class F>
  void scalar(const std::string& name, const F& of)
  {
    std::vector<Real> values;
    for (const Record& record : records_)
      values.push_back(of(record));
    points_.addScalar(name, values);
  }
  template <class F>
  void integer(const std::string& name, const F& of)
  {
    std::vector<std::int64_t> values;
    for (const Record& record : records_)
      values.push_back(std::int64_t(of(record)));
    points_.addIntegers(name, values);
  }

private:
  VtpPoints& points_;
  const std::vector<Record>& records_;
};

/// The columns that are members of the planes.
void addMembers(Columns& columns)
{
  forEachMember(
      [&](const auto& member)
      {
        if (!member.column)
          return;
        const auto of = [&](const Record& r) -> const auto&
        {
          return member.get(r.plane);
        };
        using Value = std::decay_t<decltype(member.get(std::declval<const Plane&>()))>;
        if constexpr (std::is_same_v<Value, Vec3>)
          columns.vector(member.column, of);
        else if constexpr (std::is_floating_point_v<Value>)
          columns.scalar(member.column, of);
        else if constexpr (std::is_integral_v<Value> || std::is_enum_v<Value>)
          columns.integer(member.column, of);
        else
          fail(ExitCode::Internal, "plane files: no column holds '{}'", member.column);
      });
}

/// Those that follow from them.
void addDerived(Columns& columns)
{
  columns.vector("force", [](const Record& r) { return r.plane.forceOn(1); });
  columns.scalar("gap", [](const Record& r) { return r.plane.gap - r.plane.offset; });
  columns.scalar("damage", [](const Record& r) { return r.damage; });
  columns.scalar("remainder", [](const Record& r) { return r.plane.remainder(); });
  columns.integer("inherited", [](const Record& r) { return r.plane.isInherited(); });
  columns.integer("released", [](const Record& r) { return r.plane.refusal == Refusal::Deep; });
  for (int f = 0; f < 2; ++f)
  {
    const std::string which = f == 0 ? "lower" : "higher";
    columns.integer(which + "_block", [f](const Record& r) { return r.block[f]; });
    columns.integer(which + "_element",
                    [f](const Record& r) { return elementOfFace(r.plane.faceId[f]); });
    columns.integer(which + "_side",
                    [f](const Record& r) { return sideOfFace(r.plane.faceId[f]) + 1; });
  }
}

std::string pointsOf(const std::vector<Record>& records, const std::vector<std::string>& joints,
                     const std::string& comment)
{
  std::vector<Real> coordinates;
  for (const Record& record : records)
    for (int c = 0; c < 3; ++c)
      coordinates.push_back(record.plane.pointOfContact[c]);
  VtpPoints points(coordinates);
  points.addNames("joint_names", joints);
  Columns columns(points, records);
  addMembers(columns);
  addDerived(columns);
  return points.text(comment);
}

/// 12 of wall_planes_0012.vtp
int numberOfStep(const std::string& name)
{
  return std::atoi(name.substr(name.rfind('_') + 1).c_str());
}

constexpr const char* beginningOfComment = "<!-- coplane run ";

std::string commentOf(const std::string& run)
{
  return beginningOfComment + run + " -->";
}

/// Series and steps say so at their beginning; nothing else is read as a whole. Steps that were
/// written before they had a comment have names of joints there.
bool isOfCoplane(const std::string& file)
{
  if (!isPlainFile(file))
    return false; // opening a pipe would wait
  std::string start(512, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), std::streamsize(start.size()));
  return start.find(beginningOfComment) != std::string::npos ||
         start.find("Name=\"joint_names\"") != std::string::npos;
}

std::string textOf(const std::filesystem::path& file)
{
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Files of the steps of a series, by its text, without folder.
std::vector<std::string> stepsNamed(const std::string& series, const std::string& base)
{
  static const std::regex entry("file=\"([^\"/]*_planes_[0-9]{1,9}\\.vtp)\"");
  const std::string stem = std::filesystem::path(base).filename().string() + "_planes_";
  const std::string mine = xmlText(stem);
  std::vector<std::string> names;
  for (auto step = std::sregex_iterator(series.begin(), series.end(), entry);
       step != std::sregex_iterator(); ++step)
    if (const std::string name = (*step)[1]; name.rfind(mine, 0) == 0)
      names.push_back(stem + name.substr(mine.size()));
  return names;
}

/// Behind all files of steps that are there.
int firstFreeNumber(const std::string& base)
{
  const std::filesystem::path path(base);
  const std::string stem = path.filename().string() + "_planes_";
  static const std::regex end(R"([0-9]{1,9}\.vtp)");
  int first = 0;
  std::error_code error;
  for (const auto& file : std::filesystem::directory_iterator(
           path.has_parent_path() ? path.parent_path() : std::filesystem::path("."), error))
    if (const std::string name = file.path().filename().string();
        name.rfind(stem, 0) == 0 && std::regex_match(name.substr(stem.size()), end))
      first = std::max(first, numberOfStep(name) + 1);
  return first;
}
} // namespace

PlanesObserver::PlanesObserver(const Comm& comm, PlanesOptions options)
    : base_(std::move(options.base)), run_(std::move(options.run)),
      continues_(!options.position.empty()), schedule_(std::move(options.when))
{
  // The cycle of the last step, the base, then a line for each step: time and file.
  std::istringstream position(options.position);
  std::string line;
  if (std::getline(position, line) && isSameName(line, base_))
  {
    std::getline(position, line);
    lastCycle_ = std::strtoll(line.c_str(), nullptr, 10);
    while (std::getline(position, line))
      steps_.emplace_back(std::strtod(line.c_str(), nullptr), line.substr(line.find(' ') + 1));
    if (!steps_.empty())
      firstNumber_ = numberOfStep(steps_.front().second);
  }
  comm.together(
      [&]
      {
        if (!comm.isRoot())
          return;
        clearTheWay();
        series_.emplace(placeOfFile(file())); // a link stays one
        series_->remember();
        writeSeries();
      });
}

void PlanesObserver::start(const Solver& solver)
{
  schedule_.startAt(solver.clock().time);
  if (!continues_)
    write(solver);
}

void PlanesObserver::savePosition(std::map<std::string, std::string>& positions) const
{
  std::string text = fmt::format("{}\n{}\n", base_, lastCycle_);
  for (const auto& [time, name] : steps_)
    text += fmt::format("{:.17g} {}\n", time, name);
  positions["planes"] = text;
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
  const std::string file =
      fmt::format("{}_planes_{:04}.vtp", base_, firstNumber_ + int(steps_.size()));
  steps_.emplace_back(solver.clock().time, std::filesystem::path(file).filename().string());
  std::vector<std::string> joints;
  if (solver.hasContact())
    for (const JointRecipe& joint : solver.contact().rules().joints)
      joints.push_back(joint.name);
  solver.comm().together(
      [&]
      {
        if (!solver.comm().isRoot())
          return;
        // Those of this series have been removed.
        makeWayNowFor(file, [](const std::string&) { return false; });
        replaceFile(file, pointsOf(records, joints, commentOf(run_)));
        writeSeries();
      });
  lastCycle_ = solver.clock().cycle;
}

/// A new run removes the steps of an earlier one: those that its series names, and no others. A
/// restart goes on with its own series; if another run has written one of that name, or this one
/// has not, that is put aside, its steps stay, and new ones are counted on from what is there.
void PlanesObserver::clearTheWay()
{
  const std::string series = file();
  std::error_code error;
  const bool isSeries = isOfCoplane(continues_ ? placeOfFile(series) : series);
  const std::string all = isSeries ? textOf(series) : "";
  const auto removeFrom = [&](int first)
  {
    for (const std::string& name : stepsNamed(all, base_))
      if (numberOfStep(name) >= first)
      {
        makeWayFor(fileOf(name), isOfCoplane);
        std::filesystem::remove(fileOf(name), error);
      }
  };
  if (!continues_)
  {
    removeFrom(0);
    makeWayFor(series, [&](const std::string&) { return isSeries; });
    return;
  }
  const bool isOwn =
      !wouldBeLost(placeOfFile(series)) || all.find(commentOf(run_)) != std::string::npos;
  if (isOwn && !steps_.empty())
  {
    removeFrom(firstNumber_ + int(steps_.size())); // later than the checkpoint
    return;
  }
  steps_.clear();
  firstNumber_ = firstFreeNumber(base_);
  if (wouldBeLost(series))
    putForeignFileAside(series);
}

std::string PlanesObserver::fileOf(const std::string& step) const
{
  return std::filesystem::path(base_).replace_filename(step).string();
}

void PlanesObserver::writeSeries() const
{
  std::string text = "<?xml version=\"1.0\"?>\n" + commentOf(run_) +
                     "\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
                     "  <Collection>\n";
  for (const auto& [time, name] : steps_)
    text +=
        fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time, xmlText(name));
  text += "  </Collection>\n</VTKFile>\n";
  series_->replace(text);
}
} // namespace coplane
