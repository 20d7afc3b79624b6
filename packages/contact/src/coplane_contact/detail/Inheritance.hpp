#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/detail/View.hpp>

#include <array>
#include <vector>

// What a plane hands on to the pairs of faces that take over from it while bodies slide.

namespace coplane
{
/// Planes that carry something, joints that have just been closed, and those that carry nothing now
/// and have been crushed, or have absorbed a gap or an overlap of the mesh: that belongs to the
/// surfaces, whether they touch or not.
bool isDonor(const Plane& plane, const JointLaw& law);

/// What a plane has to give; without the nodes of its faces.
Donor donorOf(const Plane& plane);

/// Takes from a pair that has not touched yet what an earlier search has passed on to it.
void forgetPassed(Plane& plane);

/// Ids of faces say which way a normal points and on which face a traction acts: where the common
/// face is the lower one of one plane and the higher one of the other, both are turned round: -1.
inline Real turned(const GlobalId* donorFaces, const GlobalId* planeFaces)
{
  return donorFaces[0] == planeFaces[1] || donorFaces[1] == planeFaces[0] ? -1 : 1;
}

/// The nodes of a new plane's faces, in its order; 0: none.
using PairNodes = std::array<std::array<GlobalId, 4>, 2>;

/// A pair of faces that has not touched yet, as it lies now.
struct NewPair
{
  GlobalId faceId[2] = {0, 0};
  PairNodes nodes{};
  int count[2] = {0, 0};
  int body[2] = {0, 0};
  Vec3 corners[2][4] = {}; ///< [m]
  Vec3 normal{};           ///< from face 0 to face 1
  /// Area that they shared when the pair was last looked at; negative: it is new [m^2].
  Real sharedBefore = -1;
};

/// Whether the other face of the donor goes on in that of the pair without a node in common: over
/// the flush seam of two bodies.
bool isFlush(const NewPair& pair, const Donor& donor, int dimension);

/// Whether the area of a new plane goes on where that of a donor ends.
class Continuation
{
public:
  /// @param reach how far faces move between two searches [m]
  Continuation(const NewPair& pair, int dimension, Real reach);

  /// Whether the donor shares a face with the pair, and its area, which the faces have carried
  /// along, lies within the reach of the pair's other face on the common plane; where the donor has
  /// absorbed a gap of the mesh, within that of gaps which joints absorb. What rests and has
  /// absorbed nothing has to lie in the other face as well: it has not left the place that it was
  /// crushed to.
  bool isNear(const Donor& donor) const;
  /// Where the pair shared area already, it has to be closed at the donor's offset, or where faces
  /// touch that have absorbed nothing, and go on over the same surface: then it has not come down
  /// beside the donor. What two bodies have absorbed between them goes on between these two also
  /// where they are apart, and to a third one only where that is level: it is the height of their
  /// surfaces. Asked of donors that are near, and know whether they are flush and of the same
  /// bodies.
  bool goesOn(const Donor& donor) const;

private:
  /// Whether the two faces that the pair and the donor do not have in common are as high, but for a
  /// step [m].
  bool isLevel(const Donor& donor, Real step) const;

  const NewPair& pair_;
  View view_;
  ConvexPolygon shadows_[2]; ///< of the faces
  Real reach_;
  Real size_;                   ///< of the smaller face [m]
  bool fromTheSide_;            ///< it has shared no area yet
  Real gap_ = 0, roundOff_ = 0; ///< where the faces share area [m]
};

/// Least cosine between the normals of a donor and of a plane that takes over from it: 26 degrees.
constexpr Real nearlyItsNormal = 0.9;

/// Whether a donor, or a plane that may become one, is of the joint of the new plane and has nearly
/// its normal.
template <class DonorOrPlane>
bool fits(const DonorOrPlane& donor, const Plane& plane, const Vec3& normal)
{
  return donor.joint == plane.joint &&
         turned(donor.faceId, plane.faceId) * dot(donor.normal, normal) > nearlyItsNormal;
}

/// Gives a new plane the means of its donors, weighted by their areas and summed in the order of
/// their keys: of those between the same two
/// bodies, if there are some, and of these of those that carry, if there are some. Returns whether
/// there were any that fit. A donor that has one face in common with the plane, and whose other
/// face shares a node with the plane's other one, shows that the plane only slides on over the same
/// surface. The plane is bonded if most of the area is, between the same two bodies: a bond holds
/// together what has been bonded, and a third body that comes to one of them has not.
bool inherit(Plane& plane, const Vec3& normal, const PairNodes& nodes, std::vector<Donor>& donors);
} // namespace coplane
