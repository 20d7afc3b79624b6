#include <coplane_mesh/ContiguousRange.hpp>

#include <gtest/gtest.h>

namespace coplane
{
TEST(ContiguousRange, dealsEveryItemOnceInOrder)
{
  for (int ranks = 1; ranks <= 7; ++ranks)
    for (int n = 0; n <= 20; ++n)
    {
      int next = 0;
      for (int r = 0; r < ranks; ++r)
      {
        const IndexRange range = contiguousRange(n, r, ranks);
        EXPECT_EQ(range.first, next) << n << " items, rank " << r << " of " << ranks;
        next += range.count;
      }
      EXPECT_EQ(next, n);
    }
}

TEST(ContiguousRange, sizesDifferByAtMostOneAndTheLongerComeFirst)
{
  // 11 items on 4 ranks: 3 3 3 2.
  const int expected[] = {3, 3, 3, 2};
  for (int r = 0; r < 4; ++r)
    EXPECT_EQ(contiguousRange(11, r, 4).count, expected[r]);
}

TEST(ContiguousRange, ranksBeyondTheItemsAreEmpty)
{
  EXPECT_EQ(contiguousRange(2, 2, 4).count, 0);
  EXPECT_EQ(contiguousRange(2, 3, 4).count, 0);
}

TEST(RankOfItem, isTheRankWhoseRangeHoldsTheItem)
{
  for (int ranks = 1; ranks <= 7; ++ranks)
    for (int n = 1; n <= 20; ++n)
      for (int r = 0; r < ranks; ++r)
      {
        const IndexRange range = contiguousRange(n, r, ranks);
        for (int i = range.first; i < range.first + range.count; ++i)
          EXPECT_EQ(rankOfItem(i, n, ranks), r) << n << " items, " << ranks << " ranks";
      }
}
} // namespace coplane
