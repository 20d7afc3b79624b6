#include <coplane_exodus/ExodusCalls.hpp>
#include <coplane_exodus/SharedFile.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <limits>
#include <sys/stat.h>
#include <unistd.h>

namespace coplane
{
namespace
{
constexpr int typeInt = 4, typeDouble = 6, typeInt64 = 10; // of the classic format

void putBigEndian(std::uint64_t value, int bytes, unsigned char* to)
{
  for (int i = bytes - 1; i >= 0; --i, value >>= 8)
    to[i] = static_cast<unsigned char>(value & 0xff);
}

std::uint64_t bitsOf(Real value)
{
  std::uint64_t bits;
  static_assert(sizeof bits == sizeof value);
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

[[noreturn]] void failFor(const std::string& what)
{
  throw ExodusFailure(fmt::format("{}: {}", what, std::strerror(errno)));
}
} // namespace

SharedFile::SharedFile(const std::string& file) : layout_(readClassicLayout(file))
{
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor_ < 0)
    failFor("opening the file");
}

SharedFile::~SharedFile()
{
  if (descriptor_ >= 0)
    ::close(descriptor_); // errors are lost here: call close() where they matter
}

const ClassicVariable& SharedFile::variable(const std::string& name) const
{
  const auto found = layout_.variables.find(name);
  if (found == layout_.variables.end())
    throw ExodusFailure(fmt::format("the file has no variable '{}'", name));
  return found->second;
}

void SharedFile::write(const std::string& what, std::uint64_t at, const unsigned char* bytes,
                       std::size_t count) const
{
  while (count > 0)
  {
    const ssize_t done = ::pwrite(descriptor_, bytes, count, off_t(at));
    if (done < 0 && errno == EINTR)
      continue;
    if (done == 0)
      errno = ENOSPC; // a file system that neither writes nor says why
    if (done <= 0)
      failFor(what);
    bytes += done;
    at += std::uint64_t(done);
    count -= std::size_t(done);
  }
}

template <class T>
void SharedFile::putAny(const std::string& name, std::uint64_t first, const std::vector<T>& values,
                        int step)
{
  constexpr std::size_t valuesAtOnce = 1 << 16;
  const ClassicVariable& to = variable(name);
  if (first > to.entries || values.size() > to.entries - first)
    throw ExodusFailure(fmt::format("'{}' has {} entries, and {} were to be written from {} on",
                                    name, to.entries, values.size(), first));
  const std::uint64_t size = std::uint64_t(to.bytes);
  std::uint64_t at = to.begin + first * size;
  if (to.isRecord)
    at += std::uint64_t(step) * layout_.recordBytes;
  for (std::size_t done = 0; done < values.size(); done += valuesAtOnce)
  {
    const std::size_t count = std::min(valuesAtOnce, values.size() - done);
    buffer_.resize(count * size);
    for (std::size_t i = 0; i < count; ++i)
    {
      const T value = values[done + i];
      std::uint64_t bits = 0;
      if constexpr (std::is_same_v<T, Real>)
        bits = bitsOf(value);
      else
        bits = std::uint64_t(value);
      putBigEndian(bits, to.bytes, &buffer_[i * size]);
    }
    write("writing '" + name + "'", at + done * size, buffer_.data(), count * size);
  }
}

void SharedFile::put(const std::string& name, std::uint64_t first, const std::vector<Real>& values,
                     int step)
{
  if (variable(name).type != typeDouble)
    throw ExodusFailure(fmt::format("'{}' does not hold real numbers", name));
  putAny(name, first, values, step);
}

void SharedFile::put(const std::string& name, std::uint64_t first,
                     const std::vector<std::int64_t>& values)
{
  const int type = variable(name).type;
  if (type != typeInt && type != typeInt64)
    throw ExodusFailure(fmt::format("'{}' does not hold whole numbers", name));
  if (type == typeInt)
    for (const std::int64_t value : values)
      if (value < std::numeric_limits<std::int32_t>::min() ||
          value > std::numeric_limits<std::int32_t>::max())
        throw ExodusFailure(fmt::format("{} is too large for '{}'", value, name));
  putAny(name, first, values, 0);
}

void SharedFile::reserve(std::uint64_t first, std::uint64_t bytes) const
{
  if (bytes == 0)
    return;
  // Told before anything is written: how much is missing.
  const int error = ::posix_fallocate(descriptor_, off_t(first), off_t(bytes));
  // A file system that cannot reserve answers EINVAL or EOPNOTSUPP; there the write itself tells.
  if (error != 0 && error != EINVAL && error != EOPNOTSUPP)
    throw ExodusFailure(fmt::format("reserving {} bytes: {}", bytes, std::strerror(error)));
}

void SharedFile::reserveMesh() const
{
  reserve(0, layout_.firstRecord);
}

void SharedFile::reserveStep(int step) const
{
  if (layout_.recordBytes > 0)
    reserve(beginOfStep(step), layout_.recordBytes);
}

std::uint64_t SharedFile::beginOfStep(int step) const
{
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max();
  for (const auto& [name, variable] : layout_.variables)
    if (variable.isRecord)
      first = std::min(first, variable.begin);
  return first + std::uint64_t(step) * layout_.recordBytes;
}

bool SharedFile::isCutOff(int step, Real time)
{
  struct stat file
  {
  };
  if (::fstat(descriptor_, &file) != 0)
    return false; // what cannot be asked is told by the next write
  const std::uint64_t before = bytes_;
  bytes_ = std::uint64_t(file.st_size);
  const ClassicVariable& times = variable("time_whole");
  unsigned char expected[8], found[8] = {};
  putBigEndian(bitsOf(time), 8, expected);
  const off_t at = off_t(times.begin + std::uint64_t(step) * layout_.recordBytes);
  const ssize_t read = ::pread(descriptor_, found, sizeof found, at);
  return bytes_ < before || (read >= 0 && std::memcmp(expected, found, sizeof found) != 0);
}

void SharedFile::setSteps(int steps) const
{
  // After the magic number: 8 bytes in CDF-5, which is what the results are.
  unsigned char bytes[8];
  putBigEndian(std::uint64_t(steps), 8, bytes);
  write("number of time steps", 4, bytes, sizeof bytes);
}

bool SharedFile::isGone() const
{
  struct stat file
  {
  };
  return ::fstat(descriptor_, &file) == 0 && file.st_nlink == 0;
}

void SharedFile::sync() const
{
  // EINVAL: a file system without disk.
  if (::fsync(descriptor_) != 0 && errno != EINVAL)
    failFor("bringing it to the disk");
}

void SharedFile::close()
{
  const int closing = descriptor_;
  descriptor_ = -1;
  if (closing >= 0 && ::close(closing) != 0)
    failFor("closing");
}
} // namespace coplane
