#include <coplane_checkpoint/CheckpointFile.hpp>
#include <coplane_core/StateHash.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <sstream>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace coplane
{
namespace
{
constexpr const char* firstLine = "coplane checkpoint";

std::uint64_t hashOf(const std::string& text)
{
  std::uint64_t hash = mix(text.size());
  for (const char c : text)
    hash = mix(hash ^ std::uint64_t(static_cast<unsigned char>(c)));
  return hash;
}

/// A file that is open for reading.
class Descriptor
{
public:
  explicit Descriptor(const std::string& file) : it_(::open(file.c_str(), O_RDONLY)) {}
  ~Descriptor()
  {
    if (it_ >= 0)
      ::close(it_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  bool isOpen() const { return it_ >= 0; }

  /// Returns the number of bytes that were there.
  std::size_t read(std::uint64_t from, char* to, std::size_t count) const
  {
    std::size_t done = 0;
    while (done < count)
    {
      const ssize_t got = ::pread(it_, to + done, count - done, off_t(from + done));
      if (got < 0 && errno == EINTR)
        continue;
      if (got <= 0)
        break;
      done += std::size_t(got);
    }
    return done;
  }

private:
  int it_;
};

/// What follows `name` in the line that begins with it.
std::string valueOf(const std::string& text, const std::string& name)
{
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind(name + " ", 0) == 0)
      return line.substr(name.size() + 1);
  return "";
}
} // namespace

std::string CheckpointHead::text() const
{
  const std::string lines = fmt::format(
      "{}\nversion {}\nprogram {}\ncycle {}\ntime {:.17g}\nbytes {}\nchecksum {:016x}\n", firstLine,
      version, program, cycle, time, bytes, checksum);
  return fmt::format("{}head {:016x}\n", lines, hashOf(lines));
}

std::string inspectCheckpoint(const std::string& file, CheckpointHead& head)
{
  struct stat status
  {
  };
  if (::stat(file.c_str(), &status) != 0)
    return fmt::format("it cannot be opened: {}", std::strerror(errno));
  if (!S_ISREG(status.st_mode))
    return "it is not a plain file";
  const Descriptor descriptor(file);
  if (!descriptor.isOpen())
    return fmt::format("it cannot be opened: {}", std::strerror(errno));
  std::string text(CheckpointHead::headBytes, '\0');
  text.resize(descriptor.read(0, text.data(), text.size()));
  if (text.rfind(std::string(firstLine) + "\n", 0) != 0)
    return "it is not a checkpoint of Coplane";
  const std::size_t last = text.find("\nhead ");
  const std::string version = valueOf(text, "version");
  if (last == std::string::npos)
    return fmt::format("it is cut off after {} bytes", text.size());
  const std::string lines = text.substr(0, last + 1);
  if (valueOf(text.substr(last + 1), "head").substr(0, 16) != fmt::format("{:016x}", hashOf(lines)))
    return "its first bytes are damaged";
  if (version != std::to_string(CheckpointHead::version))
    return fmt::format("its format has version {}; this program reads version {}. Restart with the "
                       "program that wrote it ({})",
                       version, CheckpointHead::version, valueOf(lines, "program"));
  head.program = valueOf(lines, "program");
  head.cycle = std::strtoll(valueOf(lines, "cycle").c_str(), nullptr, 10);
  head.time = std::strtod(valueOf(lines, "time").c_str(), nullptr);
  head.bytes = std::strtoull(valueOf(lines, "bytes").c_str(), nullptr, 10);
  head.checksum = std::strtoull(valueOf(lines, "checksum").c_str(), nullptr, 16);
  const std::string asWritten = head.text();
  if (text.rfind(asWritten, 0) != 0 ||
      text.find_first_not_of('\0', asWritten.size()) != std::string::npos)
    return "its first bytes are damaged";
  if (head.bytes != std::uint64_t(status.st_size))
    return fmt::format("it has {} bytes and should have {}", status.st_size, head.bytes);
  return "";
}

std::uint64_t checksumOfCheckpoint(const std::string& file, std::uint64_t bytes, const Comm& comm,
                                   std::string& problem)
{
  constexpr std::uint64_t wordBytes = sizeof(std::uint64_t), wordsAtOnce = 1 << 17;
  const std::uint64_t words =
      (bytes - std::min(bytes, CheckpointHead::headBytes) + wordBytes - 1) / wordBytes;
  const std::uint64_t ranks = std::uint64_t(comm.size()), rank = std::uint64_t(comm.rank());
  const std::uint64_t end = words / ranks * (rank + 1) + std::min(words % ranks, rank + 1);
  std::uint64_t sum = 0;
  const Descriptor descriptor(file);
  std::vector<std::uint64_t> buffer(wordsAtOnce);
  for (std::uint64_t at = words / ranks * rank + std::min(words % ranks, rank); at < end;)
  {
    const std::uint64_t count = std::min(wordsAtOnce, end - at);
    std::fill(buffer.begin(), buffer.end(), 0);
    const std::uint64_t from = CheckpointHead::headBytes + at * wordBytes;
    errno = 0;
    if (!descriptor.isOpen() ||
        descriptor.read(from, reinterpret_cast<char*>(buffer.data()), count * wordBytes) !=
            std::min(count * wordBytes, bytes - from))
      problem = fmt::format("reading: {}", errno ? std::strerror(errno) : "the file ends early");
    for (std::uint64_t i = 0; i < count; ++i)
      sum += mix(mix(at + i) ^ buffer[i]);
    at += count;
  }
  std::vector<std::uint64_t> total{sum};
  comm.sum(total);
  return total[0];
}

std::string verifyCheckpoint(const std::string& file, const Comm& comm, CheckpointHead& head)
{
  const std::string mine = inspectCheckpoint(file, head);
  const int worst = int(comm.min(std::int64_t(mine.empty() ? comm.size() : comm.rank())));
  if (worst < comm.size())
    return comm.broadcast(mine, worst);
  std::string problem;
  const bool same = checksumOfCheckpoint(file, head.bytes, comm, problem) == head.checksum;
  const int failed = int(comm.min(std::int64_t(problem.empty() ? comm.size() : comm.rank())));
  if (failed < comm.size())
    return comm.broadcast(problem, failed);
  if (!same)
    return "its bytes are damaged: they do not have the checksum that is written in it";
  return "";
}
} // namespace coplane
