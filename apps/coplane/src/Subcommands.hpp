#pragma once

#include <string>

/// `coplane report ...` is the program `coplane_report` beside this one, as `git log` is one of
/// git's: when the first word of the command line is a subcommand, this process becomes that
/// program, or ends with ExitCode::Usage where it cannot be started. Otherwise nothing is done. A
/// deck of such a name is `./report`.
void startSubcommand(int argc, char** argv);

/// A line for each subcommand, for --help.
std::string subcommandsHelp();
