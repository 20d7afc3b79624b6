#include <coplane_contact/Contact.hpp>
#include <coplane_contact/Preparation.hpp>
#include <coplane_contact/detail/Inheritance.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_core/WorkWatch.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
/// Carries nothing until its faces are candidates again.
void makeDormant(Plane& plane)
{
  carryNothing(plane);
  plane.face[0] = plane.face[1] = -1;
  plane.overlap = plane.nodeStiffness = 0;
  plane.exits = plane.turns = plane.covered = plane.seams = 0;
  plane.sighting = Sighting::Missed;
  plane.refusal = Refusal::None;
}

/// The slots after a search, sorted by key, and where each comes from.
struct Slots
{
  std::vector<CandidatePair> pairs;   ///< candidates, then other pairs that carry traction
  std::vector<std::int64_t> existing; ///< by pair: its slot from before the search, or -1
  std::vector<std::int64_t>
      source; ///< by slot: a pair, or ~p of a slot whose plane becomes dormant
};

/// Candidates and slots are both sorted by key: which pairs have their slot already, and what
/// becomes of planes that are no candidates. Those that end are booked in `ended`.
Slots slotsOf(std::vector<CandidatePair> candidates, const PlaneTable& before,
              const FaceTable& faces, EndedPlanes& ended)
{
  const std::size_t old = before.count(), candidateCount = candidates.size();
  Slots slots;
  slots.pairs = std::move(candidates);
  slots.existing.assign(candidateCount, -1);
  slots.source.reserve(candidateCount);
  const auto keep = [&](std::size_t p)
  {
    const Plane* const known = before.slots().plane[p];
    if (known == nullptr || !known->isBorn())
      return;
    const Plane& plane = *known;
    if (plane.pushes())
    {
      // A bond may hold while it is open farther than the skin, a contact be deeper than its limit,
      // and faces that do not oppose each other any more need one more update, which books the work
      // of the last force.
      slots.source.push_back(std::int64_t(slots.pairs.size()));
      slots.pairs.push_back({faces.place(plane.faceId[0]), faces.place(plane.faceId[1])});
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
        std::make_pair(faces.all()[slots.pairs[i].lower].id, faces.all()[slots.pairs[i].higher].id);
    for (; p < old && before.keyOf(p) < key; ++p)
      keep(p);
    if (p < old && before.keyOf(p) == key)
      slots.existing[i] = std::int64_t(p++);
    slots.source.push_back(std::int64_t(i));
  }
  for (; p < old; ++p)
    keep(p);
  return slots;
}

/// Makes the slots of a search: those of planes that are there already, those of other pairs, and
/// those of planes that become dormant.
class SlotFiller
{
public:
  SlotFiller(bool inherit, const std::vector<Face>& faces, const PlaneTable& before,
             const Slots& slots, const Preparation& preparation)
      : inherit_(inherit), faces_(faces), before_(before), slots_(slots), preparation_(preparation)
  {
  }

  /// The slots, with their planes where these are there already.
  PlaneTable::Slots made() const
  {
    const int count = int(slots_.source.size());
    std::size_t planes = 0;
    for (int slot = 0; slot < count; ++slot)
      planes += planeBefore(slot) != nullptr;
    PlaneTable::Slots next(std::size_t(count), planes);
    planes = 0;
    for (int slot = 0; slot < count; ++slot)
      if (planeBefore(slot) != nullptr)
        next.plane[slot] = &next.stored(planes++);
    parallelFor("coplane::contact::fillSlots", count, [&](const int slot) { fill(slot, next); });
    return next;
  }

private:
  /// The slot before the search, or -1.
  std::int64_t slotBefore(int slot) const
  {
    const std::int64_t source = slots_.source[std::size_t(slot)];
    return source < 0 ? ~source : slots_.existing[std::size_t(source)];
  }
  const Plane* planeBefore(int slot) const
  {
    const std::int64_t before = slotBefore(slot);
    return before < 0 ? nullptr : before_.slots().plane[before];
  }

  void fill(int slot, const PlaneTable::Slots& next) const
  {
    const std::int64_t source = slots_.source[std::size_t(slot)];
    const Plane* const before = planeBefore(slot);
    Plane* const plane = next.plane[slot];
    if (plane != nullptr)
      new (plane) Plane(*before);
    if (source < 0)
    {
      makeDormant(*plane);
      return;
    }
    const CandidatePair& pair = slots_.pairs[std::size_t(source)];
    const std::int64_t known = slotBefore(slot);
    Preparation::Todo todo = 0;
    // While the faces lie in each other, edges stay what they are, and the energy does not jump.
    if (before == nullptr || !(before->overlap > 0 && before->gap < before->offset))
      todo |= Preparation::LookAtEdges;
    // The neighbours of a face that erosion has just laid bare lie on the old surface.
    if (inherit_ && !(before != nullptr && before->isBorn()) && !faces_[pair.lower].young &&
        !faces_[pair.higher].young)
      todo |= known >= 0 ? before_.takeOver(std::size_t(known)) : Preparation::TakeOver;
    next.faces(slot).face[0] = pair.lower;
    next.faces(slot).face[1] = pair.higher;
    next.todo(slot) = todo;
    next.activity(slot) =
        known >= 0 && before == nullptr ? before_.slots().activity(known) : Activity::Awake;
    if (plane == nullptr)
      return;
    plane->face[0] = pair.lower;
    plane->face[1] = pair.higher;
    plane->pairAs(isShallow(faces_[pair.lower], faces_[pair.higher]), plane->isGrowing());
    if (plane->sighting == Sighting::Missed)
      plane->sighting = Sighting::Woken;
    if (!(plane->area > 0)) // told when it comes near
      return;
    preparation_.prepare(std::size_t(slot), todo, *plane);
    next.todo(slot) = 0;
  }

  const bool inherit_;
  const std::vector<Face>& faces_;
  const PlaneTable& before_;
  const Slots& slots_;
  const Preparation& preparation_;
};

/// What a living plane has to give. @param nodeIds, x of the nodes of the table of faces
Donor donorWithFaces(const Plane& plane, const Array<Face>& faces,
                     const std::vector<GlobalId>& nodeIds, const ConstNodeVectors& x)
{
  Donor donor = donorOf(plane);
  for (int side = 0; side < 2; ++side)
    if (plane.face[side] >= 0)
    {
      const Face& face = faces(plane.face[side]);
      donor.count[side] = face.count;
      donor.body[side] = face.body;
      for (int k = 0; k < face.count; ++k)
      {
        donor.nodes[side][k] = nodeIds[face.nodes[k]];
        donor.corners[side][k] = at(x, face.nodes[k]);
      }
    }
  return donor;
}
} // namespace

