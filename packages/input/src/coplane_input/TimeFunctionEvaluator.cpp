#include "TimeFunctionEvaluator.hpp"

#include <coplane_core/Error.hpp>

#include <muParser.h>

#include <cmath>
#include <regex>

namespace coplane
{
struct TimeFunctionEvaluator::Expression
{
  Real t = 0;
  mu::Parser parser;

  explicit Expression(const std::string& text)
  {
    parser.DefineVar("t", &t);
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
} // namespace

TimeFunctionEvaluator::TimeFunctionEvaluator(const TimeFunction& function) : function_(function)
{
  if (function.expression.empty())
    return;
  const std::string problem = expressionProblem(function.expression);
  if (!problem.empty())
    fail(ExitCode::Deck, "{}: '{}' is not an expression of t: {}.", function.where,
         function.expression, problem);
  expression_ = std::make_unique<Expression>(function.expression);
}

TimeFunctionEvaluator::~TimeFunctionEvaluator() = default;
TimeFunctionEvaluator::TimeFunctionEvaluator(TimeFunctionEvaluator&&) noexcept = default;
TimeFunctionEvaluator& TimeFunctionEvaluator::operator=(TimeFunctionEvaluator&&) noexcept = default;

Real TimeFunctionEvaluator::operator()(Real t)
{
  if (!expression_)
    return function_.constant;
  expression_->t = t;
  const Real value = expression_->parser.Eval();
  if (!std::isfinite(value))
    fail(ExitCode::Computation,
         "{}: '{}' is {} at t = {} s, which is not a finite number. Change the expression, for "
         "example with max(t, 1e-9) where it divides by t.",
         function_.where, function_.expression, value, t);
  return value;
}

std::string expressionProblem(const std::string& expression)
{
  if (const auto at = findAssignment(expression); at != std::string::npos)
    return fmt::format("'=' at character {} would set a variable; compare with ==", at + 1);
  try
  {
    Real t = 0;
    mu::Parser parser;
    parser.DefineVar("t", &t);
    parser.SetExpr(expression);
    int results = 0;
    parser.Eval(results);
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
