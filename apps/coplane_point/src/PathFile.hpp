#pragma once

#include "PointDeck.hpp"

namespace coplane
{
/// Reads times, gaps and slips of a path from a CSV file. Throws Error(ExitCode::Deck) with file
/// and line.
void readPathFile(const std::string& file, JointPathCard& card);
} // namespace coplane
