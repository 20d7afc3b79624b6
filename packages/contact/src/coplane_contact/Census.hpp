#pragma once

#include <coplane_contact/Contact.hpp>

#include <array>
#include <string>
#include <vector>

namespace coplane
{
/// How a length is spread over pairs, over all ranks.
struct CensusLengths
{
  struct Pair
  {
    GlobalId faceId[2];
    Real length; ///< [m]
  };

  std::int64_t count = 0;
  /// Fractions of the pairs that have at most the lengths of `quantiles` [m]; the first and the
  /// last are the least and the largest.
  static constexpr std::array<Real, 7> fractions{0, 0.05, 0.25, 0.5, 0.75, 0.95, 1};
  std::array<Real, 7> quantiles{};
  std::vector<Pair> extreme; ///< the few by which a mesh is judged, the most conspicuous first
};

/// What is known of contact before the first step, over all ranks.
struct ContactCensus
{
  /// Lengths below this fraction of the skin are rounding of the mesh's coordinates.
  static constexpr Real roundOff = 1e-8;

  std::int64_t pairs = 0;          ///< candidates
  std::int64_t declaredClosed = 0; ///< planes of declared joints
  std::int64_t bonded = 0;         ///< of them
  /// Whose gap changes along the faces: of them, and of pairs beside each other.
  std::int64_t uneven = 0;
  Real changeOfGap = 0;                    ///< the most that it changes over a face [m]
  std::int64_t declaredWithoutOverlap = 0; ///< pairs of such joints that only neighbour each other
  std::int64_t touching = 0;               ///< other pairs whose faces meet, but for round-off
  std::int64_t overlapping = 0; ///< others that lie on each other (26 degrees) and overlap
  std::int64_t apart = 0;       ///< other pairs that are apart
  std::int64_t open = 0, stick = 0, slip = 0; ///< planes by state, declared or not

  CensusLengths joints;   ///< gaps that declared joints absorb; the largest sizes first
  CensusLengths overlaps; ///< depths of other pairs that overlap; the deepest first
  CensusLengths gaps;     ///< of other pairs that face each other apart; the smallest first

  /// Faces of side sets between which a joint is declared, and faces that oppose candidates across
  /// a declared joint, that no plane closes.
  std::int64_t lonelyFaces = 0;
  std::vector<GlobalId> firstLonelyFaces; ///< the lowest ids, at most ten

  /// Names of the items that declare joints of which not one is closed.
  std::vector<std::string> itemsWithoutPartner;

  Real leastStiffness = infinity, largestStiffness = 0; ///< initial normal stiffness [Pa/m]
};

/// Call after the forces at t = 0 are known and before the first step. The same on every rank.
/// Collective.
ContactCensus census(const Contact& contact);
} // namespace coplane
