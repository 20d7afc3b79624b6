#include <coplane_contact/detail/RadixSort.hpp>

#include <gtest/gtest.h>

#include <random>

namespace coplane
{
TEST(RadixSort, sortsAndKeepsTheOrderOfEquals)
{
  struct Item
  {
    std::uint64_t code;
    int place;
  };
  for (const int bits : {0, 1, 5, 11, 12, 23, 40, 63})
    for (const int count : {0, 1, 255, 256, 1000, 30000})
    {
      std::mt19937_64 random(bits);
      std::vector<Item> items(count);
      for (int i = 0; i < count; ++i)
        items[i] = {bits == 0 ? 0 : random() >> (64 - bits), i};
      std::vector<Item> expected = items;
      std::stable_sort(expected.begin(), expected.end(),
                       [](const Item& a, const Item& b) { return a.code < b.code; });
      radixSort(items, bits, [](const Item& item) { return item.code; });
      for (int i = 0; i < count; ++i)
      {
        ASSERT_EQ(items[i].code, expected[i].code) << bits << " bits, " << count << " items";
        ASSERT_EQ(items[i].place, expected[i].place) << bits << " bits, " << count << " items";
      }
    }
}
} // namespace coplane
