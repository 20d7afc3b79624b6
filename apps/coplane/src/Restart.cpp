#include "Restart.hpp"

#include <coplane_core/Log.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_input/DeckFingerprint.hpp>
#include <coplane_output/Sha256.hpp>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

namespace coplane
{
namespace
{
/// A line for each part of the mesh, in words that a message can use. Every value is hashed with
/// its place in the file, and the hashes are summed: that is the same for any number of ranks.
std::string meshFingerprint(const MeshSlice& slice, const Comm& comm)
{
  const Mesh& mesh = slice.mine;
  std::vector<std::string> names;
  std::vector<std::uint64_t> hashes;
  const auto close = [&](const std::string& name, const StateHash& hash)
  {
    names.push_back(name);
    hashes.push_back(hash.part());
  };
  const auto add = [](StateHash& hash, int what, int first, int perItem, const auto& values)
  {
    for (std::size_t i = 0; i < values.size(); ++i)
      hash.add(std::uint64_t(what), first + GlobalId(i) / perItem, i % std::size_t(perItem),
               std::uint64_t(values[i]));
  };
  const int firstNode = slice.nodeRange().first;
  StateHash ids, places;
  add(ids, 0, firstNode, 1, mesh.nodeIds);
  close("ids of nodes", ids);
  for (int n = 0; n < mesh.nodes(); ++n)
    for (int c = 0; c < 3; ++c)
      places.add(0, firstNode + n, std::uint64_t(c), mesh.coordinates[n][c]);
  close("coordinates", places);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const Mesh::Block& block = mesh.blocks[b];
    const int first = slice.elementRange(int(b)).first;
    StateHash hash;
    if (slice.rank == 0)
      hash.add(0, block.id, 0, std::uint64_t(block.type));
    add(hash, 1, first, 1, block.elementIds);
    add(hash, 2, first, topology(block.type).nodes, block.connectivity);
    close(fmt::format("block '{}'", block.name), hash);
  }
  for (std::size_t s = 0; s < mesh.nodeSets.size(); ++s)
  {
    StateHash hash;
    add(hash, 0, slice.rangeOf(slice.nodeSetSizes[s]).first, 1, mesh.nodeSets[s].nodes);
    close(fmt::format("node set '{}'", mesh.nodeSets[s].name), hash);
  }
  for (std::size_t s = 0; s < mesh.sideSets.size(); ++s)
  {
    const int first = slice.rangeOf(slice.sideSetSizes[s]).first;
    StateHash hash;
    add(hash, 0, first, 1, mesh.sideSets[s].elements);
    add(hash, 1, first, 1, mesh.sideSets[s].sides);
    close(fmt::format("side set '{}'", mesh.sideSets[s].name), hash);
  }
  comm.sum(hashes);
  std::string text =
      fmt::format("numbers of nodes and elements = {} and {}\n", slice.nodes, slice.elements());
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format("{} = {:016x}\n", names[i], hashes[i]);
  return text;
}

/// Hashes tell nobody anything: names of the parts that differ.
std::vector<std::string> meshDifferences(const std::string& before, const std::string& now)
{
  const auto linesOf = [](const std::string& text)
  {
    std::map<std::string, std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
      if (const std::size_t equals = line.rfind(" = "); equals != std::string::npos)
        lines[line.substr(0, equals)] = line.substr(equals + 3);
    return lines;
  };
  const auto old = linesOf(before), present = linesOf(now);
  std::vector<std::string> texts;
  for (const auto& [what, value] : old)
  {
    const auto found = present.find(what);
    if (found == present.end())
      texts.push_back(what + " is not there now");
    else if (found->second != value)
      texts.push_back(what.rfind("numbers", 0) == 0
                          ? fmt::format("{} were {} and are {} now", what, value, found->second)
                          : what + " changed");
  }
  for (const auto& [what, value] : present)
    if (old.find(what) == old.end())
      texts.push_back(what + " was not there");
  return texts;
}
} // namespace

