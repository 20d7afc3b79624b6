#include <coplane_core/Program.hpp>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <iostream>
#include <unistd.h>

namespace coplane
{
void beginProgram()
{
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) == -1) // open() takes the first that is free
      if (stream != STDOUT_FILENO || ::open("/dev/full", O_RDWR) < 0)
        (void)::open("/dev/null", O_RDWR);
}

void demandTextWritten()
{
  const bool written = std::cout.flush() && std::fflush(stdout) == 0 && !std::ferror(stdout);
  if (!written && errno != EPIPE)
    fail(ExitCode::Output, "the text cannot be written to the standard output: {}.",
         std::strerror(errno));
}
} // namespace coplane
