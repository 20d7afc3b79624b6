#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/Error.hpp>

#include <exception>
#include <string>

namespace coplane
{
/// The one way out when this rank cannot go on and others may be waiting for it in a collective
/// call: prints the text once, ends all ranks with the code, and does not return. Calls nothing
/// collective, flushes no file, and allocates nothing.
[[noreturn]] void abortAllRanks(ExitCode code, const char* text) noexcept;

/// Exit code of an exception and whose fault it is: the code of an Error; Machine for memory that
/// is not there; Output for what the system says of files; Internal for everything else.
ExitCode codeOf(const std::exception& error);

/// What is printed of an exception. May throw std::bad_alloc.
std::string textOf(const std::exception& error);

/// Exceptions that no handler takes (out of a thread of a kernel, or a destructor) end all ranks,
/// too. Once, at the start of main().
void abortAllRanksOnTerminate();

/// At the end of main(), on every rank: waits for the others, at most so long. When they do not
/// come (they wait elsewhere for this one), ends all ranks with the code and the text. Collective.
void leaveTogether(const Comm& comm, ExitCode code, const std::string& text, double seconds);
} // namespace coplane
