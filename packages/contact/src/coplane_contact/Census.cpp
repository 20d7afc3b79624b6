#include <coplane_contact/Census.hpp>
#include <coplane_contact/detail/DeclaredJoints.hpp>
#include <coplane_core/OrderStatistics.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
constexpr std::size_t extremePairs = 5, lonelyNamed = 10;

struct Entry
{
  CensusLengths::Pair pair;
  Real rank; ///< the larger, the more conspicuous
};

void keepFirst(std::vector<Entry>& entries)
{
  const auto before = [](const Entry& a, const Entry& b)
  {
    return std::tie(b.rank, a.pair.faceId[0], a.pair.faceId[1]) <
           std::tie(a.rank, b.pair.faceId[0], b.pair.faceId[1]);
  };
  const std::size_t kept = std::min(entries.size(), extremePairs);
  std::partial_sort(entries.begin(), entries.begin() + std::ptrdiff_t(kept), entries.end(), before);
  entries.resize(kept);
}

CensusLengths lengthsOf(std::vector<Entry> mine, const Comm& comm)
{
  CensusLengths lengths;
  lengths.count = comm.sum(std::int64_t(mine.size()));
  if (lengths.count == 0)
    return lengths;
  std::vector<Real> values;
  for (const Entry& entry : mine)
    values.push_back(entry.pair.length);
  const auto& fractions = CensusLengths::fractions;
  const std::vector<Real> quantiles =
      orderStatistics(values, {fractions.begin(), fractions.end()}, comm);
  std::copy(quantiles.begin(), quantiles.end(), lengths.quantiles.begin());
  keepFirst(mine);
  std::vector<Entry> all = comm.allGather(mine);
  keepFirst(all);
  for (const Entry& entry : all)
    lengths.extreme.push_back(entry.pair);
  return lengths;
}

/// For every group of faces whether it belongs to side sets between which a joint is declared.
std::vector<char> groupsOfDeclaredSets(const Contact& contact)
{
  const ContactRules& rules = contact.rules();
  std::vector<Real> ofSideSets(rules.groups(), 0), kinds(rules.kinds, 0);
  for (const Face& face : contact.faces())
    if (face.group != face.block) // the first groups are the blocks
      ofSideSets[face.group] = 1;
  contact.comm().max(ofSideSets);
  for (int a = 0; a < rules.groups(); ++a)
    if (ofSideSets[a] > 0)
      kinds[rules.kindOf[a]] = 1;
  std::vector<char> declaredKind(rules.kinds, 0), declared(rules.groups(), 0);
  for (int a = 0; a < rules.kinds; ++a)
    for (int b = 0; b < rules.kinds; ++b)
      if (kinds[b] > 0 && rules.table[std::size_t(a) * std::size_t(rules.kinds) + b].declared)
        declaredKind[a] = 1;
  for (int a = 0; a < rules.groups(); ++a)
    declared[a] = ofSideSets[a] > 0 && declaredKind[rules.kindOf[a]];
  return declared;
}

void countLonelyFaces(const Contact& contact, const std::vector<char>& declared,
                      const std::vector<char>& closed, ContactCensus& census)
{
  const std::vector<char> group = groupsOfDeclaredSets(contact);
  std::vector<GlobalId> lonely;
  for (std::size_t f = 0; f < contact.faces().size(); ++f)
    if (contact.faces()[f].ownedHere && !contact.faces()[f].isCut() && !closed[f] &&
        (declared[f] || group[contact.faces()[f].group]))
      lonely.push_back(contact.faces()[f].id);
  census.lonelyFaces = contact.comm().sum(std::int64_t(lonely.size()));
  const auto keepLowest = [&]
  {
    std::sort(lonely.begin(), lonely.end());
    lonely.resize(std::min(lonely.size(), lonelyNamed));
  };
  keepLowest();
  lonely = contact.comm().allGather(lonely);
  keepLowest();
  census.firstLonelyFaces = lonely;
}
/// Of a declared joint: faces beside each other, which share no area yet, are not.
bool isClosed(const Plane& plane)
{
  return plane.declared && plane.overlap > 0;
}

/// What this rank sees of the pairs.
struct Survey
{
  enum Count
  {
    Pairs,
    Closed,
    Bonded,
    Uneven,
    Neighbours,
    Touching,
    Overlapping,
    Apart,
    Open,
    Stick,
    Slip,
    Counts
  };
  std::vector<std::int64_t> n;
  std::vector<Real> most{-infinity, 0, 0}; ///< -least stiffness, largest; change of a gap
  std::vector<Entry> joints, overlaps, gaps;
  std::vector<char> declared, closed; ///< faces: of declared joints, of closed planes
  Real roundOff;                      ///< of gaps [m]

