#pragma once

#include <coplane_dynamics/Model.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace coplane
{
class Solver;

/// What a run goes on with when a stage has ended: a restart in memory with another model of the
/// same mesh, blocks and laws, and what happens at its beginning.
struct Stage
{
  int index = 0;                ///< the first is 0
  Model model;                  ///< of the solver's part of the mesh
  std::vector<int> remove, add; ///< blocks of the mesh
  bool zeroDisplacements = false;
};

/// Asked at the end of every stage; nothing: that was the last one. Collective.
using NextStage = std::function<std::optional<Stage>(const Solver&)>;
} // namespace coplane
