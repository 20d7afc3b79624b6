#include "Restart.hpp"

#include <coplane_core/Log.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_input/DeckFingerprint.hpp>

#include <cstdlib>
#include <map>
#include <sstream>

namespace coplane
{
namespace
{
/// A hash of values in their order.
class OrderedHash
{
public:
  void add(std::uint64_t bits) { hash_ = mix(hash_ ^ bits); }
  void add(Real value)
  {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  void add(const std::string& text)
  {
    add(std::uint64_t(text.size()));
    for (const char c : text)
      add(std::uint64_t(static_cast<unsigned char>(c)));
  }
  template <class T>
  void add(const std::vector<T>& values)
  {
    add(std::uint64_t(values.size()));
    for (const T& value : values)
      add(std::uint64_t(value));
  }
  std::string text() const { return fmt::format("{:016x}", hash_); }

private:
  std::uint64_t hash_ = 0;
};

/// A line for each part of the mesh, in words that a message can use.
std::string meshFingerprint(const Mesh& mesh)
{
  std::string text =
      fmt::format("numbers of nodes and elements = {} and {}\n", mesh.nodes(), mesh.elements());
  OrderedHash nodes;
  nodes.add(mesh.nodeIds);
  text += fmt::format("ids of nodes = {}\n", nodes.text());
  OrderedHash places;
  for (const Vec3& x : mesh.coordinates)
    for (int c = 0; c < 3; ++c)
      places.add(x[c]);
  text += fmt::format("coordinates = {}\n", places.text());
  for (const Mesh::Block& block : mesh.blocks)
  {
    OrderedHash hash;
    hash.add(std::uint64_t(block.id));
    hash.add(std::uint64_t(block.type));
    hash.add(block.elementIds);
    hash.add(block.connectivity);
    text += fmt::format("block '{}' = {}\n", block.name, hash.text());
  }
  for (const Mesh::NodeSet& set : mesh.nodeSets)
  {
    OrderedHash hash;
    hash.add(set.nodes);
    text += fmt::format("node set '{}' = {}\n", set.name, hash.text());
  }
  for (const Mesh::SideSet& set : mesh.sideSets)
  {
    OrderedHash hash;
    hash.add(set.elements);
    hash.add(set.sides);
    text += fmt::format("side set '{}' = {}\n", set.name, hash.text());
  }
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

std::vector<std::pair<std::string, std::string>> fingerprintsOf(const Deck& deck, const Mesh& mesh,
                                                                int part)
{
  return {{"mesh", meshFingerprint(mesh)},
          {"deck", deckFingerprint(deck.text, deck.file)},
          {"part", std::to_string(part)}};
}

void demandSameRun(const CheckpointReader& checkpoint, const Deck& deck, const Mesh& mesh)
{
  const auto texts = meshDifferences(checkpoint.text("mesh"), meshFingerprint(mesh));
  if (!texts.empty())
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: the mesh {} is not that of the checkpoint: {}. Restart with the mesh of "
                   "then, or start without --restart.",
                   checkpoint.file(), deck.mesh, fmt::join(texts, "; "));
  const auto changes =
      deckDifferences(checkpoint.text("deck"), deckFingerprint(deck.text, deck.file));
  if (!changes.empty())
    failOnAllRanks(
        ExitCode::Checkpoint,
        "{}: the deck {} is not that of the checkpoint: {}. What may change at a restart "
        "are title, mesh (its path), time.end, time.energy_tolerance, "
        "time.contact_gain_tolerance, output, history.every, history.file, history.tables, "
        "checkpoint and partition. Restart "
        "with the deck of then, or start without --restart.",
        checkpoint.file(), deck.file, fmt::join(changes, "; "));
  if (checkpoint.head().program != version().number)
    logWarning("version",
               fmt::format("{} was written by coplane {}; this is {}: the bits of the "
                           "rest of the run may be others",
                           checkpoint.file(), checkpoint.head().program, version().number));
}

int partIn(const CheckpointReader& checkpoint)
{
  return std::atoi(checkpoint.text("part").c_str());
}
} // namespace coplane