std::vector<Donor> Contact::livingPlanes(const std::vector<GlobalId>& nodeIds,
                                         const ConstNodeVectors& x) const
{
  std::vector<std::size_t> living;
  for (std::size_t p = 0; p < planes().size(); ++p)
    if (isDonor(planes()[p], lawOf(planes()[p])))
      living.push_back(p);
  std::vector<Donor> donors(living.size());
  parallelFor("coplane::contact::livingPlanes", int(living.size()),
              [&](const int d) {
                donors[d] = donorWithFaces(planes()[living[d]], faces_.forKernels(), nodeIds, x);
              });
  return donors;
}

void Contact::findLimits(const ConstNodeVectors& x, const ConstNodeVectors& v, Real ahead)
{
  TimedRegion region("coplane::contact::step1_globalSpaceLimits");
  std::vector<Real> offset{0};
  for (std::size_t p = 0; p < planes().size(); ++p)
    if (const Plane& plane = planes()[p]; plane.isBorn())
      offset[0] = std::max(offset[0], plane.offset);
  comm_->max(offset);
  reach_.begin(offset[0], motionAhead(v, ahead));
  firstHalf_.bins = step1_globalSpaceLimits(localFaces(), x, reach_.rules(), *comm_);
}

std::vector<GlobalId> Contact::findGhosts(const ConstNodeVectors& x,
                                          const std::vector<GlobalId>& nodeIds,
                                          const ConstNodeVectors& v, Real ahead)
{
  firstHalf_ = {};
  firstHalf_.nodeIds = nodeIds;
  firstHalf_.x = x;
  findLimits(x, v, ahead);
  if (comm_->size() == 1)
    return {};
  SortedFaces sorted;
  {
    TimedRegion region("coplane::contact::step2_sortIntoBins");
    const WorkWatch watch(searches_.seconds);
    sorted = step2_sortIntoBins(firstHalf_.bins, localFaces(), x, dimension_, reach_.rules());
  }
  std::vector<InteractingRank> ranks;
  {
    TimedRegion region("coplane::contact::step3_interactingRanks");
    ranks = step3_interactingRanks(sorted, *comm_);
  }
  {
    TimedRegion region("coplane::contact::step4_copyGhostFaces");
    firstHalf_.ghosts =
        step4_copyGhostFaces(ranks, sorted, localFaces(), nodeIds,
                             livingPlanes(firstHalf_.nodeIds, firstHalf_.x), *comm_);
  }
  addGhostsOfLivingPlanes(nodeIds);
  return firstHalf_.nodesOfGhosts();
}

