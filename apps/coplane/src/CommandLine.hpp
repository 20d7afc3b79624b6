#pragma once

#include <string>
#include <vector>

namespace coplane
{
struct CommandLine
{
  std::string deck;
  std::vector<std::string> overrides;
  std::string backend = "threads";
  int threads = 0; ///< 0: OMP_NUM_THREADS, else 1
  bool restart = false;
  std::string checkpoint; ///< to restart from; empty: the newest
  double maxWall = 0;     ///< [s]; 0: no limit
  bool check = false, quiet = false, helpDeck = false, helpDeckMarkdown = false, schema = false;
  std::string topic; ///< of --help-deck; empty: everything
  bool helpCodes = false;
};

bool asksForHelp(const CommandLine& line);

/// What all ranks must have been given alike. Threads may differ.
std::string optionsOf(const CommandLine& line);

/// What has to be the same on all ranks. Not the processor: machines of a cluster may have
/// different ones, for which the program is compiled differently with the same bits.
std::string sameEverywhere();

/// Exit code when the program should end now, -1 to go on.
int parse(int argc, char** argv, bool isRoot, CommandLine& line);

/// Threads per rank; throws where the environment asks for too many.
int threadsOf(const CommandLine& line);
} // namespace coplane
