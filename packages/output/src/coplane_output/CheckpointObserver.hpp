#pragma once

#include <coplane_checkpoint/CheckpointReader.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_dynamics/Observer.hpp>

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace coplane
{
struct CheckpointOptions
{
  std::string file;             ///< e.g. wall.chk: wall.chk.0 and wall.chk.1 are written in turn
  std::int64_t everyCycles = 0; ///< 0: never
  Real everySeconds = 0;        ///< of wall-clock time; 0: never
  bool atEnd = false;
  std::optional<Real> maxWall; ///< a checkpoint and the end after this time [s]
  std::string stopFile;        ///< the same as soon as this file is there; it is removed
  std::string restartedFrom;   ///< checkpoint, which is not the first to be overwritten
  /// Where outputs stood in the checkpoint of the restart: handed on of those that are not written.
  std::map<std::string, std::string> positions = {};
  /// What another run compares itself with, by name.
  std::vector<std::pair<std::string, std::string>> texts;
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
};

/// Removes a stop file; whether it was there. One that cannot be removed counts as well, with a
/// warning: whoever made it wants the run to end.
bool takeStopFile(const std::string& file);

/// Writes checkpoints: every so many cycles or seconds, when a signal asks for one, and before an
/// end that was asked for. Comes after all outputs, whose positions go into the checkpoint. One
/// that is not written in the middle of a run is a warning; before an end it is an error.
class CheckpointObserver : public Observer
{
public:
  /// outputs: what has positions. Collective.
  CheckpointObserver(const Comm& comm, CheckpointOptions options, const Observer& outputs);

  void start(const Solver& solver) override;
  void endOfCycle(const Solver& solver) override;
  void finish(const Solver& solver, const Ending& ending) override;

private:
  void write(const Solver& solver); ///< collective
  void askByClockAndFile();

  using WallClock = std::chrono::steady_clock;
  const Comm* comm_;
  CheckpointOptions options_;
  const Observer* outputs_;
  int slot_ = 0;                    ///< the next one
  std::vector<ReplacedFile> slots_; ///< on rank 0
  std::int64_t lastCycle_ = -1;
  WallClock::time_point last_, looked_;
};

/// The newest checkpoint `file`.0 or .1 that is whole. Warns of one that is not. Throws
/// Error(ExitCode::Checkpoint) when there is none. Collective.
std::string newestCheckpoint(const std::string& file, const Comm& comm);

/// Whether a checkpoint is `file`.0 or .1, by whatever name. Collective.
bool isOneOfTwo(const std::string& file, const std::string& checkpoint, const Comm& comm);

/// Puts checkpoints of an earlier run aside under a name with the time when they were written,
/// `file`.0.old-20261122-064405, so that no number of new runs ever overwrites one. Says how to go
/// on from them and how to get rid of them. Throws Error(ExitCode::Output) when that fails.
/// Collective.
void putAside(const std::string& file, const Comm& comm);

/// At a restart from one of the two: puts the other one aside, with a warning, unless it is a whole
/// checkpoint of which `isOwn` says yes. Collective, also isOwn.
void putOtherAside(const std::string& file, const std::string& restartedFrom, const Comm& comm,
                   const std::function<bool(const CheckpointReader&)>& isOwn);

/// Positions of the outputs in a checkpoint. Collective.
std::map<std::string, std::string> positionsIn(const CheckpointReader& checkpoint);
} // namespace coplane
