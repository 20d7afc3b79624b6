#pragma once

#include <coplane_contact/ClassicPairKernel.hpp>
#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Search.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <array>
#include <utility>
#include <vector>

// Method CommonPlane: of the pairs of faces of two elements, one leads. It carries the plane of the
// elements until the next search.

namespace coplane
{
/// Whether a pair of faces leads, and the normal of its elements' plane.
struct Leader
{
  bool leads = false;
  Vec3 normal{};
};

/// Nodes of an element with velocities or, without `v`, at rest.
ElementNodes elementNodes(const FaceElement& element, const ConstNodeVectors& x,
                          const ConstNodeVectors& v = {});

/// The common plane of two elements, sought anew.
ClassicPlane planeBetween(const FaceElement& a, const FaceElement& b, const ConstNodeVectors& x,
                          int dimension, const ContactOptions& options);

/// A pair leads when its faces are those which the common plane of the elements, sought anew, names
/// as closest. That needs no knowledge of other pairs: all ranks decide alike.
Leader leaderOf(const Face& a, const Face& b, const FaceElement& elementA,
                const FaceElement& elementB, const ConstNodeVectors& x, int dimension,
                const ContactOptions& options);

using ElementPair = std::pair<GlobalId, GlobalId>; ///< lower id first

inline ElementPair elementPairOf(const GlobalId (&faceId)[2])
{
  return {elementOfFace(faceId[0]), elementOfFace(faceId[1])};
}

using DonorRange =
    std::pair<std::vector<Donor>::const_iterator, std::vector<Donor>::const_iterator>;

/// Those of a pair of elements, of planes that are sorted by pair.
DonorRange planesOf(const std::vector<Donor>& planes, const ElementPair& pair);

/// The planes of some pairs of elements, sorted by pair, from wherever they are. `counted`: planes
/// that carry traction and are counted on this rank; `wanted`: pairs that this rank asks for.
/// Collective.
std::vector<Donor> planesOfElements(const std::vector<ElementPair>& wanted,
                                    const std::vector<Donor>& counted, const Comm& comm);
} // namespace coplane
