#pragma once

#include <coplane_contact/Contact.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace coplane
{
/// Bodies that lie in each other where contact does not hold them.
struct LostContact
{
  Real lost = 0;          ///< area of their faces there [m^2]
  Real carrying = 0;      ///< area on which planes carry, of all bodies [m^2]
  Real surface = 0;       ///< area of all faces [m^2]
  std::int64_t faces = 0; ///< of both bodies that are lost
  // Of the deepest of these faces:
  Real depth = 0;              ///< least way back out of the other body [m]
  int block[2] = {0, 0};       ///< its own and the other one, in the order of the mesh
  GlobalId faceId[2] = {0, 0}; ///< and the one through which the way leads out
};

/// Numbers of two bodies (Face::body), the lower one first.
using BodyPair = std::array<int, 2>;

/// A face is lost when its centre lies in another body, deeper than any contact begins, by the
/// least way out that does not lead through the back, and no plane of it carries. Of two bodies so
/// many faces count only if their area is larger than that on which both carry: corners of bodies
/// that hold may lie as deep. Bodies are those of the mesh with all blocks that ever come; parts of
/// one in each other are not seen.
/// @param known pairs of bodies that may lie in each other, sorted
/// The same on all ranks, for any number of them. Collective.
LostContact lostContact(const Contact& contact, const ConstNodeVectors& x,
                        const std::vector<BodyPair>& known = {});

/// Bodies that lie in each other, however deep, also in joints; sorted, the same on all ranks.
/// @param blocks of which one of two bodies has to be; empty: all. Collective.
std::vector<BodyPair> bodiesInEachOther(const Contact& contact, const ConstNodeVectors& x,
                                        const std::vector<int>& blocks = {});
} // namespace coplane
