#include "DeckRun.hpp"

#include "Estimate.hpp"
#include "FilesOfRun.hpp"
#include "Observers.hpp"
#include "OwnErrors.hpp"
#include "Report.hpp"
#include "Restart.hpp"

#include <coplane_core/Backend.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_dynamics/Rebalancer.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_exodus/MeshReport.hpp>
#include <coplane_exodus/ReadMesh.hpp>
#include <coplane_input/DeckReader.hpp>
#include <coplane_input/MeshChecks.hpp>
#include <coplane_mesh/Distribute.hpp>
#include <coplane_output/CheckpointObserver.hpp>
#include <coplane_setup/BuildModel.hpp>
#include <coplane_setup/ConditionsOfDeck.hpp>
#include <coplane_setup/DeckProblems.hpp>
#include <coplane_setup/IdleLoads.hpp>
#include <coplane_setup/PartitionPlan.hpp>
#include <coplane_setup/SofteningReport.hpp>

#include <chrono>
#include <memory>
#include <optional>
#include <utility>

namespace coplane
{
namespace
{
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

} // namespace

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
} // namespace coplane
