#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace coplane
{
/// Whether a file of a classic netCDF kind (magic CDF and 1, 2 or 5) describes nothing larger than
/// itself: every list and name ends within the file, every variable of fixed size lies in it. The
/// netCDF library believes such numbers, and fills the memory. True for files of other kinds.
bool classicHeaderFitsFile(const std::string& file);

/// Where a variable lies in a file of a classic netCDF kind.
struct ClassicVariable
{
  int type = 0;              ///< of the format: 4 int, 6 double, 10 int64
  int bytes = 0;             ///< of a value
  bool isRecord = false;     ///< one piece for every time step
  std::uint64_t entries = 0; ///< in all; of a record variable: in one time step
  std::uint64_t begin = 0;   ///< first byte; of a record variable: in the first time step
};

struct ClassicLayout
{
  std::map<std::string, ClassicVariable> variables;
  std::uint64_t recordBytes = 0; ///< of a time step, all variables together
  std::uint64_t firstRecord = 0; ///< where the first time step begins, or would
};

/// The layout of a file that the netCDF library has just written. Throws ExodusFailure when it
/// cannot be read, or is not of a classic kind.
ClassicLayout readClassicLayout(const std::string& file);
} // namespace coplane
