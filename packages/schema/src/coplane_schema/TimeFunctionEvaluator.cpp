#include "TimeFunctionEvaluator.hpp"

#include <coplane_core/Error.hpp>

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <vector>

namespace coplane
{
struct ParsedExpression
{
  std::vector<Real> values; ///< of the variables; at least of t, x, y and z
  mu::Parser parser;

  ParsedExpression(const std::string& text, const std::vector<std::string>& variables)
      : values(std::max<std::size_t>(4, variables.size()))
  {
    for (std::size_t i = 0; i < variables.size(); ++i)
      parser.DefineVar(variables[i], &values[i]);
    parser.SetExpr(text);
  }
};

namespace
{
// muParser would let an expression change t ("t=3"): the only '=' allowed are those of comparisons.
std::size_t findAssignment(const std::string& text)
{
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    if (text[i] != '=')
      continue;
    if (i + 1 < text.size() && text[i + 1] == '=')
      ++i;
    else if (i == 0 || (text[i - 1] != '<' && text[i - 1] != '>' && text[i - 1] != '!'))
      return i;
  }
  return std::string::npos;
}

std::unique_ptr<ParsedExpression> parsed(const TimeFunction& function,
                                         const std::vector<std::string>& variables, const char* of)
{
  if (function.expression.empty())
    return nullptr;
  const std::string problem = expressionProblem(function.expression, variables);
  if (!problem.empty())
    fail(ExitCode::Deck, "{}: '{}' is not an expression of {}: {}.", function.where,
         function.expression, of, problem);
  return std::make_unique<ParsedExpression>(function.expression, variables);
}
} // namespace

TimeFunctionEvaluator::TimeFunctionEvaluator(const TimeFunction& function)
    : expression_(parsed(function, function.ofPlace ? variablesOfTimeAndPlace : variablesOfTime,
                         function.ofPlace ? "t, x, y, z" : "t")),
      function_(function)
{
}

TimeFunctionEvaluator::~TimeFunctionEvaluator() = default;
TimeFunctionEvaluator::TimeFunctionEvaluator(TimeFunctionEvaluator&&) noexcept = default;
TimeFunctionEvaluator& TimeFunctionEvaluator::operator=(TimeFunctionEvaluator&&) noexcept = default;

Real TimeFunctionEvaluator::operator()(Real t, const Vec3& place)
{
  const std::vector<Real>& times = function_.times;
  if (!times.empty())
  {
    const auto next = std::upper_bound(times.begin(), times.end(), t);
    if (next == times.begin() || next == times.end())
      return next == times.begin() ? function_.values.front() : function_.values.back();
    const std::size_t i = std::size_t(next - times.begin());
    const Real part = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return (1 - part) * function_.values[i - 1] + part * function_.values[i];
  }
  if (!expression_)
    return function_.constant;
  expression_->values[0] = t;
  for (int c = 0; c < 3; ++c)
    expression_->values[1 + c] = place[c];
  const Real value = expression_->parser.Eval();
  if (!std::isfinite(value))
    fail(ExitCode::Computation,
         "{}: '{}' is {} at t = {} s, which is not a finite number. Change the expression, for "
         "example with max(t, 1e-9) where it divides by t.",
         function_.where, function_.expression, value, t);
  return value;
}

PlaceFunctionEvaluator::PlaceFunctionEvaluator(const PlaceFunction& function)
    : expression_(parsed(function, variablesOfPlace, "x, y, z")), function_(function)
{
}

PlaceFunctionEvaluator::~PlaceFunctionEvaluator() = default;
PlaceFunctionEvaluator::PlaceFunctionEvaluator(PlaceFunctionEvaluator&&) noexcept = default;
PlaceFunctionEvaluator&
PlaceFunctionEvaluator::operator=(PlaceFunctionEvaluator&&) noexcept = default;

Real PlaceFunctionEvaluator::operator()(const Vec3& point)
{
  if (!expression_)
    return function_.constant;
  for (int c = 0; c < 3; ++c)
    expression_->values[c] = point[c];
  const Real value = expression_->parser.Eval();
  if (!std::isfinite(value))
    fail(ExitCode::Computation,
         "{}: '{}' is {} at ({}, {}, {}) m, which is not a finite number. Change the expression.",
         function_.where, function_.expression, value, point.x, point.y, point.z);
  return value;
}

bool hasPlace(const std::string& expression)
{
  ParsedExpression parsed(expression, variablesOfTimeAndPlace);
  for (const auto& [name, value] : parsed.parser.GetUsedVar())
    if (name != "t")
      return true;
  return false;
}

std::string expressionProblem(const std::string& expression,
                              const std::vector<std::string>& variables)
{
  if (const auto at = findAssignment(expression); at != std::string::npos)
    return fmt::format("'=' at character {} would set a variable; compare with ==", at + 1);
  try
  {
    ParsedExpression trial(expression, variables);
    int results = 0;
    trial.parser.Eval(results);
    if (results != 1)
      return fmt::format("it gives {} values where one is needed", results);
  }
  catch (const mu::Parser::exception_type& e)
  {
    // muParser counts from zero; people count characters from one.
    std::string text =
        std::regex_replace(e.GetMsg(), std::regex("at position [0-9]+"),
                           fmt::format("at character {}", static_cast<long>(e.GetPos()) + 1));
    while (!text.empty() && (text.back() == '.' || text.back() == ' ' || text.back() == '\n'))
      text.pop_back();
    return text;
  }
  return "";
}
} // namespace coplane
