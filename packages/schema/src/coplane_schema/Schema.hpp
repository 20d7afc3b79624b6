#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_schema/TimeFunction.hpp>

#include <functional>
#include <optional>
#include <string>
#include <typeinfo>
#include <utility>
#include <variant>
#include <vector>

namespace coplane
{
struct CardPlace;

/// What a key holds.
enum class KeyKind
{
  Text,
  Number,
  Integer,
  Flag,
  Numbers,        ///< list of numbers
  Integers,       ///< list of whole numbers
  Points,         ///< list of lists of numbers
  Texts,          ///< list of words
  TextLists,      ///< list of lists of words
  TimeFunction,   ///< a number, an expression of t, or a table over t
  TimeFunctions,  ///< a list of them
  PlaceFunctions, ///< a list of numbers or expressions of x, y and z
  Definitions,    ///< names with numbers that the rest of the file may use
  Changes,        ///< paths in another file, with any values
  Group,          ///< keys
  NamedGroups,    ///< names, each with the same keys
  GroupList       ///< list of groups
};

using KeyValue = std::variant<bool, int, Real, std::string, std::vector<Real>, std::vector<int>,
                              std::vector<std::vector<Real>>, std::vector<std::string>,
                              std::vector<std::vector<std::string>>, std::vector<TimeFunction>>;

/// Keys of one group of which at most one, or exactly one, may be given.
struct Alternatives
{
  std::vector<std::string> names;
  bool oneNeeded = false;
};

/// A key that a group had once: whoever still gives it is told why it has gone and what to do.
struct RemovedKey
{
  std::string name;
  std::string instead; ///< whole sentences
};

/// A key that people look for and that no such group ever had: what to do in its place.
struct AbsentKey
{
  std::string name;
  std::string advice; ///< whole sentences
};

/// Where the magnitudes of a value lie as a rule; zero is always usual. What lies outside is a
/// warning, not an error.
struct UsualRange
{
  Real least = 0, largest = infinity;
  std::string slip; ///< the likely mistake, as sentences
};

/// One key of an input file: everything that is said about it anywhere is said here. The checks,
/// --help-deck, the manual's page and the JSON Schema are made from it, and `store` or `enter`
/// binds it to a field of a card, so that no key can be without effect.
struct Key
{
  std::string name;
  KeyKind kind = KeyKind::Text;
  std::string unit;        ///< "-" for a pure number, empty where no number is expected
  std::string defaultText; ///< empty: none
  std::string meaning;
  std::string example;   ///< a value other than the default, as YAML
  bool required = false; ///< among `models` when these are given
  std::vector<std::string>
      models; ///< only with these values of the group's discriminator; empty: always

  // values
  std::vector<std::string>
      choices; ///< Text, Texts: accepted words; Integer: words beside numbers, for 0, -1, ...;
               ///< TextLists: words that may stand in place of the list
  std::optional<Real> lower, upper;
  bool lowerOpen = false, upperOpen = false; ///< the limit itself is refused
  UsualRange usual;
  std::vector<std::string> habits; ///< what other programs call the key
  std::vector<std::pair<std::string, std::string>>
      habitualWords;           ///< what others call one of `choices`, and the choice
  std::size_t length = 0;      ///< of a list; 0: any
  std::size_t itemLength = 0;  ///< of the lists in it (Points, TextLists); 0: any
  std::size_t leastLength = 0; ///< of a list
  bool byDimension = false;    ///< 2 or 3 numbers, in a list or in each of its points
  bool aloneToo = false;       ///< an item may stand without its list
  bool notAllZero = false;     ///< Numbers: a direction
  bool ofPlaceToo = false;     ///< TimeFunction(s): expressions may have x, y, z beside t
  std::function<void(void* target, const KeyValue&)> store;
  std::function<std::string(const void* target)> show; ///< the value there, if it can be shown
  /// The key of the card's own model, where those of several models are one (keysOfModels).
  std::function<const Key&(const void* target)> ofModel;
  const std::type_info* card = nullptr; ///< what `store` or `enter` takes its target for
  int dimension = 0;                    ///< the only one in which the key may be given; 0: any
  std::string noPlace;                  ///< why the key may not be given here; see fitToDimension

  // groups
  std::vector<Key> keys;
  std::string discriminator; ///< the key (`model`, `type`) that decides which others there are
  /// Why one of its values has no place here; then the rest of the group is not read. Empty: it
  /// has.
  std::function<std::string(const std::string& model)> problemOfModel;
  std::vector<Alternatives> alternatives;
  std::vector<RemovedKey> removed;
  std::vector<AbsentKey> absent;
  std::string completedBy; ///< a key (`set`) that gives all required ones that are not given
  std::string shortFor;    ///< a value that is no map is that of this key of the group
  /// What one key of the group demands of another; asked when all of them could be read.
  std::function<void(void* card, const CardPlace&)> check;
  /// The card that the group's keys fill; lists grow by one item.
  std::function<void*(void* target, const std::string& name, const std::string& where)> enter;

  bool isGroup() const { return kind >= KeyKind::Group; }
  bool appliesTo(const std::string& model) const;
};

/// Makes a schema that of one dimension, 2 or 3: lists with a number per axis get their length,
/// keys of the other dimension are refused.
void fitToDimension(Key& key, int dimension);

/// What is odd in a value, as sentences: it lies outside of the usual range; or empty.
std::string oddityOf(const Key& key, const KeyValue& value);

/// What may be written: "a number > 0 [kg/m^3]", "linear_elastic or j2", "a list of 3 numbers
/// [m/s]".
std::string acceptedText(const Key& key);
} // namespace coplane
