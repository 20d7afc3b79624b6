#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_dynamics/Observer.hpp>
#include <coplane_output/OutputSchedule.hpp>

#include <map>
#include <string>
#include <vector>

namespace coplane
{
struct TablesOptions
{
  std::string base;       ///< base_blocks.csv, base_pairs.csv, ... are written
  Real every = 0;         ///< [s]; 0: every cycle
  bool blocks = false;    ///< energies of every element block
  bool pairs = false;     ///< energies of contact between every two blocks
  bool materials = false; ///< the same between every two materials
  bool lines = false;     ///< every segment of every line
  std::map<std::string, std::string> positions = {}; ///< of the run that is continued
};

/// Writes energies by block, by pair of blocks and by pair of materials, and segments of lines, as
/// CSV, a line for each of them at each output time, so that tables can grow when blocks meet. The
/// sums of energies over a table are those of the history.
class TablesObserver : public Observer
{
public:
  /// Creates the files. Collective.
  TablesObserver(const Comm& comm, TablesOptions options);

  void start(const Solver& solver) override;
  void endOfCycle(const Solver& solver) override;
  void endOfStage(const Solver& solver) override;
  void repartitioned(const Solver& solver) override;
  void savePosition(std::map<std::string, std::string>& positions) const override;
  void finish(const Solver& solver, const Ending& ending) override;

private:
  std::string fileOf(const char* table) const;
  /// A node of a block and the mass that the block's elements bring to it [kg].
  struct Share
  {
    int node;
    Real mass;
  };

  // Collective.
  void findShares(const Solver& solver);
  void write(const Solver& solver);
  std::string blockLines(const Solver& solver) const;
  std::string pairLines(const Solver& solver) const;
  std::string materialLines(const Solver& solver) const;
  static std::string segmentLines(const Solver& solver);

  TablesOptions options_;
  OutputSchedule schedule_;
  TextTable blocks_, pairs_, materials_, lines_; ///< open on rank 0
  std::int64_t lastCycle_ = -1;                  ///< that was written
  std::vector<std::vector<Share>> shares_;       ///< per block, owned nodes
  /// Mass of each block over that of all rigid blocks of a body; [body * blocks + block]
  std::vector<Real> partOfBody_;
};
} // namespace coplane