std::vector<GlobalId> Contact::FirstHalf::nodesOfGhosts() const
{
  std::vector<GlobalId> nodes;
  for (const GhostFace& face : ghosts.faces)
    nodes.insert(nodes.end(), face.nodes, face.nodes + face.count);
  return nodes;
}

void Contact::addGhostsOfLivingPlanes(const std::vector<GlobalId>& nodeIds)
{
  std::vector<GhostFace>& ghosts = firstHalf_.ghosts.faces;
  std::vector<GlobalId> wanted;
  for (std::size_t p = 0; p < planes().size(); ++p)
    if (const Plane& plane = planes()[p]; plane.pushes())
      for (const GlobalId id : plane.faceId)
        if (!hasFace(localFaces(), id) && !hasFace(ghosts, id))
          wanted.push_back(id);
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  if (comm_->max(std::int64_t(wanted.size())) == 0)
    return;
  const std::vector<GhostFace> fetched = fetchGhosts(wanted, nodeIds);
  if (comm_->max(std::int64_t(fetched.size() != wanted.size())) > 0)
    failOnAllRanks(ExitCode::Internal, "A contact plane has lost one of its faces.");
  const auto middle = ghosts.insert(ghosts.end(), fetched.begin(), fetched.end());
  std::inplace_merge(ghosts.begin(), middle, ghosts.end(),
                     [](const GhostFace& a, const GhostFace& b) { return a.id < b.id; });
}

void Contact::measureDistances(const ConstNodeVectors& x, const ConstNodeVectors& v)
{
  // Bodies that fly apart go on as they were foreseen for longer than searches look.
  constexpr Real longer = 3;
  distances_.forget();
  if (options_.forces != ContactOptions::Forces::Potential)
    return;
  const auto& slots = planes_.slots().faces;
  const Array<std::uint8_t> mayReach("coplane::contact::mayReach", slots.extent(0));
  parallelFor("coplane::contact::mayReach", int(slots.extent(0)),
              [&](const int slot)
              {
                const SlotFaces& pair = slots(slot);
                if (pair.face[0] < 0)
                  return;
                // What has absorbed an uneven gap may act beyond the offset.
                const Plane* const plane = planes_.slots().plane[slot];
                mayReach(slot) = lawOf(pair).mayReachOut() ||
                                 (plane != nullptr && plane->history.absorbedUnevenly);
              });
  CandidateRules rules = reach_.rules();
  Motion& motion = rules.motion;
  motion.ahead *= longer;
  distances_.take(slots, faces_.forKernels(),
                  facePlanes(faces().data(), faces().size(), x, dimension_, rules), mayReach,
                  {x, motion.ahead > 0 ? copyOf(v) : ConstNodeVectors(), motion.ahead, motion.frame,
                   reach_.offset(), leastOpposed(options_)});
}

void Contact::restoreDistances(const ConstNodeVectors& x, const ConstNodeVectors& v, Real ahead)
{
  reach_.begin(reach_.offset(), motionAhead(v, ahead));
  measureDistances(copyOf(x), v);
  reach_.end();
}

