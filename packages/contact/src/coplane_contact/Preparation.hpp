#pragma once

#include <coplane_contact/Heritage.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/Search.hpp>
#include <coplane_geometry/Mirror.hpp>
#include <coplane_mesh/NodeLayout.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace coplane
{
/// What is known of the pairs of a search: what lies beyond the edges of their faces, seen at the
/// search, and which living planes they continue, seen then or later. Most pairs are edge
/// neighbours that do not come near each other before the next search, so each is told when it
/// does.
class Preparation
{
public:
  /// What is left to do for a pair: a sum of these.
  using Todo = std::uint8_t;
  static constexpr Todo LookAtEdges = 1, TakeOver = 2;
  static constexpr Todo WasSeen = 4; ///< the last cycle before has seen what its faces share

  /// A search that has been made.
  struct Search
  {
    std::vector<CandidatePair> pairs;
    std::vector<std::int64_t> pairOfSlot; ///< negative: none
    std::size_t localFaces = 0;           ///< that have an owned node: they come first
  };

  /// Nothing is left to do for any pair.
  Preparation() = default;
  /// @param planes of the faces, heritage: at the search; mirrors in which surfaces go on as their
  /// images. Collective.
  Preparation(Search search, const Heritage::Place& place, const Array<FacePlane>& planes,
              const std::vector<Mirror>& mirrors, std::shared_ptr<const Heritage> heritage,
              const NodeLayout& layout);

  /// From now on pairs take over what living planes have to give now.
  void renew(std::shared_ptr<const Heritage> heritage) { heritage_ = std::move(heritage); }

  /// Tells the plane of a pair. Where that is not done at once, the pair had not been evaluated by
  /// then, or shared no area.
  void prepare(std::size_t slot, Todo todo, Plane& plane) const;

private:
  struct Edges; ///< of the faces of all pairs

  std::shared_ptr<const Edges> edges_;
  std::shared_ptr<const Heritage> heritage_;
};
} // namespace coplane
