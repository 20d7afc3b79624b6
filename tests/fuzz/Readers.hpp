#pragma once

#include <functional>
#include <string>
#include <vector>

namespace coplane
{
/// A reader that must answer every file with a result or with an Error.
struct Reader
{
  std::string name;
  std::string extension;
  /// A good file: some readers take a recipe for it.
  std::function<std::string(const std::string& path)> goodFile;
  std::function<void(const std::string& path)> read;
  /// Every file in a program of its own: the HDF5 library is not itself again after some damaged
  /// files, nor in a child of a program that has used it.
  bool alone = false;
  /// What it may leave in memory per file; the netCDF library loses some of a file that it refuses.
  double bytesKept = 100;
};

const std::vector<Reader>& readers();
/// What was not spoilt: the files to start from.
std::vector<std::string>& goodFiles();
std::string textOfFile(const std::string& path);
} // namespace coplane
