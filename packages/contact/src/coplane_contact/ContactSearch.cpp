#include <coplane_contact/Contact.hpp>
#include <coplane_contact/detail/EdgesOfSurfaces.hpp>
#include <coplane_contact/detail/Inheritance.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_core/WorkWatch.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
std::pair<GlobalId, GlobalId> keyOf(const Plane& plane)
{
  return {plane.faceId[0], plane.faceId[1]};
}

/// A plane more than this times as stiff as the elements behind its faces chatters: their nodes
/// bounce on it many times. The penalty of the defaults, 2, does not (docs/user/contact.md).
constexpr Real stiffestCalm = 2.5;

/// Carries nothing until its faces are candidates again.
void makeDormant(Plane& plane)
{
  carryNothing(plane);
  plane.face[0] = plane.face[1] = -1;
  plane.overlap = plane.nodeStiffness = 0;
  plane.sighting = Sighting::Missed;
  plane.refusal = Refusal::None;
}

/// The slots after a search, sorted by key, and where each comes from.
struct Slots
{
  std::vector<CandidatePair> pairs;   ///< candidates, then other pairs that carry traction
  std::vector<std::int64_t> existing; ///< by pair: its plane from before the search, or -1
  std::vector<std::int64_t> source;   ///< by slot: a pair, or ~p of a plane that becomes dormant
};

/// Candidates and planes are both sorted by key: which pairs have their plane already, and what
/// becomes of planes that are no candidates. Those that end are booked in `ended`.
/// @param faceHere place of a face in the table from its id, -1: not here
template <class FaceHere>
Slots slotsOf(std::vector<CandidatePair> candidates,
              const Kokkos::View<Plane*, Kokkos::HostSpace>& planes, const std::vector<Face>& faces,
              const FaceHere& faceHere, EndedPlanes& ended)
{
  const std::size_t old = planes.extent(0), candidateCount = candidates.size();
  Slots slots;
  slots.pairs = std::move(candidates);
  slots.existing.assign(candidateCount, -1);
  slots.source.reserve(candidateCount);
  const auto keep = [&](std::size_t p)
  {
    const Plane& plane = planes(p);
    if (!plane.isBorn())
      return;
    if (plane.area > 0)
    {
      // A bond may hold while it is open farther than the skin, a contact be deeper than its limit,
      // and faces that do not oppose each other any more need one more update, which books the work
      // of the last force.
      slots.source.push_back(std::int64_t(slots.pairs.size()));
      slots.pairs.push_back({faceHere(plane.faceId[0]), faceHere(plane.faceId[1])});
      slots.existing.push_back(std::int64_t(p));
      return;
    }
    // Planes that are no candidates now are kept for two searches, joints for ever; their energy is
    // booked at their end.
    if (plane.declared || plane.sighting != Sighting::Missed)
      slots.source.push_back(~std::int64_t(p));
    else if (plane.countedHere)
      ended.add(plane);
  };
  std::size_t p = 0;
  for (std::size_t i = 0; i < candidateCount; ++i)
  {
    const auto key =
        std::make_pair(faces[slots.pairs[i].lower].id, faces[slots.pairs[i].higher].id);
    for (; p < old && keyOf(planes(p)) < key; ++p)
      keep(p);
    if (p < old && keyOf(planes(p)) == key)
      slots.existing[i] = std::int64_t(p++);
    slots.source.push_back(std::int64_t(i));
  }
  for (; p < old; ++p)
    keep(p);
  return slots;
}

/// Places in `donors` by the ids of their faces, sorted.
std::vector<std::pair<GlobalId, std::size_t>> byFace(const std::vector<Donor>& donors)
{
  std::vector<std::pair<GlobalId, std::size_t>> places;
  for (std::size_t d = 0; d < donors.size(); ++d)
    for (const GlobalId id : donors[d].faceId)
      places.emplace_back(id, d);
  std::sort(places.begin(), places.end());
  return places;
}
} // namespace

