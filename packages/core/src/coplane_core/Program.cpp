#include <coplane_core/Program.hpp>

#include <cerrno>
#include <cstring>
#include <iostream>

namespace coplane
{
void demandTextWritten()
{
  const bool written = std::cout.flush() && std::fflush(stdout) == 0 && !std::ferror(stdout);
  if (!written && errno != EPIPE)
    fail(ExitCode::Output, "the text cannot be written to the standard output: {}.",
         std::strerror(errno));
}
} // namespace coplane
