#include "Sample.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace coplane
{
namespace
{
bool sameBits(const std::vector<Real>& a, const std::vector<Real>& b)
{
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Real)) == 0);
}
} // namespace

TEST(StateTables, giveInMemoryWhatACheckpointGives)
{
  const Comm comm;
  const TestFolder folder(comm);
  const CheckpointWriter tables = sample(comm);
  tables.write(folder / "a.chk", 1, 0);
  const CheckpointReader file(folder / "a.chk", comm);
  const StateSource* sources[] = {&tables, &file};
  std::vector<GlobalId> wanted;
  for (int i = comm.rank(); i < 100; i += 3)
    wanted.push_back(7 * ((i * 37) % 100) - 20);
  KeyedRows rows[2];
  for (int s = 0; s < 2; ++s)
    rows[s] = sources[s]->rowsOf("nodes", {"a", "b"}, wanted);
  EXPECT_EQ(rows[0].keys, rows[1].keys);
  EXPECT_TRUE(sameBits(rows[0].numbers, rows[1].numbers));
  for (const char* name : {"nodes", "contact/planes", "elements/block_7"})
    EXPECT_EQ(tables.rowCount(name), file.rowCount(name));
  for (const char* name : {"solver/numbers", "none"})
    EXPECT_TRUE(sameBits(sources[0]->numbers(name), sources[1]->numbers(name)));
  for (const char* name : {"deck", "empty"})
    EXPECT_EQ(sources[0]->text(name), sources[1]->text(name));
  for (const char* name : {"contact/planes/keys", "contact/faces/keys", "deck", "none", "nodes"})
    EXPECT_EQ(sources[0]->has(name), sources[1]->has(name)) << name;
  EXPECT_EQ(comm.sum(std::int64_t(tables.part("contact/planes", {"c"}).count())), 100);
}

TEST(StateTables, findRowsWhereSomeRanksHaveNone)
{
  // All keys are the same few: ranks in the middle get no part of the table.
  const Comm comm;
  StateTables tables(comm);
  KeyedRows rows;
  rows.columns = {"value"};
  if (comm.isRoot())
    for (const GlobalId key : {3, 1})
      rows.add({key})[0] = Real(10 * key);
  tables.rows("few", rows);
  const KeyedRows found = tables.rowsOf("few", {"value"}, {3, 1, 3});
  EXPECT_EQ(found.numbers, (std::vector<Real>{30, 10, 30}));
}

TEST(StateTables, tellOfNumbersWhatRankZeroSaid)
{
  const Comm comm;
  StateTables tables(comm);
  tables.numbers("rank", {Real(comm.rank() + 5)});
  tables.text("rank", std::to_string(comm.rank()));
  EXPECT_EQ(tables.numbers("rank"), std::vector<Real>{5});
  EXPECT_EQ(tables.text("rank"), "0");
}

TEST(StateTables, refuseWhatIsNotThere)
{
  const Comm comm;
  StateTables tables(comm);
  KeyedRows rows;
  rows.columns = {"a"};
  if (comm.isRoot())
    rows.add({1});
  tables.rows("one", rows);
  EXPECT_THROW(tables.part("two", {"a"}), Error);
  EXPECT_THROW(tables.part("one", {"b"}), Error);
  EXPECT_THROW(tables.rowsOf("one", {"a"}, {2}), Error);
  EXPECT_THROW(tables.numbers("one"), Error);
  EXPECT_THROW(tables.text("one"), Error);
}
} // namespace coplane
