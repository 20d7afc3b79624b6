#include "Sample.hpp"

#include <gtest/gtest.h>

#include <random>

namespace coplane
{
namespace
{
/// The reason for which a file is refused.
std::string problemOf(const std::string& file, const Comm& comm)
{
  try
  {
    const CheckpointReader in(file, comm);
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Checkpoint);
    EXPECT_TRUE(error.onAllRanks());
    return error.what();
  }
  return "";
}

struct Damaged : testing::Test
{
  Comm comm;
  TestFolder folder{comm};
  std::string file = folder / "a.chk";
  std::string whole;

  void SetUp() override
  {
    sample(comm).write(file, 17, 0.5);
    whole = contentOf(file);
  }
};
} // namespace

TEST_F(Damaged, isFoundWhereverABitIsTurned)
{
  // The same places on all ranks: many in the head, and places everywhere.
  std::mt19937 random(7);
  for (int trial = 0; trial < 400; ++trial)
  {
    const std::size_t place =
        trial < 150 ? random() % CheckpointHead::headBytes : random() % whole.size();
    std::string bytes = whole;
    bytes[place] = char(bytes[place] ^ (1 << random() % 8));
    setBytes(file, bytes, comm);
    EXPECT_NE(problemOf(file, comm), "") << "byte " << place;
  }
}

TEST_F(Damaged, isFoundWhenItIsCutOff)
{
  for (const std::size_t length :
       {std::size_t(0), std::size_t(1), std::size_t(19), std::size_t(100), std::size_t(511),
        std::size_t(512), std::size_t(513), whole.size() / 2, whole.size() - 1})
  {
    setBytes(file, whole.substr(0, length), comm);
    EXPECT_NE(problemOf(file, comm), "") << length << " bytes";
  }
  setBytes(file, whole + "x", comm);
  EXPECT_NE(problemOf(file, comm).find("it has"), std::string::npos);
}

TEST_F(Damaged, isFoundWhenPartsOfItAreZeros)
{
  // As file systems leave them after a loss of power.
  for (std::size_t from = 0; from < whole.size(); from += 4096)
  {
    std::string bytes = whole;
    const std::size_t count = std::min<std::size_t>(4096, bytes.size() - from);
    if (bytes.find_first_not_of('\0', from) >= from + count)
      continue; // nothing but zeros before
    bytes.replace(from, count, count, '\0');
    setBytes(file, bytes, comm);
    EXPECT_NE(problemOf(file, comm), "") << "from byte " << from;
  }
}

TEST_F(Damaged, filesOfOthersAreNamedAsSuch)
{
  setBytes(file, "title: not a checkpoint\n" + std::string(2000, 'x'), comm);
  EXPECT_NE(problemOf(file, comm).find("it is not a checkpoint of Coplane"), std::string::npos);
  setBytes(file, whole.substr(512), comm); // HDF5, but without the head
  EXPECT_NE(problemOf(file, comm).find("it is not a checkpoint of Coplane"), std::string::npos);
  EXPECT_NE(problemOf(file + ".none", comm).find("No such file or directory"), std::string::npos);
  EXPECT_NE(problemOf(folder.path(), comm).find("it is not a plain file"), std::string::npos);
}

} // namespace coplane
