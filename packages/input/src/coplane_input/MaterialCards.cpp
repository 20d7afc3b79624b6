#include "MaterialCards.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_material/MaterialModel.hpp>
#include <coplane_schema/SchemaBuilder.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <tuple>

namespace coplane
{
using namespace schema;

namespace
{
bool sameTexts(const Key& a, const Key& b)
{
  const auto texts = [](const Key& key)
  {
    return std::tie(key.name, key.kind, key.unit, key.defaultText, key.meaning, key.example,
                    key.required, key.choices, key.lower, key.upper, key.lowerOpen, key.upperOpen,
                    key.length);
  };
  return texts(a) == texts(b);
}

const MaterialModel& modelOf(const MaterialCard& card)
{
  return *findMaterialModel(card.model);
}

/// The keys of all models, each once: what several models say alike is one key, which goes to the
/// parameters of the card's own model.
std::vector<Key> keysOfModels()
{
  using OfModel = std::map<std::string, Key>;
  std::vector<Key> keys;
  std::vector<std::shared_ptr<OfModel>> owners;
  for (const MaterialModel& model : materialModels())
    for (const Key& key : model.keys)
    {
      const auto same = std::find_if(keys.begin(), keys.end(),
                                     [&](const Key& one) { return sameTexts(one, key); });
      const auto at = std::size_t(same - keys.begin());
      if (same == keys.end())
      {
        const auto owner = std::make_shared<OfModel>();
        Key shared = key;
        shared.store = [owner](void* target, const KeyValue& value)
        {
          const auto& card = *static_cast<const MaterialCard*>(target);
          if (const auto own = owner->find(card.model); own != owner->end())
            own->second.store(card.parameters.get(), value);
        };
        shared.show = [owner](const void* target)
        {
          const auto& card = *static_cast<const MaterialCard*>(target);
          const auto own = owner->find(card.model);
          return own == owner->end() ? "" : own->second.show(card.parameters.get());
        };
        keys.push_back(shared);
        owners.push_back(owner);
      }
      keys[at].models.push_back(model.name);
      owners[at]->emplace(model.name, key);
    }
  for (Key& key : keys)
    if (key.models.size() == materialModels().size())
      key.models.clear();
  return keys;
}
} // namespace

std::vector<Key> materialCardKeys()
{
  std::vector<std::string> names, meanings;
  for (const MaterialModel& model : materialModels())
  {
    names.push_back(model.name);
    meanings.push_back(model.meaning);
  }
  std::vector<Key> keys{
      text("model", &MaterialCard::model)
          .needed()
          .oneOf(names)
          .means(fmt::format("law of the continuum: {}", fmt::join(meanings, "; ")))
          .like("j2")
          .andThen<MaterialCard>([](MaterialCard& card)
                                 { card.parameters = modelOf(card).parameters(); }),
      text("set", &MaterialCard::set)
          .oneOf(materialSetNames())
          .like("concrete_c40")
          .defaultIs("none")
          .means("set of the library, from which all keys come that are not given here, the model "
                 "too"),
  };
  for (Key& key : keysOfModels())
    keys.push_back(key);
  return keys;
}

Key materialKeys()
{
  return named("materials", &Deck::materials, materialCardKeys())
      .decidedBy("model")
      .completedBy("set")
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

std::string problemInTheFlat(const MaterialCard& card)
{
  const MaterialModel& model = modelOf(card);
  return model.problemInTheFlat ? model.problemInTheFlat(card.parameters.get()) : "";
}

Real largestElement(const MaterialCard& card)
{
  const MaterialModel& model = modelOf(card);
  return model.largestElement ? model.largestElement(card.parameters.get()) : infinity;
}
} // namespace coplane
