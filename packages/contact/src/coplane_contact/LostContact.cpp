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
BodyPair bodiesOf(int a, int b)
{
  return {std::min(a, b), std::max(a, b)};
}

std::vector<int> bodiesOfFaces(const Contact& contact)
{
  std::vector<int> bodies;
  for (const Face& face : contact.localFaces())
    bodies.push_back(face.body);
  return bodies;
}

/// Those of these points that lie too deep in other bodies, and of whose faces no plane carries.
/// Collective.
std::vector<detail::PointInBody> lostOf(const std::vector<detail::PointBelow>& points,
                                        const Contact& contact, const ConstNodeVectors& x,
                                        const std::vector<BodyPair>& known)
{
  std::vector<GlobalId> carrying;
  for (std::size_t p = 0; p < contact.planes().size(); ++p)
    if (const Plane& plane = contact.planes()[p]; plane.area > 0)
      carrying.insert(carrying.end(), plane.faceId, plane.faceId + 2);
  std::sort(carrying.begin(), carrying.end());
  const Real deepest = Plane::deepestStart * contact.options().depthMax;
  std::vector<detail::PointInBody> lost;
  for (const detail::PointInBody& point : detail::pointsInBodies(
           points, contact, x, bodiesOfFaces(contact), true, detail::WaysOut::NotBehind))
    if (point.depth > deepest * point.thinner &&
        !std::binary_search(known.begin(), known.end(), bodiesOf(point.body[0], point.body[1])) &&
        !std::binary_search(carrying.begin(), carrying.end(), point.faceId[0]))
      lost.push_back(point);
  return lost;
}

/// The areas on which these pairs of bodies carry, and all, and that of all faces. Collective.
std::vector<Real> areasOf(const std::vector<BodyPair>& pairs,
                          const std::vector<detail::PointBelow>& faces, const Contact& contact)
{
  std::vector<ExactSum> areas(pairs.size() + 2);
  for (const detail::PointBelow& face : faces)
    areas.back().add(face.area);
  for (std::size_t p = 0; p < contact.planes().size(); ++p)
  {
    const Plane& plane = contact.planes()[p];
    if (!plane.countedHere || !(plane.area > 0))
      continue;
    areas[pairs.size()].add(plane.area);
    if (pairs.empty())
      continue;
    const auto body = [&](int side) { return contact.faces()[std::size_t(plane.face[side])].body; };
    const BodyPair bodies = bodiesOf(body(0), body(1));
    const auto found = std::lower_bound(pairs.begin(), pairs.end(), bodies);
    if (found != pairs.end() && *found == bodies)
      areas[std::size_t(found - pairs.begin())].add(plane.area);
  }
  return ExactSum::overRanks(areas, contact.comm());
}
} // namespace

LostContact lostContact(const Contact& contact, const ConstNodeVectors& x,
                        const std::vector<BodyPair>& known)
{
  const std::vector<detail::PointBelow> faces = detail::pointsBelowCentres(contact, x);
  std::vector<detail::PointInBody> points =
      contact.comm().allGather(lostOf(faces, contact, x, known));
  const auto key = [](const detail::PointInBody& p)
  { return std::tie(p.body[0], p.body[1], p.faceId[0], p.faceId[1]); };
  std::sort(points.begin(), points.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  // The faces of either body in the other tell of the same: the larger sum counts.
  struct Lost
  {
    Real area[2] = {0, 0};
    std::int64_t faces = 0;
    const detail::PointInBody* deepest = nullptr;
  };
  std::map<BodyPair, Lost> lost;
  for (const detail::PointInBody& point : points)
  {
    Lost& pair = lost[bodiesOf(point.body[0], point.body[1])];
    pair.area[point.body[0] > point.body[1]] += point.area;
    ++pair.faces;
    if (!pair.deepest || point.depth > pair.deepest->depth)
      pair.deepest = &point;
  }
  std::vector<BodyPair> pairs;
  for (const auto& [bodies, pair] : lost)
    pairs.push_back(bodies);
  const std::vector<Real> areas = areasOf(pairs, faces, contact);

  LostContact found;
  found.carrying = areas[pairs.size()];
  found.surface = areas.back();
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    const Lost& pair = lost.at(pairs[i]);
    const Real larger = std::max(pair.area[0], pair.area[1]);
    if (!(larger > areas[i]))
      continue;
    found.lost += larger;
    found.faces += pair.faces;
    if (!(pair.deepest->depth > found.depth))
      continue;
    found.depth = pair.deepest->depth;
    std::copy(pair.deepest->block, pair.deepest->block + 2, found.block);
    std::copy(pair.deepest->faceId, pair.deepest->faceId + 2, found.faceId);
  }
  return found;
}

std::vector<BodyPair> bodiesInEachOther(const Contact& contact, const ConstNodeVectors& x,
                                        const std::vector<int>& blocks)
{
  const auto isOne = [&](int block)
  { return std::find(blocks.begin(), blocks.end(), block) != blocks.end(); };
  std::vector<BodyPair> pairs;
  for (const detail::PointInBody& point : detail::pointsInBodies(
           detail::pointsBelowFaces(contact, x), contact, x, bodiesOfFaces(contact), false))
    if (blocks.empty() || isOne(point.block[0]) || isOne(point.block[1]))
      pairs.push_back(bodiesOf(point.body[0], point.body[1]));
  const auto tidy = [&]
  {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  };
  tidy();
  pairs = contact.comm().allGather(pairs);
  tidy();
  return pairs;
}
} // namespace coplane