/// What a living plane has to give, during a search.
Donor Contact::donor(const Plane& plane) const
{
  Donor donor = donorOf(plane);
  for (int side = 0; side < 2; ++side)
    if (plane.face[side] >= 0)
    {
      const Face& face = faceTable_(plane.face[side]);
      donor.count[side] = face.count;
      for (int k = 0; k < face.count; ++k)
      {
        donor.nodes[side][k] = nodeIds_[face.nodes[k]];
        donor.corners[side][k] = at(oldX_, face.nodes[k]);
      }
    }
  return donor;
}

std::vector<Donor> Contact::livingPlanes() const
{
  std::vector<Donor> donors;
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
    if (isDonor(planes_(p)))
      donors.push_back(donor(planes_(p)));
  return donors;
}

std::vector<GlobalId> Contact::findGhosts(const ConstNodeVectors& x,
                                          const std::vector<GlobalId>& nodeIds,
                                          const ConstNodeVectors& v, Real ahead)
{
  nodeIds_ = nodeIds;
  oldX_ = x;
  {
    TimedRegion region("coplane::contact::step1_globalSpaceLimits");
    std::vector<Real> offset{0};
    for (std::size_t p = 0; p < planes_.extent(0); ++p)
      offset[0] = std::max(offset[0], planes_(p).offset);
    comm_->max(offset);
    candidates_.offset = offset[0];
    candidates_.reach = candidates_.skin + candidates_.offset;
    candidates_.motion = {};
    if (ahead > 0)
      candidates_.motion = {v, ahead, commonVelocity(localFaces_, v, *comm_)};
    bins_ = step1_globalSpaceLimits(localFaces_, x, candidates_, *comm_);
  }
  ghosts_ = {};
  std::vector<GlobalId> nodes;
  if (comm_->size() == 1)
    return nodes;
  SortedFaces sorted;
  {
    TimedRegion region("coplane::contact::step2_sortIntoBins");
    const WorkWatch watch(searchSeconds_);
    sorted = step2_sortIntoBins(bins_, localFaces_, x, dimension_, candidates_);
  }
  std::vector<InteractingRank> ranks;
  {
    TimedRegion region("coplane::contact::step3_interactingRanks");
    ranks = step3_interactingRanks(sorted, *comm_);
  }
  {
    TimedRegion region("coplane::contact::step4_copyGhostFaces");
    ghosts_ = step4_copyGhostFaces(ranks, sorted, localFaces_, nodeIds, livingPlanes(), *comm_);
  }
  addGhostsOfLivingPlanes(nodeIds);
  return nodesOfGhosts();
}

std::vector<GlobalId> Contact::nodesOfGhosts() const
{
  std::vector<GlobalId> nodes;
  for (const GhostFace& face : ghosts_.faces)
    nodes.insert(nodes.end(), face.nodes, face.nodes + face.count);
  return nodes;
}

void Contact::addGhostsOfLivingPlanes(const std::vector<GlobalId>& nodeIds)
{
  const auto less = [](const GhostFace& a, const GhostFace& b) { return a.id < b.id; };
  std::vector<GlobalId> wanted;
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
    if (planes_(p).area > 0)
      for (const GlobalId id : planes_(p).faceId)
      {
        GhostFace face;
        face.id = id;
        const auto local =
            std::lower_bound(localFaces_.begin(), localFaces_.end(), id,
                             [](const Face& f, GlobalId wantedId) { return f.id < wantedId; });
        if ((local == localFaces_.end() || local->id != id) &&
            !std::binary_search(ghosts_.faces.begin(), ghosts_.faces.end(), face, less))
          wanted.push_back(id);
      }
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  if (comm_->max(std::int64_t(wanted.size())) == 0)
    return;
  const std::vector<GhostFace> fetched = fetchGhosts(wanted, nodeIds);
  if (comm_->max(std::int64_t(fetched.size() != wanted.size())) > 0)
    failOnAllRanks(ExitCode::Internal, "A contact plane has lost one of its faces.");
  const auto middle = ghosts_.faces.insert(ghosts_.faces.end(), fetched.begin(), fetched.end());
  std::inplace_merge(ghosts_.faces.begin(), middle, ghosts_.faces.end(), less);
}