Motion Contact::motionAhead(const ConstNodeVectors& v, Real ahead) const
{
  if (!(ahead > 0))
    return {};
  return {v, ahead, commonVelocity(localFaces(), v, *comm_)};
}

Heritage::Place Contact::placeOfFaces(const ConstNodeVectors& x, const NodeLayout& layout) const
{
  return {faces_.forKernels(), copyOf(x),          layout.ids(),
          dimension_,          reach_.leastSkin(), options_.axisymmetric};
}

void Contact::passOnAnew(const ConstNodeVectors& x, const NodeLayout& layout)
{
  TimedRegion region("coplane::contact::passOnAnew");
  const WorkWatch watch(searches_.seconds);
  std::vector<Donor> donors = livingPlanes(layout.ids(), x);
  const std::vector<Donor> theirs = donorsOfGhosts(donors);
  donors.insert(donors.end(), theirs.begin(), theirs.end());
  planes_.renew(std::make_shared<const Heritage>(placeOfFaces(x, layout), std::move(donors)));
}

std::vector<Donor> Contact::donorsOfGhosts(const std::vector<Donor>& mine)
{
  if (comm_->size() == 1)
    return {};
  if (!ghostsElsewhere_.known)
  {
    std::vector<GlobalId> ghosts;
    for (std::size_t f = localFaces().size(); f < faces().size(); ++f)
      ghosts.push_back(faces()[f].id);
    ghostsElsewhere_ = {true, askOwners(ghosts)};
    std::sort(ghostsElsewhere_.faces.begin(), ghostsElsewhere_.faces.end());
  }
  std::vector<std::vector<Donor>> send(comm_->size());
  for (const Donor& donor : mine)
    for (const GlobalId id : donor.faceId)
      for (auto wanted = std::lower_bound(ghostsElsewhere_.faces.begin(),
                                          ghostsElsewhere_.faces.end(), WantedFace{id, 0});
           wanted != ghostsElsewhere_.faces.end() && wanted->face == id; ++wanted)
        send[wanted->byRank].push_back(donor);
  return comm_->exchange(send);
}

void Contact::pairUp(const ConstNodeVectors& x, const NodeLayout& layout, bool again,
                     const ConstNodeVectors& v)
{
  TimedRegion region("coplane::contact::step5_candidatePairs");
  const WorkWatch watch(searches_.seconds);
  planes_.forgetPreparation();
  std::vector<Donor> donors;
  if (options_.inherit)
  {
    donors = livingPlanes(firstHalf_.nodeIds, firstHalf_.x);
    const std::vector<Donor>& theirs = firstHalf_.ghosts.donors;
    donors.insert(donors.end(), theirs.begin(), theirs.end());
  }
  firstHalf_.ghosts.donors = {};
  faces_.list(firstHalf_.ghosts.faces, layout);
  reach_.takeVelocities(v);
  const SortedFaces sorted =
      step2_sortIntoBins(firstHalf_.bins, faces(), x, dimension_, reach_.rules());
  Slots slots = slotsOf(step5_candidatePairs(sorted, faces(), x, reach_.rulesWith(rules_)), planes_,
                        faces_, ended_);
  const Heritage::Place place = placeOfFaces(x, layout);
  Preparation preparation({slots.pairs, slots.source, localFaces().size()}, place, sorted.planes,
                          rules_.mirrors,
                          std::make_shared<const Heritage>(place, std::move(donors)), layout);
  PlaneTable::Slots made =
      SlotFiller(options_.inherit, faces(), planes_, slots, preparation).made();
  planes_.take(std::move(made), faces_.forKernels(), std::move(preparation));
  measureDistances(place.x, v);
  planesHaveChanged();
  firstHalf_ = {};
  ghostsElsewhere_ = {};
  reach_.end();
  listSlotsOfFaces(layout.owned());
  for (Face& face : faces_.local())
    face.young = false;
  if (!again)
    ++searches_.count;
  searches_.sinceUpdate = true;
}
} // namespace coplane
