#include "MeshChecks.hpp"

#include "detail/Names.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace coplane
{
std::vector<std::string> problemsOfDimension(const Deck& deck, int dimension)
{
  std::vector<std::string> messages;
  const auto demand = [&](bool good, const std::string& where, const std::string& what)
  {
    if (!good)
      messages.push_back(fmt::format(
          "{}: {} has no effect: the mesh has two dimensions. Accepted: 0.", where, what));
  };
  const auto nothing = [](const TimeFunction& function)
  {
    return function.expression.empty() && function.constant == 0 &&
           std::all_of(function.values.begin(), function.values.end(),
                       [](Real value) { return value == 0; });
  };
  for (const LineCard& card : deck.lines)
  {
    const bool fits = std::all_of(card.points.begin(), card.points.end(),
                                  [&](const auto& point)
                                  {
                                    return int(point.size()) == dimension ||
                                           (dimension == 2 && point.size() == 3 && point[2] == 0);
                                  });
    if (!fits)
      messages.push_back(fmt::format("{}: lines.{}.points: the mesh has {} dimensions; accepted: "
                                     "{} numbers for each point.",
                                     card.where, card.name, dimension, dimension));
    if (dimension == 3 && card.spacing != 1)
      messages.push_back(fmt::format("{}: lines.{}.spacing has no effect: the mesh has three "
                                     "dimensions. Use copies and copy_step for a row.",
                                     card.where, card.name));
  }
  if (dimension == 3)
    return messages;
  for (std::size_t p = 0; p < deck.history.probes.size(); ++p)
    for (const auto& point : {deck.history.probes[p].point, deck.history.probes[p].plane})
      demand(!point || point->z == 0, deck.history.probes[p].where,
             fmt::format("z of a point of history.probes.{}", p));
  demand(nothing(deck.gravity[2]),
         deck.gravity[2].where.empty() ? deck.file : deck.gravity[2].where, "gravity along z");
  for (const InitialCard& card : deck.initial)
  {
    demand(card.velocity.z == 0, card.where, "an initial velocity along z");
    demand(card.angularVelocity.x == 0 && card.angularVelocity.y == 0, card.where,
           "an initial angular_velocity about x or y");
  }
  if (deck.geometry == "axisymmetric")
  {
    const auto refuse = [&](bool bad, const std::string& where, const std::string& what)
    {
      if (bad)
        messages.push_back(fmt::format("{}: {} does not go with geometry = 'axisymmetric': x is "
                                       "the distance from the axis, and y runs along it. "
                                       "Accepted: 0.",
                                       where, what));
    };
    refuse(!nothing(deck.gravity[0]),
           deck.gravity[0].where.empty() ? deck.file : deck.gravity[0].where, "gravity along x");
    for (const InitialCard& card : deck.initial)
      refuse(card.angularVelocity.z != 0, card.where, "an initial angular_velocity about z");
  }
  for (const ConditionCard& card : deck.conditions)
  {
    demand(card.normal.z == 0, card.where, "the normal of a symmetry along z");
    demand(nothing(card.traction[2]), card.where, "a traction along z");
    demand(nothing(card.velocity[2]), card.where, "a velocity along z");
    demand(nothing(card.displacement[2]), card.where, "a displacement along z");
    demand(nothing(card.acceleration[2]), card.where, "an acceleration along z");
    if (const auto& axes = card.components; axes[2] && !axes[0] && !axes[1])
      messages.push_back(fmt::format("{}: components: [z] holds nothing: the mesh has two "
                                     "dimensions. Accepted: x, y or both.",
                                     card.where));
  }
  return messages;
}

namespace
{
/// Names of a mesh, and what is wrong with those that a deck says.
class NamesOfMesh
{
public:
  NamesOfMesh(const Names& blocks, const Names& nodeSets, const Names& sideSets)
      : blocks_{"an element block", blocks}, nodeSets_{"a node set", nodeSets}, sideSets_{
                                                                                    "a side set",
                                                                                    sideSets}
  {
  }

  // @param where the card is; path of the key; name that it says, empty: none
  void block(const std::string& where, const std::string& path, const std::string& name)
  {
    demand(blocks_, where, path, name);
  }
  void nodeSet(const std::string& where, const std::string& path, const std::string& name)
  {
    demand(nodeSets_, where, path, name);
  }
  void sideSet(const std::string& where, const std::string& path, const std::string& name)
  {
    demand(sideSets_, where, path, name);
  }
  /// Every block of the mesh has a card.
  void allHaveCards(const Deck& deck);
  const std::vector<std::string>& messages() const { return messages_; }

private:
  struct Kind
  {
    std::string what;
    const Names& names;
  };

  void demand(const Kind& kind, const std::string& where, const std::string& path,
              const std::string& name)
  {
    if (!name.empty() && !contains(kind.names, name))
      messages_.push_back(where + ": " +
                          unknown(path, name, kind.what + " of the mesh", kind.names) + hint(name));
  }
  /// What a name is instead.
  std::string hint(const std::string& name) const
  {
    for (const Kind* kind : {&blocks_, &nodeSets_, &sideSets_})
      if (contains(kind->names, name))
        return fmt::format(" '{}' is {}.", name, kind->what);
    return name.find_first_not_of("0123456789") == std::string::npos
               ? " Names are wanted, not numbers: coplane_mesh check MESH lists both."
               : "";
  }

  Kind blocks_, nodeSets_, sideSets_;
  std::vector<std::string> messages_;
};

void NamesOfMesh::allHaveCards(const Deck& deck)
{
  const Names cards = namesOf(deck.blocks);
  for (const auto& name : blocks_.names)
    if (!contains(cards, name))
      messages_.push_back(
          fmt::format("{}: blocks has no card for the element block '{}' of the "
                      "mesh; add '{}: {{material: ...}}'.{}",
                      deck.blocksWhere, name, name,
                      didYouMean(name, cards).empty()
                          ? ""
                          : " The most similar card is '" + nearest(name, cards) + "'."));
}

void checkPairs(const Deck& deck, NamesOfMesh& mesh)
{
  for (std::size_t i = 0; i < deck.contact.pairs.size(); ++i)
  {
    const auto& pair = deck.contact.pairs[i];
    const std::string path = fmt::format("contact.pairs.{}", i);
    for (std::size_t k = 0; k < 2; ++k)
    {
      if (pair.blocks[k] != "*")
        mesh.block(pair.where, fmt::format("{}.blocks.{}", path, k), pair.blocks[k]);
      if (pair.sideSets[k] != "*")
        mesh.sideSet(pair.where, fmt::format("{}.side_sets.{}", path, k), pair.sideSets[k]);
    }
    mesh.sideSet(pair.where, path + ".joint_set", pair.jointSet);
  }
}

void checkConditions(const Deck& deck, NamesOfMesh& mesh)
{
  for (std::size_t i = 0; i < deck.conditions.size(); ++i)
  {
    const auto& card = deck.conditions[i];
    if (card.type == "rigid_motion")
      mesh.block(card.where, fmt::format("conditions.{}.block", i), card.set);
    else if (card.onSides())
      mesh.sideSet(card.where, fmt::format("conditions.{}.side_set", i), card.set);
    else
      mesh.nodeSet(card.where, fmt::format("conditions.{}.node_set", i), card.set);
  }
}
} // namespace

std::vector<std::string> checkNamesAgainstMesh(const Deck& deck, const Names& blockNames,
                                               const Names& nodeSetNames, const Names& sideSetNames)
{
  NamesOfMesh mesh(blockNames, nodeSetNames, sideSetNames);
  mesh.allHaveCards(deck);
  for (const auto& card : deck.blocks)
    mesh.block(card.where, "blocks", card.name);
  checkPairs(deck, mesh);
  checkConditions(deck, mesh);
  for (std::size_t i = 0; i < deck.initial.size(); ++i)
    mesh.block(deck.initial[i].where, fmt::format("initial.{}.block", i), deck.initial[i].block);
  for (std::size_t i = 0; i < deck.history.probes.size(); ++i)
  {
    const auto& probe = deck.history.probes[i];
    mesh.nodeSet(probe.where, fmt::format("history.probes.{}.node_set", i), probe.nodeSet);
    mesh.block(probe.where, fmt::format("history.probes.{}.block", i), probe.block);
  }
  return mesh.messages();
}
} // namespace coplane
