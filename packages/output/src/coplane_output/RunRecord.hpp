#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_dynamics/Observer.hpp>

#include <chrono>
#include <string>
#include <vector>

namespace coplane
{
struct RunRecordOptions
{
  std::string file; ///< e.g. wall.run.json, next to the results
  std::string title;
  std::string commandLine;
  std::string deckFile;
  std::string deckText; ///< as it was used, with overrides
  std::string meshFile;
  std::string restartedFrom = {}; ///< checkpoint; empty: a new run
  double end = 0; ///< of the whole run, where the model is that of a stage [s]; 0: of the model
  std::string run = {}; ///< identity, by which restarts know what they may replace
};

/// Writes down in JSON what is needed to repeat or judge a run: versions, build, ranks x threads,
/// where they may run, deck and mesh with their SHA-256, sizes, the census of contact; and at the
/// end how it ended, energies, wall-clock times, the hash of the state. Written at the start
/// (ending "running"), renewed while the run goes on, and replaced at the end; always with the
/// warnings and errors that were shown, and what limited the step, so that they are known without
/// what the program printed. Warns in the log when threads share cores.
class RunRecord : public Observer
{
public:
  RunRecord(const Comm& comm, RunRecordOptions options); ///< collective

  void start(const Solver& solver) override;
  void endOfCycle(const Solver&) override {}
  void finish(const Solver& solver, const Ending& ending) override;

  /// Counts what limits the step now, the same on all ranks. A record keeps the last 50 of them.
  void noteLimit(const std::string& limit);
  /// Renews the record of the run that goes on. A file that cannot be written is a warning: the
  /// run is worth more. Called by all ranks, and not collective.
  /// @param secondsLeft of the wall's clock
  void renew(double secondsLeft);

private:
  struct Limit
  {
    std::string by;
    std::int64_t looks;
  };

  /// With what was said and what limited the step. On rank 0.
  template <class Json>
  void replace(Json json);

  RunRecordOptions options_;
  bool isRoot_;
  ReplacedFile file_;               ///< on rank 0
  std::string deckHash_, meshHash_; ///< on rank 0
  std::string placement_;           ///< JSON array: host, cores and threads of every rank
  std::string atStart_;             ///< JSON object: what was written at the start; on rank 0
  std::vector<Limit> limits_;       ///< the last that was seen stands at the end
  std::string startDate_;
  std::chrono::steady_clock::time_point begin_;
};
} // namespace coplane
