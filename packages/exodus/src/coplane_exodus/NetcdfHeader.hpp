#pragma once

#include <string>

namespace coplane
{
/// Whether a file of a classic netCDF kind (magic CDF and 1, 2 or 5) describes nothing larger than
/// itself: every list and name ends within the file, every variable of fixed size lies in it. The
/// netCDF library believes such numbers, and fills the memory. True for files of other kinds.
bool classicHeaderFitsFile(const std::string& file);
} // namespace coplane
