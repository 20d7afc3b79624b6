#include <coplane_exodus/ExodusCalls.hpp>

#include <exodusII.h>
#include <fmt/format.h>

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
} // namespace coplane
