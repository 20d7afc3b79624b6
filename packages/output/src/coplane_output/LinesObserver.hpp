#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Observer.hpp>
#include <coplane_output/OutputSchedule.hpp>

#include <memory>
#include <string>

namespace coplane
{
class VtpSteps;

struct LinesOptions
{
  std::string base;          ///< what the names begin with
  OutputTimes when;          ///< as for the results
  std::string position = {}; ///< savePosition() of the run that is continued; empty: a new run
  std::string run = {};      ///< identity, by which a restart knows whether a series is its own
};

/// Writes bolts, cables and bars for ParaView: <base>_lines.pvd and <base>_lines_0000.vtp, ... with
/// a straight cell for each segment of the lines that are there, where it is now. Every rank has
/// all lines with the same bits, so rank 0 writes without asking the others. A killed run leaves a
/// readable series.
class LinesObserver : public Observer
{
public:
  LinesObserver(const Comm& comm, LinesOptions options); ///< collective
  ~LinesObserver() override;

  void start(const Solver& solver) override;
  void endOfCycle(const Solver& solver) override;
  void endOfStage(const Solver& solver) override;
  void savePosition(std::map<std::string, std::string>& positions) const override;
  void finish(const Solver& solver, const Ending& ending) override;

private:
  void write(const Solver& solver); ///< collective
  std::string base() const;

  LinesOptions options_;
  OutputSchedule schedule_;
  std::int64_t lastCycle_ = -1;     ///< that was written
  std::unique_ptr<VtpSteps> steps_; ///< on rank 0
};
} // namespace coplane
