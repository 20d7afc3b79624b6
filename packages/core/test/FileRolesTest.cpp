#include <coplane_core/FileRoles.hpp>

#include <gtest/gtest.h>

#include <TestFolder.hpp>
#include <atomic>
#include <sys/stat.h>
#include <thread>

namespace coplane
{
namespace
{
namespace fs = std::filesystem;

/// On one rank: nothing here is collective.
class FileRolesTest : public ::testing::Test
{
protected:
  std::string at(const std::string& name) const { return folder_ / name; }
  void make(const std::string& name) const { std::ofstream(at(name)) << "content of " << name; }

  std::vector<std::string> problems(const std::string& input, const std::string& output) const
  {
    FileRoles roles;
    roles.reads(input, "the mesh");
    roles.writes(output, "the results");
    return roles.problems();
  }
  void expectClash(const std::string& input, const std::string& output) const
  {
    const auto found = problems(input, output);
    ASSERT_EQ(found.size(), 1u) << input << " and " << output;
    EXPECT_NE(found[0].find("the mesh '" + input + "'"), std::string::npos) << found[0];
    EXPECT_NE(found[0].find("the results '" + output + "'"), std::string::npos) << found[0];
  }

  TestFolder folder_{Comm::alone()};
};

TEST_F(FileRolesTest, DistinctFilesAreFine)
{
  make("mesh.e");
  EXPECT_TRUE(problems(at("mesh.e"), at("run.e")).empty());
  make("run.e");
  EXPECT_TRUE(problems(at("mesh.e"), at("run.e")).empty());
}

TEST_F(FileRolesTest, OneNameInManyShapes)
{
  make("mesh.e");
  fs::create_directory(at("sub"));
  fs::create_directory_symlink(at("."), at("link"));
  expectClash(at("mesh.e"), at("mesh.e"));
  expectClash(at("mesh.e"), at("./mesh.e"));
  expectClash(at("mesh.e"), at("sub/../mesh.e"));
  expectClash(at("mesh.e"), at("link/mesh.e"));
  expectClash(at("sub/../link/mesh.e"), at("mesh.e"));
}

TEST_F(FileRolesTest, LinksLeadToOneFile)
{
  make("mesh.e");
  fs::create_hard_link(at("mesh.e"), at("hard.e"));
  fs::create_symlink("mesh.e", at("soft.e"));
  fs::create_symlink("soft.e", at("softer.e"));
  expectClash(at("mesh.e"), at("hard.e"));
  expectClash(at("mesh.e"), at("softer.e"));
  expectClash(at("softer.e"), at("hard.e"));
}

TEST_F(FileRolesTest, WhatIsNotThereYetIsComparedByItsFolder)
{
  fs::create_directory_symlink(at("."), at("link"));
  fs::create_symlink("later.e", at("dangling.e"));
  expectClash(at("later.e"), at("link/later.e"));
  expectClash(at("later.e"), at("dangling.e"));
  EXPECT_TRUE(problems(at("later.e"), at("sub/later.e")).empty());
}

TEST_F(FileRolesTest, OutputsMeetOutputsAndSeries)
{
  FileRoles roles;
  roles.writes(at("run.0"), "the results");
  roles.writes(at("run.0"), "the checkpoint");
  roles.writesSeries({at("run_planes_"), ".vtp"}, "the planes");
  roles.reads(at("run_planes_0007.vtp"), "the mesh");
  roles.reads(at("run_planes_7x.vtp"), "the deck");
  const auto found = roles.problems();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NE(found[0].find("the checkpoint"), std::string::npos);
  EXPECT_NE(found[1].find("the mesh"), std::string::npos);
}

TEST_F(FileRolesTest, ASeriesMeetsAHardLinkOfItsName)
{
  make("mesh.e");
  fs::create_hard_link(at("mesh.e"), at("run.e-s0002"));
  FileRoles roles;
  roles.reads(at("mesh.e"), "the mesh");
  roles.writesSeries({at("run.e-s"), ""}, "the results");
  EXPECT_EQ(roles.problems().size(), 1u);
}

TEST_F(FileRolesTest, SpecialFilesAreNotWritten)
{
  ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", at("to_pipe"));
  fs::create_directory(at("folder"));
  for (const std::string& name :
       {at("pipe"), at("to_pipe"), at("folder"), std::string("/dev/null")})
  {
    FileRoles roles;
    roles.writes(name, "the history");
    ASSERT_EQ(roles.problems().size(), 1u) << name;
    EXPECT_NE(roles.problems()[0].find("accepted: a plain file"), std::string::npos);
  }
  EXPECT_EQ(kindOfSpecialFile(at("pipe")), "a pipe");
  EXPECT_EQ(kindOfSpecialFile("/dev/full"), "a device");
  EXPECT_EQ(kindOfSpecialFile(at("missing")), "");
}
} // namespace

TEST_F(FileRolesTest, FilesThatARunReplacesMeanwhileDoNotSeemToBeOne)
{
  // Two files are replaced in turn; where the file system gives the inode of one that has gone to
  // the next that is made, each has now and then the inode that the other had.
  std::atomic<bool> isOver{false};
  std::thread writer(
      [&]
      {
        for (int i = 0; !isOver; ++i)
          for (const char* name : {"mesh.e", "run.e"})
          {
            make("draft");
            fs::rename(at("draft"), at(name));
          }
      });
  int clashes = 0;
  for (int i = 0; i < 20000; ++i)
    clashes += int(problems(at("mesh.e"), at("run.e")).size());
  isOver = true;
  writer.join();
  EXPECT_EQ(clashes, 0);
}

TEST_F(FileRolesTest, SaysWhatCannotBeWrittenAndChangesNothing)
{
  const std::string there = at("there.csv");
  make("there.csv");
  const auto bytes = fs::file_size(there);
  FileRoles roles;
  roles.writesInPlace(there, "the history");
  roles.writes(at("new.csv"), "a table");
  EXPECT_TRUE(roles.hindrances().empty());
  EXPECT_EQ(fs::file_size(there), bytes);
  EXPECT_FALSE(fs::exists(at("new.csv")));
  // Even root cannot write over a program that runs: this one.
  roles.writes("/proc/self/exe", "the planes, which are renamed over it");
  roles.writesInPlace("/proc/self/exe", "the results");
  const auto busy = roles.hindrances(); // its folder may not be writable either
  ASSERT_FALSE(busy.empty());
  for (const std::string& sentence : busy)
    EXPECT_EQ(sentence.find("the planes, which are renamed over it cannot be written over"),
              std::string::npos);
  EXPECT_NE(busy.back().find("the results cannot replace this file"), std::string::npos);
  roles.writes(at("missing/new.csv"), "the planes");
  ASSERT_EQ(roles.hindrances().size(), busy.size() + 1);
  EXPECT_NE(roles.hindrances().back().find("the planes cannot be written"), std::string::npos);
}

TEST_F(FileRolesTest, InputsMayBeSeries)
{
  FileRoles roles;
  roles.readsSeries({at("wall.e."), ".", ""}, "a part of the mesh");
  roles.writes(at("wall.e.2.1"), "the history");
  EXPECT_EQ(roles.problems().size(), 1u);
  FileRoles others;
  others.readsSeries({at("wall.e."), ".", ""}, "a part of the mesh");
  others.writes(at("wall.e.csv"), "the history");
  EXPECT_TRUE(others.problems().empty());
}
} // namespace coplane
