#pragma once

#include <coplane_core/Error.hpp>
#include <coplane_schema/SchemaBuilder.hpp>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace coplane
{
/// A model that the cards of a group may name. Schema, references, checks and laws come from here;
/// a law's own file makes it.
template <class LawType>
struct CardModel
{
  using Law = LawType;

  std::string name;                                  ///< the word of the deck
  std::string meaning;                               ///< a few words for the reference
  std::vector<std::string> habits;                   ///< what other programs call it
  std::vector<Key> keys;                             ///< their target is what `parameters` makes
  std::function<std::shared_ptr<void>()> parameters; ///< with their defaults
  /// What one key demands of another; empty: nothing.
  std::function<void(const void* parameters, const CardPlace&)> check;
  /// Throws Error(ExitCode::Deck) with what is wrong.
  std::function<Law(const void* parameters)> law;
};

/// A model under construction, whose keys fill a P; makeLaw(const P&) makes its law. Derived adds
/// words of its own.
template <class Derived, class Model, class P>
class CardModelBuilder
{
public:
  CardModelBuilder(const std::string& name, const std::string& meaning)
  {
    model_.name = name;
    model_.meaning = meaning;
    model_.parameters = [] { return std::make_shared<P>(); };
    model_.law = [](const void* parameters) -> typename Model::Law
    { return makeLaw(*static_cast<const P*>(parameters)); };
  }
  operator Model() const { return model_; }

  /// What other programs call the model: a message about such a word names it.
  Derived& elsewhere(const std::vector<std::string>& names)
  {
    model_.habits = names;
    return self();
  }

  Derived& has(const std::vector<Key>& keys)
  {
    for (const Key& key : keys)
    {
      // A member of a base is bound as number<P, Real>("x", &P::x), or the target is not the base.
      if (*key.card != typeid(P))
        fail(ExitCode::Internal, "key {} of model {} is bound to another card", key.name,
             model_.name);
      model_.keys.push_back(key);
    }
    return self();
  }
  /// @param check of P or of a base of it
  template <class Checked>
  Derived& demands(void (*check)(const Checked&, const CardPlace&))
  {
    model_.check = [check](const void* parameters, const CardPlace& place)
    { check(*static_cast<const P*>(parameters), place); };
    return self();
  }

protected:
  Derived& self() { return static_cast<Derived&>(*this); }

  Model model_;
};

/// The model of that name, or nullptr.
template <class Model>
const Model* findModel(const std::vector<Model>& models, const std::string& name)
{
  for (const Model& model : models)
    if (model.name == name)
      return &model;
  return nullptr;
}

/// Whether references say the same of two keys.
bool sameTexts(const Key& a, const Key& b);

/// The keys of one name that several models say alike, by model.
using KeyOfModel = std::map<std::string, Key>;

/// One key in place of those of several models: it goes to the parameters of the card's own model.
/// @param key of one of them; owner: all, filled as they come
template <class Card>
Key keyOfOwnModel(const Key& key, const std::shared_ptr<KeyOfModel>& owner)
{
  Key shared = key;
  shared.store = [owner](void* target, const KeyValue& value)
  {
    const auto& card = *static_cast<const Card*>(target);
    if (const auto own = owner->find(card.model); own != owner->end())
      own->second.store(card.parameters.get(), value);
  };
  shared.show = [owner](const void* target)
  {
    const auto& card = *static_cast<const Card*>(target);
    const auto own = owner->find(card.model);
    return own == owner->end() ? "" : own->second.show(card.parameters.get());
  };
  shared.ofModel = [owner, key](const void* target) -> const Key&
  {
    const auto found = owner->find(static_cast<const Card*>(target)->model);
    return found == owner->end() ? key : found->second;
  };
  if (key.isGroup())
    shared.enter = [owner](void* target, const std::string& name, const std::string& where)
    {
      const auto& card = *static_cast<const Card*>(target);
      return owner->at(card.model).enter(card.parameters.get(), name, where);
    };
  return shared;
}

/// The keys of a group of cards whose `model` decides what they have: the key `model` itself, and
/// those of all models, each once: what several models say alike is one key, which goes to the
/// parameters of the card's own model.
/// @param Card has `std::string model` and `std::shared_ptr<void> parameters`
/// @param word the key that names the model
template <class Card, class Model>
std::vector<Key> keysOfModels(const std::vector<Model>& models, const std::string& meaning,
                              const std::string& example, const std::string& word = "model")
{
  std::vector<std::string> names, meanings;
  std::vector<std::pair<std::string, std::string>> namesElsewhere;
  for (const Model& model : models)
  {
    names.push_back(model.name);
    meanings.push_back(model.meaning);
    for (const std::string& habit : model.habits)
      namesElsewhere.emplace_back(habit, model.name);
  }
  std::vector<Key> keys{schema::text(word, &Card::model)
                            .oneOf(names)
                            .means(fmt::format("{}: {}", meaning, fmt::join(meanings, "; ")))
                            .like(example)
                            .wordsElsewhere(namesElsewhere)
                            .template andThen<Card>(
                                [&models](Card& card) {
                                  card.parameters = findModel(models, card.model)->parameters();
                                })};
  std::vector<std::shared_ptr<KeyOfModel>> owners(1);
  for (const Model& model : models)
    for (const Key& key : model.keys)
    {
      const auto same = std::find_if(keys.begin() + 1, keys.end(),
                                     [&](const Key& one) { return sameTexts(one, key); });
      const auto at = std::size_t(same - keys.begin());
      if (same == keys.end())
      {
        owners.push_back(std::make_shared<KeyOfModel>());
        keys.push_back(keyOfOwnModel<Card>(key, owners.back()));
      }
      keys[at].models.push_back(model.name);
      owners[at]->emplace(model.name, key);
    }
  for (Key& key : keys)
    if (key.models.size() == models.size())
      key.models.clear();
  return keys;
}
} // namespace coplane
