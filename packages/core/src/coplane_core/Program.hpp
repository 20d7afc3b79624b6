#pragma once

#include <coplane_core/Abort.hpp>
#include <coplane_core/Error.hpp>

#include <cstdio>
#include <exception>

namespace coplane
{
/// Throws Error(ExitCode::Output) when what was said so far did not reach the standard output (full
/// disk). Who stops reading has read enough.
void demandTextWritten();

/// For main() of programs on one rank: the exit code of body(), or that of the error that it ends
/// with, whose message goes to standard error.
template <class Body>
int exitCodeOf(const Body& body)
{
  try
  {
    const int code = body();
    demandTextWritten();
    return code;
  }
  catch (const std::exception& error)
  {
    fmt::print(stderr, "error: {}\n", textOf(error));
    return int(codeOf(error));
  }
}
} // namespace coplane
