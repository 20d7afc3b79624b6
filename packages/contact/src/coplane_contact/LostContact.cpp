#include <coplane_contact/LostContact.hpp>
#include <coplane_contact/detail/PointsInBodies.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

namespace coplane
{
namespace
{
using Bodies = std::array<int, 2>; ///< the lower number first

Bodies bodiesOf(int a, int b)
{
  return {std::min(a, b), std::max(a, b)};
}

/// Faces of this rank that lie too deep in other bodies, and of which no plane carries.
std::vector<detail::PointInBody> lostHere(const Contact& contact, const ConstNodeVectors& x)
{
  std::vector<int> bodies;
  for (const Face& face : contact.localFaces())
    bodies.push_back(face.body);
  std::vector<GlobalId> carrying;
  for (std::size_t p = 0; p < contact.planes().size(); ++p)
    if (const Plane& plane = contact.planes()[p]; plane.area > 0)
      carrying.insert(carrying.end(), plane.faceId, plane.faceId + 2);
  std::sort(carrying.begin(), carrying.end());
  std::vector<detail::PointInBody> lost;
  for (const detail::PointInBody& point :
       detail::pointsInBodies(detail::pointsBelowCentres(contact, x), contact, x, bodies, true))
    if (point.depth > point.thinner &&
        !std::binary_search(carrying.begin(), carrying.end(), point.faceId[0]))
      lost.push_back(point);
  return lost;
}

/// Of these pairs of bodies the areas on which they carry, and that of all. Collective.
std::vector<Real> carryingAreas(const std::vector<Bodies>& pairs, const Contact& contact)
{
  std::vector<ExactSum> areas(pairs.size() + 1);
  for (std::size_t p = 0; p < contact.planes().size(); ++p)
  {
    const Plane& plane = contact.planes()[p];
    if (!plane.countedHere || !(plane.area > 0))
      continue;
    areas.back().add(plane.area);
    if (pairs.empty())
      continue;
    const auto body = [&](int side) { return contact.faces()[std::size_t(plane.face[side])].body; };
    const Bodies bodies = bodiesOf(body(0), body(1));
    const auto found = std::lower_bound(pairs.begin(), pairs.end(), bodies);
    if (found != pairs.end() && *found == bodies)
      areas[std::size_t(found - pairs.begin())].add(plane.area);
  }
  return ExactSum::overRanks(areas, contact.comm());
}
} // namespace

LostContact lostContact(const Contact& contact, const ConstNodeVectors& x)
{
  std::vector<detail::PointInBody> points = contact.comm().allGather(lostHere(contact, x));
  const auto key = [](const detail::PointInBody& p)
  { return std::tie(p.body[0], p.body[1], p.faceId[0], p.faceId[1]); };
  std::sort(points.begin(), points.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  // The faces of either body in the other tell of the same: the larger sum counts.
  std::map<Bodies, std::array<Real, 2>> lost;
  for (const detail::PointInBody& point : points)
    lost[bodiesOf(point.body[0], point.body[1])][point.body[0] > point.body[1]] += point.area;
  std::vector<Bodies> pairs;
  for (const auto& [bodies, areas] : lost)
    pairs.push_back(bodies);
  const std::vector<Real> carrying = carryingAreas(pairs, contact);

  LostContact found;
  found.carrying = carrying.back();
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    const auto& areas = lost.at(pairs[i]);
    const Real larger = std::max(areas[0], areas[1]);
    if (!(larger > carrying[i]))
      continue;
    found.lost += larger;
    for (const detail::PointInBody& point : points)
    {
      if (bodiesOf(point.body[0], point.body[1]) != pairs[i])
        continue;
      ++found.faces;
      if (!(point.depth > found.depth))
        continue;
      found.depth = point.depth;
      std::copy(point.block, point.block + 2, found.block);
      std::copy(point.faceId, point.faceId + 2, found.faceId);
    }
  }
  return found;
}
} // namespace coplane
