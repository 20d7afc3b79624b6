#include <coplane_input/ContactRoles.hpp>
#include <coplane_input/JointCards.hpp>
#include <coplane_setup/Lookups.hpp>
#include <coplane_setup/detail/ContactRulesOfDeck.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace coplane
{
namespace
{
/// A declared pair as messages name it.
std::string nameOf(const ContactPairCard& card, std::size_t item)
{
  const std::string sides =
      !card.jointSet.empty() ? "joint set " + card.jointSet
      : !card.sideSets[0].empty()
          ? fmt::format("side sets {} and {}", card.sideSets[0], card.sideSets[1])
      : !card.materials[0].empty()
          ? fmt::format("materials {} and {}", card.materials[0], card.materials[1])
          : fmt::format("blocks {} and {}", card.blocks[0], card.blocks[1]);
  return fmt::format("contact.pairs.{} ({})", item, sides);
}

/// What the rules of contact may ask of a face: its block, and the side sets that hold it.
struct FaceTraits
{
  int block = 0;
  std::vector<int> sets;
  bool operator<(const FaceTraits& other) const
  {
    return std::tie(block, sets) < std::tie(other.block, other.sets);
  }
};
using FacesOfSets = std::map<GlobalId, FaceTraits>; ///< by face id

/// The faces of this rank's elements in side sets that contact.pairs names.
FacesOfSets facesOfNamedSets(const Deck& deck, const Mesh& mesh, const RankMesh& part)
{
  std::set<std::string> named;
  for (const ContactPairCard& pair : deck.contact.pairs)
    named.insert({pair.sideSets[0], pair.sideSets[1], pair.jointSet});
  FacesOfSets faces;
  for (std::size_t s = 0; s < mesh.sideSets.size(); ++s)
    if (named.count(mesh.sideSets[s].name) > 0)
      for (const RankMesh::Side& side : part.sideSets[s])
      {
        FaceTraits& face =
            faces[faceId(part.blocks[side.block].elementIds[side.element], side.side)];
        face.block = side.block;
        face.sets.push_back(int(s));
      }
  return faces;
}

/// The traits that the faces of all ranks have, in the order of the lowest face id with each.
/// Collective.
std::vector<FaceTraits> kindsOfFaces(const FacesOfSets& faces, const Comm& comm)
{
  std::map<FaceTraits, GlobalId> lowest;
  for (const auto& [id, face] : faces)
    lowest.emplace(face, id);    // ids ascend
  std::vector<GlobalId> numbers; // face id, block, number of sets, sets
  for (const auto& [face, id] : lowest)
  {
    numbers.insert(numbers.end(), {id, face.block, GlobalId(face.sets.size())});
    numbers.insert(numbers.end(), face.sets.begin(), face.sets.end());
  }
  numbers = comm.allGather(numbers);
  for (auto next = numbers.begin(); next != numbers.end();)
  {
    const GlobalId id = *next++;
    FaceTraits face{int(*next++), {}};
    const auto end = next + 1 + *next;
    face.sets.assign(next + 1, end);
    next = end;
    const auto found = lowest.emplace(face, id).first;
    found->second = std::min(found->second, id);
  }
  std::vector<std::pair<GlobalId, FaceTraits>> order;
  for (const auto& [face, id] : lowest)
    order.emplace_back(id, face);
  std::sort(order.begin(), order.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<FaceTraits> kinds;
  for (const auto& [id, face] : order)
    kinds.push_back(face);
  return kinds;
}

/// The law of cards that name none, and those of all cards.
std::vector<JointRecipe> recipesOf(const Deck& deck)
{
  std::vector<JointRecipe> recipes(1);
  recipes[0].name = "penalty (built in)";
  for (const JointCard& card : deck.joints)
    recipes.push_back({card.name, jointLawOf(card)});
  return recipes;
}

int indexOfJoint(const std::vector<JointRecipe>& recipes, const std::string& name)
{
  const auto found = std::find_if(recipes.begin(), recipes.end(),
                                  [&](const JointRecipe& recipe) { return recipe.name == name; });
  return int(found - recipes.begin());
}

/// What the rules of contact may ask of the faces of each group: the blocks, then faces of named
/// side sets, whose groups go to the model. Collective.
std::vector<ContactTraits> groupsOf(const Deck& deck, const Mesh& mesh, const Comm& comm,
                                    Model& model)
{
  std::vector<ContactTraits> groups;
  for (const Mesh::Block& block : mesh.blocks)
    groups.push_back({block.name, cardOf(deck, block).material, {}});
  const FacesOfSets faces = facesOfNamedSets(deck, mesh, model.mesh);
  std::map<FaceTraits, int> groupOf;
  for (const FaceTraits& face : kindsOfFaces(faces, comm))
  {
    groupOf.emplace(face, int(groups.size()));
    ContactTraits traits = groups[face.block];
    for (const int set : face.sets)
      traits.sideSets.push_back(mesh.sideSets[set].name);
    groups.push_back(traits);
  }
  for (const auto& [id, face] : faces)
    model.faceGroups.emplace_back(id, groupOf.at(face));
  return groups;
}

/// Groups that rules do not tell apart are of one kind.
/// @returns a face of each kind
std::vector<const ContactTraits*>
findKinds(const ContactCard& contact, const std::vector<ContactTraits>& groups, ContactRules& rules)
{
  std::map<std::vector<bool>, int> kindWith;
  std::vector<const ContactTraits*> kinds;
  for (const ContactTraits& group : groups)
  {
    const auto [kind, isNew] = kindWith.emplace(contactRoles(contact, group), int(kinds.size()));
    if (isNew)
      kinds.push_back(&group);
    rules.kindOf.push_back(kind->second);
  }
  rules.kinds = int(kinds.size());
  return kinds;
}

ContactRule ruleOf(const ContactCard& contact, const ContactPairCard& card, ContactRule rule,
                   const std::vector<JointRecipe>& joints)
{
  if (!card.joint.empty())
    rule.joint = indexOfJoint(joints, card.joint);
  rule.declared = card.declared;
  rule.excluded = card.excluded;
  rule.item = int(&card - contact.pairs.data());
  return rule;
}

/// Items all of whose faces wait for blocks that a stage adds find no partner at the start.
void leaveOutItemsToCome(const std::vector<int>& absentBlocks, std::size_t blocks,
                         ContactRules& rules)
{
  const auto kinds = std::size_t(rules.kinds);
  std::vector<char> isHere(kinds, 0);
  for (std::size_t group = 0; group < rules.kindOf.size(); ++group)
    if (group >= blocks || std::count(absentBlocks.begin(), absentBlocks.end(), int(group)) == 0)
      isHere[std::size_t(rules.kindOf[group])] = 1;
  std::set<int> here, toCome;
  for (std::size_t a = 0; a < kinds; ++a)
    for (std::size_t b = 0; b < kinds; ++b)
      (isHere[a] && isHere[b] ? here : toCome).insert(rules.table[a * kinds + b].item);
  auto& items = rules.declaredItems;
  items.erase(std::remove_if(items.begin(), items.end(),
                             [&](const auto& item) {
                               return toCome.count(item.first) > 0 && here.count(item.first) == 0;
                             }),
              items.end());
}
} // namespace

void addContactRules(const Deck& deck, const Mesh& mesh, const Comm& comm, Model& model)
{
  const ContactCard& contact = deck.contact;
  ContactRules& rules = model.contactRules;
  rules.joints = recipesOf(deck);
  const std::vector<ContactTraits> groups = groupsOf(deck, mesh, comm, model);
  for (std::size_t i = 0; i < contact.pairs.size(); ++i)
    if (contact.pairs[i].declared)
      rules.declaredItems.emplace_back(int(i), nameOf(contact.pairs[i], i));

  const std::vector<const ContactTraits*> kinds = findKinds(contact, groups, rules);
  ContactRule general;
  general.joint =
      contact.defaultJoint.empty() ? 0 : indexOfJoint(rules.joints, contact.defaultJoint);
  rules.table.assign(kinds.size() * kinds.size(), general);
  for (std::size_t a = 0; a < kinds.size(); ++a)
    for (std::size_t b = 0; b < kinds.size(); ++b)
      if (const ContactPairCard* card = contactPairFor(contact, *kinds[a], *kinds[b]))
        rules.table[a * kinds.size() + b] = ruleOf(contact, *card, general, rules.joints);
  leaveOutItemsToCome(model.absentBlocks, mesh.blocks.size(), rules);
}
} // namespace coplane
