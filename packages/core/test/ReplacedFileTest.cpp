#include <coplane_core/TextFile.hpp>

#include <gtest/gtest.h>

#include <TestFolder.hpp>
#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <iterator>
#include <unistd.h>
#include <vector>

namespace coplane
{
namespace
{
namespace fs = std::filesystem;

/// On one rank: nothing here is collective.
class ReplacedFileTest : public ::testing::Test
{
protected:
  std::string at(const std::string& name) const { return folder_ / name; }
  void make(const std::string& name, const std::string& text) const
  {
    std::ofstream(at(name)) << text;
  }
  /// What the files of the folder hold, in order.
  std::vector<std::string> texts() const
  {
    std::vector<std::string> texts;
    for (const auto& entry : fs::directory_iterator(fs::path(at("x")).parent_path()))
    {
      std::ifstream stream(entry.path());
      texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    }
    std::sort(texts.begin(), texts.end());
    return texts;
  }

  TestFolder folder_{Comm::alone()};
};

TEST_F(ReplacedFileTest, ReplacesWhatItLeft)
{
  ReplacedFile file(at("run.txt"));
  file.replace("first");
  EXPECT_TRUE(file.isAsLeft());
  file.replace("second");
  EXPECT_EQ(texts(), (std::vector<std::string>{"second"}));
}

TEST_F(ReplacedFileTest, PutsAsideWhatSomebodyElseLeft)
{
  ReplacedFile file(at("run.txt"));
  file.replace("first");
  make("new", "precious");
  fs::rename(at("new"), at("run.txt"));
  EXPECT_FALSE(file.isAsLeft());
  file.replace("second");
  EXPECT_EQ(texts(), (std::vector<std::string>{"precious", "second"}));
}

// Somebody takes the name between the program's look at it and the end of its writing, which goes
// to the file that it has open.
TEST_F(ReplacedFileTest, WhatIsOpenIsLeftWhateverHasTheNameNow)
{
  ReplacedFile file(at("run.txt"));
  file.replace("first");
  const int descriptor = ::open(at("run.txt").c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  ASSERT_GE(descriptor, 0);
  ASSERT_TRUE(file.isAsLeft());
  make("new", "precious");
  fs::rename(at("new"), at("run.txt"));
  ASSERT_EQ(::write(descriptor, " more", 5), 5);
  file.remember(descriptor);
  EXPECT_FALSE(file.isAsLeft());
  file.replace("second");
  EXPECT_EQ(texts(), (std::vector<std::string>{"precious", "second"}));
  ::close(descriptor);
}

TEST_F(ReplacedFileTest, WhatIsOpenAndHasItsNameIsAsLeft)
{
  ReplacedFile file(at("run.txt"));
  file.replace("first");
  const int descriptor = ::open(at("run.txt").c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  ASSERT_EQ(::write(descriptor, " more", 5), 5);
  EXPECT_FALSE(file.isAsLeft());
  file.remember(descriptor);
  EXPECT_TRUE(file.isAsLeft());
  ::close(descriptor);
}
} // namespace
} // namespace coplane
