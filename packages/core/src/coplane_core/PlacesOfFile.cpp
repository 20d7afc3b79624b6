#include <coplane_core/PlacesOfFile.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>
#include <vector>

namespace coplane
{
PlaceWriter::PlaceWriter(const std::string& file)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CLOEXEC))
{
  if (descriptor_ < 0)
    fails(errno);
}

void PlaceWriter::fails(int error, const std::string& before)
{
  error_ = error;
  reason_ = before + std::strerror(error);
}

void PlaceWriter::write(std::uint64_t at, const void* values, std::size_t count)
{
  const char* bytes = static_cast<const char*>(values);
  while (reason_.empty() && count > 0)
  {
    const ssize_t done = ::pwrite(descriptor_, bytes, count, off_t(at));
    if (done < 0 && errno == EINTR)
      continue;
    if (done <= 0)
      fails(done == 0 ? ENOSPC : errno);
    bytes += done;
    at += std::uint64_t(done);
    count -= std::size_t(done);
  }
}

void PlaceWriter::resize(off_t bytes)
{
  if (reason_.empty() && ::ftruncate(descriptor_, bytes) != 0)
    fails(errno);
}

void PlaceWriter::compare(std::uint64_t at, const void* values, std::size_t count)
{
  std::vector<char> there(std::min<std::size_t>(count, 1 << 20));
  const char* bytes = static_cast<const char*>(values);
  while (reason_.empty() && count > 0)
  {
    const ssize_t got =
        ::pread(descriptor_, there.data(), std::min(count, there.size()), off_t(at));
    if (got < 0 && errno == EINTR)
      continue;
    if (got < 0)
      fails(errno, "reading back: ");
    else if (got == 0 || std::memcmp(there.data(), bytes, std::size_t(got)) != 0)
      reason_ = "what was read back differs from what was written";
    bytes += got;
    at += std::uint64_t(got);
    count -= std::size_t(got);
  }
}

void PlaceWriter::copy(const PlaceWriter& other, std::uint64_t from, std::uint64_t to,
                       std::uint64_t count)
{
  std::vector<char> piece(std::min<std::uint64_t>(count, 1 << 20));
  while (reason_.empty() && count > 0)
  {
    const ssize_t got = ::pread(other.descriptor_, piece.data(),
                                std::min<std::uint64_t>(count, piece.size()), off_t(from));
    if (got < 0 && errno == EINTR)
      continue;
    if (got <= 0)
    {
      fails(got == 0 ? EIO : errno, "reading what was written: ");
      return;
    }
    write(to, piece.data(), std::size_t(got));
    from += std::uint64_t(got);
    to += std::uint64_t(got);
    count -= std::uint64_t(got);
  }
}

void PlaceWriter::close()
{
  if (descriptor_ >= 0 && ::close(descriptor_) != 0 && reason_.empty())
    fails(errno);
  descriptor_ = -1;
}

MemoryFile::MemoryFile() : descriptor_(::mkostemp(name_, O_CLOEXEC))
{
  if (descriptor_ < 0)
    throw Failure("a file in memory, " + name() + ": " + std::strerror(errno));
}

MemoryFile::~MemoryFile()
{
  forgetName();
  ::close(descriptor_);
}

void MemoryFile::forgetName()
{
  if (name_[0] != '\0')
    ::unlink(name_);
  name_[0] = '\0';
}

off_t MemoryFile::size() const
{
  return ::lseek(descriptor_, 0, SEEK_END);
}

void MemoryFile::forEachPiece(
    const std::function<void(std::uint64_t, const char*, std::size_t)>& action) const
{
  std::vector<char> piece(1 << 16);
  for (off_t at = ::lseek(descriptor_, 0, SEEK_DATA); at >= 0;
       at = ::lseek(descriptor_, at, SEEK_DATA))
    for (const off_t end = ::lseek(descriptor_, at, SEEK_HOLE); at < end;)
    {
      const ssize_t got = ::pread(descriptor_, piece.data(),
                                  std::min<std::size_t>(piece.size(), std::size_t(end - at)), at);
      if (got <= 0)
        throw Failure(std::string("a file in memory: ") + std::strerror(errno));
      action(std::uint64_t(at), piece.data(), std::size_t(got));
      at += got;
    }
}
} // namespace coplane
