// Contact's part of a checkpoint: faces with what they got at their birth, all slots, planes that
// have ended.
#include <coplane_contact/Contact.hpp>
#include <coplane_contact/PlaneState.hpp>
#include <coplane_core/StateHash.hpp>

#include <algorithm>
#include <tuple>
#include <type_traits>

namespace coplane
{
namespace
{
const std::vector<std::string> faceColumns{"thickness", "modulus"};

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

/// A plane under way to the ranks that have one of its faces.
struct SentPlane
{
  GlobalId face;
  Plane plane;
};

struct WantedFace
{
  GlobalId face;
  int byRank;
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

  KeyedRows planes;
  planes.keySize = 2;
  planes.columns = namesOfNumbers();
  for (std::size_t p = 0; p < planes_.count(); ++p)
  {
    const Plane plane = prepared(p);
    if (!plane.countedHere)
      continue;
    Real* row = planes.add({plane.faceId[0], plane.faceId[1]});
    forEachNumber(plane, [&](const auto& number) { *row++ = Real(number); });
  }
  out.rows("contact/planes", planes);
  out.numbers("contact/ended", ended_.numbers(*comm_));
  out.numbers("contact/counts", {Real(searches_.count), Real(comm_->sum(searches_.missed))});
}

std::vector<Plane> Contact::planesOfCheckpoint(const StateSource& in) const
{
  const KeyedRows rows = in.part("contact/planes", namesOfNumbers());
  std::vector<std::vector<SentPlane>> send(comm_->size());
  for (std::size_t i = 0; i < rows.count(); ++i)
  {
    Plane plane;
    const Real* row = rows.row(i);
    plane.faceId[0] = rows.key(i)[0];
    plane.faceId[1] = rows.key(i)[1];
    forEachNumber(plane, [&](auto& number)
                  { number = static_cast<std::decay_t<decltype(number)>>(*row++); });
    plane.face[0] = plane.sighting == Sighting::Missed ? -1 : 0;
    for (const GlobalId face : plane.faceId)
      send[rankFor(face, *comm_)].push_back({face, plane});
  }
  const std::vector<Holder> all = holders(localFaces(), *comm_);
  const std::vector<SentPlane> arrived = comm_->exchange(send);
  std::vector<std::vector<Plane>> toHolder(comm_->size());
  for (const SentPlane& sent : arrived)
    forEachHolder(all, sent.face,
                  [&](const Holder& holder) { toHolder[holder.rank].push_back(sent.plane); });
  std::vector<Plane> planes = comm_->exchange(toHolder);
  std::sort(planes.begin(), planes.end(), keyLess);
  // Once only where both faces are here.
  planes.erase(std::unique(planes.begin(), planes.end(),
                           [](const Plane& a, const Plane& b)
                           { return !keyLess(a, b) && !keyLess(b, a); }),
               planes.end());
  return planes;
}

std::vector<GhostFace> Contact::fetchGhosts(const std::vector<GlobalId>& wanted,
                                            const std::vector<GlobalId>& nodeIds) const
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
  const std::vector<WantedFace> mine = comm_->exchange(toOwner);
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
  firstHalf_.restored = planesOfCheckpoint(in);
  std::vector<GlobalId> wanted;
  const auto isLocal = [&](GlobalId id) { return std::binary_search(ids.begin(), ids.end(), id); };
  for (const Plane& plane : firstHalf_.restored)
    for (const GlobalId face : plane.faceId)
      if (plane.face[0] >= 0 && !isLocal(face))
        wanted.push_back(face);
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
  PlaneTable::Slots slots(restored.size(), restored.size());
  for (std::size_t p = 0; p < restored.size(); ++p)
  {
    Plane& plane = *new (&slots.stored(p)) Plane(restored[p]);
    slots.plane[p] = &plane;
    const int lower = faces_.place(plane.faceId[0]);
    plane.countedHere = lower >= 0 && faces()[lower].ownedHere;
    if (plane.face[0] >= 0)
    {
      plane.face[0] = lower;
      plane.face[1] = faces_.place(plane.faceId[1]);
    }
  }
  firstHalf_ = {};
  planes_.take(std::move(slots), faces_.forKernels(), nullptr);
  forceSums_.forgetFaces();
  listSlotsOfFaces(layout.owned());
  ended_ = {};
  const std::vector<Real> counts = in.numbers("contact/counts");
  searches_.count = std::int64_t(counts.at(0));
  searches_.missed = comm_->isRoot() ? std::int64_t(counts.at(1)) : 0;
  searches_.sinceUpdate = false;
  if (comm_->isRoot())
    ended_.addNumbers(in.numbers("contact/ended"));
  else
    in.numbers("contact/ended"); // collective
}
} // namespace coplane
