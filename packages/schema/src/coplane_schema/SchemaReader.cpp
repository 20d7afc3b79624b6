#include "SchemaReader.hpp"

#include "Suggestion.hpp"
#include "TimeFunctionEvaluator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <system_error>

namespace coplane
{
namespace
{
using Kind = DeckNode::Kind;

std::string found(const DeckNode& node)
{
  switch (node.kind)
  {
  case Kind::Nothing:
    return "nothing";
  case Kind::Scalar:
    return fmt::format(node.quoted ? "\"{}\"" : "'{}'", node.text);
  case Kind::List:
    return fmt::format("a list of {}", node.items.size());
  case Kind::Map:
    return "a group of keys";
  }
  return "";
}

/// The number written in a text; nothing when it is not one, infinity when it is too large.
std::optional<Real> numberIn(const std::string& text)
{
  const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
  const char* end = text.data() + text.size();
  Real value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (stop != end || error == std::errc::invalid_argument || text.empty())
  {
    if (text == ".inf" || text == "+.inf" || text == "-.inf" || text == ".nan") // as YAML has them
      return infinity;
    return std::nullopt;
  }
  return error == std::errc::result_out_of_range ? infinity : value;
}

/// All places of the schema with a key of this name.
void collectPlaces(const Key& group, const std::string& path, const std::string& name,
                   std::vector<std::string>& places)
{
  for (const auto& key : group.keys)
  {
    const std::string here = path + (path.empty() ? "" : ".") + key.name;
    if (key.name == name && (places.empty() || places.back() != here))
      places.push_back(here);
    collectPlaces(key, key.kind == KeyKind::NamedGroups ? here + ".<name>" : here, name, places);
  }
}

class SchemaReader
{
public:
  SchemaReader(const Key& schema, Problems& problems) : schema_(schema), problems_(problems) {}

  void readGroup(const Key& group, const DeckNode& node, const std::string& path, void* target)
  {
    if (node.kind != Kind::Map)
      return wrong(node, path, "", "keys with values");
    const std::optional<std::string> model = modelOf(group, node);
    checkNames(node, path);
    for (const auto& [name, value] : node.entries)
      checkKnown(group, model, name, path);
    for (const auto& key : group.keys)
    {
      if (!key.models.empty() && !(model && key.appliesTo(*model)))
        continue;
      const DeckNode* value = node.find(key.name);
      if (value)
        readKey(key, *value, join(path, key.name), target);
      else if (key.required)
        problems_.add(
            node, fmt::format("{} is missing{}; accepted: {}: {}.", join(path, key.name),
                              key.models.empty()
                                  ? ""
                                  : fmt::format(" ({}: {} needs it)", group.discriminator, *model),
                              acceptedText(key), key.meaning));
    }
    checkAlternatives(group, node, path);
  }

private:
  static std::string join(const std::string& path, const std::string& name)
  {
    return path.empty() ? name : path + "." + name;
  }

  void wrong(const DeckNode& node, const std::string& path, const std::string& what,
             const std::string& accepted)
  {
    problems_.add(node, fmt::format("{} = {}{}; accepted: {}.", path.empty() ? "the deck" : path,
                                    found(node), what, accepted));
  }

  /// The value that decides which keys there are; nothing when it is missing or wrong, which is
  /// reported where it is read.
  std::optional<std::string> modelOf(const Key& group, const DeckNode& node) const
  {
    if (group.discriminator.empty())
      return "";
    for (const auto& key : group.keys)
      if (key.name == group.discriminator)
      {
        const DeckNode* value = node.find(key.name);
        if (!value)
          return key.required ? std::nullopt : std::optional(key.defaultText);
        const auto& words = key.choices;
        if (std::find(words.begin(), words.end(), value->text) != words.end())
          return value->text;
      }
    return std::nullopt;
  }

  /// Keys must be words, given once; merges are refused because yaml-cpp would ignore them.
  void checkNames(const DeckNode& map, const std::string& path)
  {
    std::vector<std::pair<std::string, const DeckNode*>> seen;
    for (const auto& [name, value] : map.entries)
    {
      if (name.kind != Kind::Scalar)
      {
        problems_.add(name, fmt::format("a key{} is {}; accepted: a word.",
                                        path.empty() ? "" : " in " + path, found(name)));
        continue;
      }
      if (name.text == "<<")
      {
        problems_.add(name, fmt::format("{} is a merge of YAML 1.1, which decks do not have; write "
                                        "the keys out.",
                                        join(path, "<<")));
        continue;
      }
      const auto twin =
          std::find_if(seen.begin(), seen.end(),
                       [&text = name.text](const auto& one) { return one.first == text; });
      if (twin != seen.end())
        problems_.add(name, fmt::format("{} is given twice, first at {}; keep one of them.",
                                        join(path, name.text), twin->second->where));
      else
        seen.emplace_back(name.text, &name);
    }
  }

