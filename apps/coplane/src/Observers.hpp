#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/Mesh.hpp>
#include <coplane_output/MultiObserver.hpp>

#include <string>

namespace coplane
{
/// Everything that a deck asks to be written: results, planes, history, progress, run record.
/// Collective.
MultiObserver observersOf(const Deck& deck, const Mesh& mesh, const Comm& comm,
                          const std::string& command);
} // namespace coplane
