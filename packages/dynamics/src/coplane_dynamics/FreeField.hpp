#pragma once

#include <coplane_checkpoint/StateTables.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_dynamics/ElementForces.hpp>
#include <coplane_dynamics/FreeFieldLayers.hpp>
#include <coplane_dynamics/Model.hpp>
#include <coplane_dynamics/NodalState.hpp>

#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// The ground beside a vertical side as if it went on level without end: a column of the side's
/// layers in which all motion depends on the height alone. It moves under its own weight and with
/// its own base, which does what the base of the model does beside it, and feels nothing of the
/// model. Every rank has all columns with the same bits.
///
/// A column has one element for each layer, of the law and the form of the element behind the side,
/// whose corners at one height move together. So forces, masses and dashpots count per horizontal
/// area: levels have m [kg/m^2] and F [Pa].
class FreeFieldColumn
{
public:
  /// Finds the layers of the side and what conditions hold at its levels. Throws on all ranks where
  /// the side is not vertical, plane and layered. Collective.
  FreeFieldColumn(std::size_t boundary, const Model& model, const Comm& comm);

  const std::string& name() const { return name_; } ///< of the side set
  bool hasStarted() const { return started_; }
  /// From the state of the side: the stress and the history of the elements behind it, the motion
  /// of its nodes. What is out of balance then stays as a constant force. Collective.
  void start(Real t, const Conditions& conditions, const RankMesh& mesh, const NodalState& state,
             const ElementForces& elements, const Comm& comm);
  /// Drift from n to n + 1 and stresses there.
  void advance(Real dt);
  /// v(n-1/2) to v(n+1/2).
  void kick(const KickTimes& times, const Conditions& conditions, Real massDamping,
            Real localDamping);
  /// Velocities that nothing prescribes are zero (NodalMotion::stop).
  void stop(const KickTimes& times, const Conditions& conditions);
  Real stableStep() const; ///< [s]; infinity before the start

  /// At a corner of a face of the side at n, as the mean of both half steps [m/s].
  Vec3 velocity(const LoadedSide& side, int corner) const;
  /// Force per area of the ground beyond on a corner of a face of the side [Pa].
  Vec3 traction(const LoadedSide& side, int corner) const;

  /// Part of a checkpoint. Collective.
  void save(StateTables& out) const;
  void restore(const StateSource& in);
  void addTo(StateHash& hash, std::uint64_t field, GlobalId id) const;

private:
  /// Conditions that hold all nodes of a level, by their positions in Conditions.
  struct Holds
  {
    std::vector<std::size_t> velocities, symmetries;
  };
  /// A corner of the element of a layer: on the side or within, at the foot or the top.
  struct Corner
  {
    bool outer = false;
    int end = 0;
    Vec3 place{}; ///< at the start [m]
  };
  struct LayerElement
  {
    int block = 0, element = 0; ///< of blocks_
    Real area = 0;              ///< horizontal [m^2]
    std::vector<Corner> corners;
  };
  /// Dashpots at the foot [Pa s/m], and what the wave that enters there pushes with [Pa].
  struct Base
  {
    Real normal = 0, shear = 0;
    Vec3 wave{};
    bool acts = false;
  };

  /// Collective.
  void findConditions(const Model& model, const Comm& comm);
  LayerElement elementOf(const FreeFieldLayer& layer, int index, ElementType type) const;
  void makeElements(const Model& model);
  /// Collective.
  void takeMotion(const Conditions& conditions, const RankMesh& mesh, const NodalState& state,
                  const Comm& comm);
  /// Collective.
  void takeElements(const Conditions& conditions, const RankMesh& mesh,
                    const ElementForces& elements, const Comm& comm);
  void tellStart(Real t, const Conditions& conditions) const;
  void placeCorners();
  void sumForces();
  Base baseAt(const Conditions& conditions, Real t, Real middle) const;
  /// Z v of the dashpots at the foot [Pa].
  Vec3 dragOf(const Base& base, const Vec3& v) const;
  void clearHeld(std::size_t level, const Conditions& conditions, Real middle, Vec3& force) const;
  Vec3 prescribed(std::size_t level, const Conditions& conditions, const KickTimes& times,
                  const Vec3& before, Vec3 v) const;
  std::size_t levels() const { return velocity_.size(); }
  std::size_t cornersPerElement() const { return dimension_ == 2 ? 4 : 8; }
  std::pair<std::size_t, std::size_t> layerOf(const LoadedSide& side, int corner) const;
  std::string tableName() const;
  std::vector<Real> numbers() const;
  template <class Self, class F>
  static void forEachVector(Self& self, F&& f);

  std::string name_, where_;
  std::size_t boundary_; ///< position in Conditions::freeFields
  Window when_;
  int dimension_;
  FreeFieldLayers layers_;
  std::vector<Holds> holds_;            ///< by level
  std::vector<std::size_t> basesBelow_; ///< absorbing boundaries at the foot of the side
  std::vector<ElementBlock> blocks_;    ///< one of each block of the mesh at the side
  std::vector<LayerElement> elements_;  ///< by layer
  NodeVectors x_, v_;                   ///< of their corners, layer by layer

  bool started_ = false;
  std::vector<Real> mass_;                    ///< by level, as are [kg/m^2]
  std::vector<Vec3> displacement_;            ///< [m]
  std::vector<Vec3> velocity_, previous_;     ///< at n + 1/2 and n - 1/2 [m/s]
  std::vector<Vec3> force_;                   ///< of elements [Pa]
  std::vector<Vec3> support_;                 ///< constant [Pa]
  std::vector<Vec3> reaction_;                ///< of prescribed motions at n [Pa]
  std::vector<std::array<Vec3, 2>> traction_; ///< by layer, at its foot and its top [Pa]
};

/// The columns of all free-field sides of a run.
class FreeFields
{
public:
  /// Collective.
  FreeFields(const Model& model, const Comm& comm);

  bool empty() const { return columns_.empty(); }
  /// Columns whose sides begin to act in the middle of this step. Collective.
  void start(const KickTimes& times, const Conditions& conditions, const RankMesh& mesh,
             const NodalState& state, const ElementForces& elements, const Comm& comm);
  void advance(Real dt);
  void kick(const KickTimes& times, const Conditions& conditions, Real massDamping,
            Real localDamping);
  void stop(const KickTimes& times, const Conditions& conditions);
  Real stableStep() const; ///< [s]
  /// The first of those that have it; nullptr: there are none.
  const FreeFieldColumn* columnWithLeastStep() const;
  /// In the order of Conditions::freeFields.
  const FreeFieldColumn& column(std::size_t boundary) const { return columns_[boundary]; }

  // Part of a checkpoint. Collective.
  void save(StateTables& out) const;
  void restore(const StateSource& in);
  void addTo(StateHash& hash, std::uint64_t field) const;

private:
  std::vector<FreeFieldColumn> columns_;
};
} // namespace coplane
