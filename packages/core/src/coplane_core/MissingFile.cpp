#include <coplane_core/FileRoles.hpp>
#include <coplane_core/MissingFile.hpp>
#include <coplane_core/Suggestion.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <vector>

namespace coplane
{
namespace
{
namespace fs = std::filesystem;

/// Names in a folder, at most so many as can be looked through at once.
std::vector<std::string> namesIn(const std::string& folder)
{
  constexpr std::size_t most = 1000;
  std::vector<std::string> names;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (const fs::directory_iterator end; !error && entry != end && names.size() < most;
       entry.increment(error))
    names.push_back(entry->path().filename().string());
  return names;
}

/// The file in the same folder whose name differs in its ending only, or is nearest.
std::string similarFile(const std::string& file)
{
  const fs::path wanted(file);
  const std::vector<std::string> names = namesIn(folderOf(file));
  const std::string name = wanted.filename().string();
  for (const std::string& other : names)
    if (editDistance(name, other) == 0)
      return other;
  for (const std::string& other : names)
    if (fs::path(other).stem() == wanted.stem())
      return other;
  return nearest(name, names);
}
} // namespace

std::string hintOfMissingFile(const std::string& file)
{
  if (file.rfind('~', 0) == 0 || file.find('$') != std::string::npos)
    return " '~' and variables are not replaced here: write the whole path.";
  if (file.find('\\') != std::string::npos)
    return " Folders are separated by '/', not by backslashes.";
  const std::string similar = similarFile(file);
  return similar.empty() ? "" : fmt::format(" There is a file '{}': is that meant?", similar);
}
} // namespace coplane
