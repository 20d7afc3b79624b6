#pragma once

#include <coplane_dynamics/Solver.hpp>

#include <string>

namespace coplane
{
/// Prints the census of contact before the first step. Collective.
void reportCensus(const Contact& contact);
/// Prints which bodies lie in each other before the first step; an error unless that is allowed.
/// Collective.
void reportInitialOverlaps(const Solver& solver, const std::string& meshFile, bool allowed);
} // namespace coplane
