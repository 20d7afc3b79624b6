#include "Observers.hpp"

#include "FilesOfRun.hpp"
#include "Restart.hpp"

#include <coplane_input/MaterialCards.hpp>
#include <coplane_output/CheckpointObserver.hpp>
#include <coplane_output/HistoryObserver.hpp>
#include <coplane_output/PlanesObserver.hpp>
#include <coplane_output/ProgressObserver.hpp>
#include <coplane_output/ResultsObserver.hpp>
#include <coplane_output/RunRecord.hpp>
#include <coplane_output/TablesObserver.hpp>

#include <algorithm>
#include <sstream>

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

template <class Items>
int positionOf(const Items& items, const std::string& name)
{
  for (int i = 0; i < int(items.size()); ++i)
    if (items[i].name == name)
      return i;
  return -1;
}

/// Variables of the laws of the mesh's blocks, each once, in the order of the blocks. Those that
/// are written anyway are left out.
std::vector<std::string> historyVariables(const Deck& deck, const MeshSlice& mesh)
{
  std::vector<std::string> names;
  for (const Mesh::Block& block : mesh.mine.blocks)
  {
    const BlockCard& card = deck.blocks[std::size_t(positionOf(deck.blocks, block.name))];
    const MaterialCard& material =
        deck.materials[std::size_t(positionOf(deck.materials, card.material))];
    for (const std::string& name : historyNames(materialOf(material)))
      if (name != "equivalent_plastic_strain" &&
          std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
  }
  return names;
}
} // namespace

void addObservers(MultiObserver& observers, const Deck& deck, const MeshSlice& mesh,
                  const Comm& comm, const RunSettings& settings)
{
  const auto lastTime = [&](const char* output)
  {
    const auto found = settings.positions.find(output);
    // What was not written before begins with the restart, but not with a line of its own.
    return found != settings.positions.end() ? found->second : settings.part > 1 ? "-1 0 " : "";
  };
  const OutputTimes when{deck.output.every, deck.output.times};

  const std::string run = identityOf(deck, mesh, comm);

  RunRecordOptions record;
  record.run = run;
  record.file = recordFile(deck, settings.part);
  record.restartedFrom = settings.restartedFrom;
  record.title = deck.title;
  record.commandLine = settings.command;
  record.deckFile = deck.file;
  record.deckText = deck.text;
  record.meshFile = deck.mesh;
  observers.add(std::make_unique<RunRecord>(comm, record));

  HistoryOptions history;
  history.file = deck.history.file;
  history.every = deck.history.every;
  history.position = lastTime("history");
  for (const ProbeCard& card : deck.history.probes)
  {
    Probe probe;
    probe.name = card.name;
    probe.nodeSet = positionOf(mesh.mine.nodeSets, card.nodeSet);
    probe.block = positionOf(mesh.mine.blocks, card.block);
    history.probes.push_back(probe);
  }
  for (const JointCard& card : deck.joints)
    if (std::any_of(deck.history.joints.begin(), deck.history.joints.end(),
                    [&](const std::string& name) { return name == "*" || name == card.name; }))
      history.joints.push_back(card.name);
  for (std::size_t b = 0; b < mesh.mine.blocks.size(); ++b)
    for (const std::string& name : deck.history.rigid)
    {
      const BlockCard& card =
          deck.blocks[std::size_t(positionOf(deck.blocks, mesh.mine.blocks[b].name))];
      if (card.rigid && (name == "*" || name == card.name))
      {
        history.rigidBlocks.push_back(int(b));
        break;
      }
    }
  observers.add(std::make_unique<HistoryObserver>(comm, history));

  const auto wants = [&](const char* table)
  {
    const auto& tables = deck.history.tables;
    return std::find(tables.begin(), tables.end(), table) != tables.end();
  };
  if (!deck.history.tables.empty())
    observers.add(std::make_unique<TablesObserver>(
        comm, TablesOptions{tablesBase(deck), deck.history.every, wants("blocks"), wants("pairs"),
                            wants("materials"), settings.positions}));

  if (!deck.output.results.empty())
  {
    ResultsOptions results;
    results.file = deck.output.results;
    results.when = when;
    results.filePerRank = deck.output.filePerRank;
    results.history = historyVariables(deck, mesh);
    results.infoLines = linesOf(deck.text);
    results.infoLines.insert(results.infoLines.begin(), settings.command);
    results.run = run;
    results.part = settings.part;
    results.position = lastTime("results");
    observers.add(std::make_unique<ResultsObserver>(comm, mesh, results));
    if (deck.output.planes && deck.contact.enabled)
      observers.add(std::make_unique<PlanesObserver>(
          comm, PlanesOptions{planesBase(deck), when, lastTime("planes"), run}));
  }
  observers.add(std::make_unique<ProgressObserver>());

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
  checkpoint.begin = settings.begin;
  observers.add(std::make_unique<CheckpointObserver>(comm, checkpoint, observers));
}
} // namespace coplane
