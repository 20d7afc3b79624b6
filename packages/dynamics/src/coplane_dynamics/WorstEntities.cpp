#include <coplane_core/ExactSum.hpp>
#include <coplane_dynamics/WorstEntities.hpp>
#include <coplane_mesh/FaceName.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace coplane
{
namespace
{
constexpr std::size_t named = 3;

struct Entry
{
  Real badness, value;
  GlobalId a, b;
};

/// The worst of all ranks, the same on all. Collective.
std::vector<Entry> worst(std::vector<Entry> mine, const Comm& comm)
{
  const auto keepWorst = [](std::vector<Entry>& list)
  {
    const auto worse = [](const Entry& p, const Entry& q)
    { return std::tie(q.badness, p.a, p.b) < std::tie(p.badness, q.a, q.b); };
    const std::size_t kept = std::min(list.size(), named);
    std::partial_sort(list.begin(), list.begin() + std::ptrdiff_t(kept), list.end(), worse);
    list.resize(kept);
  };
  keepWorst(mine);
  std::vector<Entry> all = comm.allGather(mine);
  keepWorst(all);
  return all;
}

std::string pairName(const Entry& entry)
{
  return fmt::format("plane between {} and {}", faceName(entry.a), faceName(entry.b));
}

/// Depth over the depth limit.
Real depthOf(const Plane& plane)
{
  return plane.area > 0 ? (plane.closure - plane.closureOnSurface()) / plane.depthLimit : 0;
}
} // namespace

std::string worstByRemainder(const Parts& parts)
{
  std::vector<Entry> planes;
  for (std::size_t p = 0; parts.contact && p < parts.contact->planes().size(); ++p)
  {
    const Plane& plane = parts.contact->planes()[p];
    if (!plane.countedHere || !plane.isBorn())
      continue;
    const Real rest = plane.remainder();
    planes.push_back({std::abs(rest), rest, plane.faceId[0], plane.faceId[1]});
  }
  std::string text;
  for (const Entry& e : worst(planes, parts.comm))
    text += fmt::format("\n  {}: {:.3e} J unexplained", pairName(e), e.value);
  return text;
}

std::string deepestPlanes(const Parts& parts)
{
  std::vector<Entry> planes;
  for (std::size_t p = 0; parts.contact && p < parts.contact->planes().size(); ++p)
  {
    const Plane& plane = parts.contact->planes()[p];
    if (plane.countedHere && plane.isBorn() && depthOf(plane) > 0)
      planes.push_back({depthOf(plane), plane.closure, plane.faceId[0], plane.faceId[1]});
  }
  std::string text;
  for (const Entry& e : worst(planes, parts.comm))
    text +=
        fmt::format("\n  {}: {:.3e} m deep, {:.3g} of its limit", pairName(e), e.value, e.badness);
  return text;
}

std::string worstEntities(const Parts& parts)
{
  std::vector<Entry> elements;
  for (std::size_t b = 0; b < parts.blocks().size(); ++b)
    for (int e = 0; e < parts.blocks()[b].count(); ++e)
      if (parts.mesh().blocks[b].owned[e] && parts.blocks()[b].isAlive(e))
      {
        const Real ratio = parts.blocks()[b].volume(e) / parts.blocks()[b].referenceVolume(e);
        elements.push_back({std::isnan(ratio) ? infinity : std::abs(ratio - 1), ratio,
                            parts.mesh().blocks[b].elementIds[e], 0});
      }
  std::string text = "Worst:" + worstByRemainder(parts) + deepestPlanes(parts);
  for (const Entry& e : worst(elements, parts.comm))
    text += fmt::format("\n  element {}: volume is {:.4g} times its initial one", e.a, e.value);
  return text;
}

CappedPlanes cappedPlanes(const Parts& parts)
{
  std::vector<Entry> planes;
  for (std::size_t p = 0; p < parts.contact->planes().size(); ++p)
  {
    const Plane& plane = parts.contact->planes()[p];
    if (plane.countedHere && plane.area > 0 &&
        parts.contact->lawOf(plane).capped(plane.fit, plane.history))
      planes.push_back(
          {plane.history.maximumClosure, plane.fit.stiffnessCap, plane.faceId[0], plane.faceId[1]});
  }
  CappedPlanes capped;
  capped.count = parts.comm.sum(std::int64_t(planes.size()));
  for (const Entry& e : worst(planes, parts.comm))
    capped.first +=
        fmt::format("\n  {}: closed by {:.3e} m, cap {:.3e} Pa/m", pairName(e), e.badness, e.value);
  return capped;
}
} // namespace coplane
