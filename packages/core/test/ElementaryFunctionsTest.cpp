#include <coplane_core/ElementaryFunctions.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <random>
#include <vector>

namespace coplane::testing
{
namespace
{
constexpr Real infinite = std::numeric_limits<Real>::infinity();

/// Distance from the exact value in units in the last place of doubles of its size.
Real unitsOff(Real value, long double exact)
{
  const Real nearest = std::fabs(Real(exact));
  const Real unit = std::nextafter(nearest, infinite) - nearest;
  return Real(std::fabs((static_cast<long double>(value) - exact) / unit));
}

struct Worst
{
  Real units = 0, at = 0;

  void take(Real x, Real value, long double exact)
  {
    if (const Real off = unitsOff(value, exact); !(off <= units))
    {
      units = off;
      at = x;
    }
  }
};

/// The bits of a number stand in every lane, whatever the other lanes hold.
template <class Function>
void expectLanesToBeScalars(const Function& function, const std::vector<Real>& numbers)
{
  for (std::size_t first = 0; first + laneCount <= numbers.size(); ++first)
  {
    const Lanes together =
        function(Lanes([&](auto i) { return numbers[first + std::size_t(int(i))]; }));
    for (int i = 0; i < laneCount; ++i)
    {
      const Real alone = function(numbers[first + std::size_t(i)]), lane = together[i];
      ASSERT_TRUE(alone == lane || (std::isnan(alone) && std::isnan(lane)))
          << numbers[first + std::size_t(i)];
      ASSERT_EQ(std::signbit(alone), std::signbit(lane)) << numbers[first + std::size_t(i)];
    }
  }
}

const std::vector<Real> oddNumbers{0.0,
                                   -0.0,
                                   1.0,
                                   -1.0,
                                   5e-324,
                                   1e-310,
                                   2.2250738585072014e-308,
                                   1e-20,
                                   0.70710678118654746,
                                   0.70710678118654757,
                                   1.4142135623730951,
                                   708.0,
                                   709.78,
                                   709.782712893384,
                                   709.7828,
                                   -708.0,
                                   -740.0,
                                   -745.13,
                                   -745.2,
                                   1e300,
                                   -1e300,
                                   infinite,
                                   -infinite,
                                   std::numeric_limits<Real>::quiet_NaN(),
                                   std::numeric_limits<Real>::max(),
                                   0.5,
                                   3.0};

constexpr int draws = 400000;

/// The worst of function(x), x = numberAt(draw) with draws between -range and range.
template <class NumberAt, class Function, class Exact>
Worst worstOver(std::initializer_list<Real> ranges, const NumberAt& numberAt,
                const Function& function, const Exact& exact)
{
  std::mt19937_64 random(1);
  Worst worst;
  for (const Real range : ranges)
  {
    std::uniform_real_distribution<Real> draw(-range, range);
    for (int i = 0; i < draws; ++i)
    {
      const Real x = numberAt(draw(random));
      worst.take(x, function(x), exact(static_cast<long double>(x)));
    }
  }
  return worst;
}
} // namespace

TEST(ElementaryFunctions, exponentialIsExactToOneUnitInTheLastPlace)
{
  const Worst worst = worstOver(
      {1e-8, 0.4, 5.0, 700.0}, [](Real draw) { return draw; },
      [](Real x) { return branchFree::exponential(x); }, [](long double x) { return std::exp(x); });
  EXPECT_LT(worst.units, 1.0) << worst.at;
  RecordProperty("unitsOff", std::to_string(worst.units));
}

TEST(ElementaryFunctions, exponentialEndsAsThatOfTheLibraryDoes)
{
  EXPECT_EQ(branchFree::exponential(0.0), 1.0);
  EXPECT_EQ(branchFree::exponential(infinite), infinite);
  EXPECT_EQ(branchFree::exponential(-infinite), 0.0);
  EXPECT_EQ(branchFree::exponential(710.0), infinite);
  EXPECT_EQ(branchFree::exponential(-746.0), 0.0);
  EXPECT_NEAR(branchFree::exponential(709.7) / std::exp(709.7), 1, 1e-15);
  EXPECT_TRUE(std::isnan(branchFree::exponential(std::numeric_limits<Real>::quiet_NaN())));
  for (const Real x : {-709.0, -720.0, -744.0}) // few bits are left
    EXPECT_NEAR(branchFree::exponential(x), std::exp(x), 5e-324) << x;
}

TEST(ElementaryFunctions, logarithmIsExactToOneUnitInTheLastPlace)
{
  Worst worst = worstOver(
      {1e-6, 0.6, 40.0, 700.0}, [](Real draw) { return std::exp(draw); },
      [](Real x) { return branchFree::logarithm(x); }, [](long double x) { return std::log(x); });
  for (Real x = 1e-323; x < 1e-300; x *= 1.7)
    worst.take(x, branchFree::logarithm(x), std::log(static_cast<long double>(x)));
  EXPECT_LT(worst.units, 1.0) << worst.at;
  RecordProperty("unitsOff", std::to_string(worst.units));
}

TEST(ElementaryFunctions, logarithmEndsAsThatOfTheLibraryDoes)
{
  EXPECT_EQ(branchFree::logarithm(1.0), 0.0);
  EXPECT_EQ(branchFree::logarithm(0.0), -infinite);
  EXPECT_EQ(branchFree::logarithm(-0.0), -infinite);
  EXPECT_EQ(branchFree::logarithm(infinite), infinite);
  EXPECT_TRUE(std::isnan(branchFree::logarithm(-1.0)));
  EXPECT_TRUE(std::isnan(branchFree::logarithm(-infinite)));
  EXPECT_TRUE(std::isnan(branchFree::logarithm(std::numeric_limits<Real>::quiet_NaN())));
}

TEST(ElementaryFunctions, cosineOfThirdSolvesItsCubic)
{
  std::mt19937_64 random(3);
  Worst worst;
  std::uniform_real_distribution<Real> draw(-1, 1), exponent(-35, 0);
  const auto take = [&](Real c)
  {
    worst.take(c, branchFree::cosineOfThird(c),
               std::cos(std::acos(static_cast<long double>(c)) / 3));
  };
  for (int i = 0; i < draws; ++i)
  {
    take(draw(random));
    take(std::exp(exponent(random)) - 1); // where two principal values meet
    take(1 - std::exp(exponent(random)));
  }
  EXPECT_LT(worst.units, 2.0) << worst.at;
  RecordProperty("unitsOff", std::to_string(worst.units));
  EXPECT_EQ(branchFree::cosineOfThird(-1.0), 0.5);
  EXPECT_EQ(branchFree::cosineOfThird(1.0), 1.0);
  EXPECT_EQ(branchFree::cosineOfThird(-1.5), 0.5);
  EXPECT_EQ(branchFree::cosineOfThird(1.5), 1.0);
  EXPECT_EQ(branchFree::cosineOfThird(std::numeric_limits<Real>::quiet_NaN()), 1.0);
}

TEST(ElementaryFunctions, haveTheSameBitsInEveryLane)
{
  std::vector<Real> numbers = oddNumbers;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<Real> draw(-750, 750), small(-1, 1);
  for (int i = 0; i < 20000; ++i)
  {
    numbers.push_back(draw(random));
    numbers.push_back(small(random));
  }
  expectLanesToBeScalars([](const auto& x) { return branchFree::exponential(x); }, numbers);
  expectLanesToBeScalars([](const auto& x) { return branchFree::logarithm(x); }, numbers);
  expectLanesToBeScalars([](const auto& x) { return branchFree::cosineOfThird(x); }, numbers);
}
} // namespace coplane::testing
