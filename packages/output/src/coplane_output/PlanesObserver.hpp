#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Observer.hpp>
#include <coplane_output/OutputSchedule.hpp>

#include <memory>
#include <string>

namespace coplane
{
class PlanesSeries;

enum class PlanesFormat
{
  VtkHdf, ///< base_planes.vtkhdf for all steps, and base_planes.xmf3
  Vtp     ///< base_planes.pvd and base_planes_0000.vtp, ...
};

struct PlanesOptions
{
  std::string base;          ///< what the names begin with
  OutputTimes when;          ///< as for the results
  std::string position = {}; ///< savePosition() of the run that is continued; empty: a new run
  std::string run = {};      ///< identity, by which a restart knows whether a series is its own
  PlanesFormat format = PlanesFormat::VtkHdf;
};

/// Writes the common planes as points for ParaView: the point of contact of every plane that exists
/// and whose faces overlap, with all its variables and history, sorted by key, so that the files do
/// not depend on the number of ranks. A killed run leaves a readable series.
class PlanesObserver : public Observer
{
public:
  PlanesObserver(const Comm& comm, PlanesOptions options); ///< collective
  ~PlanesObserver() override;

  void start(const Solver& solver) override;
  void endOfCycle(const Solver& solver) override;
  void savePosition(std::map<std::string, std::string>& positions) const override;
  void finish(const Solver& solver, const Ending& ending) override;

private:
  void write(const Solver& solver); ///< collective
  std::string nameInPosition() const;

  PlanesOptions options_;
  OutputSchedule schedule_;
  std::int64_t lastCycle_ = -1;          ///< that was written
  std::unique_ptr<PlanesSeries> series_; ///< on rank 0
};
} // namespace coplane
