#include <coplane_core/OrderStatistics.hpp>

#include <gtest/gtest.h>

namespace coplane
{
TEST(OrderStatistics, areThoseOfTheSortedValuesOfAllRanks)
{
  // -5, -4, ..., 5 dealt out to the ranks in turn: 11 values, so that p of them are p * 11 rounded
  // up; the least number that 3 of 11 do not exceed is -3.
  const Comm comm;
  std::vector<Real> mine;
  for (int i = -5; i <= 5; ++i)
    if ((i + 5) % comm.size() == comm.rank())
      mine.push_back(i);
  const std::vector<Real> expected{-5, -3, 0, 3, 5};
  EXPECT_EQ(orderStatistics(mine, {0, 0.25, 0.5, 0.75, 1}, comm), expected);
}

TEST(OrderStatistics, areValuesToTheLastBitAlsoOnOneRankOfMany)
{
  const Comm comm;
  std::vector<Real> mine;
  if (comm.isRoot())
    mine = {1.0 / 3, -1e-300, 0.0, 7e200};
  const std::vector<Real> expected{-1e-300, 1.0 / 3, 7e200};
  EXPECT_EQ(orderStatistics(mine, {0.25, 0.75, 1}, comm), expected);
}

TEST(OrderStatistics, ofNothingAreNone)
{
  EXPECT_TRUE(orderStatistics({}, {0.5}, Comm()).empty());
}
} // namespace coplane
