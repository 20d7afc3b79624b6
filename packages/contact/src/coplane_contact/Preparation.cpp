#include <coplane_contact/detail/Inheritance.hpp>
#include <coplane_contact/detail/Preparation.hpp>
#include <coplane_mesh/NodeLayout.hpp>

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

/// The positions now: those of the run go on.
ConstNodeVectors copyOf(const ConstNodeVectors& x)
{
  const NodeVectors copy(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::atSearch"),
                         x.extent(0));
  Kokkos::deep_copy(copy, x);
  return copy;
}

Preparation::Search withCopies(Preparation::Search search)
{
  search.x = copyOf(search.x);
  return search;
}
} // namespace

Preparation::Preparation(Search search, std::vector<Donor> donors, const NodeLayout& layout)
    : search_(withCopies(std::move(search))), facePlanes_(facePlanes()),
      edges_(search_.pairs, search_.faces, search_.localFaces, facePlanes_, search_.x,
             search_.dimension, layout),
      nodeIds_(layout.ids()), donors_(std::move(donors)), donorsOfFace_(byFace(donors_))
{
}

Array<FacePlane> Preparation::facePlanes() const
{
  const Array<FacePlane> planes(
      Kokkos::ViewAllocateWithoutInitializing("coplane::contact::facePlanes"),
      search_.faces.extent(0));
  parallelFor("coplane::contact::facePlanes", int(planes.extent(0)),
              [&](const int f) {
                new (&planes(f))
                    FacePlane(facePlane(search_.faces(f), search_.x, search_.dimension));
              });
  return planes;
}

void Preparation::prepare(int slot, Todo todo, Plane& plane) const
{
  const Real sharedBefore = (todo & WasKnown) != 0 ? plane.overlap : -1;
  if ((todo & LookAtEdges) != 0)
    edges_.look(std::size_t(search_.pairOfSlot[std::size_t(slot)]), plane);
  if ((todo & TakeOver) != 0)
    takeOver(plane, sharedBefore);
}

/// What the living planes of its faces pass on to a slot that has not touched yet, sought anew
/// after every search.
void Preparation::takeOver(Plane& plane, Real sharedBefore) const
{
  forgetPassed(plane);
  const Vec3 normal =
      normalised(facePlanes_(plane.face[0]).normal - facePlanes_(plane.face[1]).normal);
  std::vector<Donor> donors;
  for (const int f : plane.face)
    addDonors(f, plane, normal, donors);
  if (donors.empty())
    return;
  const NewPair now = newPair(plane, normal, sharedBefore);
  const Continuation continuation(now, search_.dimension, search_.skin);
  std::vector<Donor> heirlooms;
  for (Donor& donor : donors)
  {
    if (!continuation.isNear(donor))
      continue;
    donor.flush = isFlush(now, donor, search_.dimension);
    donor.ofSameBodies = std::is_permutation(donor.body, donor.body + 2, now.body);
    if (continuation.goesOn(donor))
      heirlooms.push_back(donor);
  }
  inherit(plane, normal, now.nodes, heirlooms);
}

void Preparation::addDonors(int face, const Plane& plane, const Vec3& normal,
                            std::vector<Donor>& donors) const
{
  const GlobalId id = search_.faces(face).id;
  for (auto d = std::lower_bound(donorsOfFace_.begin(), donorsOfFace_.end(),
                                 std::make_pair(id, std::size_t(0)));
       d != donorsOfFace_.end() && d->first == id; ++d)
    if (fits(donors_[d->second], plane, normal))
      donors.push_back(donors_[d->second]);
}

NewPair Preparation::newPair(const Plane& plane, const Vec3& normal, Real sharedBefore) const
{
  NewPair now;
  now.normal = normal;
  now.sharedBefore = sharedBefore;
  for (int side = 0; side < 2; ++side)
  {
    const Face& mine = search_.faces(plane.face[side]);
    now.faceId[side] = mine.id;
    now.count[side] = mine.count;
    now.body[side] = mine.body;
    for (int k = 0; k < mine.count; ++k)
    {
      now.nodes[side][k] = nodeIds_[mine.nodes[k]];
      now.corners[side][k] = at(search_.x, mine.nodes[k]);
    }
  }
  return now;
}
} // namespace coplane
