#include "CommandLine.hpp"

#include "Subcommands.hpp"
#include "UsageHint.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Version.hpp>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>

namespace coplane
{
namespace
{
/// More than that is a slip of the pen: each thread takes memory, and the system gives only so
/// many.
int mostThreads()
{
  return std::max(256, 4 * int(std::thread::hardware_concurrency()));
}

std::string build()
{
  return fmt::format("coplane {} ({}; {}; {}; Trilinos {})", version().number, version().revision,
                     version().compiler, version().flags, version().trilinos);
}

/// What an option says is wrong with its text; empty: nothing.
std::string secondsAboveZero(const std::string& text)
{
  char* end = nullptr;
  const double seconds = std::strtod(text.c_str(), &end);
  return seconds > 0 && std::isfinite(seconds) && *end == 0
             ? ""
             : text + "; accepted: a number of seconds above 0";
}

/// Options whose values may be left out: whether they are there says the option itself.
struct OpenOptions
{
  CLI::Option *restart, *helpDeck;
};

OpenOptions addOptions(CLI::App& app, CommandLine& line)
{
  app.add_option("deck", line.deck, "The deck (YAML); --help-deck lists its keys");
  app.add_option("--set", line.overrides,
                 "Overrides a deck value: --set time.end=0.1 (may be repeated)")
      ->allow_extra_args(false);
  app.add_option("--backend", line.backend, "Where kernels run: serial or threads")
      ->check(CLI::IsMember({"serial", "threads"}));
  app.add_option("--threads", line.threads,
                 "Threads per rank with --backend threads; default: OMP_NUM_THREADS, else 1")
      ->check(CLI::Range(1, mostThreads()));
  OpenOptions open{};
  open.restart =
      app.add_option(
             "--restart", line.checkpoint,
             "Go on from a checkpoint: from this file, or from the newest one that is whole")
          ->expected(0, 1);
  app.add_option("--max-wall", line.maxWall,
                 "Write a checkpoint and stop after so many seconds (exit code 8)")
      ->check(secondsAboveZero);
  app.add_flag("--check", line.check,
               "Check deck and mesh, print masses, step and contact pairs, and stop");
  app.add_flag("--quiet", line.quiet, "Print only warnings and errors");
  open.helpDeck =
      app.add_option("--help-deck", line.topic,
                     "Print every key of a deck and stop; of one TOPIC: a section, key or model")
          ->type_name("[TOPIC]")
          ->expected(0, 1);
  app.add_flag("--help-deck-markdown", line.helpDeckMarkdown, "The same as Markdown");
  app.add_flag("--help-codes", line.helpCodes,
               "Print the table of exit codes as Markdown and stop");
  app.add_flag("--schema", line.schema, "Print the JSON Schema of decks and stop");
  app.set_version_flag("--version", build);
  return open;
}

/// What single options cannot see. Throws CLI::ParseError.
void demandSense(const CommandLine& line)
{
  if (!asksForHelp(line) && line.deck.empty())
    throw CLI::RequiredError("deck");
  if (line.backend == "serial" && line.threads > 1)
    throw CLI::ValidationError(
        "--threads", fmt::format("{} threads, but --backend serial has one; leave one of the two "
                                 "options out",
                                 line.threads));
}

} // namespace

bool asksForHelp(const CommandLine& line)
{
  return line.helpDeck || line.helpDeckMarkdown || line.schema || line.helpCodes;
}

std::string optionsOf(const CommandLine& line)
{
  return fmt::format("{} --set [{}] restart {} {} max-wall {} check {} help {}", line.deck,
                     fmt::join(line.overrides, "] ["), line.restart, line.checkpoint, line.maxWall,
                     line.check, asksForHelp(line));
}

std::string sameEverywhere()
{
  return fmt::format("coplane {} ({}; {}; Trilinos {})", version().number, version().revision,
                     version().compiler, version().trilinos);
}

int parse(int argc, char** argv, bool isRoot, CommandLine& line)
{
  CLI::App app{"coplane: explicit dynamics of solids in contact, with Simple Common Planes.\n"
               "Example: mpirun -np 2 coplane wall.yaml --backend threads --threads 1\n"};
  app.footer(subcommandsHelp());
  const OpenOptions open = addOptions(app, line);
  app.failure_message(
      [argc, argv](const CLI::App* failed, const CLI::Error& error)
      {
        return fmt::format("ERROR: {}\n{}Accepted: coplane DECK [options], one deck. All options: "
                           "coplane --help\n",
                           error.what(), usageHint({argv + 1, argv + argc}, *failed));
      });
  try
  {
    app.parse(argc, argv);
    line.restart = open.restart->count() > 0;
    line.helpDeck = open.helpDeck->count() > 0;
    demandSense(line);
  }
  catch (const CLI::ParseError& error)
  {
    int code = error.get_exit_code();
    if (isRoot)
      app.exit(error);
    return code == 0 ? 0 : int(ExitCode::Usage);
  }
  return -1;
}

int threadsOf(const CommandLine& line)
{
  if (line.threads > 0)
    return line.threads;
  const char* const asked = std::getenv("OMP_NUM_THREADS");
  const int threads = asked ? std::max(1, std::atoi(asked)) : 1;
  if (threads > mostThreads())
    fail(ExitCode::Usage, "OMP_NUM_THREADS = {}; accepted: 1 to {} threads per rank.", asked,
         mostThreads());
  return threads;
}
} // namespace coplane