  explicit Survey(const Contact& contact)
      : n(Counts, 0), declared(contact.faces().size(), 0), closed(contact.faces().size(), 0),
        roundOff(ContactCensus::roundOff * contact.skin())
  {
    for (std::size_t slot = 0; slot < contact.slots(); ++slot)
      if (const Plane plane = contact.planeOf(slot); plane.face[0] >= 0)
        look(contact, plane);
  }

private:
  void look(const Contact& contact, const Plane& plane)
  {
    const int a = plane.face[0], b = plane.face[1];
    const bool joint =
        contact.rules().between(contact.faces()[a].group, contact.faces()[b].group).declared;
    if (joint && contact.isOpposed(plane))
      declared[a] = declared[b] = 1;
    if (isClosed(plane))
      closed[a] = closed[b] = 1;
    if (plane.countedHere)
      count(plane, joint, contact.opposition(plane) > opposedAcrossJoint);
  }
  /// Faces that do not lie on each other, as those of two joints that meet at a corner, may have
  /// area in common and lie far behind each other: that is no overlap of bodies.
  void count(const Plane& plane, bool joint, bool lieOnEachOther)
  {
    ++n[Pairs];
    n[Open] += plane.state == PlaneState::Open;
    n[Stick] += plane.state == PlaneState::Stick;
    n[Slip] += plane.state == PlaneState::Slip;
    most[0] = std::max(most[0], -plane.fit.normalStiffness);
    most[1] = std::max(most[1], plane.fit.normalStiffness);
    const CensusLengths::Pair pair{{plane.faceId[0], plane.faceId[1]}, plane.gap};
    most[2] = std::max(most[2], plane.changeOfGap());
    n[Uneven] += plane.history.absorbedUnevenly;
    if (isClosed(plane))
    {
      ++n[Closed];
      n[Bonded] += plane.history.bonded;
      const Real absorbed = plane.offset - plane.closure;
      joints.push_back({{{pair.faceId[0], pair.faceId[1]}, absorbed}, std::abs(absorbed)});
    }
    else if (joint)
      ++n[Neighbours];
    else if (std::abs(plane.gap) <= roundOff &&
             (plane.overlap > 0 || plane.sighting == Sighting::FoundLate))
      ++n[Touching];
    else if (plane.sighting == Sighting::FoundLate && lieOnEachOther)
    {
      ++n[Overlapping];
      overlaps.push_back({{{pair.faceId[0], pair.faceId[1]}, -plane.gap}, -plane.gap});
    }
    else
    {
      ++n[Apart];
      if (plane.overlap > 0 && plane.sighting != Sighting::FoundLate)
        gaps.push_back({pair, -plane.gap});
    }
  }
};

/// What the items that declare joints are called of which no plane was closed. Collective.
std::vector<std::string> itemsWithoutPartner(const Contact& contact)
{
  const auto& items = contact.rules().declaredItems;
  if (items.empty())
    return {};
  std::vector<std::int64_t> closed(items.size(), 0);
  for (std::size_t p = 0; p < contact.planes().size(); ++p)
  {
    const Plane& plane = contact.planes()[p];
    if (!isClosed(plane) || !plane.countedHere || plane.face[0] < 0)
      continue;
    const int item =
        contact.rules()
            .between(contact.faces()[plane.face[0]].group, contact.faces()[plane.face[1]].group)
            .item;
    for (std::size_t i = 0; i < items.size(); ++i)
      closed[i] += item == items[i].first;
  }
  contact.comm().sum(closed);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (closed[i] == 0)
      names.push_back(items[i].second);
  return names;
}
} // namespace

ContactCensus census(const Contact& contact)
{
  Survey survey(contact);
  const std::vector<std::int64_t>& n = survey.n;
  contact.comm().sum(survey.n);
  contact.comm().max(survey.most);
  ContactCensus census;
  census.pairs = n[Survey::Pairs];
  census.declaredClosed = n[Survey::Closed];
  census.bonded = n[Survey::Bonded];
  census.uneven = n[Survey::Uneven];
  census.declaredWithoutOverlap = n[Survey::Neighbours];
  census.touching = n[Survey::Touching];
  census.overlapping = n[Survey::Overlapping];
  census.apart = n[Survey::Apart];
  census.open = n[Survey::Open];
  census.stick = n[Survey::Stick];
  census.slip = n[Survey::Slip];
  census.leastStiffness = -survey.most[0];
  census.largestStiffness = survey.most[1];
  census.changeOfGap = survey.most[2];
  census.joints = lengthsOf(std::move(survey.joints), contact.comm());
  census.overlaps = lengthsOf(std::move(survey.overlaps), contact.comm());
  census.gaps = lengthsOf(std::move(survey.gaps), contact.comm());
  countLonelyFaces(contact, survey.declared, survey.closed, census);
  census.itemsWithoutPartner = itemsWithoutPartner(contact);
  return census;
}
} // namespace coplane
