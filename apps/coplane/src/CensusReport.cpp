#include "CensusReport.hpp"

#include <coplane_contact/Census.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_mesh/FaceName.hpp>

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
/// Lengths below this fraction of the skin are rounding of the mesh's coordinates.
constexpr Real nothing = 1e-8;

void printLengths(const CensusLengths& lengths, const char* what, const char* extreme, Real skin)
{
  if (lengths.count == 0)
    return;
  const auto& q = lengths.quantiles;
  if (std::max(std::abs(q[0]), std::abs(q[6])) <= nothing * skin)
  {
    logInfo("    {}: all zero", what);
    return;
  }
  logInfo("    {} [m]: least {:.3e}, 5 % {:.3e}, 25 % {:.3e}, median {:.3e}, 75 % {:.3e}, "
          "95 % {:.3e}, largest {:.3e}",
          what, q[0], q[1], q[2], q[3], q[4], q[5], q[6]);
  for (const CensusLengths::Pair& pair : lengths.extreme)
    logInfo("      {} {:.3e} m: {} and {}", extreme, pair.length, faceName(pair.faceId[0]),
            faceName(pair.faceId[1]));
}
} // namespace

void reportCensus(const Contact& contact)
{
  const ContactCensus c = census(contact);
  logInfo("contact: skin {:.4e} m; {} candidate pairs; planes: {} open, {} stick, {} slip",
          contact.skin(), c.pairs, c.open, c.stick, c.slip);
  for (const std::string& item : c.itemsWithoutPartner)
    logWarning("a declared joint without planes",
               fmt::format("{} declares a joint that is closed at the start, but no faces of its "
                           "two sides overlap within the skin of {:.4e} m. Check the names, the "
                           "gap in the mesh, and contact.skin.",
                           item, contact.skin()));
  if (c.pairs == 0)
    return;
  logInfo("  normal stiffness of pairs: {:.4e} to {:.4e} Pa/m", c.leastStiffness,
          c.largestStiffness);
  logInfo("  declared joints: {} planes closed, {} of them bonded; {} more pairs of their faces "
          "only neighbour each other",
          c.declaredClosed, c.bonded, c.declaredWithoutOverlap);
  printLengths(c.joints, "gaps of the mesh that are absorbed", "gap", contact.skin());
  if (c.lonelyFaces > 0)
  {
    std::vector<std::string> names;
    for (const GlobalId id : c.firstLonelyFaces)
      names.push_back(faceName(id));
    logInfo("    {} faces of declared joints share no area with any other: {}{}", c.lonelyFaces,
            fmt::join(names, ", "), c.lonelyFaces > std::int64_t(names.size()) ? ", ..." : "");
  }
  logInfo("  other pairs: {} apart, {} overlapping", c.apart, c.overlapping);
  printLengths(c.overlaps, "depths of overlaps, which carry no force at the start", "overlap",
               contact.skin());
  printLengths(c.gaps, "gaps of pairs that face each other", "gap", contact.skin());
}
} // namespace coplane
