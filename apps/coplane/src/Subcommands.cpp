#include "Subcommands.hpp"

#include <coplane_core/Error.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <unistd.h>
#include <vector>

namespace
{
struct Subcommand
{
  const char *word, *arguments, *does;
};
constexpr Subcommand subcommands[] = {
    {"new", "NAME --like EXAMPLE", "makes a folder with deck, recipe and check"},
    {"pictures", "RUN", "draws any run: states, strips, films, two runs side by side"},
    {"report", "RUN", "writes one HTML file about a run"},
    {"watch", "RUN", "shows a run in the terminal while it goes on"},
};
} // namespace

void startSubcommand(int argc, char** argv)
{
  if (argc < 2 || std::none_of(std::begin(subcommands), std::end(subcommands),
                               [&](const Subcommand& subcommand)
                               { return std::strcmp(subcommand.word, argv[1]) == 0; }))
    return;
  std::error_code unknown;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", unknown);
  std::string program = own.parent_path() / ("coplane_" + std::string(argv[1]));
  std::vector<char*> arguments(argv + 1, argv + argc + 1); // with the null pointer at the end
  arguments[0] = program.data();
  ::execv(program.c_str(), arguments.data());
  const std::string text =
      fmt::format("ERROR: {}: {}. `coplane {}` starts this script, which is built and installed "
                  "beside coplane and needs /usr/bin/python3.\n",
                  program, std::strerror(errno), argv[1]);
  std::fputs(text.c_str(), stderr);
  std::exit(int(coplane::ExitCode::Usage));
}

std::string subcommandsHelp()
{
  std::string text = "Subcommands; each has its own --help:\n";
  for (const Subcommand& subcommand : subcommands)
    text += fmt::format("  coplane {} {:<{}} {}\n", subcommand.word, subcommand.arguments,
                        25 - std::strlen(subcommand.word), subcommand.does);
  return text;
}
