#include <coplane_core/MissingFile.hpp>
#include <coplane_core/Suggestion.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace coplane
{
TEST(MissingFile, aFileWithASimilarNameIsNamed)
{
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("missing_file_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "wall.e") << "x";
  const auto hint = [&](const char* name) { return hintOfMissingFile((folder / name).string()); };
  for (const char* name : {"Wall.e", "wall", "wall.exo", "wal.e"})
    EXPECT_EQ(hint(name), " There is a file 'wall.e': is that meant?") << name;
  EXPECT_EQ(hint("bricks.e"), "");
  EXPECT_EQ(hint("none/wall.e"), "");
  fs::remove_all(folder);
}

TEST(MissingFile, signsOfShellsAndOfOtherSystemsAreNamed)
{
  EXPECT_EQ(hintOfMissingFile("~/wall.e"),
            " '~' and variables are not replaced here: write the whole path.");
  EXPECT_EQ(hintOfMissingFile("$HOME/wall.e"), hintOfMissingFile("~/wall.e"));
  EXPECT_EQ(hintOfMissingFile("meshes\\wall.e"),
            " Folders are separated by '/', not by backslashes.");
}

TEST(Suggestion, theOnlyNameOfWhichAWordIsPartIsFound)
{
  const std::vector<std::string> names{"linear_elastic", "mohr_coulomb", "drucker_prager"};
  EXPECT_EQ(nearest("elastic", names), "linear_elastic");
  EXPECT_EQ(nearest("Mohr", names), "mohr_coulomb");
  EXPECT_EQ(nearest("mohr_coulomb_model", names), "mohr_coulomb");
  EXPECT_EQ(nearest("lastic", names), ""); // not from the beginning of a word
  EXPECT_EQ(nearest("shear", {"shear_stiffness", "shear_ratio"}), "") << "two have it";
}
} // namespace coplane
