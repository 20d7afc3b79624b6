#pragma once

#include <coplane_contact/Plane.hpp>
#include <coplane_core/ExactSum.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

namespace coplane
{
/// Energies of contact since the start, summed over planes that live and planes that have ended
/// [J].
struct ContactEnergy
{
  Real stored = 0, friction = 0, hysteresis = 0, fracture = 0, damping = 0;
  Real eroded = 0; ///< was stored in planes when an element behind them died
  Real work = 0;   ///< done on the planes by the nodes
  /// What the work is not accounted for by the other terms: areas that change at fixed traction.
  Real remainder() const
  {
    return work - stored - friction - hysteresis - fracture - damping - eroded;
  }
};

/// What planes are told apart by in tables of energies: joint card and blocks. Whichever of the two
/// blocks has the lower face, they stand in the order of the mesh.
struct PlaneKind
{
  std::uint16_t joint = 0;
  std::uint16_t blocks[2] = {0, 0};

  explicit PlaneKind(const Plane& plane)
      : joint(plane.joint), blocks{std::min(plane.block[0], plane.block[1]),
                                   std::max(plane.block[0], plane.block[1])}
  {
  }
  PlaneKind() = default;
  bool operator<(const PlaneKind& other) const
  {
    return std::tie(blocks[0], blocks[1], joint) <
           std::tie(other.blocks[0], other.blocks[1], other.joint);
  }
  bool operator==(const PlaneKind& other) const { return !(*this < other || other < *this); }
};

/// Sums of energies of planes [J]. A plane that has ended stores nothing.
struct PlaneEnergySums
{
  enum Term
  {
    Work,
    Stored,
    Friction,
    Hysteresis,
    Fracture,
    Damping,
    Eroded,
    Terms
  };
  std::array<ExactSum, Terms> sums;

  void add(const Plane& plane, Real stored);
  void add(const PlaneEnergySums& other);
  static ContactEnergy energyOf(const Real* totals); ///< totals of all terms, in their order
};

/// Energies of planes that have ended, by kind, so that tables stay complete.
class EndedPlanes
{
public:
  /// eroded: what the plane stored when an element behind it died [J]
  void add(const Plane& plane, Real eroded = 0)
  {
    PlaneEnergySums& sums = byKind_[PlaneKind(plane)];
    sums.add(plane, 0);
    sums.sums[PlaneEnergySums::Eroded].add(eroded);
  }
  const std::map<PlaneKind, PlaneEnergySums>& byKind() const { return byKind_; }

  /// Exact sums over all ranks as a list of numbers, the same on all. Collective.
  std::vector<Real> numbers(const Comm& comm) const;
  /// Adds such a list.
  void addNumbers(const std::vector<Real>& numbers);

private:
  std::map<PlaneKind, PlaneEnergySums> byKind_;
};
} // namespace coplane
