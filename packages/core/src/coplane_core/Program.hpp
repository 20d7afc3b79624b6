#pragma once

#include <coplane_core/Abort.hpp>
#include <coplane_core/Error.hpp>

#include <cstdio>
#include <exception>

namespace coplane
{
/// At the start of every program: a pipe without reader and a file that meets a limit are errors of
/// the call, not the end of the program; and the three standard streams are open, so that no file
/// that is opened later is taken for one of them. What goes to a closed standard output counts as
/// not written.
void beginProgram();

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
    std::fputs(fmt::format("error: {}\n", textOf(error)).c_str(), stderr);
    return int(codeOf(error));
  }
}
} // namespace coplane
