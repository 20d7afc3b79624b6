#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_input/Deck.hpp>

#include <memory>
#include <string>

namespace coplane
{
/// Evaluates a number or an expression of t [s], such as 0.05*sin(2*_pi*200*t). The language is
/// that of muParser: + - * / ^, comparisons, a ? b : c, && ||, min max abs sqrt exp ln log10 sin
/// cos tan and their like, the constants _pi and _e. One evaluator serves one thread.
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
  Real operator()(Real t);

private:
  struct Expression;
  std::unique_ptr<Expression> expression_; // empty: constant
  TimeFunction function_;
};

/// What is wrong with an expression of t, with the place in it; empty when it can be evaluated.
std::string expressionProblem(const std::string& expression);
} // namespace coplane
