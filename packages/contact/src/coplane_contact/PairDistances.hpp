#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/Search.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/NodeViews.hpp>

namespace coplane
{
/// How far the faces of each pair of a search must be from each other, from where they were at the
/// search, what it foresaw, and how far their nodes have strayed from that since. A pair that
/// cannot touch need not be looked at: most of those that a search finds in a wall that has come
/// apart.
///
/// All of one face lies beyond all of the other along some direction that does not lean against the
/// pair's normal (docs/theory/scp.md, stepE_planeExists). Along the way that the search foresaw,
/// the least height of the nodes beyond is concave in time, and their largest height before convex:
/// the gap is at least what lies on the line between its values at the search and at the end of the
/// way, where it stays then but for the motion that all share. What a node strays takes off at most
/// as much, and for warped faces, whose mean planes stand for them, three times that. The gap
/// counts up to what nodes may stray before the normal leans against the direction.
class PairDistances
{
public:
  using SlotTable = Kokkos::View<SlotFaces*, Kokkos::HostSpace>;
  /// Where the search saw nodes, and what it foresaw of them.
  struct Seen
  {
    ConstNodeVectors x, v; ///< copies; v may be empty: nothing moves
    Real ahead = 0;        ///< for how long it looked ahead [s]
    Vec3 frame{};          ///< velocity that all have [m/s]
    Real offset = 0;       ///< largest gap at which a plane touches [m]
    Real leastOpposed = 0; ///< faces with -n0.n1 not above this do not act on each other [-]
  };

  /// A search has been made. @param planes of the faces at the search; mayReach: by slot, 1 where
  /// pairs may act while they are open, at whatever distance
  void take(const SlotTable& slots, const Array<Face>& faces, const Array<FacePlane>& planes,
            const Array<std::uint8_t>& mayReach, const Seen& seen);
  /// No pair is known to be far.
  void forget();

  /// Faces are at x now, since the search by this time [s]. What may touch within the look-ahead at
  /// the velocities that they have is not far.
  void follow(const ConstNodeVectors& x, const ConstNodeVectors& v, Real since, Real lookAhead);

  /// Whether the faces of a pair are apart, or do not oppose each other, and stay so within the
  /// look-ahead.
  bool isFar(int slot) const
  {
    if (!known())
      return false;
    const SlotFaces& faces = slots_(slot);
    return gap_(slot) + closing_(slot) * later_ > strayed_(faces.face[0]) + strayed_(faces.face[1]);
  }
  /// isFar() of the slots from `first` on; those without faces are not far. Only if known().
  /// @param far by slot from the first on: 1 or 0
  void areFar(int first, int count, std::uint8_t* far) const
  {
    const SlotFaces* const faces = slots_.data() + first;
    const float *const gap = gap_.data() + first, *const closing = closing_.data() + first;
    const float* const strayed = strayed_.data();
    const float later = later_;
    for (int i = 0; i < count; ++i)
    {
      // Without faces the gap is negative: any face will do.
      const std::int32_t a = faces[i].face[0] < 0 ? 0 : faces[i].face[0],
                         b = faces[i].face[1] < 0 ? 0 : faces[i].face[1];
      far[i] = gap[i] + closing[i] * later > strayed[a] + strayed[b];
    }
  }
  /// Whether a pair may be left out while its faces are apart by more than reach().
  bool mayBeLeftOut(int slot) const { return known() && mayReach_(slot) == 0; }
  Real reach() const { return seen_.offset; } ///< [m]
  /// Whether anything is known.
  bool known() const { return gap_.extent(0) > 0 && strayed_.extent(0) > 0; }

private:
  SlotTable slots_;
  Array<Face> faces_;
  Seen seen_;
  // By slot: the gap at the search, as far as it counts [m], and its rate, not positive [m/s].
  // Rounded to the safe side.
  Array<float> gap_, closing_;
  Array<std::uint8_t> mayReach_;
  Array<float> strayedNodes_; ///< [m]
  Array<float> strayed_;      ///< by face, thrice its nodes' [m]
  float later_ = 0;           ///< [s]
};
} // namespace coplane
