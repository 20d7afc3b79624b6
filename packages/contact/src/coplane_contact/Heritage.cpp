#include <coplane_contact/Heritage.hpp>
#include <coplane_contact/detail/Inheritance.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
/// Places in `donors` by the ids of their faces, sorted.
std::vector<std::pair<GlobalId, std::size_t>> byFace(const std::vector<Donor>& donors)
{
  std::vector<std::pair<GlobalId, std::size_t>> places;
  places.reserve(2 * donors.size());
  for (std::size_t d = 0; d < donors.size(); ++d)
    for (const GlobalId id : donors[d].faceId)
      places.emplace_back(id, d);
  std::sort(places.begin(), places.end());
  return places;
}
} // namespace

ConstNodeVectors copyOf(const ConstNodeVectors& x)
{
  const NodeVectors copy(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::positions"),
                         x.extent(0));
  Kokkos::deep_copy(copy, x);
  return copy;
}

Heritage::Heritage(Place place, std::vector<Donor> donors)
    : place_(std::move(place)), donors_(std::move(donors)), donorsOfFace_(byFace(donors_))
{
}

void Heritage::passOn(Plane& plane, Real sharedBefore) const
{
  forgetPassed(plane);
  const auto normalOf = [&](int face)
  { return facePlane(place_.faces(face), place_.x, place_.dimension).normal; };
  const Vec3 normal = normalised(normalOf(plane.face[0]) - normalOf(plane.face[1]));
  std::vector<Donor> donors;
  for (const int f : plane.face)
    addDonors(f, plane, normal, donors);
  if (donors.empty())
    return;
  const NewPair now = newPair(plane, normal, sharedBefore);
  const Continuation continuation(now, place_.dimension, place_.reach);
  std::vector<Donor> heirlooms;
  for (Donor& donor : donors)
  {
    if (!continuation.isNear(donor))
      continue;
    donor.flush = isFlush(now, donor, place_.dimension);
    donor.ofSameBodies = std::is_permutation(donor.body, donor.body + 2, now.body);
    if (continuation.goesOn(donor))
      heirlooms.push_back(donor);
  }
  inherit(plane, normal, now.nodes, heirlooms);
}

void Heritage::addDonors(int face, const Plane& plane, const Vec3& normal,
                         std::vector<Donor>& donors) const
{
  const GlobalId id = place_.faces(face).id;
  for (auto d = std::lower_bound(donorsOfFace_.begin(), donorsOfFace_.end(),
                                 std::make_pair(id, std::size_t(0)));
       d != donorsOfFace_.end() && d->first == id; ++d)
    if (fits(donors_[d->second], plane, normal))
      donors.push_back(donors_[d->second]);
}

NewPair Heritage::newPair(const Plane& plane, const Vec3& normal, Real sharedBefore) const
{
  NewPair now;
  now.normal = normal;
  now.sharedBefore = sharedBefore;
  for (int side = 0; side < 2; ++side)
  {
    const Face& mine = place_.faces(plane.face[side]);
    now.faceId[side] = mine.id;
    now.count[side] = mine.count;
    now.body[side] = mine.body;
    for (int k = 0; k < mine.count; ++k)
    {
      now.nodes[side][k] = place_.nodeIds[mine.nodes[k]];
      now.corners[side][k] = at(place_.x, mine.nodes[k]);
    }
  }
  if (place_.axisymmetric) // lengths are compared
    now.sharedBefore /= pi * (now.corners[0][0].x + now.corners[0][1].x);
  return now;
}
} // namespace coplane
