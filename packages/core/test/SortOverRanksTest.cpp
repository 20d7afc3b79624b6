#include <coplane_core/SortOverRanks.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
struct Item
{
  std::int64_t key;
  int rank;
};
std::int64_t keyOf(const Item& item)
{
  return item.key;
}

/// Sorted over the ranks and gathered: what one rank would get by sorting.
void expectSorted(const std::vector<Item>& mine, const Comm& comm)
{
  const KeyRanges ranges(mine, keyOf, comm);
  const std::vector<Item> sorted = sortOverRanks(mine, keyOf, ranges, comm);
  for (const Item& item : sorted)
    EXPECT_EQ(ranges.rankOf(item.key), comm.rank());
  std::vector<Item> expected = comm.allGather(mine);
  std::stable_sort(expected.begin(), expected.end(),
                   [](const Item& a, const Item& b) { return a.key < b.key; });
  const std::vector<Item> all = comm.allGather(sorted);
  ASSERT_EQ(all.size(), expected.size());
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    EXPECT_EQ(all[i].key, expected[i].key);
    EXPECT_EQ(all[i].rank, expected[i].rank);
  }
  const Share share(sorted.size(), comm);
  EXPECT_EQ(share.total, std::int64_t(expected.size()));
  if (!sorted.empty())
  {
    EXPECT_EQ(all[std::size_t(share.before)].key, sorted[0].key);
  }
}
} // namespace

TEST(SortOverRanks, isThatOfOneRank)
{
  const Comm comm;
  std::vector<Item> mine;
  for (int i = 0; i < 50; ++i)
    mine.push_back({(i * 37 + comm.rank() * 11) % 83 - 20, comm.rank()});
  expectSorted(mine, comm);
}

TEST(SortOverRanks, takesTheWholeRangeOfKeysAndRanksWithoutAny)
{
  const Comm comm;
  std::vector<Item> mine;
  if (comm.rank() == comm.size() - 1)
    mine = {{INT64_MAX, 1}, {INT64_MIN, 2}, {0, 3}};
  expectSorted(mine, comm);
  expectSorted({}, comm);
}

TEST(SortOverRanks, equalKeysStayInTheOrderOfRanks)
{
  const Comm comm;
  expectSorted({{5, comm.rank()}, {5, comm.rank() + 100}}, comm);
}
} // namespace coplane
