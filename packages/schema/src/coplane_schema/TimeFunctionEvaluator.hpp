#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_schema/TimeFunction.hpp>

#include <memory>
#include <string>
#include <vector>

namespace coplane
{
// Numbers and expressions such as 0.05*sin(2*_pi*200*t). The language is that of muParser: + - * /
// ^, comparisons, a ? b : c, && ||, min max abs sqrt exp ln log10 sin cos tan and their like, the
// constants _pi and _e. One evaluator serves one thread.

const std::vector<std::string> variablesOfTime{"t"};
const std::vector<std::string> variablesOfPlace{"x", "y", "z"};
const std::vector<std::string> variablesOfTimeAndPlace{"t", "x", "y", "z"};

struct ParsedExpression;

/// Evaluates a number, an expression of t [s] or of t and x, y, z [m], or a table over t.
class TimeFunctionEvaluator
{
public:
  /// Throws Error(Deck) when the expression is wrong; decks that were read have been checked
  /// already.
  explicit TimeFunctionEvaluator(const TimeFunction& function);
  ~TimeFunctionEvaluator();
  TimeFunctionEvaluator(TimeFunctionEvaluator&&) noexcept;
  TimeFunctionEvaluator& operator=(TimeFunctionEvaluator&&) noexcept;

  /// Value at time t [s]. Throws Error(Computation) when it is not finite (1/t at t = 0).
  Real operator()(Real t, const Vec3& place = {});

private:
  std::unique_ptr<ParsedExpression> expression_; // empty: constant
  TimeFunction function_;
};

/// Evaluates a number or an expression of x, y, z [m].
class PlaceFunctionEvaluator
{
public:
  explicit PlaceFunctionEvaluator(const PlaceFunction& function);
  ~PlaceFunctionEvaluator();
  PlaceFunctionEvaluator(PlaceFunctionEvaluator&&) noexcept;
  PlaceFunctionEvaluator& operator=(PlaceFunctionEvaluator&&) noexcept;

  /// Value at a point [m]. Throws Error(Computation) when it is not finite.
  Real operator()(const Vec3& point);

private:
  std::unique_ptr<ParsedExpression> expression_;
  PlaceFunction function_;
};

/// Whether a correct expression of t, x, y, z has one of x, y, z.
bool hasPlace(const std::string& expression);

/// What is wrong with an expression of these variables, with the place in it; empty when it can be
/// evaluated.
std::string expressionProblem(const std::string& expression,
                              const std::vector<std::string>& variables = variablesOfTime);
} // namespace coplane
