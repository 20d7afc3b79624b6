#pragma once

#include <coplane_dynamics/Solver.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// Prints the census of contact before the first step. Collective.
void reportCensus(const Contact& contact);
/// Prints in which planes of symmetry bodies go on as their images, and why not in others.
void reportMirrors(const Mirrors& mirrors);
/// Prints which bodies lie in each other before the first step; an error unless that is allowed.
/// Collective.
void reportInitialOverlaps(const Solver& solver, const std::string& meshFile, bool allowed);
/// Warns of bodies in which blocks lie that a stage has just added; call after the cycle in which
/// they came in. Collective.
/// @param added in the order of the mesh
/// @param where of the stage
void reportOverlapsOfAdded(const Solver& solver, const std::vector<int>& added,
                           const std::string& where);
} // namespace coplane
