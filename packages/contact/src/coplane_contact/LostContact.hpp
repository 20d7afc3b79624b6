#pragma once

#include <coplane_contact/Contact.hpp>

#include <cstdint>

namespace coplane
{
/// Bodies that lie in each other where contact does not hold them.
struct LostContact
{
  Real lost = 0;          ///< area of their faces there [m^2]
  Real carrying = 0;      ///< area on which planes carry, of all bodies [m^2]
  std::int64_t faces = 0; ///< that are lost
  // Of the deepest of these faces:
  Real depth = 0;              ///< least way out of the other body [m]
  int block[2] = {0, 0};       ///< its own and the other one, in the order of the mesh
  GlobalId faceId[2] = {0, 0}; ///< and the one through which the way leads out
};

/// A face is lost when its centre lies in another body, deeper than the thinner one of the elements
/// behind the face and behind the one through which the way leads out, so that no search finds it
/// any more, and no plane of it carries. Of two bodies so many faces count only if their area is
/// larger than that on which both carry: corners of bodies that hold may lie as deep. Bodies are
/// those of the start; parts of one that lie in each other are not seen.
/// The same on all ranks, for any number of them. Collective.
LostContact lostContact(const Contact& contact, const ConstNodeVectors& x);
} // namespace coplane