std::vector<std::pair<std::string, std::string>>
fingerprintsOf(const Deck& deck, const MeshSlice& mesh, int part, const Comm& comm)
{
  return {{"mesh", meshFingerprint(mesh, comm)},
          {"deck", deckFingerprint(deck.text, deck.file)},
          {"part", std::to_string(part)}};
}

namespace
{
std::string identity(const std::string& mesh, const std::string& deck)
{
  return sha256(mesh + deck).substr(0, 16);
}
} // namespace

std::string identityIn(const CheckpointReader& checkpoint)
{
  if (checkpoint.has("identity")) // the deck may have changed at a restart
    return checkpoint.text("identity");
  return identity(checkpoint.text("mesh"), checkpoint.text("deck"));
}

std::string identityOf(const Deck& deck, const MeshSlice& mesh, const Comm& comm)
{
  return identity(meshFingerprint(mesh, comm), deckFingerprint(deck.text, deck.file));
}

namespace
{
/// A few of them, and how many more there are.
std::vector<std::string> firstOf(std::vector<std::string> texts)
{
  constexpr std::size_t most = 10;
  if (texts.size() <= most)
    return texts;
  const std::size_t rest = texts.size() - most;
  texts.resize(most);
  texts.push_back(fmt::format("{} more", rest));
  return texts;
}
} // namespace

void demandSameRun(const CheckpointReader& checkpoint, const Deck& deck, const MeshSlice& mesh,
                   const Comm& comm)
{
  const auto texts = meshDifferences(checkpoint.text("mesh"), meshFingerprint(mesh, comm));
  if (!texts.empty())
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: the mesh {} is not that of the checkpoint: {}. Restart with the mesh that "
                   "the checkpoint was written with, or start without --restart.",
                   checkpoint.file(), deck.mesh, fmt::join(texts, "; "));
  const int stage = Solver::stageIn(checkpoint).index;
  const DeckChanges changes =
      deckChanges(checkpoint.text("deck"), deckFingerprint(deck.text, deck.file), stage);
  if (!changes.refused.empty())
    failOnAllRanks(
        ExitCode::Checkpoint,
        "{}: the deck {} is not that of the checkpoint: {}. What may change at a restart "
        "are title, mesh (its path), time.end, time.end_at_rest, time.energy_tolerance, "
        "time.contact_gain_tolerance, contact.lost_contact, output, history.every, history.file, "
        "history.tables, "
        "checkpoint and partition, and what a stage may change, beside stages to come. {} Restart "
        "with the deck that the checkpoint was written with, or start without --restart.",
        checkpoint.file(), deck.file, fmt::join(firstOf(changes.refused), "; "),
        whatStagesMayChange());
  if (stage >= std::max(1, int(deck.stages.size())))
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: the checkpoint is of stage {} (the first is 0), and the deck {} has {}. "
                   "Restart with the deck that the checkpoint was written with.",
                   checkpoint.file(), stage, deck.file, deck.stages.size());
  if (!changes.allowed.empty())
    logWarning("another deck",
               fmt::format("{}: the run goes on with another deck than it had: {}",
                           checkpoint.file(), fmt::join(firstOf(changes.allowed), "; ")));
  if (checkpoint.head().program != version().number)
    logWarning("version",
               fmt::format("{} was written by coplane {}; this is {}: the results from here "
                           "on may differ in the last digits",
                           checkpoint.file(), checkpoint.head().program, version().number));
}

bool isOfRun(const CheckpointReader& checkpoint, const Deck& deck, const MeshSlice& mesh,
             const Comm& comm)
{
  return meshDifferences(checkpoint.text("mesh"), meshFingerprint(mesh, comm)).empty() &&
         deckChanges(checkpoint.text("deck"), deckFingerprint(deck.text, deck.file),
                     Solver::stageIn(checkpoint).index)
             .refused.empty();
}

int partIn(const CheckpointReader& checkpoint)
{
  return std::atoi(checkpoint.text("part").c_str());
}
} // namespace coplane
