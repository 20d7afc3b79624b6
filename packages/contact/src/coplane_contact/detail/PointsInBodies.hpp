#pragma once

#include <coplane_contact/Contact.hpp>

#include <vector>

namespace coplane::detail
{
/// Points of faces that overlap by less than this fraction of the element behind the face are
/// round-off of the mesh, or facets of curved bodies that touch.
constexpr Real smallestOverlap = 1e-3;

/// A point just below a face.
struct PointBelow
{
  const Face* face;
  Vec3 point{}, normal{};
  Real area = 0; ///< that it stands for [m^2]
  Real size = 0; ///< of the face [m]
};

/// One that lies in another body.
struct PointInBody
{
  int body[2]; ///< of the point, and the other one
  int block[2];
  GlobalId faceId[2]; ///< of the point, and through which the way leads out
  Real depth;         ///< least way out [m]
  Real thinner;       ///< thickness of the thinner element behind both faces [m]
  Real area;          ///< that the point stands for [m^2]
  Real opposing;      ///< how its face opposes the one through which the way leads out, 0 to 1
};

/// Through which faces ways lead out of a body.
enum class WaysOut
{
  All,
  NotBehind ///< but those that look the way of the face of the point: what has come in through the
            ///< front of a body is not out at its back
};

/// Area of a face, of bodies of revolution over the whole turn [m^2].
/// @param center, vectorArea of the face
Real wholeArea(const Contact& contact, const Vec3& center, const Vec3& vectorArea);

/// Below the centres of the faces that this rank owns; those without area, or in planes of
/// symmetry, have none.
std::vector<PointBelow> pointsBelowCentres(const Contact& contact, const ConstNodeVectors& x);
/// The same, and near their corners.
std::vector<PointBelow> pointsBelowFaces(const Contact& contact, const ConstNodeVectors& x);

/// Those points that lie in other bodies, once for each. Not where rules exclude the face of the
/// point and a face of the other body that is met on the way.
///
/// Rays count through how many surfaces they leave bodies: a body's surface is closed, so that
/// tells in how many of them a point lies, wherever they are. Nearly all lie in their own body
/// alone, which one ray tells; of the others most of the rays along all axes decide. Faces in
/// planes of symmetry close bodies, but no way leads out through them.
/// @param points of this rank; bodyOfFace by local face, the same on all ranks
/// @param declaredAbsorb without what declared joints absorb as they are closed
/// Collective.
std::vector<PointInBody> pointsInBodies(const std::vector<PointBelow>& points,
                                        const Contact& contact, const ConstNodeVectors& x,
                                        const std::vector<int>& bodyOfFace, bool declaredAbsorb,
                                        WaysOut ways = WaysOut::All);
} // namespace coplane::detail
