#include <coplane_checkpoint/CheckpointFile.hpp>
#include <coplane_checkpoint/CheckpointWriter.hpp>
#include <coplane_checkpoint/detail/Hdf5Calls.hpp>
#include <coplane_core/DraftName.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/PlacesOfFile.hpp>
#include <coplane_core/Version.hpp>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <functional>
#include <optional>
#include <unistd.h>
#include <vector>

namespace coplane
{
namespace
{
std::string systemsReason()
{
  return std::strerror(errno);
}

/// Makes sure that the file can be written and that there is room for it: MPI-IO may lose the error
/// of a write. Returns the reason if not.
std::string findRoom(const std::string& file, std::uint64_t bytes)
{
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0666);
  if (descriptor < 0)
    return systemsReason();
  const int error = ::posix_fallocate(descriptor, 0, off_t(bytes));
  ::close(descriptor);
  // A file system that cannot reserve answers EINVAL or EOPNOTSUPP; reading back has to tell then.
  return error == 0 || error == EINVAL || error == EOPNOTSUPP
             ? ""
             : fmt::format("reserving {} bytes: {}", bytes, std::strerror(error));
}

/// Waits until the disk has the file, or the folder with its new name.
std::string makeSafe(const std::string& path)
{
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) // a folder may be written to and not read
    return errno == EACCES && std::filesystem::is_directory(path) ? "" : systemsReason();
  const std::string reason = ::fsync(descriptor) == 0 || errno == EINVAL ? "" : systemsReason();
  ::close(descriptor);
  return reason;
}

std::string writeHead(const std::string& file, const std::string& text)
{
  std::string bytes = text;
  bytes.resize(CheckpointHead::headBytes, '\0');
  PlaceWriter out(file);
  out.write(0, bytes.data(), bytes.size());
  out.close();
  return out.reason();
}

} // namespace

std::uint64_t CheckpointWriter::dataBytes() const
{
  std::uint64_t bytes = 1 << 16;
  for (const Table& table : tables_)
    bytes += (1 << 11) + std::uint64_t(table.total) * sizeof(Real) *
                             (std::uint64_t(table.rows.keySize) + table.rows.columns.size());
  for (const auto& [name, values] : numbers_)
    bytes += (1 << 11) + values.size() * sizeof(Real);
  for (const auto& [name, value] : texts_)
    bytes += (1 << 11) + value.size();
  return bytes;
}

/// Everything but the rows of tables, whose places are returned, two for each table.
std::vector<std::uint64_t> CheckpointWriter::makeFile(const std::string& name) const
{
  std::vector<std::uint64_t> places;
  hdf5::File file(name, hdf5::File::Mode::Create);
  for (const Table& table : tables_)
  {
    const KeyedRows& rows = table.rows;
    places.push_back(file.makeTable(table.name + "/keys", table.total, rows.keySize, true));
    places.push_back(file.makeTable(table.name + "/numbers", table.total,
                                    std::int64_t(rows.columns.size()), false));
    file.writeText(table.name + "/columns", rows.header());
  }
  for (const auto& [set, values] : numbers_)
    file.write(set, values);
  for (const auto& [set, value] : texts_)
    file.writeText(set, value);
  file.close();
  return places;
}

/// This rank's rows of all tables: action(place in the file, values, bytes).
template <class Action>
void CheckpointWriter::forOwnRows(const std::vector<std::uint64_t>& places,
                                  const Action& action) const
{
  for (std::size_t t = 0; t < tables_.size(); ++t)
  {
    const KeyedRows& rows = tables_[t].rows;
    const std::uint64_t first = std::uint64_t(tables_[t].first);
    action(places[2 * t] + first * std::uint64_t(rows.keySize) * sizeof(GlobalId), rows.keys.data(),
           rows.keys.size() * sizeof(GlobalId));
    action(places[2 * t + 1] + first * rows.columns.size() * sizeof(Real), rows.numbers.data(),
           rows.numbers.size() * sizeof(Real));
  }
}

namespace
{
/// Steps of writing a file under another name; after each the ranks hear whether all have done it.
class Steps
{
public:
  /// @param message of the error, with room for the reason
  Steps(const Comm& comm, std::string draft, std::function<std::string(const std::string&)> message)
      : comm_(comm), draft_(std::move(draft)), message_(std::move(message))
  {
  }

