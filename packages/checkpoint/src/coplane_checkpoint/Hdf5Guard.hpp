#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

// What every call of HDF5 goes through. Ids of HDF5 are 64-bit integers and its status is an int,
// so the header of the library stays in the sources that call it.

namespace coplane::hdf5
{
/// A call of HDF5 did not succeed; the text says what was to be done.
struct Failure : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Closes an id at the end of its scope.
class Id
{
public:
  /// @param what was to be opened or made
  /// @throws Failure when there is no id
  Id(std::int64_t id, int (*close)(std::int64_t), const std::string& what) : id_(id), close_(close)
  {
    if (id_ < 0)
      throw Failure(what);
  }
  ~Id() { close_(id_); }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator std::int64_t() const { return id_; }

private:
  std::int64_t id_;
  int (*close_)(std::int64_t);
};

/// @param what the call was to do
/// @throws Failure
inline void check(int status, const std::string& what)
{
  if (status < 0)
    throw Failure(what);
}
} // namespace coplane::hdf5
