#pragma once

#include <coplane_contact/FaceLoad.hpp>
#include <coplane_contact/Faces.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/NodeViews.hpp>

#include <vector>

namespace coplane
{
/// Which planes are of which local face, and which faces of which owned node: sums what planes do
/// at nodes in an order that hangs on ids alone, so that sums have the same bits on any ranks.
class ForceSums
{
public:
  using Planes = Kokkos::View<Plane*, Kokkos::HostSpace>;

  /// Lists of the planes of each local face.
  /// @param planes sorted by key; faceOf(plane, side): place of a local face; negative for other
  ///        faces and for pairs that are no candidates
  template <class FaceOf>
  void listPlanes(const Planes& planes, std::size_t localFaces, const FaceOf& faceOf);

  /// Lists of the local faces of each owned node, unless they have been listed since
  /// forgetFaces().
  /// @param localFaces sorted by id
  void listFaces(const std::vector<Face>& localFaces, int ownedNodes);
  void forgetFaces() { facesStart_ = {}; }

  /// Calls visit(plane) with the place of each plane of a local face, in the order of keys.
  template <class Visit>
  void forEachPlaneOf(int localFace, const Visit& visit) const
  {
    for (std::int32_t i = planesStart_(localFace); i < planesStart_(localFace + 1); ++i)
      visit(int(planesEntry_(i) / 2));
  }

  /// Adds the planes' forces to owned nodes, face by face in the order of ids and plane by plane in
  /// the order of keys, and bounds the contact stiffness that each node feels [N/m].
  /// @param asleep planes that do nothing
  void add(const Planes& planes, const Array<bool>& asleep, const NodeVectors& f,
           const Array<Real>& stiffness) const;

private:
  // Planes of local face f: entries [planesStart(f), planesStart(f + 1)) in the order of keys; an
  // entry is 2 * plane + side. What they add to its nodes.
  Array<std::int32_t> planesStart_, planesEntry_;
  Kokkos::View<FaceLoad*, Kokkos::HostSpace> faceLoads_;
  // Local faces of owned node n, in the order of ids; an entry is 4 * face + corner.
  Array<std::int32_t> facesStart_, facesEntry_;
};

template <class FaceOf>
void ForceSums::listPlanes(const Planes& planes, std::size_t localFaces, const FaceOf& faceOf)
{
  planesStart_ = Array<std::int32_t>("coplane::contact::planesStart", localFaces + 1);
  for (std::size_t p = 0; p < planes.extent(0); ++p)
    for (int side = 0; side < 2; ++side)
      if (const int face = faceOf(planes(p), side); face >= 0)
        ++planesStart_(face + 1);
  for (std::size_t f = 0; f < localFaces; ++f)
    planesStart_(f + 1) += planesStart_(f);
  planesEntry_ =
      Array<std::int32_t>(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::planesEntry"),
                          planesStart_(localFaces));
  // Planes are visited in the order of their keys, so each face's list is in that order on every
  // rank.
  std::vector<std::int32_t> next(planesStart_.data(), planesStart_.data() + localFaces);
  for (std::size_t p = 0; p < planes.extent(0); ++p)
    for (int side = 0; side < 2; ++side)
      if (const int face = faceOf(planes(p), side); face >= 0)
        planesEntry_(next[face]++) = std::int32_t(2 * p + side);
}
} // namespace coplane
