#pragma once

#include <coplane_core/Comm.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace coplane
{
/// An empty folder for one test, the same on all ranks; removed at the end. Collective.
class TestFolder
{
public:
  explicit TestFolder(const Comm& comm) : comm_(comm)
  {
    std::string pattern = (std::filesystem::temp_directory_path() / "coplane_test_XXXXXX");
    if (comm.isRoot() && !::mkdtemp(pattern.data()))
      pattern.clear();
    path_ = comm.broadcast(pattern);
  }
  ~TestFolder()
  {
    comm_.barrier();
    std::error_code ignored;
    if (comm_.isRoot())
      std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

private:
  Comm comm_;
  std::string path_;
};

/// Every byte of a file.
inline std::string contentOf(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}
} // namespace coplane
