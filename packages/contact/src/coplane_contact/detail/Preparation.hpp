#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/Search.hpp>
#include <coplane_contact/detail/EdgesOfSurfaces.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace coplane
{
struct NewPair;

/// What a search knows of its pairs: what lies beyond the edges of their faces, and which living
/// planes they continue. Most pairs are edge neighbours that do not come near each other before the
/// next search, so each is told when it does. What it is told is what was true at the search,
/// whenever it asks.
class Preparation
{
public:
  /// What is left to do for a pair: a sum of these.
  using Todo = std::uint8_t;
  static constexpr Todo LookAtEdges = 1, TakeOver = 2;
  static constexpr Todo WasKnown = 4; ///< the pair had been evaluated before the search

  /// A search that has been made.
  struct Search
  {
    std::vector<CandidatePair> pairs;
    std::vector<std::int64_t> pairOfSlot; ///< negative: none
    Array<Face> faces; ///< local, then ghost; those with an owned node come first
    std::size_t localFaces = 0;
    ConstNodeVectors x;
    int dimension = 3;
    Real skin = 0; ///< [m]
  };

  /// @param donors all living planes of the faces, in any order, some of them twice. Collective.
  Preparation(Search search, std::vector<Donor> donors, const NodeLayout& layout);
  Preparation(const Preparation&) = delete; // edges_ refers to the pairs

  /// Tells the plane of a pair. Where that is not done at the search itself, the pair had not been
  /// evaluated by then, or shared no area.
  void prepare(int slot, Todo todo, Plane& plane) const;

private:
  Array<FacePlane> facePlanes() const;
  void takeOver(Plane& plane, Real sharedBefore) const;
  void addDonors(int face, const Plane& plane, const Vec3& normal,
                 std::vector<Donor>& donors) const;
  NewPair newPair(const Plane& plane, const Vec3& normal, Real sharedBefore) const;

  const Search search_;
  const Array<FacePlane> facePlanes_;
  const EdgesOfSurfaces edges_;
  std::vector<GlobalId> nodeIds_;
  const std::vector<Donor> donors_;
  std::vector<std::pair<GlobalId, std::size_t>> donorsOfFace_; ///< by id of the face, sorted
};
} // namespace coplane