CandidateRules Contact::candidateRules() const
{
  CandidateRules rules = candidates_;
  rules.declared = [this](int a, int b) { return rules_.between(a, b).declared; };
  rules.excluded = [this](int a, int b) { return rules_.between(a, b).excluded; };
  return rules;
}

/// Makes the slots of a search: those of planes that are there already, those of new pairs, which
/// take over from their neighbours, and those of planes that become dormant.
class Contact::SlotFiller
{
public:
  SlotFiller(const Contact& contact, const Slots& slots, const ConstNodeVectors& x,
             const NodeLayout& layout)
      : contact_(contact), slots_(slots), x_(x), layout_(layout), facePlanes_(facePlanesOf()),
        edges_(slots.pairs, contact.faces_, contact.localFaces_.size(), facePlanes_, x,
               contact.dimension_, layout),
        donorsOfGhost_(byFace(contact.ghosts_.donors)), gives_(contact.planes_.extent(0))
  {
    parallelFor("coplane::contact::gives", int(gives_.size()),
                [&](const int p) { gives_[p] = char(isDonor(contact_.planes_(p))); });
  }

  void fill(int slot, Plane& plane) const
  {
    const std::int64_t source = slots_.source[slot];
    if (source < 0)
    {
      plane = contact_.planes_(~source);
      makeDormant(plane);
      return;
    }
    const CandidatePair& pair = slots_.pairs[source];
    const std::int64_t known = slots_.existing[source];
    plane = known >= 0 ? contact_.planes_(known) : newSlot(face(pair.lower), face(pair.higher));
    plane.face[0] = pair.lower;
    plane.face[1] = pair.higher;
    // While the faces lie in each other, edges stay what they are, and the energy does not jump.
    if (known < 0 || !(plane.overlap > 0 && plane.gap < plane.offset))
      edges_.look(std::size_t(source), plane);
    if (plane.sighting == Sighting::Missed)
      plane.sighting = Sighting::Woken;
    // The neighbours of a face that erosion has just laid bare lie on the old surface.
    if (contact_.options_.inherit && !plane.isBorn() && !face(pair.lower).young &&
        !face(pair.higher).young)
      takeOver(plane, known >= 0 && !plane.isNew() ? plane.overlap : -1);
  }

private:
  const Face& face(int f) const { return contact_.faces_[f]; }

  Array<FacePlane> facePlanesOf() const
  {
    const Array<FacePlane> planes(
        Kokkos::ViewAllocateWithoutInitializing("coplane::contact::facePlanes"),
        contact_.faces_.size());
    parallelFor("coplane::contact::facePlanes", int(contact_.faces_.size()),
                [&](const int f)
                { new (&planes(f)) FacePlane(facePlane(face(f), x_, contact_.dimension_)); });
    return planes;
  }

  Plane newSlot(const Face& a, const Face& b) const
  {
    Plane plane;
    const ContactRule& rule = contact_.rules_.between(a.group, b.group);
    plane.faceId[0] = a.id;
    plane.faceId[1] = b.id;
    plane.joint = std::uint16_t(rule.joint);
    plane.block[0] = std::uint16_t(a.block);
    plane.block[1] = std::uint16_t(b.block);
    plane.countedHere = a.ownedHere;
    plane.fit = contact_.rules_.joints[rule.joint].law.fittedTo(a.thickness, a.modulus, b.thickness,
                                                                b.modulus);
    plane.stiff = plane.fit.normalStiffness * (a.thickness / a.modulus + b.thickness / b.modulus) >
                  stiffestCalm;
    plane.depthLimit = contact_.options_.depthMax * std::min(a.thickness, b.thickness);
    return plane;
  }

