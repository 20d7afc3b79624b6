#include "Observers.hpp"

#include "CensusReport.hpp"
#include "FilesOfRun.hpp"
#include "Restart.hpp"

#include <coplane_core/Suggestion.hpp>
#include <coplane_input/MaterialCards.hpp>
#include <coplane_output/CheckpointObserver.hpp>
#include <coplane_output/Fragments.hpp>
#include <coplane_output/HistoryObserver.hpp>
#include <coplane_output/LinesObserver.hpp>
#include <coplane_output/PlanesObserver.hpp>
#include <coplane_output/ProgressObserver.hpp>
#include <coplane_output/ResultsObserver.hpp>
#include <coplane_output/RunRecord.hpp>
#include <coplane_output/TablesObserver.hpp>
#include <coplane_setup/Lookups.hpp>

#include <algorithm>
#include <sstream>
#include <utility>

namespace coplane
{
namespace
{
std::vector<std::string> linesOf(const std::string& text)
{
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

/// Where an output stands, for those that go on from a checkpoint.
std::string positionOfOutput(const RunSettings& settings, const char* output)
{
  const auto found = settings.positions.find(output);
  // What was not written before begins with the restart, but not with a line of its own.
  return found != settings.positions.end() ? found->second : settings.part > 1 ? "-1 0 " : "";
}

RunRecordOptions recordOptions(const Deck& deck, const std::string& run,
                               const RunSettings& settings)
{
  RunRecordOptions record;
  record.end = settings.end;
  record.run = run;
  record.file = recordFile(deck, settings.part);
  record.restartedFrom = settings.restartedFrom;
  record.title = deck.title;
  record.commandLine = settings.command;
  record.deckFile = deck.file;
  record.deckText = deck.text;
  record.meshFile = deck.mesh;
  return record;
}

/// Whether a list of names has this one, or "*" for all.
bool isListed(const std::vector<std::string>& list, const std::string& name)
{
  return std::any_of(list.begin(), list.end(),
                     [&](const std::string& item) { return item == "*" || item == name; });
}

Vec3 placeOf(const std::vector<Real>& numbers)
{
  return {numbers[0], numbers[1], numbers.size() > 2 ? numbers[2] : 0};
}

HistoryOptions historyOptions(const Deck& deck, const Mesh& mesh, const RunSettings& settings)
{
  HistoryOptions history;
  history.file = deck.history.file;
  history.every = deck.history.every;
  history.position = positionOfOutput(settings, "history");
  for (const StageCard& stage : deck.stages)
    history.leaving.insert(history.leaving.end(), stage.remove.begin(), stage.remove.end());
  for (const ProbeCard& card : deck.history.probes)
  {
    Probe probe;
    probe.name = card.name;
    probe.nodeSet = indexOf(mesh.nodeSets, card.nodeSet);
    probe.block = indexOf(mesh.blocks, card.block);
    probe.reaction = card.reaction;
    probe.point = card.plane ? card.plane : card.point;
    probe.plane = card.plane.has_value();
    probe.joint = card.joint;
    probe.variables = card.variables;
    for (int k = 0; k < card.count && !card.between.empty(); ++k)
    {
      Probe one = probe;
      one.name = fmt::format("{}_{}", card.name, k + 1);
      const Vec3 a = placeOf(card.between[0]), b = placeOf(card.between[1]);
      one.point = a + (Real(k) / (card.count - 1)) * (b - a);
      history.probes.push_back(one);
    }
    if (card.between.empty())
      history.probes.push_back(probe);
  }
  const auto byName = [&](const std::string& name)
  {
    return int(std::find_if(history.probes.begin(), history.probes.end(),
                            [&](const Probe& probe) { return probe.name == name; }) -
               history.probes.begin());
  };
  std::size_t p = 0;
  for (const ProbeCard& card : deck.history.probes)
    for (int k = 0; k < (card.between.empty() ? 1 : card.count); ++k, ++p)
      if (!card.relativeTo.empty())
        history.probes[p].relativeTo = byName(card.relativeTo);
  for (const JointCard& card : deck.joints)
    if (isListed(deck.history.joints, card.name))
      history.joints.push_back(card.name);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    if (const BlockCard& card = cardOf(deck, mesh.blocks[b]);
        card.rigid && isListed(deck.history.rigid, card.name))
      history.rigidBlocks.push_back(int(b));
  return history;
}

TablesOptions tablesOptions(const Deck& deck, const RunSettings& settings)
{
  const auto wants = [&](const char* table)
  {
    const auto& tables = deck.history.tables;
    return std::find(tables.begin(), tables.end(), table) != tables.end();
  };
  return {tablesBase(deck),   deck.history.every, wants("blocks"),   wants("pairs"),
          wants("materials"), wants("lines"),     settings.positions};
}

ResultsOptions resultsOptions(const Deck& deck, const MeshSlice& mesh, const std::string& run,
                              const RunSettings& settings)
{
  ResultsOptions results;
  results.file = deck.output.results;
  results.when = {deck.output.every, deck.output.times};
  results.filePerRank = deck.output.filePerRank;
  results.history = historyVariables(deck, mesh);
  results.variables = deck.output.variables;
  if (deck.output.fragments)
    results.bodies = std::make_shared<BodiesOfCycle>(deck.output.fragmentDamage);
  results.infoLines = linesOf(deck.text);
  results.infoLines.insert(results.infoLines.begin(), settings.command);
  results.run = run;
  results.part = settings.part;
  results.position = positionOfOutput(settings, "results");
  return results;
}

CheckpointOptions checkpointOptions(const Deck& deck, const MeshSlice& mesh, const Comm& comm,
                                    const std::string& run, const RunSettings& settings)
{
  CheckpointOptions checkpoint;
  checkpoint.file = deck.checkpoint.file;
  checkpoint.everyCycles = deck.checkpoint.everyCycles;
  checkpoint.everySeconds = deck.checkpoint.everySeconds;
  checkpoint.atEnd = deck.checkpoint.atEnd;
  checkpoint.maxWall = settings.maxWall;
  checkpoint.stopFile = stopFile(deck);
  checkpoint.restartedFrom = settings.restartedFrom;
  checkpoint.positions = settings.positions;
  checkpoint.texts = fingerprintsOf(deck, mesh, settings.part, comm);
  checkpoint.texts.emplace_back("identity", run);
  checkpoint.begin = settings.begin;
  return checkpoint;
}

/// Tells of bodies in which blocks lie that a stage adds, once they have come.
class AddedBlocksObserver : public Observer
{
public:
  AddedBlocksObserver(const Deck& deck, const Mesh& mesh) : deck_(deck), mesh_(mesh) {}

  void start(const Solver& solver) override { told_ = solver.stage().index; }

  void endOfCycle(const Solver& solver) override
  {
    if (std::exchange(told_, solver.stage().index) == solver.stage().index)
      return;
    const StageCard& stage = deck_.stages[std::size_t(told_)];
    std::vector<int> added;
    for (const std::string& name : stage.add)
      added.push_back(indexOf(mesh_.blocks, name));
    if (!added.empty() && solver.hasContact())
      reportOverlapsOfAdded(solver, added, stage.where);
  }

  void finish(const Solver&, const Ending&) override {}

private:
  const Deck& deck_;
  const Mesh& mesh_;
  int told_ = 0;
};
} // namespace

std::vector<std::string> historyVariables(const Deck& deck, const MeshSlice& mesh)
{
  std::vector<std::string> names;
  for (const Mesh::Block& block : mesh.mine.blocks)
  {
    const BlockCard& card = cardOf(deck, block);
    std::vector<std::string> own = historyNames(materialOf(materialCardOf(deck, card)));
    if (card.damping.ratio > 0 && !card.rigid)
      own.emplace_back("maxwell_dissipation");
    for (const std::string& name : own)
      if (name != "equivalent_plastic_strain" &&
          std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
  }
  return names;
}

std::vector<std::string> problemsOfOutputs(const Deck& deck, int dimension)
{
  std::vector<std::string> history, problems;
  for (const BlockCard& card : deck.blocks)
  {
    for (const std::string& name : historyNames(materialOf(materialCardOf(deck, card))))
      history.push_back(name);
    if (card.damping.ratio > 0 && !card.rigid)
      history.emplace_back("maxwell_dissipation");
  }
  const auto demand = [&](const std::string& where, const std::string& path,
                          const std::vector<std::string>& wanted,
                          const std::vector<std::string>& choices, const char* of)
  {
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (std::find(choices.begin(), choices.end(), wanted[i]) == choices.end())
        problems.push_back(fmt::format("{}: {}.{} = '{}' is not a variable of {}.{} There is: {}.",
                                       where, path, i, wanted[i], of,
                                       didYouMean(wanted[i], choices), fmt::join(choices, ", ")));
  };
  demand(deck.file, "output.variables", deck.output.variables,
         resultsChoices(dimension, history, deck.output.fragments), "the results");
  for (std::size_t p = 0; p < deck.history.probes.size(); ++p)
    if (const ProbeCard& probe = deck.history.probes[p]; !probe.nodeSet.empty())
      demand(probe.where, fmt::format("history.probes.{}.variables", p), probe.variables,
             nodalVariables(), "nodes");
  return problems;
}

void demandPossibleOutputs(const Deck& deck, const MeshSlice& mesh, const Solver& solver)
{
  HistoryObserver::demandPossible(solver, historyOptions(deck, mesh.mine, {}));
}

void addObservers(MultiObserver& observers, const Deck& deck, const MeshSlice& mesh,
                  const Comm& comm, const RunSettings& settings)
{
  const std::string run =
      settings.identity.empty() ? identityOf(deck, mesh, comm) : settings.identity;
  auto record = std::make_unique<RunRecord>(comm, recordOptions(deck, run, settings));
  RunRecord* const ofRun = record.get();
  observers.add(std::move(record));
  observers.add(std::make_unique<HistoryObserver>(comm, historyOptions(deck, mesh.mine, settings)));
  if (!deck.history.tables.empty())
    observers.add(std::make_unique<TablesObserver>(comm, tablesOptions(deck, settings)));
  if (!deck.output.results.empty())
  {
    const ResultsOptions results = resultsOptions(deck, mesh, run, settings);
    observers.add(std::make_unique<ResultsObserver>(comm, mesh, results));
    if (deck.output.fragments)
      observers.add(std::make_unique<FragmentsObserver>(
          comm,
          FragmentsOptions{fragmentsFile(deck), results.when, results.bodies, settings.positions}));
    if (deck.output.lines)
      observers.add(std::make_unique<LinesObserver>(
          comm, LinesOptions{planesBase(deck), results.when,
                             positionOfOutput(settings, "drawn_lines"), run}));
    if (deck.output.planes && deck.contact.enabled)
      observers.add(std::make_unique<PlanesObserver>(
          comm,
          PlanesOptions{planesBase(deck), results.when, positionOfOutput(settings, "planes"), run,
                        deck.output.planesFormat == "vtkhdf" ? PlanesFormat::VtkHdf
                                                             : PlanesFormat::Vtp}));
  }
  observers.add(std::make_unique<AddedBlocksObserver>(deck, mesh.mine));
  observers.add(std::make_unique<ProgressObserver>(ProgressOptions{5, settings.end}, ofRun));
  // The last: it asks the others where they stand.
  observers.add(std::make_unique<CheckpointObserver>(
      comm, checkpointOptions(deck, mesh, comm, run, settings), observers));
}
} // namespace coplane
