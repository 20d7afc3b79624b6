#pragma once

#include <coplane_dynamics/Line.hpp>
#include <coplane_input/Deck.hpp>

#include <vector>

namespace coplane
{
/// The lines of a deck that has been checked, each divided into points; rows one by one.
std::vector<LineSetup> linesOf(const Deck& deck);
} // namespace coplane
