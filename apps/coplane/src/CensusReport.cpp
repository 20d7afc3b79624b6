#include "CensusReport.hpp"

#include <coplane_contact/Census.hpp>
#include <coplane_contact/InitialOverlaps.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_mesh/Bodies.hpp>
#include <coplane_mesh/FaceName.hpp>

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

namespace coplane
{
namespace
{
void printLengths(const CensusLengths& lengths, const char* what, const char* extreme, Real skin)
{
  if (lengths.count == 0)
    return;
  const auto& q = lengths.quantiles;
  if (std::max(std::abs(q[0]), std::abs(q[6])) <= ContactCensus::roundOff * skin)
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

/// Overlaps of what is there, the deepest first. Collective.
std::vector<InitialOverlap> overlapsNow(const Solver& solver, bool declaredAbsorb)
{
  std::vector<Real> there;
  for (const ElementBlock& block : solver.blocks())
  {
    bool any = false;
    for (int e = 0; e < block.count() && !any; ++e)
      any = !block.isTakenOut(e);
    there.push_back(any ? 1 : 0);
  }
  solver.comm().max(there);
  std::vector<InitialOverlap> overlaps = initialOverlaps(
      solver.contact(), solver.state().x,
      bodyLabels(solver.mesh(), std::vector<char>(there.begin(), there.end()), solver.comm()),
      declaredAbsorb);
  std::sort(overlaps.begin(), overlaps.end(),
            [](const InitialOverlap& a, const InitialOverlap& b) {
              return std::tie(b.depth, a.block[0], a.block[1]) <
                     std::tie(a.depth, b.block[0], b.block[1]);
            });
  return overlaps;
}

/// A line for each of the first few pairs of blocks.
std::string linesOf(const std::vector<InitialOverlap>& overlaps, const Solver& solver)
{
  const RankMesh& mesh = solver.mesh();
  constexpr std::size_t named = 10;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < std::min(named, overlaps.size()); ++i)
  {
    const InitialOverlap& overlap = overlaps[i];
    const auto name = [&](int side) { return solver.model().blocks[overlap.block[side]].name; };
    lines.push_back(fmt::format(
        "  {}: {} faces up to {:.3g} m deep ({} behind {}), about {:.3g} {}",
        overlap.block[0] == overlap.block[1]
            ? fmt::format("bodies of block '{}' in each other", name(0))
            : fmt::format("blocks '{}' and '{}' in each other", name(0), name(1)),
        overlap.faces, overlap.depth, faceName(overlap.faceId[0]), faceName(overlap.faceId[1]),
        overlap.volume, mesh.dimension == 2 && !solver.model().axisymmetric() ? "m^2" : "m^3"));
  }
  if (overlaps.size() > named)
    lines.push_back(fmt::format("  and {} more pairs of blocks", overlaps.size() - named));
  return fmt::format("{}", fmt::join(lines, "\n"));
}

void reportUnevenGaps(const Contact& contact, const ContactCensus& c)
{
  if (c.uneven == 0)
    return;
  if (contact.options().forces == ContactOptions::Forces::Potential)
    logInfo("    {} pairs, those beside each other among them, absorb gaps that change along the "
            "faces, by up to {:.3e} m",
            c.uneven, c.changeOfGap);
  else
    logWarning(
        "joints of faces that are not parallel",
        fmt::format("the gaps of {} planes of declared joints change along the faces, by up "
                    "to {:.3e} m. Forces along the common normal absorb only their means: "
                    "the joints push at the start. Take contact.forces: potential, or a mesh "
                    "that has the same faces on both sides.",
                    c.uneven, c.changeOfGap));
}
} // namespace

void reportMirrors(const Mirrors& mirrors)
{
  const auto planes = std::count_if(mirrors.all.begin(), mirrors.all.end(),
                                    [](const Mirror& mirror) { return !mirror.isAxis; });
  if (planes > 0)
    logInfo("  bodies go on as their images beyond {} plane{} of symmetry", planes,
            planes == 1 ? "" : "s");
  for (const Mirrors::Lack& lack : mirrors.lacks)
    logInfo("  {}: no image beyond this symmetry, as it {}: faces there are surfaces", lack.where,
            lack.why);
}

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
  reportUnevenGaps(contact, c);
  if (c.lonelyFaces > 0)
  {
    std::vector<std::string> names;
    for (const GlobalId id : c.firstLonelyFaces)
      names.push_back(faceName(id));
    logInfo("    {} faces of declared joints share no area with any other, or lie too far from it: "
            "{}{}",
            c.lonelyFaces, fmt::join(names, ", "),
            c.lonelyFaces > std::int64_t(names.size()) ? ", ..." : "");
  }
  logInfo("  other pairs: {} apart, {} touching, {} overlapping", c.apart, c.touching,
          c.overlapping);
  printLengths(c.overlaps, "depths of overlaps, which carry no force at the start", "overlap",
               contact.skin());
  printLengths(c.gaps, "gaps of pairs that face each other", "gap", contact.skin());
}

void reportInitialOverlaps(const Solver& solver, const std::string& meshFile, bool allowed)
{
  const std::vector<InitialOverlap> overlaps = overlapsNow(solver, true);
  if (overlaps.empty())
    return;
  const std::string found = fmt::format("{}: bodies overlap before the first step:\n{}", meshFile,
                                        linesOf(overlaps, solver));
  if (!allowed)
    failOnAllRanks(ExitCode::Mesh,
                   "{}\nRepair the mesh, or declare the joint where faces lie on each other "
                   "(contact.pairs, declared: true), or exclude the pair; contact.initial_overlap: "
                   "allow starts all the same, without force between them until they press deeper.",
                   found);
  logWarning("overlaps at the start", found);
}

void reportOverlapsOfAdded(const Solver& solver, const std::vector<int>& added,
                           const std::string& where)
{
  std::vector<InitialOverlap> overlaps = overlapsNow(solver, false);
  const auto isOfAdded = [&](const InitialOverlap& overlap)
  {
    return std::any_of(added.begin(), added.end(),
                       [&](int block)
                       { return block == overlap.block[0] || block == overlap.block[1]; });
  };
  overlaps.erase(std::remove_if(overlaps.begin(), overlaps.end(), std::not_fn(isOfAdded)),
                 overlaps.end());
  if (overlaps.empty())
    return;
  // A kind for each stage: none is counted only.
  logWarning("overlaps of added blocks, " + where,
             fmt::format(
                 "{}: bodies overlap where blocks come in:\n{}\nDeclared joints "
                 "absorb overlaps up to a quarter of a face. Of others, up to contact.depth_max "
                 "({:g}) of an element there is no force now, and contact from this depth on; what "
                 "lies deeper carries nothing until it has left: declare the joint, or leave a gap "
                 "in the mesh.",
                 where, linesOf(overlaps, solver), solver.contact().options().depthMax));
}
} // namespace coplane
