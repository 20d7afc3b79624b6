#include <coplane_core/Error.hpp>
#include <coplane_core/FileLock.hpp>

#include <gtest/gtest.h>

#include <TestFolder.hpp>
#include <csignal>
#include <optional>
#include <sys/wait.h>
#include <unistd.h>

namespace coplane
{
namespace
{
/// A second process takes the lock, says so and waits to be killed.
pid_t startOwner(const std::string& file)
{
  int says[2];
  if (::pipe(says) != 0)
    return -1;
  const pid_t child = ::fork();
  if (child == 0)
  {
    const FileLock lock(file, "the outputs");
    const char done = lock.isHeld();
    if (::write(says[1], &done, 1) != 1)
      ::_exit(1);
    for (;;)
      ::pause();
  }
  char done = 0;
  const bool heard = ::read(says[0], &done, 1) == 1 && done;
  ::close(says[0]);
  ::close(says[1]);
  return heard ? child : -1;
}

TEST(FileLock, IsRefusedWithItsOwnerAndDiesWithIt)
{
  const TestFolder folder(Comm::alone());
  const std::string file = folder / "run.lock";
  const pid_t owner = startOwner(file);
  ASSERT_GT(owner, 0);
  try
  {
    const FileLock second(file, "the outputs of run.yaml");
    ADD_FAILURE() << "the lock was given twice";
  }
  catch (const Error& error)
  {
    const std::string text = error.what();
    EXPECT_EQ(error.code(), ExitCode::Output);
    EXPECT_NE(text.find(fmt::format("process {} on ", owner)), std::string::npos) << text;
    EXPECT_NE(text.find("UTC"), std::string::npos) << text;
  }
  ::kill(owner, SIGKILL);
  ::waitpid(owner, nullptr, 0);
  EXPECT_TRUE(std::filesystem::exists(file)); // left behind, and free
  const FileLock third(file, "the outputs");
  EXPECT_TRUE(third.isHeld());
}

TEST(FileLock, LeavesNothingBehind)
{
  const TestFolder folder(Comm::alone());
  const std::string file = folder / "run.lock";
  {
    FileLock lock(file, "the outputs");
    const FileLock moved(std::move(lock));
    EXPECT_TRUE(moved.isHeld());
    EXPECT_TRUE(std::filesystem::exists(file));
  }
  EXPECT_FALSE(std::filesystem::exists(file));
}
TEST(FileLock, LeavesFilesOfOthersAlone)
{
  const TestFolder folder(Comm::alone());
  const std::string file = folder / "run.lock", kept = folder / "kept.txt";
  std::ofstream(file) << "mine";
  std::ofstream(kept) << "process 1 on the list";
  EXPECT_THROW(FileLock(file, "the outputs"), Error);
  EXPECT_EQ(std::filesystem::file_size(file), 4u);
  std::filesystem::remove(file);
  std::filesystem::create_hard_link(kept, file);
  {
    const FileLock lock(file, "the outputs"); // a file of its own
    EXPECT_TRUE(lock.isHeld());
  }
  EXPECT_EQ(std::filesystem::file_size(kept), 21u);
  std::ofstream(file) << "process 1 of my list";
  EXPECT_THROW(FileLock(file, "the outputs"), Error);
  EXPECT_EQ(std::filesystem::file_size(file), 20u);
}

TEST(FileLock, RemovesNoOthers)
{
  const TestFolder folder(Comm::alone());
  const std::string file = folder / "run.lock";
  {
    const FileLock first(file, "the outputs");
    EXPECT_EQ(FileLock::textOfHolder(file).rfind("process ", 0), 0u);
    std::filesystem::remove(file);
    std::ofstream(file) << "of another";
  }
  EXPECT_TRUE(std::filesystem::exists(file));
  EXPECT_EQ(FileLock::textOfHolder(file), "");
}

} // namespace
} // namespace coplane
