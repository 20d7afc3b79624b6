#include <coplane_core/Error.hpp>
#include <coplane_schema/TimeFunctionEvaluator.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace coplane
{
namespace
{
TimeFunction expression(const std::string& text)
{
  TimeFunction function;
  function.expression = text;
  function.where = "wall.yaml:7:3";
  return function;
}

TEST(TimeFunctionEvaluator, aNumberIsTheSameAtAllTimes)
{
  TimeFunction function;
  function.constant = 3;
  TimeFunctionEvaluator evaluate(function);
  EXPECT_EQ(evaluate(0), 3);
  EXPECT_EQ(evaluate(5), 3);
}

TEST(TimeFunctionEvaluator, aTableHasStraightLinesBetweenItsPointsAndIsConstantOutside)
{
  TimeFunction table;
  table.times = {1, 2, 4};
  table.values = {10, 20, -20};
  TimeFunctionEvaluator evaluate(table);
  EXPECT_EQ(evaluate(0), 10);
  EXPECT_EQ(evaluate(1), 10);
  EXPECT_EQ(evaluate(1.5), 15);
  EXPECT_EQ(evaluate(2), 20);
  EXPECT_EQ(evaluate(3), 0);
  EXPECT_EQ(evaluate(4), -20);
  EXPECT_EQ(evaluate(9), -20);
}

TEST(TimeFunctionEvaluator, mayVaryWithThePlaceToo)
{
  TimeFunction function = expression("t*(x + 10*y + 100*z)");
  function.ofPlace = true;
  TimeFunctionEvaluator evaluate(function);
  EXPECT_EQ(evaluate(2, {1, 2, 3}), 642);
  EXPECT_TRUE(hasPlace("t + y"));
  EXPECT_FALSE(hasPlace("exp(t)"));
}

TEST(TimeFunctionEvaluator, followsTheTime)
{
  TimeFunctionEvaluator evaluate(expression("1e5*min(t/0.01,1)"));
  EXPECT_DOUBLE_EQ(evaluate(0.005), 5e4); // half way up the ramp
  EXPECT_EQ(evaluate(2), 1e5);            // on the plateau
}

TEST(TimeFunctionEvaluator, knowsPi)
{
  TimeFunctionEvaluator evaluate(expression("sin(2*_pi*200*t)"));
  EXPECT_NEAR(evaluate(0.00125), 1, 4 * epsilon); // a quarter of the period 1/200 s
}

TEST(PlaceFunctionEvaluator, followsThePlace)
{
  PlaceFunctionEvaluator evaluate(expression("x + 10*y + 100*z"));
  EXPECT_EQ(evaluate({1, 2, 3}), 321);
  TimeFunction three;
  three.constant = 3;
  EXPECT_EQ(PlaceFunctionEvaluator(three)({1, 2, 3}), 3);
}

TEST(TimeFunctionEvaluator, stillWorksAfterItWasMoved)
{
  TimeFunctionEvaluator first(expression("2*t"));
  TimeFunctionEvaluator second(std::move(first));
  EXPECT_EQ(second(4), 8);
}

TEST(TimeFunctionEvaluator, aValueThatIsNotFiniteIsAnError)
{
  TimeFunctionEvaluator evaluate(expression("1/t"));
  try
  {
    evaluate(0);
    FAIL() << "no error";
  }
  catch (const Error& e)
  {
    EXPECT_EQ(e.code(), ExitCode::Computation);
    EXPECT_STREQ(e.what(), "wall.yaml:7:3: '1/t' is inf at t = 0 s, which is not a finite number. "
                           "Change the expression, for example with max(t, 1e-9) where it divides "
                           "by t.");
  }
}

TEST(ExpressionProblem, isEmptyForAGoodExpression)
{
  EXPECT_EQ(expressionProblem("t < 0.1 ? 1 : exp(-t)"), "");
  EXPECT_EQ(expressionProblem("t >= 1 && t != 2 && t == 3"), "");
}

TEST(ExpressionProblem, namesWhatIsNotKnown)
{
  EXPECT_EQ(expressionProblem("2*x"), "Unexpected token \"x\" found at character 3");
}

TEST(ExpressionProblem, refusesToSetTheTime)
{
  EXPECT_EQ(expressionProblem("t=3"), "'=' at character 2 would set a variable; compare with ==");
}

TEST(ExpressionProblem, refusesTwoValues)
{
  EXPECT_EQ(expressionProblem("1, 2"), "it gives 2 values where one is needed");
}
} // namespace
} // namespace coplane
