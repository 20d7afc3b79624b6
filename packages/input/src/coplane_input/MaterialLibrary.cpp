#include "MaterialCards.hpp"

#include <coplane_material/MaterialModel.hpp>

namespace coplane
{
namespace
{
/// Cards as a deck would have them; sources are in docs/user/materials.md.
DeckNode libraryOfSets()
{
  std::string sets;
  for (const MaterialModel& model : materialModels())
    sets += model.sets;
  return parseYaml(sets, "library of materials");
}

/// The keys of a set that a card does not give. Messages about their values stand where the set is
/// named.
void addSet(DeckNode& card, const DeckNode& set, const DeckNode& place)
{
  for (auto [name, value] : set.entries)
  {
    if (card.find(name.text))
      continue;
    for (DeckNode* node : {&name, &value})
    {
      node->where = place.where;
      node->order = place.order;
      for (DeckNode& item : node->items)
      {
        item.where = place.where;
        item.order = place.order;
      }
    }
    card.entries.emplace_back(name, value);
  }
}

/// The cards of materials, made for what asks for one at a place.
DeckNode& materialsOf(DeckNode& root, const DeckNode& place)
{
  if (DeckNode* const materials = root.find("materials"))
    return *materials;
  DeckNode key = place, map = place;
  key.text = "materials";
  map.text.clear();
  map.kind = DeckNode::Kind::Map;
  root.entries.emplace_back(key, map);
  return root.entries.back().second;
}

/// The card of a set that is named in place of a card.
void insertNamed(DeckNode& root, const DeckNode& set, const DeckNode& place)
{
  DeckNode& materials = materialsOf(root, place);
  if (materials.kind != DeckNode::Kind::Map)
    return;
  if (DeckNode* const card = materials.find(place.text))
  {
    // Such as made by --set materials.concrete_c40.fracture_energy=100.
    if (card->kind == DeckNode::Kind::Map && !card->find("model") && !card->find("set"))
      addSet(*card, set, place);
    return;
  }
  DeckNode card = place;
  card.text.clear();
  card.kind = DeckNode::Kind::Map;
  addSet(card, set, place);
  materials.entries.emplace_back(place, card);
}
} // namespace

std::vector<std::string> materialSetNames()
{
  const DeckNode library = libraryOfSets();
  std::vector<std::string> names;
  for (const auto& [name, card] : library.entries)
    names.push_back(name.text);
  return names;
}

void insertMaterialSets(DeckNode& root)
{
  const DeckNode library = libraryOfSets();
  if (root.kind != DeckNode::Kind::Map)
    return;
  if (DeckNode* materials = root.find("materials"))
    for (auto& [name, card] : materials->entries)
      if (const DeckNode* set = card.find("set"))
        if (const DeckNode* found = library.find(set->text))
          addSet(card, *found, DeckNode(*set));
  // Copies, because the tree grows.
  std::vector<DeckNode> named;
  for (const char* group : {"blocks", "material_paths"})
    if (const DeckNode* cards = root.find(group))
      for (const auto& [name, card] : cards->entries)
        if (const DeckNode* material = card.find("material"))
          named.push_back(*material);
  for (const DeckNode& place : named)
    if (const DeckNode* const found = library.find(place.text))
      insertNamed(root, *found, place);
}
} // namespace coplane