  /// Throws on all ranks, without the draft, when one has a reason why the step has failed.
  void end(const std::string& failure) const
  {
    const int rank = int(comm_.min(std::int64_t(failure.empty() ? comm_.size() : comm_.rank())));
    if (rank == comm_.size())
      return;
    const std::string reason = comm_.broadcast(failure, rank);
    if (comm_.isRoot())
      std::remove(draft_.c_str());
    failOnAllRanks(ExitCode::Output, "{}", message_(reason));
  }

private:
  const Comm& comm_;
  std::string draft_;
  std::function<std::string(const std::string&)> message_;
};

/// Why a draft cannot take a name; empty: it has, and that is safe.
std::string rename(const std::string& draft, const std::string& file, ReplacedFile* replaced)
{
  try
  {
    errno = replaced                                        ? replaced->take(draft)
            : std::rename(draft.c_str(), file.c_str()) == 0 ? 0
                                                            : errno;
    return errno != 0 ? systemsReason() : makeSafe(folderOf(file));
  }
  catch (const Error& error)
  {
    return error.what();
  }
}
} // namespace

/// Makes the draft with everything but the rows of tables; rank 0 alone.
/// @param places gets where these come to lie
/// @return why it failed; empty: it did not
std::string CheckpointWriter::writeSkeleton(const std::string& draft,
                                            std::vector<std::uint64_t>& places) const
{
  std::optional<MemoryFile> skeleton;
  std::string failure = findRoom(draft, dataBytes());
  try
  {
    if (failure.empty())
      places = makeFile(skeleton.emplace().name());
  }
  catch (const hdf5::Failure& reason)
  {
    failure = reason.what();
  }
  catch (const MemoryFile::Failure& reason)
  {
    failure = reason.what();
  }
  if (skeleton)
    skeleton->forgetName();
  if (!failure.empty())
    return failure;
  PlaceWriter out(draft);
  out.resize(skeleton->size());
  skeleton->forEachPiece([&](auto... piece) { out.write(piece...); });
  // Now, because pieces are whole pages, on which rows of tables come to lie.
  skeleton->forEachPiece([&](auto... piece) { out.compare(piece...); });
  out.close();
  return out.reason();
}

void CheckpointWriter::write(const std::string& file, std::int64_t cycle, Real time,
                             ReplacedFile* replaced) const
{
  // Going beyond a file-size limit shall be an error of the call, like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  const std::string draft = comm_->broadcast(draftOf(file));
  const Steps step(*comm_, draft,
                   [&](const std::string& reason)
                   {
                     return fmt::format(
                         "{}: the checkpoint of cycle {} cannot be written: {}. Check that the "
                         "folder '{}' exists and can be written to, and that there is room (disk, "
                         "quota, file-size limit): {} bytes.",
                         file, cycle, reason, folderOf(file), dataBytes());
                   });
  std::vector<std::uint64_t> places;
  step.end(comm_->isRoot() ? writeSkeleton(draft, places) : "");
  places = comm_->allGather(places);
  {
    PlaceWriter out(draft);
    forOwnRows(places, [&](auto... row) { out.write(row...); });
    out.close();
    step.end(out.reason());
  }
  {
    PlaceWriter in(draft);
    forOwnRows(places, [&](auto... row) { in.compare(row...); });
    step.end(in.reason());
  }

  CheckpointHead head;
  head.cycle = cycle;
  head.time = time;
  head.program = version().number;
  std::int64_t bytes = 0;
  std::error_code error;
  if (comm_->isRoot())
    bytes = std::int64_t(std::filesystem::file_size(draft, error));
  step.end(error ? error.message() : "");
  head.bytes = std::uint64_t(comm_->max(bytes));
  std::string failure;
  head.checksum = checksumOfCheckpoint(draft, head.bytes, *comm_, failure);
  step.end(failure);
  step.end(comm_->isRoot() ? writeHead(draft, head.text()) : "");
  step.end(makeSafe(draft));
  step.end(comm_->isRoot() ? rename(draft, file, replaced) : "");
}
} // namespace coplane
