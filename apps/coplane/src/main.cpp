#include "Estimate.hpp"
#include "FilesOfRun.hpp"
#include "Observers.hpp"
#include "Report.hpp"
#include "Restart.hpp"
#include "Subcommands.hpp"
#include "UsageHint.hpp"

#include <coplane_core/Abort.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/DraftName.hpp>
#include <coplane_core/ExitCodes.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/Memory.hpp>
#include <coplane_core/Program.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_dynamics/Rebalancer.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_exodus/MeshReport.hpp>
#include <coplane_exodus/ReadMesh.hpp>
#include <coplane_input/DeckReader.hpp>
#include <coplane_input/DeckReference.hpp>
#include <coplane_input/MeshChecks.hpp>
#include <coplane_mesh/Distribute.hpp>
#include <coplane_output/CheckpointObserver.hpp>
#include <coplane_setup/BuildModel.hpp>
#include <coplane_setup/ConditionsOfDeck.hpp>
#include <coplane_setup/DeckProblems.hpp>
#include <coplane_setup/IdleLoads.hpp>
#include <coplane_setup/PartitionPlan.hpp>
#include <coplane_setup/SofteningReport.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace
{
using namespace coplane;

struct CommandLine
{
  std::string deck;
  std::vector<std::string> overrides;
  std::string backend = "threads";
  int threads = 0; ///< 0: OMP_NUM_THREADS, else 1
  bool restart = false;
  std::string checkpoint; ///< to restart from; empty: the newest
  double maxWall = 0;     ///< [s]; 0: no limit
  bool check = false, quiet = false, helpDeck = false, helpDeckMarkdown = false, schema = false;
  std::string topic; ///< of --help-deck; empty: everything
  bool helpCodes = false;
};

bool asksForHelp(const CommandLine& line)
{
  return line.helpDeck || line.helpDeckMarkdown || line.schema || line.helpCodes;
}

/// More than that is a slip of the pen: each thread takes memory, and the system gives only so
/// many.
int mostThreads()
{
  return std::max(256, 4 * int(std::thread::hardware_concurrency()));
}

/// What all ranks must have been given alike. Threads may differ.
std::string optionsOf(const CommandLine& line)
{
  return fmt::format("{} --set [{}] restart {} {} max-wall {} check {} help {}", line.deck,
                     fmt::join(line.overrides, "] ["), line.restart, line.checkpoint, line.maxWall,
                     line.check, asksForHelp(line));
}

std::string build()
{
  return fmt::format("coplane {} ({}; {}; {}; Trilinos {})", version().number, version().revision,
                     version().compiler, version().flags, version().trilinos);
}

/// What has to be the same on all ranks. Not the processor: machines of a cluster may have
/// different ones, for which the program is compiled differently with the same bits.
std::string sameEverywhere()
{
  return fmt::format("coplane {} ({}; {}; Trilinos {})", version().number, version().revision,
                     version().compiler, version().trilinos);
}

/// What an option says is wrong with its text; empty: nothing.
std::string secondsAboveZero(const std::string& text)
{
  char* end = nullptr;
  const double seconds = std::strtod(text.c_str(), &end);
  return seconds > 0 && std::isfinite(seconds) && *end == 0
             ? ""
             : text + "; accepted: a number of seconds above 0";
}

/// Options whose values may be left out: whether they are there says the option itself.
struct OpenOptions
{
  CLI::Option *restart, *helpDeck;
};

OpenOptions addOptions(CLI::App& app, CommandLine& line)
{
  app.add_option("deck", line.deck, "The deck (YAML); --help-deck lists its keys");
  app.add_option("--set", line.overrides,
                 "Overrides a deck value: --set time.end=0.1 (may be repeated)")
      ->allow_extra_args(false);
  app.add_option("--backend", line.backend, "Where kernels run: serial or threads")
      ->check(CLI::IsMember({"serial", "threads"}));
  app.add_option("--threads", line.threads,
                 "Threads per rank with --backend threads; default: OMP_NUM_THREADS, else 1")
      ->check(CLI::Range(1, mostThreads()));
  OpenOptions open{};
  open.restart =
      app.add_option(
             "--restart", line.checkpoint,
             "Go on from a checkpoint: from this file, or from the newest one that is whole")
          ->expected(0, 1);
  app.add_option("--max-wall", line.maxWall,
                 "Write a checkpoint and stop after so many seconds (exit code 8)")
      ->check(secondsAboveZero);
  app.add_flag("--check", line.check,
               "Check deck and mesh, print masses, step and contact pairs, and stop");
  app.add_flag("--quiet", line.quiet, "Print only warnings and errors");
  open.helpDeck =
      app.add_option("--help-deck", line.topic,
                     "Print every key of a deck and stop; of one TOPIC: a section, key or model")
          ->type_name("[TOPIC]")
          ->expected(0, 1);
  app.add_flag("--help-deck-markdown", line.helpDeckMarkdown, "The same as Markdown");
  app.add_flag("--help-codes", line.helpCodes,
               "Print the table of exit codes as Markdown and stop");
  app.add_flag("--schema", line.schema, "Print the JSON Schema of decks and stop");
  app.set_version_flag("--version", build);
  return open;
}

/// What single options cannot see. Throws CLI::ParseError.
void demandSense(const CommandLine& line)
{
  if (!asksForHelp(line) && line.deck.empty())
    throw CLI::RequiredError("deck");
  if (line.backend == "serial" && line.threads > 1)
    throw CLI::ValidationError(
        "--threads", fmt::format("{} threads, but --backend serial has one; leave one of the two "
                                 "options out",
                                 line.threads));
}

/// Exit code when the program should end now, -1 to go on.
int parse(int argc, char** argv, bool isRoot, CommandLine& line)
{
  CLI::App app{"coplane: explicit dynamics of solids in contact, with Simple Common Planes.\n"
               "Example: mpirun -np 2 coplane wall.yaml --backend threads --threads 1\n"};
  app.footer(subcommandsHelp());
  const OpenOptions open = addOptions(app, line);
  app.failure_message(
      [argc, argv](const CLI::App* failed, const CLI::Error& error)
      {
        return fmt::format("ERROR: {}\n{}Accepted: coplane DECK [options], one deck. All options: "
                           "coplane --help\n",
                           error.what(), usageHint({argv + 1, argv + argc}, *failed));
      });
  try
  {
    app.parse(argc, argv);
    line.restart = open.restart->count() > 0;
    line.helpDeck = open.helpDeck->count() > 0;
    demandSense(line);
  }
  catch (const CLI::ParseError& error)
  {
    int code = error.get_exit_code();
    if (isRoot)
      app.exit(error);
    return code == 0 ? 0 : int(ExitCode::Usage);
  }
  return -1;
}

/// The checkpoint to go on from: the one that is wanted, or the newest. Collective.
std::unique_ptr<CheckpointReader> checkpointOf(const CommandLine& line, const Deck& deck,
                                               const MeshSlice& mesh, const Comm& comm)
{
  auto checkpoint = std::make_unique<CheckpointReader>(
      line.checkpoint.empty() ? newestCheckpoint(deck.checkpoint.file, comm) : line.checkpoint,
      comm);
  demandSameRun(*checkpoint, deck, mesh, comm);
  return checkpoint;
}

void restart(Solver& solver, const Deck& deck, const CheckpointReader& checkpoint,
             RunSettings& settings)
{
  solver.restore(checkpoint);
  const Clock& clock = solver.clock();
  if (clock.time - clock.step > deck.time.end)
    failOnAllRanks(ExitCode::Deck,
                   "{}: time.end = {:g} s lies before the checkpoint {} (t = {:g} s): there is "
                   "nothing to compute, and what was written since would be lost. Nothing was "
                   "touched. Give a later time.end, or an earlier checkpoint.",
                   deck.file, deck.time.end, checkpoint.file(), clock.time);
  settings.restartedFrom = checkpoint.file();
  settings.positions = positionsIn(checkpoint);
  settings.identity = identityIn(checkpoint);
  settings.part = partIn(checkpoint) + 1;
  logInfo("restart from {}: cycle {}, t = {:.9e} s, part {} of the results", checkpoint.file(),
          solver.clock().cycle, solver.clock().time, settings.part);
}

/// Does some work; an error of this rank alone ends all ranks before anything is destroyed that
/// was made outside of it: communicators within libraries are freed by all ranks together, and this
/// one must not wait for others that wait for it.
template <class Work>
void endAllRanksOnOwnError(const Work& work)
{
  try
  {
    work();
  }
  catch (const std::exception& error)
  {
    const auto* ours = dynamic_cast<const Error*>(&error);
    if (!ours || !ours->onAllRanks())
      abortAllRanks(codeOf(error), textOf(error).c_str());
    throw;
  }
}

/// Reads the deck, as it is in each stage, and demands that all ranks have the same one.
std::vector<Deck> decksOf(const CommandLine& line, const Comm& comm)
{
  std::vector<Deck> decks;
  comm.together([&] { decks = readStages(line.deck, line.overrides); });
  const Deck& deck = decks[0];
  comm.demandSame("the deck", deck.text, ExitCode::Deck);
  demandSameFiles(deck, comm);
  demandDistinctFiles(deck, line.checkpoint, comm);
  return decks;
}

void warnOfUnusualValues(const Deck& deck)
{
  if (!deck.warnings.empty())
    logWarning("unusual values",
               fmt::format("values that are accepted, but perhaps not meant:\n  {}\nThe usual "
                           "ranges are those of SI units; others serve as well when all of them "
                           "agree with each other.",
                           fmt::join(deck.warnings, "\n  ")));
}

/// The mesh that the deck names; errors say where it does. Collective.
MeshSlice meshOf(const Deck& deck, const Comm& comm)
{
  try
  {
    MeshSlice mesh = readMesh(deck.mesh, comm);
    if (deck.geometry == "axisymmetric")
      bringToAxis(mesh, comm);
    return mesh;
  }
  catch (const Error& error)
  {
    if (error.code() != ExitCode::Mesh)
      throw;
    throw Error(error.code(), fmt::format("{} It is named at {}.", error.what(), deck.meshWhere),
                error.onAllRanks());
  }
}

template <class Items>
std::vector<std::string> namesOf(const Items& items)
{
  std::vector<std::string> names;
  for (const auto& item : items)
    names.push_back(item.name);
  return names;
}

/// Throws, with all problems, when deck and mesh do not fit or the mesh is of no use; warns of what
/// is odd in the mesh. Collective.
void checkTogether(const Deck& deck, const MeshSlice& mesh, const RankMesh& home, const Comm& comm)
{
  const MeshReport report = reportMesh(mesh, home, comm);
  const std::vector<std::string> ofRigidBlocks = problemsOfRigidBlocks(deck, mesh, comm);
  const Mesh& known = mesh.mine;
  const std::vector<std::string> ofAirBlasts = problemsOfAirBlasts(deck, known, home, comm);
  const std::vector<std::string> ofDashpots = problemsOfDashpots(deck, known, home, comm);
  const std::vector<std::string> ofReactions = problemsOfReactions(deck, known, home, comm);
  const std::vector<std::string> ofProbes = problemsOfProbes(deck, home, comm);
  comm.together(
      [&]
      {
        auto problems = checkNamesAgainstMesh(deck, namesOf(known.blocks), namesOf(known.nodeSets),
                                              namesOf(known.sideSets));
        for (const std::vector<std::string>& more :
             {problemsOfDimension(deck, known.dimension), problemsOfLaws(deck, known.dimension),
              problemsOfOutputs(deck, known.dimension), ofRigidBlocks, ofAirBlasts, ofDashpots,
              ofReactions, ofProbes})
          problems.insert(problems.end(), more.begin(), more.end());
        if (!problems.empty())
          fail(ExitCode::Deck, "{}", fmt::join(problems, "\n"));
        if (!report.usable())
          fail(ExitCode::Mesh, "{}: {}", deck.mesh, fmt::join(meshProblems(report), "\n"));
        for (const std::string& note : meshProblems(report))
          logWarning("mesh", fmt::format("{}: {}", deck.mesh, note));
      });
  warnOfInitialStress(deck, known, home, comm);
}

/// What only the mesh shows of the decks of later stages. Collective.
void checkStages(const std::vector<Deck>& decks, const MeshSlice& mesh, const RankMesh& home,
                 const Comm& comm)
{
  const Mesh& known = mesh.mine;
  for (std::size_t i = 1; i < decks.size(); ++i)
  {
    const std::vector<std::string> ofAirBlasts = problemsOfAirBlasts(decks[i], known, home, comm);
    const std::vector<std::string> ofDashpots = problemsOfDashpots(decks[i], known, home, comm);
    comm.together(
        [&]
        {
          auto problems = checkNamesAgainstMesh(decks[i], namesOf(known.blocks),
                                                namesOf(known.nodeSets), namesOf(known.sideSets));
          for (const std::vector<std::string>& more :
               {problemsOfDimension(decks[i], known.dimension),
                problemsOfLaws(decks[i], known.dimension), ofAirBlasts, ofDashpots})
            problems.insert(problems.end(), more.begin(), more.end());
          if (!problems.empty())
            fail(ExitCode::Deck, "stages.{} ('{}'): {}", i, decks[i].stages[i].name,
                 fmt::join(problems, "\n"));
        });
    warnOfDoubleConditions(decks[i], known, home, comm);
  }
}

/// What only the model shows of a later stage. Collective.
void demandPossibleStage(const Solver& solver, const Deck& deck, int stage, const MeshSlice& mesh,
                         const Comm& comm)
{
  try
  {
    solver.demandPossible(stageOf(deck, stage, mesh, solver.mesh(), comm));
  }
  catch (const Error& error)
  {
    throw Error(error.code(),
                fmt::format("stages.{} ('{}'): {}", stage, deck.stages[std::size_t(stage)].name,
                            error.what()),
                error.onAllRanks());
  }
}

/// Says how a stage has ended. Collective.
void tellEndOfStage(const Solver& solver, const StageCard& stage)
{
  const RestRatios ratios = solver.restRatios();
  logInfo("stage '{}' ends at cycle {}, t = {:.6e} s, {}: kinetic energy is {:.2g} of the internal "
          "one, forces out of balance are {:.2g} of loads and reactions",
          stage.name, solver.clock().cycle, solver.clock().time,
          !stage.atRest               ? "by its time"
          : solver.relaxation().ended ? "at rest"
                                      : "by its time, not at rest",
          ratios.energy, ratios.force);
}

void tellStage(const StageCard& stage)
{
  std::vector<std::string> acts;
  for (const auto& [what, names] :
       {std::pair("removes", &stage.remove), std::pair("adds", &stage.add)})
    if (!names->empty())
      acts.push_back(fmt::format("{} {}", what, fmt::join(*names, ", ")));
  if (stage.zeroDisplacements)
    acts.push_back("counts displacements anew");
  logInfo("stage '{}' begins{}{}", stage.name, acts.empty() ? "" : ": ", fmt::join(acts, "; "));
}

/// From when on the run, or a stage of it, may end at rest.
void tellWhenRestCounts(const Model& model, const Deck& deck, Real now)
{
  const RelaxationOptions& rest = model.conditions.relaxation;
  if (!model.time.endAtRest || rest.lastChange <= now)
    return;
  if (rest.lastChange < model.time.end)
    logInfo("rest counts from t = {:.6g} s on, when {} has changed for the last time",
            rest.lastChange, rest.changing);
  else
    logWarning("no rest", fmt::format("{}: {} changes until t = {:.6g} s, so nothing ends at rest "
                                      "before that. Let it end earlier, or leave the end to the "
                                      "time.",
                                      deck.file, rest.changing, model.time.end));
}

/// Checkpoints that this run does not go on from are of another, or may be.
void putAsideOtherCheckpoints(const Deck& deck, const MeshSlice& mesh, const std::string& from,
                              const Comm& comm)
{
  if (!isOneOfTwo(deck.checkpoint.file, from, comm))
    putAside(deck.checkpoint.file, comm);
  else
    putOtherAside(deck.checkpoint.file, from, comm,
                  [&](const CheckpointReader& checkpoint)
                  { return isOfRun(checkpoint, deck, mesh, comm); });
}

int runDeck(const CommandLine& line, const Comm& comm, const std::string& command)
{
  RunSettings settings;
  settings.command = command;
  if (line.maxWall > 0)
    settings.maxWall = line.maxWall;
  const std::vector<Deck> decks = decksOf(line, comm);
  const Deck& deck = decks[0];
  settings.end = decks.back().time.end;
  for (const Deck& ofStage : decks)
    warnOfUnusualValues(ofStage);
  std::vector<FileLock> locks;
  if (!line.check)
  {
    locks = lockOutputs(deck, comm);
    removeOldStopFile(deck, comm);
    demandWritableFiles(deck, comm);
  }
  const MeshSlice mesh = meshOf(deck, comm);
  RankMesh home = partAtHome(mesh, comm);
  checkTogether(deck, mesh, home, comm);
  logInfo("coplane {} ({}), {}; {} ranks x {} threads, back end {}", version().number,
          version().revision, version().flags, comm.size(), threadCount(), name(currentBackend()));
  logInfo("deck {}{}{}", line.deck, deck.title.empty() ? "" : ": ", deck.title);
  warnOfDoubleConditions(deck, mesh.mine, home, comm);
  checkStages(decks, mesh, home, comm);

  std::unique_ptr<CheckpointReader> checkpoint;
  std::size_t stage = 0; // the present one
  if (line.restart)
  {
    checkpoint = checkpointOf(line, deck, mesh, comm);
    stage = std::size_t(Solver::stageIn(*checkpoint).index);
  }
  const auto modelOf = [&](RankMesh part)
  { return buildModel(decks[stage], mesh, std::move(part), comm); };
  const auto nextStage = [&](const Solver& solver) -> std::optional<Stage>
  {
    if (deck.stages.empty())
      return std::nullopt;
    tellEndOfStage(solver, deck.stages[stage]);
    if (stage + 1 == decks.size())
      return std::nullopt;
    ++stage;
    tellStage(deck.stages[stage]);
    Stage next = stageOf(decks[stage], int(stage), mesh, solver.mesh(), comm);
    tellWhenRestCounts(next.model, deck, solver.clock().time);
    return next;
  };
  const auto begin = std::chrono::steady_clock::now();
  Solver solver(modelOf(partOf(mesh, std::move(home), deck, comm)), comm);
  const std::chrono::duration<double> toBuild = std::chrono::steady_clock::now() - begin;
  MultiObserver observers;
  Rebalancer rebalancer(comm, mesh, rebalanceOptionsOf(deck, toBuild.count()), modelOf);
  ExitCode code = ExitCode::Success;
  const auto work = [&]
  {
    if (checkpoint)
      restart(solver, decks.back(), *checkpoint, settings);
    else
      solver.prepare();
    for (std::size_t later = stage + 1; later < decks.size(); ++later)
      demandPossibleStage(solver, decks[later], int(later), mesh, comm);
    reportModel(solver, mesh, decks.back());
    reportSoftening(deck, mesh, solver, comm);
    reportDamping(deck);
    if (!checkpoint)
      warnOfIdleLoads(decks, mesh, solver, comm);
    tellWhenRestCounts(solver.model(), deck, solver.clock().time);
    if (line.check)
    {
      demandPossibleOutputs(deck, mesh, solver);
      reportEstimate(solver, mesh, decks.back());
      logInfo("check: deck and mesh are fine; nothing was written");
      return;
    }
    putAsideOtherCheckpoints(deck, mesh, settings.restartedFrom, comm);
    addObservers(observers, deck, mesh, comm, settings);
    listenToSignals();
    checkpoint.reset();
    code = solver.run(observers, &rebalancer, nextStage);
    reportEnd(solver);
  };
  endAllRanksOnOwnError(work);
  return int(code);
}

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

/// Threads per rank; throws where the environment asks for too many.
int threadsOf(const CommandLine& line)
{
  if (line.threads > 0)
    return line.threads;
  const char* const asked = std::getenv("OMP_NUM_THREADS");
  const int threads = asked ? std::max(1, std::atoi(asked)) : 1;
  if (threads > mostThreads())
    fail(ExitCode::Usage, "OMP_NUM_THREADS = {}; accepted: 1 to {} threads per rank.", asked,
         mostThreads());
  return threads;
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
