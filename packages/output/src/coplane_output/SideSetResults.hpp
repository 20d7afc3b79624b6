#pragma once

#include <coplane_exodus/ResultsFile.hpp>
#include <coplane_mesh/Redistribution.hpp>

#include <optional>
#include <string>
#include <vector>

namespace coplane
{
class Solver;

/// Variables that are written on the sides of every side set, in their order in the file.
std::vector<std::string> sideVariableNames();

/// Writes what the faces of the side sets see of their planes. A side that is not an exterior face
/// (two elements share it) has no planes: zeros.
class SideSetResults
{
public:
  /// Collective.
  SideSetResults(const Solver& solver, const ResultsFile& file);
  /// Within a step of the file. Collective.
  void write(const Solver& solver, ResultsFile& file) const;

private:
  std::vector<GlobalId> faces_; ///< of the sides that this rank brings, set after set
  std::optional<Redistribution> toFile_;
};
} // namespace coplane
