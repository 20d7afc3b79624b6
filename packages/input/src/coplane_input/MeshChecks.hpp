#pragma once

#include <coplane_input/Deck.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// Compares the deck's names with those of the mesh and returns one message for each problem, with
/// its place and a suggestion; empty when all fits. Every block of the mesh needs a card.
std::vector<std::string> checkNamesAgainstMesh(const Deck& deck,
                                               const std::vector<std::string>& blockNames,
                                               const std::vector<std::string>& nodeSetNames,
                                               const std::vector<std::string>& sideSetNames);

/// Values out of the plane of a two-dimensional mesh, which would have no effect: one message each.
std::vector<std::string> problemsOfDimension(const Deck& deck, int dimension);
} // namespace coplane
