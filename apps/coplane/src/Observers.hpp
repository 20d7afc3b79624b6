#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>
#include <coplane_output/MultiObserver.hpp>

#include <chrono>
#include <map>
#include <optional>
#include <string>

namespace coplane
{
/// How a run begins, and what the command line says of its end.
struct RunSettings
{
  std::string command;
  std::string restartedFrom;                    ///< checkpoint; empty: a new run
  std::map<std::string, std::string> positions; ///< of the outputs in that checkpoint
  std::string identity;        ///< that of the run in that checkpoint; empty: a new run
  Real end = 0;                ///< time.end of the last stage [s]
  int part = 1;                ///< of the series of results
  std::optional<Real> maxWall; ///< [s], from `begin` on
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
};

/// Variables of the laws of the mesh's blocks, each once, in the order of the blocks. Those that
/// are written anyway are left out.
std::vector<std::string> historyVariables(const Deck& deck, const MeshSlice& mesh);

/// Variables that outputs ask for and that are not there, a line for each. Laws have been checked.
std::vector<std::string> problemsOfOutputs(const Deck& deck, int dimension);

/// Throws what the history of a run would throw at its start, and writes nothing. Collective.
void demandPossibleOutputs(const Deck& deck, const MeshSlice& mesh, const Solver& solver);

/// Adds everything that a deck asks to be written: results, planes, history, progress, run record,
/// checkpoints. `observers` and `mesh` have to stay where they are. Collective.
void addObservers(MultiObserver& observers, const Deck& deck, const MeshSlice& mesh,
                  const Comm& comm, const RunSettings& settings);
} // namespace coplane
