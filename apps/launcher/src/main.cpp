// A program that is installed for several levels of processors: /usr/bin/coplane is this launcher,
// and starts PREFIX/lib/coplane/levels/LEVEL/coplane of the best level that the processor has.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace
{
/// Programs that keep what they have computed ask whether a program has changed by its bytes; these
/// have to change with those that it starts.
[[gnu::used]] const char builtFrom[] = "coplane " COPLANE_BUILD;

/// Of the psABI, as in -march and in glibc-hwcaps; the best first.
struct Level
{
  const char* name;
  bool isSupported;
};

constexpr int cannotStart = 2; // as after a wrong command line
} // namespace

int main(int, char** argv)
{
  __builtin_cpu_init();
  const Level levels[] = {{"x86-64-v4", __builtin_cpu_supports("x86-64-v4") != 0},
                          {"x86-64-v3", __builtin_cpu_supports("x86-64-v3") != 0},
                          {"x86-64-v2", __builtin_cpu_supports("x86-64-v2") != 0},
                          {"x86-64", true}};
  std::error_code unknown;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", unknown);
  const std::filesystem::path folder = own.parent_path().parent_path() / "lib/coplane/levels";
  const std::string name = own.filename();
  for (const Level& level : levels)
  {
    if (!level.isSupported)
      continue;
    ::execv((folder / level.name / name).c_str(), argv);
    if (errno != ENOENT)
      break;
  }
  std::fprintf(stderr, "ERROR: %s for this processor, in %s: %s. Install the package again.\n",
               name.c_str(), folder.c_str(), std::strerror(errno));
  return cannotStart;
}
