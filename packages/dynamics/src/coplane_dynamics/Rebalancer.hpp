#pragma once

#include <coplane_dynamics/Model.hpp>
#include <coplane_dynamics/WorkTimes.hpp>
#include <coplane_mesh/MeshSlice.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace coplane
{
class Solver;

struct RebalanceOptions
{
  enum class When
  {
    Never,
    Auto,  ///< when it pays
    Always ///< at every look, for tests
  } when = When::Never;
  std::int64_t every = 500; ///< cycles from one look to the next
  Real above = 1.1;         ///< the busiest rank's work over the mean above which it may pay
  std::string method = "multijagged"; ///< as nodeOwners() has it
  /// What a rebalance costs, until one has been measured, as far as this rank knows [s].
  double firstCost = 0;
};

/// A pair whose faces lie over each other takes about twice as long as one that passes by: two
/// plates of 50 x 50 quadrilaterals, shifted against each other and not.
constexpr Real costOfOverlap = 2;

/// What the owned nodes cost [s]: the measured work of this rank, dealt out within each kind by
/// counts of what is there now. Elements of a block that live cost the same, as do faces and nodes;
/// pairs that lie over each other cost more than others. So the costs of all nodes of a rank add up
/// to its work.
std::vector<Real> costsOfOwnedNodes(const Solver& solver, const WorkTimes& work);

/// Another partition and how good it would be.
struct RebalancePlan
{
  std::vector<int> owners; ///< of the nodes of this rank's slice of the mesh
  double busiest = 0;      ///< work of the busiest rank, in the time in which `work` was done [s]
  Real imbalance = 1;      ///< that over the mean
  std::int64_t moved = 0;  ///< nodes that would change their rank
};
/// A partition on the present positions, by the costs of work done. Collective.
RebalancePlan planRebalance(const Solver& solver, const MeshSlice& mesh, const std::string& method,
                            const WorkTimes& work);

/// Decides whether a rebalance pays. What it would have saved is summed up; once that exceeds its
/// cost, and the rest of the run will save as much again, it is due. So waiting never loses more
/// than a rebalance costs.
class RebalanceLedger
{
public:
  explicit RebalanceLedger(double cost) : cost_(cost) {}
  double cost() const { return cost_; }

  /// @param saved by another partition, in the time since the last look [s]
  /// @param rest that it will save until the end of the run [s]
  bool pays(double saved, double rest);
  void done(double cost); ///< a rebalance, which took so long [s]

private:
  double cost_;     ///< of a rebalance [s]
  double lost_ = 0; ///< since the last one [s]
};

/// Watches how evenly the ranks work, and deals the mesh out anew when that pays.
class Rebalancer
{
public:
  /// `mesh` has to live as long. Collective: the first cost is the largest that a rank names.
  /// @param modelOf the model of the run for another part of the mesh
  Rebalancer(const Comm& comm, const MeshSlice& mesh, RebalanceOptions options,
             std::function<Model(RankMesh)> modelOf);

  /// At the end of a cycle: looks if it is time to, and gives the solver another part when that
  /// pays; with the same bits. Returns whether it did. All ranks decide alike. Collective.
  bool look(Solver& solver);

private:
  bool isTime(std::int64_t cycle);
  void rebalance(Solver& solver, const RebalancePlan& plan);

  const MeshSlice* mesh_;
  RebalanceOptions options_;
  std::function<Model(RankMesh)> modelOf_;
  RebalanceLedger ledger_;
  std::int64_t nextLook_ = -1; ///< cycle
};
} // namespace coplane
