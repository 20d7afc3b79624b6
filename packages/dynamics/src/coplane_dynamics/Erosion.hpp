#pragma once

#include <coplane_contact/Substep.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/ExactSum.hpp>
#include <coplane_dynamics/ElementForces.hpp>
#include <coplane_dynamics/ErosionRule.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace coplane
{
/// What erosion has taken so far, over all ranks.
struct ErosionTotals
{
  std::int64_t elements = 0;
  Real mass = 0; ///< of the elements; nodes keep that of eroded ones [kg]
};

/// Elements that die: they leave the mesh at the end of the cycle in which they meet their
/// criterion, and the faces behind them take part in contact from the same cycle on.
class Erosion
{
public:
  Erosion(const Model& model, const ElementForces& elements);

  /// Takes out the elements that meet their criterion, and those of blocks that leave. Returns
  /// their ids, sorted, on all ranks; empty when there are none on any. Collective when it acts.
  /// @param cycle by which the elements came here; last: step of those at a node with several
  ///        `substeps` in it
  /// @param leaving blocks that a stage removes: their elements take their mass along
  std::vector<GlobalId> erode(const RankMesh& mesh, ElementForces& elements, const Substep& cycle,
                              const Array<Real>& substeps, const Substep& last,
                              const std::vector<int>& leaving, const Comm& comm);
  /// Takes blocks out that are not there yet; nothing is booked.
  void beginWithout(const std::vector<int>& blocks, const RankMesh& mesh, ElementForces& elements);
  /// After elements have come in.
  void recount(const RankMesh& mesh, const ElementForces& elements);
  /// Ids of all elements that have died or are not there, sorted, on all ranks. Collective.
  std::vector<GlobalId> dead(const RankMesh& mesh, const ElementForces& elements,
                             const Comm& comm) const;
  /// Energy that goes with elements, or comes with them: negative [J].
  void bookEnergy(int block, Real energy) { energies_[std::size_t(block)].add(energy); }

  /// Some block has a criterion, or leaves or comes in a stage.
  bool acts() const { return acts_; }
  /// Whether all elements of an owned node have died.
  bool isFree(int node) const { return acts_ && livingElements_[node] == 0; }
  /// Exterior faces of what is alive; only when erosion acts.
  std::vector<ExteriorFace> exterior() const { return sides_->exterior(alive_); }
  ErosionTotals totals(const Comm& comm) const; ///< collective
  /// Energy of a block's elements on this rank that have died [J].
  const std::vector<ExactSum>& energies() const { return energies_; }

  // Part of a checkpoint. Collective.
  void save(StateTables& out, const Comm& comm) const;
  /// After the elements have been restored. Returns the ids of the dead, sorted, on all ranks.
  std::vector<GlobalId> restore(const RankMesh& mesh, const ElementForces& elements,
                                const StateSource& in, const Comm& comm);

private:
  std::vector<std::pair<int, int>> dying(const ElementForces& elements,
                                         const std::vector<int>& leaving) const;
  void book(const RankMesh::Block& part, const ElementBlock& block, int b, int e,
            const Substep& step);
  void forget(const RankMesh::Block& part, int b, int e);

  bool acts_ = false;
  std::vector<std::optional<ErosionRule>> rules_; ///< by block
  std::optional<ElementSides> sides_;
  std::vector<std::vector<char>> alive_; ///< [block][element]
  std::vector<int> livingElements_;      ///< around each owned node
  // Of this rank, since the start.
  std::vector<ExactSum> energies_; ///< by block [J]
  ExactSum mass_;
  std::int64_t count_ = 0;
};
} // namespace coplane
