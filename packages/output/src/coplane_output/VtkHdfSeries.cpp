#include <coplane_checkpoint/Hdf5Guard.hpp>
#include <coplane_core/DraftName.hpp>
#include <coplane_core/Error.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/Text.hpp>
#include <coplane_output/detail/VtkHdfSeries.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

namespace coplane
{
namespace
{
constexpr const char* beginningOfWriter = "coplane run ";
constexpr const char* beginningOfIndex = "<!-- coplane run ";

/// Who has written a file of planes, as it says near its beginning; empty: it is none.
std::string writerOf(const std::string& file)
{
  if (!isPlainFile(file))
    return ""; // opening a pipe would wait
  std::string start(8192, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(start.data(), std::streamsize(start.size()));
  const std::size_t at = start.find(beginningOfWriter);
  return at == std::string::npos ? "" : start.substr(at, start.find('\n', at) - at);
}

/// @param run of this run; empty: of any
bool isIndex(const std::string& file, const std::string& run)
{
  std::string first, second;
  if (!isPlainFile(file))
    return false;
  std::ifstream stream(file);
  return std::getline(stream, first) && std::getline(stream, second) &&
         second.rfind(beginningOfIndex + run, 0) == 0;
}

/// Where a file is, behind links. A new run puts aside what is not ours, a link with its own name;
/// what is ours is replaced in its place.
template <class IsOurs>
std::string clearedPlace(const std::string& file, bool continues, const IsOurs& isOurs)
{
  if (!continues)
    makeWayFor(file, isOurs);
  return placeOfFile(file);
}

/// A range of a table as the Xdmf library names it: first:stride:count:size.
std::string slab(const std::string& file, const std::string& table, const char* kind, int bytes,
                 int components, std::int64_t first, std::int64_t count, std::int64_t size)
{
  const char* all = components == 3 ? " 3" : "";
  return fmt::format("<DataItem Dimensions=\"{0}{1}\" NumberType=\"{2}\" Precision=\"{3}\" "
                     "Format=\"HDF\">{4}:/VTKHDF/{5}|{6}{7}:1{8}:{0}{1}:{9}{1}</DataItem>",
                     count, all, kind, bytes, file, table, first, components == 3 ? " 0" : "",
                     components == 3 ? " 1" : "", size);
}

const void* bytesOf(const PlaneColumn& column)
{
  return std::visit([](const auto& values) -> const void* { return values.data(); }, column.values);
}
} // namespace

VtkHdfSeries::VtkHdfSeries(const std::string& base, const std::string& run, bool continues,
                           const std::string& steps)
    : base_(base), run_(run), columns_(planePointsOfNone().columns),
      data_(clearedPlace(base + "_planes.vtkhdf", continues,
                         [](const std::string& file) { return !writerOf(file).empty(); })),
      index_(clearedPlace(base + "_planes.xmf3", continues,
                          [](const std::string& file) { return isIndex(file, ""); }))
{
  std::istringstream lines(steps);
  Step step{};
  while (lines >> step.time >> step.rows)
    steps_.push_back(step);
  const bool isOwn = !steps_.empty() && openOwn();
  if (!isOwn)
  {
    steps_.clear();
    if (continues) // what another run has written
      makeWayFor(data_.file(), [](const std::string&) { return false; });
    std::error_code ignored;
    std::filesystem::remove(data_.file(), ignored); // an earlier run's
  }
  if (continues) // the index of another run is kept with its data
    makeWayFor(index_.file(), [&](const std::string& file) { return isIndex(file, run_); });
  if (isOwn)
    data_.remember(file_->descriptor());
  index_.remember();
  writeIndex();
}

/// The file of the run that is continued, if it is there; its tables are found by begin().
bool VtkHdfSeries::openOwn()
{
  const std::string writer = writerOf(data_.file());
  std::istringstream words(writer);
  std::string word, run;
  words >> word >> word >> run >> word >> room_.rows >> word >> room_.steps;
  if (!words || run != run_ || room_.steps < std::int64_t(steps_.size()) || room_.rows < rows())
    return false;
  file_ = std::make_unique<PlaceWriter>(data_.file());
  return file_->reason().empty();
}

void VtkHdfSeries::begin(const std::vector<std::string>& joints)
{
  joints_ = joints;
  if (!file_)
    return;
  written_ = skeleton(room_);
  makeRoom(room_); // without steps later than the checkpoint
  writeIndex();
}

std::int64_t VtkHdfSeries::rows() const
{
  return std::accumulate(steps_.begin(), steps_.end(), std::int64_t(0),
                         [](std::int64_t sum, const Step& step) { return sum + step.rows; });
}

std::string VtkHdfSeries::writer(const VtkHdfRoom& room) const
{
  return fmt::format("{}{} rows {} steps {}\n", beginningOfWriter, run_.empty() ? "-" : run_,
                     room.rows, room.steps);
}

VtkHdfSkeleton VtkHdfSeries::skeleton(const VtkHdfRoom& room) const
{
  std::string why;
  try
  {
    return vtkHdfSkeleton(writer(room), columns_, joints_, room, std::int64_t(steps_.size()));
  }
  catch (const MemoryFile::Failure& failure)
  {
    why = failure.what();
  }
  catch (const hdf5::Failure& failure)
  {
    why = std::string("HDF5: ") + failure.what();
  }
  fail(ExitCode::Output, "{}_planes.vtkhdf: the file cannot be prepared: {}. Is /dev/shm full?",
       base_, why);
}

std::string VtkHdfSeries::position() const
{
  std::string text;
  for (const Step& step : steps_)
    text += fmt::format("{:.17g} {}\n", step.time, step.rows);
  return text;
}

void VtkHdfSeries::fails(int error) const
{
  errno = error;
  failToWrite(base_ + "_planes.vtkhdf");
}

/// Writes the steps to a file with this room, which takes the place of the old one.
/// @param last the points of the last step, where that is not in the old one
void VtkHdfSeries::makeRoom(const VtkHdfRoom& room, const PlanePoints* last)
{
  const VtkHdfSkeleton next = skeleton(room);
  const std::string draft = draftOf(data_.file());
  errno = 0;
  if (!std::ofstream(draft, std::ios::trunc))
    fails(errno);
  auto file = std::make_unique<PlaceWriter>(draft);
  file->resize(off_t(next.bytes));
  for (const auto& [at, bytes] : next.pieces)
    file->write(at, bytes.data(), bytes.size());
  if (!file_ && steps_.size() > 1) // writing to it has failed before
    file_ = std::make_unique<PlaceWriter>(data_.file());
  const auto copy = [&](const std::string& table, std::int64_t rowBytes, std::int64_t count)
  {
    if (count > 0)
      file->copy(*file_, written_.places.at(table), next.places.at(table),
                 std::uint64_t(count * rowBytes));
  };
  const std::int64_t steps = std::int64_t(steps_.size()) - (last ? 1 : 0),
                     all = rows() - (last ? last->count() : 0);
  for (const char* table : {"Steps/Values", "NumberOfPoints", "Steps/PointOffsets",
                            "Steps/PartOffsets", "Steps/NumberOfParts"})
    copy(table, 8, steps);
  copy("Points", 24, all);
  copy("Connectivity", 8, all);
  copy("Offsets", 8, all + steps);
  copy("Types", 1, all);
  for (const PlaneColumn& column : columns_)
    copy("PointData/" + column.name, 8 * column.components, all);
  if (last)
    writeRows(*file, next, *last);
  int error = file->error();
  if (error == 0)
    error = data_.take(draft);
  if (error != 0)
  {
    std::remove(draft.c_str());
    fails(error);
  }
  file_ = std::move(file);
  written_ = next;
  room_ = room;
}

void VtkHdfSeries::add(Real time, const PlanePoints& points)
{
  if (file_ && !steps_.empty() && steps_.back().time == time)
    return; // it is there; what failed was the index, which finish() writes
  steps_.push_back({time, points.count()});
  const std::int64_t steps = std::int64_t(steps_.size()), all = rows();
  try
  {
    if (file_ && steps <= room_.steps && all <= room_.rows && data_.isAsLeft())
    {
      writeRows(*file_, written_, points);
      commit();
    }
    else
      makeRoom({std::max({room_.rows, 2 * all, std::int64_t(64)}),
                std::max({room_.steps, 2 * steps, std::int64_t(16)})},
               &points);
  }
  catch (const Error&)
  {
    steps_.pop_back();
    throw;
  }
  // Rewritten for every sixteenth of its steps, its text is written some 16 times altogether.
  if (16 * (steps_.size() - stepsOfIndex_) >= stepsOfIndex_)
    writeIndex();
}

/// Of the last step, behind the rows of those before.
void VtkHdfSeries::writeRows(PlaceWriter& file, const VtkHdfSkeleton& in,
                             const PlanePoints& points) const
{
  const std::int64_t count = points.count(), step = std::int64_t(steps_.size()) - 1,
                     first = rows() - count, one = 1;
  const auto put =
      [&](const std::string& table, std::int64_t before, const void* values, std::int64_t bytes)
  { file.write(in.places.at(table) + std::uint64_t(before), values, std::size_t(bytes)); };
  std::vector<std::int64_t> numbers(std::size_t(count + 1));
  std::iota(numbers.begin(), numbers.end(), 0);
  const std::vector<std::uint8_t> vertices(std::size_t(count), 1);
  put("Steps/Values", 8 * step, &steps_.back().time, 8);
  put("NumberOfPoints", 8 * step, &count, 8);
  put("Steps/PointOffsets", 8 * step, &first, 8);
  put("Steps/PartOffsets", 8 * step, &step, 8);
  put("Steps/NumberOfParts", 8 * step, &one, 8);
  put("Points", 24 * first, points.coordinates.data(), 24 * count);
  put("Connectivity", 8 * first, numbers.data(), 8 * count);
  put("Offsets", 8 * (first + step), numbers.data(), 8 * (count + 1));
  put("Types", first, vertices.data(), count);
  for (const PlaneColumn& column : points.columns)
  {
    const std::int64_t bytes = 8 * column.components;
    put("PointData/" + column.name, bytes * first, bytesOf(column), bytes * count);
  }
}

/// With this the last step is there.
void VtkHdfSeries::commit()
{
  VtkHdfSkeleton next = skeleton(room_);
  for (std::size_t p = 0; p < next.pieces.size(); ++p)
  {
    const std::string &now = next.pieces[p].second, &before = written_.pieces[p].second;
    for (std::size_t first = 0; first < now.size(); ++first)
    {
      if (now[first] == before[first])
        continue;
      std::size_t end = first + 1;
      while (end < now.size() && now[end] != before[end])
        ++end;
      file_->write(next.pieces[p].first + first, &now[first], end - first);
      first = end;
    }
  }
  if (const int error = file_->error(); error != 0)
  {
    file_.reset(); // it keeps its error
    fails(error);
  }
  written_ = std::move(next);
  // Not what has the name by now: that may be of somebody else.
  data_.remember(file_->descriptor());
}

void VtkHdfSeries::finish()
{
  if (!file_)
    return;
  if (rows() != room_.rows || std::int64_t(steps_.size()) != room_.steps)
    makeRoom({rows(), std::int64_t(steps_.size())});
  writeIndex();
}

void VtkHdfSeries::writeIndex()
{
  const std::string file =
      xmlText(std::filesystem::path(base_).filename().string()) + "_planes.vtkhdf";
  std::string text = fmt::format("<?xml version=\"1.0\"?>\n{}{} -->\n<Xdmf Version=\"3.0\"><Domain>"
                                 "<Grid Name=\"planes\" GridType=\"Collection\" "
                                 "CollectionType=\"Temporal\">\n",
                                 beginningOfIndex, run_);
  std::int64_t first = 0;
  for (const Step& step : steps_)
  {
    const auto part = [&](const std::string& table, const char* kind, int components)
    { return slab(file, table, kind, 8, components, first, step.rows, room_.rows); };
    text += fmt::format("<Grid Name=\"planes\"><Time Value=\"{}\"/>\n<Topology "
                        "TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\">"
                        "{}</Topology>\n<Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                        step.time, step.rows, part("Connectivity", "Int", 1),
                        part("Points", "Float", 3));
    for (const PlaneColumn& column : columns_)
      text += fmt::format(
          "<Attribute Name=\"{}\" Center=\"Node\" AttributeType=\"{}\">{}</Attribute>\n",
          column.name, column.components == 3 ? "Vector" : "Scalar",
          part("PointData/" + column.name, column.values.index() == 0 ? "Float" : "Int",
               column.components));
    text += "</Grid>\n";
    first += step.rows;
  }
  text += "</Grid></Domain></Xdmf>\n";
  index_.replace(text);
  stepsOfIndex_ = steps_.size();
}
} // namespace coplane
