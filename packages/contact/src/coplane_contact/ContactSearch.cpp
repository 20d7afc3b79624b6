#include <coplane_contact/Contact.hpp>
#include <coplane_contact/detail/Inheritance.hpp>
#include <coplane_contact/detail/Preparation.hpp>
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
  plane.exits = plane.turns = plane.covered = 0;
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
      donor.body[side] = face.body;
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
  std::vector<std::size_t> living;
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
    if (activity_(p) != Activity::Asleep && isDonor(planes_(p)))
      living.push_back(p);
  std::vector<Donor> donors(living.size());
  parallelFor("coplane::contact::livingPlanes", int(living.size()),
              [&](const int d) { donors[d] = donor(planes_(living[d])); });
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
      if (planes_(p).isBorn())
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
  std::vector<GlobalId> wanted;
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
    if (planes_(p).area > 0)
      for (const GlobalId id : planes_(p).faceId)
        if (!hasFace(localFaces_, id) && !hasFace(ghosts_.faces, id))
          wanted.push_back(id);
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  if (comm_->max(std::int64_t(wanted.size())) == 0)
    return;
  const std::vector<GhostFace> fetched = fetchGhosts(wanted, nodeIds);
  if (comm_->max(std::int64_t(fetched.size() != wanted.size())) > 0)
    failOnAllRanks(ExitCode::Internal, "A contact plane has lost one of its faces.");
  const auto middle = ghosts_.faces.insert(ghosts_.faces.end(), fetched.begin(), fetched.end());
  std::inplace_merge(ghosts_.faces.begin(), middle, ghosts_.faces.end(),
                     [](const GhostFace& a, const GhostFace& b) { return a.id < b.id; });
}

CandidateRules Contact::candidateRules() const
{
  CandidateRules rules = candidates_;
  rules.declared = [this](int a, int b) { return rules_.between(a, b).declared; };
  rules.excluded = [this](int a, int b) { return rules_.between(a, b).excluded; };
  return rules;
}

/// Makes the slots of a search: those of planes that are there already, those of new pairs, and
/// those of planes that become dormant.
class Contact::SlotFiller
{
public:
  SlotFiller(const Contact& contact, const Slots& slots, const Preparation& preparation)
      : contact_(contact), slots_(slots), preparation_(preparation)
  {
  }

  /// @returns what is to be done when the pair comes near
  Preparation::Todo fill(int slot, Plane& plane) const
  {
    const std::int64_t source = slots_.source[slot];
    if (source < 0)
    {
      new (&plane) Plane(contact_.planes_(~source));
      makeDormant(plane);
      return 0;
    }
    const CandidatePair& pair = slots_.pairs[source];
    const Face &lower = contact_.faces_[pair.lower], &higher = contact_.faces_[pair.higher];
    const std::int64_t known = slots_.existing[source];
    new (&plane) Plane(known >= 0 ? contact_.planes_(known) : newSlot(lower, higher));
    plane.face[0] = pair.lower;
    plane.face[1] = pair.higher;
    Preparation::Todo todo = known >= 0 && !plane.isNew() ? Preparation::WasKnown : 0;
    // While the faces lie in each other, edges stay what they are, and the energy does not jump.
    if (known < 0 || !(plane.overlap > 0 && plane.gap < plane.offset))
      todo |= Preparation::LookAtEdges;
    if (plane.sighting == Sighting::Missed)
      plane.sighting = Sighting::Woken;
    // The neighbours of a face that erosion has just laid bare lie on the old surface.
    if (contact_.options_.inherit && !plane.isBorn() && !lower.young && !higher.young)
      todo |= Preparation::TakeOver;
    if (known < 0 || contact_.activity_(known) == Activity::Asleep)
      return todo;
    preparation_.prepare(slot, todo, plane);
    return 0;
  }

private:
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

  const Contact& contact_;
  const Slots& slots_;
  const Preparation& preparation_;
};

void Contact::pairUp(const ConstNodeVectors& x, const NodeLayout& layout, bool again,
                     const ConstNodeVectors& v)
{
  TimedRegion region("coplane::contact::step5_candidatePairs");
  const WorkWatch watch(searchSeconds_);
  preparation_.reset();
  todo_ = {};
  std::vector<Donor> donors;
  if (options_.inherit)
  {
    donors = livingPlanes();
    donors.insert(donors.end(), ghosts_.donors.begin(), ghosts_.donors.end());
  }
  ghosts_.donors = {};
  listFaces(layout);
  takeFaceTables();
  candidates_.motion.v = v;
  Slots slots = slotsOf(
      step5_candidatePairs(bins_, faces_, x, dimension_, candidateRules()), planes_, faces_,
      [&](GlobalId id) { return faceHere(id); }, ended_);
  const int count = int(slots.source.size());
  const Kokkos::View<Plane*, Kokkos::HostSpace> next(
      Kokkos::ViewAllocateWithoutInitializing("coplane::contact::planes"), std::size_t(count));
  preparation_ =
      std::make_shared<Preparation>(Preparation::Search{slots.pairs, slots.source, faceTable_,
                                                        localFaces_.size(), x, dimension_, skin_},
                                    std::move(donors), layout);
  const SlotFiller filler(*this, slots, *preparation_);
  const Array<Preparation::Todo> todo("coplane::contact::todo", std::size_t(count));
  parallelFor("coplane::contact::fillSlots", count,
              [&](const int slot) { todo(slot) = filler.fill(slot, next(slot)); });

  planes_ = next;
  todo_ = todo;
  nodeIds_ = {};
  oldX_ = {};
  candidates_.motion = {};
  buildLists(layout.owned());
  for (Face& face : localFaces_)
    face.young = false;
  if (!again)
    ++searches_;
  searchedSinceUpdate_ = true;
  passedOnHasChanged_ = false;
}

void Contact::prepareAll() const
{
  parallelFor("coplane::contact::prepareAll", int(todo_.extent(0)),
              [&](const int slot)
              {
                if (todo_(slot) != 0)
                  preparation_->prepare(slot, todo_(slot), planes_(slot));
                todo_(slot) = 0;
              });
}

void Contact::listFaces(const NodeLayout& layout)
{
  faces_ = localFaces_;
  const auto localNode = [&](GlobalId id) { return layout.localNode(id); };
  for (const GhostFace& ghost : ghosts_.faces)
    faces_.push_back(toFace(ghost, localNode));
}

int Contact::faceHere(GlobalId id) const
{
  const auto ghosts = faces_.begin() + std::ptrdiff_t(localFaces_.size());
  auto found = findFace(faces_.begin(), ghosts, id);
  if (found == ghosts)
    found = findFace(ghosts, faces_.end(), id);
  return found != faces_.end() ? int(found - faces_.begin()) : -1;
}

void Contact::takeFaceTables()
{
  faceTable_ = Array<Face>(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::faces"),
                           faces_.size());
  std::copy(faces_.begin(), faces_.end(), faceTable_.data());
}
} // namespace coplane
