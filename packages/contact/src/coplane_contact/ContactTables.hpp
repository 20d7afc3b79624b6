#pragma once

#include <coplane_contact/Contact.hpp>

#include <vector>

namespace coplane
{
// Sums over the planes of all ranks, the same bits on all for any number of them. Collective.

/// The planes with one joint card whose faces lie over each other: opposed, and with a shadow in
/// common that is no sliver, as neighbours have at the corners of blocks. Of the area in which they
/// face each other a part is open, a part sticks and a part slips. Energies are those of all
/// planes.
struct JointSummary
{
  Real openArea = 0;    ///< faced, but carries no traction [m^2]
  Real stickArea = 0;   ///< [m^2]
  Real slipArea = 0;    ///< [m^2]
  Real meanClosure = 0; ///< of the area that carries traction; 0 without such area [m]
  Real largestSlip = 0; ///< longest slip path of these planes [m]
  Real normalForce = 0; ///< sum of area times normal traction, compression positive [N]
  ContactEnergy energy; ///< with the planes that have ended
};

/// Shadows in common below this part of the smaller face are slivers.
constexpr Real sliverOfJoint = 1e-3;

/// Whether the faces of a plane, which are on this rank, lie over each other now: nearly opposed,
/// and in more than a sliver. x: positions of the nodes now [m].
bool isPartOfJoint(const Contact& contact, const Plane& plane, const ConstNodeVectors& x);

/// A plane with area and tractions by the faces as they are now: its own are by the area that they
/// had when they met (Plane::birthArea). Their product is the same, the force. x: positions of the
/// nodes now [m].
Plane planeNow(const Contact& contact, const Plane& plane, const ConstNodeVectors& x);

/// One for each joint card of the rules, in their order. x: positions of the nodes now.
std::vector<JointSummary> jointSummaries(const Contact& contact, const ConstNodeVectors& x);

/// Energy of the planes of one joint card between two blocks.
struct ContactTableRow
{
  PlaneKind kind;
  std::int64_t planes = 0; ///< that exist now
  Real area = 0;           ///< that carries traction now [m^2]
  ContactEnergy energy;    ///< with the planes that have ended
};

/// A row for every kind that has or had a plane, sorted by blocks and joint. The columns add up to
/// Contact::energy().
std::vector<ContactTableRow> contactTable(const Contact& contact, const ConstNodeVectors& x);
} // namespace coplane
