#include <coplane_contact/Contact.hpp>
#include <coplane_contact/detail/FacePairLanes.hpp>
#include <coplane_contact/detail/NodesOfFace.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_geometry/FaceCorners.hpp>

#include <algorithm>
#include <limits>
#include <numeric>

namespace coplane
{
namespace
{
/// Planes keep the numbers of joint cards and blocks in 16 bits.
void demandFewKinds(const Comm& comm, const std::vector<Face>& faces, const ContactRules& rules)
{
  constexpr std::int64_t most = std::numeric_limits<std::uint16_t>::max();
  std::int64_t blocks = 0;
  for (const Face& face : faces)
    blocks = std::max(blocks, std::int64_t(face.block) + 1);
  blocks = comm.max(blocks);
  const auto demand = [&](std::int64_t count, const char* what, const char* instead)
  {
    if (count > most)
      failOnAllRanks(ExitCode::Deck, "contact of {} {}: at most {} are possible. {}", count, what,
                     most, instead);
  };
  demand(blocks, "element blocks",
         "Put bodies of one material into one block of the mesh: contact tells bodies apart by "
         "their faces, not by their blocks.");
  demand(std::int64_t(rules.joints.size()), "joint laws", "Remove cards that are equal to others.");
}
} // namespace

Contact::Contact(const Comm& comm, int dimension, std::vector<Face> localFaces,
                 ContactOptions options, ContactRules rules, Real skin, Real smallestFace)
    : comm_(&comm), dimension_(dimension), options_(options), rules_(std::move(rules)),
      faces_(std::move(localFaces)), reach_(options, skin, smallestFace),
      planes_(rules_, options_.depthMax)
{
  demandFewKinds(comm, faces_.local(), rules_);
}

Real Contact::smallestFaceSize(const std::vector<Face>& faces, const ConstNodeVectors& x,
                               int dimension, const Comm& comm)
{
  Real smallest = infinity;
  for (const Face& face : faces)
  {
    const Real area = norm(cornersAt(x, face).area(dimension));
    smallest = std::min(smallest, faceSize(area, dimension));
  }
  return comm.min(smallest);
}

void Contact::endPlanesOf(const std::vector<GlobalId>& deadElements,
                          const std::vector<GlobalId>& gone, const ConstNodeVectors& x,
                          const ConstNodeVectors& v, Real dt, const Substep& last)
{
  const auto isDead = [&](GlobalId face)
  {
    return std::binary_search(deadElements.begin(), deadElements.end(), elementOfFace(face)) ||
           std::binary_search(gone.begin(), gone.end(), face);
  };
  const auto halfStep = [&](int face, const Substep& step)
  {
    const Face& of = faces()[face];
    FaceNodes nodes = nodesOf(of, x);
    for (int k = 0; k < nodes.count; ++k)
      nodes.v[k] = at(step.v, of.nodes[k]);
    return stepA_halfStepFace(nodes, step.dt, dimension_);
  };
  const Substep cycle{v, dt};
  std::vector<std::size_t> ending;
  for (std::size_t p = 0; p < planes().size(); ++p)
  {
    Plane& plane = planes()[p];
    if (!isDead(plane.faceId[0]) && !isDead(plane.faceId[1]))
      continue;
    ending.push_back(planes().slotOf(p));
    if (!plane.isBorn() || !plane.countedHere)
      continue;
    // What the last force still does in this step belongs to what is lost.
    Real eroded = plane.stored - plane.work;
    if (plane.pushes())
    {
      const Substep& step = substepped_.has(planes().slotOf(p)) ? last : cycle;
      bookOldForce(plane, halfStep(plane.face[0], step), halfStep(plane.face[1], step), step.dt);
    }
    eroded += plane.work;
    ended_.add(plane, eroded);
  }
  planes_.drop(ending);
  planesHaveChanged();
}

void Contact::replaceLocalFaces(std::vector<Face> localFaces)
{
  faces_.replaceLocal(std::move(localFaces));
  forceSums_.forgetFaces(); // listed anew with the search that has to follow
}

void Contact::listSlotsOfFaces(int ownedNodes)
{
  pairedFaces_.mark(planes_.slots().faces, faces().size());
  forceSums_.listPlanes(planes_.slots().faces, localFaces().size(), faces().size());
  forceSums_.listFaces(localFaces(), ownedNodes);
}

Real Contact::stiffestOn(const Face& face) const
{
  const std::size_t kinds = std::size_t(rules_.kinds),
                    kind = std::size_t(rules_.kindOf[std::size_t(face.group)]);
  Real most = 0;
  for (std::size_t other = 0; other < kinds; ++other)
  {
    const ContactRule& rule = rules_.table[kind * kinds + other];
    if (rule.excluded)
      continue;
    const JointLaw& law = rules_.joints[std::size_t(rule.joint)].law;
    const JointFit fit = law.fittedTo(face.thickness, face.modulus, 0, face.modulus);
    most = std::max(most, law.curve.stiffens() ? fit.stiffnessCap : fit.normalStiffness);
  }
  return most;
}

namespace
{
/// Steps B to H for several pairs side by side. @param near slots that have faces, ascending
template <int Dim>
void stepsBtoHIn(const PairTables& pairs, const std::vector<int>& near,
                 const HalfStepFace* halfStep, const ContactOptions& options, Real dt)
{
  const int count = int(near.size());
  const int* const slots = near.data();
  // Several pieces for each thread, which take unlike times.
  const int atOnce = std::clamp(count / (8 * threadCount()), 8 * laneCount, PairLanes<Dim>::atOnce);
  parallelForUneven(
      "coplane::contact::stepsBtoH", (count + atOnce - 1) / atOnce, KOKKOS_LAMBDA(const int s) {
        const int first = s * atOnce;
        PairLanes<Dim>(pairs, halfStep, options, dt)
            .update(slots + first, std::min(atOnce, count - first));
      });
}
void stepsBtoH(const PairTables& pairs, const std::vector<int>& near, const HalfStepFace* halfStep,
               int dimension, const ContactOptions& options, Real dt)
{
  if (dimension == 2)
    stepsBtoHIn<2>(pairs, near, halfStep, options, dt);
  else
    stepsBtoHIn<3>(pairs, near, halfStep, options, dt);
}
} // namespace

PairedFaces::Motion Contact::motionOf(const ConstNodeVectors& x, const ConstNodeVectors& v,
                                      Real dt) const
{
  return {faces_.forKernels(), dimension_, x, v, options_.forces, dt};
}

void Contact::findFaces(const ConstNodeVectors& x, const ConstNodeVectors& v)
{
  pairedFaces_.stepA(motionOf(x, v, 0));
}

void Contact::step6_updateCommonPlanes(const ConstNodeVectors& x, const ConstNodeVectors& v,
                                       Real dt, Real lookAhead, Real sinceSearch,
                                       const Substep& last)
{
  TimedRegion region("coplane::contact::step6_updateCommonPlanes");
  distances_.follow(x, v, sinceSearch, lookAhead);
  lookAhead_ = lookAhead;
  near_.list(pairTables(), int(planes_.count()), faces().size());
  if (substepped_.empty())
  {
    pairedFaces_.stepA(motionOf(x, v, dt), near_.faces());
    updatePairs(near_.slots(), dt);
  }
  else
  {
    listSubsteppedNear();
    updateSubstepped(x, last);
    pairedFaces_.stepA(motionOf(x, v, dt), near_.faces());
    updatePairs(substepped_.othersOf(near_.slots()), dt);
  }
  planes_.listWoken();
  planesHaveChanged();
  if (searches_.sinceUpdate && searches_.count > 1)
    for (std::size_t p = 0; p < planes().size(); ++p)
      if (const Plane& plane = planes()[p];
          plane.sighting == Sighting::FoundLate && plane.countedHere && plane.face[0] >= 0)
        searches_.missed += wasMissed(plane, x);
  searches_.sinceUpdate = false;
}

void Contact::beginSubsteps(const ConstNodeVectors& x, const Substep& step, Real sinceSearch,
                            Real lookAhead)
{
  distances_.follow(x, step.v, sinceSearch, lookAhead);
  lookAhead_ = lookAhead;
  listSubsteppedNear();
}

void Contact::listSubsteppedNear()
{
  substepped_.listNear(
      planes_.slots().faces, [&](int slot)
      { return !distances_.isFar(slot) || !planes_.carriesNothing(std::size_t(slot)); });
}

void Contact::updateSubstepped(const ConstNodeVectors& x, const Substep& step)
{
  pairedFaces_.stepA(motionOf(x, step.v, step.dt), substepped_.nearFaces());
  updatePairs(substepped_.near(), step.dt);
  planesHaveChanged();
  planes_.listWoken(); // a search, or elements that die, may come before the next update
}

/// Steps B to H. @param slots whose faces have had step A, ascending
void Contact::updatePairs(const std::vector<int>& slots, Real dt)
{
  ContactOptions options = options_;
  options.lookAhead = lookAhead_;
  stepsBtoH(pairTables(), slots, pairedFaces_.data(), dimension_, options, dt);
}

PairTables Contact::pairTables()
{
  PairTables pairs = planes_.forKernels(isIncremental());
  pairs.distances = &distances_;
  pairs.changedFaces = forceSums_.changed().data();
  return pairs;
}

bool Contact::wasPassedOver(std::size_t slot) const
{
  return distances_.known() && planes_.slots().activity(slot) == Activity::Apart;
}

const PlaneList& Contact::planesNow() const
{
  if (!shown_)
    shown_ = planesNow([](const Plane&) { return true; });
  return shown_->list;
}

Contact::Shown Contact::planesNow(const std::function<bool(const Plane&)>& isAskedFor) const
{
  Shown shown;
  const PlaneList& all = planes();
  std::vector<std::size_t> passedOver;
  for (std::size_t p = 0; p < all.size(); ++p)
    if (all[p].isBorn() && wasPassedOver(all.slotOf(p)) && isAskedFor(all[p]))
      passedOver.push_back(p);
  const std::size_t count = passedOver.size();
  shown.copies = Kokkos::View<Plane*, Kokkos::HostSpace>(
      Kokkos::ViewAllocateWithoutInitializing("coplane::contact::shown"), count);
  std::vector<Plane*> copies(count);
  std::vector<SlotFaces> slots(count);
  std::vector<Activity> activity(count, Activity::Awake);
  parallelFor("coplane::contact::planesNow", int(count),
              [&](const int i)
              {
                copies[i] = new (&shown.copies(i)) Plane(all[passedOver[i]]);
                slots[i] = planes_.slots().faces(all.slotOf(passedOver[i]));
              });
  PassedOnChanges notAsked;
  const PairTables again{nullptr,        copies.data(),   slots.data(), activity.data(),
                         planes_.laws(), isIncremental(), &notAsked};
  constexpr Real noTime = 0;
  std::vector<int> every(count);
  std::iota(every.begin(), every.end(), 0);
  stepsBtoH(again, every, pairedFaces_.all(), dimension_, options_, noTime);
  std::size_t next = 0;
  for (std::size_t p = 0; p < all.size(); ++p)
  {
    const bool copied = next < passedOver.size() && passedOver[next] == p;
    shown.list.add(all.slotOf(p), copied ? &shown.copies(next) : &all[p]);
    next += copied;
  }
  return shown;
}

bool Contact::wasMissed(const Plane& plane, const ConstNodeVectors& x) const
{
  const Face &a = faces()[plane.face[0]], &b = faces()[plane.face[1]];
  return !a.young && !b.young &&
         hadToBeFound(a, b, facePlane(a, x, dimension_), facePlane(b, x, dimension_),
                      reach_.rulesWith(rules_), reach_.movedBetween(), reach_.turningWithinSkin());
}

void Contact::Tally::add(const Tally& others)
{
  counts.add(others.counts);
  for (std::size_t joint = 0; joint < energies.size(); ++joint)
    energies[joint].add(others.energies[joint]);
}

const Contact::Tally& Contact::tally() const
{
  if (!tally_)
    tally_ = sumInParts("coplane::contact::tally", planes().size(),
                        Tally{{}, std::vector<PlaneEnergySums>(rules_.joints.size())},
                        [&](Tally& mine, std::size_t p)
                        {
                          planes().prefetchAfter(p);
                          const Plane& plane = planes()[p];
                          if (!plane.countedHere)
                            return;
                          ContactCounts& counts = mine.counts;
                          counts.carrying += plane.area > 0;
                          counts.planes += plane.isBorn();
                          counts.open += plane.state == PlaneState::Open;
                          counts.stick += plane.state == PlaneState::Stick;
                          counts.slip += plane.state == PlaneState::Slip;
                          counts.tooDeep += plane.tooDeep;
                          counts.released += plane.isReleased();
                          if (plane.isBorn())
                            mine.energies[plane.joint].add(plane, plane.stored);
                        });
  return *tally_;
}

ContactEnergy Contact::energy() const
{
  PlaneEnergySums mine;
  for (const auto& [kind, sums] : ended_.byKind())
    mine.add(sums);
  for (const PlaneEnergySums& ofJoint : tally().energies)
    mine.add(ofJoint);
  std::vector<ExactSum> sums(mine.sums.begin(), mine.sums.end());
  return PlaneEnergySums::energyOf(ExactSum::overRanks(sums, *comm_).data());
}

std::int64_t Contact::lookedAtHere() const
{
  // A block at a time, so that what is far is told side by side.
  constexpr std::size_t width = 512;
  struct Sum
  {
    std::int64_t lookedAt = 0;
    void add(const Sum& other) { lookedAt += other.lookedAt; }
  };
  const PlaneTable::Slots& slots = planes_.slots();
  const auto take = [&](Sum& mine, std::size_t block)
  {
    const std::size_t first = width * block, count = std::min(width, planes_.count() - first);
    std::uint8_t far[width] = {};
    if (distances_.known())
      distances_.areFar(int(first), int(count), far);
    for (std::size_t i = 0; i < count; ++i)
      mine.lookedAt += slots.countedHere(first + i) && slots.faces(first + i).face[0] >= 0 &&
                       !(far[i] && planes_.carriesNothing(first + i));
  };
  const std::size_t blocks = (planes_.count() + width - 1) / width;
  return sumInParts("coplane::contact::lookedAt", blocks, Sum{}, take).lookedAt;
}

ContactCounts Contact::counts() const
{
  ContactCounts counts = tally().counts;
  counts.lookedAt = lookedAtHere();
  counts.slots = planes_.countedHere();
  counts.missed = searches_.missed;
  std::vector<std::int64_t> sums;
  for (const std::int64_t* number : counts.all())
    sums.push_back(*number);
  comm_->sum(sums);
  for (std::size_t i = 0; i < sums.size(); ++i)
    *counts.all()[i] = sums[i];
  return counts;
}
} // namespace coplane
