#pragma once

#include <coplane_dynamics/Solver.hpp>

namespace coplane
{
/// Prints, for each joint card, by how much its bonds soften the elements that they hold together.
/// Collective.
void reportBondSoftness(const Solver& solver);
} // namespace coplane
