#pragma once

#include <coplane_contact/FaceLoad.hpp>
#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/Substep.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/Lists.hpp>
#include <coplane_core/NodeViews.hpp>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

namespace coplane
{
/// The pairs of the last search that advance by several steps in a cycle: those at a node that
/// does (docs/theory/time-integration.md, "Subcycling"), but for those of rigid bodies, which move
/// once in a cycle.
class SubsteppedPairs
{
public:
  using SlotTable = Kokkos::View<SlotFaces*, Kokkos::HostSpace>;

  /// @param slots of the planes, which are sorted by key; faces: of which the first `localFaces`
  ///        are local, sorted by id; steps: in a cycle, by node
  void list(const SlotTable& slots, const std::vector<Face>& faces, std::size_t localFaces,
            int ownedNodes, const Array<Real>& steps);
  void clear() { *this = {}; }
  bool empty() const { return slots_.empty(); }
  bool has(std::size_t slot) const { return slot < has_.size() && has_[slot] != 0; }
  /// Owned nodes of their faces, ascending.
  const std::vector<int>& nodes() const { return nodes_; }

  /// Those that have to be looked at. @param isNear by slot
  template <class IsNear>
  void listNear(const SlotTable& slots, const IsNear& isNear)
  {
    near_.clear();
    std::copy_if(slots_.begin(), slots_.end(), std::back_inserter(near_), isNear);
    listNearFaces(slots);
  }
  const std::vector<int>& near() const { return near_; }           ///< slots, ascending
  const std::vector<int>& nearFaces() const { return nearFaces_; } ///< ascending
  /// Without these pairs. @param near slots, ascending
  std::vector<int> othersOf(const std::vector<int>& near) const;

  /// Adds the forces of their planes to owned nodes, face by face in the order of ids and plane by
  /// plane in the order of keys [N].
  void addForces(Plane* const* planes, const Array<Activity>& activity,
                 const NodeVectors& force) const;

private:
  void listNearFaces(const SlotTable& slots);

  std::vector<int> slots_; ///< ascending
  std::vector<char> has_;  ///< by slot
  std::vector<int> near_, nearFaces_;
  Lists<std::int32_t> planesOfFace_; ///< 2 * slot + side, by local face that has such pairs
  std::vector<int> nodes_;
  Lists<std::int32_t> facesOfNode_; ///< 4 * place in planesOfFace_ + corner, by place in nodes_
};
} // namespace coplane
