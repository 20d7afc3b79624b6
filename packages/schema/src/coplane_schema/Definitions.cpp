#include "Definitions.hpp"

#include "Suggestion.hpp"
#include "TimeFunctionEvaluator.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <regex>
#include <system_error>

namespace coplane
{
namespace
{
/// Numbers and words of an expression; a word before '(' is a function.
const std::regex& token()
{
  static const std::regex pattern(R"((\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|([A-Za-z_]\w*)(\s*\()?)");
  return pattern;
}

/// Copies an expression; `word` is called for each name in it and gives what takes its place.
template <class Word>
std::string copied(const std::string& expression, const Word& word)
{
  std::string copy;
  auto rest = expression.cbegin();
  for (std::sregex_iterator at(expression.begin(), expression.end(), token()), end; at != end; ++at)
  {
    const std::smatch& match = *at;
    copy.append(rest, match[0].first);
    copy += match[3].matched && !match[4].matched ? word(match[3].str()) : match[0].str();
    rest = match[0].second;
  }
  return copy.append(rest, expression.cend());
}

/// Why a word cannot be the name of a number; empty when it can.
std::string problemOfName(const std::string& name)
{
  if (!std::regex_match(name, std::regex(R"([A-Za-z_]\w*)")))
    return "is no name for expressions; accepted: letters, digits and _, a letter first.";
  const auto& variables = variablesOfTimeAndPlace;
  const mu::Parser parser;
  if (std::find(variables.begin(), variables.end(), name) != variables.end())
    return "is the time or a coordinate in expressions; choose another name.";
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
  { problems.add(at, fmt::format("define.{} {}", name.text, text)); };
  if (const std::string problem = problemOfName(name.text); !problem.empty())
    return refuse(name, problem);
  const bool isWord = value.kind == DeckNode::Kind::Scalar && !value.text.empty();
  std::optional<Real> number = isWord ? numberIn(value.text) : std::nullopt;
  std::string problem;
  if (number && value.quoted)
    problem = "it is text in quotes; remove the quotes";
  else if (isWord && !number)
  {
    appearIn(value.text);
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
  if (problem.empty() && number && !std::isfinite(*number))
    problem = "it is not finite";
  definitions_[name.text] = {number.value_or(0), name, false};
  if (!problem.empty() || !number)
  {
    definitions_[name.text].used = true; // one message is enough
    refuse(value,
           fmt::format("{}; accepted: a number or an expression of names before it.",
                       isWord ? fmt::format("= '{}' is not accepted ({})", value.text, problem)
                              : "has no number"));
  }
}

std::vector<std::string> Definitions::names() const
{
  std::vector<std::string> names;
  for (const auto& [name, definition] : definitions_)
    names.push_back(name);
  return names;
}

bool Definitions::appearIn(const std::string& expression)
{
  bool found = false;
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
