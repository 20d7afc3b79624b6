#pragma once

#include <coplane_contact/Contact.hpp>

#include <vector>

namespace coplane
{
// Sums over the planes of all ranks, the same bits on all for any number of them. Collective.

/// The planes with one joint card. Of the area in which the two sides of its planes face each other
/// a part is open, a part sticks and a part slips.
struct JointSummary
{
  Real openArea = 0;    ///< faced, but carries no traction [m^2]
  Real stickArea = 0;   ///< [m^2]
  Real slipArea = 0;    ///< [m^2]
  Real meanClosure = 0; ///< of the area that carries traction; 0 without such area [m]
  Real largestSlip = 0; ///< longest slip path of the planes that exist [m]
  Real normalForce = 0; ///< sum of area times normal traction, compression positive [N]
  ContactEnergy energy; ///< with the planes that have ended
};

/// One for each joint card of the rules, in their order.
std::vector<JointSummary> jointSummaries(const Contact& contact);

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
std::vector<ContactTableRow> contactTable(const Contact& contact);
} // namespace coplane
