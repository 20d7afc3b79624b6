#include <coplane_core/PlaceText.hpp>
#include <coplane_exodus/MeshReport.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
// Beyond these a mesh is told of, though it can be used.
constexpr Real poorQuality = 0.03;                         // a corner of 2 degrees in a rectangle
constexpr Real shortEdge = 1.0 / 300;                      // of the longest
constexpr Real largestExtent = 2e4, smallestExtent = 1e-5; // [m]

/// With digits that tell elements apart, however far from the origin.
std::string at(const MeshReport& report, const Vec3& x)
{
  return placeText(x, std::max(report.shortestEdge, 1e-3 * report.longestEdge));
}

template <class T, class Text>
std::string firstOf(const Findings<T>& items, const Text& text)
{
  std::string list;
  for (std::size_t i = 0; i < items.first.size(); ++i)
    list += (i ? ", " : "") + text(items.first[i]);
  if (const std::int64_t more = items.count - std::int64_t(items.first.size()); more > 0)
    list += fmt::format(" and {} more", more);
  return list;
}

using Problems = std::vector<std::string>;

std::string nameOf(const MeshReport::BadElement& e)
{
  return fmt::format("element {} of block '{}'", e.element, e.block);
}

void addProblemsOfElements(const MeshReport& report, Problems& problems)
{
  const char* measure = report.dimension == 2 ? "area" : "volume";
  const char* unit = report.dimension == 2 ? "m^2" : "m^3";
  if (!report.inverted.empty())
    problems.push_back(
        fmt::format("{} elements are inside out or flat ({} zero or negative): {}. "
                    "Correct the order of their nodes, or remesh "
                    "that region.",
                    report.inverted.count, measure,
                    firstOf(report.inverted, [&](const MeshReport::BadElement& e)
                            { return fmt::format("{} ({:.3g} {})", nameOf(e), e.volume, unit); })));
  if (!report.repeatedNodes.empty())
    problems.push_back(fmt::format(
        "{} elements use a node twice: {}. Quadrilaterals and hexahedra may not be collapsed to "
        "other shapes; remesh that region.",
        report.repeatedNodes.count, firstOf(report.repeatedNodes, nameOf)));
  if (!report.folded.empty())
    problems.push_back(fmt::format(
        "{} elements are folded at a corner: {}. Their {} is positive, but they are not convex; "
        "remesh "
        "that region.",
        report.folded.count, firstOf(report.folded, nameOf), measure));
  for (const MeshReport::BlockSummary& block : report.blocks)
    if (block.worstQuality > 0 && block.worstQuality < poorQuality)
      problems.push_back(fmt::format(
          "element {} of block '{}' at {} has the shape {:.3g} (1 is ideal, 0 is flat): it takes a "
          "small time step and is stiff. Remesh that region.",
          block.worstElement, block.name, at(report, block.worstPlace), block.worstQuality));
}

void addProblemsOfJoints(const MeshReport& report, Problems& problems)
{
  for (const MeshReport::Joint& joint : report.joints)
    if (!joint.alone.empty())
      problems.push_back(fmt::format(
          "side set '{}' is a joint of {} pairs of faces, but {} of its faces have no partner in "
          "it: "
          "{}. Add the faces that they touch, or take them out.",
          joint.name, joint.pairs, joint.alone.count,
          firstOf(joint.alone, [](const std::pair<GlobalId, int>& side)
                  { return fmt::format("side {} of element {}", side.second, side.first); })));
}

void addProblemsOfConnection(const MeshReport& report, Problems& problems)
{
  if (!report.unusedNodes.empty())
    problems.push_back(fmt::format(
        "{} nodes belong to no element: {}. They have no mass; remove them from the mesh.",
        report.unusedNodes.count,
        firstOf(report.unusedNodes, [](GlobalId id) { return fmt::format("node {}", id); })));
  if (!report.coincident.empty())
    problems.push_back(
        fmt::format("{} pairs of nodes of one body lie at one place: {}. If no crack is meant "
                    "there, merge them.",
                    report.coincident.count,
                    firstOf(report.coincident, [](const MeshReport::NodePair& p)
                            { return fmt::format("nodes {} and {}", p.first, p.second); })));
  if (!report.twice.empty())
    problems.push_back(fmt::format(
        "{} pairs of elements have their centres at one place: {}. They are in the file twice, or "
        "bodies lie in each other; remove one of each pair.",
        report.twice.count,
        firstOf(report.twice,
                [&](const MeshReport::ElementPair& p) {
                  return fmt::format("elements {} and {} at {}", p.first, p.second,
                                     at(report, p.place));
                })));
  if (!report.overused.empty())
    problems.push_back(fmt::format(
        "{} {} belong to more than two elements: {}. There is no inside and outside there; use "
        "nodes of its own for one of the bodies.",
        report.overused.count, report.dimension == 2 ? "edges" : "faces",
        firstOf(report.overused,
                [&](const MeshReport::SharedFace& f)
                {
                  return fmt::format("of {} elements, among them {} and {}, at {}", f.count,
                                     f.elements[0], f.elements[1], at(report, f.place));
                })));
}

void addProblemsOfLengths(const MeshReport& report, Problems& problems)
{
  if (report.tooFar())
    problems.push_back(fmt::format(
        "coordinates from {} to {} m, and an edge of {:.3g} m at {}: too few of sixteen digits are "
        "left for it; accepted: up to {:.0e} times the shortest edge. Look at the outermost nodes, "
        "at that edge and at the units.",
        at(report, report.lowest), at(report, report.highest), report.shortestEdge,
        at(report, report.shortestPlace), MeshReport::farthest));
  if (report.shortestEdge > 0 && report.shortestEdge < shortEdge * report.longestEdge)
    problems.push_back(fmt::format(
        "the shortest edge, {:.3g} m at {}, is {:.0f} times shorter than the longest: it sets the "
        "time step of all. If that is not intended, remesh that region.",
        report.shortestEdge, at(report, report.shortestPlace),
        report.longestEdge / report.shortestEdge));
  const Real extent = norm(report.highest - report.lowest);
  if (report.elements > 0 && (extent > largestExtent || extent < smallestExtent))
    problems.push_back(fmt::format(
        "the mesh measures {:.3g} m from corner to corner. Are its lengths in metres? Scale its "
        "coordinates if not.",
        extent));
}
} // namespace

std::vector<std::string> meshProblems(const MeshReport& report)
{
  Problems problems;
  for (const auto add :
       {addProblemsOfElements, addProblemsOfJoints, addProblemsOfConnection, addProblemsOfLengths})
    add(report, problems);
  return problems;
}

std::vector<std::string> meshProblems(const Mesh& mesh)
{
  return meshProblems(reportMesh(mesh));
}
} // namespace coplane
