#include "detail/ValueReader.hpp"

#include "TimeFunctionEvaluator.hpp"
#include "detail/ValueHints.hpp"

#include <coplane_core/Suggestion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <system_error>

namespace coplane
{
namespace
{
using Kind = DeckNode::Kind;

class ValueReader
{
public:
  explicit ValueReader(Reading& reading) : reading_(reading) {}

  std::optional<KeyValue> read(const Key& key, DeckNode& node, const std::string& path)
  {
    switch (key.kind)
    {
    case KeyKind::Numbers:
      return readNumbers(key, node, path);
    case KeyKind::Integers:
      return readItems<int>(key, node, path,
                            [&](DeckNode& item, const std::string& here)
                            { return readInteger(oneOf(key, KeyKind::Integer), item, here); });
    case KeyKind::Points:
      return readItems<std::vector<Real>>(key, node, path,
                                          [&](DeckNode& item, const std::string& here)
                                          { return readPoint(key, item, here); });
    case KeyKind::Texts:
      return readTexts(key, node, path);
    case KeyKind::TextLists:
      return readTextLists(key, node, path);
    case KeyKind::TimeFunctions:
      return readFunctions(key, KeyKind::TimeFunction, node, path);
    case KeyKind::PlaceFunctions:
      return readFunctions(key, KeyKind::PlaceFunctions, node, path);
    default:
      return readOne(key, node, path);
    }
  }

private:
  std::optional<KeyValue> readOne(const Key& key, DeckNode& node, const std::string& path)
  {
    const bool isTable = key.kind == KeyKind::TimeFunction && node.kind == Kind::Map;
    if (!isTable && (node.kind != Kind::Scalar || node.text.empty()))
    {
      reading_.wrong(node, path, "", acceptedText(key));
      return std::nullopt;
    }
    switch (key.kind)
    {
    case KeyKind::Number:
      return optionalValue(readNumber(key, node, path));
    case KeyKind::Integer:
      return optionalValue(readInteger(key, node, path));
    case KeyKind::Flag:
      if (!node.quoted && (node.text == "true" || node.text == "false"))
        return node.text == "true";
      reading_.wrong(node, path, " is not a flag", acceptedText(key));
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

  /// The number of a scalar: as written, or what an expression of defined names gives, which then
  /// stands in the tree. Else `problem` says why there is none.
  std::optional<Real> numberOf(const Key& key, DeckNode& node, std::string& problem)
  {
    auto number = node.kind == Kind::Scalar ? numberIn(node.text) : std::nullopt;
    if (number && node.quoted)
      problem = " is text in quotes, not a number; remove the quotes";
    else if (number && !std::isfinite(*number))
      problem = " is not a finite number";
    else if (!number && node.kind == Kind::Scalar && reading_.definitions.appearIn(node.text))
    {
      if (reading_.definitions.areUnknownIn(node.text))
        return std::nullopt; // without another message
      number = reading_.definitions.value(node.text, problem);
      if (number && std::isfinite(*number))
        insert(node, *number);
      else
        problem = fmt::format(" is not a number ({}){}",
                              number ? fmt::format("it is {}", *number) : problem,
                              reading_.definitions.suggestionFor(node.text));
    }
    else if (!number)
      problem = " is not a number" + reading_.definitions.suggestionFor(node.text) +
                hintOfNumber(node.text, key.unit);
    return problem.empty() ? number : std::nullopt;
  }

  static void insert(DeckNode& node, Real value)
  {
    node.text = fmt::format("{}", value);
    node.quoted = false;
  }

  static bool isOutside(const Key& key, Real value)
  {
    return (key.lower && (value < *key.lower || (key.lowerOpen && value == *key.lower))) ||
           (key.upper && (value > *key.upper || (key.upperOpen && value == *key.upper)));
  }

  std::optional<Real> readNumber(const Key& key, DeckNode& node, const std::string& path)
  {
    const std::string written = node.text;
    std::string problem;
    const auto value = numberOf(key, node, problem);
    if (value && key.unit == "m" && std::abs(*value) > reading_.file.longest)
      problem = fmt::format(" is beyond {:g} m", reading_.file.longest);
    else if (value && isOutside(key, *value))
      problem = written == node.text ? " is out of range"
                                     : fmt::format(" is out of range (it is {})", node.text);
    if (problem.empty())
      return value;
    node.text = written;
    reading_.wrong(node, path, problem, acceptedText(key));
    return std::nullopt;
  }

  std::optional<int> readInteger(const Key& key, DeckNode& node, const std::string& path)
  {
    const auto word = std::find(key.choices.begin(), key.choices.end(), node.text);
    if (node.kind == Kind::Scalar && word != key.choices.end())
      return -int(word - key.choices.begin()); // words stand for 0, -1, ...
    const std::string written = node.text;
    std::string problem; // of an expression
    if (node.kind == Kind::Scalar && reading_.definitions.appearIn(node.text))
    {
      if (reading_.definitions.areUnknownIn(node.text))
        return std::nullopt; // without another message
      problem = insertWhole(node);
    }
    const auto it = problem.empty() && written != node.text ? fmt::format(" (it is {})", node.text)
                    : problem.empty()                       ? ""
                                                            : fmt::format(" ({})", problem);
    const auto refuse = [&](const std::string& text)
    {
      node.text = written;
      reading_.wrong(node, path, text + it + reading_.definitions.suggestionFor(written),
                     acceptedText(key));
    };
    int value = 0;
    const char* end = node.text.data() + node.text.size();
    const auto [stop, error] = std::from_chars(node.text.data(), end, value);
    if (node.quoted || stop != end || error == std::errc::invalid_argument)
      refuse(" is not a whole number");
    else if (error != std::errc())
      refuse(" is beyond the largest whole numbers, +-2147483647");
    else if (isOutside(key, value))
      refuse(" is out of range");
    else
      return value;
    return std::nullopt;
  }

  /// The value of an expression, which rounding may have left beside a whole number. Returns what
  /// is wrong with the expression.
  std::string insertWhole(DeckNode& node) const
  {
    std::string problem;
    const auto value = reading_.definitions.value(node.text, problem);
    if (!value || !std::isfinite(*value))
      return value ? fmt::format("it is {}", *value) : problem;
    const Real whole = std::round(*value);
    const bool isWhole = std::abs(*value - whole) <= 1e-9 * std::max(Real(1), std::abs(whole));
    insert(node, *value);
    if (isWhole)
      node.text = fmt::format("{:.0f}", whole + 0.0); // no -0
    return "";
  }

  /// The word that is meant: by its name in other programs, or by its letters.
  static std::string hintOfWord(const Key& key, const std::string& word)
  {
    for (const auto& [theirs, ours] : key.habitualWords)
      if (editDistance(word, theirs) == 0)
        return fmt::format(" It is called '{}' here.", ours);
    return didYouMean(word, key.choices);
  }

  std::optional<std::string> readWord(const Key& key, const DeckNode& node, const std::string& path)
  {
    const auto& words = key.choices;
    if (node.kind != Kind::Scalar || node.text.empty())
      reading_.wrong(node, path, " is not text", acceptedText(key));
    else if (!words.empty() && std::find(words.begin(), words.end(), node.text) == words.end())
      reading_.problems.add(node, fmt::format("{} = {} is not known.{} Accepted: {}.", path,
                                              foundText(node), hintOfWord(key, node.text),
                                              acceptedText(key)));
    else
      return node.text;
    return std::nullopt;
  }

  std::optional<TimeFunction> readFunction(const Key& key, DeckNode& node, const std::string& path)
  {
    const bool ofPlace = key.kind == KeyKind::PlaceFunctions;
    TimeFunction function;
    function.where = node.where;
    if (!ofPlace && node.kind == Kind::Map)
      return readTable(node, path);
    if (node.kind != Kind::Scalar || node.text.empty())
    {
      reading_.wrong(node, path, "", acceptedText(key));
      return std::nullopt;
    }
    const auto& variables = ofPlace          ? variablesOfPlace
                            : key.ofPlaceToo ? variablesOfTimeAndPlace
                                             : variablesOfTime;
    if (!numberIn(node.text))
    {
      const std::string problem = insertDefinitions(node, variables);
      if (!problem.empty())
      {
        reading_.wrong(node, path,
                       fmt::format(" is not an expression of {} ({}){}", fmt::join(variables, ", "),
                                   problem,
                                   reading_.definitions.suggestionFor(node.text) +
                                       hintOfExpression(node.text)),
                       acceptedText(key));
        return std::nullopt;
      }
    }
    if (const auto number = numberIn(node.text))
    {
      const bool isFinite = std::isfinite(*number);
      if (!isFinite || (key.lower && *number < *key.lower) || (key.upper && *number > *key.upper))
      {
        reading_.wrong(node, path, isFinite ? " is out of range" : " is not a finite number",
                       acceptedText(key));
        return std::nullopt;
      }
      function.constant = *number;
      return function;
    }
    function.expression = node.text;
    function.ofPlace = key.ofPlaceToo && hasPlace(node.text);
    return function;
  }

  /// Puts numbers in place of defined names; what has no other names becomes a number. Returns what
  /// is wrong with the expression.
  std::string insertDefinitions(DeckNode& node, std::vector<std::string> variables)
  {
    const bool uses = reading_.definitions.appearIn(node.text);
    std::string problem;
    if (uses && reading_.definitions.areUnknownIn(node.text))
      return ""; // told already
    if (const auto value = uses ? reading_.definitions.value(node.text, problem) : std::nullopt)
    {
      insert(node, *value);
      return std::isfinite(*value) ? "" : "it is not finite";
    }
    const auto names = reading_.definitions.names();
    variables.insert(variables.end(), names.begin(), names.end());
    problem = expressionProblem(node.text, variables);
    if (problem.empty() && uses)
      node.text = reading_.definitions.insertedInto(node.text);
    return problem;
  }

  /// {times: [...], values: [...], scale: 1}
  std::optional<TimeFunction> readTable(DeckNode& node, const std::string& path)
  {
    const std::size_t before = reading_.problems.size();
    TimeFunction function;
    function.where = node.where;
    reading_.checkNames(node, path);
    for (const auto& [name, value] : node.entries)
      if (name.kind == Kind::Scalar && name.text != "times" && name.text != "values" &&
          name.text != "scale" && name.text != "<<")
        reading_.problems.add(name, fmt::format("{} is not known. Accepted here: times, values, "
                                                "scale.",
                                                join(path, name.text)));
    for (const bool isTimes : {true, false})
    {
      const char* const name = isTimes ? "times" : "values";
      Key key;
      key.kind = KeyKind::Numbers;
      DeckNode* const list = node.find(name);
      if (!list)
        reading_.problems.add(
            node, fmt::format("{} is missing; accepted: a table has times [s] and values, "
                              "as in {{times: [0, 0.01], values: [0, 1]}}.",
                              join(path, name)));
      else if (const auto numbers = readNumbers(key, *list, join(path, name)))
        (isTimes ? function.times : function.values) = *numbers;
    }
    Key factor;
    factor.kind = KeyKind::Number;
    if (DeckNode* const scale = node.find("scale"))
      if (const auto number = readNumber(factor, *scale, join(path, "scale")))
        for (Real& value : function.values)
          value *= *number;
    if (reading_.problems.size() > before)
      return std::nullopt;
    const auto falls = std::adjacent_find(function.times.begin(), function.times.end(),
                                          [](Real a, Real b) { return !(a < b); });
    const bool rising = falls == function.times.end();
    if (function.times.size() < 2 || function.times.size() != function.values.size() || !rising)
    {
      reading_.problems.add(
          node, fmt::format(
                    "{} has {} times and {} values{}; accepted: as many of both, at "
                    "least 2, with times that rise.",
                    path, function.times.size(), function.values.size(),
                    rising ? "" : fmt::format(", and {} s comes after {} s", falls[1], falls[0])));
      return std::nullopt;
    }
    return function;
  }

  bool hasLength(const Key& key, std::size_t items) const
  {
    const bool oneAnAxis = key.byDimension && key.kind != KeyKind::Points;
    return items >= key.leastLength &&
           (oneAnAxis ? items == 2 || items == 3 : !key.length || items == key.length);
  }

  /// As of "max(w" in [max(w, 3), 1], of which YAML makes a list of three.
  static bool hasOpenParenthesis(const DeckNode& node)
  {
    return std::count(node.text.begin(), node.text.end(), '(') >
           std::count(node.text.begin(), node.text.end(), ')');
  }

  /// The items of a list, if all of them could be read.
  template <class T, class Read>
  std::optional<std::vector<T>> readItems(const Key& key, DeckNode& node, const std::string& path,
                                          const Read& readItem)
  {
    if (node.kind != Kind::List || !hasLength(key, node.items.size()))
    {
      const bool isCut = std::any_of(node.items.begin(), node.items.end(), hasOpenParenthesis);
      reading_.wrong(node, path, isCut ? ": an expression with a comma in it wants quotes" : "",
                     acceptedText(key) +
                         (key.length && !key.example.empty() ? ", such as " + key.example : ""));
      return std::nullopt;
    }
    std::vector<T> values;
    for (std::size_t i = 0; i < node.items.size(); ++i)
      if (const auto value = readItem(node.items[i], fmt::format("{}.{}", path, i)))
        values.push_back(*value);
    return values.size() == node.items.size() ? std::optional(values) : std::nullopt;
  }

  std::optional<KeyValue> readFunctions(const Key& key, KeyKind kind, DeckNode& node,
                                        const std::string& path)
  {
    const Key one = oneOf(key, kind);
    return readItems<TimeFunction>(key, node, path,
                                   [&](DeckNode& item, const std::string& here)
                                   { return readFunction(one, item, here); });
  }

  std::optional<std::vector<Real>> readNumbers(const Key& key, DeckNode& node,
                                               const std::string& path)
  {
    const Key one = oneOf(key, KeyKind::Number);
    if (key.aloneToo && node.kind == Kind::Scalar)
    {
      const auto number = readNumber(key, node, path);
      return number ? std::optional(std::vector{*number}) : std::nullopt;
    }
    const auto numbers = readItems<Real>(key, node, path,
                                         [&](DeckNode& item, const auto& here)
                                         { return readNumber(one, item, here); });
    if (numbers && key.notAllZero &&
        std::all_of(numbers->begin(), numbers->end(), [](Real v) { return v == 0; }))
    {
      reading_.wrong(node, path, " without direction", acceptedText(key));
      return std::nullopt;
    }
    return numbers;
  }

  std::optional<std::vector<Real>> readPoint(const Key& list, DeckNode& node,
                                             const std::string& path)
  {
    Key point = oneOf(list, KeyKind::Numbers);
    point.length = list.itemLength;
    point.leastLength = 0;
    return readNumbers(point, node, path);
  }

  std::optional<KeyValue> readTexts(const Key& key, DeckNode& node, const std::string& path)
  {
    const auto readItem = [&](DeckNode& item, const std::string& here)
    { return readWord(oneOf(key, KeyKind::Text), item, here); };
    if (key.aloneToo && node.kind == Kind::Scalar)
    {
      const auto word = readItem(node, path);
      return word ? optionalValue(std::optional(std::vector{*word})) : std::nullopt;
    }
    const auto words = readItems<std::string>(key, node, path, readItem);
    if (words && !key.choices.empty() &&
        ((words->empty() && key.defaultText != "[]") ||
         std::set<std::string>(words->begin(), words->end()).size() < words->size()))
    {
      reading_.wrong(node, path, words->empty() ? " without items" : " with an item given twice",
                     acceptedText(key));
      return std::nullopt;
    }
    return optionalValue(words);
  }

  /// Words, or one of the choices as the only word of the only list.
  std::optional<KeyValue> readTextLists(const Key& key, DeckNode& node, const std::string& path)
  {
    using Lists = std::vector<std::vector<std::string>>;
    const auto& words = key.choices;
    if (node.kind == Kind::Scalar &&
        std::find(words.begin(), words.end(), node.text) != words.end())
      return Lists{{node.text}};
    Key item = oneOf(key, KeyKind::Texts);
    item.length = key.itemLength;
    item.leastLength = 0;
    item.choices.clear();
    const Key word = oneOf(item, KeyKind::Text);
    return optionalValue(readItems<std::vector<std::string>>(
        key, node, path,
        [&](DeckNode& list, const std::string& here)
        {
          return readItems<std::string>(item, list, here,
                                        [&](DeckNode& one, const auto& place)
                                        { return readWord(word, one, place); });
        }));
  }

  /// What is accepted of one item of a list.
  static Key oneOf(const Key& list, KeyKind kind)
  {
    Key key = list;
    key.kind = kind;
    return key;
  }

  Reading& reading_;
};
} // namespace

std::string foundText(const DeckNode& node)
{
  switch (node.kind)
  {
  case Kind::Nothing:
    return "nothing";
  case Kind::Scalar:
    return fmt::format(node.quoted ? "\"{}\"" : "'{}'", shortened(node.text));
  case Kind::List:
    return fmt::format("a list of {}", node.items.size());
  case Kind::Map:
    return "a group of keys";
  }
  return "";
}

std::string join(const std::string& path, const std::string& name)
{
  return path.empty() ? shortened(name) : path + "." + shortened(name);
}

void Reading::wrong(const DeckNode& node, const std::string& path, const std::string& what,
                    const std::string& accepted)
{
  problems.add(node, fmt::format("{} = {}{}; accepted: {}.", path.empty() ? file.name : path,
                                 foundText(node), what, accepted));
}

void Reading::checkNames(const DeckNode& map, const std::string& path)
{
  std::vector<std::pair<std::string, const DeckNode*>> seen;
  for (const auto& [name, value] : map.entries)
  {
    if (name.kind != Kind::Scalar)
    {
      problems.add(name, fmt::format("a key{} is {}; accepted: a word.",
                                     path.empty() ? "" : " in " + path, foundText(name)));
      continue;
    }
    if (name.text == "<<")
    {
      problems.add(name, fmt::format("{} is a merge of YAML 1.1, which decks do not have; write "
                                     "the keys out.",
                                     join(path, "<<")));
      continue;
    }
    const auto twin =
        std::find_if(seen.begin(), seen.end(),
                     [&text = name.text](const auto& one) { return one.first == text; });
    if (twin != seen.end())
      problems.add(name, fmt::format("{} is given twice, first at {}; keep one of them.",
                                     join(path, name.text), twin->second->where));
    else
      seen.emplace_back(name.text, &name);
  }
}

std::optional<KeyValue> readValue(Reading& reading, const Key& key, DeckNode& node,
                                  const std::string& path)
{
  return ValueReader(reading).read(key, node, path);
}
} // namespace coplane
