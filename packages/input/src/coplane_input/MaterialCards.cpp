#include "MaterialCards.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_material/MaterialModel.hpp>
#include <coplane_schema/SchemaBuilder.hpp>

namespace coplane
{
using namespace schema;

namespace
{
const MaterialModel& modelOf(const MaterialCard& card)
{
  return *findModel(materialModels(), card.model);
}
} // namespace

std::vector<Key> materialCardKeys()
{
  std::vector<Key> keys =
      keysOfModels<MaterialCard>(materialModels(), "law of the continuum", "j2");
  keys[0] = KeyBuilder(keys[0]).needed();
  keys.insert(keys.begin() + 1,
              text("set", &MaterialCard::set)
                  .oneOf(materialSetNames())
                  .like("concrete_c40")
                  .defaultIs("none")
                  .means("set of the library, from which all keys come that are not given here, "
                         "the model too"));
  return keys;
}

Key materialKeys()
{
  return named("materials", &Deck::materials, materialCardKeys())
      .decidedBy("model")
      .completedBy("set")
      .absent("bulk_modulus", "From bulk modulus K and shear modulus G: youngs_modulus = "
                              "9 K G / (3 K + G), poisson_ratio = (3 K - 2 G) / (6 K + 2 G).")
      .absent("shear_modulus", "From Young's modulus E and shear modulus G: poisson_ratio = "
                               "E / (2 G) - 1; from bulk modulus K and G: youngs_modulus = "
                               "9 K G / (3 K + G), poisson_ratio = (3 K - 2 G) / (6 K + 2 G).")
      .means("laws of the continuum, by a name of your choice; blocks may name sets of the library "
             "without a card here");
}

Material materialOf(const MaterialCard& card)
{
  return modelOf(card).law(card.parameters.get());
}

void checkMaterials(const std::vector<MaterialCard>& materials, const DeckNode& root,
                    Problems& problems)
{
  for (const MaterialCard& card : materials)
  {
    if (card.model.empty())
      continue; // reported where it was read
    const DeckNode& node = nodeAt(root, {"materials", card.name});
    const std::string path = "materials." + card.name;
    const std::size_t before = problems.size();
    if (modelOf(card).check)
      modelOf(card).check(card.parameters.get(), {node, path, problems});
    if (before > 0 || problems.size() > before)
      continue; // a law is only made of values that were accepted
    try
    {
      materialOf(card);
    }
    catch (const Error& error)
    {
      std::string text = error.what();
      if (text.rfind("material: ", 0) == 0)
        text = text.substr(10);
      problems.add(node, path + ": " + text);
    }
  }
}

std::string problemInTheFlat(const MaterialCard& card, bool revolved)
{
  const MaterialModel& model = modelOf(card);
  return model.problemInTheFlat ? model.problemInTheFlat(card.parameters.get(), revolved) : "";
}

SofteningLimit softeningLimit(const MaterialCard& card)
{
  const MaterialModel& model = modelOf(card);
  return model.softening ? model.softening(card.parameters.get()) : SofteningLimit{};
}
} // namespace coplane
