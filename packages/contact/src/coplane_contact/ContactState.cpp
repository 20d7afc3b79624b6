// Contact's part of a checkpoint: faces with what they got at their birth, planes, pairs that have
// none, planes that have ended.
#include <coplane_contact/Contact.hpp>
#include <coplane_contact/PlaneState.hpp>
#include <coplane_core/StateHash.hpp>

#include <algorithm>
#include <array>
#include <tuple>
#include <type_traits>

namespace coplane
{
namespace
{
const std::vector<std::string> faceColumns{"thickness", "modulus"};
const std::vector<std::string> pairColumns{"activity", "exits", "turns", "covered", "seams"};

/// A rank that looks after what belongs to a face while data find their way.
int rankFor(GlobalId face, const Comm& comm)
{
  return int(mix(std::uint64_t(face)) % std::uint64_t(comm.size()));
}

/// Who has a face.
struct Holder
{
  GlobalId face;
  int rank;
  bool owns;
};

/// A plane or a pair under way to the ranks that have one of its faces.
template <class Record>
struct Sent
{
  GlobalId face;
  Record record;
};

/// Those who have a face of which this rank looks after, sorted by face.
std::vector<Holder> holders(const std::vector<Face>& localFaces, const Comm& comm)
{
  std::vector<std::vector<Holder>> tell(comm.size());
  for (const Face& face : localFaces)
    tell[rankFor(face.id, comm)].push_back({face.id, comm.rank(), face.ownedHere});
  std::vector<Holder> all = comm.exchange(tell);
  std::sort(all.begin(), all.end(),
            [](const Holder& a, const Holder& b)
            { return std::tie(a.face, a.rank) < std::tie(b.face, b.rank); });
  return all;
}

template <class F>
void forEachHolder(const std::vector<Holder>& all, GlobalId face, const F& f)
{
  for (auto h = std::lower_bound(all.begin(), all.end(), face,
                                 [](const Holder&a, GlobalId id) { return a.face < id; });
       h != all.end() && h->face == face; ++h)
    f(*h);
}

/// Planes or pairs that have a face here, sorted by key, from ranks that have read some of them
/// each. Collective.
template <class Record>
std::vector<Record> withAFaceHere(const std::vector<Record>& read, const std::vector<Holder>& all,
                                  const Comm& comm)
{
  std::vector<std::vector<Sent<Record>>> send(comm.size());
  for (const Record& record : read)
    for (const GlobalId face : record.faceId)
      send[rankFor(face, comm)].push_back({face, record});
  const std::vector<Sent<Record>> arrived = comm.exchange(send);
  std::vector<std::vector<Record>> toHolder(comm.size());
  for (const Sent<Record>& sent : arrived)
    forEachHolder(all, sent.face,
                  [&](const Holder& holder) { toHolder[holder.rank].push_back(sent.record); });
  std::vector<Record> records = comm.exchange(toHolder);
  const auto less = [](const Record& a, const Record& b) { return keyLess(a, b); };
  std::sort(records.begin(), records.end(), less);
  // Once only where both faces are here.
  records.erase(std::unique(records.begin(), records.end(),
                            [&](const Record& a, const Record& b)
                            { return !less(a, b) && !less(b, a); }),
                records.end());
  return records;
}
} // namespace

void Contact::save(StateTables& out) const
{
  KeyedRows faces;
  faces.columns = faceColumns;
  for (const Face& face : localFaces())
    if (face.ownedHere)
    {
      Real* row = faces.add({face.id});
      row[0] = face.thickness;
      row[1] = face.modulus;
    }
  out.rows("contact/faces", faces);

  // Most pairs have nothing to remember: their planes follow from their faces.
  KeyedRows planes, pairs;
  planes.keySize = pairs.keySize = 2;
  planes.columns = namesOfNumbers();
  pairs.columns = pairColumns;
  for (std::size_t p = 0; p < planes_.count(); ++p)
  {
    const Plane plane = prepared(p);
    if (!plane.countedHere)
      continue;
    if (planes_.isBare(p, plane))
    {
      const std::array<Real, 5> numbers{Real(planes_.slots().activity(p)), Real(plane.exits),
                                        Real(plane.turns), Real(plane.covered), Real(plane.seams)};
      std::copy(numbers.begin(), numbers.end(), pairs.add({plane.faceId[0], plane.faceId[1]}));
      continue;
    }
    Real* row = planes.add({plane.faceId[0], plane.faceId[1]});
    forEachNumber(plane, [&](const auto& number) { *row++ = Real(number); });
  }
  out.rows("contact/planes", planes);
  out.rows("contact/pairs", pairs);
  out.numbers("contact/ended", ended_.numbers(*comm_));
  out.numbers("contact/counts",
              {Real(searches_.count), Real(comm_->sum(searches_.missed)), reach_.offset()});
}

void Contact::readSlots(const StateSource& in)
{
  std::vector<Plane> planes;
  const KeyedRows rows = in.part("contact/planes", namesOfNumbers());
  for (std::size_t i = 0; i < rows.count(); ++i)
  {
    Plane& plane = planes.emplace_back();
    const Real* row = rows.row(i);
    plane.faceId[0] = rows.key(i)[0];
    plane.faceId[1] = rows.key(i)[1];
    forEachNumber(plane, [&](auto& number)
                  { number = static_cast<std::decay_t<decltype(number)>>(*row++); });
    plane.face[0] = plane.sighting == Sighting::Missed ? -1 : 0;
  }
  std::vector<BarePair> pairs;
  const KeyedRows bare = in.part("contact/pairs", pairColumns);
  for (std::size_t i = 0; i < bare.count(); ++i)
  {
    const Real* row = bare.row(i);
    pairs.push_back(
        {{bare.key(i)[0], bare.key(i)[1]},
         Activity(int(row[0])),
         {std::uint8_t(row[1]), std::uint8_t(row[2]), std::uint8_t(row[3]), std::uint8_t(row[4])}});
  }
  const std::vector<Holder> all = holders(localFaces(), *comm_);
  firstHalf_.restored = withAFaceHere(planes, all, *comm_);
  firstHalf_.bare = withAFaceHere(pairs, all, *comm_);
}

std::vector<Contact::WantedFace> Contact::askOwners(const std::vector<GlobalId>& wanted) const
{
  std::vector<std::vector<WantedFace>> ask(comm_->size()), toOwner(comm_->size());
  for (const GlobalId face : wanted)
    ask[rankFor(face, *comm_)].push_back({face, comm_->rank()});
  const std::vector<Holder> all = holders(localFaces(), *comm_);
  const std::vector<WantedFace> asked = comm_->exchange(ask);
  for (const WantedFace& one : asked)
    forEachHolder(all, one.face,
                  [&](const Holder& holder)
                  {
                    if (holder.owns)
                      toOwner[holder.rank].push_back(one);
                  });
  return comm_->exchange(toOwner);
}

std::vector<GhostFace> Contact::fetchGhosts(const std::vector<GlobalId>& wanted,
                                            const std::vector<GlobalId>& nodeIds) const
{
  const std::vector<WantedFace> mine = askOwners(wanted);
  std::vector<std::vector<GhostFace>> answer(comm_->size());
  for (const WantedFace& one : mine)
    answer[one.byRank].push_back(
        toGhostFace(*findFace(localFaces().begin(), localFaces().end(), one.face), nodeIds));
  std::vector<GhostFace> ghosts = comm_->exchange(answer);
  std::sort(ghosts.begin(), ghosts.end(),
            [](const GhostFace& a, const GhostFace& b) { return a.id < b.id; });
  return ghosts;
}

std::vector<GlobalId> Contact::restoreFaces(const StateSource& in,
                                            const std::vector<GlobalId>& nodeIds)
{
  std::vector<GlobalId> ids;
  for (const Face& face : localFaces())
    ids.push_back(face.id);
  const KeyedRows rows = in.rowsOf("contact/faces", faceColumns, ids);
  std::size_t f = 0;
  for (Face& face : faces_.local())
  {
    face.thickness = rows.row(f)[0];
    face.modulus = rows.row(f)[1];
    face.young = false;
    ++f;
  }

  firstHalf_ = {};
  readSlots(in);
  std::vector<GlobalId> wanted;
  const auto want = [&](const GlobalId(&faces)[2])
  {
    for (const GlobalId face : faces)
      if (!std::binary_search(ids.begin(), ids.end(), face))
        wanted.push_back(face);
  };
  for (const Plane& plane : firstHalf_.restored)
    if (plane.face[0] >= 0)
      want(plane.faceId);
  for (const BarePair& pair : firstHalf_.bare)
    want(pair.faceId);
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  firstHalf_.ghosts.faces = fetchGhosts(wanted, nodeIds);
  if (comm_->max(std::int64_t(firstHalf_.ghosts.faces.size() != wanted.size())) > 0)
    failOnAllRanks(ExitCode::Checkpoint,
                   "the checkpoint has contact planes on faces that this mesh does not have.");
  return firstHalf_.nodesOfGhosts();
}

void Contact::restorePlanes(const StateSource& in, const NodeLayout& layout)
{
  faces_.list(firstHalf_.ghosts.faces, layout);
  const std::vector<Plane>& restored = firstHalf_.restored;
  const std::vector<BarePair>& bare = firstHalf_.bare;
  PlaneTable::Slots slots(restored.size() + bare.size(), restored.size());
  slots.edges.resize(slots.plane.size());
  std::size_t p = 0, b = 0;
  for (std::size_t slot = 0; slot < slots.plane.size(); ++slot)
  {
    if (b < bare.size() && (p == restored.size() || keyLess(bare[b], restored[p])))
    {
      const BarePair& pair = bare[b++];
      for (int side = 0; side < 2; ++side)
        slots.faces(slot).face[side] = faces_.place(pair.faceId[side]);
      slots.activity(slot) = pair.activity;
      slots.edges[slot] = pair.edges;
      continue;
    }
    Plane& plane = *new (&slots.stored(p)) Plane(restored[p]);
    ++p;
    slots.plane[slot] = &plane;
    const int lower = faces_.place(plane.faceId[0]);
    plane.countedHere = lower >= 0 && faces()[lower].ownedHere;
    if (plane.face[0] >= 0)
    {
      plane.face[0] = lower;
      plane.face[1] = faces_.place(plane.faceId[1]);
    }
  }
  firstHalf_ = {};
  ghostsElsewhere_ = {};
  planes_.take(std::move(slots), faces_.forKernels(), {});
  forceSums_.forgetFaces();
  listSlotsOfFaces(layout.owned());
  ended_ = {};
  const std::vector<Real> counts = in.numbers("contact/counts");
  searches_.count = std::int64_t(counts.at(0));
  searches_.missed = comm_->isRoot() ? std::int64_t(counts.at(1)) : 0;
  searches_.sinceUpdate = false;
  reach_.setOffset(counts.at(2));
  distances_.forget();
  planesHaveChanged();
  if (comm_->isRoot())
    ended_.addNumbers(in.numbers("contact/ended"));
  else
    in.numbers("contact/ended"); // collective
}
} // namespace coplane
