#include <coplane_core/ExactSum.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace coplane;

namespace
{
Real sumOf(const std::vector<Real>& terms)
{
  ExactSum sum;
  for (const Real term : terms)
    sum.add(term);
  return sum.value();
}

/// Terms of both signs over 600 binary orders of magnitude.
std::vector<Real> wildTerms(int count, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<Real> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-300, 300);
  std::vector<Real> terms(count);
  for (Real& term : terms)
    term = std::ldexp(mantissa(random), exponent(random));
  return terms;
}
} // namespace

TEST(ExactSum, isZeroWithoutTerms)
{
  EXPECT_EQ(ExactSum().value(), 0.0);
}

TEST(ExactSum, returnsASingleTermUnchanged)
{
  const std::vector<Real> terms = {1.0,
                                   -1.0,
                                   .1,
                                   -1e300,
                                   std::numeric_limits<Real>::max(),
                                   3e-308,
                                   1e-5,
                                   -0x1p-60,
                                   0x1.fffffffffffffp-1};
  for (const Real term : terms)
    EXPECT_EQ(sumOf({term}), term);
}

TEST(ExactSum, keepsASmallTermBetweenTwoThatCancel)
{
  EXPECT_EQ(sumOf({1e300, 1, -1e300}), 1.0);
  EXPECT_EQ(sumOf({-1e300, -1, 1e300}), -1.0);
  EXPECT_EQ(sumOf({std::numeric_limits<Real>::max(), 5e-324, -std::numeric_limits<Real>::max()}),
            5e-324);
}

TEST(ExactSum, addsSubnormalNumbers)
{
  const Real least = std::numeric_limits<Real>::denorm_min();
  EXPECT_EQ(sumOf({least}), least);
  EXPECT_EQ(sumOf({least, least, least}), 3 * least);
  EXPECT_EQ(sumOf({-least, 4 * least}), 3 * least);
  // The border between subnormal and normal.
  const Real smallest = std::numeric_limits<Real>::min();
  EXPECT_EQ(sumOf({smallest, -least}), smallest - least);
}

TEST(ExactSum, passesThroughTheLargestNumberOnTheWay)
{
  const Real most = std::numeric_limits<Real>::max();
  EXPECT_EQ(sumOf({most, most, -most}), most) << "2 max is no double, the sum is";
  EXPECT_EQ(sumOf({most, most}), infinity);
}

TEST(ExactSum, notANumberAndInfinityMakeItNotANumber)
{
  EXPECT_TRUE(std::isnan(sumOf({1, std::nan(""), 2})));
  EXPECT_TRUE(std::isnan(sumOf({1, infinity})));
}

TEST(ExactSum, doesNotDependOnTheOrder)
{
  std::vector<Real> terms = wildTerms(10000, 1);
  const Real reference = sumOf(terms);
  std::mt19937 random(2);
  for (int n = 0; n < 20; ++n)
  {
    std::shuffle(terms.begin(), terms.end(), random);
    EXPECT_EQ(sumOf(terms), reference);
  }
}

TEST(ExactSum, termsAndTheirNegativesCancelToZero)
{
  std::vector<Real> terms = wildTerms(2000, 3);
  const std::size_t half = terms.size();
  for (std::size_t i = 0; i < half; ++i)
    terms.push_back(-terms[i]);
  std::shuffle(terms.begin(), terms.end(), std::mt19937(4));
  EXPECT_EQ(sumOf(terms), 0.0);
}

TEST(ExactSum, isWithinOneUnitInTheLastPlaceOfTheExactSum)
{
  // Whole numbers times 2^-40: __int128 holds the exact sum.
  std::mt19937_64 random(5);
  for (int n = 0; n < 1000; ++n)
  {
    __int128 exact = 0;
    ExactSum sum;
    for (int i = 0; i < 20; ++i)
    {
      const std::int64_t whole = std::int64_t(random()) >> 11; // 53 bits: a double
      const int shift = int(random() % 60);
      exact += __int128(whole) * (__int128(1) << shift);
      sum.add(std::ldexp(Real(whole), shift - 40));
    }
    const Real rounded = std::ldexp(Real(exact), -40);
    EXPECT_LE(std::abs(sum.value() - rounded), std::abs(rounded) * epsilon);
  }
}

TEST(ExactSum, sumOfSumsIsTheSumOfAllTerms)
{
  const std::vector<Real> terms = wildTerms(999, 6);
  ExactSum parts[3], total;
  for (std::size_t i = 0; i < terms.size(); ++i)
    parts[i % 3].add(terms[i]);
  for (const ExactSum& part : parts)
    total.add(part);
  EXPECT_EQ(total.value(), sumOf(terms));
}

TEST(ExactSum, overRanksHasTheBitsOfOneRank)
{
  // rank 0: terms 0, n, 2n, ...   rank 1: terms 1, n + 1, ...   n = number of ranks
  const Comm comm;
  const std::vector<Real> first = wildTerms(1000, 7), second = wildTerms(1000, 8);
  std::vector<ExactSum> mine(2);
  for (std::size_t i = comm.rank(); i < first.size(); i += comm.size())
  {
    mine[0].add(first[i]);
    mine[1].add(second[i]);
  }
  const std::vector<Real> total = ExactSum::overRanks(mine, comm);
  ASSERT_EQ(total.size(), 2u);
  EXPECT_EQ(total[0], sumOf(first));
  EXPECT_EQ(total[1], sumOf(second));
}

TEST(ExactSum, notANumberOnOneRankIsSeenOnAll)
{
  const Comm comm;
  std::vector<ExactSum> mine(1);
  mine[0].add(comm.rank() == comm.size() - 1 ? std::nan("") : 1.0);
  EXPECT_TRUE(std::isnan(ExactSum::overRanks(mine, comm)[0]));
}

TEST(ExactSumDigits, bringBackTheExactSum)
{
  // 1e300 + 1e-300 - 1e300 is 1e-300 only if nothing is lost on the way.
  for (const std::vector<Real>& values :
       {std::vector<Real>{1e300, 1e-300}, {-1e300, -1e-300, 3.5}, {-0.1}, {}})
  {
    ExactSum sum;
    Real rest = 0; // exact: at most one term is left but for tiny ones
    for (const Real value : values)
    {
      sum.add(value);
      rest += std::abs(value) > 1e100 ? 0 : value;
    }
    ExactSum again = ExactSum::fromDigits(sum.digits().data());
    EXPECT_EQ(again.value(), sum.value());
    for (const Real value : values)
      if (std::abs(value) > 1e100)
        again.add(-value);
    EXPECT_EQ(again.value(), rest);
  }
}

TEST(ExactSumDigits, keepThatATermWasNotFinite)
{
  ExactSum sum;
  sum.add(infinity);
  EXPECT_TRUE(std::isnan(ExactSum::fromDigits(sum.digits().data()).value()));
}

TEST(ExactSumTotals, areExactOverRanks)
{
  // Every rank adds 1e300 and 2^-40; without 1e300 the small terms are there.
  const Comm comm;
  std::vector<ExactSum> mine(1);
  mine[0].add(1e300);
  mine[0].add(std::ldexp(1.0, -40));
  ExactSum total = ExactSum::totals(mine, comm)[0];
  for (int r = 0; r < comm.size(); ++r)
    total.add(-1e300);
  EXPECT_EQ(total.value(), comm.size() * std::ldexp(1.0, -40));
}
