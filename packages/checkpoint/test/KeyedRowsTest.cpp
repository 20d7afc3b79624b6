#include "Sample.hpp"

#include <gtest/gtest.h>

namespace coplane
{
TEST(SortedOverRanks, standInTheOrderOfTheirKeysOneRankAfterTheOther)
{
  const Comm comm;
  const KeyedRows sorted = sortedOverRanks(sampleRows(comm, 50), comm);
  const std::vector<GlobalId> keys = comm.allGather(sorted.keys);
  const std::vector<Real> numbers = comm.allGather(sorted.numbers);
  ASSERT_EQ(keys.size(), 50u);
  ASSERT_EQ(numbers.size(), 100u);
  for (int i = 0; i < 50; ++i)
  {
    EXPECT_EQ(keys[std::size_t(i)], 7 * i - 20);
    EXPECT_EQ(numbers[std::size_t(2 * i)], 1.0 / (i + 1));
  }
}

TEST(SortedOverRanks, sortsKeysOfTwoIdsByTheFirstThenTheSecond)
{
  const Comm comm;
  const KeyedRows sorted = sortedOverRanks(samplePairs(comm, 12), comm);
  const std::vector<GlobalId> keys = comm.allGather(sorted.keys);
  ASSERT_EQ(keys.size(), 24u);
  for (std::size_t i = 0; i < 12; ++i)
  {
    EXPECT_EQ(keys[2 * i], GlobalId(i / 3));
    EXPECT_EQ(keys[2 * i + 1], GlobalId(8 + i % 3));
  }
}

TEST(SortedOverRanks, givesEveryRankAShareWhenAllRowsComeFromOne)
{
  const Comm comm;
  KeyedRows rows;
  rows.columns = {"a"};
  for (int i = 0; i < 1000 && comm.isRoot(); ++i)
    rows.add({i});
  const std::size_t mine = sortedOverRanks(rows, comm).count();
  EXPECT_GT(mine, 500u / std::size_t(comm.size()));
  EXPECT_LT(mine, 2000u / std::size_t(comm.size()) + 1);
}

TEST(SortedOverRanks, withoutRowsIsEmpty)
{
  const Comm comm;
  EXPECT_EQ(sortedOverRanks(KeyedRows{}, comm).count(), 0u);
}

TEST(SortedOverRanks, refusesAKeyThatIsThereTwice)
{
  const Comm comm;
  KeyedRows rows;
  rows.columns = {"a"};
  rows.add({comm.rank()});
  if (comm.rank() == comm.size() - 1)
    rows.add({0});
  EXPECT_THROW(sortedOverRanks(rows, comm), Error);
}
} // namespace coplane
