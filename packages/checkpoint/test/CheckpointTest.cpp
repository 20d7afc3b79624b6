#include "Sample.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <sys/resource.h>

namespace coplane
{
namespace
{
std::string errorOf(const std::function<void()>& action, ExitCode code)
{
  try
  {
    action();
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), code);
    EXPECT_TRUE(error.onAllRanks());
    return error.what();
  }
  return "";
}

std::ptrdiff_t filesIn(const TestFolder& folder)
{
  return std::distance(std::filesystem::directory_iterator(folder.path()),
                       std::filesystem::directory_iterator());
}

bool sameBits(Real a, Real b)
{
  return std::memcmp(&a, &b, sizeof a) == 0;
}
} // namespace

TEST(Checkpoint, givesBackEveryBitByKey)
{
  const Comm comm;
  const TestFolder folder(comm);
  const std::string file = folder / "a.chk.0";
  sample(comm).write(file, 17, 1.0 / 3);
  const CheckpointReader in(file, comm);
  EXPECT_EQ(in.head().cycle, 17);
  EXPECT_EQ(in.head().time, 1.0 / 3);
  EXPECT_EQ(in.rowCount("nodes"), 100);

  // Each rank asks for others than it has given, some of them twice, in any order.
  std::vector<GlobalId> wanted;
  for (int i = comm.rank(); i < 100; i += 3)
    wanted.push_back(7 * ((i * 37) % 100) - 20);
  wanted.push_back(wanted.front());
  const KeyedRows rows = in.rowsOf("nodes", {"a", "b"}, wanted);
  ASSERT_EQ(rows.count(), wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k)
  {
    const int i = int(wanted[k] + 20) / 7;
    EXPECT_EQ(rows.row(k)[0], 1.0 / (i + 1));
    const Real b = i % 5 == 0   ? -0.0
                   : i % 5 == 1 ? std::nan("7")
                   : i % 5 == 2 ? -infinity
                                : std::sin(i);
    EXPECT_TRUE(sameBits(rows.row(k)[1], b)) << "row " << i;
  }
  EXPECT_EQ(comm.sum(std::int64_t(in.part("contact/planes", {"c"}).count())), 100);
  EXPECT_EQ(in.part("elements/block_7", {"d"}).count(), 0u);
  const std::vector<Real> numbers = in.numbers("solver/numbers");
  ASSERT_EQ(numbers.size(), 5u);
  EXPECT_TRUE(sameBits(numbers[2], -0.0));
  EXPECT_TRUE(sameBits(numbers[3], std::nan("3")));
  EXPECT_TRUE(in.numbers("none").empty());
  EXPECT_EQ(in.text("deck"), "time.end = 1\nmesh = a.e\n");
  EXPECT_EQ(in.text("empty"), "");
  EXPECT_TRUE(in.has("contact/planes/keys"));
  EXPECT_FALSE(in.has("contact/faces/keys"));
}

TEST(Checkpoint, hasTheSameBytesOnAnyRanks)
{
  const Comm comm, alone(MPI_COMM_SELF);
  const TestFolder folder(comm);
  sample(comm).write(folder / "all.chk", 5, 0.25);
  if (comm.isRoot())
  {
    sample(alone).write(folder / "alone.chk", 5, 0.25);
    EXPECT_EQ(contentOf(folder / "all.chk") == contentOf(folder / "alone.chk"), true);
  }
  comm.barrier();
}

TEST(Checkpoint, leavesNoDraftBehind)
{
  const Comm comm;
  const TestFolder folder(comm);
  sample(comm).write(folder / "a.chk", 1, 1);
  EXPECT_EQ(filesIn(folder), 1);
}

TEST(Checkpoint, tellsOfARowThatIsNotThere)
{
  const Comm comm;
  const TestFolder folder(comm);
  const std::string file = folder / "a.chk";
  sample(comm).write(file, 1, 1);
  const CheckpointReader in(file, comm);
  // One rank asks for it, all are told.
  std::vector<GlobalId> wanted{-20};
  if (comm.rank() == comm.size() - 1)
    wanted.push_back(4711);
  const std::string text = errorOf(
      [&] {
        in.rowsOf("nodes", {"a", "b"}, wanted);
      },
      ExitCode::Checkpoint);
  EXPECT_NE(text.find("no row of id 4711 in 'nodes'"), std::string::npos) << text;
}

TEST(Checkpoint, tellsOfTablesThatAreMissingOrHaveOtherColumns)
{
  const Comm comm;
  const TestFolder folder(comm);
  const std::string file = folder / "a.chk";
  sample(comm).write(file, 1, 1);
  const CheckpointReader in(file, comm);
  EXPECT_NE(errorOf([&] { in.numbers("rigid"); }, ExitCode::Checkpoint).find("'rigid' is missing"),
            std::string::npos);
  EXPECT_NE(errorOf(
                [&] {
                  in.part("nodes", {"a", "x"});
                },
                ExitCode::Checkpoint)
                .find("'nodes' has other columns"),
            std::string::npos);
}

TEST(Checkpoint, thatCannotBeWrittenSaysWhereAndWhy)
{
  const Comm comm;
  const std::string text =
      errorOf([&] { sample(comm).write("no/such/folder/a.chk", 3, 0); }, ExitCode::Output);
  EXPECT_NE(text.find("no/such/folder/a.chk: the checkpoint of cycle 3"), std::string::npos);
  EXPECT_NE(text.find("No such file or directory"), std::string::npos);
}

TEST(Checkpoint, onAFullDiskTheOldOneStays)
{
  const Comm comm;
  const TestFolder folder(comm);
  const std::string file = folder / "a.chk";
  sample(comm).write(file, 1, 1);
  const std::string before = contentOf(file);
  comm.barrier();
  // MPI's own files are larger than this limit only where they exist already.
  rlimit old{}, limit{};
  getrlimit(RLIMIT_FSIZE, &old);
  limit = old;
  limit.rlim_cur = 100 * 1024;
  std::string text;
  const CheckpointWriter large = sample(comm, 20000); // 480 kB
  setrlimit(RLIMIT_FSIZE, &limit);
  text = errorOf([&] { large.write(file, 2, 2); }, ExitCode::Output);
  setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_NE(text.find("File too large"), std::string::npos) << text;
  EXPECT_EQ(contentOf(file) == before, true);
  EXPECT_EQ(filesIn(folder), 1);
  comm.barrier();
}
} // namespace coplane
