#include <coplane_checkpoint/CheckpointFile.hpp>
#include <coplane_checkpoint/CheckpointWriter.hpp>
#include <coplane_checkpoint/Hdf5Calls.hpp>
#include <coplane_core/Version.hpp>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>

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
  const int descriptor = ::open(path.c_str(), O_RDONLY);
  if (descriptor < 0)
    return systemsReason();
  const std::string reason = ::fsync(descriptor) == 0 || errno == EINVAL ? "" : systemsReason();
  ::close(descriptor);
  return reason;
}

std::string writeHead(const std::string& file, const std::string& text)
{
  std::string bytes = text;
  bytes.resize(CheckpointHead::headBytes, '\0');
  const int descriptor = ::open(file.c_str(), O_WRONLY);
  if (descriptor < 0)
    return systemsReason();
  const bool written = ::pwrite(descriptor, bytes.data(), bytes.size(), 0) == ssize_t(bytes.size());
  const std::string reason = written ? "" : systemsReason();
  ::close(descriptor);
  return reason;
}

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b)
{
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
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

std::string CheckpointWriter::writeData(const std::string& name) const
{
  try
  {
    hdf5::File file(name, hdf5::File::Mode::Create, *comm_);
    for (const Table& table : tables_)
    {
      const KeyedRows& rows = table.rows;
      hdf5::Part part{table.total, rows.keySize, table.first, std::int64_t(rows.count())};
      file.write(table.name + "/keys", part, rows.keys);
      part.columns = std::int64_t(rows.columns.size());
      file.write(table.name + "/numbers", part, rows.numbers);
      file.writeText(table.name + "/columns", rows.header());
    }
    for (const auto& [set, values] : numbers_)
    {
      const std::int64_t size = std::int64_t(values.size());
      file.write(set, {size, 1, 0, comm_->isRoot() ? size : 0}, values);
    }
    for (const auto& [set, value] : texts_)
      file.writeText(set, value);
    file.close();
  }
  catch (const hdf5::Failure& failure)
  {
    return failure.what();
  }
  return "";
}

std::string CheckpointWriter::readBack(const std::string& name) const
{
  try
  {
    const hdf5::File file(name, hdf5::File::Mode::Read, *comm_);
    bool same = true;
    for (const Table& table : tables_)
    {
      KeyedRows rows;
      hdf5::Part part{table.total, table.rows.keySize, table.first,
                      std::int64_t(table.rows.count())};
      file.read(table.name + "/keys", part, rows.keys);
      part.columns = std::int64_t(table.rows.columns.size());
      file.read(table.name + "/numbers", part, rows.numbers);
      same = same && sameBytes(rows.keys, table.rows.keys) &&
             sameBytes(rows.numbers, table.rows.numbers);
    }
    for (const auto& [set, values] : numbers_)
    {
      std::vector<Real> read;
      const std::int64_t size = std::int64_t(values.size());
      file.read(set, {size, 1, 0, size}, read);
      same = same && (!comm_->isRoot() || sameBytes(read, values));
    }
    for (const auto& [set, value] : texts_)
    {
      const std::string read = file.readText(set);
      same = same && (!comm_->isRoot() || read == value);
    }
    return same ? "" : "what was read back differs from what was written";
  }
  catch (const hdf5::Failure& failure)
  {
    return std::string("reading back: ") + failure.what();
  }
}

void CheckpointWriter::write(const std::string& file, std::int64_t cycle, Real time) const
{
  // Going beyond a file-size limit shall be an error of the call, like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  const std::string draft = file + ".part";
  std::string failure;
  const auto failTogether = [&]
  {
    const int rank = int(comm_->min(std::int64_t(failure.empty() ? comm_->size() : comm_->rank())));
    if (rank == comm_->size())
      return;
    const std::string reason = comm_->broadcast(failure, rank);
    if (comm_->isRoot())
      std::remove(draft.c_str());
    failOnAllRanks(
        ExitCode::Output,
        "{}: the checkpoint of cycle {} cannot be written: {}. Check that the folder '{}' exists "
        "and can be written to, and that there is room (disk, quota, file-size limit): {} bytes.",
        file, cycle, reason, std::filesystem::absolute(file).parent_path().string(), dataBytes());
  };
  if (comm_->isRoot())
    failure = findRoom(draft, dataBytes());
  failTogether();
  failure = writeData(draft);
  failTogether();
  failure = readBack(draft);
  failTogether();

  CheckpointHead head;
  head.cycle = cycle;
  head.time = time;
  head.program = version().number;
  std::error_code error;
  const auto bytes = std::filesystem::file_size(draft, error);
  head.bytes = error ? 0 : bytes;
  head.checksum = checksumOfCheckpoint(draft, head.bytes, *comm_);
  if (comm_->isRoot())
    failure = writeHead(draft, head.text());
  failTogether();
  failure = makeSafe(draft);
  failTogether();
  if (comm_->isRoot())
  {
    if (std::rename(draft.c_str(), file.c_str()) != 0)
      failure = systemsReason();
    else
      failure = makeSafe(std::filesystem::absolute(file).parent_path().string());
  }
  failTogether();
}
} // namespace coplane
