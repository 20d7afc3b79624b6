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
class ForceSums
{
public:
  using SlotTable = Kokkos::View<SlotFaces*, Kokkos::HostSpace>;

  /// Lists of the planes of each local face.
  /// @param slots of the planes, which are sorted by key; local faces come first in the table
  void listPlanes(const SlotTable& slots, std::size_t localFaces);

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
  Lists<std::int32_t> planesOfFace_;                     ///< 2 * plane + side, in the order of keys
  Lists<std::int32_t> facesOfNode_;                      ///< 4 * face + corner, in the order of ids
  Kokkos::View<FaceLoad*, Kokkos::HostSpace> faceLoads_; ///< what planes add to the nodes of a face
};
} // namespace coplane
