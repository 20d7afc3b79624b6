#pragma once

/// `coplane report ...` is the program `coplane_report` beside this one, as `git log` is one of
/// git's: when the first word of the command line is `report`, this process becomes that program,
/// or ends with ExitCode::Usage where it cannot be started. Otherwise nothing is done. A deck of
/// that name is `./report`.
void startReport(int argc, char** argv);
