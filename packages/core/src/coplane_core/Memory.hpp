#pragma once

#include <cstdint>

namespace coplane
{
/// Lets the process keep the memory that it frees, for the next search or output step, instead of
/// giving it back to the system and taking it again page by page. Call before threads start; does
/// nothing where the C library is not that of GNU.
void keepFreedMemory();

/// Largest resident memory of this process so far [bytes].
std::int64_t peakMemory();

/// Makes asking for more memory than the machine (or the container) has an error of the call,
/// std::bad_alloc, instead of the slow death of everything on the machine. A lower limit of the
/// user's stays.
void limitMemoryToMachine();

/// Throws Error(ExitCode::Machine) when the process may not have as many files open as a run needs;
/// a soft limit below that is raised first.
void demandOpenFiles();
/// Throws Error(ExitCode::Machine) when the process cannot make so many threads: the library of
/// threads would end the program.
void demandThreads(int count);
} // namespace coplane
