#pragma once

#include "CommandLine.hpp"

#include <coplane_core/Comm.hpp>

namespace coplane
{
/// Checks the deck and the mesh that the command line names, and runs them, from a checkpoint if it
/// asks for that. Collective.
/// @param command as it was given, for the results
/// @returns the exit code
int runDeck(const CommandLine& line, const Comm& comm, const std::string& command);
} // namespace coplane
