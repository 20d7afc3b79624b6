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
  const auto child = [](DeckNode& node, const std::string& key) -> DeckNode*
  {
    for (auto& [name, value] : node.entries)
      if (name.text == key)
        return &value;
    return nullptr;
  };
  const auto add = [&](DeckNode& card, const DeckNode& set, const DeckNode& place)
  {
    for (auto [name, value] : set.entries)
    {
      if (card.find(name.text))
        continue;
      // Messages about a value of the set stand where the set is named.
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
  };
  if (root.kind != DeckNode::Kind::Map)
    return;
  if (DeckNode* materials = child(root, "materials"))
    for (auto& [name, card] : materials->entries)
      if (const DeckNode* set = card.find("set"))
        if (const DeckNode* found = library.find(set->text))
          add(card, *found, DeckNode(*set));
  // Copies, because the tree grows.
  std::vector<DeckNode> named;
  for (const char* group : {"blocks", "material_paths"})
    if (const DeckNode* cards = root.find(group))
      for (const auto& [name, card] : cards->entries)
        if (const DeckNode* material = card.find("material"))
          named.push_back(*material);
  for (const DeckNode& place : named)
  {
    const DeckNode* const found = library.find(place.text);
    if (!found)
      continue;
    DeckNode* materials = child(root, "materials");
    if (!materials)
    {
      DeckNode key = place, map = place;
      key.text = "materials";
      map.text.clear();
      map.kind = DeckNode::Kind::Map;
      root.entries.emplace_back(key, map);
      materials = child(root, "materials");
    }
    if (materials->kind != DeckNode::Kind::Map)
      continue;
    if (DeckNode* const card = child(*materials, place.text))
    {
      // Such as made by --set materials.concrete_c40.fracture_energy=100.
      if (card->kind == DeckNode::Kind::Map && !card->find("model") && !card->find("set"))
        add(*card, *found, place);
      continue;
    }
    DeckNode card = place;
    card.text.clear();
    card.kind = DeckNode::Kind::Map;
    add(card, *found, place);
    materials->entries.emplace_back(place, card);
  }
}
} // namespace coplane
