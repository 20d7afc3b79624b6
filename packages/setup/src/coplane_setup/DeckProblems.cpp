#include <coplane_input/MaterialCards.hpp>
#include <coplane_setup/DeckProblems.hpp>
#include <coplane_setup/Lookups.hpp>
#include <coplane_setup/detail/BlocksOfDeck.hpp>

#include <algorithm>

namespace coplane
{
std::vector<std::string> problemsOfLaws(const Deck& deck, int dimension)
{
  std::vector<std::string> problems;
  for (const BlockCard& card : deck.blocks)
  {
    const MaterialCard& material = materialCardOf(deck, card);
    if (const std::string problem =
            dimension == 2 ? problemInTheFlat(material, deck.geometry == "axisymmetric") : "";
        !problem.empty())
      problems.push_back(fmt::format("{}: blocks.{}: material '{}': {}.", card.where, card.name,
                                     material.name, problem));
    const std::vector<std::string> names = historyNames(materialOf(material));
    for (const std::string& wanted : erosionOf(card.erosion).variableNames())
      if (std::find(names.begin(), names.end(), wanted) == names.end())
        problems.push_back(fmt::format(
            "{}: blocks.{}.erosion asks for '{}', but material '{}' ({}) {}.", card.where,
            card.name, wanted, material.name, material.model,
            names.empty() ? std::string("has no variables; use volume_ratio or stable_step")
                          : fmt::format("has only {}", fmt::join(names, ", "))));
  }
  return problems;
}

namespace
{
std::vector<char> rigidBlocksOf(const Deck& deck, const Mesh& mesh)
{
  std::vector<char> rigid;
  for (const Mesh::Block& block : mesh.blocks)
  {
    const int card = indexOf(deck.blocks, block.name);
    rigid.push_back(card >= 0 && deck.blocks[card].rigid);
  }
  return rigid;
}

/// The lowest rigid block that has a side in a set, over all ranks; -1: none. Collective.
int rigidBlockBehind(const Mesh::SideSet& set, const std::vector<char>& rigid,
                     const MeshSlice& slice, const Comm& comm)
{
  std::int64_t block = std::int64_t(rigid.size());
  for (const int element : set.elements)
    if (const int other = slice.placeOf(element).first; rigid[other])
      block = std::min(block, std::int64_t(other));
  block = comm.min(block);
  return block < std::int64_t(rigid.size()) ? int(block) : -1;
}
} // namespace

std::vector<std::string> problemsOfRigidBlocks(const Deck& deck, const MeshSlice& slice,
                                               const Comm& comm)
{
  std::vector<std::string> problems;
  const Mesh& mesh = slice.mine;
  const std::vector<char> rigid = rigidBlocksOf(deck, mesh);
  for (const ConditionCard& card : deck.conditions)
    for (int c = 0; c < 2 && card.spin && mesh.dimension == 2; ++c)
      if (const TimeFunction& spin = (*card.spin)[c];
          spin.constant != 0 || !spin.expression.empty() || !spin.times.empty())
        problems.push_back(fmt::format(
            "{}: angular_velocity about {} of the rigid block '{}', but the mesh has two "
            "dimensions; accepted: 0 there, a spin about z.",
            card.where, "xy"[c], card.set));
  for (const ConditionCard& card : deck.conditions)
    if (const int set = card.type == "absorbing" || card.type == "free_field"
                            ? indexOf(mesh.sideSets, card.set)
                            : -1;
        set >= 0)
      if (const int block = rigidBlockBehind(mesh.sideSets[set], rigid, slice, comm); block >= 0)
        problems.push_back(
            fmt::format("{}: {} side set '{}' has a side of the rigid block '{}', through which no "
                        "waves run; take it out of the set, or remove rigid.",
                        card.where, card.type, card.set, mesh.blocks[block].name));
  return problems;
}
} // namespace coplane
