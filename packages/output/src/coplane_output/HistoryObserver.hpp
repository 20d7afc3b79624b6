#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_dynamics/Observer.hpp>
#include <coplane_output/OutputSchedule.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace coplane
{
class HistoryColumns;

/// A place whose motion is recorded: the mean over a node set, the mass-weighted mean over the
/// nodes of an element block, or the node nearest to a point. Or the plane nearest to a point that
/// goes with that node.
struct Probe
{
  std::string name;
  int nodeSet = -1;               ///< position in Mesh::nodeSets, or
  int block = -1;                 ///< position in Mesh::blocks
  bool reaction = false;          ///< also the sum of the reactions on the nodes of the set
  std::optional<Vec3> point = {}; ///< or that, at the start [m]
  /// Of the element nearest to the point, or least and largest of the block or node set; stress and
  /// strain stand for their components.
  std::vector<std::string> variables = {};
  bool plane = false;     ///< of the point: the nearest plane, in place of the motion
  std::string joint = {}; ///< of the plane; empty: any
  int relativeTo = -1;    ///< position of the probe from whose motion this one's is counted
};

/// Variables of nodes of which a probe can have the extremes over a node set: names of the results,
/// and displacement and velocity for their lengths.
const std::vector<std::string>& nodalVariables();

struct HistoryOptions
{
  std::string file; ///< CSV
  Real every = 0;   ///< [s]; 0: every cycle
  std::vector<Probe> probes;
  std::vector<std::string> joints; ///< joint cards whose planes are summed up in columns
  bool stateHash = false; ///< one more column: the hash of the whole state, for comparing runs
  /// Rigid blocks (positions in Mesh::blocks) whose bodies are recorded in columns.
  std::vector<int> rigidBlocks = {};
  std::vector<std::string> leaving =
      {};                    ///< blocks that stages take out: probes there are warned of
  std::string position = {}; ///< savePosition() of the run that is continued; empty: a new run
};

/// Writes one line per output time: the whole energy ledger, momenta, counts of planes, probes. All
/// numbers have the same bits for any number of ranks and threads and are written so that they can
/// be read back exactly. The header names columns with units; every line is in the file as soon as
/// its cycle has ended.
class HistoryObserver : public Observer
{
public:
  /// Creates the file. Collective.
  HistoryObserver(const Comm& comm, HistoryOptions options);

  /// Throws what a run with these options would throw at its start: variables that a law has not,
  /// two columns of one name, no distance to what a probe is relative to. Writes nothing.
  /// Collective.
  static void demandPossible(const Solver& solver, HistoryOptions options);

  void start(const Solver& solver) override;
  void endOfCycle(const Solver& solver) override;
  void endOfStage(const Solver& solver) override;
  void repartitioned(const Solver& solver) override;
  void savePosition(std::map<std::string, std::string>& positions) const override;
  void finish(const Solver& solver, const Ending& ending) override;

private:
  using NamedValues = std::vector<std::pair<std::string, Real>>;
  /// A node of a probe and its share of the mean (not divided by the sum of all shares).
  struct Share
  {
    int node;
    Real weight;
  };

  // Collective.
  void findShares(const Solver& solver);
  void demandDistances(const Comm& comm) const;
  void warnOfLeaving(const Solver& solver) const;
  HistoryColumns columnsOf(const Solver& solver) const;
  void write(const Solver& solver);
  std::vector<Real> probeValues(const Solver& solver) const;
  void findElements(const Solver& solver);
  /// Columns and values of the variables of a probe.
  NamedValues variablesOf(const Solver& solver, std::size_t probe) const;
  /// Of those of planes, in the order of the probes; values count on rank 0.
  std::vector<NamedValues> planeValues(const Solver& solver,
                                       const std::vector<Real>& motions) const;
  std::vector<Vec3> reactions(const Solver& solver) const; ///< per probe, zero if not wanted [N]

  HistoryOptions options_;
  OutputSchedule schedule_;
  TextTable table_;             ///< open on rank 0
  std::int64_t lastCycle_ = -1; ///< that was written
  bool hasHeader_ = false;
  Real initialKinetic_ = 0;                  ///< [J]
  std::vector<std::vector<Share>> shares_;   ///< per probe, owned nodes
  std::vector<Real> totalWeight_;            ///< per probe, over all ranks
  std::vector<Vec3> places_;                 ///< per probe, its mean place at the start [m]
  std::vector<std::pair<int, int>> nearest_; ///< per probe, block and element here, or -1
};
} // namespace coplane
