#pragma once

#include <coplane_checkpoint/StateTables.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_dynamics/ElementForces.hpp>
#include <coplane_dynamics/Line.hpp>
#include <coplane_dynamics/NodalState.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <array>
#include <vector>

namespace coplane
{
/// All lines of a run. Every rank has all of them with the same bits: the owner of an element tells
/// where a point in it is, and every rank adds to the nodes that it owns, point after point.
class Lines
{
public:
  /// Finds the elements that hold the points, and where lines cross from one body to another.
  /// Throws on all ranks where a point is in no element. Collective.
  Lines(const std::vector<LineSetup>& setups, const RankMesh& mesh, const Comm& comm);

  bool empty() const { return lines_.empty(); }
  /// Forces and stiffness of lines at t are added to those of the owned nodes. Collective.
  /// @param dt the step that ends at t [s]; alone: no contact has written the stiffness of nodes
  void addForces(const ElementForces& elements, NodalState& state, Real t, Real dt, int stage,
                 bool alone);

  /// Moments from beyond planes of symmetry come from outside: the angular impulse of a kick.
  /// @param dt of the kick [s]
  void bookOuterMoments(NodalState& state, Real dt) const;

  const std::vector<Line>& lines() const { return lines_; }
  LineEnergy energy() const; ///< the same bits on all ranks
  /// Stiffness of lines at an owned node [N/m].
  Real stiffnessAt(int node) const;

  // Part of a checkpoint. Collective.
  void save(StateTables& out) const;
  void restore(const StateSource& in);
  void addTo(StateHash& hash, std::uint64_t field) const;

private:
  /// A point of a line in an element that this rank holds.
  struct Embedded
  {
    int point = 0; ///< of all points of all lines, dowels included
    int block = 0, element = 0;
    bool owned = false; ///< the element
    int count = 0;
    std::array<int, 8> nodes{};
    std::array<Real, 8> weights{};
  };
  void embed(const std::vector<Vec3>& places, const std::vector<GlobalId>& hosts,
             const RankMesh& mesh);
  /// Collective.
  std::vector<LineHosts> gatherHosts(const ElementForces& elements, const NodalState& state) const;

  const Comm* comm_;
  int owned_ = 0; ///< nodes
  std::vector<Line> lines_;
  std::vector<int> firstPoints_, pointsOf_; ///< by line; dowels come behind its points
  std::vector<Vec3> axes_;                  ///< of points [-]
  int points_ = 0;
  std::vector<Embedded> embedded_; ///< in the order of the points
};
} // namespace coplane