  void checkKnown(const Key& group, const std::optional<std::string>& model, const DeckNode& name,
                  const std::string& path)
  {
    if (name.kind != Kind::Scalar || name.text == "<<")
      return;
    std::vector<std::string> names, owners;
    bool known = false, fits = false;
    for (const auto& key : group.keys)
    {
      const bool here = key.models.empty() || !model || key.appliesTo(*model);
      if (here && std::find(names.begin(), names.end(), key.name) == names.end())
        names.push_back(key.name);
      if (key.name != name.text)
        continue;
      known = true;
      fits = fits || here;
      owners.insert(owners.end(), key.models.begin(), key.models.end());
    }
    if (fits)
      return;
    if (known)
      return problems_.add(name,
                           fmt::format("{} belongs to {}: {}, but {} is {} here; remove it or "
                                       "change {}.",
                                       join(path, name.text), group.discriminator, listOf(owners),
                                       group.discriminator, *model, group.discriminator));
    for (const RemovedKey& gone : group.removed)
      if (gone.name == name.text)
        return problems_.add(
            name, fmt::format("{} is no longer a key. {}", join(path, name.text), gone.instead));
    std::string hint = didYouMean(name.text, names);
    if (hint.empty())
    {
      std::vector<std::string> places;
      collectPlaces(schema_, "", name.text, places);
      if (!places.empty())
        hint = fmt::format(" Its place is {}.", listOf(places));
    }
    problems_.add(name, fmt::format("{} is not known.{} Accepted here: {}.", join(path, name.text),
                                    hint, listOf(names, 30)));
  }

  void checkAlternatives(const Key& group, const DeckNode& node, const std::string& path)
  {
    for (const auto& alternatives : group.alternatives)
    {
      std::vector<std::string> given;
      for (const auto& name : alternatives.names)
        if (node.find(name))
          given.push_back(name);
      if (given.size() > 1)
        problems_.add(*node.find(given[1]),
                      fmt::format("{} and {} exclude each other; keep one of them.",
                                  join(path, given[0]), join(path, given[1])));
      if (given.empty() && alternatives.oneNeeded)
        problems_.add(
            node, fmt::format("{} needs one of the keys {}.", path, listOf(alternatives.names)));
    }
  }

  void readKey(const Key& key, const DeckNode& node, const std::string& path, void* target)
  {
    switch (key.kind)
    {
    case KeyKind::Group:
      return readGroup(key, node, path, key.enter(target, "", node.where));
    case KeyKind::NamedGroups:
      return readNamedGroups(key, node, path, target);
    case KeyKind::GroupList:
      return readGroupList(key, node, path, target);
    default:
      if (const auto value = readValue(key, node, path))
        key.store(target, *value);
    }
  }

  void readNamedGroups(const Key& key, const DeckNode& node, const std::string& path, void* target)
  {
    if (node.kind != Kind::Map || (key.required && node.entries.empty()))
      return wrong(node, path, "", acceptedText(key));
    checkNames(node, path);
    std::set<std::string> seen;
    for (const auto& [name, value] : node.entries)
      if (name.kind == Kind::Scalar && name.text != "<<" && seen.insert(name.text).second)
        readGroup(key, value, join(path, name.text), key.enter(target, name.text, name.where));
  }

  void readGroupList(const Key& key, const DeckNode& node, const std::string& path, void* target)
  {
    if (node.kind != Kind::List)
      return wrong(node, path, "", acceptedText(key));
    for (std::size_t i = 0; i < node.items.size(); ++i)
      readGroup(key, node.items[i], fmt::format("{}.{}", path, i),
                key.enter(target, "", node.items[i].where));
  }

  std::optional<KeyValue> readValue(const Key& key, const DeckNode& node, const std::string& path)
  {
    const bool isList = key.kind == KeyKind::Numbers || key.kind == KeyKind::Texts ||
                        key.kind == KeyKind::TimeFunctions || key.kind == KeyKind::PlaceFunctions;
    if (isList)
      return readList(key, node, path);
    const bool isTable = key.kind == KeyKind::TimeFunction && node.kind == Kind::Map;
    if (!isTable && (node.kind != Kind::Scalar || node.text.empty()))
    {
      wrong(node, path, "", acceptedText(key));
      return std::nullopt;
    }
    switch (key.kind)
    {
    case KeyKind::Number:
      return optionalValue(readNumber(key, node, path));
    case KeyKind::Integer:
      return readInteger(key, node, path);
    case KeyKind::Flag:
      if (!node.quoted && (node.text == "true" || node.text == "false"))
        return node.text == "true";
      wrong(node, path, " is not a flag", acceptedText(key));
      return std::nullopt;
    case KeyKind::TimeFunction:
    {
      const auto function = readFunction(key, node, path);
      return function ? optionalValue(std::optional(std::vector{*function})) : std::nullopt;
    }
    default:
      return optionalValue(readWord(key, node, path));
    }
  }

