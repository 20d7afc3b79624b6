#include <coplane_core/StateHash.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <vector>

using namespace coplane;

TEST(StateHash, doesNotDependOnTheOrder)
{
  std::vector<int> order(1000);
  std::iota(order.begin(), order.end(), 1);
  StateHash forward, shuffled;
  for (const int id : order)
    forward.add(1, id, 0, std::sqrt(Real(id)));
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  for (const int id : order)
    shuffled.add(1, id, 0, std::sqrt(Real(id)));
  EXPECT_EQ(forward.part(), shuffled.part());
}

TEST(StateHash, partsOfAnySplitAddUpToTheWhole)
{
  StateHash whole, a, b;
  for (int id = 1; id <= 100; ++id)
  {
    whole.add(1, id, 0, 1.0 / id);
    (id % 3 ? a : b).add(1, id, 0, 1.0 / id);
  }
  EXPECT_EQ(whole.part(), a.part() + b.part());
}

TEST(StateHash, oneChangedBitChangesIt)
{
  StateHash reference;
  reference.add(1, 7, 0, 1.0);
  std::set<std::uint64_t> seen{reference.part()};
  for (int bit = 0; bit < 64; ++bit)
  {
    StateHash changed;
    changed.add(1, 7, 0, std::uint64_t(0x3ff0000000000000) ^ (std::uint64_t(1) << bit));
    EXPECT_TRUE(seen.insert(changed.part()).second) << bit;
  }
}

TEST(StateHash, tellsFieldIdAndComponentApart)
{
  std::set<std::uint64_t> seen;
  for (std::uint64_t what = 0; what < 8; ++what)
    for (GlobalId id = 0; id < 8; ++id)
      for (std::uint64_t component = 0; component < 8; ++component)
      {
        StateHash hash;
        hash.add(what, id, component, 1.0);
        EXPECT_TRUE(seen.insert(hash.part()).second) << what << ' ' << id << ' ' << component;
      }
}

TEST(StateHash, exchangingTheValuesOfTwoNodesChangesIt)
{
  StateHash a, b;
  a.add(1, 1, 0, 2.0);
  a.add(1, 2, 0, 3.0);
  b.add(1, 1, 0, 3.0);
  b.add(1, 2, 0, 2.0);
  EXPECT_NE(a.part(), b.part());
}
