#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_dynamics/Observer.hpp>
#include <coplane_output/OutputSchedule.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace coplane
{
struct PlanesOptions
{
  std::string base;          ///< base_planes.pvd and base_planes_0000.vtp, ... are written
  OutputTimes when;          ///< as for the results
  std::string position = {}; ///< savePosition() of the run that is continued; empty: a new run
  std::string run = {};      ///< identity, by which a restart knows whether a series is its own
};

/// Writes the common planes as points for ParaView: the point of contact of every plane that exists
/// and whose faces overlap, with all its variables and history, sorted by key, so that the files do
/// not depend on the number of ranks. The .pvd names all steps with their times; it is replaced as
/// a whole after each step, so that a killed run leaves a readable series.
class PlanesObserver : public Observer
{
public:
  PlanesObserver(const Comm& comm, PlanesOptions options); ///< collective

  void start(const Solver& solver) override;
  void endOfCycle(const Solver& solver) override;
  void savePosition(std::map<std::string, std::string>& positions) const override;
  void finish(const Solver& solver, const std::string& ending) override;

  /// base + "_planes.pvd"
  std::string file() const { return base_ + "_planes.pvd"; }
  std::string fileOf(const std::string& step) const; ///< with its folder

private:
  void write(const Solver& solver); ///< collective
  void clearTheWay();
  void writeSeries() const;

  std::string base_, run_;
  mutable std::optional<ReplacedFile> series_; ///< on rank 0
  bool continues_;
  OutputSchedule schedule_;
  std::int64_t lastCycle_ = -1;                     ///< that was written
  int firstNumber_ = 0;                             ///< of the files of the steps
  std::vector<std::pair<Real, std::string>> steps_; ///< time [s] and file name without folder
};
} // namespace coplane
