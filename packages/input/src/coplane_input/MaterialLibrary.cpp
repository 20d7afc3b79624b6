#include "MaterialCards.hpp"

namespace coplane
{
// Sources are in docs/user/materials.md.
const char* materialLibrary()
{
  return R"(
steel_generic: {model: j2, density: 7850, youngs_modulus: 200e9, poisson_ratio: 0.3,
                yield_stress: 1e9, hardening_modulus: 1e9}
steel_4340: {model: johnson_cook, density: 7830, youngs_modulus: 201e9, poisson_ratio: 0.3,
             yield_stress: 792e6, hardening_modulus: 510e6, hardening_exponent: 0.26,
             rate_factor: 0.014, thermal_exponent: 1.03, melting_temperature: 1793,
             heat_capacity: 477, fracture: [0.05, 3.44, -2.12, 0.002, 0.61],
             eos: mie_grueneisen, sound_speed: 4570, shock_slope: 1.49, grueneisen: 1.93}
copper_ofhc: {model: johnson_cook, density: 8960, youngs_modulus: 124e9, poisson_ratio: 0.34,
              yield_stress: 90e6, hardening_modulus: 292e6, hardening_exponent: 0.31,
              rate_factor: 0.025, thermal_exponent: 1.09, melting_temperature: 1356,
              heat_capacity: 383, fracture: [0.54, 4.89, -3.03, 0.014, 1.12],
              eos: mie_grueneisen, sound_speed: 3940, shock_slope: 1.489, grueneisen: 2.02}
iron_armco: {model: johnson_cook, density: 7890, youngs_modulus: 207e9, poisson_ratio: 0.29,
             yield_stress: 175e6, hardening_modulus: 380e6, hardening_exponent: 0.32,
             rate_factor: 0.06, thermal_exponent: 0.55, melting_temperature: 1811,
             heat_capacity: 452, fracture: [-2.2, 5.43, -0.47, 0.016, 0.63],
             eos: mie_grueneisen, sound_speed: 4570, shock_slope: 1.49, grueneisen: 1.93}
concrete_c40: {model: pseudo_cap, density: 2300, youngs_modulus: 33e9, poisson_ratio: 0.2,
               compressive_strength: 40e6, tensile_strength: 4e6, fracture_energy: 120,
               porosity: 0.08, grain_modulus: 40e9, grain_slope: 1.5, crush_pressure: 80e6,
               crush_hardening: 300e6, cap_ratio: 0.5, shear_compaction: 2}
concrete_hjc_48: {model: hjc, density: 2440, shear_modulus: 14.86e9, compressive_strength: 48e6,
                  cohesive_factor: 0.79, pressure_factor: 1.6, pressure_exponent: 0.61,
                  rate_factor: 0.007, largest_strength: 7, tensile_strength: 4e6,
                  least_fracture_strain: 0.01, damage_factor: 0.04, damage_exponent: 1,
                  crush_pressure: 16e6, crush_compression: 0.001, lock_pressure: 800e6,
                  lock_compression: 0.1, lock_moduli: [85e9, -171e9, 208e9]}
granite: {model: linear_elastic, density: 2650, youngs_modulus: 60e9, poisson_ratio: 0.25}
clay_brick: {model: mohr_coulomb, density: 1800, youngs_modulus: 10e9, poisson_ratio: 0.15,
             cohesion: 4.66e6, friction: 0.84, dilation: 0.18, tensile_strength: 2e6,
             fracture_energy: 60, shear_energy: 600}
)";
}

std::vector<std::string> materialSetNames()
{
  const DeckNode library = parseYaml(materialLibrary(), "library of materials");
  std::vector<std::string> names;
  for (const auto& [name, card] : library.entries)
    names.push_back(name.text);
  return names;
}

void insertMaterialSets(DeckNode& root)
{
  const DeckNode library = parseYaml(materialLibrary(), "library of materials");
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
