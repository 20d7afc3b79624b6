#include <coplane_core/Error.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/OutputLocks.hpp>

#include <algorithm>
#include <filesystem>

namespace coplane
{
namespace
{
namespace fs = std::filesystem;

/// Looks for runs that hold a lock in this folder and write what this one writes.
void demandNoOther(const std::string& folder, const std::set<std::string>& mine,
                   const FileRoles& roles, const std::string& whose)
{
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
  {
    const std::string file = entry->path().string();
    std::error_code ignored;
    if (entry->path().extension() != ".lock" ||
        std::any_of(mine.begin(), mine.end(),
                    [&](const std::string& own) { return fs::equivalent(own, file, ignored); }))
      continue;
    const std::string text = FileLock::textOfHolder(file);
    const auto problems = roles.problemsWith(FileRoles::outputsIn(text));
    if (!problems.empty())
      fail(ExitCode::Output,
           "{}: another run writes files of {}: {}. {} Wait for it or end it, or give the "
           "outputs of this one other names. Nothing was written.",
           file, whose, text.substr(0, text.find('\n')), fmt::join(problems, " "));
  }
}
} // namespace

std::vector<FileLock> lockOutputs(const FileRoles& outputs, const std::set<std::string>& files,
                                  const std::string& whose)
{
  std::vector<FileLock> locks;
  for (const std::string& file : files)
  {
    locks.emplace_back(file, "the outputs of " + whose, outputs.outputsText());
    if (!locks.back().isHeld())
      logWarning("locks",
                 fmt::format("{}: the file system has no locks: nothing keeps a second run "
                             "from writing the same files",
                             file));
  }
  // Runs of other names may write the same files all the same. Each says first what it writes, and
  // looks then.
  for (const std::string& folder : outputs.folders())
    demandNoOther(folder, files, outputs, whose);
  return locks;
}

void removeDraftsOfKilled(const FileRoles& outputs, const std::vector<FileLock>& locks)
{
  FileRoles left;
  for (const FileLock& lock : locks)
    left.add(FileRoles::outputsIn(lock.textFound()));
  std::error_code ignored;
  for (const std::string& file : left.draftsIn(outputs.folders()))
    fs::remove(file, ignored);
}
} // namespace coplane