  /// What the living planes of its faces pass on to a slot that has not touched yet, sought anew at
  /// every search.
  void takeOver(Plane& plane, Real sharedBefore) const
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
    const Continuation continuation(now, contact_.dimension_, contact_.skin_);
    std::vector<Donor> heirlooms;
    for (Donor& donor : donors)
    {
      if (!continuation.isNear(donor))
        continue;
      donor.flush = isFlush(now, donor, contact_.dimension_);
      if (continuation.goesOn(donor))
        heirlooms.push_back(donor);
    }
    inherit(plane, normal, now.nodes, heirlooms);
  }

  /// Donors of a face, from before this search: a local face has all its planes here, those of a
  /// ghost have come with it.
  void addDonors(int f, const Plane& plane, const Vec3& normal, std::vector<Donor>& donors) const
  {
    if (face(f).local)
    {
      if (contact_.searches_ > 0)
        contact_.forceSums_.forEachPlaneOf(
            f,
            [&](int p)
            {
              if (gives_[p] && fits(contact_.planes_(p), plane, normal))
                donors.push_back(contact_.donor(contact_.planes_(p)));
            });
      return;
    }
    const std::vector<Donor>& ofGhosts = contact_.ghosts_.donors;
    for (auto d = std::lower_bound(donorsOfGhost_.begin(), donorsOfGhost_.end(),
                                   std::make_pair(face(f).id, std::size_t(0)));
         d != donorsOfGhost_.end() && d->first == face(f).id; ++d)
      if (fits(ofGhosts[d->second], plane, normal))
        donors.push_back(ofGhosts[d->second]);
  }

  NewPair newPair(const Plane& plane, const Vec3& normal, Real sharedBefore) const
  {
    NewPair now;
    now.normal = normal;
    now.sharedBefore = sharedBefore;
    for (int side = 0; side < 2; ++side)
    {
      const Face& mine = face(plane.face[side]);
      now.faceId[side] = mine.id;
      now.count[side] = mine.count;
      for (int k = 0; k < mine.count; ++k)
      {
        now.nodes[side][k] = layout_.ids()[mine.nodes[k]];
        now.corners[side][k] = at(x_, mine.nodes[k]);
      }
    }
    return now;
  }

  const Contact& contact_;
  const Slots& slots_;
  const ConstNodeVectors& x_;
  const NodeLayout& layout_;
  const Array<FacePlane> facePlanes_;
  const EdgesOfSurfaces edges_;
  const std::vector<std::pair<GlobalId, std::size_t>> donorsOfGhost_;
  std::vector<char> gives_; ///< much smaller than the planes, which are asked often
};

void Contact::pairUp(const ConstNodeVectors& x, const NodeLayout& layout, bool again,
                     const ConstNodeVectors& v)
{
  TimedRegion region("coplane::contact::step5_candidatePairs");
  const WorkWatch watch(searchSeconds_);
  listFaces(layout);
  candidates_.motion.v = v;
  const Slots slots = slotsOf(
      step5_candidatePairs(bins_, faces_, x, dimension_, candidateRules()), planes_, faces_,
      [&](GlobalId id) { return faceHere(id); }, ended_);
  const int count = int(slots.source.size());
  const Kokkos::View<Plane*, Kokkos::HostSpace> next(
      Kokkos::ViewAllocateWithoutInitializing("coplane::contact::planes"), std::size_t(count));
  const SlotFiller filler(*this, slots, x, layout);
  parallelFor("coplane::contact::fillSlots", count,
              [&](const int slot) { filler.fill(slot, next(slot)); });

  planes_ = next;
  nodeIds_ = {};
  oldX_ = {};
  candidates_.motion = {};
  takeFaceTables();
  buildLists(layout.owned());
  for (Face& face : localFaces_)
    face.young = false;
  if (!again)
    ++searches_;
  searchedSinceUpdate_ = true;
}
} // namespace coplane
