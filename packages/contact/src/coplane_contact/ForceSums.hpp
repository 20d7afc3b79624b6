#pragma once

#include <coplane_contact/FaceLoad.hpp>
#include <coplane_contact/Faces.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/Lists.hpp>
#include <coplane_core/NodeViews.hpp>

#include <vector>

namespace coplane
{
/// Which planes are of which local face, and which faces of which owned node: sums what planes do
/// at nodes in an order that hangs on ids alone, so that sums have the same bits on any ranks.
///
/// Of the slots of a face few are loaded. Each face has a list of those, which is made anew when
/// one of its slots becomes loaded or ceases to be.
class ForceSums
{
public:
  using SlotTable = Kokkos::View<SlotFaces*, Kokkos::HostSpace>;

  /// Lists of the planes of each local face.
  /// @param slots of the planes, which are sorted by key; local faces come first in the table of
  ///        faces
  void listPlanes(const SlotTable& slots, std::size_t localFaces, std::size_t faces);

  /// By face: 1 where slots have become loaded, or have ceased to be, since the last sum. For those
  /// who change that.
  const Array<std::uint8_t>& changed() const { return changed_; }

  /// Lists of the local faces of each owned node, unless they have been listed since
  /// forgetFaces().
  /// @param localFaces sorted by id
  void listFaces(const std::vector<Face>& localFaces, int ownedNodes);
  void forgetFaces()
  {
    facesOfNode_ = {};
    faceLoads_ = {};
  }

  /// Adds the planes' forces to owned nodes, face by face in the order of ids and plane by plane in
  /// the order of keys, and bounds the contact stiffness that each node feels [N/m].
  /// @param planes by slot; those that are loaded are there
  void add(Plane* const* planes, const Array<Activity>& activity, const NodeVectors& f,
           const Array<Real>& stiffness) const;

private:
  void listLoaded(const Array<Activity>& activity) const;

  Lists<std::int32_t> planesOfFace_; ///< 2 * plane + side, in the order of keys
  Array<std::int32_t> loaded_;       ///< of each list of planesOfFace_ those that are loaded, from
                                     ///< where that list begins
  Array<std::int32_t> loadedCount_;  ///< by local face
  Array<std::uint8_t> changed_;      ///< by face: loaded_ is out of date
  Lists<std::int32_t> facesOfNode_;  ///< 4 * face + corner, in the order of ids
  Kokkos::View<FaceLoad*, Kokkos::HostSpace> faceLoads_; ///< what planes add to the nodes of a face
};
} // namespace coplane