  template <class T>
  static std::optional<KeyValue> optionalValue(const std::optional<T>& value)
  {
    return value ? std::optional<KeyValue>(*value) : std::nullopt;
  }

  std::optional<Real> readNumber(const Key& key, const DeckNode& node, const std::string& path)
  {
    const auto value = node.kind == Kind::Scalar ? numberIn(node.text) : std::nullopt;
    std::string problem;
    if (!value)
      problem = " is not a number";
    else if (node.quoted)
      problem = " is text in quotes, not a number; remove the quotes";
    else if (!std::isfinite(*value))
      problem = " is not a finite number";
    else if ((key.lower && (*value < *key.lower || (key.lowerOpen && *value == *key.lower))) ||
             (key.upper && (*value > *key.upper || (key.upperOpen && *value == *key.upper))))
      problem = " is out of range";
    if (problem.empty())
      return value;
    wrong(node, path, problem, acceptedText(key));
    return std::nullopt;
  }

  std::optional<KeyValue> readInteger(const Key& key, const DeckNode& node, const std::string& path)
  {
    const auto word = std::find(key.choices.begin(), key.choices.end(), node.text);
    if (word != key.choices.end())
      return -int(word - key.choices.begin()); // words stand for 0, -1, ...
    int value = 0;
    const char* end = node.text.data() + node.text.size();
    const auto [stop, error] = std::from_chars(node.text.data(), end, value);
    if (node.quoted || stop != end || error == std::errc::invalid_argument)
      wrong(node, path, " is not a whole number", acceptedText(key));
    else if (error != std::errc())
      wrong(node, path, " is beyond the largest whole numbers, +-2147483647", acceptedText(key));
    else if (key.lower && value < *key.lower)
      wrong(node, path, " is out of range", acceptedText(key));
    else
      return value;
    return std::nullopt;
  }

  std::optional<std::string> readWord(const Key& key, const DeckNode& node, const std::string& path)
  {
    const auto& words = key.choices;
    if (node.kind != Kind::Scalar || node.text.empty())
      wrong(node, path, " is not text", acceptedText(key));
    else if (!words.empty() && std::find(words.begin(), words.end(), node.text) == words.end())
      problems_.add(node, fmt::format("{} = {} is not known.{} Accepted: {}.", path, found(node),
                                      didYouMean(node.text, words), acceptedText(key)));
    else
      return node.text;
    return std::nullopt;
  }

  std::optional<TimeFunction> readFunction(const Key& key, const DeckNode& node,
                                           const std::string& path)
  {
    const bool ofPlace = key.kind == KeyKind::PlaceFunctions;
    TimeFunction function;
    function.where = node.where;
    if (!ofPlace && node.kind == Kind::Map)
      return readTable(node, path);
    if (node.kind != Kind::Scalar || node.text.empty())
    {
      wrong(node, path, "", acceptedText(key));
      return std::nullopt;
    }
    if (const auto number = numberIn(node.text))
    {
      if (!std::isfinite(*number))
      {
        wrong(node, path, " is not a finite number", acceptedText(key));
        return std::nullopt;
      }
      if ((key.lower && *number < *key.lower) || (key.upper && *number > *key.upper))
      {
        wrong(node, path, " is out of range", acceptedText(key));
        return std::nullopt;
      }
      function.constant = *number;
      return function;
    }
    const std::string problem =
        expressionProblem(node.text, ofPlace          ? variablesOfPlace
                                     : key.ofPlaceToo ? variablesOfTimeAndPlace
                                                      : variablesOfTime);
    if (!problem.empty())
    {
      wrong(node, path,
            fmt::format(" is not an expression of {} ({})",
                        ofPlace          ? "x, y, z"
                        : key.ofPlaceToo ? "t, x, y, z"
                                         : "t",
                        problem),
            acceptedText(key));
      return std::nullopt;
    }
    function.expression = node.text;
    function.ofPlace = key.ofPlaceToo && hasPlace(node.text);
    return function;
  }

