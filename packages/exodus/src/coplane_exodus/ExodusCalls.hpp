#pragma once

#include <coplane_mesh/ContiguousRange.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace coplane
{
/// A call of the Exodus library did not succeed. The text is the library's reason; callers add
/// file, time and advice.
struct ExodusFailure : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Throws ExodusFailure when `status` is an error of Exodus (negative); warnings (positive) pass.
void checkExodus(int status, const std::string& action);

/// The library prints nothing by itself; its messages reach the user through errors of ours.
void quietExodus();

/// Ids, connectivity and counts are passed as 64-bit integers (EX_ALL_INT64_API).
using ExodusInt = std::int64_t;

/// Writable C strings for the calls that take char**.
class ExodusNames
{
public:
  explicit ExodusNames(std::vector<std::string> names);
  char** data() { return pointers_.data(); }
  int size() const { return int(pointers_.size()); }

private:
  std::vector<std::string> names_;
  std::vector<char*> pointers_;
};
} // namespace coplane
