#include "Definitions.hpp"

#include "TimeFunctionEvaluator.hpp"

#include <coplane_core/Suggestion.hpp>

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace coplane
{
namespace
{
bool isDigit(char c)
{
  return c >= '0' && c <= '9';
}
bool isLetter(char c)
{
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

/// Where the characters of a kind that begin at `at` end.
template <class IsOfKind>
std::size_t endOf(const std::string& text, std::size_t at, const IsOfKind& isOfKind)
{
  while (at < text.size() && isOfKind(text[at]))
    ++at;
  return at;
}

/// Where the number that begins at `at` ends: "2.5e-3", ".5", "3".
std::size_t endOfNumber(const std::string& text, std::size_t at)
{
  at = endOf(text, at, isDigit);
  if (at < text.size() && text[at] == '.')
    at = endOf(text, at + 1, isDigit);
  if (at >= text.size() || (text[at] != 'e' && text[at] != 'E'))
    return at;
  const bool hasSign = at + 1 < text.size() && (text[at + 1] == '+' || text[at + 1] == '-');
  const std::size_t digits = at + (hasSign ? 2 : 1), end = endOf(text, digits, isDigit);
  return end > digits ? end : at;
}

/// Copies an expression; `word` is called for each name in it, but for functions, and gives what
/// takes its place.
template <class Word>
std::string copied(const std::string& expression, const Word& word)
{
  std::string copy;
  for (std::size_t at = 0, end = 0; at < expression.size(); at = end)
  {
    const char c = expression[at];
    const bool isName = isLetter(c);
    end = isName ? endOf(expression, at, [](char d) { return isLetter(d) || isDigit(d); })
          : isDigit(c) || (c == '.' && at + 1 < expression.size() && isDigit(expression[at + 1]))
              ? endOfNumber(expression, at)
              : at + 1;
    const std::string piece = expression.substr(at, end - at);
    const std::size_t next = endOf(expression, end, [](char d) { return d == ' ' || d == '\t'; });
    const bool isFunction = isName && next < expression.size() && expression[next] == '(';
    copy += isName && !isFunction ? word(piece) : piece;
  }
  return copy;
}

/// Why a word cannot be the name of a number; empty when it can.
std::string problemOfName(const std::string& name)
{
  if (name.empty() || !isLetter(name[0]) ||
      !std::all_of(name.begin(), name.end(), [](char c) { return isLetter(c) || isDigit(c); }))
    return "is no name for expressions; accepted: letters, digits and _, a letter first.";
  const auto& variables = variablesOfTimeAndPlace;
  const mu::Parser parser;
  if (std::find(variables.begin(), variables.end(), name) != variables.end())
    return "is the time or a coordinate in expressions; choose another name.";
  if (numberIn(name))
    return "is read as a number; choose another name.";
  if (parser.GetFunDef().count(name) || parser.GetConst().count(name))
    return "is a function or a constant of expressions; choose another name.";
  return "";
}
} // namespace

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

void Definitions::read(const DeckNode& node, Problems& problems)
{
  if (node.kind != DeckNode::Kind::Map)
    return problems.add(node, "define is no map; accepted: names, each with a number or an "
                              "expression of names before it, as in define: {h: 0.1}.");
  for (const auto& [name, value] : node.entries)
    if (name.kind == DeckNode::Kind::Scalar && !definitions_.count(name.text))
      readOne(name, value, node, problems);
}

void Definitions::readOne(const DeckNode& name, const DeckNode& value, const DeckNode& all,
                          Problems& problems)
{
  const auto refuse = [&](const DeckNode& at, const std::string& text)
  { problems.add(at, fmt::format("define.{} {}", shortened(name.text), text)); };
  if (const std::string problem = problemOfName(name.text); !problem.empty())
  {
    definitions_[name.text] = {0, name, true, false}; // one message is enough
    return refuse(name, problem);
  }
  const bool isWord = value.kind == DeckNode::Kind::Scalar && !value.text.empty();
  std::optional<Real> number = isWord ? numberIn(value.text) : std::nullopt;
  std::string problem;
  if (number && value.quoted)
    problem = "it is text in quotes; remove the quotes";
  else if (isWord && !number)
  {
    appearIn(value.text);
    if (!areUnknownIn(value.text))
      number = this->value(value.text, problem);
    copied(value.text,
           [&](const std::string& word)
           {
             if (all.find(word) && !definitions_.count(word))
               problem = fmt::format("{} stands {}; a name has its number before it is used", word,
                                     word == name.text ? "for itself" : "further down");
             return word;
           });
    if (!problem.empty())
      problem += suggestionFor(value.text);
  }
  const bool followsFault = isWord && !number && areUnknownIn(value.text);
  if (problem.empty() && number && !std::isfinite(*number))
    problem = "it is not finite";
  const bool isKnown = problem.empty() && number && !followsFault;
  definitions_[name.text] = {number.value_or(0), name, !isKnown, isKnown}; // one message is enough
  if (!isKnown && !followsFault)
  {
    refuse(value, fmt::format("{}; accepted: a number or an expression of names before it.",
                              isWord ? fmt::format("= '{}' is not accepted ({})",
                                                   shortened(value.text), problem)
                                     : "has no number"));
  }
}

bool Definitions::areUnknownIn(const std::string& expression) const
{
  bool unknown = false;
  copied(expression,
         [&](const std::string& word)
         {
           const auto found = definitions_.find(word);
           unknown = unknown || (found != definitions_.end() && !found->second.isKnown);
           return word;
         });
  return unknown;
}

std::vector<std::string> Definitions::names() const
{
  std::vector<std::string> names;
  for (const auto& [name, definition] : definitions_)
    if (definition.isKnown)
      names.push_back(name);
  return names;
}

bool Definitions::appearIn(const std::string& expression)
{
  bool found = false;
  if (definitions_.empty())
    return found;
  copied(expression,
         [&](const std::string& word)
         {
           if (const auto definition = definitions_.find(word); definition != definitions_.end())
             found = definition->second.used = true;
           return word;
         });
  return found;
}

std::optional<Real> Definitions::value(const std::string& expression, std::string& problem) const
{
  problem = expressionProblem(expression, names());
  if (!problem.empty())
    return std::nullopt;
  mu::Parser parser;
  for (const auto& [name, definition] : definitions_)
    if (definition.isKnown)
      parser.DefineConst(name, definition.value);
  parser.SetExpr(expression);
  return parser.Eval();
}

std::string Definitions::insertedInto(const std::string& expression) const
{
  return copied(expression,
                [&](const std::string& word)
                {
                  const auto found = definitions_.find(word);
                  if (found == definitions_.end())
                    return word;
                  const Real value = found->second.value;
                  return fmt::format(std::signbit(value) ? "({})" : "{}", value);
                });
}

std::string Definitions::suggestionFor(const std::string& expression) const
{
  std::string suggestion;
  if (definitions_.empty())
    return suggestion;
  copied(expression,
         [&](const std::string& word)
         {
           const auto& others = variablesOfTimeAndPlace;
           if (suggestion.empty() && !definitions_.count(word) &&
               std::find(others.begin(), others.end(), word) == others.end())
             suggestion = nearest(word, names());
           return word;
         });
  return suggestion.empty() ? "" : fmt::format(" (did you mean '{}'?)", suggestion);
}

void Definitions::demandUse(Problems& problems) const
{
  for (const auto& [name, definition] : definitions_)
    if (!definition.used)
      problems.add(definition.name,
                   fmt::format("define.{} is used nowhere; use it in a number or an expression, or "
                               "remove it.",
                               name));
}
} // namespace coplane