  /// {times: [...], values: [...]}
  std::optional<TimeFunction> readTable(const DeckNode& node, const std::string& path)
  {
    const std::size_t before = problems_.size();
    TimeFunction function;
    function.where = node.where;
    checkNames(node, path);
    for (const auto& [name, value] : node.entries)
      if (name.kind == Kind::Scalar && name.text != "times" && name.text != "values" &&
          name.text != "<<")
        problems_.add(name, fmt::format("{} is not known. Accepted here: times, values.",
                                        join(path, name.text)));
    for (const bool isTimes : {true, false})
    {
      const char* const name = isTimes ? "times" : "values";
      Key key;
      key.kind = KeyKind::Numbers;
      const DeckNode* const list = node.find(name);
      if (!list)
        problems_.add(node,
                      fmt::format("{} is missing; accepted: a table has times [s] and values, "
                                  "as in {{times: [0, 0.01], values: [0, 1]}}.",
                                  join(path, name)));
      else if (const auto numbers = readList(key, *list, join(path, name)))
        (isTimes ? function.times : function.values) = std::get<std::vector<Real>>(*numbers);
    }
    if (problems_.size() > before)
      return std::nullopt;
    const auto falls = std::adjacent_find(function.times.begin(), function.times.end(),
                                          [](Real a, Real b) { return !(a < b); });
    const bool rising = falls == function.times.end();
    if (function.times.size() < 2 || function.times.size() != function.values.size() || !rising)
    {
      problems_.add(
          node, fmt::format(
                    "{} has {} times and {} values{}; accepted: as many of both, at "
                    "least 2, with times that rise.",
                    path, function.times.size(), function.values.size(),
                    rising ? "" : fmt::format(", and {} s comes after {} s", falls[1], falls[0])));
      return std::nullopt;
    }
    return function;
  }

  std::optional<KeyValue> readList(const Key& key, const DeckNode& node, const std::string& path)
  {
    if (node.kind != Kind::List || (key.length && node.items.size() != key.length))
    {
      wrong(node, path, "", acceptedText(key));
      return std::nullopt;
    }
    std::vector<Real> numbers;
    std::vector<std::string> words;
    std::vector<TimeFunction> functions;
    for (std::size_t i = 0; i < node.items.size(); ++i)
    {
      const DeckNode& item = node.items[i];
      const std::string here = fmt::format("{}.{}", path, i);
      if (key.kind == KeyKind::Numbers)
      {
        if (const auto number = readNumber(oneOf(key, KeyKind::Number), item, here))
          numbers.push_back(*number);
      }
      else if (key.kind == KeyKind::TimeFunctions || key.kind == KeyKind::PlaceFunctions)
      {
        const KeyKind kind = key.kind == KeyKind::TimeFunctions ? KeyKind::TimeFunction : key.kind;
        if (const auto one = readFunction(oneOf(key, kind), item, here))
          functions.push_back(*one);
      }
      else if (const auto word = readWord(oneOf(key, KeyKind::Text), item, here))
        words.push_back(*word);
    }
    if (numbers.size() + functions.size() + words.size() != node.items.size())
      return std::nullopt; // reported
    if (key.notAllZero &&
        std::all_of(numbers.begin(), numbers.end(), [](Real v) { return v == 0; }))
    {
      wrong(node, path, " without direction", acceptedText(key));
      return std::nullopt;
    }
    if (key.kind == KeyKind::Numbers)
      return numbers;
    if (key.kind == KeyKind::TimeFunctions || key.kind == KeyKind::PlaceFunctions)
      return functions;
    if (!key.choices.empty() &&
        ((words.empty() && key.defaultText != "[]") ||
         std::set<std::string>(words.begin(), words.end()).size() < words.size()))
    {
      wrong(node, path, words.empty() ? " without items" : " with an item given twice",
            acceptedText(key));
      return std::nullopt;
    }
    return words;
  }

  /// What is accepted of one item of a list.
  static Key oneOf(const Key& list, KeyKind kind)
  {
    Key key = list;
    key.kind = kind;
    return key;
  }

  const Key& schema_;
  Problems& problems_;
};
} // namespace

DeckNode readBySchema(const Key& schema, const std::string& text, const std::string& file,
                      const std::vector<std::string>& overrides, void* target, Problems& problems,
                      const std::function<void(DeckNode&)>& prepare)
{
  DeckNode root = parseYaml(text, file);
  for (std::size_t i = 0; i < overrides.size(); ++i)
    applyOverride(root, overrides[i], static_cast<int>(i), problems);
  if (prepare)
    prepare(root);
  SchemaReader(schema, problems).readGroup(schema, root, "", target);
  return root;
}
} // namespace coplane
