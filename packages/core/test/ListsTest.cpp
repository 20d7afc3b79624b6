#include <coplane_core/Lists.hpp>

#include <gtest/gtest.h>

#include <utility>

namespace coplane
{
namespace
{
template <class Entry>
std::vector<Entry> copyOf(const Stretch<Entry>& stretch)
{
  return {stretch.begin(), stretch.end()};
}
} // namespace

TEST(Lists, entriesKeepTheirOrderAndListsMayBeEmpty)
{
  const std::vector<std::pair<int, char>> said{{2, 'a'}, {0, 'b'}, {2, 'c'}, {4, 'd'}, {2, 'b'}};
  const Lists<char> lists(6,
                          [&](const auto& visit)
                          {
                            for (const auto& [list, entry] : said)
                              visit(std::size_t(list), entry);
                          });
  ASSERT_EQ(lists.count(), 6u);
  EXPECT_EQ(copyOf(lists[0]), std::vector<char>{'b'});
  EXPECT_EQ(copyOf(lists[1]), std::vector<char>{});
  EXPECT_EQ(copyOf(lists[2]), (std::vector<char>{'a', 'c', 'b'}));
  EXPECT_EQ(copyOf(lists[3]), std::vector<char>{});
  EXPECT_EQ(copyOf(lists.view()[4]), std::vector<char>{'d'});
  EXPECT_EQ(copyOf(lists[5]), std::vector<char>{});
  EXPECT_EQ(lists.entries(), (std::vector<char>{'b', 'a', 'c', 'b', 'd'}));
}

TEST(Lists, withoutListsThereIsNothing)
{
  EXPECT_EQ(Lists<int>().count(), 0u);
  EXPECT_EQ(Lists<int>(0, [](const auto&) {}).count(), 0u);
  EXPECT_TRUE(Lists<int>(3, [](const auto&) {}).entries().empty());
}
} // namespace coplane
