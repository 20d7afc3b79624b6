#include "Observers.hpp"

#include <coplane_input/MaterialCards.hpp>
#include <coplane_output/HistoryObserver.hpp>
#include <coplane_output/PlanesObserver.hpp>
#include <coplane_output/ProgressObserver.hpp>
#include <coplane_output/ResultsObserver.hpp>
#include <coplane_output/RunRecord.hpp>
#include <coplane_output/TablesObserver.hpp>

#include <algorithm>
#include <filesystem>
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
std::vector<std::string> historyVariables(const Deck& deck, const Mesh& mesh)
{
  std::vector<std::string> names;
  for (const Mesh::Block& block : mesh.blocks)
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

std::string withoutExtension(const std::string& file)
{
  return std::filesystem::path(file).replace_extension().string();
}
} // namespace

MultiObserver observersOf(const Deck& deck, const Mesh& mesh, const Comm& comm,
                          const std::string& command)
{
  MultiObserver observers;
  const OutputTimes when{deck.output.every, deck.output.times};

  RunRecordOptions record;
  record.file = withoutExtension(deck.history.file) + ".run.json";
  record.title = deck.title;
  record.commandLine = command;
  record.deckFile = deck.file;
  record.deckText = deck.text;
  record.meshFile = deck.mesh;
  observers.add(std::make_unique<RunRecord>(comm, record));

  HistoryOptions history;
  history.file = deck.history.file;
  history.every = deck.history.every;
  for (const ProbeCard& card : deck.history.probes)
  {
    Probe probe;
    probe.name = card.name;
    probe.nodeSet = positionOf(mesh.nodeSets, card.nodeSet);
    probe.block = positionOf(mesh.blocks, card.block);
    history.probes.push_back(probe);
  }
  for (const JointCard& card : deck.joints)
    if (std::any_of(deck.history.joints.begin(), deck.history.joints.end(),
                    [&](const std::string& name) { return name == "*" || name == card.name; }))
      history.joints.push_back(card.name);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    for (const std::string& name : deck.history.rigid)
    {
      const BlockCard& card =
          deck.blocks[std::size_t(positionOf(deck.blocks, mesh.blocks[b].name))];
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
        comm, TablesOptions{withoutExtension(deck.history.file), deck.history.every,
                            wants("blocks"), wants("pairs"), wants("materials")}));

  if (!deck.output.results.empty())
  {
    ResultsOptions results;
    results.file = deck.output.results;
    results.when = when;
    results.filePerRank = deck.output.filePerRank;
    results.history = historyVariables(deck, mesh);
    results.infoLines = linesOf(deck.text);
    results.infoLines.insert(results.infoLines.begin(), command);
    observers.add(std::make_unique<ResultsObserver>(comm, mesh, results));
    if (deck.output.planes && deck.contact.enabled)
      observers.add(std::make_unique<PlanesObserver>(
          comm, PlanesOptions{withoutExtension(deck.output.results), when}));
  }
  observers.add(std::make_unique<ProgressObserver>());
  return observers;
}
} // namespace coplane
