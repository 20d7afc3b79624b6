#include <coplane_exodus/ExodusCalls.hpp>

#include <exodusII.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace coplane
{
void checkExodus(int status, const std::string& action)
{
  if (status >= 0)
    return;
  const char* message = nullptr;
  const char* function = nullptr;
  int code = 0;
  ex_get_err(&message, &function, &code);
  std::string reason;
  // Codes beyond 1000 are Exodus' own, small positive ones come from the system, negative ones from
  // netCDF.
  if (code > 0 && code < 1000)
    reason = std::strerror(code);
  else if (code != 0 && ex_strerror(code))
    reason = ex_strerror(code);
  if (reason.empty() && message)
    reason = message;
  throw ExodusFailure(fmt::format("{}: {}", action, reason.empty() ? "unknown reason" : reason));
}

void quietExodus()
{
  ex_opts(0);
}

ExodusNames::ExodusNames(std::vector<std::string> names) : names_(std::move(names))
{
  for (std::string& name : names_)
    pointers_.push_back(name.data());
}

IndexRange contiguousRange(int n, int rank, int ranks)
{
  const int shortest = n / ranks;
  const int longer = n % ranks;
  return {rank * shortest + std::min(rank, longer), shortest + (rank < longer ? 1 : 0)};
}

int rankOfItem(int i, int n, int ranks)
{
  const int shortest = n / ranks;
  const int longer = n % ranks;
  const int inLonger = longer * (shortest + 1);
  return i < inLonger ? i / (shortest + 1) : longer + (i - inLonger) / shortest;
}
} // namespace coplane
