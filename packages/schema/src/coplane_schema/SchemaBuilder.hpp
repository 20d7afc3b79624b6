#pragma once

#include <coplane_core/Vec3.hpp>
#include <coplane_schema/DeckNode.hpp>
#include <coplane_schema/Schema.hpp>
#include <coplane_schema/UsualRanges.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace coplane::schema
{
// Words with which schemas are written. A key's default is read from a default-made card, so it is
// stated once, where the card is.

/// A key under construction; every word returns it for the next.
class KeyBuilder
{
public:
  explicit KeyBuilder(Key key) : key_(std::move(key)) {}
  operator Key() const { return key_; }

  KeyBuilder& in(const std::string& unit) { return set(key_.unit, unit); }
  KeyBuilder& means(const std::string& meaning) { return set(key_.meaning, meaning); }
  KeyBuilder& like(const std::string& example) { return set(key_.example, example); }
  KeyBuilder& defaultIs(const std::string& text) { return set(key_.defaultText, text); }
  KeyBuilder& onlyFor(std::vector<std::string> models) { return set(key_.models, models); }
  KeyBuilder& oneOf(std::vector<std::string> words) { return set(key_.choices, words); }
  KeyBuilder& needed()
  {
    key_.required = true;
    key_.defaultText.clear();
    return *this;
  }
  KeyBuilder& above(Real limit) { return lower(limit, true); }
  KeyBuilder& atLeast(Real limit) { return lower(limit, false); }
  KeyBuilder& below(Real limit) { return upper(limit, true); }
  KeyBuilder& atMost(Real limit) { return upper(limit, false); }

  /// Magnitudes beyond are a warning, with the likely mistake.
  KeyBuilder& usually(const UsualRange& range) { return set(key_.usual, range); }
  /// What other programs call the key.
  KeyBuilder& elsewhere(std::vector<std::string> names) { return set(key_.habits, names); }
  /// What they call one of the words of oneOf.
  KeyBuilder& wordsElsewhere(std::vector<std::pair<std::string, std::string>> words)
  {
    return set(key_.habitualWords, words);
  }

  /// After the value is stored: something else in the same card that follows from it.
  template <class Card>
  KeyBuilder& andThen(std::function<void(Card&)> action)
  {
    key_.store = [store = key_.store, action](void* target, const KeyValue& value)
    {
      store(target, value);
      action(*static_cast<Card*>(target));
    };
    return *this;
  }

  /// How the value in a card reads.
  template <class Card>
  KeyBuilder& shownBy(std::function<std::string(const Card&)> text)
  {
    key_.show = [text](const void* card) { return text(*static_cast<const Card*>(card)); };
    return *this;
  }

  /// What one key of a group demands of another.
  template <class Card>
  KeyBuilder& checkedBy(void (*check)(Card&, const CardPlace&))
  {
    key_.check = [check](void* card, const CardPlace& place)
    { check(*static_cast<Card*>(card), place); };
    return *this;
  }

  KeyBuilder& notAllZero() { return set(key_.notAllZero, true); }
  KeyBuilder& atLeastItems(std::size_t count) { return set(key_.leastLength, count); }
  KeyBuilder& byDimension() { return set(key_.byDimension, true); }
  KeyBuilder& orOneAlone() { return set(key_.aloneToo, true); }
  KeyBuilder& onlyInDimension(int dimension) { return set(key_.dimension, dimension); }
  KeyBuilder& shortFor(const std::string& name) { return set(key_.shortFor, name); }
  KeyBuilder& ofPlaceToo() { return set(key_.ofPlaceToo, true); }
  KeyBuilder& decidedBy(const std::string& name) { return set(key_.discriminator, name); }
  KeyBuilder& completedBy(const std::string& name) { return set(key_.completedBy, name); }
  KeyBuilder& atMostOneOf(std::vector<std::string> names) { return alternatives(names, false); }
  KeyBuilder& exactlyOneOf(std::vector<std::string> names) { return alternatives(names, true); }
  /// Of a group: a key that it had once, and what to do instead.
  KeyBuilder& removed(const std::string& name, const std::string& instead)
  {
    key_.removed.push_back({name, instead});
    return *this;
  }
  /// Of a group: a key that it never had, though people look for it, and what to do instead.
  KeyBuilder& absent(const std::string& name, const std::string& advice)
  {
    key_.absent.push_back({name, advice});
    return *this;
  }

private:
  template <class T>
  KeyBuilder& set(T& field, const T& value)
  {
    field = value;
    return *this;
  }
  KeyBuilder& lower(Real limit, bool open)
  {
    key_.lower = limit;
    key_.lowerOpen = open;
    return *this;
  }
  KeyBuilder& upper(Real limit, bool open)
  {
    key_.upper = limit;
    key_.upperOpen = open;
    return *this;
  }
  KeyBuilder& alternatives(const std::vector<std::string>& names, bool oneNeeded)
  {
    key_.alternatives.push_back({names, oneNeeded});
    return *this;
  }

  Key key_;
};

inline std::string textOf(Real value)
{
  return fmt::format("{}", value);
}
inline std::string textOf(bool value)
{
  return value ? "true" : "false";
}
inline std::string textOf(const std::string& value)
{
  return value;
}
inline std::string textOf(const std::optional<Real>& value)
{
  return value ? fmt::format("{}", *value) : "";
}
inline std::string textOf(const std::vector<Real>& v)
{
  return fmt::format("[{}]", fmt::join(v, ", "));
}
inline std::string textOf(int value)
{
  return fmt::format("{}", value);
}
inline std::string textOf(const std::vector<int>& v)
{
  return fmt::format("[{}]", fmt::join(v, ", "));
}
inline std::string textOf(const std::vector<std::string>& v)
{
  return fmt::format("[{}]", fmt::join(v, ", "));
}
inline std::string textOf(const Vec3& v)
{
  return fmt::format("[{}, {}, {}]", v.x, v.y, v.z);
}
inline std::string textOf(const std::array<Real, 6>& v)
{
  return fmt::format("[{}]", fmt::join(v, ", "));
}

inline void assign(Vec3& field, const std::vector<Real>& v)
{
  field = {v[0], v[1], v.size() > 2 ? v[2] : 0.0};
}
inline void assign(std::vector<Real>& field, const std::vector<Real>& v)
{
  field = v;
}
inline void assign(std::array<Real, 6>& field, const std::vector<Real>& v)
{
  std::copy(v.begin(), v.end(), field.begin());
}

/// A key whose value of type Value goes to a member of the card.
template <class Value, class Card, class Field, class Assign>
KeyBuilder bound(const std::string& name, KeyKind kind, Field Card::*member, Assign assignValue)
{
  Key key;
  key.name = name;
  key.kind = kind;
  key.card = &typeid(Card);
  key.store = [member, assignValue](void* target, const KeyValue& value)
  { assignValue(static_cast<Card*>(target)->*member, std::get<Value>(value)); };
  return KeyBuilder(key);
}

/// The same for fields that can be shown, with the default of a fresh card.
template <class Value, class Card, class Field, class Assign>
KeyBuilder shown(const std::string& name, KeyKind kind, Field Card::*member, Assign assignValue)
{
  return bound<Value>(name, kind, member, assignValue)
      .template shownBy<Card>([member](const Card& card) { return textOf(card.*member); })
      .defaultIs(textOf(Card{}.*member));
}

const auto copyTo = [](auto& field, const auto& value) { field = value; };

template <class Card, class Field> // Real or std::optional<Real>
KeyBuilder number(const std::string& name, Field Card::*member)
{
  return shown<Real>(name, KeyKind::Number, member, copyTo);
}

template <class Card>
KeyBuilder flag(const std::string& name, bool Card::*member)
{
  return shown<bool>(name, KeyKind::Flag, member, copyTo);
}

template <class Card>
KeyBuilder text(const std::string& name, std::string Card::*member)
{
  return shown<std::string>(name, KeyKind::Text, member, copyTo);
}

template <class Card>
KeyBuilder integer(const std::string& name, int Card::*member)
{
  return shown<int>(name, KeyKind::Integer, member, copyTo);
}

template <class Card>
KeyBuilder integers(const std::string& name, std::vector<int> Card::*member)
{
  return shown<std::vector<int>>(name, KeyKind::Integers, member, copyTo);
}

template <class Card>
KeyBuilder texts(const std::string& name, std::vector<std::string> Card::*member)
{
  return shown<std::vector<std::string>>(name, KeyKind::Texts, member, copyTo);
}

template <class Card>
KeyBuilder points(const std::string& name, std::vector<std::vector<Real>> Card::*member,
                  std::size_t length = 0)
{
  Key key = bound<std::vector<std::vector<Real>>>(name, KeyKind::Points, member, copyTo);
  key.length = length;
  return KeyBuilder(key).byDimension();
}

/// A word that stands for a value of an enumeration.
template <class Card, class Enum>
KeyBuilder choice(const std::string& name, Enum Card::*member,
                  const std::vector<std::pair<std::string, Enum>>& words)
{
  std::vector<std::string> names;
  for (const auto& [word, value] : words)
    names.push_back(word);
  const auto wordOf = [words](const Enum& value)
  {
    for (const auto& [word, one] : words)
      if (one == value)
        return word;
    return std::string();
  };
  KeyBuilder key = bound<std::string>(name, KeyKind::Text, member,
                                      [words](Enum& field, const std::string& word)
                                      {
                                        for (const auto& [name, value] : words)
                                          if (name == word)
                                            field = value;
                                      });
  return key.shownBy<Card>([member, wordOf](const Card& card) { return wordOf(card.*member); })
      .oneOf(names)
      .defaultIs(wordOf(Card{}.*member));
}

template <class Card, class Field> // Vec3, std::array<Real, 6> or std::vector<Real>
KeyBuilder numbers(const std::string& name, Field Card::*member, std::size_t length = 0)
{
  Key key = shown<std::vector<Real>>(name, KeyKind::Numbers, member,
                                     [](auto& field, const auto& value) { assign(field, value); });
  key.length = length;
  return KeyBuilder(key);
}

template <class Card>
KeyBuilder vector(const std::string& name, Vec3 Card::*member)
{
  return numbers(name, member, 3);
}

/// `define`: names with numbers that the rest of the file may use. A key of the whole file.
inline KeyBuilder definitions()
{
  Key key;
  key.name = "define";
  key.kind = KeyKind::Definitions;
  return KeyBuilder(key)
      .means("numbers that other values of the file name, alone or in expressions; each of the "
             "names before it")
      .like("{h: 0.1, width: \"4*h\"}");
}

/// Changes of another file, by the paths of its keys.
inline KeyBuilder changes(const std::string& name)
{
  Key key;
  key.name = name;
  key.kind = KeyKind::Changes;
  return KeyBuilder(key);
}

/// Keys in a group of their own whose target is the same card.
inline KeyBuilder section(const std::string& name, std::vector<Key> keys)
{
  Key key;
  key.name = name;
  key.kind = KeyKind::Group;
  key.keys = std::move(keys);
  key.enter = [](void* target, const std::string&, const std::string&) { return target; };
  return KeyBuilder(key);
}

/// Keys of a card that is a member of the card around it.
template <class Outer, class Card>
KeyBuilder group(const std::string& name, Card Outer::*member, std::vector<Key> keys)
{
  Key key = section(name, std::move(keys));
  key.card = &typeid(Outer);
  key.enter = [member](void* target, const std::string&, const std::string&) -> void*
  { return &(static_cast<Outer*>(target)->*member); };
  return KeyBuilder(key);
}

/// Cards with names: `steel: {...}`.
template <class Outer, class Card>
KeyBuilder named(const std::string& name, std::vector<Card> Outer::*member, std::vector<Key> keys)
{
  Key key = section(name, std::move(keys));
  key.kind = KeyKind::NamedGroups;
  key.card = &typeid(Outer);
  key.enter = [member](void* target, const std::string& cardName, const std::string& where) -> void*
  {
    auto& cards = static_cast<Outer*>(target)->*member;
    cards.emplace_back();
    cards.back().name = cardName;
    cards.back().where = where;
    return &cards.back();
  };
  return KeyBuilder(key);
}

/// A list of cards: `- {...}`.
template <class Outer, class Card>
KeyBuilder list(const std::string& name, std::vector<Card> Outer::*member, std::vector<Key> keys)
{
  Key key = section(name, std::move(keys));
  key.kind = KeyKind::GroupList;
  key.card = &typeid(Outer);
  key.enter = [member](void* target, const std::string&, const std::string& where) -> void*
  {
    auto& cards = static_cast<Outer*>(target)->*member;
    cards.emplace_back();
    cards.back().where = where;
    return &cards.back();
  };
  return KeyBuilder(key);
}
} // namespace coplane::schema
