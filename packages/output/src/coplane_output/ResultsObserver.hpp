#pragma once

#include <coplane_dynamics/Observer.hpp>
#include <coplane_exodus/ResultsFile.hpp>
#include <coplane_mesh/MeshSlice.hpp>
#include <coplane_mesh/Redistribution.hpp>
#include <coplane_output/Fragments.hpp>
#include <coplane_output/OutputSchedule.hpp>
#include <coplane_output/SideSetResults.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace coplane
{
struct ResultsOptions
{
  std::string file; ///< Exodus file, e.g. wall.e
  OutputTimes when;
  bool filePerRank = false;              ///< file.N.r, to be joined by `epu -auto`
  std::vector<std::string> infoLines;    ///< kept in the file: command line, deck
  std::vector<std::string> history = {}; ///< variables of the blocks' laws that are written besides
  /// Those of nodes and elements that are written, by names of variables, vectors and tensors;
  /// empty: all. Displacement and alive are in any case.
  std::vector<std::string> variables = {};
  std::shared_ptr<BodiesOfCycle> bodies = {}; ///< are written if given
  int part = 1;              ///< of a series: 1 for a new run, one more with every restart
  std::string position = {}; ///< savePosition() of the run that is continued
  std::string run = {};      ///< identity, by which restarts know what they may cut or remove
};

/// Name of a part of a series of results: wall.e, wall.e-s0002, ...
std::string resultsPart(const std::string& file, int part);

/// Names by which variables of nodes and elements can be chosen: of the variables, and of vectors
/// and tensors without the ends _x and _xx.
/// @param history variables of the blocks' laws that are written besides
std::vector<std::string> resultsChoices(int dimension, const std::vector<std::string>& history,
                                        bool fragments);

/// What one step of the results takes in files [bytes].
/// @param chosen as ResultsOptions::variables
std::int64_t bytesOfResultsStep(const MeshSlice& mesh, const std::vector<std::string>& history,
                                bool fragments = false,
                                const std::vector<std::string>& chosen = {});

/// Writes the Exodus results: at t = 0, in the first cycle at or after each due time, on request
/// (SIGUSR1) and at the end. Names and their order are those that ParaView's IOSS reader groups
/// into vectors and tensors; `displacement` comes first, so that the reader applies it to the mesh.
/// README.md of this package lists all variables with units.
class ResultsObserver : public Observer
{
public:
  /// Creates the file, so that a folder that cannot be written to is found before anything is
  /// computed; a later part of a series is created with its first step. Cuts off steps that the
  /// run before has written after the position, and removes later parts. `mesh` has to live as
  /// long. Collective.
  ResultsObserver(const Comm& comm, const MeshSlice& mesh, ResultsOptions options);

  void start(const Solver& solver) override;
  void endOfCycle(const Solver& solver) override;
  void endOfStage(const Solver& solver) override;
  void repartitioned(const Solver& solver) override;
  void savePosition(std::map<std::string, std::string>& positions) const override;
  /// Writes the last state, unless the last cycle has been written, and closes the file.
  void finish(const Solver& solver, const Ending& ending) override;

  int steps() const { return file_ ? file_->steps() : 0; }

private:
  void continueSeries(); ///< collective
  void open();
  void prepare(const Solver& solver);
  void write(const Solver& solver);
  void writeNodes(const Solver& solver);
  void writeElements(const Solver& solver);

  const Comm* comm_;
  const MeshSlice* mesh_;
  ResultsOptions options_;
  int dimension_;
  std::vector<std::string> history_;
  OutputSchedule schedule_;
  std::vector<int> nodal_, element_; ///< places of what is written among all variables
  std::optional<ResultsFile> file_;
  std::int64_t lastCycle_ = -1; ///< that was written
  /// From owned nodes and elements to the contiguous ranges of the file.
  std::optional<Redistribution> nodesToFile_, elementsToFile_;
  std::optional<SideSetResults> sides_; ///< when the mesh has side sets
};
} // namespace coplane
