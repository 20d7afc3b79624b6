#include <coplane_contact/PlaneState.hpp>
#include <coplane_contact/PlaneTable.hpp>
#include <coplane_contact/detail/FacePairLanes.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
/// A plane more than this times as stiff as the elements behind its faces chatters: their nodes
/// bounce on it many times. The penalty of the defaults, 2, does not (docs/user/contact.md). It
/// does between rigid bodies, which have nothing else that gives way.
constexpr Real stiffestCalm = 2.5;

constexpr std::size_t wokenAtOnce = 128; ///< planes for which there is memory at once

void putEdges(const EdgesOfPair& edges, Plane& plane)
{
  plane.exits = edges.exits;
  plane.turns = edges.turns;
  plane.covered = edges.covered;
  plane.seams = edges.seams;
}
} // namespace

void PlaneList::clear()
{
  planes_.clear();
  slots_.clear();
}

void PlaneList::add(std::size_t slot, Plane* plane)
{
  planes_.push_back(plane);
  slots_.push_back(slot);
}

PlaneTable::Slots::Slots(std::size_t count, std::size_t planes)
    : faces("coplane::contact::slotFaces", count), plane(count, nullptr),
      activity("coplane::contact::activity", count), todo("coplane::contact::todo", count),
      countedHere("coplane::contact::countedHere", count), born("coplane::contact::born", count),
      gains("coplane::contact::gains", count),
      stored(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::planes"), planes)
{
}

PlaneTable::PlaneTable(const ContactRules& rules, Real depthMax)
    : rules_(&rules), depthMax_(depthMax), laws_("coplane::contact::laws", rules.joints.size())
{
  for (std::size_t j = 0; j < rules.joints.size(); ++j)
    laws_(j) = rules.joints[j].law;
}

std::pair<GlobalId, GlobalId> PlaneTable::keyOf(std::size_t slot) const
{
  if (const Plane* const plane = slots_.plane[slot])
    return {plane->faceId[0], plane->faceId[1]};
  const SlotFaces& pair = slots_.faces(slot);
  if (pair.face[0] < 0)
    return {-1, -1};
  return {faces_(pair.face[0]).id, faces_(pair.face[1]).id};
}

Plane PlaneTable::freshPlane(std::size_t slot) const
{
  const SlotFaces& pair = slots_.faces(slot);
  const Face &a = faces_(pair.face[0]), &b = faces_(pair.face[1]);
  const ContactRule& rule = rules_->between(a.group, b.group);
  Plane plane;
  plane.faceId[0] = a.id;
  plane.faceId[1] = b.id;
  plane.face[0] = pair.face[0];
  plane.face[1] = pair.face[1];
  plane.joint = std::uint16_t(rule.joint);
  plane.acrossJoint = rule.declared;
  plane.block[0] = std::uint16_t(a.block);
  plane.block[1] = std::uint16_t(b.block);
  plane.countedHere = a.ownedHere;
  plane.sighting = carriesNothing(slot) ? Sighting::Known : Sighting::New;
  plane.unseen = slots_.activity(slot) == Activity::Apart;
  plane.fit =
      rules_->joints[rule.joint].law.fittedTo(a.thickness, a.modulus, b.thickness, b.modulus);
  const JointLaw& law = rules_->joints[rule.joint].law;
  const Real stiffest = law.curve.stiffens() ? plane.fit.stiffnessCap : plane.fit.normalStiffness;
  const bool isStiff =
      (a.rigid && b.rigid) ||
      stiffest * (a.thickness / a.modulus + b.thickness / b.modulus) > stiffestCalm;
  plane.pairing = isStiff ? Pairing::Stiff : Pairing::Usual;
  plane.pairAs(isShallow(a, b), false);
  plane.depthLimit = float(depthMax_ * std::min(a.thickness, b.thickness));
  if (!slots_.edges.empty())
    putEdges(slots_.edges[slot], plane);
  return plane;
}

Plane PlaneTable::planeOf(std::size_t slot) const
{
  const Plane* const plane = slots_.plane[slot];
  return plane != nullptr ? *plane : freshPlane(slot);
}

Plane PlaneTable::prepared(std::size_t slot) const
{
  Plane plane = planeOf(slot);
  if (slots_.todo(slot) != 0)
    preparation_.prepare(slot, slots_.todo(slot), plane);
  return plane;
}

bool PlaneTable::isBare(std::size_t slot, const Plane& prepared) const
{
  if (slots_.faces(slot).face[0] < 0) // dormant
    return false;
  Plane bare = freshPlane(slot);
  putEdges({prepared.exits, prepared.turns, prepared.covered, prepared.seams}, bare);
  return sameNumbers(prepared, bare);
}

PairTables PlaneTable::forKernels(bool incremental)
{
  PairTables pairs{this,         slots_.plane.data(), slots_.faces.data(), slots_.activity.data(),
                   laws_.data(), incremental,         &passedOn_};
  pairs.gains = slots_.gains.data();
  return pairs;
}

void PlaneTable::take(Slots slots, const Array<Face>& faces, Preparation preparation)
{
  slots_ = std::move(slots);
  faces_ = faces;
  preparation_ = std::move(preparation);
  passedOn_.forget();
  gainsAreKnown_ = false;
  woken_.clear();
  wokenCount_ = 0;
  parallelFor("coplane::contact::slots", int(count()),
              [&](const int p)
              {
                const Plane* const plane = slots_.plane[p];
                slots_.countedHere(p) = plane != nullptr
                                            ? plane->countedHere
                                            : faces_(slots_.faces(p).face[0]).ownedHere;
                if (plane == nullptr)
                  return;
                slots_.activity(p) = activityOf(*plane);
                for (int side = 0; side < 2; ++side)
                  slots_.faces(p).face[side] = plane->face[side];
              });
  countedHere_ = std::count(slots_.countedHere.data(), slots_.countedHere.data() + count(), 1);
  list();
}

void PlaneTable::forgetPreparation()
{
  preparation_ = {};
}

Preparation::Todo PlaneTable::takeOver(std::size_t slot) const
{
  const Plane* const plane = slots_.plane[slot];
  const bool known = plane != nullptr ? !plane->isNew() : carriesNothing(slot);
  return Preparation::TakeOver |
         (known && slots_.activity(slot) != Activity::Apart ? Preparation::WasSeen : 0);
}

void PlaneTable::renew(std::shared_ptr<const Heritage> heritage)
{
  preparation_.renew(std::move(heritage));
  passedOn_.forget();
  parallelFor("coplane::contact::renew", int(count()),
              [&](const int slot)
              {
                if (slots_.faces(slot).face[0] < 0 || slots_.born(slot) != 0)
                  return;
                if (const Plane* const plane = slots_.plane[slot];
                    plane != nullptr && plane->isBorn())
                {
                  slots_.born(slot) = 1;
                  return;
                }
                Preparation::Todo& todo = slots_.todo(slot);
                todo = Preparation::Todo((todo & Preparation::LookAtEdges) | takeOver(slot));
              });
}

namespace
{
/// A sum that is rounded in the order of threads; several at once, which do not wait for each
/// other.
struct LooseSum
{
  static constexpr std::size_t width = 8;
  std::array<Real, width> parts{};

  void add(const LooseSum& other)
  {
    for (std::size_t i = 0; i < width; ++i)
      parts[i] += other.parts[i];
  }
  Real value() const
  {
    Real sum = 0;
    for (const Real part : parts)
      sum += part;
    return sum;
  }
};
} // namespace

Real PlaneTable::gain() const
{
  if (!gainsAreKnown_)
    parallelFor("coplane::contact::gains", int(count()),
                [&](const int slot)
                {
                  const Plane* const plane = slots_.plane[slot];
                  slots_.gains(slot) = plane == nullptr ? 0 : gainOf(*plane);
                });
  gainsAreKnown_ = true;
  const Real* const gains = slots_.gains.data();
  constexpr std::size_t width = LooseSum::width;
  LooseSum sum = sumInParts("coplane::contact::gain", count() / width, LooseSum{},
                            [&](LooseSum& mine, std::size_t part)
                            {
                              for (std::size_t i = 0; i < width; ++i)
                                mine.parts[i] += gains[width * part + i];
                            });
  for (std::size_t slot = count() / width * width; slot < count(); ++slot)
    sum.parts[0] += gains[slot];
  return sum.value();
}

void PlaneTable::drop(const std::vector<std::size_t>& slots)
{
  for (const std::size_t slot : slots)
  {
    slots_.plane[slot] = nullptr;
    slots_.activity(slot) = Activity::Awake;
    slots_.born(slot) = 0;
    slots_.gains(slot) = 0;
  }
  list();
}

Plane* PlaneTable::newPlace()
{
  const std::lock_guard<std::mutex> lock(waking_);
  if (wokenCount_ == wokenAtOnce * woken_.size())
    woken_.push_back(std::make_unique<Plane[]>(wokenAtOnce));
  const std::size_t place = wokenCount_++;
  return &woken_[place / wokenAtOnce][place % wokenAtOnce];
}

Plane& PlaneTable::wake(std::size_t slot)
{
  Plane*& plane = slots_.plane[slot];
  if (plane == nullptr)
  {
    Plane* const place = newPlace();
    *place = freshPlane(slot);
    plane = place;
  }
  if (std::uint8_t& todo = slots_.todo(slot); todo != 0)
  {
    preparation_.prepare(slot, todo, *plane);
    todo = 0;
  }
  return *plane;
}

void PlaneTable::listWoken()
{
  if (wokenCount_ != wokenListed_)
    list();
}

void PlaneTable::list()
{
  planes_.clear();
  for (std::size_t slot = 0; slot < count(); ++slot)
    if (Plane* const plane = slots_.plane[slot])
      planes_.add(slot, plane);
  wokenListed_ = wokenCount_;
}
} // namespace coplane
