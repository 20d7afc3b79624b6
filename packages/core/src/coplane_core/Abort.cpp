#include <coplane_core/Abort.hpp>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <sys/uio.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace coplane
{
namespace
{
bool mpiRuns() noexcept
{
  int begun = 0, ended = 0;
  MPI_Initialized(&begun);
  MPI_Finalized(&ended);
  return begun && !ended;
}

/// Whether an allocation of this thread has failed.
thread_local bool memoryRanOut = false;

[[noreturn]] void onFailedAllocation()
{
  memoryRanOut = true;
  throw std::bad_alloc();
}

[[noreturn]] void onTerminate()
{
  // Before GCC 13 an exception that leaves a noexcept function (as some of std::filesystem that
  // allocate) is not the current one here.
  const char* text = "an exception was thrown where nothing may throw";
  ExitCode code = ExitCode::Internal;
  if (memoryRanOut)
  {
    text = "there is not enough memory";
    code = ExitCode::Machine;
  }
  if (const std::exception_ptr current = std::current_exception())
    try
    {
      std::rethrow_exception(current);
    }
    catch (const std::exception& error)
    {
      code = codeOf(error);
      text = code == ExitCode::Machine ? "there is not enough memory" : error.what();
      abortAllRanks(code, text);
    }
    catch (...)
    {
    }
  abortAllRanks(code, text);
}
} // namespace

namespace
{
std::atomic<int> codeOfAbort{0}; ///< 0: nothing aborts yet
thread_local bool aborts = false;

/// MPI may need memory to abort, and crashes where there is none: then this rank ends at once, and
/// mpirun ends the others.
void leaveAtOnce(int = 0)
{
  ::_exit(codeOfAbort);
}
} // namespace

void abortAllRanks(ExitCode code, const char* text) noexcept
{
  if (aborts)
    leaveAtOnce(); // aborting has failed
  aborts = true;
  if (int none = 0; !codeOfAbort.compare_exchange_strong(none, int(code)))
  {
    std::this_thread::sleep_for(std::chrono::seconds(10)); // another thread is about it
    leaveAtOnce();
  }
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL})
    std::signal(signal, leaveAtOnce);
  int rank = 0;
  if (mpiRuns())
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  char head[64];
  const int length = std::snprintf(head, sizeof head, "ERROR: rank %d: ", rank);
  std::fflush(stdout);
  char end[] = "\n";
  // The pieces of writev are not const, though it only reads them.
  const iovec pieces[] = {
      {head, std::size_t(length)}, {const_cast<char*>(text), std::strlen(text)}, {end, 1}};
  const bool heard = ::writev(STDERR_FILENO, pieces, 3) >= 0; // without memory of our own
  static_cast<void>(heard);
  if (mpiRuns())
    MPI_Abort(MPI_COMM_WORLD, int(code));
  ::_exit(int(code));
}

ExitCode codeOf(const std::exception& error)
{
  if (const auto* ours = dynamic_cast<const Error*>(&error))
    return ours->code();
  if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error))
    return ExitCode::Machine; // more than there is, or than can be counted
  if (dynamic_cast<const std::system_error*>(&error))
    return ExitCode::Output; // a folder that is gone, a file that cannot be looked at
  return ExitCode::Internal;
}

std::string textOf(const std::exception& error)
{
  switch (codeOf(error))
  {
  case ExitCode::Machine:
    if (!dynamic_cast<const Error*>(&error))
      return "there is not enough memory for this computation. Use a coarser mesh, more ranks on "
             "more machines, or fewer ranks on this one; look for a value that is far too large.";
    break;
  case ExitCode::Internal:
    return std::string(error.what()) + " (a defect of the program: please report it)";
  default:
    break;
  }
  return error.what();
}

void abortAllRanksOnTerminate()
{
  std::set_terminate(onTerminate);
  std::set_new_handler(onFailedAllocation);
}

void leaveTogether(const Comm& comm, ExitCode code, const std::string& text, double seconds)
{
  if (comm.size() == 1)
    return;
  MPI_Request all = MPI_REQUEST_NULL;
  MPI_Ibarrier(comm.mpi(), &all);
  const auto begin = std::chrono::steady_clock::now();
  for (int here = 0;;)
  {
    MPI_Test(&all, &here, MPI_STATUS_IGNORE);
    if (here)
      return;
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > seconds)
      abortAllRanks(code == ExitCode::Success ? ExitCode::Machine : code, text.c_str());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}
} // namespace coplane
