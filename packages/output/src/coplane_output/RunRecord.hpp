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
  std::string run = {};           ///< identity, by which restarts know what they may replace
};

/// Writes down in JSON what is needed to repeat or judge a run: versions, build, ranks x threads,
/// where they may run, deck and mesh with their SHA-256, sizes, the census of contact; and at the
/// end how it ended, energies, wall-clock times, the hash of the state. Written at the start
/// (ending "running") and replaced at the end. Warns in the log when threads share cores.
class RunRecord : public Observer
{
public:
  RunRecord(const Comm& comm, RunRecordOptions options); ///< collective

  void start(const Solver& solver) override;
  void endOfCycle(const Solver&) override {}
  void finish(const Solver& solver, const std::string& ending) override;

private:
  void write(const Solver& solver, const std::string& ending) const; ///< collective

  RunRecordOptions options_;
  mutable ReplacedFile file_;       ///< on rank 0
  std::string deckHash_, meshHash_; ///< on rank 0
  std::string placement_;           ///< JSON array: host, cores and threads of every rank
  std::string census_; ///< JSON object: contact before the first step; empty without contact
  std::string startDate_;
  std::chrono::steady_clock::time_point begin_;
};
} // namespace coplane
