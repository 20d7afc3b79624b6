#include <coplane_core/Comm.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <new>
#include <vector>

using namespace coplane;

TEST(Comm_Reductions, leastGreatestAndSumOverRanks)
{
  const Comm comm;
  const int n = comm.size();
  EXPECT_EQ(comm.min(Real(comm.rank())), 0.0);
  EXPECT_EQ(comm.max(Real(comm.rank())), n - 1.0);
  EXPECT_EQ(comm.sum(std::int64_t(comm.rank() + 1)), n * (n + 1) / 2);
}

TEST(Comm_Reductions, unsignedSumsWrapAround)
{
  const Comm comm;
  std::vector<std::uint64_t> values{comm.rank() == 0 ? ~std::uint64_t(0) : 0, 1};
  comm.sum(values);
  EXPECT_EQ(values[0], ~std::uint64_t(0));
  EXPECT_EQ(values[1], std::uint64_t(comm.size()));
}

TEST(Comm_Broadcast, everyRankGetsTheTextOfTheRoot)
{
  const Comm comm;
  const int last = comm.size() - 1;
  EXPECT_EQ(comm.broadcast(comm.rank() == last ? "from the last" : "no", last), "from the last");
  EXPECT_EQ(comm.broadcast("", last), "");
}

TEST(Comm_AllGather, concatenatesInTheOrderOfRanks)
{
  // rank r holds r items of value r: 1 | 2 2 | 3 3 3, and nothing on rank 0.
  const Comm comm;
  const std::vector<int> all = comm.allGather(std::vector<int>(comm.rank(), comm.rank()));
  std::vector<int> expected;
  for (int r = 0; r < comm.size(); ++r)
    expected.insert(expected.end(), r, r);
  EXPECT_EQ(all, expected);
}

TEST(Comm_Exchange, everyRankGetsWhatIsMeantForIt)
{
  // Rank s sends s + 1 items (s, r) to rank r, but nothing to itself.
  struct Item
  {
    int from, to;
  };
  const Comm comm;
  std::vector<std::vector<Item>> toRank(comm.size());
  for (int r = 0; r < comm.size(); ++r)
    if (r != comm.rank())
      toRank[r].assign(comm.rank() + 1, Item{comm.rank(), r});
  std::vector<int> counts;
  const std::vector<Item> got = comm.exchange(toRank, &counts);
  ASSERT_EQ(int(counts.size()), comm.size());
  std::size_t at = 0;
  for (int s = 0; s < comm.size(); ++s)
  {
    EXPECT_EQ(counts[s], s == comm.rank() ? 0 : s + 1);
    for (int i = 0; i < counts[s]; ++i, ++at)
    {
      ASSERT_LT(at, got.size());
      EXPECT_EQ(got[at].from, s);
      EXPECT_EQ(got[at].to, comm.rank());
    }
  }
  EXPECT_EQ(at, got.size());
}

TEST(Comm_Together, doesNothingWhenNoRankFails)
{
  const Comm comm;
  int runs = 0;
  EXPECT_NO_THROW(comm.together([&] { ++runs; }));
  EXPECT_EQ(runs, 1);
}

TEST(Comm_Together, allRanksThrowTheErrorOfTheOnlyRankThatFailed)
{
  const Comm comm;
  const int last = comm.size() - 1;
  try
  {
    comm.together(
        [&]
        {
          if (comm.rank() == last)
            fail(ExitCode::Mesh, "side {} is missing", 7);
        });
    FAIL() << "nothing was thrown on rank " << comm.rank();
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Mesh);
    EXPECT_STREQ(error.what(), "side 7 is missing");
  }
}

TEST(Comm_Together, allRanksThrowTheErrorOfTheLowestRankThatFailed)
{
  //  rank   0    1     2     3
  //  error  -  Deck  Deck  Deck        (rank 0 fails alone when there is only one)
  const Comm comm;
  const int lowest = comm.size() > 1 ? 1 : 0;
  try
  {
    comm.together(
        [&]
        {
          if (comm.rank() >= lowest)
            fail(ExitCode::Deck, "rank {}", comm.rank());
        });
    FAIL() << "nothing was thrown on rank " << comm.rank();
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Deck);
    EXPECT_EQ(error.what(), "rank " + std::to_string(lowest));
  }
}

TEST(Comm_Together, otherExceptionsBecomeInternalErrors)
{
  const Comm comm;
  try
  {
    comm.together(
        [&]
        {
          if (comm.isRoot())
            throw std::out_of_range("beyond the end");
        });
    FAIL() << "nothing was thrown on rank " << comm.rank();
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Internal);
    EXPECT_STREQ(error.what(), "beyond the end (a defect of the program: please report it)");
  }
}

TEST(Comm_Together, whatTheMachineDoesNotGiveIsNoDefect)
{
  const Comm comm;
  const auto codeOn = [&](const std::function<void()>& failing)
  {
    try
    {
      comm.together(
          [&]
          {
            if (comm.rank() == comm.size() - 1)
              failing();
          });
    }
    catch (const Error& error)
    {
      EXPECT_TRUE(error.onAllRanks());
      return error.code();
    }
    return ExitCode::Success;
  };
  EXPECT_EQ(codeOn([] { throw std::bad_alloc(); }), ExitCode::Machine);
  EXPECT_EQ(codeOn([] { std::vector<int>().reserve(std::size_t(-1)); }), ExitCode::Machine);
  EXPECT_EQ(codeOn([] { std::filesystem::directory_iterator("/no/such/folder"); }),
            ExitCode::Output);
}

TEST(Comm_DemandSame, namesTheFirstRankThatDiffers)
{
  const Comm comm;
  EXPECT_NO_THROW(comm.demandSame("the deck", "one text", ExitCode::Deck));
  if (comm.size() == 1)
    return;
  try
  {
    comm.demandSame("the deck", comm.rank() == 0 ? "a" : "b", ExitCode::Deck);
    FAIL() << "nothing was thrown on rank " << comm.rank();
  }
  catch (const Error& error)
  {
    EXPECT_TRUE(error.onAllRanks());
    EXPECT_EQ(error.code(), ExitCode::Deck);
    EXPECT_NE(std::string(error.what()).find("that of rank 1 is\n  b"), std::string::npos);
  }
}

TEST(Comm, aRankAloneNeedsNobody)
{
  const Comm alone = Comm::alone();
  EXPECT_EQ(alone.rank(), 0);
  EXPECT_EQ(alone.size(), 1);
  EXPECT_EQ(alone.min(3.5), 3.5);
  EXPECT_EQ(alone.sum(std::int64_t(7)), 7);
  std::vector<std::int64_t> values{1, 2};
  alone.sum(values);
  EXPECT_EQ(values, (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(alone.broadcast("text"), "text");
  EXPECT_EQ(alone.allGather(std::vector<int>{4, 5}), (std::vector<int>{4, 5}));
  std::vector<int> counts;
  EXPECT_EQ(alone.exchange<int>({{6, 7, 8}}, &counts), (std::vector<int>{6, 7, 8}));
  EXPECT_EQ(counts, std::vector<int>{3});
  alone.barrier();
  try
  {
    alone.together([] { fail(ExitCode::Mesh, "no"); });
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Mesh);
    EXPECT_TRUE(error.onAllRanks());
  }
}
