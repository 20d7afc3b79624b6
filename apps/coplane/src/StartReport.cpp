#include "StartReport.hpp"

#include <coplane_core/Error.hpp>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <unistd.h>
#include <vector>

void startReport(int argc, char** argv)
{
  if (argc < 2 || std::strcmp(argv[1], "report") != 0)
    return;
  std::error_code unknown;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", unknown);
  std::string program = own.parent_path() / "coplane_report";
  std::vector<char*> arguments(argv + 1, argv + argc + 1); // with the null pointer at the end
  arguments[0] = program.data();
  ::execv(program.c_str(), arguments.data());
  const std::string text = fmt::format(
      "ERROR: {}: {}. `coplane report` starts this script, which is built and installed "
      "beside coplane and needs /usr/bin/python3.\n",
      program, std::strerror(errno));
  std::fputs(text.c_str(), stderr);
  std::exit(int(coplane::ExitCode::Usage));
}
