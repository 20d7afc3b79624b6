#pragma once

#include <coplane_contact/Contact.hpp>

#include <vector>

namespace coplane
{
/// What a face sees of its planes. All zero for a face that faces none.
struct FaceContact
{
  PlaneState state = PlaneState::Slot; ///< the highest of the planes' states
  Real areaFraction = 0;               ///< area of contact over the area of the face now [-]
  // Means over the area of contact:
  Real normalTraction = 0; ///< compression positive [Pa]
  Vec3 shearTraction{};    ///< on this face [Pa]
  Real closure = 0;        ///< [m]
  // Extremes over planes with overlap:
  Real slip = 0; ///< longest slip path [m]
  Real gap = 0;  ///< smallest, offset taken off; negative: overlap [m]
};

/// For every local face of this rank, in the order of Contact::faces(). A rank holds all planes of
/// its local faces and they are visited in the order of their keys, so the values have the same
/// bits on any number of ranks.
std::vector<FaceContact> faceContact(const Contact& contact, const ConstNodeVectors& x);
} // namespace coplane
