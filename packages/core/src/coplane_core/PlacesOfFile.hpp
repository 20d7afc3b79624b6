#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <sys/types.h>

namespace coplane
{
/// Writes and reads at places of a file that is there. The first failure is kept, and nothing is
/// done after it.
class PlaceWriter
{
public:
  explicit PlaceWriter(const std::string& file);
  ~PlaceWriter() { close(); }
  PlaceWriter(const PlaceWriter&) = delete;
  PlaceWriter& operator=(const PlaceWriter&) = delete;

  void write(std::uint64_t at, const void* values, std::size_t count);
  void resize(off_t bytes);
  /// Whether the file has these bytes there.
  void compare(std::uint64_t at, const void* values, std::size_t count);
  /// A part of another file, to the place `to` of this one.
  void copy(const PlaceWriter& other, std::uint64_t from, std::uint64_t to, std::uint64_t count);
  /// Here some file systems tell of writes that failed.
  void close();

  const std::string& reason() const { return reason_; } ///< of the first failure; empty: none
  int error() const { return error_; }                  ///< errno of it
  int descriptor() const { return descriptor_; }

private:
  void fails(int error, const std::string& before = "");

  int descriptor_;
  int error_ = 0;
  std::string reason_;
};

/// A file in memory with the name of one on a disk, for a library that does not survive an error of
/// a disk (HDF5 1.10 crashes when the program ends).
class MemoryFile
{
public:
  struct Failure : std::runtime_error
  {
    using std::runtime_error::runtime_error;
  };

  MemoryFile(); ///< throws Failure
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string name() const { return name_; }
  /// So that nothing is left behind when the program is killed.
  void forgetName();
  off_t size() const;

  /// action(place, bytes, count) for all that was written, in whole pages; holes are passed over.
  void
  forEachPiece(const std::function<void(std::uint64_t, const char*, std::size_t)>& action) const;

private:
  char name_[32] = "/dev/shm/coplane_XXXXXX"; ///< HDF5 takes no name that is a link (/proc/self/fd)
  int descriptor_;
};
} // namespace coplane
