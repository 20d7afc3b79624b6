#include "CommandLine.hpp"
#include "DeckRun.hpp"
#include "OwnErrors.hpp"
#include "Subcommands.hpp"

#include <coplane_core/Backend.hpp>
#include <coplane_core/DraftName.hpp>
#include <coplane_core/ExitCodes.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/Memory.hpp>
#include <coplane_core/Program.hpp>
#include <coplane_dynamics/Signals.hpp>
#include <coplane_input/DeckReference.hpp>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>

namespace
{
using namespace coplane;

/// After something that does no more than to say something.
void demandTextOfRoot(const Comm& comm)
{
  comm.together(
      [&]
      {
        if (comm.isRoot())
          demandTextWritten();
      });
}

/// The command line, which has to be the same on all ranks, as has the program. Returns the exit
/// code, the same on all; negative: go on. Collective.
int parseTogether(int argc, char** argv, const Comm& comm, CommandLine& line)
{
  const int parsed = parse(argc, argv, comm.isRoot(), line);
  logSetup(comm.isRoot(), line.quiet);
  setDraftToken(comm.broadcast(draftToken()));
  comm.demandSame("the program", sameEverywhere(), ExitCode::Usage);
  comm.demandSame("the command line",
                  optionsOf(line) + (parsed > 0 ? " (cannot be understood)" : ""), ExitCode::Usage);
  const auto code = comm.max(std::int64_t(parsed));
  if (code >= 0)
    demandTextOfRoot(comm);
  return int(code);
}

/// What Kokkos is to use. Options and nothing else say it; Kokkos takes variables that contradict
/// them, or are no numbers, for errors of the program. Collective.
Kokkos::InitArguments kokkosArguments(const CommandLine& line, const Comm& comm)
{
  for (const char* variable : {"KOKKOS_NUM_THREADS", "KOKKOS_NUMA", "KOKKOS_DEVICE_ID",
                               "KOKKOS_NUM_DEVICES", "KOKKOS_SKIP_DEVICE", "KOKKOS_RAND_DEVICES",
                               "KOKKOS_DISABLE_WARNINGS", "KOKKOS_TUNE_INTERNALS"})
    ::unsetenv(variable);
  Kokkos::InitArguments arguments;
  comm.together(
      [&]
      {
        demandOpenFiles();
        arguments.num_threads = threadsOf(line);
        demandThreads(arguments.num_threads);
      });
  arguments.disable_warnings = true;
  return arguments;
}

void printHelp(const CommandLine& line, const Comm& comm)
{
  std::string text;
  comm.together(
      [&]
      {
        text = line.helpCodes  ? exitCodesMarkdown()
               : line.schema   ? deckJsonSchema()
               : line.helpDeck ? deckReferenceText(line.topic)
                               : deckReferenceMarkdown();
      });
  if (comm.isRoot())
    std::cout << text;
}

/// Everything between the start and the end of MPI. Errors of all ranks at once end here, those of
/// this rank alone are for the caller.
int runProgram(int argc, char** argv, const Comm& comm, std::string& failure)
{
  try
  {
    CommandLine line;
    if (const int code = parseTogether(argc, argv, comm, line); code >= 0)
      return code; // the same everywhere, but for threads and back end
    const Kokkos::InitArguments arguments = kokkosArguments(line, comm);
    const Kokkos::ScopeGuard kokkos(arguments);
    setBackend(line.backend == "serial" ? Backend::Serial : Backend::Threads);
    std::string command;
    for (int i = 0; i < argc; ++i)
      command += (i ? " " : "") + std::string(argv[i]);
    int code = 0;
    // Before Kokkos ends, which a rank that fails alone must not wait for.
    const auto work = [&]
    {
      if (asksForHelp(line))
        printHelp(line, comm);
      else
        code = std::max(runDeck(line, comm, command), 0);
      logSummary();
    };
    endAllRanksOnOwnError(work);
    if (asksForHelp(line) || line.check)
      demandTextOfRoot(comm);
    return code;
  }
  catch (const Error& error)
  {
    if (!error.onAllRanks())
      abortAllRanks(error.code(), error.what());
    logError(error.what());
    failure = error.what();
    return int(error.code());
  }
  catch (const std::exception& error)
  {
    abortAllRanks(codeOf(error), textOf(error).c_str());
  }
}
} // namespace

int main(int argc, char** argv)
{
  startSubcommand(argc, argv);
  coplane::beginProgram();
  coplane::keepFreedMemory();
  coplane::limitMemoryToMachine();
  coplane::abortAllRanksOnTerminate();
  // Without mpirun Open MPI 4 starts a daemon beside the program, which only spawning needs. When
  // the program is killed it may stay, and has been seen to fill the memory of the machine.
  ::setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  if (!std::getenv("OMPI_COMM_WORLD_SIZE") && !std::getenv("PMIX_RANK") && !std::getenv("PMI_RANK"))
  {
    // All such programs would share one folder for the session, which each removes at its end,
    // while another starts; a single rank needs none.
    ::setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
    // It sends nothing over a network, either; looking for fast ones took 0.2 s of each start.
    ::setenv("OMPI_MCA_pml", "ob1", 0);
  }
  coplane::holdRequests();
  MPI_Init(&argc, &argv);
  coplane::listenToRequests();
  constexpr double patienceAfterErrors = 10, patience = 120; // [s]
  std::string failure;
  const Comm comm;
  const int code = runProgram(argc, argv, comm, failure);
  leaveTogether(comm, ExitCode(code),
                failure.empty() ? "the other ranks did not finish in time; all ranks are stopped"
                                : failure,
                failure.empty() ? patience : patienceAfterErrors);
  MPI_Finalize();
  return code;
}
